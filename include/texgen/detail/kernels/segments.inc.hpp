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

TEXGEN_INLINE LongWords are_among(const double (&range)[2], const Doubles& alpha) noexcept {
    return greater(alpha, range[0]) & ~greater(alpha, range[1]);
}
// Whether one of these alphas is in one of the job's ranges. As a float the end of a range has the same floats below it.
TEXGEN_INLINE bool has_small_alpha(const SegmentJob& job, std::size_t begin, std::size_t end) noexcept {
    if (job.subnormal_alpha[0] < 0.0) return true;
    const auto last = static_cast<float>(smaller(larger(job.subnormal_alpha[1], job.inexact_alpha[1]), 2.0));
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

// The float next to the middle of two in the direction of a remainder, the even one where that is 0; elsewhere the nearest.
TEXGEN_INLINE Floats rounded_from(const Doubles& middle, const Doubles& remainder, const LongWords& are_near) noexcept {
    const Doubles away = with_sign_of(magnitude(middle) * 0x1p-51, remainder);
    return to_floats(middle + where(are_near & are_nonzero(remainder), away));
}

// The floats nearest to s / q in the lanes that are near the middle of two floats, of the quotient in double elsewhere. There
// the sign of s - middle q decides, which is exact where q.low is 0 and the sums are.
TEXGEN_INLINE Floats nearest_quotients(const ExactSum& s, const ExactSum& q, const Doubles& quotient,
                                       const LongWords& are_near) noexcept {
    const Doubles middle = select(are_near, middle_near(quotient), quotient);
    return rounded_from(middle, small_difference(s, q, middle), are_near);
}

// The same where a float may be subnormal, q.low is not 0, or sums are off. `known` loses the lanes where it decides nothing.
TEXGEN_INLINE Floats nearest_quotients(const ExactSum& s, const ExactSum& q, const Doubles& quotient,
                                       const LongWords& are_near, const Doubles& s_lost, const Doubles& q_lost,
                                       LongWords& known) noexcept {
    const Doubles error = quotient * 0x1p-50;
    const Doubles low = to_doubles(to_floats(quotient - error)), high = to_doubles(to_floats(quotient + error));
    const Doubles middle = select(greater(magnitude(quotient), 0x1p-125),
                                  select(are_near, middle_near(quotient), quotient), low * 0.5 + high * 0.5);
    const Doubles last_product = middle * q.low;
    const Doubles remainder = small_difference(s, q, middle) - last_product;
    const Doubles lost = s_lost + magnitude(middle) * q_lost + magnitude(last_product) * 0x1p-51;
    known &= ~are_near | at_most(lost * 2.0, magnitude(remainder));
    return rounded_from(middle, remainder, are_near);
}

// Blocks, on both sides of the projector, up to the first with values that stay in doubt.
template <std::size_t Numerators, bool AreShort>
TEXGEN_APART Undecided fill_segment_closely(const SegmentJob& original, std::size_t begin, std::size_t end,
                                            bool has_small) noexcept {
    const SegmentJob job = original;
    std::uint64_t doubtful = 0;
    for (std::size_t i = begin; i < end; i += static_cast<std::size_t>(lanes)) {
        if (i % exact_block == 0) {
            if (doubtful != 0) break;
            begin = i;
        }
        const Doubles alpha = to_doubles(load<Floats>(job.alpha + i));
        const ExactSum q = exactly_at<AreShort>(job.q, alpha);
        const LongWords in_front = greater(q.high, 0.0);
        const Doubles reciprocal = 1.0 / q.high;
        ExactSum s[2];
        Doubles quotient[2];
        LongWords are_near[2], any_near{};
        TEXGEN_UNROLL
        for (std::size_t k = 0; k < Numerators; ++k) {
            s[k] = exactly_at<AreShort>(job.numerator[k], alpha);
            quotient[k] = where(in_front, s[k].high * reciprocal);
            are_near[k] = are_near_middles(quotient[k], 7);
            any_near |= are_near[k];
        }
        std::uint64_t near_bits = lane_bits(any_near);
        LongWords are_small{}, known = ~LongWords{};
        if (has_small) {
            are_small = are_among(job.subnormal_alpha, alpha);
            near_bits |= lane_bits(are_small);
        }
        Floats value[2];
        if (near_bits == 0) {
            TEXGEN_UNROLL
            for (std::size_t k = 0; k < Numerators; ++k) value[k] = to_floats(quotient[k]);
        } else if (!has_small && (near_bits & lane_bits(are_nonzero(q.low))) == 0) {
            TEXGEN_UNROLL
            for (std::size_t k = 0; k < Numerators; ++k)
                value[k] = nearest_quotients(s[k], q, quotient[k], are_near[k]);
        } else {
            const Doubles q_lost = lost_at(job.q, alpha);
            TEXGEN_UNROLL
            for (std::size_t k = 0; k < Numerators; ++k)
                value[k] = nearest_quotients(s[k], q, quotient[k], are_near[k] | are_small,
                                             lost_at(job.numerator[k], alpha), q_lost, known);
            doubtful |= (near_bits & ~lane_bits(known)) << (i - begin);
        }
        store_points(job, i, Numerators, value, narrow(in_front));
    }
    return doubtful != 0 ? Undecided{begin, doubtful} : Undecided{end, 0};
}

TEXGEN_INLINE std::size_t end_of_blocks(const SegmentJob& job, std::size_t begin, std::size_t blocks) noexcept {
    const std::size_t size = blocks * exact_block;
    const std::size_t next = (begin / size + 1) * size;
    return next < job.count ? next : job.count;
}

// base + alpha (step + rest) in double, two vectors by one division, all of it in front. Returns where the first block begins
// that has a quotient near the middle of two floats, or an alpha that is no number or too small (it is written all the same),
// or the last.
template <std::size_t Numerators>
TEXGEN_INLINE std::size_t fill_segment_quickly(const SegmentJob& job, std::size_t begin, std::size_t last,
                                               bool has_small) noexcept {
    const double q_step = job.q.step + job.q.rest;
    double step[2];
    TEXGEN_UNROLL
    for (std::size_t k = 0; k < Numerators; ++k) step[k] = job.numerator[k].step + job.numerator[k].rest;
    while (begin < last) {
        const std::size_t end = end_of_blocks(job, begin, 1);
        LongWords doubt{};
        Doubles sum{};
        for (std::size_t i = begin; i < end; i += 2 * static_cast<std::size_t>(lanes)) {
            Doubles alpha[2], q[2];
            TEXGEN_UNROLL
            for (std::size_t j = 0; j < 2; ++j) {
                alpha[j] = to_doubles(load<Floats>(job.alpha + i + j * static_cast<std::size_t>(lanes)));
                q[j] = alpha[j] * q_step + job.q.base;
                if (has_small) doubt |= are_among(job.subnormal_alpha, alpha[j]);
            }
            const Doubles of_both = 1.0 / (q[0] * q[1]);
            sum = sum + of_both;
            TEXGEN_UNROLL
            for (std::size_t j = 0; j < 2; ++j) {
                const Doubles reciprocal = of_both * q[1 - j];
                Floats value[2];
                TEXGEN_UNROLL
                for (std::size_t k = 0; k < Numerators; ++k) {
                    const Doubles quotient = (alpha[j] * step[k] + job.numerator[k].base) * reciprocal;
                    doubt |= are_near_middles(quotient, job.ulps[k]);
                    value[k] = to_floats(quotient);
                }
                store_points(job, i + j * static_cast<std::size_t>(lanes), Numerators, value, ~Words{});
            }
        }
        if (any(doubt | ~at_most(sum, sum))) return begin;
        begin = end;
    }
    return last;
}

// Quickly, and what that leaves in doubt closely, with the rest of eight blocks.
template <std::size_t Numerators>
TEXGEN_INLINE Undecided fill_segment_exact_of(const SegmentJob& original, std::size_t first) noexcept {
    const SegmentJob job = original;
    for (std::size_t begin = first; begin < job.count;) {
        const bool is_first_of_eight = begin / exact_block % 8 == 0;
        const std::size_t end = end_of_blocks(job, begin, 8);
        const bool has_small = has_small_alpha(job, begin, end);
        if (job.is_quick && is_first_of_eight) begin = fill_segment_quickly<Numerators>(job, begin, end, has_small);
        if (begin == end) continue;
        const Undecided left = job.are_short ? fill_segment_closely<Numerators, true>(original, begin, end, has_small)
                                             : fill_segment_closely<Numerators, false>(original, begin, end, has_small);
        if (left.values != 0) return left;
        begin = end;
    }
    return {job.count, 0};
}

template <class CompiledWhereCalled = void>
Undecided fill_segment_exact(const SegmentJob& job, std::size_t first) noexcept {
    return job.numerators == 2 ? fill_segment_exact_of<2>(job, first) : fill_segment_exact_of<1>(job, first);
}

// In float about one end, two vectors by one division, so that an alpha that is no number spoils its neighbour: its block
// is left to fill_exact.
template <std::size_t Numerators>
TEXGEN_INLINE std::size_t fill_segment_all_float_of(const SegmentJob& job, std::size_t first) noexcept {
    // alpha, or 1 - alpha.
    const WideFloats start = WideFloats{} + (job.about_b ? 1.0f : 0.0f);
    const float direction = job.about_b ? -1.0f : 1.0f;
    const auto store_value = [&job](std::size_t i, const WideFloats& step) {
        WideFloats value[2];
        for (std::size_t k = 0; k < Numerators; ++k) value[k] = step * job.slope[k] + job.base[k];
        store_points(job, i, Numerators, value, ~WideWords{});
    };
    for (std::size_t begin = first; begin < job.count; begin += float_block) {
        const std::size_t end = begin + float_block < job.count ? begin + float_block : job.count;
        WideFloats sum{};
        for (std::size_t i = begin; i < end; i += 2 * static_cast<std::size_t>(wide_lanes)) {
            const std::size_t next = i + static_cast<std::size_t>(wide_lanes);
            const WideFloats from = load<WideFloats>(job.alpha + i) * direction + start;
            const WideFloats next_from = load<WideFloats>(job.alpha + (next < end ? next : i)) * direction + start;
            sum = sum + (from + next_from);
            const WideFloats q = from * job.bend + 1.0f;
            const WideFloats next_q = next_from * job.bend + 1.0f;
            const WideFloats of_both = 1.0f / (q * next_q);
            store_value(i, from * (of_both * next_q));
            if (next < end) store_value(next, next_from * (of_both * q));
        }
        if (largest_lane(magnitude_bits(sum - sum)) != 0) return begin;
    }
    return job.count;
}

template <class CompiledWhereCalled = void>
std::size_t fill_segment_all_float(const SegmentJob& original, std::size_t first) noexcept {
    const SegmentJob job = original;
    return job.numerators == 2 ? fill_segment_all_float_of<2>(job, first) : fill_segment_all_float_of<1>(job, first);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
