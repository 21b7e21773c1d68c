#pragma once

// The linear functions of a triangle to twice the precision of double, about the first fragment of a tile: for tiles
// where the planes cancel (a corner far outside of the window, q next to 0) and for quotients next to the middle of two
// floats.
//
// F = sum E_i c_i as in planes.hpp, but from the differences between the fragment and the corners: what is large at a
// far corner never enters.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "../arithmetic/rounding.hpp"
#include "../language.hpp"
#include "../simd/lanes.hpp"
#include "../simd/tiers.hpp"
#include "planes.hpp"

namespace TEXGEN_DETAIL {

// The terms of base + i dx + j dy, which is within `error` of the exact value at every fragment of the tile that it was
// made for.
struct CloseRamp {
    DoubleDouble term[3];
    double error;

    TEXGEN_APART void move(const DoubleDouble& x, const DoubleDouble& y) noexcept {
        for (std::size_t j = 1; j < 3; ++j) term[0] = sum(term[0], product(term[j], j == 1 ? x : y));
    }

    // |base| + |i dx| + |j dy| where that is largest.
    double size_over(const Tile& tile) const noexcept {
        return std::fabs(term[0].high) + tile.width * std::fabs(term[1].high) + tile.height * std::fabs(term[2].high);
    }

    // Splits it into high and low, see CloseFunction. The coefficients of low are at most half a unit: these, two
    // products and two sums are rounded in double, 6 u of half of width + height + 1 units, less than 2^-50 of those.
    TEXGEN_APART void copy_to(const Tile& tile, CloseFunction& result) const noexcept {
        const double size = size_over(tile);
        const double unit = size > 0.0 ? 0x1p-50 / reciprocal_power_of_two(size) : 0.0;
        const double rounder = 0x1.8p52 * unit;
        const auto split = [rounder](const DoubleDouble& of, double& high, double& low) {
            high = (of.high + rounder) - rounder;
            low = (of.high - high) + of.low;
        };
        split(term[0], result.high.base, result.low.base);
        split(term[1], result.high.dx, result.low.dx);
        split(term[2], result.high.dy, result.low.dy);
        result.error = error + 0x1p-50 * (1.0 + tile.width + tile.height) * unit;
    }
};

// Two numerators and q over a tile; one numerator alone stands in both places.
struct CloseRamps {
    Tile tile;
    CloseRamp function[3];

    TEXGEN_RARE bool cancel() const noexcept {
        for (const CloseRamp& ramp : function)
            if (ramp.error > cancelled_share * ramp.size_over(tile) + 0x1p-700) return true;
        return false;
    }

