// The bodies of segment.hpp: the values' bounds, and the segment from one tier to the next.

namespace TEXGEN_DETAIL {

// A float stands for the segment's value at alpha exactly: A - alpha A + alpha B.
inline Expansion<5> exactly_mixed(double a, double b, double alpha) noexcept {
    Expansion<5> sum;
    sum.add(a);
    sum.add_product(-alpha, a);
    sum.add_product(alpha, b);
    return sum;
}

// 1 - alpha, the products and the sum are rounded once each.
inline Bounded mixed(double a, double b, double alpha) noexcept {
    const double from_a = (1.0 - alpha) * a;
    const double from_b = alpha * b;
    return {from_a + from_b, gamma(4) * (std::fabs(from_a) + std::fabs(from_b))};
}

// One value of a job, every decision exact.
inline void interpolate_one(const SegmentJob& job, std::size_t i) noexcept {
    const double alpha = widened(job.alpha[i]);
    const auto exact_q = [&] { return exactly_mixed(job.q_a, job.q_b, alpha); };
    const Bounded q = mixed(job.q_a, job.q_b, alpha);
    const bool in_front = certain_sign(q, exact_q) > 0;
    float value[2] = {0.0f, 0.0f};
    for (int k = 0; k < job.numerators; ++k) {
        if (in_front)
            value[k] = certain_quotient(
                mixed(job.a[k], job.b[k], alpha), q, [&] { return exactly_mixed(job.a[k], job.b[k], alpha); }, exact_q);
        job.out[k][i] = value[k];
    }
    if (job.lit != nullptr) job.lit[i] = in_front && is_inside(value[0], value[1], job.min, job.max) ? 1.0f : 0.0f;
}

// The quotients at the ends of a segment in front, but for some ulps.
struct EndQuotients {
    double of_q_a, of_q_b;
    double at_a[2], at_b[2];

    explicit EndQuotients(const SegmentJob& job) noexcept : of_q_a(1.0 / job.q_a), of_q_b(1.0 / job.q_b) {
        for (int k = 0; k < job.numerators; ++k) {
            at_a[k] = job.a[k] * of_q_a;
            at_b[k] = job.b[k] * of_q_b;
        }
    }

