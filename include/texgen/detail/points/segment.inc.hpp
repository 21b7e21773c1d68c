// The bodies of segment.hpp: the values' bounds, and the segment from one tier to the next.

namespace TEXGEN_DETAIL {

// The exact value at alpha, A - alpha A + alpha B, of the floats that are given.
inline Expansion<5> exactly_mixed(double a, double b, double alpha) noexcept {
    Expansion<5> sum;
    sum.add(a);
    sum.add_product(-alpha, a);
    sum.add_product(alpha, b);
    return sum;
}

// The value at alpha in double: 1 - alpha, the products and the sum are rounded once each.
inline Bounded mixed(double a, double b, double alpha) noexcept {
    const double from_a = (1.0 - alpha) * a, from_b = alpha * b;
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

// Whether none is less than 0 or more than 1: a NaN is not.
inline bool are_from_0_to_1(const std::span<const float>& alpha) noexcept {
    const Float4 zero{}, one = zero + 1.0f;
    std::size_t i = 0;
    for (Float4 four; i + 4 <= alpha.size(); i += 4) {
        std::memcpy(&four, alpha.data() + i, sizeof four);
        if (!are_between(four, zero, one)) break;
    }
    for (; i < alpha.size(); ++i)
        if (alpha[i] < 0.0f || alpha[i] > 1.0f) return false;
    return true;
}

// Two coordinates of a tile of one row whose corners are the ends. These are given, and so have no error.
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

inline Coverage depth_coverage(const Segment& segment, LitTest lit, double accepted) noexcept {
    if (!lit.has_depth) return Coverage::inside;
    const glm::dvec4 a = widened(segment.a), b = widened(segment.b);
    if (!is_finite(a.z + a.w) || !is_finite(b.z + b.w)) return Coverage::partial;
    return r_coverage(segment_corners(a, b, 2, 2), lit, accepted);
}

inline Mixture mixture_of(double a, double b) noexcept {
    const DoubleDouble step = two_sum(b, -a);
    if (!is_finite(step.high)) return {a, b, 0.0, Mixture::is_not_finite};
    if (step.low != 0.0)
        return std::fabs(a) < std::fabs(b) ? Mixture{a, b, -a, Mixture::is_far} : Mixture{a, -a, b, Mixture::is_far};
    const double leading = leading_bits<29>(step.high);
    return {a + 0.0, leading, step.high - leading, leading == step.high ? Mixture::is_short : Mixture::is_long};
}

// A bound on the error of the sum a + alpha (b - a) in double, in ulps. That of a short mixture is rounded once; of
// others the step and the product are too, which may be as large as the larger end.
inline double ulps_of_sum(double a, double b) noexcept {
    if (mixture_of(a, b).kind == Mixture::is_short) return 1.0;
    const double ratio = larger(std::fabs(a), std::fabs(b)) / smaller(std::fabs(a), std::fabs(b));
    return a * b > 0.0 && is_finite(ratio) ? 1.0 + 2.0 * ratio : infinity;
}

inline namespace TEXGEN_BUILD {

// Whether quotients about the asymptote are normal floats and within quick_ulps; `ulps` bounds their error.
inline bool bound_about_asymptote(const Asymptote& about, const EndQuotients& u, double& ulps) noexcept {
    const Double2 least = u.least(), error = about.error(u);
    if (!about.is_in_range(u) || !all_less(double2_of(0.0, 0.0), u.at_a * u.at_b) ||
        !all_less(double2_of(0x1p-120, 0x1p-120), least))
        return false;
    ulps = larger(error[0] / least[0], error[1] / least[1]);
    return ulps < quick_ulps;
}

// Returns `last`: only for alphas in (0, last] a sum a + alpha (b - a) can have a quotient that is no normal float; 2
// means all, 0 none. Between ends of one sign a sum is no less than the lesser. Between ends of both signs, neither 0,
// it is 0 or more than 2^-49 of lesser^2 / larger: alpha is then at least half of lesser / larger, or the sum more than
// half of a, and it is a multiple of alpha's last bit, at least 2^-24 alpha, times that of the lesser.
inline double last_subnormal_alpha(double a, double b, double least_normal) noexcept {
    const double lesser = smaller(std::fabs(a), std::fabs(b)), larger_one = larger(std::fabs(a), std::fabs(b));
    if (!(larger_one > 0.0)) return 0.0;
    if (a == 0.0) return smaller(2.5 * least_normal / larger_one, 2.0);
    const double least = a * b > 0.0     ? lesser
                         : lesser == 0.0 ? 0x1p-24 * larger_one
                                         : 0x1p-50 * lesser * (lesser / larger_one);
    return least >= least_normal ? 0.0 : 2.0;
}
inline double last_subnormal_alpha(const SegmentJob& job) noexcept {
    const double least_normal = 0x1p-126 * larger(job.q_a, job.q_b);
    double last = 0.0;
    for (int k = 0; k < job.numerators; ++k)
        last = larger(last, last_subnormal_alpha(job.a[k], job.b[k], least_normal));
    return last;
}

// As bound_about_asymptote(), for quotients of two sums. A division that two vectors share rounds four times.
inline bool bound_by_sums(const SegmentJob& job, double& ulps) noexcept {
    ulps = 0.0;
    for (int k = 0; k < job.numerators; ++k) ulps = larger(ulps, ulps_of_sum(job.a[k], job.b[k]));
    ulps += ulps_of_sum(job.q_a, job.q_b) + 4.0;
    return ulps < quick_ulps && job.small_alpha < 2.0f;
}

// Whether a tolerance accepts quotients in double of no more than `largest`, rounded to float.
inline bool accepts_rounding(double largest, double tolerance) noexcept {
    return unit_roundoff_float * 1.001 * largest <= tolerance;
}

// Sets what fill_in_double needs, and small_alpha. Returns whether it is worth a try.
TEXGEN_APART inline bool prepare_in_double(SegmentJob& job) noexcept {
    const SegmentEnds ends(job);
    const EndQuotients u(ends);
    const Asymptote asymptote(ends, u);
    double ulps = 0.0;
    job.is_asymptotic = ends.are_in_front() && bound_about_asymptote(asymptote, u, ulps);
    job.small_alpha = 0.0f;
    if (job.is_asymptotic) {
        job.pole = asymptote.pole;
        put(job.base, asymptote.base);
        put(job.slope, asymptote.slope);
    } else {
        job.small_alpha = static_cast<float>(last_subnormal_alpha(job));
        if (!ends.are_in_front() || !bound_by_sums(job, ulps)) return false;
        job.pole = job.q_a;
        job.bend = job.q_b - job.q_a;
        put(job.base, ends.a + 0.0);
        put(job.slope, ends.b - ends.a);
    }
    job.ulps = mask_of_ulps(ulps + 6.0);
    job.are_accepted = accepts_rounding(larger_lane(u.largest()), job.tolerance);
    return true;
}

// Sets what fill_all_float needs: the coordinate that steps more, and the other's share of it. False beyond tolerance.
TEXGEN_INLINE bool prepare_in_float(SegmentJob& job, const SegmentEnds& ends, double tolerance) noexcept {
    if (!(tolerance > 0.0 && ends.are_in_front())) return false;
    const EndQuotients u(ends);
    const LesserEnd end(ends, u);
    if (!end.is_in_range(u) || !all_less(end.error(u), double2_of(tolerance, tolerance))) return false;
    job.about_b = end.is_b;
    job.bend = end.bend;
    put(job.base, end.base);
    const bool is_second = magnitude(end.slope[0]) < magnitude(end.slope[1]);
    const double lesser = is_second ? end.slope[0] : end.slope[1];
    job.steeper = is_second ? 1 : 0;
    job.step = is_second ? end.slope[1] : end.slope[0];
    job.share = job.step != 0.0 ? lesser / job.step : 0.0;
    return true;
}

// Sets what the segments' kernels need, but for the alphas and the outputs, for coordinate `first` and the next.
TEXGEN_INLINE void prepare_job(SegmentJob& job, const Segment& segment, int first, int numerators,
                               double tolerance) noexcept {
    const SegmentEnds ends(segment, first, first + numerators - 1);
    job.numerators = numerators;
    put(job.a, ends.a);
    put(job.b, ends.b);
    job.q_a = ends.q_a;
    job.q_b = ends.q_b;
    job.tolerance = tolerance;
    job.is_in_float = prepare_in_float(job, ends, tolerance);
    job.is_quick = !job.is_in_float && prepare_in_double(job);
}

// Sets what fill_exact needs. The terms of a mixture in two doubles are multiples of alpha's last bit times that of the
// lesser end: of at least 2^-48 of alpha times that end. Where alpha is not too small, what the first sum leaves and
// the rest have no more than 53 bits above that.
inline void prepare_exact(SegmentJob& job) noexcept {
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
    // Rounding keeps the order: floats up to the number are up to its float.
    job.inexact_alpha = static_cast<float>(smaller(inexact, 2.0));
}

// Computes the nearest floats from value i on, which quotients in double have not decided: this block and the rest of
// sixteen in two doubles, and value by value what those cannot decide.
inline void interpolate_exactly(const SegmentKernels& kernels, SegmentJob& job, std::size_t i) noexcept {
    constexpr std::size_t part = 16 * exact_block;
    const std::size_t count = job.count;
    prepare_exact(job);
    while (i < count) {
        if (job.is_quick && count - i > part) job.count = (i / part + 1) * part;
        fill_blocks(kernels.fill_exact, job, i, interpolate_one);
        i = job.count;
        job.count = count;
        if (job.is_quick && i < count) i = kernels.fill_in_double(job, i);
    }
}

// Computes the rest of a job whose kernel stopped at value i: in float at a block with an alpha that is not finite.
TEXGEN_APART inline void finish_job(const SegmentKernels& kernels, SegmentJob& job, std::size_t i) noexcept {
    if (!job.is_in_float) return interpolate_exactly(kernels, job, i);
    while (i < job.count) {
        const std::size_t end = job.count - i < float_block ? job.count : i + float_block;
        SegmentJob block = job;
        block.count = end;
        block.is_quick = prepare_in_double(block);
        interpolate_exactly(kernels, block, i);
        i = end == job.count ? end : kernels.fill_all_float(job, end);
    }
}

// In float where that stays inside the tolerance for the whole segment, else in double.
inline void interpolate_job(const SegmentKernels& kernels, SegmentJob& job) noexcept {
    const std::size_t done = job.is_in_float ? kernels.fill_all_float(job, 0)
                             : job.is_quick  ? kernels.fill_in_double(job, 0)
                                             : 0;
    if (done < job.count) finish_job(kernels, job, done);
}

// The last values, fewer than a kernel takes.
TEXGEN_APART void run_rest(SegmentJob& job, const PointOutputs& outputs, const std::span<const float>& alpha,
                           const auto& run) noexcept {
    const std::size_t rest = alpha.size() % point_quantum, first = alpha.size() - rest;
    float padded[point_quantum];
    for (std::size_t i = 0; i < point_quantum; ++i) padded[i] = alpha[first + (i < rest ? i : rest - 1)];
    job.alpha = padded;
    run_part(job, outputs, {first, rest, point_quantum}, run);
}

// Computes values along a segment, one group of coordinates after another.
template <class CompiledWhereCalled = void>
struct SegmentGroups {
    const Segment& segment;
    std::span<const float> alpha;
    const LitTest& lit;
    double accepted;

    TEXGEN_INLINE void operator()(int first, int numerators, const PointOutputs& outputs) const noexcept {
        SegmentJob job;
        prepare_job(job, segment, first, numerators, accepted);
        if (outputs.lit != nullptr) lit.copy_to(job.min, job.max);
        const auto run = [](SegmentJob& part) { interpolate_job(chosen<SegmentKernels>(), part); };
        const auto run_from = [&](std::size_t begin, std::size_t count) {
            job.alpha = alpha.data() + begin;
            if (place(job, outputs, {begin, count, count}))
                run(job);
            else
                run_part(job, outputs, {begin, count, count}, run);
        };
        const std::size_t whole = alpha.size() / point_quantum * point_quantum;
        if (whole != 0) run_from(0, whole);
        if (whole == alpha.size()) return;
        // The last vector begins in the one before, as outputs overlap no alpha. Not that of r: what its first values
        // have darkened would stay dark, and they are to be the same without a mask.
        const bool is_r = first == 2;
        if (whole != 0 && !is_r)
            run_from(alpha.size() - point_quantum, point_quantum);
        else
            run_rest(job, outputs, alpha, run);
    }
};

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE_COMPILER {

inline Work work(const Segment& segment, const TextureRegion& region, const Tolerance& tolerance) noexcept {
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

inline glm::dvec2 error_bound(const Segment& segment, const Tolerance& tolerance) noexcept {
    const double accepted = detail::accepted(tolerance);
    const detail::SegmentEnds st(segment, 0, 1);
    if (!detail::is_finite(st.a[0] + st.a[1] + st.b[0] + st.b[1] + st.q_a + st.q_b))
        return {detail::infinity, detail::infinity};
    if (st.q_a <= 0.0 && st.q_b <= 0.0) return {0.0, 0.0};
    if (!st.are_in_front()) return {detail::infinity, detail::infinity};
    const auto bound = [&](int coordinate) {
        const detail::SegmentEnds ends(segment, coordinate, coordinate);
        const detail::EndQuotients u(ends);
        const double rounded = detail::half_ulp(1.001 * u.largest()[0]);
        double largest = detail::accepts_rounding(u.largest()[0], accepted) ? 1.001 * rounded : rounded;
        const detail::LesserEnd end(ends, u);
        const double error = end.error(u)[0];
        // Where error and tolerance are that close, a file with other flags may have decided otherwise.
        const bool is_in_float = end.is_in_range(u) && error * (1.0 - 0x1p-40) <= accepted;
        return is_in_float ? detail::larger(largest, error) : largest;
    };
    return {bound(0), bound(1)};
}

}  // namespace TEXGEN_NAMESPACE_COMPILER

namespace TEXGEN_NAMESPACE_BUILD {

template <class CompiledWhereCalled>
void interpolate(const Segment& segment, const std::span<const float>& alpha, const TextureRegion& region,
                 const Texcoords& out, const Tolerance& tolerance) noexcept {
    TEXGEN_ASSERT(detail::are_from_0_to_1(alpha));
    const double accepted = detail::accepted(tolerance);
    detail::LitTest lit(out.lit.empty() ? whole_texture() : region);
    if (lit.has_depth && detail::depth_coverage(segment, lit, accepted) == Coverage::inside) lit.has_depth = false;
    detail::for_each_group(out, alpha.size(), lit, detail::SegmentGroups<>{segment, alpha, lit, accepted});
}

}  // namespace TEXGEN_NAMESPACE_BUILD