    // Leaves the residues as they are.
    void copy_to(CloseFunctions& result) const noexcept {
        for (std::size_t k = 0; k < 3; ++k) function[k].copy_to(tile, result.function[k]);
    }
};

// Products of two numbers at a time are made of exact ones, so that contraction changes nothing.

inline DoubleDouble2 with_lanes_exchanged(const DoubleDouble2& a) noexcept {
    return {with_lanes_exchanged(a.high), with_lanes_exchanged(a.low)};
}

// a b within 2^-102 |a b|. Parts of 26 bits and the 27 behind them have exact products, but for two of 27.
inline DoubleDouble2 product(const DoubleDouble2& a, const DoubleDouble2& b) noexcept {
    const Double2 a_part = leading_bits<26>(a.high), a_rest = a.high - a_part;
    const Double2 b_part = leading_bits<26>(b.high), b_rest = b.high - b_part;
    const DoubleDouble2 leading = quick_two_sum<Double2>(a_part * b_part, a_part * b_rest);
    const DoubleDouble2 both = two_sum<Double2>(leading.high, a_rest * b_part);
    return quick_two_sum<Double2>(both.high,
                                  (leading.low + both.low) + (a_rest * b_rest + (a.high * b.low + a.low * b.high)));
}

// The same with a float, whose products with 29 bits and the 24 behind them are exact.
inline DoubleDouble2 product_with_float(const DoubleDouble2& a, double b) noexcept {
    const Double2 part = leading_bits<29>(a.high);
    const DoubleDouble2 leading = quick_two_sum<Double2>(part * b, (a.high - part) * b);
    return {leading.high, leading.low + a.low * b};
}

// The functions of s, t, r, q over a tile in two doubles. Differences are exact; products and sums err by 2^-102 of
// their terms: E_i, the difference of two products, by 2^-101 of these, its product with w_j w_k by 2^-100, and the
// value by 2^-99 of what its terms are at most: 2^-97 leaves room.
class ClosePlanes {
public:
    TEXGEN_APART ClosePlanes(const TrianglePlanes& planes, const Tile& tile) noexcept : tile_(tile) {
        const Double2 first =
            double2_of(static_cast<double>(tile.x) + 0.5, static_cast<double>(tile.y) + 0.5);  // integers
        DoubleDouble2 to[3];  // from the first fragment to the corners
        Double2 turned[3];    // the corners, by a quarter
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec2 at = planes.corner(i);
            to[i] = two_sum<Double2>(double2_of(at.x, at.y), -first);
            turned[i] = double2_of(at.y, -at.x);
        }
        DoubleDoubleOf<Double4> sums[3];
        Double4 magnitudes{};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            // The function of the side opposite corner i at the first fragment, in the second lane, and its growth by x
            // and y; what they are made of is times w_j w_k.
            const DoubleDouble2 terms = product(to[j], with_lanes_exchanged(to[k]));
            const DoubleDouble2 value = sum(with_lanes_exchanged(terms), -terms);
            const DoubleDouble2 growth = two_sum<Double2>(turned[j], -turned[k]);
            double leading[4], rest[4], low[4];
            for (std::size_t m = 0; m < 4; m += 2) {
                const DoubleDouble2 of = product_with_float(
                    product_with_float(m == 0 ? value : growth, planes.scaled_w(j)), widened(planes.vertex(k).clip_w));
                const Double2 part = leading_bits<29>(of.high), left = of.high - part;
                std::memcpy(leading + m, &part, sizeof part);
                std::memcpy(rest + m, &left, sizeof left);
                std::memcpy(low + m, &of.low, sizeof of.low);
            }
            const Double4 f = four_widened(planes.vertex(i).strq);
            for (std::size_t m = 0; m < 3; ++m) {
                DoubleDoubleOf<Double4> part = quick_two_sum<Double4>(f * leading[m + 1], f * rest[m + 1]);
                part.low = part.low + f * low[m + 1];
                sums[m] = i == 0 ? part : sum<Double4>(sums[m], part);
            }
            const Double2 sizes = magnitude(terms.high);
            const double size =
                std::fabs(planes.weight(i)) * (sizes[0] + sizes[1] + tile.width * std::fabs(growth.high[0]) +
                                               tile.height * std::fabs(growth.high[1]));
            magnitudes = magnitudes + magnitude(f) * size;
        }
        double high[4], low[4];
        for (std::size_t m = 0; m < 3; ++m) {
            std::memcpy(high, &sums[m].high, sizeof high);
            std::memcpy(low, &sums[m].low, sizeof low);
            for (std::size_t n = 0; n < 4; ++n) ramp_[n].term[m] = {high[n], low[n]};
        }
        std::memcpy(high, &magnitudes, sizeof high);
        for (std::size_t n = 0; n < 4; ++n)
            ramp_[n].error = 0x1p-97 * high[n] + 0x1p-800;  // normal in products with other errors, too
    }

    const Tile& tile() const noexcept { return tile_; }

    // Of one coordinate, 0 to 3 for s, t, r, q.
    const CloseRamp& ramp(glm::length_t coordinate) const noexcept { return ramp_[coordinate]; }

    // Takes one from exact growths, see exact_fragment.hpp, if its error is less.
    void replace(glm::length_t coordinate, const CloseRamp& exact) noexcept {
        if (exact.error < ramp_[coordinate].error) ramp_[coordinate] = exact;
        is_exact_[coordinate] = true;
    }
    bool is_exact(glm::length_t coordinate) const noexcept { return is_exact_[coordinate]; }
    bool are_exact(glm::length_t first, glm::length_t second) const noexcept {
        return is_exact(first) && is_exact(second) && is_exact(3);
    }

    // Two coordinates and q over a part of the tile.
    TEXGEN_RARE CloseRamps ramps(glm::length_t first, glm::length_t second, const Tile& part) const noexcept {
        const auto x = static_cast<double>(part.x - tile_.x);  // integers
        const auto y = static_cast<double>(part.y - tile_.y);  // integers
        CloseRamps result;
        result.tile = part;
        const CloseRamp* const from[] = {&ramp_[first], &ramp_[second], &ramp_[3]};
        for (std::size_t k = 0; k < 3; ++k) {
            auto& [term, error] = result.function[k];
            for (std::size_t j = 0; j < 3; ++j) term[j] = from[k]->term[j];
            error = from[k]->error;
            if (x != 0.0 || y != 0.0) result.function[k].move({x, 0.0}, {y, 0.0});
        }
        return result;
    }

private:
    Tile tile_;
    CloseRamp ramp_[4];
    bool is_exact_[4] = {};
};

}  // namespace TEXGEN_DETAIL
