// What doubles leave in doubt of a vector of fragments, decided by what is known besides of their functions. Included by
// kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// Bit i for lane i.
TEXGEN_INLINE std::uint64_t bits_of(const Words& mask) noexcept {
    return lane_bits(are_nonzero(to_doubles_as_rounded(one_where(mask))));
}

// A function at a vector of fragments: within `error` of the sum of two doubles.
struct CloseValues {
    Doubles high, low, error;

    // Where its residue times the grain is all of it.
    TEXGEN_INLINE LongWords are_residues(double grain) const noexcept {
        return greater(Doubles{} + 0x1p62 * grain, magnitude(high + low) + error);
    }
};

// Where F is 0, as its residue says, so is the quotient.
TEXGEN_INLINE Words decide_zeros(const LongWords& are_zeros, const Words& doubt, Floats& value) noexcept {
    value = select(doubt & narrow(are_zeros), Floats{}, value);
    return doubt & ~narrow(are_zeros);
}

// The nearer of `below` and `above`, next to one another, by the sign of the remainder that a quotient leaves beyond their
// middle (`middle` is twice that, `unit` the power of two below it). Returns the lanes that this decides.
TEXGEN_INLINE Words decide_between(const Floats& below, const Floats& above, const Doubles& middle, const Doubles& unit,
                                   const Doubles& remainder, const LongWords& is_open, const LongWords& is_tie,
                                   Floats& value) noexcept {
    // A step from the middle that is less than half of what the floats are away.
    const Doubles step = where(is_open, with_sign_of(unit * 0x1p-26, remainder));
    const Floats nearest = to_floats((middle + step) * 0.5);
    const LongWords are_neighbours =
        at_most(to_doubles_as_rounded(above) - to_doubles_as_rounded(below), unit * 0x1p-24);
    const Words decided =
        narrow((is_open | is_tie) & are_neighbours) & ~equal(bits(below) & bits(above) & 0x7f800000, 0);
    value = select(decided, nearest, below);
    return decided;
}

// What F - m Q is of a vector, or nearly: m the middle of the floats below and above a quotient.
struct CloseRemainder {
    Floats below, above;
    Doubles middle, unit, value, error;  // middle is twice m, and unit the power of two below it
};

// The sign of F - m Q by its residue: the finer one of its terms' grains times an integer. Returns the lanes of `doubt` that
// this does not decide.
template <class Grain>
TEXGEN_INLINE Words decide_by_residues(const Residues& f, const Grain& f_grain, const Residues& q, const Grain& q_grain,
                                       const CloseRemainder& remainder, const Words& doubt, Floats& value) noexcept {
    const Doubles finer = minimum(remainder.unit * (0x1p-25 * q_grain), Doubles{} + f_grain);
    const Doubles per_finer = reciprocals_of_powers(finer);
    const Doubles of_f = per_finer * f_grain;
    const Doubles of_q = remainder.middle * (0.5 * q_grain) * per_finer;
    const LongWords is_known = greater(finer * 0x1p62, magnitude(remainder.value) + remainder.error) &
                               greater(Doubles{} + 0x1p62, maximum(of_f, magnitude(of_q)));
    const Residues residues = f * to_residues(where(is_known, of_f)) - q * to_residues(where(is_known, of_q));
    Floats nearest;
    const Words decided = doubt & decide_between(remainder.below, remainder.above, remainder.middle, remainder.unit,
                                                 signs_of(residues), is_known & ~are_zero(residues), is_known, nearest);
    value = select(decided, nearest, value);
    return doubt & ~decided;
}

// The nearer float where a quotient is so near the middle m of two that the sign of F - m Q decides: that of its residue, if there
// is one that says all of it, else of what two doubles hold; and that is known well enough for a residue of more digits.
struct CloseMiddle {
    Doubles middle, unit;  // middle is a multiple of unit, and within 2^25 of them

    TEXGEN_INLINE explicit CloseMiddle(const Doubles& u) noexcept
        : middle(middle_near(u)), unit(power_of_two_below(u) * 0x1p-24) {}

    // The sign of `rest` decides; 0 is a tie.
    TEXGEN_INLINE Floats beyond(const Doubles& sign, const LongWords& is_tie) const noexcept {
        return to_floats(middle + where(~is_tie, with_sign_of(unit * 0.25, sign)));
    }

    // F - m Q, which is at most `bound`, by its residue. Returns the lanes of `doubt` that this does not decide.
    TEXGEN_INLINE Words decide(const Residues& f, double f_grain, const Residues& q, double q_grain,
                               const Doubles& bound, const Words& doubt, Floats& value) const noexcept {
        const Doubles finer = minimum(unit * q_grain, Doubles{} + f_grain);
        const Doubles per_finer = reciprocals_of_powers(finer);
        const Doubles of_f = per_finer * f_grain;
        const Doubles of_q = middle * q_grain * per_finer;
        const LongWords is_known =
            greater(finer * 0x1p62, bound) & greater(Doubles{} + 0x1p62, maximum(of_f, magnitude(of_q)));
        const Residues rest = f * to_residues(where(is_known, of_f)) - q * to_residues(where(is_known, of_q));
        const Words decided = doubt & narrow(is_known);
        value = select(decided, beyond(signs_of(rest), are_zero(rest)), value);
        return doubt & ~decided;
    }