    double least(int k) const noexcept { return smaller(std::fabs(at_a[k]), std::fabs(at_b[k])); }
    double largest(int k) const noexcept { return larger(std::fabs(at_a[k]), std::fabs(at_b[k])); }
    double sum(int k) const noexcept { return std::fabs(at_a[k]) + std::fabs(at_b[k]); }
};

// With D = Q1 - Q0, u is exactly
//   U + d / (alpha + p),  U = (F1 - F0) / D, p = Q0 / D, d = (F0 Q1 - F1 Q0) / D^2.
inline void prepare_asymptote(SegmentJob& job) noexcept {
    const double inverse = 1.0 / (job.q_b - job.q_a);
    job.pole = job.q_a * inverse;
    for (int k = 0; k < job.numerators; ++k) {
        job.base[k] = (job.b[k] - job.a[k]) * inverse;
        job.slope[k] = (job.a[k] * job.q_b - job.b[k] * job.q_a) * inverse * inverse;
    }
}

// The roundings of U, p and d above: of D, its reciprocal and their products, or of each once more to float.
struct AsymptoteRoundings {
    double base, pole, slope;
};
inline constexpr AsymptoteRoundings rounded_in_double{4.0, 3.0, 7.0}, rounded_to_float{1.0, 1.0, 1.0};

// The error of that in unit roundoffs; infinite where numbers could leave their range. p is at most max(1, Q0 / Q1) times the
// divisor: its roundings and one for the sum, three for a reciprocal that two vectors share, those of d and one for the product
// are of u - U, which is largest at an end; the last sum is of u.
inline double asymptote_error(const SegmentJob& job, const EndQuotients& u, int k,
                              const AsymptoteRoundings& of) noexcept {
    const double part = larger(std::fabs(u.at_a[k] - job.base[k]), std::fabs(u.at_b[k] - job.base[k]));
    const double ratio = larger(1.0, job.q_a * u.of_q_b);
    const double pole = std::fabs(job.pole);
    if (!(u.sum(k) + std::fabs(job.base[k]) < 0x1p60 && ratio < 0x1p10 && pole < 0x1p30 && pole > 0x1p-30))
        return std::numeric_limits<double>::infinity();
    return 1.01 * ((of.slope + 5.0 + of.pole * ratio) * part + of.base * std::fabs(job.base[k]) + u.largest(k));
}
inline double asymptote_error_in_float(const SegmentJob& job, const EndQuotients& u, int k) noexcept {
    return unit_roundoff_float * asymptote_error(job, u, k, rounded_to_float) + 0x1p-90;
}

// About the end where q is less, with i the alpha from there, u is exactly
//   u0 + d i / (1 + b i),  b = (Q1 - Q0) / Q0 >= 0,  d = (u1 - u0) Q1 / Q0,
// and the step lies between 0 and u1 - u0.
inline void prepare_end(SegmentJob& job, const EndQuotients& u) noexcept {
    job.about_b = job.q_b < job.q_a;
    const double ratio = job.about_b ? job.q_a * u.of_q_b : job.q_b * u.of_q_a;
    job.pole = 1.0;
    job.bend = job.about_b ? (job.q_a - job.q_b) * u.of_q_b : (job.q_b - job.q_a) * u.of_q_a;
    for (int k = 0; k < job.numerators; ++k) {
        job.base[k] = job.about_b ? u.at_b[k] : u.at_a[k];
        job.slope[k] = ((job.about_b ? u.at_a[k] : u.at_b[k]) - job.base[k]) * ratio;
    }
}

// The error of that in float. With r = 2^-24: 1 - alpha, b, its product and the sum, the product of two sums, its reciprocal, the
// products with the other sum and with i, d and its product are rounded, 10 r of the step at most; u0 and the last sum once
// each. Infinite where a float could leave its range.
inline double end_error_in_float(const SegmentJob& job, const EndQuotients& u, int k) noexcept {
    const double ratio = larger(job.q_a * u.of_q_b, job.q_b * u.of_q_a);
    if (!(u.sum(k) < 0x1p60 && ratio < 0x1p60)) return std::numeric_limits<double>::infinity();
    return 1.001 * unit_roundoff_float * (2.0 * u.largest(k) + 11.0 * std::fabs(u.at_a[k] - u.at_b[k])) + 0x1p-120;
}

// What the segments' kernels need, but for the alphas and the outputs: coordinates `first` and the next.
inline SegmentJob segment_job(const Segment& segment, int first, int numerators) noexcept {
    SegmentJob job{};
    job.numerators = numerators;
    for (int k = 0; k < numerators; ++k) {
        const auto coordinate = static_cast<glm::length_t>(first + k);
        job.a[k] = widened(segment.a[coordinate]);
        job.b[k] = widened(segment.b[coordinate]);
    }
    job.q_a = widened(segment.a.w);
    job.q_b = widened(segment.b.w);
    return job;
}

// A tile of one row whose corners are the ends: given, so without an error. Of two coordinates.
inline Corners segment_corners(const glm::dvec4& a, const glm::dvec4& b, glm::length_t first,
                               glm::length_t second) noexcept {
    Corners at{};
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec4& end = i % 2 == 0 ? a : b;
        at.numerator[i] = double2_of(end[first], end[second]);
        at.q[i] = end.w;
    }
    at.least_q = smaller(a.w, b.w);
    at.largest_q = larger(a.w, b.w);
    return at;
}

inline Coverage depth_coverage(const Segment& segment, const LitTest& lit, double accepted) noexcept {
    if (!lit.has_depth()) return Coverage::inside;
    const glm::dvec4 a = widened(segment.a), b = widened(segment.b);
    if (!is_finite(a.z + a.w) || !is_finite(b.z + b.w)) return Coverage::partial;
    return r_coverage(segment_corners(a, b, 2, 2), lit, accepted);
}

