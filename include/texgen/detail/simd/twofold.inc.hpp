// What one double leaves in doubt, decided in two: sums whose loss is known, in the lanes of the kernels. Included by
// kernels.inc.hpp. For rounding to nearest; products are exact without fma(), so that contraction changes nothing.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// Exactly a + b: the sum rounded, and in `error` the rest. As detail::two_sum().
TEXGEN_INLINE Doubles two_sum(const Doubles& a, const Doubles& b, Doubles& error) noexcept {
    const Doubles sum = a + b;
    const Doubles b_part = sum - a;
    error = (a - (sum - b_part)) + (b - b_part);
    return sum;
}

// The same where |b| <= |a|; elsewhere only the sum is right.
TEXGEN_INLINE Doubles quick_two_sum(const Doubles& a, Doubles b, Doubles& error) noexcept {
    const Doubles sum = a + b;
    error = b - (sum - a);
    return sum;
}

// A number as the unevaluated sum high + low + rest, high being the nearest double and rest far below; `lost` bounds
// what the sum lacks, and is 0 where it is exact. All parts are multiples of the grain, a power of two.
struct PointSum {
    Doubles high, low, lost, rest, grain;
};

struct PointLanes {
    Doubles v[3];
};

// A form with its coefficients in all lanes: GCC does not take that out of loops that have branches.
struct PointFormLanes {
    Doubles x, y, z, w;

    TEXGEN_INLINE PointFormLanes(const PointForm& of) noexcept
        : x(Doubles{} + of.x), y(Doubles{} + of.y), z(Doubles{} + of.z), w(Doubles{} + of.w) {}
};

// The value of a form of either kind.
template <class Form>
TEXGEN_INLINE Doubles value_at(const Form& form, const PointLanes& point) noexcept {
    return point.v[0] * form.x + (point.v[1] * form.y + (point.v[2] * form.z + form.w));
}

// The last bit that is set of each number, which is not negative and has at most 51 bits; 2^500 for 0. A bit is put in
// front first, as without_last_bit() takes no power of two.
TEXGEN_INLINE Doubles last_bits(const Doubles& size) noexcept {
    const Doubles longer = size + power_of_two_below(size) * 4.0;
    return select(greater(size, 0.0), longer - without_last_bit(longer), Doubles{} + 0x1p500);
}

// The value of a form at points. A coefficient is split in two, so that both products with a float are exact.
struct TwofoldForm {
    PointForm form;
    double high[3], low[3], size[3], grain[3];
    double size_of_w, grain_of_w;
    unsigned used = 0, with_low = 0;  // a bit for each coefficient
    bool is_finite;

    TwofoldForm() = default;
    TEXGEN_APART explicit TwofoldForm(const PointForm& given) noexcept
        : form(given),
          size_of_w(std::fabs(form.w)),
          grain_of_w(last_bit(form.w)),
          is_finite(0.0 * (form.x + form.y + form.z + form.w) == 0.0) {
        const double coefficient[3] = {form.x, form.y, form.z};
        for (unsigned j = 0; j < 3; ++j) {
            high[j] = detail::leading_bits<29>(coefficient[j]);
            low[j] = coefficient[j] - high[j];
            size[j] = std::fabs(coefficient[j]);
            grain[j] = last_bit(coefficient[j]);
            used |= coefficient[j] != 0.0 ? 1u << j : 0;
            with_low |= low[j] != 0.0 ? 1u << j : 0;
        }
    }

    TEXGEN_INLINE Doubles error_at(const PointLanes& of) const noexcept {
        return (of.v[0] * size[0] + (of.v[1] * size[1] + (of.v[2] * size[2] + size_of_w))) * gamma(5);
    }

    // The floats nearest to the values of a finite form, which are the quotients where q is 1. Beside the rounded sum
    // of the products with `high` there are six numbers: what that sum leaves, and the products with `low`. At the
    // middle of two floats their sum tells the side: five of their sums are rounded, and what these leave is added with
    // five roundings more. It loses nothing where all are 0, as in most ties, or cancel. `is_known` loses the lanes in
    // doubt.
    TEXGEN_INLINE Floats nearest_at(const PointLanes& at, const PointLanes& of, LongWords& is_known) const noexcept {
        const RoundedEnds ends(value_at(form, at), error_at(of));
        if (!any(ends.differ())) return ends.below;
        Doubles sum = Doubles{} + form.w, second{}, third{}, size_of_third{};
        const auto keep = [&](const Doubles& term) {
            Doubles left;
            second = two_sum(second, term, left);
            third = third + left;
            size_of_third = size_of_third + magnitude(left);
        };
        TEXGEN_FOR (unsigned j = 0; j < 3; ++j) {
            if ((used >> j & 1u) == 0) continue;
            Doubles left;
            sum = two_sum(sum, at.v[j] * high[j], left);
            keep(left);
        }
        for (unsigned j = 0; j < 3; ++j)
            if ((with_low >> j & 1u) != 0) keep(at.v[j] * low[j]);
        second = second + third;
        const Doubles lost = size_of_third * gamma(8) + magnitude(second) * (1.01 * unit_roundoff_double);
        sum = two_sum(sum, second, second) + 0.0;
        const Doubles size_of_sum = magnitude(sum);
        const LongWords is_middle = ~are_nonzero(sum - middle_near(sum + 0x1p-900));
        const LongWords is_small = greater(Doubles{} + 0x1p-125, size_of_sum) & are_nonzero(sum);
        is_known &= at_most(lost, size_of_sum * 0x1p-55) & ~is_small;
        is_known &= ~is_middle | at_most(lost * 2.0, magnitude(second));
        const Doubles beside = sum + where(are_nonzero(second), with_sign_of(size_of_sum * 0x1p-48, second));
        return to_floats(select(is_middle, beside, sum));
    }

