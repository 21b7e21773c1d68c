// The inner loops of segments. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// A sum of two doubles, the second the lesser, and the double nearest to it. Only ties ask for low(), what that leaves.
struct ExactSum {
    Doubles first, second, high;

    TEXGEN_INLINE ExactSum(const Doubles& a, const Doubles& b) noexcept : first(a), second(b), high(a + b) {}

    TEXGEN_INLINE Doubles low() const noexcept { return second - (high - first); }
};

// A mixture in all lanes.
struct MixtureLanes {
    Doubles base, step, rest;
    Mixture::Kind kind;

    TEXGEN_INLINE explicit MixtureLanes(const Mixture& of) noexcept
        : base(Doubles{} + of.base), step(Doubles{} + of.step), rest(Doubles{} + of.rest), kind(of.kind) {}

    // The value, exact but for alphas in (0, inexact_alpha]. The first term is a multiple of the second's ulp, so that
    // the quick sum is exact too, unless the ends are far apart.
    template <bool IsShort>
    TEXGEN_INLINE ExactSum exactly_at(const Doubles& alpha) const noexcept {
        const Doubles part = alpha * step;
        if (IsShort || kind == Mixture::is_short) return {base, part};
        if (kind == Mixture::is_not_finite) return {(1.0 - alpha) * base, part};
        Doubles low;
        const Doubles sum = kind == Mixture::is_far ? two_sum(base, part, low) : quick_two_sum(base, part, low);
        return {sum, low + alpha * rest};
    }

    // The most that exactly_at() is off by.
    TEXGEN_INLINE Doubles lost_at(const Doubles& alpha) const noexcept {
        if (kind == Mixture::is_short || kind == Mixture::is_not_finite) return Doubles{};
        Doubles low, lost;
        two_sum(base, alpha * step, low);
        two_sum(low, alpha * rest, lost);
        return magnitude(lost);
    }
};

// Whether one of these alphas is in (0, last].
TEXGEN_INLINE bool has_small_alpha(const SegmentJob& job, std::size_t begin, std::size_t end, float last) noexcept {
    if (!(last > 0.0f)) return false;
    WideWords are_small{};
    for (std::size_t i = begin; i < end; i += wide_at_once) {
        const auto alpha = load<WideFloats>(job.alpha + i);
        are_small |= less(WideFloats{}, alpha) & at_most(alpha, WideFloats{} + last);
    }
    return any(are_small);
}

// s - middle q.high, where both are about the same.
TEXGEN_INLINE Doubles small_difference(const ExactSum& s, const ExactSum& q, const Doubles& middle) noexcept {
    const Doubles q_part = leading_bits<27>(q.high);
    return ((s.high - middle * q_part) - middle * (q.high - q_part)) + s.low();
}

// The float next to the middle of two in the direction of a remainder, the even one where that is 0; 0 behind.
TEXGEN_INLINE Floats rounded_from(const Doubles& middle, const Doubles& remainder, const LongWords& in_front) noexcept {
    const Doubles away = with_sign_of(magnitude(middle) * 0x1p-51, remainder);
    return to_floats(where(in_front, middle + where(are_nonzero(remainder), away)));
}

