#pragma once

// Regions, polygons about their slides, and the exact distances from the slide's sides.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "judges/numbers.hpp"
#include "support/hex.hpp"
#include "support/polygons.hpp"
#include "support/random.hpp"
#include "texgen/clip.hpp"

namespace clip_slide_cases {

using support::bits;
using support::exactly;
using support::hex;
using support::Polygon;
using support::Random;
using support::Rational;
using texgen::atlas_tile;
using texgen::clip_to_slide;
using texgen::ClipVertex;
using texgen::TextureRegion;
using texgen::whole_texture;

inline std::string hex_of(const Polygon& polygon, const TextureRegion& region) {
    return hex(region) + ": " + support::hex_of(polygon);
}

inline Polygon clipped(const Polygon& polygon, const TextureRegion& region) {
    Polygon out(polygon.size() + (region.depth() ? 7 : 5));
    out.resize(clip_to_slide(polygon, region, out));
    return out;
}

// (s, t, r, q), exactly; r is 0 where no depth asks for it.
struct Point {
    Rational s, t, r, q;
};

inline Point point_of(const ClipVertex& v) {
    return {exactly(v.strq.x), exactly(v.strq.y), std::isfinite(v.strq.z) ? exactly(v.strq.z) : Rational(0),
            exactly(v.strq.w)};
}

// q and the sides of s, t, and r.
inline std::size_t distance_count(const TextureRegion& region) { return region.depth() ? 7 : 5; }

// The distances that clip_to_slide() cuts by, in its order.
inline Rational distance(std::size_t side, const Point& p, const TextureRegion& region) {
    if (side == 0) return p.q;
    const int k = side < 3 ? 0 : side < 5 ? 1 : 2;
    const Rational& u = k == 0 ? p.s : k == 1 ? p.t : p.r;
    const double bound =
        side % 2 == 1 ? (k == 2 ? region.depth()->x : region.min()[k]) : (k == 2 ? region.depth()->y : region.max()[k]);
    return side % 2 == 1 ? Rational(u - exactly(bound) * p.q) : Rational(exactly(bound) * p.q - u);
}

inline TextureRegion some_sides(Random& random) {
    const double size = random.power_of_ten(-2.0, 3.0);
    switch (random.integer(0, 3)) {
        case 0:
            return whole_texture();
        case 1:
            return texgen::rectangle_texture(1024.0, 512.0);
        default: {
            const glm::dvec2 min(random.uniform(-size, size), random.uniform(-size, size));
            return atlas_tile(min, min + glm::dvec2(random.uniform(0.1, 1.0), random.uniform(0.1, 1.0)) * size);
        }
    }
}

// Every second one has a depth.
inline TextureRegion some_region(Random& random) {
    const TextureRegion region = some_sides(random);
    switch (random.integer(0, 5)) {
        case 0:
            return region.with_depth();
        case 1:
            return region.with_depth(-1.0, 1.0);
        case 2: {
            const double r_min = random.uniform(-1.0, 1.0);
            return region.with_depth(r_min, r_min + random.uniform(0.1, 2.0));
        }
        default:
            return region;
    }
}

// Anywhere about the slide, in front more often than not; now and then exactly on a side, at q = 0, or at the
// projector.
inline ClipVertex slide_vertex(Random& random, const TextureRegion& region, double spread = 1.5) {
    const glm::dvec2 size = region.max() - region.min(), middle = 0.5 * (region.min() + region.max());
    double q = random.power_of_ten(-2.0, 3.0) * (random.uniform(0.0, 1.0) < 0.7 ? 1.0 : -1.0);
    const int special = random.integer(0, 19);
    if (special == 0) q = 0.0;
    if (special == 1) q = 1.0;
    glm::dvec2 st = middle + size * glm::dvec2(random.uniform(-spread, spread), random.uniform(-spread, spread));
    if (special == 1) st.x = region.min().x;
    if (special == 2) st.x = st.y = 0.0;
    const double scale = q == 0.0 ? 1.0 : q;
    double r = random.uniform(-1.0, 1.0);
    if (const auto depth = region.depth()) {
        const double middle_of_depth = 0.5 * (depth->x + depth->y);
        r = scale *
            (special == 4 ? depth->y : middle_of_depth + (depth->y - depth->x) * random.uniform(-spread, spread));
    }
    ClipVertex v{
        {},
        {support::to_float(st.x * scale), support::to_float(st.y * scale), support::to_float(r), support::to_float(q)}};
    if (special == 3) v.strq = {0.0f, 0.0f, v.strq.z, 0.0f};
    v.position = v.strq;
    return v;
}

// An affine image of a regular polygon on the slide, at the depths of a plane: convex but for the rounding of its
// floats.
inline Polygon slide_polygon(Random& random, const TextureRegion& region) {
    const int corners = random.integer(3, 7);
    const glm::dvec2 size = region.max() - region.min(), middle = 0.5 * (region.min() + region.max());
    const glm::dvec2 centre = middle + size * glm::dvec2(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    const glm::dvec2 radius = size * glm::dvec2(random.power_of_ten(-2.0, 0.7), random.power_of_ten(-2.0, 0.7));
    const double turn = random.uniform(0.0, 6.3), slope = random.uniform(-0.9, 0.9);
    const double depth = random.power_of_ten(-2.0, 2.0);
    // r is linear in s, t and q.
    const glm::dvec2 limits = region.depth().value_or(glm::dvec2(-1.0, 1.0));
    const double deep = (limits.y - limits.x) * random.uniform(0.2, 2.0) * (random.coin() ? 1.0 : -1.0);
    const double of_middle = random.uniform(limits.x, limits.y);
    Polygon polygon;
    for (int i = 0; i < corners; ++i) {
        const double angle = turn + 6.283185307179586 * i / corners;
        const double q = depth * (1.0 + slope * std::cos(angle));
        const glm::dvec2 st = (centre + radius * glm::dvec2(std::cos(angle), std::sin(angle))) * q;
        const double r = of_middle * q + deep * ((st.x - centre.x * q) / size.x + (st.y - centre.y * q) / size.y);
        const glm::vec4 strq(support::to_float(st.x), support::to_float(st.y), support::to_float(r),
                             support::to_float(q));
        polygon.push_back({strq, strq});
    }
    if (random.coin()) std::reverse(polygon.begin(), polygon.end());
    return polygon;
}

inline void require_inside(const Polygon& out, const Polygon& polygon, const TextureRegion& region) {
    for (const ClipVertex& v : out) {
        REQUIRE_MESSAGE(v.strq.w > 0.0f, hex_of(polygon, region));
        const Point p = point_of(v);
        for (std::size_t side = 1; side < distance_count(region); ++side) {
            const int k = side < 3 ? 0 : 1;
            const glm::dvec2 sides =
                side < 5 ? glm::dvec2(region.min()[k], region.max()[k]) : region.depth().value_or(glm::dvec2());
            const double largest = std::max(std::fabs(sides.x), std::fabs(sides.y));
            const Rational slack = exactly(texgen::slide_clip_error) * exactly(largest) * p.q;
            REQUIRE_MESSAGE(distance(side, p, region) >= -slack, hex_of(polygon, region));
        }
    }
}

}  // namespace clip_slide_cases
