#pragma once

// The linear functions of a triangle to twice the precision of double, about the first fragment of a tile: for tiles where
// the planes cancel (a corner far outside of the window, q next to 0) and for quotients next to the middle of two floats.
//
// F = sum E_i c_i as in planes.hpp, but from the differences between the fragment and the corners: what is large at a far
// corner never enters.

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "expansion.hpp"
#include "lanes.hpp"
#include "planes.hpp"
#include "rounding.hpp"

namespace TEXGEN_DETAIL {

// base + i dx + j dy, within `error` of the exact value at every fragment of the tile that it was made for. The exact value is a
// multiple of `grain`, a power of two (or 0, where that is not known).
struct CloseRamp {
    DoubleDouble base, dx, dy;
    double error, grain;

    CloseRamp moved(std::int64_t x, std::int64_t y) const noexcept {
        const auto right = static_cast<double>(x);  // integers
        const auto down = static_cast<double>(y);   // integers
        const DoubleDouble along_x = product(dx, {right, 0.0});
        const DoubleDouble along_y = product(dy, {down, 0.0});
        return {sum(base, sum(along_x, along_y)), dx, dy, error, grain};
    }

    // |base| + |i dx| + |j dy| where that is largest.
    double size(const Tile& tile) const noexcept {
        return std::fabs(base.high) + tile.width * std::fabs(dx.high) + tile.height * std::fabs(dy.high);
    }

    // As high and low parts, see CloseFunction. The coefficients of low are at most half a unit: they, two products and two
    // sums are rounded in double, 6 u of half of width + height + 1 units (2^-53 = u; 2^-50 has room for every direction).
    CloseFunction split(const Tile& tile) const noexcept {
        const double unit = unit_for(tile);
        const double rounder = 0x1.8p52 * unit;
        CloseFunction function;
        const auto part = [rounder](const DoubleDouble& value, double& high, double& low) {
            high = (value.high + rounder) - rounder;
            low = (value.high - high) + value.low;
        };
        part(base, function.high.base, function.low.base);
        part(dx, function.high.dx, function.low.dx);
        part(dy, function.high.dy, function.low.dy);
        function.error = error + 0x1p-50 * (1.0 + tile.width + tile.height) * unit;
        function.grain = grain;
        return function;
    }
    double unit_for(const Tile& tile) const noexcept {
        const double size = this->size(tile);
        return size > 0.0 ? 0x1p-50 / reciprocal_power_of_two(size) : 0.0;
    }
};

// Two numerators and q over a tile.
struct CloseRamps {
    Tile tile;
    CloseRamp numerator[2];
    CloseRamp q;

    CloseRamps moved_to(const Tile& part) const noexcept {
        const std::int64_t x = part.x - tile.x;
        const std::int64_t y = part.y - tile.y;
        return {part, {numerator[0].moved(x, y), numerator[1].moved(x, y)}, q.moved(x, y)};
    }

    CloseFunctions split() const noexcept {
        return {{numerator[0].split(tile), numerator[1].split(tile)}, q.split(tile), 0x1.8p78 * q.unit_for(tile)};
    }
};

// What all functions of a triangle share over a tile. With double-double sums within 2^-103 of their terms and products
// within 2^-103, E_i errs by 2^-102 of the two products that it is the difference of, and the value by 2^-100 of theirs
// times the c_i: 2^-97 leaves room for every direction of rounding.
class ClosePlanes {
public:
    ClosePlanes(const TrianglePlanes& planes, const Tile& tile) noexcept : planes_(planes), tile_(tile) {
        const double x = static_cast<double>(tile.x) + 0.5;  // integers
        const double y = static_cast<double>(tile.y) + 0.5;  // integers
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec2 corner = planes.corner(i);
            to_x_[i] = two_sum(corner.x, -x);
            to_y_[i] = two_sum(corner.y, -y);
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            const std::size_t k = (i + 2) % 3;
            const DoubleDouble left = product(to_x_[j], to_y_[k]);
            const DoubleDouble right = product(to_y_[j], to_x_[k]);
            edge_[i] = sum(left, -right);
            edge_dx_[i] = two_sum(planes.corner(j).y, -planes.corner(k).y);
            edge_dy_[i] = two_sum(planes.corner(k).x, -planes.corner(j).x);
            magnitude_[i] = std::fabs(left.high) + std::fabs(right.high) + tile.width * std::fabs(edge_dx_[i].high) +
                            tile.height * std::fabs(edge_dy_[i].high);
        }
    }

    CloseRamp ramp(glm::length_t coordinate) const noexcept {
        CloseRamp ramp{};
        double magnitude = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            const DoubleDouble c = two_product(planes_.value(i, coordinate), planes_.weight(i));
            ramp.base = sum(ramp.base, product(edge_[i], c));
            ramp.dx = sum(ramp.dx, product(edge_dx_[i], c));
            ramp.dy = sum(ramp.dy, product(edge_dy_[i], c));
            magnitude += magnitude_[i] * std::fabs(c.high);
        }
        ramp.error = 0x1p-97 * magnitude + 0x1p-1000;
        ramp.grain = planes_.grain(coordinate);
        return ramp;
    }

    CloseRamps ramps(glm::length_t first, glm::length_t second) const noexcept {
        return {tile_, {ramp(first), ramp(second)}, ramp(3)};
    }

private:
    const TrianglePlanes& planes_;
    Tile tile_;
    DoubleDouble to_x_[3], to_y_[3];                  // from the first fragment to the corners
    DoubleDouble edge_[3], edge_dx_[3], edge_dy_[3];  // of the side opposite each corner
    double magnitude_[3];
};

// F at one fragment.
inline Bounded close_to(const TrianglePlanes& planes, glm::length_t coordinate, std::int64_t x,
                        std::int64_t y) noexcept {
    const CloseRamp ramp = ClosePlanes(planes, {x, y, 1, 1}).ramp(coordinate);
    const double value = ramp.base.high + ramp.base.low;
    if (4.0 * ramp.error < ramp.grain && std::fabs(value) < 0.5 * ramp.grain) return {0.0, 0.0};
    return {value, ramp.error + 0x1p-52 * std::fabs(value)};
}

}  // namespace TEXGEN_DETAIL
