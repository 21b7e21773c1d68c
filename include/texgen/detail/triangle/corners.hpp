#pragma once

// What is known of a tile by its corner fragments: in front or behind, where its coordinates lie in the region, and how
// large they and their errors are.

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "../../primitives.hpp"
#include "../arithmetic/rounding.hpp"
#include "../arithmetic/widen.hpp"
#include "../culling/lit_test.hpp"
#include "../language.hpp"
#include "../simd/lanes.hpp"
#include "../simd/tiers.hpp"
#include "close_planes.hpp"
#include "planes.hpp"

namespace TEXGEN_DETAIL_BUILD {

// Columns of a tile, or rows.
struct Stretch {
    bool across_width;
    int begin, end;

    // Part 0 is what comes before the stretch, 1 the stretch itself, 2 what comes after it.
    TEXGEN_RARE Tile part(const Tile& tile, std::size_t i) const noexcept {
        const int size = across_width ? tile.width : tile.height;
        const int first = i == 0 ? 0 : i == 1 ? begin : end;
        const int last = i == 0 ? begin : i == 1 ? end : size;
        return across_width ? Tile{tile.x + first, tile.y, last - first, tile.height}
                            : Tile{tile.x, tile.y + first, tile.width, last - first};
    }
};

// A tile of two numerators F and of Q: the linear functions, their values at the corner fragments and bounds on their
// errors. What holds at the corners with a margin for rounding holds at every fragment.
struct Corners {
    RampOf<Double2> numerator_ramp;
    Ramp q_ramp;
    Double2 numerator[4];
    double q[4];
    Double2 numerator_error;
    double q_error;
    Double2 largest_numerator;  // the largest |F|
    double least_q, largest_q;
    double reciprocal;  // the largest 1 / q, for a tile in front

    bool all_behind() const noexcept { return largest_q <= -q_error; }
    bool all_in_front() const noexcept { return least_q > q_error; }
    // Whether so little is left of the functions' terms that many quotients would be in doubt, as far from the corner
    // that the planes are about. Where q has both signs there is doubt beside q = 0 in any case.
    bool cancel() const noexcept {
        return q_cancels() || any_less(largest_numerator * cancelled_share, numerator_error);
    }
    bool q_cancels() const noexcept {
        const double size = least_q > q_error ? least_q : larger(-least_q, largest_q);
        return q_error > cancelled_share * size;
    }
    bool is_well_in_front() const noexcept { return least_q > well_in_front * q_error; }
    bool has_one_error() const noexcept { return is_well_in_front() && least_q > share_for_one_error * largest_q; }
    // Also, the product of two q is in range, so that they may share a division.
    bool may_share_divisions() const noexcept { return has_one_error() && least_q > 0x1p-500 && largest_q < 0x1p500; }

    static constexpr int few = 4 * TileJob::unit_size;

    // The stretch of a tile that is next to q = 0, along the side by which q varies more: what comes before and after
    // it is behind, or there q is no less than a fourth of its largest. The whole tile where no such stretch is found;
    // where it would hold more than a few fragments, an empty one in the middle of the longer side, which halves the
    // tile.
    TEXGEN_RARE Stretch next_to_zero(const Tile& tile) const noexcept {
        const bool across_width = std::fabs(q_ramp.dx) * tile.width >= std::fabs(q_ramp.dy) * tile.height;
        const int size = across_width ? tile.width : tile.height;
        const double step = across_width ? q_ramp.dx : q_ramp.dy;
        const double per_step = 1.0 / std::fabs(step);
        // Index i counts from where q is least: there q is at most largest_q - (size - 1 - i) |step|, and at least
        // least_q + i |step|.
        const auto clamped = [size](double i) { return i > 0.0 ? (i < size ? static_cast<int>(i) : size) : 0; };
        int begin = clamped(size - 1 - (largest_q + q_error) * per_step);
        int end = clamped((0x1p-2 * largest_q - least_q) * per_step + 1.0);
        if (begin >= end) {
            begin = 0;
            end = size;
        }
        if (std::int64_t{end - begin} * (across_width ? tile.height : tile.width) > few) {
            const bool is_wide = tile.width >= tile.height;
            const int half = (is_wide ? tile.width : tile.height) / 2;
            return {is_wide, half, half};
        }
        return step < 0.0 ? Stretch{across_width, size - end, size - begin} : Stretch{across_width, begin, end};
    }

