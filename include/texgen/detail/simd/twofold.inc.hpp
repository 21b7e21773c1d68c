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

// A number as an unevaluated sum, high the nearest double, and a bound on what that lacks: 0 where it is exact. A sum is made
// either precisely, or quickly: then what its leading part leaves is added in one double, which no tie is certain by.
struct Twofold {
    Doubles high, low, lost;
};

// Quickly: a sum, what is left of it in at most six terms, and their magnitudes. The low part is exact where what is lost is
// small beside the sum.
TEXGEN_INLINE Twofold twofold_of(const Doubles& sum, const Doubles& rest, const Doubles& size) noexcept {
    Twofold result;
    result.high = quick_two_sum(sum, rest, result.low);
    result.lost = size * 0x1p-51;
    return result;
}

struct PointLanes {
    Doubles v[3];
};

// The value of a form at points. A coefficient is split in two, so that both products with a float are exact.
struct TwofoldForm {
    PointForm form;
    double high[3], low[3];
    bool is_used[3], has_low[3];
    bool is_finite;

    TwofoldForm() = default;
    TEXGEN_INLINE explicit TwofoldForm(const PointForm& given) noexcept
        : form(given),
          high{},
          low{},
          is_used{},
          has_low{},
          is_finite(0.0 * (form.x + form.y + form.z + form.w) == 0.0) {
        const double coefficient[3] = {form.x, form.y, form.z};
        for (int j = 0; j < 3; ++j) {
            high[j] = leading_29_bits(coefficient[j]);
            low[j] = coefficient[j] - high[j];
            is_used[j] = coefficient[j] != 0.0;
            has_low[j] = low[j] != 0.0;
        }
    }

    TEXGEN_INLINE Doubles nearly_at(const PointLanes& at) const noexcept {
        return at.v[0] * form.x + (at.v[1] * form.y + (at.v[2] * form.z + form.w));
    }
    TEXGEN_INLINE Doubles error_at(const PointLanes& at) const noexcept {
        return (magnitude(at.v[0]) * std::fabs(form.x) + magnitude(at.v[1]) * std::fabs(form.y) +
                magnitude(at.v[2]) * std::fabs(form.z) + std::fabs(form.w)) *
               gamma(5);
    }

    // Of points that are numbers: a coordinate without a coefficient is not looked at.
    TEXGEN_INLINE Twofold at(const PointLanes& at, bool precisely) const noexcept {
        Doubles sum = Doubles{} + form.w;
        Doubles rest{}, lost{}, third{};  // what the sum leaves, and what that leaves
        bool is_first = precisely;
        const auto keep = [&](const Doubles& term) {
            Doubles left = term;
            if (precisely) {
                rest = two_sum(rest, term, left);
                third = third + left;
            } else {
                rest = rest + term;
            }
            lost = lost + magnitude(left);
        };
        TEXGEN_UNROLL
        for (int j = 0; j < 3; ++j) {
            if (!is_used[j]) continue;
            Doubles product = at.v[j] * high[j];
            Doubles product_rest = at.v[j] * low[j];
            if (!precisely) product = quick_two_sum(product, product_rest, product_rest);
            Doubles error;
            sum = two_sum(sum, product, error);
            if (is_first)
                rest = error;
            else
                keep(error);
            is_first = false;
            if (has_low[j]) keep(product_rest);
        }
        if (!precisely) return twofold_of(sum, rest, lost);
        Twofold result;
        result.high = two_sum(sum, rest, result.low);
        // Beside a sum that cancels what is lost is much, and is kept.
        if (any(~at_most(lost, magnitude(result.high) * 0x1p-60))) {
            Doubles error;
            const Doubles second = two_sum(result.low, third, error);
            result.high = two_sum(result.high, second, result.low);
            lost = lost * 0x1p-50 + magnitude(error);
        }
        result.lost = lost * 1.001;
        return result;
    }
};

// The denominators of a vector of quotients, and on which side of 0 they are.
struct TwofoldDivisor {
    LongWords in_front, is_known;  // is_known: the side is, and in front the value well enough to divide by
    Doubles high, low, lost, reciprocal;
    Doubles part[2], low_part[2];  // high and low in parts of 27 bits and less, whose products with 25 bits are exact

