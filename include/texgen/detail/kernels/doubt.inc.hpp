// Vectors of fragments that doubles leave in doubt, decided by what else is known of them. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// A function at a vector of fragments: within `error` of the sum of two doubles.
struct CloseValues {
    Doubles high, low, error;

    // The lanes where it is exactly its residue times the grain, one number or one a lane; if that is 0, only 0 is.
    TEXGEN_INLINE LongWords are_residues(const auto& grain) const noexcept {
        return at_most(magnitude(high + low) + error, Doubles{} + grain * 0x1p62);
    }
};

// The residues of integers below 2^115, or of at most 50 digits and zeros behind them: larger ones of these are
// multiples of 2^64, and `rest` is 0.
TEXGEN_INLINE Residues to_residues_of_any(const Doubles& integers) noexcept {
    const Doubles rest = integers - ((integers * 0x1p-64 + 0x1.8p52) - 0x1.8p52) * 0x1p64;
    return to_residues(rest - where(~greater(Doubles{} + 0x1p63, rest), Doubles{} + 0x1p64));
}

// Finds the nearer float where a quotient is so near the middle m of two that the sign of F - m Q decides: by what two
// doubles hold of that, or by its residue, where that is all of it.
struct CloseMiddle {
    Doubles middle, unit;  // middle is a multiple of unit, and below 2^25 units

    TEXGEN_INLINE explicit CloseMiddle(const Doubles& u) noexcept
        : middle(middle_near(u)), unit(power_of_two_below(u) * 0x1p-24) {}

    // A power of two of which F - m Q is a multiple.
    template <class Grain>
    TEXGEN_INLINE Doubles grain_of(const Grain& f_grain, const Grain& q_grain) const noexcept {
        return minimum(unit * q_grain, Doubles{} + f_grain);
    }

    // The float on the side of `sign`, or in a tie the even one.
    TEXGEN_INLINE Floats nearest(const Doubles& sign, const LongWords& is_tie) const noexcept {
        return to_floats(middle + where(~is_tie, with_sign_of(unit * 0.25, sign)));
    }

    // Decides by two doubles, where F - m Q is larger than its error, or that is less than half a grain. Returns the
    // lanes that are decided; `bound` becomes what |F - m Q| is at most.
    template <class Grain>
    TEXGEN_INLINE LongWords decide_by_sums(const CloseValues& f, const CloseValues& q, const Grain& f_grain,
                                           const Grain& q_grain, Doubles& bound, Floats& value) const noexcept {
        // The leading parts cancel, and their product is exact.
        const Doubles leading = leading_bits<27>(q.high);
        Doubles low;
        const Doubles sum = two_sum(f.high - middle * leading, middle * (leading - q.high), low);
        const Doubles rest = sum + (low + (f.low - middle * q.low));
        const Doubles error = magnitude(middle) * q.error + f.error;
        const LongWords is_tie = at_most(magnitude(rest), error);
        bound = minimum(magnitude(rest) + error, bound);
        value = nearest(rest, is_tie);
        return ~is_tie | greater(grain_of(f_grain, q_grain), error * 2.25);
    }

    // Decides by residues, where F - m Q, at most `bound`, is all in its residue. Returns the lanes that are decided.
    template <class Grain>
    TEXGEN_INLINE LongWords decide_by_residues(const Residues& of_f, const Grain& f_grain, const Residues& of_q,
                                               const Grain& q_grain, const Doubles& bound,
                                               Floats& value) const noexcept {
        const Doubles finer = grain_of(f_grain, q_grain);
        const Doubles per_finer = reciprocals_of_powers(finer);
        const Doubles f_times = per_finer * f_grain;
        const Doubles q_times = middle * q_grain * per_finer;
        const LongWords fits = greater(Doubles{} + 0x1p62, f_times) & greater(Doubles{} + 0x1p900, magnitude(q_times));
        const Residues residue =
            of_f * to_residues(where(fits, f_times)) - of_q * to_residues_of_any(where(fits, q_times));
        value = nearest(bits_as<Doubles>(residue), are_zero(residue));
        return fits & greater(finer * 0x1p62, bound);
    }
};

