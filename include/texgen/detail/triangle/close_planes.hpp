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

#include "../arithmetic/rounding.hpp"
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
        double high[3];
        double low[3];
        for (std::size_t j = 0; j < 3; ++j) {
            high[j] = (term[j].high + rounder) - rounder;
            low[j] = (term[j].high - high[j]) + term[j].low;
        }
        result.high = {high[0], high[1], high[2]};
        result.low = {low[0], low[1], low[2]};
        result.error = error + 0x1p-50 * (1.0 + tile.width + tile.height) * unit;
    }
};

// Two numerators and q over a tile.
struct CloseRamps {
    Tile tile;
    CloseRamp function[3];

    TEXGEN_APART CloseRamps moved_to(const Tile& part) const noexcept {
        const auto x = static_cast<double>(part.x - tile.x);  // integers
        const auto y = static_cast<double>(part.y - tile.y);  // integers
        CloseRamps result = *this;
        result.tile = part;
        if (x == 0.0 && y == 0.0) return result;
        for (CloseRamp& ramp : result.function) ramp.move({x, 0.0}, {y, 0.0});
        return result;
    }

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

// What all functions of a triangle share over a tile: the edge functions. With double-double sums within 2^-103 of
// their terms and products within 2^-103, E_i errs by 2^-102 of the two products that it is the difference of, and the
// value by 2^-100 of theirs times the c_i: 2^-97 leaves room.
class ClosePlanes {
public:
    ClosePlanes(const TrianglePlanes& planes, const Tile& tile) noexcept : planes_(planes), tile_(tile) {
        const Double2 first =
            double2_of(static_cast<double>(tile.x) + 0.5, static_cast<double>(tile.y) + 0.5);  // integers
        const auto corner = [&](std::size_t i) {
            const glm::dvec2 at = planes.corner(i);
            return double2_of(at.x, at.y);
        };
        Pair to[3];  // from the first fragment to the corners
        for (std::size_t i = 0; i < 3; ++i) to[i] = Pair(corner(i), first);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            const DoubleDouble left = product(to[j].lane(0), to[k].lane(1));
            const DoubleDouble right = product(to[j].lane(1), to[k].lane(0));
            const Pair side(corner(j), corner(k));
            edge_[i][0] = sum(left, -right);
            edge_[i][1] = side.lane(1);
            edge_[i][2] = -side.lane(0);
            magnitude_[i] = std::fabs(left.high) + std::fabs(right.high) + tile.width * std::fabs(edge_[i][1].high) +
                            tile.height * std::fabs(edge_[i][2].high);
        }
    }

    TEXGEN_APART CloseRamp ramp(glm::length_t coordinate) const noexcept {
        CloseRamp ramp{};
        double magnitude = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            const DoubleDouble c = two_product(planes_.value(i, coordinate), planes_.weight(i));
            for (std::size_t j = 0; j < 3; ++j) ramp.term[j] = sum(ramp.term[j], product(edge_[i][j], c));
            magnitude += magnitude_[i] * std::fabs(c.high);
        }
        ramp.error = 0x1p-97 * magnitude + 0x1p-800;  // normal in products with other errors, too
        return ramp;
    }

    // One coordinate alone stands in both places.
    TEXGEN_APART CloseRamps ramps(glm::length_t first, glm::length_t second) const noexcept {
        const CloseRamp of_first = ramp(first);
        return {tile_, {of_first, second == first ? of_first : ramp(second), ramp(3)}};
    }

private:
    // Exactly a - b, for x and for y.
    struct Pair {
        Double2 high, low;

        Pair() = default;
        Pair(const Double2& a, const Double2& b) noexcept { high = two_sum(a, -b, low); }
        DoubleDouble lane(std::size_t i) const noexcept { return {high[i], low[i]}; }
    };

    const TrianglePlanes& planes_;
    Tile tile_;
    DoubleDouble edge_[3][3];  // of the side opposite each corner: its function's value there, and by x and by y
    double magnitude_[3];
};

// A power of two of which three numbers are multiples; finite even if all are 0.
TEXGEN_RARE inline double common_grain(double a, double b, double c) noexcept {
    return smaller(smaller(last_bit(a), smaller(last_bit(b), last_bit(c))), 0x1p500);
}

// A whole number modulo 2^64: halves of it fit a signed integer.
TEXGEN_RARE inline std::uint64_t residue_of(double number) noexcept {
    if (std::fabs(number) < 0x1p63) return static_cast<std::uint64_t>(static_cast<std::int64_t>(number));
    return 2 * static_cast<std::uint64_t>(static_cast<std::int64_t>(0.5 * std::fmod(number, 0x1p64)));
}

// What is known of the functions of a tile in doubt: the planes as they are or in two doubles, with residues or
// without. Residues cost less than two doubles, and decide where the planes are exact, or err by less than residues
// tell apart, but not next to q = 0.
struct DoubtfulFunctions : CloseFunctions {
    bool adds_residues_first = false;
    bool are_vain = false;  // all that there is has left fragments in doubt
};
struct DoubtfulJob {
    TileJob job;
    DoubtfulFunctions functions;

