#pragma once

// The near planes of cameras, the exact distance from one, and polygons that are clipped to it.

#include <array>

#include <glm/vec4.hpp>

#include "judges/oracle.hpp"
#include "support/polygons.hpp"
#include "texgen/clip.hpp"

namespace clip_cases {

using support::exactly;
using support::hex_of;
using support::Polygon;
using support::Rational;
using texgen::clip_to_near;
using texgen::ClipVertex;
using texgen::DepthRange;

struct NearPlane {
    DepthRange range;
    bool reversed;
};
inline constexpr std::array near_planes{
    NearPlane{DepthRange::negative_one_to_one, false}, NearPlane{DepthRange::zero_to_one, false},
    NearPlane{DepthRange::zero_to_one, true}, NearPlane{DepthRange::negative_one_to_one, true}};

inline Rational distance(const glm::vec4& p, NearPlane plane) {
    if (plane.reversed) return exactly(p.w) - exactly(p.z);
    return plane.range == DepthRange::zero_to_one ? exactly(p.z) : Rational(exactly(p.z) + exactly(p.w));
}

// Whether a float is one rounding away from what is within `slack` of the exact value.
inline bool is_rounded(float value, const Rational& exact, const Rational& slack) {
    return support::magnitude(exactly(value) - exact) <=
           slack + support::power_of_two(support::ulp_exponent<float>(exact) - 1);
}

inline Polygon clipped(const Polygon& polygon, NearPlane plane) {
    Polygon out(polygon.size() + 1);
    out.resize(clip_to_near(polygon, out, plane.range, plane.reversed));
    return out;
}

}  // namespace clip_cases
