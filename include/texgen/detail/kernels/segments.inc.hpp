// The inner loops of segments. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// A number as an unevaluated sum of two doubles, exactly; high is the nearest double.
struct ExactSum {
    Doubles high, low;
};

// Exactly, but where an alpha is among inexact_alpha. The first term is a multiple of the second's ulp, so that the quick sum
// is exact too, but where the ends are far apart.
template <bool IsShort>
TEXGEN_INLINE ExactSum exactly_at(const Mixture& mixture, const Doubles& alpha) noexcept {
    ExactSum sum;
    const Doubles part = alpha * mixture.step;
    sum.high = part + mixture.base;
    sum.low = part - (sum.high - mixture.base);
    if (IsShort || mixture.kind == Mixture::is_short) return sum;
    if (mixture.kind == Mixture::is_not_finite) return {(1.0 - alpha) * mixture.base + part, Doubles{}};
    if (mixture.kind == Mixture::is_far) sum.high = two_sum(Doubles{} + mixture.base, part, sum.low);
    sum.high = quick_two_sum(sum.high, sum.low + alpha * mixture.rest, sum.low);
    return sum;
}

// What that is off by at most.
TEXGEN_INLINE Doubles lost_at(const Mixture& mixture, const Doubles& alpha) noexcept {
    if (mixture.kind == Mixture::is_short || mixture.kind == Mixture::is_not_finite) return Doubles{};
    Doubles low, lost;
    two_sum(Doubles{} + mixture.base, alpha * mixture.step, low);
    two_sum(low, alpha * mixture.rest, lost);
    return magnitude(lost);
}

// Whether one of these alphas is in (0, last].
TEXGEN_INLINE bool has_small_alpha(const SegmentJob& job, std::size_t begin, std::size_t end, float last) noexcept {
    if (!(last > 0.0f)) return false;
    WideWords are{};
    for (std::size_t i = begin; i < end; i += static_cast<std::size_t>(wide_lanes)) {
        const auto alpha = load<WideFloats>(job.alpha + i);
        are |= less(WideFloats{}, alpha) & at_most(alpha, WideFloats{} + last);
    }
    return any(are);
}

// s - middle q but for middle q.low, where both products are about the same.
TEXGEN_INLINE Doubles small_difference(const ExactSum& s, const ExactSum& q, const Doubles& middle) noexcept {
    const Doubles q_part = leading_bits<27>(q.high);
    return ((s.high - middle * q_part) - middle * (q.high - q_part)) + s.low;
}

// The float next to the middle of two in the direction of a remainder, the even one where that is 0.
TEXGEN_INLINE Floats rounded_from(const Doubles& middle, const Doubles& remainder) noexcept {
    const Doubles away = with_sign_of(magnitude(middle) * 0x1p-51, remainder);
    return to_floats(middle + where(are_nonzero(remainder), away));
}

// The middle of the two floats next to a quotient that may be subnormal, or the only one.
TEXGEN_INLINE Doubles middle_of_floats(const Doubles& quotient) noexcept {
    const Doubles error = quotient * 0x1p-50;
    return to_doubles(to_floats(quotient - error)) * 0.5 + to_doubles(to_floats(quotient + error)) * 0.5;
}

// Blocks end at multiples of their size.
TEXGEN_INLINE std::size_t end_of_block(const DividedOutput& output, std::size_t begin, std::size_t size) noexcept {
    const std::size_t next = (begin / size + 1) * size;
    return next < output.count ? next : output.count;
}

