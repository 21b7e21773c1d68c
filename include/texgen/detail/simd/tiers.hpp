#pragma once

// The tiers: how values are computed, the dearest way first, and what bounds their errors. What a tier's bound does not
// cover goes to a dearer one.
//
//   exact           in double, with a certificate: the nearest float. What that leaves in doubt is decided closely, in
//                   two doubles; and what those leave, one by one, by exact sums
//   in_double       numerators and quotient in double, rounded once
//   float_divided   numerators and q in double, rounded; the quotient in float
//   all_float       numerators, q and quotient in float; of points about the origin, or about one of them
//   polynomial      in float about the middle of a chunk, with a polynomial instead of a division
//
// CONTRIBUTING.md has a table of which serve what.

#include "../arithmetic/rounding.hpp"
#include "../language.hpp"

namespace TEXGEN_DETAIL {

// Sums of a form's terms below this are floats in range, and their reciprocals no subnormal ones.
inline constexpr double largest_terms_in_float = 0x1p125;

// The error of a division in float: the forms of s and q err by form_error of their terms, and what is rounded after
// them adds `roundings` of the quotient, and half of the least subnormal number.
struct FloatDivision {
    double form_error, roundings;

    // A bound on the error of s/q. The terms are sum |T_j v_j|, size is |x| + |y| + |z| + 1; q is at least least_q, and
    // |s/q| at most `largest`, both either exactly or as computed. With s^ = s + a, q^ = q + b, |s^/q^ - s/q| is
    // |a - b s/q| / q^ = |a - b s^/q^| / q. Infinite where a float could leave its range.
    constexpr double error(double s_terms, double q_terms, double size, double least_q, double largest) const noexcept {
        const double underflow = 0x1p-124 * size;
        const double s_error = form_error * s_terms + underflow, q_error = form_error * q_terms + underflow;
        const double q = least_q * (1.0 - roundings) - q_error;
        if (!(q > 0x1p-60 && s_terms < largest_terms_in_float && q_terms < largest_terms_in_float)) return infinity;
        return (s_error + largest * q_error) * (1.001 / q) + roundings * largest + 0x1p-150;
    }
};

// With u = 2^-24: rounded coefficients and four terms, 5 u, and one more about a point, from which differences are
// rounded; the reciprocal and the product, 2 u.
inline constexpr FloatDivision all_float{5.01 * unit_roundoff_float, 2.01 * unit_roundoff_float};
inline constexpr FloatDivision about_point{6.01 * unit_roundoff_float, 2.01 * unit_roundoff_float};
// Points in front are certified about the origin where q is between these, or is taken for the larger; others are
// divided about a point.
inline constexpr double least_q_in_front = 0x1p-59, largest_q_in_front = 0x1p100;
// Numerator and q that are rounded to float, the reciprocal and the product.
inline constexpr double float_divided_roundings = 4.01 * unit_roundoff_float;

// q is well in front where it is so many times its error: what it errs by is below 2^-24 of it.
inline constexpr double well_in_front = 0x1p24;
// One error bound serves all quotients of a tile whose least q is above this share of the largest: beyond, that of the
// largest quotient would make the smallest ones doubtful.
inline constexpr double share_for_one_error = 0x1p-12;
// The shares of a tolerance that the bounds of chunks and of whole tiles may take: they are rounded themselves, those of
// tiles more often.
inline constexpr double share_for_chunks = 1.0 - 0x1p-20, share_for_tiles = 1.0 - 0x1p-18;
// Functions cancel where they err by more than this share of what is left of them: more than one float in 2^12 would be
// in doubt.
inline constexpr double cancelled_share = 0x1p-36;

// How the steps i / (1 + x) of a chunk are computed: with 2 or 3 factors of 1 / (1 + x) = (1 - x) (1 + x^2) (1 + x^4)
// ..., which err by x^4 or x^8 of the step; by a division; or (none) not, as no bound holds. undecided: chunk by chunk.
enum class StepRule { undecided, degree4, degree8, divide, none };

}  // namespace TEXGEN_DETAIL