    TEXGEN_INLINE explicit TwofoldDivisor(const Twofold& q) noexcept {
        in_front = greater(q.high, 0.0) & at_most(q.lost, q.high * 0x1p-50);
        is_known = in_front | at_most(q.lost * 2.0, -1.0 * q.high);
        high = q.high;
        low = q.low;
        lost = q.lost;
        reciprocal = where(in_front, 1.0 / q.high);
        part[0] = leading_bits<27>(q.high);
        part[1] = q.high - part[0];
        low_part[0] = leading_bits<27>(q.low);
        low_part[1] = q.low - low_part[0];
    }
};

// The same of numerators with these errors. False where a lane is in doubt, as where value - error and value + error do not
// round to one float. 2^-49 covers what q lacks, and the roundings here.
TEXGEN_INLINE bool divide_nearly(const Doubles& s, const Doubles& s_error, const TwofoldDivisor& q,
                                 Floats& value) noexcept {
    const Doubles quotient = where(q.in_front, s * q.reciprocal);
    const Doubles error = where(q.in_front, magnitude(quotient) * 0x1p-49 + q.reciprocal * (s_error * 1.001));
    value = to_floats(quotient - error);
    return !any(bits(value) ^ bits(to_floats(quotient + error)));
}

// The floats nearest to s / q in front, 0 elsewhere; `is_known` loses the lanes in front where that is in doubt.
// As nearest_quotient(): where the quotient, which errs by less than 2^-48 of it, 32 ulps, is so near the middle of two
// floats, the sign of s - middle q decides. That is a small number beside both products, so s - middle q' is exact for the
// leading 53 bits q' of q; and precisely the rest is summed exactly where it is but short, as it is of ties. Below `within`
// either float will do. Integers know the middles of normal floats; those of subnormal ones are found by rounding.
TEXGEN_INLINE Floats nearest_quotients(const Twofold& s, const TwofoldDivisor& q, const Doubles& within, bool precisely,
                                       LongWords& is_known) noexcept {
    const Doubles quotient = where(q.in_front, s.high * q.reciprocal) + 0.0;
    const Doubles size = magnitude(quotient);
    const LongWords is_precise = at_most(s.lost, magnitude(s.high) * 0x1p-50);
    const LongWords is_open = ~greater(within, size);
    const LongWords is_small = is_open & greater(Doubles{} + 0x1p-125, size) & greater(size, 0x1p-800);
    LongWords is_near = is_open & are_near_middles(quotient, 63);
    if (!any(is_near | is_small)) {
        is_known &= ~q.in_front | is_precise;
        return to_floats(quotient);
    }
    Doubles middle = middle_near(quotient + 0x1p-900);  // of 0 it is subnormal, which takes long
    if (any(is_small)) {
        const Doubles error = size * 0x1p-48;
        const Doubles low = to_doubles_as_rounded(to_floats(quotient - error));
        const Doubles high = to_doubles_as_rounded(to_floats(quotient + error));
        middle = select(is_small, low * 0.5 + high * 0.5, middle);
        is_near = (is_near & ~is_small) | (is_small & greater(high, low));
    }
    const Doubles leading_rest = (s.high - middle * q.part[0]) - middle * q.part[1];
    Doubles remainder;
    Doubles lost = s.lost + magnitude(middle) * q.lost;
    if (!precisely) {
        const Doubles low_product = middle * q.low;
        remainder = leading_rest + (s.low - low_product);
        lost = lost + (magnitude(s.low) + magnitude(low_product)) * 0x1p-52;
    } else {
        const Doubles last_product = middle * q.low_part[1];
        Doubles left[2];
        Doubles sum = two_sum(leading_rest, s.low, left[0]);
        sum = two_sum(sum, -1.0 * (middle * q.low_part[0]), left[1]);
        remainder = sum + ((left[0] + left[1]) - last_product);
        lost = lost + (magnitude(left[0]) + magnitude(left[1]) + magnitude(last_product)) * 0x1p-51;
    }
    is_known &= ~q.in_front | (is_precise & (~is_near | at_most(lost * 2.0, magnitude(remainder))));
    const Doubles decided = middle + where(are_nonzero(remainder), with_sign_of(size * 0x1p-48, remainder));
    return to_floats(select(is_near, decided, quotient));
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