inline Mixture mixture_of(double a, double b) noexcept {
    const DoubleDouble step = two_sum(b, -a);
    if (!is_finite(step.high)) return {a, b, 0.0, Mixture::is_not_finite};
    if (step.low != 0.0)
        return std::fabs(a) < std::fabs(b) ? Mixture{a, b, -a, Mixture::is_far} : Mixture{a, -a, b, Mixture::is_far};
    const double leading = leading_29_bits(step.high);
    return {a + 0.0, leading, step.high - leading, leading == step.high ? Mixture::is_short : Mixture::is_long};
}

// The sum a + alpha (b - a) in double is within so many ulps. Of a short mixture it is rounded once, of others the step and the
// product too, which may be as large as the larger end.
inline double ulps_of_sum(double a, double b) noexcept {
    if (mixture_of(a, b).kind == Mixture::is_short) return 1.0;
    const double ratio = larger(std::fabs(a), std::fabs(b)) / smaller(std::fabs(a), std::fabs(b));
    return a * b > 0.0 && is_finite(ratio) ? 1.0 + 2.0 * ratio : std::numeric_limits<double>::infinity();
}

// The most ulps for which quotients in double are worth a try: more are in doubt too often.
inline constexpr double quick_ulps = 0x1p13;

// Whether there are so few about the asymptote, and no subnormal floats; takes how many.
inline bool is_quick_about_asymptote(const SegmentJob& job, const EndQuotients& u, double& ulps) noexcept {
    for (int k = 0; k < job.numerators; ++k) {
        if (!(u.at_a[k] * u.at_b[k] > 0.0 && u.least(k) > 0x1p-120)) return false;
        ulps = larger(ulps, asymptote_error(job, u, k, rounded_in_double) / u.least(k));
    }
    return ulps < quick_ulps;
}

// Where sums a + alpha (b - a) can have a quotient that is no normal float: for alphas in (0, last], or all where that is 2; 0
// where they cannot. Where no end is 0 a sum is 0 or more than 2^-51 of lesser^2 / larger: alpha is then no less than a half of
// their ratio, or the sum more than half of a.
inline double last_subnormal_alpha(double a, double b, double least_normal) noexcept {
    const double lesser = smaller(std::fabs(a), std::fabs(b));
    const double larger_one = larger(std::fabs(a), std::fabs(b));
    if (!(larger_one > 0.0)) return 0.0;
    if (a == 0.0) return smaller(2.5 * least_normal / larger_one, 2.0);
    const double least = lesser == 0.0 ? 0x1p-24 * larger_one : 0x1p-52 * lesser * (lesser / larger_one);
    return least >= least_normal ? 0.0 : 2.0;
}
inline double last_subnormal_alpha(const SegmentJob& job) noexcept {
    const double least_normal = 0x1p-126 * larger(job.q_a, job.q_b);
    double last = 0.0;
    for (int k = 0; k < job.numerators; ++k)
        last = larger(last, last_subnormal_alpha(job.a[k], job.b[k], least_normal));
    return last;
}

// The same of the quotients of two sums. A division that two vectors share rounds four times.
inline bool is_quick_by_sums(const SegmentJob& job, double& ulps) noexcept {
    ulps = 0.0;
    for (int k = 0; k < job.numerators; ++k) ulps = larger(ulps, ulps_of_sum(job.a[k], job.b[k]));
    ulps += ulps_of_sum(job.q_a, job.q_b) + 4.0;
    return ulps < quick_ulps && job.small_alpha < 2.0f;
}

// Whether a tolerance accepts quotients in double of no more than `largest`, rounded to float.
inline bool accepts_rounding(double largest, double tolerance) noexcept {
    return unit_roundoff_float * 1.001 * largest <= tolerance;
}

