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

// The largest |F/Q| of a segment whose ends are in front, where it is at an end.
inline double largest_quotient(const SegmentJob& job, int k) noexcept {
    return 1.001 * larger(std::fabs(job.a[k]) / job.q_a, std::fabs(job.b[k]) / job.q_b);
}

// About the end where q is less, with i the alpha from there, u is exactly
//   u0 + d i / (1 + b i),  b = (Q1 - Q0) / Q0 >= 0,  d = (u1 - u0) Q1 / Q0,
// and the step lies between 0 and u1 - u0. With r = 2^-24: 1 - alpha, b, its product and the sum, the product of two sums,
// its reciprocal, the products with the other sum and with i, d and its product are rounded, 10 r of the step at most; u0 and
// the last sum once each. Infinite where a float could leave its range.
inline double segment_float_error(const SegmentJob& job, int k) noexcept {
    const double u_a = job.a[k] / job.q_a;
    const double u_b = job.b[k] / job.q_b;
    const double size_a = std::fabs(u_a);
    const double size_b = std::fabs(u_b);
    const double largest = larger_or_nan(size_a, size_b);
    const double ratio = larger(job.q_a, job.q_b) / smaller(job.q_a, job.q_b);
    if (!(largest < 0x1p60 && ratio < 0x1p60)) return std::numeric_limits<double>::infinity();
    return 1.001 * unit_roundoff_float * (2.0 * largest + 11.0 * std::fabs(u_a - u_b)) + 0x1p-120;
}

