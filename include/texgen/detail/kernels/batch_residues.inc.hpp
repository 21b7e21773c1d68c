// The functions of a batch's triangles over tiles and runs that doubles leave in doubt, to twice their precision and as integers
// modulo 2^64, as in triangle/close_planes.hpp, a tile in each lane; then the quotients. Included by batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// A function at a vector of fragments: within `error` of the sum of two doubles.
struct CloseValues {
    Doubles high, low, error;

    // Where its residue times the grain is all of it.
    TEXGEN_INLINE LongWords are_residues(double grain) const noexcept {
        return greater(Doubles{} + 0x1p62 * grain, magnitude(high + low) + error);
    }
};

// Of as many tiles as a block has, about their first fragments: base, and by how much it grows along a row and down; q last.
struct BatchFunctions {
    double high[4][3][batch_block], low[4][3][batch_block], error[4][batch_block], grain[4][batch_block];
    std::uint64_t residue[4][3][batch_block];

    // The tiles from `first` on, of a triangle in each lane: see CloseRamp::split(). What residues do not know has a grain of 0.
    // Returns the lanes that nothing is known of.
    template <std::size_t Numerators>
    TEXGEN_APART LongWords take(const float* const (&triangle)[lanes], const Doubles& x, const Doubles& y,
                                const Doubles& width, const Doubles& height, std::size_t first) noexcept {
        const VertexLanes vertices(triangle);
        const CloseLanes close(vertices, x, y);
        const CloseSteps along(vertices, 1), down(vertices, 0);
        ResidueLanes corners(vertices, x, y);
        Residues dx[3], dy[3];
        corners.steps(dx, dy);
        for (std::size_t n = 0; n <= Numerators; ++n) {
            const std::size_t k = n < Numerators ? n : 3;
            const Twofold term[3] = {close.function(vertices, k), along.function(vertices, k),
                                     down.function(vertices, k)};
            const Doubles size =
                magnitude(term[0].high) + (magnitude(term[1].high) * width + magnitude(term[2].high) * height);
            const Doubles lost = term[0].lost + (term[1].lost * width + term[2].lost * height);
            const Doubles unit = power_of_two_below(size) * 0x1p-50;
            const Doubles rounder = unit * 0x1.8p52;
            TEXGEN_UNROLL
            for (std::size_t j = 0; j < 3; ++j) {
                const Doubles leading = (term[j].high + rounder) - rounder;
                store(&high[n][j][first], leading);
                store(&low[n][j][first], (term[j].high - leading) + term[j].low);
            }
            store(&error[n][first], (lost + (width + height + 1.0) * unit * 0x1p-50) * 1.01);
            const ResidueValues value = corners.values(k);
            store(&residue[n][0][first], value.times(corners.side));
            store(&residue[n][1][first], value.times(dx));
            store(&residue[n][2][first], value.times(dy));
            store(&grain[n][first], where(corners.is_known, value.grain));
        }
        return ~vertices.has_area;
    }

    // Of tile i at (x, y) from its first fragment; sums of the high parts are exact.
    TEXGEN_INLINE CloseValues at(std::size_t n, std::size_t i, const Doubles& x, const Doubles& y) const noexcept {
        return {x * high[n][1][i] + (y * high[n][2][i] + high[n][0][i]),
                x * low[n][1][i] + (y * low[n][2][i] + low[n][0][i]), Doubles{} + error[n][i]};
    }
    TEXGEN_INLINE Residues residues_at(std::size_t n, std::size_t i, const Residues& x,
                                       const Residues& y) const noexcept {
        return x * residue[n][1][i] + (y * residue[n][2][i] + residue[n][0][i]);
    }
};

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

// A vector of fragments of a tile, again.
template <std::size_t Numerators>
struct CloseFragments {
    Floats quotient[Numerators];
    LongWords front;
    Words doubtful;

    TEXGEN_INLINE void divide(const BatchFunctions& functions, std::size_t i, const Doubles& x, const Doubles& y,
                              double tolerance) noexcept {
        const CloseValues q = functions.at(Numerators, i, x, y);
        const Doubles q_value = q.high + q.low;
        front = greater(q_value, q.error * 256.0);
        LongWords is_beside = ~(front | greater(q_value * -1.0, q.error));
        const Doubles reciprocal = where(front, 1.0 / q_value);
        const Doubles relative_error = reciprocal * q.error + 0x1p-50;
        CloseValues f[Numerators];
        Doubles u[Numerators], error[Numerators];
        LongWords is_open[Numerators], is_rough[Numerators], any_open = is_beside, any_rough{};
        const bool has_tolerance = tolerance > 0.0;
        TEXGEN_UNROLL
        for (std::size_t k = 0; k < Numerators; ++k) {
            f[k] = functions.at(k, i, x, y);
            u[k] = (f[k].high + f[k].low) * reciprocal + 0x1p-900;  // no 0
            const Doubles size = magnitude(u[k]);
            error[k] = size * relative_error + (reciprocal * f[k].error + 0x1p-152);
            quotient[k] = to_floats(u[k]);
            // Of normal floats that err by so little there is but one middle in reach.
            is_rough[k] = ~greater(size * 0x1p-27, error[k]);
            is_open[k] = front & (is_rough[k] | ~greater(magnitude(u[k] - middle_near(u[k])), error[k]));
            if (has_tolerance)
                is_open[k] &= ~at_most(error[k] * 2.001 + (size * (1.0001 * unit_roundoff_float) + 0x1p-149),
                                       Doubles{} + tolerance);
            any_rough |= is_rough[k];
            any_open |= is_open[k];
        }
        doubtful = Words{};
        if (!any(any_open)) return;
        const bool has_rough = any(any_rough);
        const Residues x_index = to_residues(x), y_index = to_residues(y);
        const Residues of_q = functions.residues_at(Numerators, i, x_index, y_index);
        const double q_grain = functions.grain[Numerators][i];
        is_beside &= ~q.are_residues(q_grain) | are_positive(of_q);
        doubtful = narrow(is_beside);
        TEXGEN_UNROLL
        for (std::size_t k = 0; k < Numerators; ++k) {
            if (!any(is_open[k])) continue;
            const double grain = functions.grain[k][i];
            const Residues of_f = functions.residues_at(k, i, x_index, y_index);
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
            Words left = middle.decide(of_f, grain, of_q, q_grain, error[k] * q_value * 2.25, is_near, quotient[k]);
            if (!any(left)) continue;
            Doubles rest_error;
            const Doubles rest = middle.rest_of(f[k], q, rest_error);
            const Words decided = left & narrow(greater(magnitude(rest), rest_error));
            quotient[k] = select(decided, middle.beyond(rest, LongWords{}), quotient[k]);
            left &= ~decided;
            if (any(left))
                left = middle.decide(of_f, grain, of_q, q_grain, magnitude(rest) + rest_error, left, quotient[k]);
            doubtful |= left;
        }
    }
};

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