// The q of a vector of fragments, and what their quotients share. is_beside: its sign is in doubt.
struct CloseDivisor : CloseValues {
    Doubles value, reciprocal, relative_error;
    LongWords front, is_beside;

    TEXGEN_INLINE explicit CloseDivisor(const CloseValues& q) noexcept : CloseValues(q) {
        value = high + low;
        front = greater(value, error * 256.0);
        is_beside = ~(front | at_most(value, error * -1.0));
        reciprocal = where(front, 1.0 / value);
        relative_error = reciprocal * error + 0x1p-50;
    }
};

// A quotient in double, and whether that leaves its float in doubt.
struct CloseQuotient {
    CloseValues f;
    Doubles u, size, error;
    LongWords is_open;

    TEXGEN_INLINE CloseQuotient(const CloseValues& of_f, const CloseDivisor& q, double tolerance) noexcept
        : f(of_f),
          u((f.high + f.low) * q.reciprocal + 0x1p-200),  // never 0, and normal when multiplied by a grain
          size(magnitude(u)),
          error(size * q.relative_error + (q.reciprocal * f.error + 0x1p-152)),
          is_open(~greater(minimum(size * 0x1p-27, magnitude(u - middle_near(u))), error)) {
        if (tolerance > 0.0)
            is_open &=
                ~at_most(error * 2.001 + (size * (1.0001 * unit_roundoff_float) + 0x1p-149), Doubles{} + tolerance);
    }
};

// Divides a vector of fragments again. `at` has their functions, q as the last, and tells whether two doubles say more
// than residues do and so are asked first. Middles that no lane is next to, as where all are zeros, are skipped; not so
// in a tile's kernel, to keep it small.
template <std::size_t Numerators, bool SkipsMiddles = true>
struct CloseFragments {
    Floats quotient[Numerators];
    LongWords doubtful;

    // Divides `count` numerators, if is_more_known with residues or two doubles; else what is in doubt stays so.
    TEXGEN_INLINE void divide(const auto& at, const CloseDivisor& q, std::size_t count, double tolerance,
                              bool is_more_known) noexcept {
        const auto q_grain = at.grain(Numerators);
        Residues of_q{};
        doubtful = q.is_beside;
        if (is_more_known && (!at.are_sums_first || any(doubtful))) {
            of_q = at.residues(Numerators);
            doubtful &= ~q.are_residues(q_grain) | are_positive(of_q);
        }
        for (std::size_t k = 0; k < count; ++k) {
            const CloseQuotient close(at.values(k), q, tolerance);
            quotient[k] = to_floats(close.u);
            const LongWords is_open = close.is_open & q.front;
            if (!is_more_known) doubtful |= is_open;
            if (!is_more_known || !any(is_open)) continue;
            // Only of quotients that err by less is but one middle of normal floats in reach.
            const LongWords is_rough = is_open & ~greater(close.size * 0x1p-27, close.error);
            const auto grain = at.grain(k);
            LongWords left = is_open;
            const auto take = [&](LongWords decided, const Floats& nearest) {
                decided &= left & ~is_rough;
                quotient[k] = select(narrow(decided), nearest, quotient[k]);
                left &= ~decided;
            };
            const CloseMiddle middle(close.u);
            // Both the middle and F/Q are within the error of the quotient: |F - m Q| is at most twice that times Q.
            Doubles bound = close.error * q.value * 2.25;
            Floats nearest;
            if (at.are_sums_first) {
                take(middle.decide_by_sums(close.f, q, grain, q_grain, bound, nearest), nearest);
                if (!any(left)) continue;
                of_q = at.residues(Numerators);
            }
            const Residues of_f = at.residues(k);
            if (!SkipsMiddles || any(left & ~is_rough))
                take(middle.decide_by_residues(of_f, grain, of_q, q_grain, bound, nearest), nearest);
            if (any(is_rough)) {
                const RoundedEnds ends(close.u, close.error);
                const LongWords is_zero = close.f.are_residues(grain) & are_zero(of_f);
                quotient[k] = select(narrow(is_rough), select(narrow(is_zero), Floats{}, ends.above), quotient[k]);
                left &= ~is_rough | (~is_zero & are_nonzero(to_doubles(ends.differ())));
            }
            doubtful |= left;
        }
    }
};

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
