#pragma once

// Inputs of every state of subnormal numbers, and what the state allows of their results.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "support/float_state.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "texgen/conventions.hpp"
#include "texgen/primitives.hpp"

namespace float_state {

using support::FloatState;
using support::hex;
using support::Homogeneous;
using support::Outputs;
using support::Quotient;
using support::Random;
using support::under;
using texgen::Coverage;
using texgen::ObjectTexgen;
using texgen::Segment;
using texgen::TextureRegion;
using texgen::Tolerance;
using texgen::TriangleSetup;
using texgen::Work;

// What the state makes of a float that is read.
inline float as_read(float value, const FloatState& state) {
    return state.flushes && std::fabs(value) < 0x1p-126f ? std::copysign(0.0f, value) : value;
}
inline glm::vec3 as_read(const glm::vec3& v, const FloatState& state) {
    return {as_read(v.x, state), as_read(v.y, state), as_read(v.z, state)};
}
inline glm::vec4 as_read(const glm::vec4& v, const FloatState& state) {
    return {as_read(glm::vec3(v), state), as_read(v.w, state)};
}
inline Segment as_read(const Segment& segment, const FloatState& state) {
    return {as_read(segment.a, state), as_read(segment.b, state)};
}
inline texgen::Triangle as_read(const texgen::Triangle& triangle, const FloatState& state) {
    const auto vertex = [&](const texgen::WindowVertex& v) {
        return texgen::WindowVertex{
            {as_read(v.window.x, state), as_read(v.window.y, state)}, as_read(v.clip_w, state), as_read(v.strq, state)};
    };
    return {vertex(triangle.a), vertex(triangle.b), vertex(triangle.c)};
}

// The distance of neighbouring floats where n/d is.
inline double ulp_of(const Quotient& u) {
    const double size = std::fabs(u.estimate());
    return size < 0x1p-126 ? 0x1p-149 : std::ldexp(1.0, std::ilogb(size) - 23);
}

// The error that the state allows: half an ulp or a tolerance, and what is flushed.
inline bool keeps(float value, const Quotient& u, Tolerance tolerance, const FloatState& state) {
    const double limit = std::max(tolerance.value, 0.5 * ulp_of(u)) * (1.0 + 0x1p-20);
    if (!(std::fabs(u.estimate()) < 0x1.fffffep127)) return !(std::fabs(value) < 0x1.fffffep127f);
    if (std::isinf(value)) return std::fabs(u.estimate()) + limit >= 0x1.fffffep127;
    return support::distance(value, u) <= limit + (state.flushes ? 0x1p-126 : 0.0);
}

// How often each case came up.
struct Seen {
    int in_front = 0, behind = 0, on_plane = 0, flushed = 0;
};

// Empty where value i keeps the promises; otherwise what is wrong with it.
inline std::string what_is_wrong(const Homogeneous& exact, const TextureRegion& region, Tolerance tolerance,
                                 const FloatState& state, const Outputs& out, std::size_t i, Seen& seen) {
    const int side = exact.q.sign();
    ++(side > 0 ? seen.in_front : side < 0 ? seen.behind : seen.on_plane);
    const std::string text = hex(out.s()[i]) + " " + hex(out.t()[i]) + " " + hex(out.lit()[i]);
    if (side <= 0)
        return out.s()[i] == 0.0f && out.t()[i] == 0.0f && out.lit()[i] == 0.0f ? "" : "behind, and not 0: " + text;
    for (std::size_t k = 0; k < 2; ++k) {
        const Quotient u = exact.over_q(k);
        if (!keeps(out[k][i], u, tolerance, state)) return "should be " + hex(u.estimate()) + ": " + text;
        seen.flushed += out[k][i] == 0.0f && std::fabs(u.estimate()) > 0x1p-140;
    }
    const bool is_inside =
        support::contains(region, as_read(out.s()[i], state), as_read(out.t()[i], state), as_read(out.r()[i], state));
    return out.lit()[i] == (is_inside ? 1.0f : 0.0f) ? "" : "lit is not what s, t and r say: " + text;
}

inline Tolerance any_tolerance(Random& random) {
    return random.coin() ? texgen::exact : Tolerance{random.power_of_ten(-8.0, -1.0)};
}

// Sides that are normal floats, or none.
inline TextureRegion any_region(Random& random) {
    const TextureRegion region = random.coin() ? support::everywhere() : texgen::atlas_tile({0.0, 0.25}, {1.0, 0.75});
    return random.coin() ? region : region.with_depth(random.coin() ? 0.0 : -HUGE_VAL, 0.5);
}

// Every test goes through the states that the machine has.
template <class Test>
void in_every_state(const Test& test) {
    std::uint64_t seed = 8000;
    for (const FloatState& state : support::float_states) {
        if (!has(state)) continue;
        CAPTURE(std::string(state.name));
        Random random(++seed);
        test(state, random);
    }
}

inline void check_seen(const Seen& seen) {
    CHECK(seen.in_front > 2000);
    CHECK(seen.behind > 200);
}

}  // namespace float_state