    // In place of braces: where these initialise more than 256 bytes, GCC 12 clears members where it should clear
    // padding, if it is told to initialise all variables (-ftrivial-auto-var-init).
    DoubtfulJob(const TileJob& tile, const DoubtfulFunctions& known) noexcept : job(tile), functions(known) {}
};

// Whether sums decide ties, too, if functions err by `share` of what they do now: then F - m Q, where m is a multiple
// of 2^-25 of itself, errs by less than half of its grain.
TEXGEN_RARE inline bool are_decided_by_sums(const CloseFunctions& functions, double share) noexcept {
    const auto& [first, second, q] = functions.function;
    return 4.0 * share * first.error < first.grain && 4.0 * share * second.error < second.grain &&
           0x1p27 * share * q.error < q.grain;
}

// Whether residues decide the quotients of a tile well in front, if its numerators are as large as their errors
// suggest. Coefficients are multiples of their grains: where the error leaves one candidate they are made exact, and
// what is left is the error of computing with them, 2^-98 of the values.
TEXGEN_RARE inline bool let_residues_decide(CloseFunctions& functions) noexcept {
    for (CloseFunction& f : functions.function) {
        if (!(4.0 * f.error < f.grain)) continue;
        const double rounder = 0x1.8p52 * f.grain;  // they are below 2^46 grains, as the error has 20 u of them
        for (double* const coefficient : {&f.high.base, &f.high.dx, &f.high.dy})
            *coefficient = (*coefficient + rounder) - rounder;
        f.error *= 0x1p-50;
    }
    const auto& [first, second, q] = functions.function;
    return q.error < 0x1p33 * q.grain && first.error < 0x1p58 * first.grain && second.error < 0x1p58 * second.grain;
}

// Whether coefficient j of a function is exactly u times q, which is constant.
TEXGEN_RARE inline bool is_multiple(const CloseFunction& f, std::size_t j, double u, const CloseFunction& q) noexcept {
    double Ramp::*const part = j == 0 ? &Ramp::base : j == 1 ? &Ramp::dx : &Ramp::dy;
    const std::uint64_t residue = j == 0 ? f.residue.base : j == 1 ? f.residue.dx : f.residue.dy;
    const DoubleDouble product = two_product(u, q.high.base);
    const double rest = u * q.low.base;
    const double difference = ((f.high.*part - product.high) - product.low) + (f.low.*part - rest);
    const double error = f.error + std::fabs(u) * q.error +
                         0x1p-50 * (std::fabs(product.low) + std::fabs(f.low.*part) + std::fabs(rest));
    const double unit = (u != 0.0 ? last_bit(u) : 1.0) * q.grain;
    const double finer = smaller(unit, f.grain);
    if (!(std::fabs(difference) <= error && error < 0x1p61 * finer)) return false;
    const double per_finer = reciprocal_power_of_two(finer);
    return residue * residue_of(f.grain * per_finer) == q.residue.base * residue_of(u * q.grain * per_finer);
}

// Where q is constant the quotients are linear. If doubles hold one of them exactly, rounding it to float decides every
// tie.
TEXGEN_RARE inline bool take_exact_quotients(const CloseFunctions& functions, TileJob& job) noexcept {
    const CloseFunction& q = functions.function[CloseFunctions::q];
    if (!is_multiple(q, 1, 0.0, q) || !is_multiple(q, 2, 0.0, q)) return false;
    const double reciprocal = 1.0 / (q.high.base + q.low.base);
    bool is_any_exact = false;
    for (std::size_t k = 0; k < 2; ++k) {
        const CloseFunction& f = functions.function[k];
        Ramp ramp{(f.high.base + f.low.base) * reciprocal, (f.high.dx + f.low.dx) * reciprocal,
                  (f.high.dy + f.low.dy) * reciprocal};
        const double size = std::fabs(ramp.base) + job.width * std::fabs(ramp.dx) + job.height * std::fabs(ramp.dy);
        // Rounded to 45 bits, so that the kernel's products and sums are exact.
        const double rounder = 0x1.8p8 / reciprocal_power_of_two(size);
        const Ramp exact{(ramp.base + rounder) - rounder, (ramp.dx + rounder) - rounder, (ramp.dy + rounder) - rounder};
        const bool is_exact =
            is_multiple(f, 0, exact.base, q) && is_multiple(f, 1, exact.dx, q) && is_multiple(f, 2, exact.dy, q);
        if (is_exact) ramp = exact;
        job.numerator.base[k] = ramp.base;
        job.numerator.dx[k] = ramp.dx;
        job.numerator.dy[k] = ramp.dy;
        job.quotient_error[k] = is_exact ? 0.0 : (f.error + size * q.error) * (1.001 * reciprocal) + gamma(5) * size;
        is_any_exact |= is_exact;
    }
    job.q = {1.0, 0.0, 0.0};
    job.q_is_constant = true;
    job.ulps = 0;
    return is_any_exact;
}