// Blocks, on both sides of the projector, up to the first with values that stay in doubt.
template <std::size_t Numerators, bool AreShort>
TEXGEN_INLINE Undecided fill_segment_closely(const SegmentJob& original, std::size_t first) noexcept {
    constexpr auto width = static_cast<std::size_t>(lanes);
    const SegmentJob job = original;
    std::size_t begin = first, end = first;
    bool has_inexact = false, has_subnormal = false;
    std::uint64_t doubtful = 0;
    for (std::size_t i = first; i < job.count; i += width) {
        if (i % exact_block == 0) {
            if (doubtful != 0) break;
            begin = i;
        }
        if (i == end) {
            end = end_of_block(job, i, float_block);
            has_inexact = !AreShort && has_small_alpha(job, i, end, job.inexact_alpha);
            has_subnormal = has_small_alpha(job, i, end, job.small_alpha);
        }
        const Doubles alpha = to_doubles(load<Floats>(job.alpha + i));
        const ExactSum q = exactly_at<AreShort>(job.q, alpha);
        const LongWords in_front = greater(q.high, 0.0);
        const Doubles reciprocal = 1.0 / q.high;
        ExactSum s[2];
        Doubles quotient[2];
        LongWords are_near[2], are_small{}, any_near{};
        TEXGEN_UNROLL
        for (std::size_t k = 0; k < Numerators; ++k) {
            s[k] = exactly_at<AreShort>(job.numerator[k], alpha);
            quotient[k] = where(in_front, s[k].high * reciprocal);
            are_near[k] = are_near_middles(quotient[k], 7);
            if (has_subnormal) {
                const LongWords is_small =
                    at_most(magnitude(quotient[k]), Doubles{} + 0x1p-125) & are_nonzero(quotient[k]);
                are_small |= is_small;
                are_near[k] |= is_small;
            }
            any_near |= are_near[k];
        }
        const std::uint64_t near_bits = lane_bits(any_near);
        Floats value[2];
        if (near_bits == 0) {
            TEXGEN_UNROLL
            for (std::size_t k = 0; k < Numerators; ++k) value[k] = to_floats(quotient[k]);
        } else if (!has_inexact && (near_bits & lane_bits(are_small | are_nonzero(q.low))) == 0) {
            // The sign of s - middle q decides everywhere, and is exact near the middle, as q.low is 0 and the sums are exact.
            // What is 0 becomes so little that its float is 0, and no subnormal double, which takes long.
            TEXGEN_UNROLL
            for (std::size_t k = 0; k < Numerators; ++k) {
                const Doubles middle = middle_near(quotient[k] + 0x1p-900);
                value[k] = job.numerator[k].kind == Mixture::is_not_finite
                               ? to_floats(quotient[k])
                               : rounded_from(middle, small_difference(s[k], q, middle));
            }
        } else {
            LongWords known = ~LongWords{};
            const Doubles q_lost = has_inexact ? lost_at(job.q, alpha) : Doubles{};
            TEXGEN_UNROLL
            for (std::size_t k = 0; k < Numerators; ++k) {
                const Doubles s_lost = has_inexact ? lost_at(job.numerator[k], alpha) : Doubles{};
                const Doubles middle = select(are_small, middle_of_floats(quotient[k]),
                                              select(are_near[k], middle_near(quotient[k]), quotient[k]));
                const Doubles last_product = middle * q.low;
                const Doubles remainder = small_difference(s[k], q, middle) - last_product;
                const Doubles lost = s_lost + magnitude(middle) * q_lost + magnitude(last_product) * 0x1p-51;
                known &= ~are_near[k] | at_most(lost * 2.0, magnitude(remainder));
                value[k] = rounded_from(middle, where(are_near[k], remainder));
            }
            doubtful |= lane_bits(~known) << (i - begin);
        }
        store_points(job, i, Numerators, value, narrow(in_front));
    }
    return doubtful != 0 ? Undecided{begin, doubtful} : Undecided{job.count, 0};
}

template <class CompiledWhereCalled = void>
Undecided fill_segment_exact(const SegmentJob& job, std::size_t first) noexcept {
    if (job.numerators == 2)
        return job.are_short ? fill_segment_closely<2, true>(job, first) : fill_segment_closely<2, false>(job, first);
    return job.are_short ? fill_segment_closely<1, true>(job, first) : fill_segment_closely<1, false>(job, first);
}

// Two vectors by one division, all of it in front: an alpha that is no number spoils its neighbour. The divisions of a block go
// first: they take long, and what waits for one has little room to wait in.
template <std::size_t Numerators, bool IsAsymptotic>
TEXGEN_INLINE std::size_t fill_segment_in_double_of(const SegmentJob& job, std::size_t first) noexcept {
    const DividedOutput output = job;
    const float* const from = job.alpha;
    const double pole = job.pole, bend = job.bend;
    const double base[2] = {job.base[0], job.base[1]}, slope[2] = {job.slope[0], job.slope[1]};
    const std::int32_t ulps = job.ulps;
    const bool are_accepted = job.are_accepted;
    constexpr auto width = static_cast<std::size_t>(lanes);
    Doubles reciprocal[float_block / width];
    for (std::size_t begin = first; begin < output.count;) {
        const std::size_t end = end_of_block(output, begin, float_block);
        if (has_small_alpha(job, begin, end, job.small_alpha)) return begin;
        WideWords distance = WideWords{} + 0x7fffffff;
        Doubles sum{};
        Doubles* next = reciprocal;
        for (std::size_t i = begin; i < end; i += 2 * width) {
            Doubles q[2];
            TEXGEN_UNROLL
            for (std::size_t j = 0; j < 2; ++j) {
                const Doubles alpha = to_doubles(load<Floats>(from + i + j * width));
                q[j] = IsAsymptotic ? alpha + pole : alpha * bend + pole;
            }
            const Doubles product = q[0] * q[1];
            const Doubles of_both = 1.0 / product;
            sum = sum + product;
            *next++ = of_both * q[1];
            *next++ = of_both * q[0];
        }
        next = reciprocal;
        for (std::size_t i = begin; i < end; i += width) {
            const Doubles of_q = *next++;
            const Doubles alpha = IsAsymptotic ? Doubles{} : to_doubles(load<Floats>(from + i));
            Doubles quotient[2];
            Floats value[2];
            TEXGEN_UNROLL
            for (std::size_t k = 0; k < Numerators; ++k) {
                quotient[k] = IsAsymptotic ? of_q * slope[k] + base[k] : (alpha * slope[k] + base[k]) * of_q;
                value[k] = to_floats(quotient[k]);
            }
            distance = minimum(distance, distances_from_middles(quotient[0], quotient[Numerators - 1], ulps));
            store_points(output, i, Numerators, value, ~Words{});
        }
        if ((!are_accepted && any(equal(distance, 0))) || any(~at_most(sum - sum, Doubles{}))) return begin;
        begin = end;
    }
    return output.count;
}