    // The largest |F/Q| of a tile in front. Where Q varies little the quotient of the bounds will do; else the corners
    // have it, u = F/Q being monotone along every line.
    TEXGEN_APART Double2 largest_quotient() const noexcept {
        if (largest_q < 1.25 * least_q) return (largest_numerator + numerator_error) * reciprocal;
        Double2 size[4];
        TEXGEN_FOR (std::size_t i = 0; i < 4; ++i)
            size[i] = (magnitude(numerator[i]) + numerator_error) / ((q[i] - q_error) * reciprocal);
        return larger(larger(size[0], size[1]), larger(size[2], size[3])) * reciprocal;
    }

    // The least |F| of a numerator that does not change its sign; of another 0 or less.
    Double2 least_numerator() const noexcept {
        const auto& f = numerator;
        return larger(smaller(smaller(f[0], f[1]), smaller(f[2], f[3])),
                      -larger(larger(f[0], f[1]), larger(f[2], f[3]))) -
               numerator_error;
    }
    // No |F/Q| of a tile in front is below this.
    Double2 least_quotient() const noexcept { return least_numerator() / (largest_q + q_error); }

    // The error of F/Q in double for a tile well in front: as in certain_quotient(), where it is worst. A division for
    // two q has two more roundings: their product, its reciprocal, that times the other q, and the quotient, before it
    // is moved by its error.
    Double2 quotient_error(const Double2& largest) const noexcept {
        return (numerator_error + largest * q_error) * (1.0001 * reciprocal) + largest * (6.0 * unit_roundoff_double);
    }

    // The error of F/Q with F and Q rounded to float, then the reciprocal and the product. With 2^-21 <= Q <= 2 a float
    // of F that is subnormal, or flushed to zero, adds less than 2^-104.
    Double2 float_divided_error() const noexcept {
        const Double2 largest = largest_quotient();
        return largest * float_divided_roundings + 0x1p-104 + quotient_error(largest);
    }

