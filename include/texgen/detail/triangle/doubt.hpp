#pragma once

// What is known of a triangle's functions where doubles leave a fragment in doubt: two doubles, residues, or quotients
// that are exact.

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "../arithmetic/rounding.hpp"
#include "../language.hpp"
#include "../on_demand.hpp"
#include "../simd/lanes.hpp"
#include "../simd/tiers.hpp"
#include "close_planes.hpp"
#include "planes.hpp"

namespace TEXGEN_DETAIL {

// A power of two of which three numbers are multiples, the largest up to 2^500; 0 where that is no normal number.
TEXGEN_APART inline double common_grain(double a, double b, double c) noexcept {
    int least = 1023 + 500;
    for (const double number : {a, b, c}) {
        const auto bits = bit_cast<std::uint64_t>(number);
        const int last = static_cast<int>(bits >> 52 & 0x7ff) - 52 + std::countr_zero(bits | std::uint64_t{1} << 52);
        if (bits << 1 != 0 && last < least) least = last;
    }
    return least > 0 ? bit_cast<double>(static_cast<std::uint64_t>(least) << 52) : 0.0;
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
    TEXGEN_APART void add_to(CloseFunction& function, glm::length_t coordinate, const Tile& part) const noexcept {
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

// What is made of a rectangle when a fragment in doubt first needs it: all of its outputs share it.
struct RectInDoubt {
    OnDemand<ClosePlanes> planes;
    OnDemand<PlaneResidues> residues;
};

// q over a tile in two doubles and by its residue.
class CloseQ {
public:
    TEXGEN_RARE CloseQ(const TrianglePlanes& planes, const Tile& tile) noexcept : close_(planes, tile) {
        PlaneResidues(planes, tile).add_to(exact_, 3, tile);
    }

    // Over a part of the tile, and in the places of two numerators.
    CloseRamps ramps(const Tile& part) const noexcept { return close_.ramps(3, 3, part); }

    // Its value at one fragment, with an error that is small beside it wherever two doubles, or 2^62 grains with the
    // residue, allow that.
    TEXGEN_RARE Bounded at(std::int64_t x, std::int64_t y) const noexcept {
        const std::int64_t to_x = x - close_.tile().x, to_y = y - close_.tile().y;
        CloseRamp ramp = close_.ramp(3);
        ramp.move({static_cast<double>(to_x), 0.0}, {static_cast<double>(to_y), 0.0});  // integers
        const double value = ramp.term[0].high + ramp.term[0].low;
        const double error = ramp.error + 0x1p-52 * std::fabs(value);
        if (std::fabs(value) > well_in_front * error || !(std::fabs(value) + error < 0x1p62 * exact_.grain))
            return {value, error};
        const std::uint64_t residue = exact_.residue.base + static_cast<std::uint64_t>(to_x) * exact_.residue.dx +
                                      static_cast<std::uint64_t>(to_y) * exact_.residue.dy;
        const double known = static_cast<double>(static_cast<std::int64_t>(residue)) * exact_.grain;  // integers
        return {known, 0x1p-52 * std::fabs(known)};
    }

private:
    ClosePlanes close_;
    CloseFunction exact_;
};

}  // namespace TEXGEN_DETAIL
