#pragma once

// Triangles as the projector sees them, quadrilaterals, and what is exactly true of both. The hard ones are edge on,
// next to it, or next to a triangle, up to a bit.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "judges/exact.hpp"
#include "judges/oracle.hpp"
#include "judges/real.hpp"
#include "support/random.hpp"
#include "texgen/surface.hpp"

namespace support {

// (s, t, r, q) of a triangle's corners.
using Corners = std::array<glm::vec4, 3>;

// The determinant of three of the coordinates.
inline Dyadic exact_determinant(const Corners& corners, int x, int y, int z) {
    const auto at = [&](std::size_t corner, int k) { return Dyadic(static_cast<double>(corners[corner % 3][k])); };
    Dyadic sum;
    for (std::size_t i = 0; i < 3; ++i) sum = sum + (at(i, x) * at(i + 1, y) - at(i + 1, x) * at(i, y)) * at(i + 2, z);
    return sum;
}
inline Dyadic exact_determinant(const Corners& corners) { return exact_determinant(corners, 0, 1, 3); }

enum class CornerFamily { ordinary, behind, next_to_edge_on, edge_on, graded, any_bits, far_corner };
inline constexpr std::array corner_families{
    CornerFamily::ordinary, CornerFamily::behind,   CornerFamily::next_to_edge_on, CornerFamily::edge_on,
    CornerFamily::graded,   CornerFamily::any_bits, CornerFamily::far_corner};

inline float small_number(Random& random) { return to_float(std::ldexp(random.integer(-1 << 20, 1 << 20), -18)); }

inline Corners corners_of(CornerFamily family, Random& random) {
    Corners corners{};
    for (glm::vec4& corner : corners) {
        corner = random.vector4(2.0);
        corner.w = random.uniform_float(0.5, 4.0);
    }
    switch (family) {
        case CornerFamily::ordinary:
            break;
        case CornerFamily::behind:
            for (glm::vec4& corner : corners) corner.w = random.uniform_float(-4.0, 4.0);
            break;
        case CornerFamily::next_to_edge_on: {
            // On the line of two others, rounded, and up to a few ulp beside it.
            const double along = random.uniform(-1.0, 2.0);
            for (int k = 0; k < 4; ++k) {
                const double between =
                    static_cast<double>(corners[0][k]) +
                    along * (static_cast<double>(corners[1][k]) - static_cast<double>(corners[0][k]));
                corners[2][k] = neighbour(to_float(between), random.integer(-2, 2));
            }
            break;
        }
        case CornerFamily::edge_on: {
            // a, b and a + b or a power of two times a; up to units of coordinates and of corners.
            for (int k = 0; k < 4; ++k) {
                corners[0][k] = small_number(random);
                corners[1][k] = small_number(random);
                corners[2][k] = corners[0][k] + corners[1][k];
            }
            if (random.coin()) corners[1] = 4.0f * corners[2];
            if (random.coin())
                for (int k = 0; k < 4; ++k) {
                    const float unit = std::ldexp(1.0f, random.integer(-60, 60));
                    for (glm::vec4& corner : corners) corner[k] *= unit;
                }
            for (glm::vec4& corner : corners) corner *= std::ldexp(1.0f, random.integer(-20, 20));
            // And one bit beside it.
            if (random.coin()) {
                float& number = corners[static_cast<std::size_t>(random.integer(0, 2))][random.integer(0, 3)];
                number = neighbour(number, random.integer(-1, 1));
            }
            break;
        }
        case CornerFamily::far_corner: {
            // One is so far to the side that the others decide by what no two doubles hold beside it: it cancels
            // wholly.
            corners[0].x = std::ldexp(corners[0].x, random.integer(20, 120));
            const float unit = std::ldexp(1.0f, random.integer(-4, 4));
            corners[2].y = unit * corners[1].y;
            corners[2].w = unit * corners[1].w;
            break;
        }
        case CornerFamily::graded:
            for (glm::vec4& corner : corners)
                for (int k = 0; k < 4; ++k)
                    corner[k] = random.integer(0, 3) == 0 ? 0.0f : std::ldexp(corner[k], random.integer(-120, 120));
            if (random.coin()) corners[2] = -corners[0];
            break;
        case CornerFamily::any_bits:
            for (glm::vec4& corner : corners)
                for (int k = 0; k < 4; ++k) corner[k] = random.any_finite();
            break;
    }
    std::swap(corners[0], corners[static_cast<std::size_t>(random.integer(0, 2))]);
    return corners;
}

// |computed - n/d| over |n/d|; 0 where both are 0.
inline double relative_error(double computed, const Quotient& exact) {
    if (exact.n.sign() == 0) return computed == 0.0 ? 0.0 : HUGE_VAL;
    return std::fabs(((Dyadic(computed) * exact.d - exact.n).estimate()) / exact.n.estimate());
}

inline Quotient exact_slide_area(const Corners& corners) {
    Dyadic divisor(2.0);
    for (const glm::vec4& corner : corners) divisor = divisor * Dyadic(static_cast<double>(corner.w));
    return {exact_determinant(corners), divisor};
}

// Cramer's rule.
inline std::array<Quotient, 3> exact_receiver_plane(const Corners& corners) {
    const Dyadic divisor = exact_determinant(corners);
    return {Quotient{exact_determinant(corners, 2, 1, 3), divisor},
            Quotient{exact_determinant(corners, 0, 2, 3), divisor},
            Quotient{exact_determinant(corners, 0, 1, 2), divisor}};
}

inline texgen::Facing facing_of_sign(int sign, texgen::TextureOrigin origin) {
    if (sign == 0) return texgen::Facing::edge_on;
    return (sign > 0) == (origin == texgen::TextureOrigin::bottom_left) ? texgen::Facing::towards
                                                                        : texgen::Facing::away;
}

// The corners of a quadrilateral.
using Quadrilateral = std::array<glm::dvec2, 4>;

enum class Shape { ordinary, whole_numbers, next_to_a_triangle, far_away, any_unit, thin, graded };
inline constexpr std::array shapes{Shape::ordinary, Shape::whole_numbers, Shape::next_to_a_triangle,
                                   Shape::far_away, Shape::any_unit,      Shape::thin,
                                   Shape::graded};

inline Quadrilateral corners_of(Shape shape, Random& random) {
    Quadrilateral corners{{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}};
    for (glm::dvec2& corner : corners) corner += glm::dvec2(random.uniform(-0.45, 0.45), random.uniform(-0.45, 0.45));
    switch (shape) {
        case Shape::ordinary:
            break;
        case Shape::whole_numbers:
            for (glm::dvec2& corner : corners) corner = glm::dvec2(random.integer(-3, 3), random.integer(-3, 3));
            break;
        case Shape::next_to_a_triangle: {
            // A corner on the diagonal of its neighbours, up to a few ulp.
            const std::size_t k = random.bits() % 4;
            const glm::dvec2 &from = corners[(k + 1) % 4], &to = corners[(k + 3) % 4];
            corners[k] = from + random.uniform(-0.2, 1.2) * (to - from);
            for (int i = 0; i < 2; ++i) corners[k][i] += random.integer(-4, 4) * double_ulp(corners[k][i]);
            break;
        }
        case Shape::far_away: {
            const glm::dvec2 away = random.power_of_ten(2.0, 7.0) * glm::dvec2(random.direction());
            for (glm::dvec2& corner : corners) corner += away;
            break;
        }
        case Shape::any_unit: {
            const glm::dvec2 unit(random.power_of_ten(-100.0, 100.0), random.power_of_ten(-100.0, 100.0));
            for (glm::dvec2& corner : corners) corner *= unit;
            break;
        }
        case Shape::graded: {
            // Each number has a size of its own, up to the largest and the least that are taken.
            const int most = std::array{3, 30, 100, 400}[random.bits() % 4];
            for (glm::dvec2& corner : corners)
                for (int i = 0; i < 2; ++i)
                    corner[i] = random.integer(0, 4) == 0
                                    ? 0.0
                                    : std::ldexp(corner[i] < 0.3 ? corner[i] - 1.2 : corner[i] + 0.4,
                                                 random.integer(1 - most, most - 1));
            break;
        }
        case Shape::thin: {
            // All corners next to one line.
            const double width = random.power_of_ten(-18.0, -1.0);
            const glm::dvec2 along = glm::dvec2(random.direction());
            for (glm::dvec2& corner : corners)
                corner = corner.x * along + width * corner.y * glm::dvec2(-along.y, along.x);
            break;
        }
    }
    if (random.coin()) std::swap(corners[1], corners[3]);
    if (random.integer(0, 3) == 0) std::swap(corners[1], corners[2]);  // that one crosses itself
    return corners;
}

inline Rational exact_area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (exactly(b.x) - exactly(a.x)) * (exactly(c.y) - exactly(a.y)) -
           (exactly(c.x) - exactly(a.x)) * (exactly(b.y) - exactly(a.y));
}