// Fills blocks, on either side of the projector, up to the first with values that stay in doubt.
template <std::size_t Numerators, bool AreShort>
Undecided fill_segment_closely(const SegmentJob& job, std::size_t first) noexcept {
    const std::size_t count = job.count;
    const float* const from = job.alpha;
    float* const out[2] = {job.out[0], job.out[Numerators - 1]};
    float* const lit = Numerators == 2 ? job.lit : nullptr;
    const MixtureLanes q_mixture(job.q);
    const MixtureLanes mixture[2] = {MixtureLanes(job.numerator[0]), MixtureLanes(job.numerator[Numerators - 1])};
    const bool is_constant = job.q.kind == Mixture::is_short && job.q.step == 0.0;
    const auto inexact_alpha = widened(job.inexact_alpha);
    const bool are_finite = mixture[0].kind != Mixture::is_not_finite && mixture[1].kind != Mixture::is_not_finite;
    ExactSum q(q_mixture.base, Doubles{});
    Doubles reciprocal = 1.0 / q.high;
    for (std::size_t begin = first; begin < count;) {
        const std::size_t end = end_of_block(count, begin, exact_block);
        const bool has_inexact = !AreShort && has_small_alpha(job, begin, end, job.inexact_alpha);
        const bool has_subnormal = has_small_alpha(job, begin, end, job.small_alpha);
        std::uint64_t doubtful = 0;
        for (std::size_t i = begin; i < end; i += at_once) {
            const Doubles alpha = to_doubles(load<Floats>(from + i));
            if (is_constant) {
                q.high = q_mixture.base + alpha * 0.0;  // no number where alpha is none
            } else {
                q = q_mixture.exactly_at<AreShort>(alpha);
                reciprocal = 1.0 / q.high;
            }
            const LongWords in_front = greater(q.high, 0.0);
            const ExactSum s[2] = {mixture[0].template exactly_at<AreShort>(alpha),
                                   mixture[Numerators - 1].template exactly_at<AreShort>(alpha)};
            Doubles quotient[2];
            Floats value[2];
            TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) quotient[k] = s[k].high * reciprocal + 0x1p-900;
            const Distances distance = nearer(far_from_middles(), quotient[0], quotient[Numerators - 1], 7);
            const bool are_near = any_zero(distance);
            // The lanes where the float may be subnormal and the quotient is next to the middle of two such floats.
            // Elsewhere middle_near() serves: to it the middles of subnormal floats are not middles, but floats.
            LongWords is_small[2] = {};
            bool are_small = false;
            if (has_subnormal) {
                TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k)
                    is_small[k] = at_most(magnitude(quotient[k]), Doubles{} + 0x1p-125);
                if (any(is_small[0] | is_small[Numerators - 1])) {
                    TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) {
                        const Doubles distance_to_it = magnitude(quotient[k] - middle_of_subnormals(quotient[k]));
                        is_small[k] &= at_most(distance_to_it, magnitude(quotient[k]) * 0x1p-48);
                    }
                    are_small = any(is_small[0] | is_small[Numerators - 1]);
                }
            }
            const auto are_exact = [&] {
                if (!has_inexact) return is_constant || !any_nonzero_near(distance, q.low());
                const LongWords is_inexact = at_most(alpha, Doubles{} + inexact_alpha);
                return !any_nonzero_near(distance, select(is_inexact, Doubles{} + 1.0, q.low()));
            };
            if (!are_near && !are_small) {
                TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) value[k] = to_floats(where(in_front, quotient[k]));
            } else if (!are_small && are_finite && are_exact()) {
                // The sign of s - middle q decides everywhere, and is exact near the middle, as q.low() is 0 and the
                // sums are exact.
                TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) {
                    const Doubles middle = middle_near(quotient[k]);
                    value[k] = rounded_from(middle, small_difference(s[k], q, middle), in_front);
                }
            } else {
                LongWords in_doubt{};
                const Doubles q_lost = has_inexact ? q_mixture.lost_at(alpha) : Doubles{};
                TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) {
                    Doubles middle = middle_near(quotient[k]);
                    if (are_small) middle = select(is_small[k], middle_of_subnormals(quotient[k]), middle);
                    const Doubles last_product = middle * q.low();
                    Doubles remainder = small_difference(s[k], q, middle) - last_product;
                    if (!are_finite) {
                        const LongWords is_finite = at_most(quotient[k] - quotient[k], Doubles{});
                        middle = select(is_finite, middle, quotient[k]);
                        remainder = where(is_finite, remainder);
                    }
                    Doubles lost = magnitude(last_product) * 0x1p-50;
                    if (has_inexact) lost = lost + (mixture[k].lost_at(alpha) + magnitude(middle) * q_lost) * 2.0;
                    in_doubt |= greater(lost, magnitude(remainder));
                    value[k] = rounded_from(middle, remainder, in_front);
                }
                doubtful |= lane_bits(in_front & in_doubt) << (i - begin);
            }
            if (lit != nullptr) {
                const Floats ones = to_floats(where(in_front, Doubles{} + 1.0));
                store(lit + i, select(in_region(job, value), ones, Floats{}));
            }
            TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) store(out[k] + i, value[k]);
        }
        if (doubtful != 0) return {begin, doubtful};
        begin = end;
    }
    return {count, 0};
}

template <class CompiledWhereCalled = void>
Undecided fill_segment_exact(const SegmentJob& job, std::size_t first) noexcept {
    if (job.numerators == 2)
        return job.are_short ? fill_segment_closely<2, true>(job, first) : fill_segment_closely<2, false>(job, first);
    return job.are_short ? fill_segment_closely<1, true>(job, first) : fill_segment_closely<1, false>(job, first);
}

// Fills values in front by fill(job, begin, end), which returns the first value that it does not vouch for, or the end;
// and their mask, where one is asked for.
template <class CompiledWhereCalled = void>
TEXGEN_INLINE std::size_t fill_with_mask(std::size_t (*fill)(const SegmentJob&, std::size_t, std::size_t) noexcept,
                                         const SegmentJob& job, std::size_t first) noexcept {
    if (job.lit == nullptr) return fill(job, first, job.count);
    for (std::size_t begin = first; begin < job.count;) {
        const std::size_t end = end_of_block(job.count, begin, float_block);
        if (fill(job, begin, end) != end) return begin;
        light_apart(job.min, job.max, job.out[0] + begin, job.out[1] + begin, job.lit + begin,
                    static_cast<std::int64_t>(end - begin));
        begin = end;
    }
    return job.count;
}

