#pragma once

// The linear functions of a triangle to twice the precision of double, about the first fragment of a tile: for tiles where
// the planes cancel (a corner far outside of the window, q next to 0) and for quotients next to the middle of two floats.
//
// F = sum E_i c_i as in planes.hpp, but from the differences between the fragment and the corners: what is large at a far
// corner never enters.

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "../arithmetic/expansion.hpp"
#include "../arithmetic/rounding.hpp"
#include "../simd/lanes.hpp"
#include "planes.hpp"

namespace TEXGEN_DETAIL {

// base + i dx + j dy: these three terms. Within `error` of the exact value at every fragment of the tile that it was made for;
// that value is a multiple of `grain`, a power of two (or 0, where that is not known).
struct CloseRamp {
    DoubleDouble term[3];
    double error, grain;

    CloseRamp moved(double x, double y) const noexcept {
        CloseRamp result = *this;
        for (std::size_t j = 1; j < 3; ++j)
            result.term[0] = sum(result.term[0], product(term[j], {j == 1 ? x : y, 0.0}));
        return result;
    }

    // Of double coefficients: takes the multiples of the grain next to them, if their errors leave no others.
    bool take_multiples() noexcept {
        if (!(4.0 * error < grain)) return false;
        const double rounder = 0x1.8p52 * grain;  // they are below 2^46 grains, as the error has 20 u of them
        for (DoubleDouble& coefficient : term) coefficient.high = (coefficient.high + rounder) - rounder;
        error = 0.0;
        return true;
    }

    // |base| + |i dx| + |j dy| where that is largest.
    double size_over(const Tile& tile) const noexcept {
        return std::fabs(term[0].high) + tile.width * std::fabs(term[1].high) + tile.height * std::fabs(term[2].high);
    }

    // As high and low parts, see CloseFunction. The coefficients of low are at most half a unit: they, two products and two
    // sums are rounded in double, 6 u of half of width + height + 1 units: less than 2^-50 of those.
    CloseFunction split(const Tile& tile) const noexcept {
        const double unit = unit_for(tile);
        const double rounder = 0x1.8p52 * unit;
        double high[3];
        double low[3];
        for (std::size_t j = 0; j < 3; ++j) {
            high[j] = (term[j].high + rounder) - rounder;
            low[j] = (term[j].high - high[j]) + term[j].low;
        }
        return {{high[0], high[1], high[2]},
                {low[0], low[1], low[2]},
                error + 0x1p-50 * (1.0 + tile.width + tile.height) * unit,
                grain};
    }
    double unit_for(const Tile& tile) const noexcept {
        const double size = size_over(tile);
        return size > 0.0 ? 0x1p-50 / reciprocal_power_of_two(size) : 0.0;
    }
};

// Two numerators and q over a tile.
struct CloseRamps {
    static constexpr std::size_t q = 2;

    Tile tile;
    CloseRamp function[3];

    CloseRamps moved_to(const Tile& part) const noexcept {
        const auto x = static_cast<double>(part.x - tile.x);  // integers
        const auto y = static_cast<double>(part.y - tile.y);  // integers
        CloseRamps result = *this;
        result.tile = part;
        for (CloseRamp& ramp : result.function) ramp = ramp.moved(x, y);
        return result;
    }

    CloseFunctions split() const noexcept {
        CloseFunctions result;
        for (std::size_t k = 0; k < 2; ++k) result.numerator[k] = function[k].split(tile);
        result.q = function[q].split(tile);
        result.q_unit = 0x1.8p78 * function[q].unit_for(tile);
        return result;
    }
};

// What all functions of a triangle share over a tile. With double-double sums within 2^-103 of their terms and products
// within 2^-103, E_i errs by 2^-102 of the two products that it is the difference of, and the value by 2^-100 of theirs
// times the c_i: 2^-97 leaves room.
class ClosePlanes {
public:
    ClosePlanes(const TrianglePlanes& planes, const Tile& tile) noexcept
        : planes_(planes), tile_(tile), grain_(planes.grain_of_edges()) {
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
            edge_[i][0] = sum(left, -right);
            edge_[i][1] = two_sum(planes.corner(j).y, -planes.corner(k).y);
            edge_[i][2] = two_sum(planes.corner(k).x, -planes.corner(j).x);
            magnitude_[i] = std::fabs(left.high) + std::fabs(right.high) + tile.width * std::fabs(edge_[i][1].high) +
                            tile.height * std::fabs(edge_[i][2].high);
        }
    }

    CloseRamp ramp(glm::length_t coordinate) const noexcept {
        CloseRamp ramp{};
        double magnitude = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            const DoubleDouble c = two_product(planes_.value(i, coordinate), planes_.weight(i));
            for (std::size_t j = 0; j < 3; ++j) ramp.term[j] = sum(ramp.term[j], product(edge_[i][j], c));
            magnitude += magnitude_[i] * std::fabs(c.high);
        }
        ramp.error = 0x1p-97 * magnitude + 0x1p-1000;
        ramp.grain = planes_.grain(grain_, coordinate);
        return ramp;
    }

    CloseRamps ramps(glm::length_t first, glm::length_t second) const noexcept {
        return {tile_, {ramp(first), ramp(second), ramp(3)}};
    }

private:
    const TrianglePlanes& planes_;
    Tile tile_;
    double grain_;
    DoubleDouble to_x_[3], to_y_[3];  // from the first fragment to the corners
    DoubleDouble edge_[3][3];         // of the side opposite each corner: its function's value there, and by x and by y
    double magnitude_[3];
};

// F at one fragment.
inline Bounded closely_at(const TrianglePlanes& planes, glm::length_t coordinate, std::int64_t x,
                          std::int64_t y) noexcept {
    const CloseRamp ramp = ClosePlanes(planes, {x, y, 1, 1}).ramp(coordinate);
    const double value = ramp.term[0].high + ramp.term[0].low;
    if (4.0 * ramp.error < ramp.grain && std::fabs(value) < 0.5 * ramp.grain) return {0.0, 0.0};
    return {value, ramp.error + 0x1p-52 * std::fabs(value)};
}

}  // namespace TEXGEN_DETAIL