// The linear functions of a triangle as integers modulo 2^64. Products and sums of floats are multiples of the products
// of their last bits: so at every fragment a function is an integer times a power of two, its grain. Two doubles hold
// its leading digits, the residue its last ones.
class PlaneResidues {
public:
    PlaneResidues(const TrianglePlanes& planes, const Tile& tile) noexcept : planes_(planes), tile_(tile) {
        const glm::dvec2 a = planes.corner(0), b = planes.corner(1), c = planes.corner(2);
        const double unit_x = smaller(0.5, common_grain(a.x, b.x, c.x));
        const double unit_y = smaller(0.5, common_grain(a.y, b.y, c.y));
        const double of_weights = common_grain(planes.weight(0), planes.weight(1), planes.weight(2));
        grain_ = of_weights * (unit_x * unit_y);
        const double per_x = reciprocal_power_of_two(unit_x), per_y = reciprocal_power_of_two(unit_y);
        const double per_weight = reciprocal_power_of_two(of_weights);
        const std::uint64_t one_x = residue_of(per_x), one_y = residue_of(per_y);
        const std::uint64_t first_x = residue_of((static_cast<double>(tile.x) + 0.5) * per_x);  // integers
        const std::uint64_t first_y = residue_of((static_cast<double>(tile.y) + 0.5) * per_y);  // integers
        std::uint64_t x[3], y[3];
        for (std::size_t i = 0; i < 3; ++i) {
            x[i] = residue_of(planes.corner(i).x * per_x) - first_x;
            y[i] = residue_of(planes.corner(i).y * per_y) - first_y;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            const std::uint64_t weight = residue_of(planes.weight(i) * per_weight);
            edge_[i] = {weight * (x[j] * y[k] - y[j] * x[k]), weight * ((y[j] - y[k]) * one_x),
                        weight * ((x[k] - x[j]) * one_y)};
        }
    }

    // Adds the residue and the grain of a coordinate's function over a part of the tile.
    TEXGEN_RARE void add_to(CloseFunction& function, glm::length_t coordinate, const Tile& part) const noexcept {
        const double unit =
            common_grain(planes_.value(0, coordinate), planes_.value(1, coordinate), planes_.value(2, coordinate));
        const double per_unit = reciprocal_power_of_two(unit);
        RampOf<std::uint64_t> sum{};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint64_t value = residue_of(planes_.value(i, coordinate) * per_unit);
            sum = {sum.base + value * edge_[i].base, sum.dx + value * edge_[i].dx, sum.dy + value * edge_[i].dy};
        }
        sum.base += static_cast<std::uint64_t>(part.x - tile_.x) * sum.dx;
        sum.base += static_cast<std::uint64_t>(part.y - tile_.y) * sum.dy;
        function.grain = grain_ * unit;  // 0 where that is too small for a double
        function.residue = sum;
    }

private:
    const TrianglePlanes& planes_;
    Tile tile_;
    double grain_;                   // without the unit of the values
    RampOf<std::uint64_t> edge_[3];  // of the sides' functions, with the weights
};

// One function of a tile in two doubles and by its residue.
class ClosePlane {
public:
    ClosePlane(const TrianglePlanes& planes, glm::length_t coordinate, const Tile& tile) noexcept
        : tile_(tile), ramp_(ClosePlanes(planes, tile).ramp(coordinate)) {
        PlaneResidues(planes, tile).add_to(exact_, coordinate, tile);
    }

    CloseRamp moved_to(std::int64_t x, std::int64_t y) const noexcept {
        CloseRamp result = ramp_;
        result.move({static_cast<double>(x - tile_.x), 0.0}, {static_cast<double>(y - tile_.y), 0.0});  // integers
        return result;
    }

    // Its value at one fragment, with an error that is small beside it wherever two doubles, or 2^62 grains with the
    // residue, allow that.
    Bounded at(std::int64_t x, std::int64_t y) const noexcept {
        const DoubleDouble close = moved_to(x, y).term[0];
        const double value = close.high + close.low;
        const double error = ramp_.error + 0x1p-52 * std::fabs(value);
        if (std::fabs(value) > well_in_front * error || !(std::fabs(value) + error < 0x1p62 * exact_.grain))
            return {value, error};
        const std::uint64_t residue = exact_.residue.base +
                                      static_cast<std::uint64_t>(x - tile_.x) * exact_.residue.dx +
                                      static_cast<std::uint64_t>(y - tile_.y) * exact_.residue.dy;
        const double known = static_cast<double>(static_cast<std::int64_t>(residue)) * exact_.grain;  // integers
        return {known, 0x1p-52 * std::fabs(known)};
    }

private:
    Tile tile_;
    CloseRamp ramp_;
    CloseFunction exact_;
};

}  // namespace TEXGEN_DETAIL