    // The value at points that are numbers; a coordinate whose coefficient is 0 is not looked at. With T the sum of the
    // terms' magnitudes, the sum in double leaves six terms of less than 2^-50 T together, and their sum, kept where
    // `precisely`, five of less than 2^-101 T. The last ones are added in one double, with five roundings: none where
    // the grain is at least 2^-102 T, as that of numbers of about one size is, or precisely 2^-152 T.
    TEXGEN_INLINE PointSum at(const PointLanes& at, const PointLanes& of, bool precisely,
                              const PointLanes& grains) const noexcept {
        Doubles sum = Doubles{} + form.w;
        Doubles terms = Doubles{} + size_of_w;
        Doubles second{}, third{};  // what the sum leaves, and what that leaves
        PointSum result;
        result.grain = Doubles{} + grain_of_w;
        const auto keep = [&](const Doubles& term) {
            if (precisely) {
                Doubles left;
                second = two_sum(second, term, left);
                third = third + left;
            } else {
                second = second + term;
            }
        };
        TEXGEN_FOR (unsigned j = 0; j < 3; ++j) {
            if ((used >> j & 1u) == 0) continue;
            Doubles left;
            const Doubles product = quick_two_sum(at.v[j] * high[j], at.v[j] * low[j], left);
            if ((with_low >> j & 1u) != 0) keep(left);
            sum = two_sum(sum, product, left);
            keep(left);
            terms = terms + of.v[j] * size[j];
            result.grain = minimum(grains.v[j] * grain[j], result.grain);
        }
        const auto lost_beyond = [&](double range) {
            const Doubles lost = terms * (4.0 / range) + 0x1p-1000;
            return where(greater(terms, result.grain * range), lost);
        };
        result.rest = third;
        if (precisely) {
            result.lost = lost_beyond(0x1p152);
            result.high = two_sum(sum, second, result.low);
            // The rest is not small beside a sum that cancels.
            if (any(~at_most(magnitude(third), magnitude(result.high) * 0x1p-80))) {
                second = two_sum(result.low, third, result.rest);
                result.high = two_sum(result.high, second, result.low);
            }
        } else {
            result.lost = lost_beyond(0x1p102);
            result.high = quick_two_sum(sum, second, result.low);
        }
        return result;
    }
};

// Numbers with the signs of exact sums of up to 26 terms in the lanes that are asked; the terms are overwritten. sigma
// is a power of two, at least twice the sum of their magnitudes. Terms are added to sigma, and the sum stays between a
// half and twice of it: so what is added is a multiple of 2^-53 sigma and leaves at most that of each term, of all less
// than a quarter of the next sigma, 2^-46 sigma. The sum so far is at most half the next sigma, and with what is added
// there an exact multiple again, or has the sign of all that follows. What two sigmas leave, of each term at most 2^-7
// of a third one, is summed in double, rounded 25 times; where that cancels, too, two more sigmas follow.
// Source: Rump, Ogita, Oishi, Accurate Floating-Point Summation I, SIAM J. Sci. Comput. 31 (2008), ExtractVector.
TEXGEN_INLINE Doubles signed_sum(Doubles* term, std::size_t count, Doubles sigma, const LongWords& asked) noexcept {
    Doubles sum{};
    for (;;) {
        const Doubles next = sigma * 0x1p-46;
        Doubles high = sigma, low = next, rest;
        Doubles tail{};
        for (std::size_t k = 0; k < count; ++k) {
            high = quick_two_sum(high, term[k], rest);
            low = quick_two_sum(low, rest, term[k]);
            tail = tail + term[k];
        }
        sum = (sum + (high - sigma)) + (low - next);
        const Doubles value = sum + tail;
        sigma = next * 0x1p-46;
        const LongWords are_open = asked & at_most(magnitude(value), sigma * (26 * 0x1p-7 * gamma(28)));
        if (!any(are_open)) return value;
        Doubles left{};
        for (std::size_t k = 0; k < count; ++k) left = left + magnitude(term[k]);
        if (!any(are_open & greater(left, 0.0) & at_most(magnitude(value), left * gamma(28)))) return value;
    }
}