inline void prepare_float(SegmentJob& job) noexcept {
    job.about_b = job.q_b < job.q_a;
    const double q = job.about_b ? job.q_b : job.q_a;
    const double far_q = job.about_b ? job.q_a : job.q_b;
    job.bend = static_cast<float>((far_q - q) / q);
    for (int k = 0; k < job.numerators; ++k) {
        const double u = (job.about_b ? job.b[k] : job.a[k]) / q;
        const double far_u = (job.about_b ? job.a[k] : job.b[k]) / far_q;
        job.base[k] = static_cast<float>(u);
        job.slope[k] = static_cast<float>((far_u - u) * (far_q / q));
    }
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

// What rounding makes of a mixture. Of a short one the sum is rounded in double, and of others the step and the product too,
// which may be as large as the larger end. The terms of one in two doubles are multiples of alpha's last bit times that of the
// lesser end, 2^-48 of their product at least: where alpha is not too small, what the first sum leaves and the rest need no more
// than 53 bits above that.
struct MixtureBounds {
    double ulps = 1.0;           // of the sum in double, if it has one sign
    double inexact_below = 0.0;  // see SegmentJob

    MixtureBounds(const Mixture& mixture, double a, double b) noexcept {
        if (mixture.kind == Mixture::is_short) return;
        const double ratio = larger(std::fabs(a), std::fabs(b)) / smaller(std::fabs(a), std::fabs(b));
        ulps = a * b > 0.0 && is_finite(ratio) ? 1.0 + 2.0 * ratio : std::numeric_limits<double>::infinity();
        inexact_below = 0x1p-54 * ratio;
    }
};

// What the kernels in double need.
inline void prepare_exact(SegmentJob& job) noexcept {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    job.q = is_finite(job.q_a + job.q_b) ? mixture_of(job.q_a, job.q_b) : Mixture{nan, nan, 0.0, Mixture::is_short};
    const MixtureBounds of_q(job.q, job.q_a, job.q_b);
    // A numerator whose quotient is one; where q is not finite all quotients are 0.
    const double least_normal = is_finite(job.q_a + job.q_b) ? 0x1p-126 * larger(job.q_a, job.q_b) : 0.0;
    job.inexact_alpha[0] = 0.0;
    job.inexact_alpha[1] = of_q.inexact_below;
    job.subnormal_alpha[0] = job.subnormal_alpha[1] = 0.0;
    job.are_short = job.q.kind == Mixture::is_short;
    job.is_quick = job.q_a > 0.0 && job.q_b > 0.0;
    for (int k = 0; k < job.numerators; ++k) {
        const double a = job.a[k];
        const double b = job.b[k];
        job.numerator[k] = mixture_of(a, b);
        job.are_short = job.are_short && job.numerator[k].kind == Mixture::is_short;
        const MixtureBounds bounds(job.numerator[k], a, b);
        job.inexact_alpha[1] = larger(job.inexact_alpha[1], bounds.inexact_below);
        // A division that two vectors share rounds four times.
        const double ulps = bounds.ulps + of_q.ulps + 4.0;
        job.is_quick = job.is_quick && ulps < 0x1p14;
        job.ulps[k] = 7;
        while (job.is_quick && job.ulps[k] <= static_cast<std::int32_t>(ulps)) job.ulps[k] = 2 * job.ulps[k] + 1;
        // Where no end is 0 a mixture is 0 or more than 2^-51 of lesser^2 / larger: alpha is then no less than a half of their
        // ratio, or the mixture more than half of a.
        const double lesser = smaller(std::fabs(a), std::fabs(b));
        const double larger_one = larger(std::fabs(a), std::fabs(b));
        if (a == 0.0) {
            if (b != 0.0) job.subnormal_alpha[1] = larger(job.subnormal_alpha[1], 2.0 * least_normal / std::fabs(b));
        } else if (!(b == 0.0 ? 0x1p-24 * larger_one >= least_normal
                              : 0x1p-52 * lesser * lesser >= least_normal * larger_one)) {
            job.subnormal_alpha[0] = -1.0;
            job.subnormal_alpha[1] = 2.0;
            job.is_quick = false;
        }
    }
}

inline namespace TEXGEN_BUILD {

// The nearest floats from `first` on: in vectors; what those cannot decide value by value.
inline void interpolate_exact(const SegmentKernels& kernels, SegmentJob& job, std::size_t first) noexcept {
    prepare_exact(job);
    fill_blocks(kernels.fill_exact, job, first, interpolate_one);
}

// In float where that stays inside the tolerance for the whole segment, else the nearest float.
inline void interpolate_job(const SegmentKernels& kernels, SegmentJob job, double tolerance) noexcept {
    bool float_fits = tolerance > 0.0 && job.q_a > 0.0 && job.q_b > 0.0;
    for (int k = 0; k < job.numerators; ++k) float_fits = float_fits && segment_float_error(job, k) <= tolerance;
    if (!float_fits) return interpolate_exact(kernels, job, 0);
    prepare_float(job);
    const std::size_t count = job.count;
    for (std::size_t i = kernels.fill_all_float(job, 0); i < count; i = kernels.fill_all_float(job, i)) {
        job.count = count - i < float_block ? count : i + float_block;
        interpolate_exact(kernels, job, i);
        i = job.count;
        job.count = count;
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
    const detail::SegmentJob job = detail::segment_job(segment, 0, 2);
    const double sum = job.a[0] + job.a[1] + job.b[0] + job.b[1] + job.q_a + job.q_b;
    if (!detail::is_finite(sum)) return {infinity, infinity};
    if (job.q_a <= 0.0 && job.q_b <= 0.0) return {0.0, 0.0};
    if (job.q_a <= 0.0 || job.q_b <= 0.0) return {infinity, infinity};
    const auto bound = [&](int k) {
        const double of_nearest = detail::half_ulp(detail::largest_quotient(job, k));
        const double of_float = detail::segment_float_error(job, k);
        // Where both are next to one another, a file with other flags may have decided otherwise.
        const bool may_be_float = of_float * (1.0 - 0x1p-40) <= detail::accepted(tolerance);
        return may_be_float ? detail::larger(of_float, of_nearest) : of_nearest;
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
        const auto run = [&](const detail::SegmentJob& part) { detail::interpolate_job(kernels, part, accepted); };

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