// What fill_in_double needs, and small_alpha; whether it is worth a try.
inline bool prepare_in_double(SegmentJob& job, double tolerance) noexcept {
    const bool is_in_front = job.q_a > 0.0 && job.q_b > 0.0;
    const EndQuotients u(job);
    double ulps = 0.0;
    prepare_asymptote(job);
    job.is_asymptotic = is_in_front && is_quick_about_asymptote(job, u, ulps);
    job.small_alpha = 0.0f;
    if (!job.is_asymptotic) {
        job.small_alpha = static_cast<float>(last_subnormal_alpha(job));
        if (!is_in_front || !is_quick_by_sums(job, ulps)) return false;
        job.pole = job.q_a;
        job.bend = job.q_b - job.q_a;
        for (int k = 0; k < job.numerators; ++k) {
            job.base[k] = job.a[k] + 0.0;
            job.slope[k] = job.b[k] - job.a[k];
        }
    }
    job.ulps = static_cast<std::int32_t>(std::bit_ceil(static_cast<std::uint32_t>(ulps) + 8)) - 1;
    job.are_accepted = true;
    for (int k = 0; k < job.numerators; ++k)
        job.are_accepted = job.are_accepted && accepts_rounding(u.largest(k), tolerance);
    return true;
}

// What fill_exact needs. The terms of a mixture in two doubles are multiples of alpha's last bit times that of the lesser end,
// 2^-48 of their product at least: where alpha is not too small, what the first sum leaves and the rest need no more than 53
// bits above that.
inline void prepare_exact(SegmentJob& job) noexcept {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    double inexact = 0.0;
    job.are_short = true;
    const auto mixed_exactly = [&](double a, double b) {
        const Mixture mixture = mixture_of(a, b);
        if (mixture.kind == Mixture::is_short) return mixture;
        job.are_short = false;
        inexact = larger(inexact, 0x1p-54 * larger(std::fabs(a), std::fabs(b)) / smaller(std::fabs(a), std::fabs(b)));
        return mixture;
    };
    job.q = is_finite(job.q_a + job.q_b) ? mixed_exactly(job.q_a, job.q_b) : Mixture{nan, nan, 0.0, Mixture::is_short};
    for (int k = 0; k < job.numerators; ++k) job.numerator[k] = mixed_exactly(job.a[k], job.b[k]);
    // As a float it has the same floats below it.
    job.inexact_alpha = static_cast<float>(smaller(inexact, 2.0));
}