// The denominators of a vector of quotients, and on which side of 0 they are.
struct TwofoldDivisor : PointSum {
    LongWords in_front, is_known;  // is_known: the side is, and in front the value well enough to divide by
    Doubles reciprocal;
    Doubles part[2];  // high in parts of 27 bits and less, whose products with 25 bits are exact

    TEXGEN_INLINE explicit TwofoldDivisor(const PointSum& q) noexcept : PointSum(q) {
        in_front = greater(q.high, 0.0) & at_most(q.lost, q.high * 0x1p-50);
        is_known = in_front | at_most(q.lost * 2.0, -1.0 * q.high);
        reciprocal = where(in_front, 1.0 / q.high);
        part[0] = leading_bits<27>(q.high);
        part[1] = q.high - part[0];
    }
};

// The floats nearest to s / q, s with an error. False where a lane is in doubt. 2^-49 covers what q lacks, and
// roundings.
TEXGEN_INLINE bool divide_nearly(const Doubles& s, const Doubles& s_error, const TwofoldDivisor& q,
                                 Floats& value) noexcept {
    const Doubles quotient = where(q.in_front, s * q.reciprocal);
    const Doubles error = where(q.in_front, magnitude(quotient) * 0x1p-49 + q.reciprocal * (s_error * 1.001));
    const RoundedEnds ends(quotient, error);
    value = ends.below;
    return !any(ends.differ());
}

// The middle of two floats that is next to a number below 2^-125, where floats may be subnormal and have one exponent.
TEXGEN_INLINE Doubles middle_of_subnormals(const Doubles& a) noexcept {
    constexpr double rounder = 0x1.8p52 * 0x1p-149;
    return (((a - 0x1p-150) + rounder) - rounder) + 0x1p-150;
}

// The floats nearest to s / q in front, 0 elsewhere; is_known says where that is not in doubt.
// As nearest_quotient(): where the quotient, which errs by less than 2^-48 of it, 32 ulps, is so near the middle of two
// floats, the sign of s - middle q decides. That is small beside both products, so s - middle q' is exact for the
// leading 53 bits q' of q; with `precisely` the rest is summed exactly where it is short, as in ties. Below `within`
// either float will do. The middles of normal floats are found by integers, those of subnormal ones by rounding.
TEXGEN_INLINE Floats nearest_quotients(const PointSum& s, const TwofoldDivisor& q, const Doubles& within,
                                       bool precisely, LongWords& is_known) noexcept {
    const Doubles quotient = where(q.in_front, s.high * q.reciprocal) + 0.0;
    const Doubles size = magnitude(quotient);
    const Doubles size_of_s = magnitude(s.high);
    const LongWords is_precise = at_most(s.lost, size_of_s * 0x1p-50);
    const LongWords is_open = ~greater(within, size);
    const LongWords is_small = is_open & greater(Doubles{} + 0x1p-125, size) & greater(size, 0x1p-800);
    LongWords is_near = is_open & are_near_middles(quotient, 63);
    if (!any(is_near | is_small)) {
        is_known = ~q.in_front | is_precise;
        return to_floats(quotient);
    }
    Doubles middle = middle_near(quotient + 0x1p-900);  // of 0 it is subnormal, which takes long
    if (any(is_small)) {
        const Doubles of_small = middle_of_subnormals(quotient);
        middle = select(is_small, of_small, middle);
        is_near = (is_near & ~is_small) | (is_small & at_most(magnitude(quotient - of_small), size * 0x1p-48));
    }
    const Doubles leading_rest = (s.high - middle * q.part[0]) - middle * q.part[1];
    // All numbers are multiples of the grain of s, or of that of middle q, which is at least 2^-25 middle times q's.
    // What is added in one double, less than 2^-47 s or precisely 2^-77 s, is exact where no grain is too fine for this
    // range; else four roundings are lost, if not `precisely` of less than 2^-51 s.
    const auto lost_beyond = [&](double range) {
        const LongWords is_exact = at_most(size_of_s, s.grain * range) & at_most(q.high, q.grain * (range * 0x1p-25));
        return where(~is_exact, size_of_s * (4.0 / range));
    };
    Doubles remainder;
    Doubles lost = s.lost + magnitude(middle) * q.lost;
    if (!precisely) {
        remainder = leading_rest + (s.low - middle * q.low);
        lost = lost + lost_beyond(0x1p99);
    } else {
        const Doubles low_part = leading_bits<27>(q.low);
        Doubles left[2];
        Doubles sum = two_sum(s.low, -1.0 * (middle * low_part), left[0]);
        sum = two_sum(leading_rest, sum, left[1]);
        remainder = sum + (((left[0] + left[1]) - middle * (q.low - low_part)) + (s.rest - middle * q.rest));
        lost = lost + lost_beyond(0x1p130);
    }
    is_known = ~q.in_front | (is_precise & (~is_near | at_most(lost * 2.0, magnitude(remainder))));
    const Doubles decided = middle + where(are_nonzero(remainder), with_sign_of(size * 0x1p-48, remainder));
    return to_floats(select(is_near, decided, quotient));
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
