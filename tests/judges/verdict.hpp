#pragma once

// What the contract says of one divided coordinate: in front of the projector within the tolerance, behind it 0, and
// lit where the written s and t, and r where it has a depth, are inside the closed region.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <glm/vec2.hpp>

#include "judges/exact.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "texgen/conventions.hpp"

namespace support {

// |error| <= tolerance.value, or half an ulp: for the exact tier the nearest float, ties to even.
inline bool keeps(float value, const Quotient& u, std::size_t coordinate, texgen::Tolerance tolerance) {
    if (!(tolerance.value > 0.0)) return is_nearest(value, u);
    return coordinate == 2 ? is_within_relatively(value, u, tolerance.value) : is_within(value, u, tolerance.value);
}

// Whether n/d is inside [min, max] (or outside it) so far that every float within the tolerance is, too; beyond the
// largest float stands infinity.
inline bool is_inside_for_sure(const Quotient& u, double min, double max, double tolerance) {
    const double size = std::fabs(u.estimate());
    const double slack = tolerance + 0x1p-23 * size + 0x1p-148;
    return size < 0x1p127 && compare(u, min + slack) > 0 && compare(u, max - slack) < 0;
}
inline bool is_outside_for_sure(const Quotient& u, double min, double max, double tolerance) {
    const double size = std::fabs(u.estimate());
    const double slack = tolerance + 0x1p-23 * size + 0x1p-148;
    return size < 0x1p127 && (compare(u, min - slack) < 0 || compare(u, max + slack) > 0);
}

// A region with a side through (s, t), and with a limit of its depth through r, a unit or two beside it, or anywhere:
// of doubles, and of floats.
inline texgen::TextureRegion region_about(const Homogeneous& at, Random& random) {
    const double size = random.power_of_ten(-3.0, 3.0);
    const auto side_at = [&](const Quotient& u) {
        const double value = u.estimate();
        double side = value;
        switch (random.integer(0, 5)) {
            case 0:
                break;
            case 1:
                side = value * (1.0 + random.integer(-3, 3) * 0x1p-52);
                break;
            case 2:
                side = value * (1.0 + random.integer(-4, 4) * 0x1p-25);
                break;
            case 3:
                side = static_cast<double>(neighbour(static_cast<float>(value), random.integer(-1, 1)));
                break;
            case 4:
                side = value * random.uniform(0.9, 1.1);
                break;
            default:
                side = value * random.uniform(-3.0, 3.0);
                break;
        }
        return side;
    };
    const auto sides = [&](const Quotient& u) {
        const double side = side_at(u);
        switch (random.integer(0, 3)) {
            case 0:
                return glm::dvec2(side, side + size);
            case 1:
                return glm::dvec2(side - size, side);
            case 2:
                return glm::dvec2(side, side);
            default:
                return glm::dvec2(side, side_at(u));  // inverted half of the time
        }
    };
    const glm::dvec2 none(-HUGE_VAL, HUGE_VAL);
    const Quotient s = at.over_q(0), t = at.over_q(1), r = at.over_q(2);
    const glm::dvec2 of_s = sides(s), of_t = random.coin() ? sides(t) : none;
    const texgen::TextureRegion region = texgen::atlas_tile({of_s.x, of_t.x}, {of_s.y, of_t.y});
    // What s and t leave dark says nothing of a depth.
    switch (random.integer(0, 5)) {
        case 0:
            return region;
        case 1:
            return region.with_depth(side_at(r), HUGE_VAL);
        case 2:
            return texgen::atlas_tile({none.x, none.x}, {none.y, none.y}).with_depth(-HUGE_VAL, side_at(r));
        case 3:
            return region.with_depth(sides(r).x, sides(r).y);
        default: {
            const glm::dvec2 of_r = sides(r);
            return texgen::atlas_tile({none.x, none.x}, {none.y, none.y}).with_depth(of_r.x, of_r.y);
        }
    }
}

// Empty where output i is what it must be; otherwise what is wrong with it. Outputs that were not asked for are not
// looked at.
inline std::string what_is_wrong(const Homogeneous& exact, const texgen::TextureRegion& region,
                                 texgen::Tolerance tolerance, const Outputs& out, std::size_t i) {
    const auto show = [&] {
        std::string text;
        for (std::size_t k = 0; k < 4; ++k)
            if (out.asked(k)) text += " " + std::string(1, "strl"[k]) + "=" + hex(out[k][i]);
        return text;
    };
    if (exact.q.sign() <= 0) {
        for (std::size_t k = 0; k < 4; ++k)
            if (out.asked(k) && !(out[k][i] == 0.0f)) return "behind, and not 0:" + show();
        return {};
    }
    for (std::size_t k = 0; k < 3; ++k) {
        if (!out.asked(k) || keeps(out[k][i], exact.over_q(k), k, tolerance)) continue;
        return std::string(1, "str"[k]) + " should be " + hex(exact.over_q(k).estimate()) + ":" + show();
    }
    if (!out.asked(3)) return {};
    const float lit = out.lit()[i];
    if (lit != 0.0f && lit != 1.0f) return "lit is neither 0 nor 1:" + show();
    bool all_inside = true, any_outside = false;
    for (std::size_t k = 0; k < 3; ++k) {
        const Quotient u = exact.over_q(k);
        if (out.asked(k) || !(tolerance.value > 0.0)) {
            const bool is_inside = contains(region, k, out.asked(k) ? out[k][i] : nearest_float(u));
            all_inside = all_inside && is_inside;
            any_outside = any_outside || !is_inside;
            continue;
        }
        if (k == 2 && !region.depth()) continue;
        const glm::dvec2 limits = limits_of(region, k);
        const double limit = tolerance.value * (k == 2 ? std::max(1.0, std::fabs(u.estimate())) : 1.0);
        all_inside = all_inside && is_inside_for_sure(u, limits.x, limits.y, limit);
        any_outside = any_outside || is_outside_for_sure(u, limits.x, limits.y, limit);
    }
    if (lit == 0.0f && all_inside) return "inside and not lit:" + show();
    if (lit == 1.0f && any_outside) return "outside and lit:" + show();
    return {};
}

}  // namespace support