// Two vectors share a division; all values are in front. An alpha that is no number spoils its neighbour, and its block
// is refused. The divisions of a block go first: they take long, and only so much can wait for one.
template <std::size_t Numerators, bool IsAsymptotic>
std::size_t fill_segment_in_double_of(const SegmentJob& job, std::size_t first, std::size_t count) noexcept {
    float* const out[2] = {job.out[0], job.out[Numerators - 1]};
    const float* const from = job.alpha;
    const double pole = job.pole, bend = job.bend;
    const double base[2] = {job.base[0], job.base[1]}, slope[2] = {job.slope[0], job.slope[1]};
    const std::int32_t ulps = job.ulps;
    const bool are_accepted = job.are_accepted;
    Doubles reciprocal[float_block / at_once];
    for (std::size_t begin = first; begin < count;) {
        const std::size_t end = end_of_block(count, begin, float_block);
        if (has_small_alpha(job, begin, end, job.small_alpha)) return begin;
        Distances distance = far_from_middles();
        Doubles sum{};
        Doubles* next = reciprocal;
        for (std::size_t i = begin; i < end; i += 2 * at_once) {
            Doubles q[2];
            TEXGEN_FOR (std::size_t j = 0; j < 2; ++j) {
                const Doubles alpha = to_doubles(load<Floats>(from + i + j * at_once));
                q[j] = IsAsymptotic ? alpha + pole : alpha * bend + pole;
            }
            const SharedDivision division(q[0], q[1]);
            sum = sum + division.product;
            for (const Doubles& of_q : division.reciprocal) *next++ = of_q;
        }
        next = reciprocal;
        for (std::size_t i = begin; i < end; i += at_once) {
            const Doubles of_q = *next++;
            const Doubles alpha = IsAsymptotic ? Doubles{} : to_doubles(load<Floats>(from + i));
            Doubles quotient[2];
            Floats value[2];
            TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) {
                quotient[k] = IsAsymptotic ? of_q * slope[k] + base[k] : (alpha * slope[k] + base[k]) * of_q;
                value[k] = to_floats(quotient[k]);
            }
            distance = nearer(distance, quotient[0], quotient[Numerators - 1], ulps);
            TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) store(out[k] + i, value[k]);
        }
        if ((!are_accepted && any_zero(distance)) || any(~at_most(sum - sum, Doubles{}))) return begin;
        begin = end;
    }
    return count;
}

template <class CompiledWhereCalled = void>
std::size_t fill_segment_in_double(const SegmentJob& job, std::size_t first) noexcept {
    if (job.numerators == 2)
        return fill_with_mask(
            job.is_asymptotic ? fill_segment_in_double_of<2, true> : fill_segment_in_double_of<2, false>, job, first);
    return fill_with_mask(job.is_asymptotic ? fill_segment_in_double_of<1, true> : fill_segment_in_double_of<1, false>,
                          job, first);
}

// The same in float. Two vectors divide the slope of the steeper coordinate, and the step of the other is a share of
// this one's: that is a product less, and fewer sums for compilers to fuse with products, which wait for stores.
template <std::size_t Numerators>
std::size_t fill_segment_all_float_of(const SegmentJob& job, std::size_t first, std::size_t count) noexcept {
    const float* const from = job.alpha;
    const int other = Numerators == 2 ? 1 - job.steeper : 0;
    float* const out = job.out[job.steeper];
    float* const other_out = job.out[other];
    const auto bend = static_cast<float>(job.bend);
    const auto base = static_cast<float>(job.base[job.steeper]), other_base = static_cast<float>(job.base[other]);
    const auto slope = static_cast<float>(job.step), share = static_cast<float>(job.share);
    // alpha, or 1 - alpha.
    const float start = job.about_b ? 1.0f : 0.0f, direction = job.about_b ? -1.0f : 1.0f;
    const auto load_alpha = [&](std::size_t i) { return load<WideFloats>(from + i) * direction + start; };
    WideFloats sum{};
    // An array at a time: stores to one and another in turn take longer where vectors span two lines of a cache.
    const auto fill_both = [&](std::size_t i, std::size_t next) {
        const WideFloats alpha = load_alpha(i), next_alpha = load_alpha(next);
        const WideFloats q = alpha * bend + 1.0f, next_q = next_alpha * bend + 1.0f;
        const WideFloats product = q * next_q;
        sum = sum + product;
        const WideFloats of_both = slope / product;
        const WideFloats step = of_both * next_q * alpha, next_step = of_both * q * next_alpha;
        store(out + i, step + base);
        store(out + next, next_step + base);
        if (Numerators == 1) return;
        store(other_out + i, step * share + other_base);
        store(other_out + next, next_step * share + other_base);
    };
    for (std::size_t begin = first; begin < count;) {
        const std::size_t end = end_of_block(count, begin, float_block);
        sum = WideFloats{};
        std::size_t i = begin;
        for (; i + wide_at_once < end; i += 2 * wide_at_once) fill_both(i, i + wide_at_once);
        if (i < end) fill_both(i, i);
        if (any(~at_most(sum - sum, WideFloats{}))) return begin;
        begin = end;
    }
    return count;
}

template <class CompiledWhereCalled = void>
std::size_t fill_segment_all_float(const SegmentJob& job, std::size_t first) noexcept {
    return fill_with_mask(job.numerators == 2 ? fill_segment_all_float_of<2> : fill_segment_all_float_of<1>, job,
                          first);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
