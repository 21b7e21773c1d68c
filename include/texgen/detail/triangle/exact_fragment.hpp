#pragma once

// Exact sums for what doubles leave in doubt of a triangle's planes, at one fragment or over a tile.

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "../arithmetic/expansion.hpp"
#include "../arithmetic/rounding.hpp"
#include "../arithmetic/widen.hpp"
#include "../language.hpp"
#include "close_planes.hpp"
#include "planes.hpp"

namespace TEXGEN_DETAIL {

// The functions at one fragment, exactly: F = sum G_i f_i with G_i = E_i w_j w_k, without the planes' common factor, or
// up to any positive one where Factor::any will do.
class ExactFragment {
public:
    // 8 products are 16 doubles, times a weight 32; three such times a value are 192.
    using Sum = Expansion<192>;
    enum class Factor { of_planes, any };

    TEXGEN_RARE ExactFragment(const TrianglePlanes& planes, std::int64_t x, std::int64_t y,
                              Factor up_to = Factor::of_planes) noexcept
        : planes_(planes) {
        const ToCorners to(planes, x, y);
        const std::size_t opposite = up_to == Factor::any ? to.find_side() : 3;
        if (opposite < 3) {
            take_side(to, opposite);
            return;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            const Side side(planes, i);
            Sum edge;
            edge.add_product(to.x[j], side.y);
            edge.add_product(-to.y[j], side.x);
            weighted_[i].add_scaled(edge, planes.unscaled_weight(i));
        }
    }

    // Whether a fragment is on the line through two corners, where exact sums are short.
    TEXGEN_RARE static bool is_on_side(const TrianglePlanes& planes, const Tile& fragment) noexcept {
        return ToCorners(planes, fragment.x, fragment.y).find_side() < 3;
    }

    // By how much the functions grow along a row (axis 0) or down (1): E_i grows by the difference of corners j and k.
    TEXGEN_RARE static ExactFragment growth(const TrianglePlanes& planes, glm::length_t axis) noexcept {
        ExactFragment result(planes);
        for (std::size_t i = 0; i < 3; ++i) {
            const Side side(planes, i);
            result.weighted_[i].add_product(axis == 0 ? -side.y : side.x, {planes.unscaled_weight(i), 0.0});
        }
        return result;
    }

    // F of one coordinate, 0 to 3 for s, t, r, q.
    TEXGEN_RARE Sum function(glm::length_t coordinate) const noexcept {
        Sum sum;
        for (std::size_t i = 0; i < 3; ++i) sum.add_scaled(weighted_[i], planes_.value(i, coordinate));
        return sum;
    }

private:
    explicit ExactFragment(const TrianglePlanes& planes) noexcept : planes_(planes) {}

    // The side opposite corner i, from j to k. It has fewer digits than the difference of k and a fragment far away.
    struct Side {
        DoubleDouble x, y;

        TEXGEN_RARE Side(const TrianglePlanes& planes, std::size_t i) noexcept {
            const glm::dvec2 from = planes.corner((i + 1) % 3), to = planes.corner((i + 2) % 3);
            x = two_sum(to.x, -from.x);
            y = two_sum(to.y, -from.y);
        }
    };

    // From a fragment to the corners.
    struct ToCorners {
        DoubleDouble x[3], y[3];

        TEXGEN_RARE ToCorners(const TrianglePlanes& planes, std::int64_t from_x, std::int64_t from_y) noexcept {
            for (std::size_t i = 0; i < 3; ++i) {
                x[i] = two_sum(planes.corner(i).x, -(static_cast<double>(from_x) + 0.5));  // integers
                y[i] = two_sum(planes.corner(i).y, -(static_cast<double>(from_y) + 0.5));  // integers
            }
        }

        // The corner opposite a side on whose line the fragment is; 3 where it is on none, or a difference is no double.
        TEXGEN_RARE std::size_t find_side() const noexcept {
            std::size_t i = 0;
            for (; i < 3; ++i) {
                const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
                if (x[j].low != 0.0 || y[j].low != 0.0 || x[k].low != 0.0 || y[k].low != 0.0) continue;
                const DoubleDouble left = two_product(x[j].high, y[k].high);
                const DoubleDouble right = two_product(y[j].high, x[k].high);
                if (left.high == right.high && left.low == right.low) break;
            }
            return i;
        }
    };

    // On the line through corners j and k the third corner, i, has no part in F, and its numbers may be long. Along
    // either axis G_j : G_k = w_k (k - p) : w_j (p - j) there.
    TEXGEN_RARE void take_side(const ToCorners& from, std::size_t i) noexcept {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        const DoubleDouble(&to)[3] = from.x[j].high != from.x[k].high ? from.x : from.y;
        for (const std::size_t end : {j, k}) {
            const std::size_t other = end == j ? k : j;
            const double side = to[end].high < to[other].high ? to[other].high : -to[other].high;
            weighted_[end].add_product(side, widened(planes_.vertex(other).clip_w));
        }
    }

    const TrianglePlanes& planes_;
    Sum weighted_[3];
};

// Makes two numerators and q over a tile anew where their terms cancel even in two doubles: from exact growths, within
// 2^-104 of each, and from the value at the first corner, where only one term is not 0: F(A) = area w_b w_c f_A.
// Products, sums and steps within the tile err by less than 2^-97 of the three. Where that corner is so far away that
// this would say less, they stay as they are.
TEXGEN_RARE inline void take_exact_growths(const TrianglePlanes& planes, glm::length_t first, glm::length_t second,
                                           ClosePlanes& close) noexcept {
    const Tile& tile = close.tile();
    const DoubleDouble x = two_sum(static_cast<double>(tile.x) + 0.5, -planes.corner(0).x);  // integers
    const DoubleDouble y = two_sum(static_cast<double>(tile.y) + 0.5, -planes.corner(0).y);  // integers
    const double reach_x = std::fabs(x.high) + tile.width, reach_y = std::fabs(y.high) + tile.height;
    const DoubleDouble weight = product(planes.exact_area().leading(), {planes.weight(0), 0.0});
    const ExactFragment growth[] = {ExactFragment::growth(planes, 0), ExactFragment::growth(planes, 1)};
    for (const glm::length_t coordinate : {first, second, glm::length_t{3}}) {
        if (close.is_exact(coordinate)) continue;
        CloseRamp ramp;
        auto& [term, error] = ramp;
        term[0] = product(weight, {planes.value(0, coordinate), 0.0});
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const DoubleDouble leading = growth[axis].function(coordinate).leading();
            term[1 + axis] = {leading.high * planes.factor(), leading.low * planes.factor()};
        }
        error = 0x1p-97 *
                    (std::fabs(term[0].high) + std::fabs(term[1].high) * reach_x + std::fabs(term[2].high) * reach_y) +
                0x1p-800;
        ramp.move(x, y);
        close.replace(coordinate, ramp);
    }
}

}  // namespace TEXGEN_DETAIL