    // What is left of F - m Q, whose leading parts cancel, and its error.
    TEXGEN_INLINE Doubles rest_of(const CloseValues& f, const CloseValues& q, Doubles& error) const noexcept {
        const Doubles leading = leading_bits<27>(q.high);
        Doubles low;
        const Doubles sum = two_sum(f.high - middle * leading, middle * (leading - q.high), low);
        error = magnitude(middle) * q.error + f.error;
        return sum + (low + (f.low - middle * q.low));
    }
};

// A vector of q, and what its quotients share.
struct CloseDivisor : CloseValues {
    Doubles value, reciprocal, relative_error;
    LongWords front, is_beside;

    TEXGEN_INLINE void take(const CloseValues& q) noexcept {
        static_cast<CloseValues&>(*this) = q;
        value = high + low;
        front = greater(value, error * 256.0);
        is_beside = ~(front | at_most(value, error * -1.0));
        reciprocal = where(front, 1.0 / value);
        relative_error = reciprocal * error + 0x1p-50;
    }
};

// A vector of fragments, again. `at` knows its functions there, q as the last.
template <std::size_t Numerators>
struct CloseFragments {
    Floats quotient[Numerators];
    Words doubtful;

    // Of `count` numerators, with residues or two doubles if there are any; else what doubles doubt stays so.
    template <class Functions>
    TEXGEN_INLINE void divide(const Functions& at, const CloseDivisor& q, std::size_t count, double tolerance,
                              bool is_more_known) noexcept {
        CloseValues f[Numerators];
        Doubles u[Numerators], error[Numerators];
        LongWords is_open[Numerators], is_rough[Numerators], any_open = q.is_beside, any_rough{};
        const bool has_tolerance = tolerance > 0.0;
        TEXGEN_UNROLL
        for (std::size_t k = 0; k < Numerators; ++k) {
            f[k] = at.values(k);
            u[k] = (f[k].high + f[k].low) * q.reciprocal + 0x1p-900;  // no 0
            const Doubles size = magnitude(u[k]);
            error[k] = size * q.relative_error + (q.reciprocal * f[k].error + 0x1p-152);
            quotient[k] = to_floats(u[k]);
            // Of normal floats that err by so little there is but one middle in reach.
            is_rough[k] = ~greater(size * 0x1p-27, error[k]);
            is_open[k] = q.front & (is_rough[k] | ~greater(magnitude(u[k] - middle_near(u[k])), error[k]));
            if (has_tolerance)
                is_open[k] &= ~at_most(error[k] * 2.001 + (size * (1.0001 * unit_roundoff_float) + 0x1p-149),
                                       Doubles{} + tolerance);
            any_rough |= is_rough[k];
            any_open |= is_open[k];
        }
        doubtful = narrow(any_open);
        if (!is_more_known || !any(any_open)) return;
        const bool has_rough = any(any_rough);
        const Residues of_q = at.residues(Numerators);
        const double q_grain = at.grain(Numerators);
        doubtful = narrow(q.is_beside & (~q.are_residues(q_grain) | are_positive(of_q)));
        for (std::size_t k = 0; k < count; ++k) {
            if (!any(is_open[k])) continue;
            const double grain = at.grain(k);
            const Residues of_f = at.residues(k);
            Words is_near = narrow(is_open[k]);
            if (has_rough) {
                const Words rough = is_near & narrow(is_rough[k]);
                is_near &= ~rough;
                const Floats above = to_floats(u[k] + error[k]);
                const Words differ = ~equal(bits(to_floats(u[k] - error[k])) ^ bits(above), 0) & rough;
                quotient[k] = select(rough, above, quotient[k]);
                doubtful |= decide_zeros(f[k].are_residues(grain) & are_zero(of_f), differ, quotient[k]);
            }
            // The middle is as near to the quotient as F/Q is: so |F - m Q| is at most twice the error times Q.
            const CloseMiddle middle(u[k]);
            Doubles bound = error[k] * q.value * 2.25;
            for (bool is_last = false;; is_last = true) {
                is_near = middle.decide(of_f, grain, of_q, q_grain, bound, is_near, quotient[k]);
                if (is_last || !any(is_near)) break;
                Doubles rest_error;
                const Doubles rest = middle.rest_of(f[k], q, rest_error);
                const Words decided = is_near & narrow(greater(magnitude(rest), rest_error));
                quotient[k] = select(decided, middle.beyond(rest, LongWords{}), quotient[k]);
                is_near &= ~decided;
                if (!any(is_near)) break;
                bound = magnitude(rest) + rest_error;
            }
            doubtful |= is_near;
        }
    }
};

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