inline namespace TEXGEN_BUILD {

// The nearest floats from `first` on: by quotients in double; where those decide nothing in two doubles, with the rest of sixteen
// blocks; what that cannot decide value by value.
inline void interpolate_in_double(const SegmentKernels& kernels, SegmentJob& job, std::size_t first,
                                  double tolerance) noexcept {
    constexpr std::size_t part = 16 * exact_block;
    const bool is_quick = prepare_in_double(job, tolerance);
    const std::size_t count = job.count;
    bool is_prepared = false;
    for (std::size_t i = first; i < count;) {
        if (is_quick) i = kernels.fill_in_double(job, i);
        if (i == count) return;
        if (!is_prepared) prepare_exact(job);
        is_prepared = true;
        if (is_quick && count - i > part) job.count = (i / part + 1) * part;
        fill_blocks(kernels.fill_exact, job, i, interpolate_one);
        i = job.count;
        job.count = count;
    }
}

// Whether the error of a form in float is inside the tolerance; false where it is NaN.
template <class Error>
inline bool float_fits(const Error& error, const SegmentJob& job, const EndQuotients& u, double tolerance) noexcept {
    for (int k = 0; k < job.numerators; ++k)
        if (!(error(job, u, k) <= tolerance)) return false;
    return true;
}

// In float where that stays inside the tolerance for the whole segment, else in double.
inline void interpolate_job(const SegmentKernels& kernels, SegmentJob& job, double tolerance) noexcept {
    if (!(tolerance > 0.0 && job.q_a > 0.0 && job.q_b > 0.0)) return interpolate_in_double(kernels, job, 0, tolerance);
    const EndQuotients u(job);
    prepare_asymptote(job);
    job.is_asymptotic = float_fits(asymptote_error_in_float, job, u, tolerance);
    if (!job.is_asymptotic) {
        if (!float_fits(end_error_in_float, job, u, tolerance))
            return interpolate_in_double(kernels, job, 0, tolerance);
        prepare_end(job, u);
    }
    for (std::size_t i = kernels.fill_all_float(job, 0); i < job.count; i = kernels.fill_all_float(job, i)) {
        SegmentJob block = job;
        block.count = job.count - i < float_block ? job.count : i + float_block;
        interpolate_in_double(kernels, block, i, tolerance);
        i = block.count;
    }
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {
inline namespace TEXGEN_COMPILER {

inline Work work(const Segment& segment, TextureRegion region, Tolerance tolerance) noexcept {
    const glm::dvec4 a = detail::widened(segment.a);
    const glm::dvec4 b = detail::widened(segment.b);
    if (!detail::is_finite(a.x + a.y + a.w) || !detail::is_finite(b.x + b.y + b.w)) return Work::divide_and_test;
    if (a.w <= 0.0 && b.w <= 0.0) return Work::nothing;

    const detail::LitTest sides(region);
    const double accepted = detail::accepted(tolerance);
    const Coverage of_st = detail::st_coverage(detail::segment_corners(a, b, 0, 1), sides, accepted);
    const Coverage of_r = detail::depth_coverage(segment, sides, accepted);
    if (of_st == Coverage::outside || of_r == Coverage::outside) return Work::nothing;
    if (a.w == b.w) return Work::affine;
    const bool all_inside = of_st == Coverage::inside && of_r == Coverage::inside;
    return all_inside ? Work::divide : Work::divide_and_test;
}

inline glm::dvec2 error_bound(const Segment& segment, Tolerance tolerance) noexcept {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    detail::SegmentJob job = detail::segment_job(segment, 0, 2);
    const double sum = job.a[0] + job.a[1] + job.b[0] + job.b[1] + job.q_a + job.q_b;
    if (!detail::is_finite(sum)) return {infinity, infinity};
    if (job.q_a <= 0.0 && job.q_b <= 0.0) return {0.0, 0.0};
    if (job.q_a <= 0.0 || job.q_b <= 0.0) return {infinity, infinity};
    const detail::EndQuotients u(job);
    detail::prepare_asymptote(job);
    const auto bound = [&](int k) {
        const double rounded = detail::half_ulp(1.001 * u.largest(k)), accepted = detail::accepted(tolerance);
        double largest = detail::accepts_rounding(u.largest(k), accepted) ? 1.001 * rounded : rounded;
        // Where both are next to one another, a file with other flags may have decided otherwise.
        for (const double error : {detail::asymptote_error_in_float(job, u, k), detail::end_error_in_float(job, u, k)})
            if (error * (1.0 - 0x1p-40) <= accepted) largest = detail::larger(largest, error);
        return largest;
    };
    return {bound(0), bound(1)};
}

}  // namespace TEXGEN_COMPILER

inline namespace TEXGEN_BUILD {

template <class CompiledWhereCalled>
void interpolate(const Segment& segment, std::span<const float> alpha, TextureRegion region, Texcoords out,
                 Tolerance tolerance) noexcept {
    for ([[maybe_unused]] const float a : alpha) TEXGEN_ASSERT(!(a < 0.0f) && !(a > 1.0f));
    const double accepted = detail::accepted(tolerance);
    const detail::SegmentKernels& kernels = detail::chosen<detail::SegmentKernels>();
    detail::LitTest lit(region);
    if (lit.has_depth() && detail::depth_coverage(segment, lit, accepted) == Coverage::inside) lit.drop_depth();
    detail::for_each_group(out, alpha.size(), lit, [&](int first, int numerators, const detail::PointOutputs& outputs) {
        detail::SegmentJob job = detail::segment_job(segment, first, numerators);
        lit.copy_to(job.min, job.max);
        const auto run = [&](detail::SegmentJob& part) { detail::interpolate_job(kernels, part, accepted); };

        const std::size_t whole = alpha.size() / detail::point_quantum * detail::point_quantum;
        job.alpha = alpha.data();
        if (whole != 0) detail::run_batch(job, outputs, {0, whole, whole}, run);
        const std::size_t rest = alpha.size() - whole;
        if (rest == 0) return;
        float padded[detail::point_quantum];
        for (std::size_t i = 0; i < detail::point_quantum; ++i) padded[i] = alpha[whole + (i < rest ? i : rest - 1)];
        job.alpha = padded;
        detail::run_batch(job, outputs, {whole, rest, detail::point_quantum}, run);
    });
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_NAMESPACE