template <class CompiledWhereCalled = void>
std::size_t fill_segment_in_double(const SegmentJob& job, std::size_t first) noexcept {
    if (job.numerators == 2)
        return job.is_asymptotic ? fill_segment_in_double_of<2, true>(job, first)
                                 : fill_segment_in_double_of<2, false>(job, first);
    return job.is_asymptotic ? fill_segment_in_double_of<1, true>(job, first)
                             : fill_segment_in_double_of<1, false>(job, first);
}

// The same in float, its block left to others.
template <std::size_t Numerators, bool IsAsymptotic>
TEXGEN_INLINE std::size_t fill_segment_all_float_of(const SegmentJob& job, std::size_t first) noexcept {
    const DividedOutput output = job;
    const float* const from = job.alpha;
    constexpr auto width = static_cast<std::size_t>(wide_lanes);
    const auto pole = static_cast<float>(job.pole), bend = static_cast<float>(job.bend);
    const float base[2] = {static_cast<float>(job.base[0]), static_cast<float>(job.base[1])};
    const float slope[2] = {static_cast<float>(job.slope[0]), static_cast<float>(job.slope[1])};
    // alpha, or 1 - alpha.
    const float start = job.about_b ? 1.0f : 0.0f, direction = job.about_b ? -1.0f : 1.0f;
    const auto load_alpha = [&](std::size_t i) {
        const auto alpha = load<WideFloats>(from + i);
        return IsAsymptotic ? alpha : alpha * direction + start;
    };
    const auto store_value = [&](std::size_t i, const WideFloats& alpha, const WideFloats& reciprocal) {
        const WideFloats step = IsAsymptotic ? reciprocal : alpha * reciprocal;
        WideFloats value[2];
        for (std::size_t k = 0; k < Numerators; ++k) value[k] = step * slope[k] + base[k];
        store_points(output, i, Numerators, value, ~WideWords{});
    };
    for (std::size_t begin = first; begin < output.count; begin += float_block) {
        const std::size_t end = end_of_block(output, begin, float_block);
        WideFloats sum{};
        for (std::size_t i = begin; i < end; i += 2 * width) {
            const bool is_last = i + width == end;
            const WideFloats alpha = load_alpha(i), next_alpha = load_alpha(is_last ? i : i + width);
            const WideFloats q = IsAsymptotic ? alpha + pole : alpha * bend + pole;
            const WideFloats next_q = IsAsymptotic ? next_alpha + pole : next_alpha * bend + pole;
            const WideFloats product = q * next_q;
            sum = sum + product;
            const WideFloats of_both = 1.0f / product;
            store_value(i, alpha, of_both * next_q);
            if (!is_last) store_value(i + width, next_alpha, of_both * q);
        }
        if (largest_lane(magnitude_bits(sum - sum)) != 0) return begin;
    }
    return output.count;
}

template <class CompiledWhereCalled = void>
std::size_t fill_segment_all_float(const SegmentJob& job, std::size_t first) noexcept {
    if (job.numerators == 2)
        return job.is_asymptotic ? fill_segment_all_float_of<2, true>(job, first)
                                 : fill_segment_all_float_of<2, false>(job, first);
    return job.is_asymptotic ? fill_segment_all_float_of<1, true>(job, first)
                             : fill_segment_all_float_of<1, false>(job, first);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