    // How many of its own ulps the error of a quotient in double is at most, two more roundings included, as 1 less
    // than a power of two: the middles of floats are doubles whose last 29 bits are 2^28, so of a quotient that is
    // farther from those the nearest float is certain. 0 where that is too many, or a quotient may be no normal float.
    // For a tile well in front, where no numerator changes its sign, so that the corners have the least |F|: F/Q errs
    // by e_F / |F| + e_Q / Q of itself and six roundings, and an ulp of it is at least 2^-53 of it.
    std::int32_t ulps_of_quotients() const noexcept {
        const Double2 least = least_numerator();
        if (!all_less(double2_of(0x1p-124, 0x1p-124) * largest_q, least)) return 0;
        const double share =
            larger(numerator_error[0] / least[0], numerator_error[1] / least[1]) + q_error * reciprocal;
        const double ulps = share * 0x1.01p53 + 6.0;
        return ulps < 0x1p15 ? mask_of_ulps(ulps) : 0;
    }
};

// Takes the values at the corner fragments, once the functions and their errors are known.
TEXGEN_APART inline void take_corners(Corners& corners, const Tile& tile) noexcept {
    const double right = tile.width - 1;
    const double bottom = tile.height - 1;
    const auto fill = [&](const auto& ramp, auto& value) {
        value[0] = ramp.base;
        value[1] = ramp.base + ramp.dx * right;
        value[2] = ramp.base + ramp.dy * bottom;
        value[3] = value[2] + ramp.dx * right;
    };
    fill(corners.numerator_ramp, corners.numerator);
    fill(corners.q_ramp, corners.q);
    const auto& f = corners.numerator;
    corners.largest_numerator =
        larger(larger(magnitude(f[0]), magnitude(f[1])), larger(magnitude(f[2]), magnitude(f[3])));
    corners.least_q = smaller(smaller(corners.q[0], corners.q[1]), smaller(corners.q[2], corners.q[3]));
    corners.largest_q = larger(larger(corners.q[0], corners.q[1]), larger(corners.q[2], corners.q[3]));
    corners.reciprocal = 1.0 / (corners.least_q - corners.q_error);
}

TEXGEN_APART inline Corners corners_of(const TrianglePlanes& planes, const PlaneOf<Double2>& numerator, const Plane& q,
                                       const Tile& tile) noexcept {
    Corners corners;
    corners.numerator_ramp = planes.ramp(numerator, tile);
    corners.q_ramp = planes.ramp(q, tile);
    corners.numerator_error = planes.error(numerator, tile);
    corners.q_error = planes.error(q, tile);
    take_corners(corners, tile);
    return corners;
}

// Takes the functions from two doubles. Each coefficient is rounded to double; its product with an index, which is less
// than the width or the height, and two sums are rounded once each.
TEXGEN_RARE inline void take_corners(Corners& corners, const CloseRamps& close) noexcept {
    const auto& [s, t, q] = close.function;
    const auto high = [](const DoubleDouble& of_s, const DoubleDouble& of_t) {
        return double2_of(of_s.high, of_t.high);
    };
    const Tile last{0, 0, close.tile.width - 1, close.tile.height - 1};
    const auto error = [&last](const CloseRamp& ramp) { return ramp.error + gamma(4) * ramp.size_over(last); };
    corners.numerator_ramp = {high(s.term[0], t.term[0]), high(s.term[1], t.term[1]), high(s.term[2], t.term[2])};
    corners.q_ramp = {q.term[0].high, q.term[1].high, q.term[2].high};
    corners.numerator_error = double2_of(error(s), error(t));
    corners.q_error = error(q);
    take_corners(corners, close.tile);
}

// Takes the planes of these corners as the functions of a tile in doubt.
TEXGEN_RARE inline void take_planes(const Corners& at, CloseFunctions& functions) noexcept {
    const auto& [base, dx, dy] = at.numerator_ramp;
    for (std::size_t k = 0; k < 2; ++k) {
        functions.function[k].high = {base[k], dx[k], dy[k]};
        functions.function[k].error = at.numerator_error[k];
    }
    functions.function[CloseFunctions::q].high = at.q_ramp;
    functions.function[CloseFunctions::q].error = at.q_error;
}

// The row or column of a tile that lies on an edge along which a coordinate is 0, as it is at both of its corners; an
// empty stretch where there is none.
TEXGEN_RARE inline Stretch zeros_of(const TrianglePlanes& planes, glm::length_t coordinate, const Tile& tile) noexcept {
    const std::int64_t first[] = {tile.x, tile.y};
    const int size[] = {tile.width, tile.height};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        if (planes.value(i, coordinate) != 0.0 || planes.value(j, coordinate) != 0.0) continue;
        for (glm::length_t axis = 0; axis < 2; ++axis) {
            const double place = planes.corner(i)[axis];
            const int index = planes.corner(j)[axis] == place ? index_at(place, first[axis], size[axis]) : -1;
            if (index >= 0) return {axis == 0, index, index + 1};
        }
    }
    return {};
}

// Whether q cancels, or a numerator does for another reason than that it is 0 in a row or column, where two doubles
// would tell no more.
TEXGEN_RARE inline bool cancel_beyond_zeros(const Corners& at, const TrianglePlanes& planes, glm::length_t of_first,
                                            glm::length_t of_second, const Tile& tile) noexcept {
    if (at.q_cancels()) return true;
    for (std::size_t k = 0; k < 2; ++k)
        if (at.largest_numerator[k] * cancelled_share < at.numerator_error[k] &&
            zeros_of(planes, k == 0 ? of_first : of_second, tile).end == 0)
            return true;
    return false;
}