// The q of the corners, the largest 1; empty where they are not strictly convex.
inline std::optional<std::array<Rational, 4>> exact_q(const Quadrilateral& corners) {
    std::array<Rational, 4> area;
    Rational least;
    for (std::size_t i = 0; i < 4; ++i) {
        area[i] = exact_area(corners[(i + 1) % 4], corners[(i + 2) % 4], corners[(i + 3) % 4]);
        if (area[i] == 0 || (area[i] > 0) != (area[0] > 0)) return std::nullopt;
        if (i == 0 || magnitude(area[i]) < least) least = magnitude(area[i]);
    }
    for (Rational& a : area) a = least / magnitude(a);
    return area;
}

// The whole texture, or a tile of an atlas.
inline texgen::TextureRegion region_of(bool is_whole, Random& random) {
    if (is_whole) return texgen::whole_texture();
    const glm::dvec2 least(random.uniform(-1.0, 0.9), random.uniform(-1.0, 0.9));
    return texgen::atlas_tile(least, {random.uniform(1.0, 3.0), random.uniform(1.0, 3.0)});
}

// How far the elements of a keystone are from those of the exact homography, the largest of them: as a share of the
// magnitudes of their two terms, or of 2^-1000.
inline double measured_keystone_error(const texgen::WindowTexgen& keystone, const Quadrilateral& corners,
                                      const texgen::TextureRegion& region) {
    const std::array<Rational, 4> q = exact_q(corners).value();
    // What is 0 on the side from corner k on, and q on the opposite one.
    const auto from_side = [&](std::size_t k) {
        const glm::dvec2 &from = corners[k], &to = corners[(k + 1) % 4], &opposite = corners[(k + 2) % 4];
        const Rational unit = q[(k + 2) % 4] / exact_area(from, to, opposite);
        return std::array<Rational, 3>{unit * (exactly(from.y) - exactly(to.y)),
                                       unit * (exactly(to.x) - exactly(from.x)),
                                       unit * (exactly(from.x) * exactly(to.y) - exactly(to.x) * exactly(from.y))};
    };
    const auto bottom = from_side(0), right = from_side(1), top = from_side(2), left = from_side(3);
    const glm::dmat4& m = keystone.matrix();
    double worst = 0.0;
    for (int column = 0; column < 4; ++column) {
        // z does nothing, and there is no r.
        const auto c = static_cast<std::size_t>(column == 3 ? 2 : column);
        std::array<std::array<Rational, 2>, 4> terms{};
        if (column != 2)
            terms = {{{exactly((region.min)().x) * right[c], exactly((region.max)().x) * left[c]},
                      {exactly((region.min)().y) * top[c], exactly((region.max)().y) * bottom[c]},
                      {0, 0},
                      {right[c], left[c]}}};
        for (int row = 0; row < 4; ++row) {
            const auto& [one, other] = terms[static_cast<std::size_t>(row)];
            const Rational size = magnitude(one) + magnitude(other), exact = one + other;
            const Rational error = magnitude(Rational(exactly(m[column][row]) - exact));
            worst = std::max(worst, nearest<double>(Rational(error / std::max(size, power_of_two(-1000)))));
        }
    }
    return worst;
}

}  // namespace support