// An upper bound on |Q|.
inline double largest_q_of(const Corners& at) noexcept {
    return larger(std::fabs(at.least_q), std::fabs(at.largest_q)) + at.q_error;
}

// The side of a region at a bound is G = F - bound Q, positive above the bound and negative below it. The float that is
// written may be on the other side than the exact value, by an ulp, by the tolerance (twice that leaves room), or as a
// 0 that was subnormal: so an answer must hold with that much slack, and with room for what F, Q and G are rounded by,
// which is the first of these and |bound| times the second; q is the largest |Q|.
inline Double2 margin_of_sides(const Corners& at, double tolerance, double q) noexcept {
    return (at.numerator_error + (0x1p-125 + 2.0 * tolerance) * q) * 1.0001;
}
inline double margin_of_bounds(const Corners& at, double q) noexcept { return (at.q_error + 0x1.001p-22 * q) * 1.0001; }

// The bounds of a region as finite numbers. An infinite one that bounds nothing becomes a number that no quotient of a
// triangle comes near; one that only infinity meets becomes what is rounded to infinity. A NaN stays one.
inline constexpr double bound_of_none = 0x1p500, bound_of_infinity = 0x1p128;
inline Double2 finite_min(const Double2& min) noexcept {
    return larger(double2_of(-bound_of_none, -bound_of_none),
                  smaller(double2_of(bound_of_infinity, bound_of_infinity), min));
}
inline Double2 finite_max(const Double2& max) noexcept {
    return larger(double2_of(-bound_of_infinity, -bound_of_infinity),
                  smaller(double2_of(bound_of_none, bound_of_none), max));
}

// How much of all fragments in front, if there are any, is between two bounds of the one numerator and two of the
// other: the corners have the least and the largest of G.
inline Coverage coverage_by_sides(const Corners& at, const Double2& min, const Double2& max,
                                  double tolerance) noexcept {
    struct Side {
        Double2 least, largest, margin;
    };
    const double q = largest_q_of(at);
    const Double2 margin = margin_of_sides(at, tolerance, q);
    const double margin_of_bound = margin_of_bounds(at, q);
    const auto side_of = [&](const Double2& bound) {
        Double2 g[4];
        TEXGEN_FOR (std::size_t i = 0; i < 4; ++i) g[i] = at.numerator[i] - bound * at.q[i];
        return Side{smaller(smaller(g[0], g[1]), smaller(g[2], g[3])), larger(larger(g[0], g[1]), larger(g[2], g[3])),
                    margin + magnitude(bound) * margin_of_bound};
    };
    const Side of_min = side_of(finite_min(min));
    const Side of_max = side_of(finite_max(max));
    if (any_less(of_min.largest, -of_min.margin) || any_less(of_max.margin, of_max.least)) return Coverage::outside;
    const bool all_inside = all_less(of_min.margin, of_min.least) && all_less(of_max.largest, -of_max.margin);
    return all_inside && at.all_in_front() ? Coverage::inside : Coverage::partial;
}

// How much is in the sides of a region; the numerators are s and t.
inline Coverage st_coverage(const Corners& at, const LitTest& lit, double tolerance) noexcept {
    return coverage_by_sides(at, double2_of(lit.least(0), lit.least(1)), double2_of(lit.greatest(0), lit.greatest(1)),
                             tolerance);
}
// How much is in its depth; both numerators are r.
inline Coverage r_coverage(const Corners& at, const LitTest& lit, double tolerance) noexcept {
    const double min = widened(lit.r_min), max = widened(lit.r_max);
    return coverage_by_sides(at, double2_of(min, min), double2_of(max, max), tolerance);
}

}  // namespace TEXGEN_DETAIL_BUILD
