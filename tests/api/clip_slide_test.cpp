// Clipping to the slide, and the slide's planes, judged by exact rationals.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "judges/oracle.hpp"
#include "support/polygons.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/clip.hpp"
#include "texgen/linear.hpp"

namespace {

using support::Bits;
using support::bits;
using support::exactly;
using support::hex;
using support::infinity_double;
using support::infinity_float;
using support::magnitude;
using support::nan_float;
using support::Polygon;
using support::Random;
using support::Rational;
using texgen::atlas_tile;
using texgen::clip_to_slide;
using texgen::ClipVertex;
using texgen::TextureRegion;
using texgen::whole_texture;

std::string hex_of(const Polygon& polygon, const TextureRegion& region) {
    return "region " + hex(region.min()) + " to " + hex(region.max()) +
           (region.depth() ? " depth " + hex(*region.depth()) : "") + ": " + support::hex_of(polygon);
}

Polygon clipped(const Polygon& polygon, const TextureRegion& region) {
    Polygon out(polygon.size() + (region.depth() ? 7 : 5));
    out.resize(clip_to_slide(polygon, region, out));
    return out;
}

// (s, t, r, q), exactly; r is 0 where no depth asks for it.
struct Point {
    Rational s, t, r, q;
};

Point point_of(const ClipVertex& v) {
    return {exactly(v.strq.x), exactly(v.strq.y), std::isfinite(v.strq.z) ? exactly(v.strq.z) : Rational(0),
            exactly(v.strq.w)};
}

// q and the sides of s, t, and r.
std::size_t distance_count(const TextureRegion& region) { return region.depth() ? 7 : 5; }

// The distances that clip_to_slide() cuts by, in its order.
Rational distance(std::size_t side, const Point& p, const TextureRegion& region) {
    if (side == 0) return p.q;
    const int k = side < 3 ? 0 : side < 5 ? 1 : 2;
    const Rational& u = k == 0 ? p.s : k == 1 ? p.t : p.r;
    const double bound =
        side % 2 == 1 ? (k == 2 ? region.depth()->x : region.min()[k]) : (k == 2 ? region.depth()->y : region.max()[k]);
    return side % 2 == 1 ? Rational(u - exactly(bound) * p.q) : Rational(exactly(bound) * p.q - u);
}

bool is_inside(const Point& p, const TextureRegion& region) {
    for (std::size_t side = 0; side < distance_count(region); ++side)
        if (distance(side, p, region) < 0) return false;
    return p.q > 0;
}

// The same clip without a rounding.
std::vector<Point> clipped_exactly(const Polygon& polygon, const TextureRegion& region) {
    std::vector<Point> points;
    for (const ClipVertex& v : polygon) points.push_back(point_of(v));
    for (std::size_t side = 0; side < distance_count(region); ++side) {
        std::vector<Point> kept;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Point &a = points[i], &b = points[(i + 1) % points.size()];
            const Rational da = distance(side, a, region), db = distance(side, b, region);
            if (da >= 0) kept.push_back(a);
            if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
                const Rational t = da / (da - db);
                kept.push_back(
                    {a.s + t * (b.s - a.s), a.t + t * (b.t - a.t), a.r + t * (b.r - a.r), a.q + t * (b.q - a.q)});
            }
        }
        points = kept;
    }
    return points;
}

// Twice the area on the slide; the polygon has q > 0.
Rational area_of(const std::vector<Point>& polygon) {
    Rational area = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        area += (a.s * b.t - a.t * b.s) / (a.q * b.q);
    }
    return magnitude(area);
}

Rational area_of(const Polygon& polygon) {
    std::vector<Point> points;
    for (const ClipVertex& v : polygon) points.push_back(point_of(v));
    return area_of(points);
}

TextureRegion some_sides(Random& random) {
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
TextureRegion some_region(Random& random) {
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

// Whether no vertex is on the other side of an edge than another, seen from the projector; within rounding.
bool is_convex(const Polygon& polygon) {
    bool any_left = false, any_right = false;
    const auto vector = [](const ClipVertex& v) { return glm::dvec3(v.strq.x, v.strq.y, v.strq.w); };
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 a = vector(polygon[i]), b = vector(polygon[(i + 1) % polygon.size()]);
        for (const ClipVertex& v : polygon) {
            const glm::dvec3 c = vector(v);
            const double volume =
                c.x * (a.y * b.z - a.z * b.y) + c.y * (a.z * b.x - a.x * b.z) + c.z * (a.x * b.y - a.y * b.x);
            any_left = any_left || volume > 0.0;
            any_right = any_right || volume < 0.0;
        }
    }
    return !(any_left && any_right);
}

// Anywhere about the slide, in front more often than not; now and then exactly on a side, at q = 0, or at the
// projector.
ClipVertex slide_vertex(Random& random, const TextureRegion& region, double spread = 1.5) {
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
Polygon slide_polygon(Random& random, const TextureRegion& region) {
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

void require_inside(const Polygon& out, const Polygon& polygon, const TextureRegion& region) {
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

}  // namespace

TEST_CASE("the clip planes are the exact ones within their bound, and of their sign") {
    Random random(1101);
    int zero = 0, cancelling = 0;
    for (int i = 0; i < 3000; ++i) {
        glm::dmat4 matrix(0.0);
        const TextureRegion region = some_region(random);
        for (int column = 0; column < 4; ++column) {
            for (int row = 0; row < 4; ++row) matrix[column][row] = random.uniform(-1.0, 1.0);
            // A row that lies on a side, or next to it.
            if (region.depth() && random.integer(0, 3) == 0) matrix[column].z = region.depth()->x * matrix[column].w;
            if (random.integer(0, 3) == 0) {
                matrix[column].x = region.min().x * matrix[column].w;
                matrix[column].y = std::nextafter(region.max().y * matrix[column].w, 0.0);
                ++cancelling;
            }
        }
        const auto planes = clip_planes(texgen::WorldTexgen(matrix), region);
        for (int column = 0; column < 4; ++column) {
            const Point of_column{exactly(matrix[column].x), exactly(matrix[column].y), exactly(matrix[column].z),
                                  exactly(matrix[column].w)};
            REQUIRE(planes.size() == distance_count(region));
            for (std::size_t side = 0; side < planes.size(); ++side) {
                const Rational exact = distance(side, of_column, region);
                const Rational off = magnitude(exactly(planes[side][column]) - exact);
                const Rational bound = (Rational(1, 2) + support::power_of_two(-29)) *
                                       support::power_of_two(support::ulp_exponent<float>(exact));
                REQUIRE_MESSAGE(off <= bound, hex(matrix[column]), " ", hex(region.min()), " ", hex(region.max()));
                REQUIRE((exact < 0) == (planes[side][column] < 0.0f));
                zero += exact == 0;
            }
        }
    }
    CHECK(cancelling > 1000);
    CHECK(zero > 100);
}

TEST_CASE("a point is inside all clip planes where the projector lights it") {
    const texgen::PerspectiveLens lens{.fovy = texgen::degrees(30), .aspect = 1.5, .z_near = 0.2, .z_far = 1000};
    const texgen::Aim aim{.position = {2, 5, 5}, .target = {-2, -4, 0}, .up = {0, 1, 0}};
    Random random(1102);
    int inside = 0;
    for (const texgen::Conventions conventions : {texgen::opengl, texgen::vulkan}) {
        const auto projector = texgen::make_projector(lens, aim, conventions);
        REQUIRE(projector);
        const TextureRegion region = texgen::rectangle_texture(640.0, 480.0);
        const texgen::WorldTexgen matrix = texture_from_world(*projector, region);
        const auto planes = clip_planes(matrix, region);
        for (int i = 0; i < 2000; ++i) {
            const glm::dvec4 point(random.vector3(12.0), 1.0);
            const glm::dvec4 strq = matrix.matrix() * point;
            double least = HUGE_VAL, margin = HUGE_VAL;
            for (const glm::vec4& plane : planes) {
                double value = 0.0;
                for (int k = 0; k < 4; ++k) value += static_cast<double>(plane[k]) * point[k];
                least = std::min(least, value);
                margin = std::min(margin, std::fabs(value));
            }
            if (margin < 0.1) continue;
            const bool lit =
                strq.w > 0.0 && strq.x >= 0.0 && strq.x <= 640.0 * strq.w && strq.y >= 0.0 && strq.y <= 480.0 * strq.w;
            REQUIRE(lit == (least >= 0.0));
            inside += lit;
        }
    }
    CHECK(inside > 100);
}

TEST_CASE("what is not finite in the matrix is not finite in the planes that it reaches") {
    for (const float bad : {nan_float, infinity_float}) {
        glm::dmat4 matrix(1.0);
        matrix[2].x = static_cast<double>(bad);
        const auto planes = clip_planes(texgen::WorldTexgen(matrix), whole_texture());
        for (const std::size_t side : {0u, 3u, 4u}) CHECK(std::isfinite(planes[side].z));
        for (const std::size_t side : {1u, 2u}) CHECK_FALSE(std::isfinite(planes[side].z));
    }
}

TEST_CASE("an infinite side has no plane of its numbers, and an infinite w stays in what it reaches") {
    const auto without_side =
        clip_planes(texgen::WorldTexgen(glm::dmat4(1.0)), texgen::atlas_tile({-infinity_double, 0.0}, {1.0, 1.0}));
    const auto finite = [](const glm::vec4& plane) { return std::isfinite(plane.x + plane.y + plane.z + plane.w); };
    CHECK_FALSE(finite(without_side[1]));
    for (const std::size_t side : {0u, 2u, 3u, 4u}) CHECK(finite(without_side[side]));
    glm::dmat4 matrix(1.0);
    matrix[2].w = infinity_double;
    CHECK(clip_planes(texgen::WorldTexgen(matrix), whole_texture())[0] == glm::vec4(0, 0, infinity_float, 1));
}

TEST_CASE("a polygon inside the slide keeps every bit and its order, also where it touches the sides") {
    Random random(1103);
    int touching = 0;
    for (int i = 0; i < 3000; ++i) {
        const TextureRegion region = some_region(random);
        Polygon polygon;
        while (polygon.size() < static_cast<std::size_t>(random.integer(3, 8))) {
            const ClipVertex v = slide_vertex(random, region, 0.5);
            const Point p = point_of(v);
            if (!is_inside(p, region)) continue;
            touching += distance(1, p, region) == 0;
            polygon.push_back(v);
        }
        polygon[0].position.x = -0.0f;
        polygon[1].position.y = infinity_float;
        if (!region.depth()) polygon[2].strq.z = nan_float;
        REQUIRE_MESSAGE(bits(clipped(polygon, region)) == bits(polygon), hex_of(polygon, region));
    }
    CHECK(touching > 100);
}

TEST_CASE("a polygon that lies in a side as a whole, or in a limit of depth, stays as it is") {
    const TextureRegion region = whole_texture().with_depth(0.0, 1.0);
    const glm::vec2 free[] = {{0.125f, 0.25f}, {0.875f, 0.25f}, {0.5f, 0.75f}};
    for (int coordinate = 0; coordinate < 3; ++coordinate) {
        for (const float limit : {0.0f, 1.0f}) {
            Polygon polygon(3);
            for (std::size_t i = 0; i < 3; ++i) {
                const float q = 1.0f + static_cast<float>(i);
                polygon[i].position = {free[i], 0.0f, 1.0f};
                polygon[i].strq[coordinate] = limit * q;
                polygon[i].strq[(coordinate + 1) % 3] = free[i].x * q;
                polygon[i].strq[(coordinate + 2) % 3] = free[i].y * q;
                polygon[i].strq.w = q;
            }
            CHECK(bits(clipped(polygon, region)) == bits(polygon));
        }
    }
}

TEST_CASE("a polygon beyond one side leaves nothing, even where a corner touches") {
    Random random(1104);
    std::array<int, 7> beyond{};
    int touching = 0;
    for (int i = 0; i < 20000; ++i) {
        const TextureRegion region = some_region(random);
        const Polygon polygon{slide_vertex(random, region), slide_vertex(random, region), slide_vertex(random, region)};
        for (std::size_t side = 0; side < distance_count(region); ++side) {
            std::array<int, 3> sign{};
            for (std::size_t k = 0; k < 3; ++k) {
                const Rational d = distance(side, point_of(polygon[k]), region);
                sign[k] = d < 0 ? -1 : d > 0 ? 1 : 0;
            }
            const auto on_side = std::count(sign.begin(), sign.end(), 0);
            if (std::count(sign.begin(), sign.end(), 1) != 0 || on_side > 1) continue;
            ++beyond[side];
            touching += on_side == 1;
            REQUIRE_MESSAGE(clipped(polygon, region).empty(), hex_of(polygon, region));
        }
    }
    for (const int count : beyond) CHECK(count > 300);
    CHECK(touching > 100);
}

TEST_CASE("an edge on a side leaves nothing of what is beyond it, whatever corners it has") {
    Random random(1105);
    const TextureRegion region = texgen::whole_texture();
    for (int side = 0; side < 4; ++side) {
        for (int corners = 1; corners <= 5; ++corners) {
            for (int i = 0; i < 100; ++i) {
                const auto at = [&](double along, double beyond) {
                    const double q = std::ldexp(1.0, random.integer(-2, 2));
                    const double across = side % 2 == 0 ? -beyond : 1.0 + beyond;
                    const glm::dvec2 st = side < 2 ? glm::dvec2(across, along) : glm::dvec2(along, across);
                    return ClipVertex{random.vector4(1.0), glm::vec4(glm::dvec4(q * st.x, q * st.y, 0.5, q))};
                };
                Polygon polygon;
                for (int k = 0; k < corners; ++k) polygon.push_back(at(0.125 + 0.125 * k, 0.0));
                polygon.push_back(at(0.625, 0.5));
                polygon.push_back(at(0.125, 0.5));
                std::rotate(polygon.begin(), polygon.begin() + random.integer(0, corners + 1), polygon.end());
                REQUIRE_MESSAGE(clipped(polygon, region).empty(), hex_of(polygon, region));
            }
        }
    }
}

TEST_CASE("what comes out is inside within the stated error, and what was inside comes out") {
    Random random(1105);
    std::array<int, 11> counts{};
    int kept = 0, behind = 0, at_projector = 0;
    for (int i = 0; i < 30000; ++i) {
        const TextureRegion region = some_region(random);
        const Polygon polygon = i % 3 == 0 ? slide_polygon(random, region)
                                           : Polygon{slide_vertex(random, region), slide_vertex(random, region),
                                                     slide_vertex(random, region)};
        const Polygon out = clipped(polygon, region);
        REQUIRE_MESSAGE(out.size() <= polygon.size() + (region.depth() ? 7 : 5), hex_of(polygon, region));
        if (polygon.size() == 3) ++counts[out.size()];
        require_inside(out, polygon, region);
        const std::vector<Bits> left = bits(out);
        for (const ClipVertex& v : polygon) {
            behind += v.strq.w < 0.0f;
            at_projector += v.strq.x == 0.0f && v.strq.y == 0.0f && v.strq.w == 0.0f;
            if (out.empty() || !is_inside(point_of(v), region)) continue;
            ++kept;
            REQUIRE_MESSAGE(std::find(left.begin(), left.end(), bits(v)) != left.end(), hex_of(polygon, region));
        }
        // Each component is cut alike.
        for (const ClipVertex& v : out) REQUIRE_MESSAGE(v.position == v.strq, hex_of(polygon, region));
    }
    for (const std::size_t count : {0u, 3u, 4u, 5u, 6u}) CHECK(counts[count] > 200);
    CHECK(counts[7] > 20);
    CHECK(kept > 5000);
    CHECK(behind > 5000);
    CHECK(at_projector > 500);
}

TEST_CASE("a vertex next to a side, or on it, stays exactly where it is inside") {
    Random random(1113);
    int on_side = 0, beyond = 0, doubtful = 0;
    for (int i = 0; i < 20000; ++i) {
        Polygon polygon;
        for (int k = 0; k < 3; ++k) {
            const double q = random.power_of_ten(-2.0, 2.0);
            polygon.push_back({{0, 0, 0, static_cast<float>(k)},
                               {support::to_float(q * random.uniform(-4.0, 4.0)),
                                support::to_float(q * random.uniform(-4.0, 4.0)), 0.0f, support::to_float(q)}});
        }
        const glm::vec4& strq = polygon[0].strq;
        const auto side = static_cast<std::size_t>(random.integer(1, 4));
        const int k = side < 3 ? 0 : 1;
        // Sometimes the quotient is a double, and the vertex on the side.
        if (random.coin()) polygon[0].strq.w = 0.25f;
        double quotient = static_cast<double>(strq[k]) / static_cast<double>(strq.w);
        const int steps = random.integer(-1, 1);
        if (steps != 0) quotient = std::nextafter(quotient, steps * HUGE_VAL);
        glm::dvec2 min(-1e6), max(1e6);
        (side % 2 == 1 ? min : max)[k] = quotient;
        const TextureRegion region = atlas_tile(min, max);
        const Rational exact = distance(side, point_of(polygon[0]), region);
        // Volatile, so that no compiler fuses it with the difference.
        const volatile double of_q = quotient * static_cast<double>(strq.w);
        const double computed = (side % 2 == 1 ? 1.0 : -1.0) * (static_cast<double>(strq[k]) - of_q);
        const Polygon out = clipped(polygon, region);
        if (out.empty()) continue;
        const bool stays =
            std::any_of(out.begin(), out.end(), [&](const ClipVertex& v) { return bits(v) == bits(polygon[0]); });
        REQUIRE_MESSAGE(stays == (exact >= 0), hex_of(polygon, region));
        on_side += exact == 0;
        beyond += exact < 0;
        doubtful += exact < 0 && computed >= 0.0;
    }
    CHECK(on_side > 1000);
    CHECK(beyond > 1000);
    CHECK(doubtful > 300);
}

TEST_CASE("a vertex that one side makes is the exact intersection, each component the nearest float") {
    Random random(1106);
    int made = 0, made_by_depth = 0, cancelling = 0;
    for (int i = 0; i < 20000; ++i) {
        const TextureRegion region = some_region(random);
        Polygon polygon;
        while (polygon.size() < 3) polygon.push_back(slide_vertex(random, region, 1.0));
        if (random.coin()) {
            // The intersection's t, q or position become differences of nearly equal terms.
            const auto side = static_cast<std::size_t>(random.integer(1, static_cast<int>(distance_count(region)) - 1));
            const Rational da = distance(side, point_of(polygon[0]), region);
            const Rational db = distance(side, point_of(polygon[1]), region);
            if (da * db < 0) {
                for (int k = 0; k < 4; ++k)
                    polygon[1].position[k] = support::neighbour(
                        support::nearest<float>(db * exactly(polygon[0].position[k]) / da), random.integer(-2, 2));
                ++cancelling;
            }
        }
        // One side has vertices outside, and all the others none.
        std::size_t crossed = 0;
        int sides = 0;
        for (std::size_t side = 0; side < distance_count(region); ++side) {
            const bool crosses = std::any_of(polygon.begin(), polygon.end(), [&](const ClipVertex& v) {
                return distance(side, point_of(v), region) < 0;
            });
            if (crosses) crossed = side;
            sides += crosses;
        }
        if (sides != 1 || crossed == 0) continue;
        const Polygon out = clipped(polygon, region);
        const std::vector<Bits> given = bits(polygon);
        for (const ClipVertex& v : out) {
            if (std::find(given.begin(), given.end(), bits(v)) != given.end()) continue;
            bool found = false, projector_on_edge = false;
            for (std::size_t e = 0; e < 3; ++e) {
                const ClipVertex &a = polygon[e], &b = polygon[(e + 1) % 3];
                const Rational da = distance(crossed, point_of(a), region), db = distance(crossed, point_of(b), region);
                projector_on_edge = projector_on_edge || a.strq.w == 0.0f || b.strq.w == 0.0f;
                if (!(da * db < 0)) continue;
                const auto cut = [&](float of_a, float of_b) {
                    return support::nearest<float>((exactly(of_b) * da - exactly(of_a) * db) / (da - db));
                };
                bool same = true;
                for (int k = 0; k < 4; ++k)
                    same = same && v.position[k] == cut(a.position[k], b.position[k]) &&
                           v.strq[k] == cut(a.strq[k], b.strq[k]);
                found = found || same;
            }
            if (projector_on_edge) continue;
            ++made;
            made_by_depth += crossed > 4;
            REQUIRE_MESSAGE(found, hex_of(polygon, region));
        }
    }
    CHECK(made > 300);
    CHECK(made_by_depth > 50);
    CHECK(cancelling > 1000);
}

TEST_CASE("a side next to 0 cuts where it is, whatever floats meet there") {
    // s = 2^-400 q, from s = 0 at q = 2^127 to s = 2^-149 at q = 1: at 2^-124 of the edge, where a position of 2^26 is
    // 0.
    const auto vertex = [](float x, float s, float q) { return ClipVertex{{x, 0.0f, 0.0f, 1.0f}, {s, 0.0f, 0.0f, q}}; };
    const Polygon polygon{vertex(0x1p26f, 0x1p-149f, 1.0f), vertex(1.0f, 0.0f, 0x1p127f), vertex(3.0f, 1.0f, 1.0f)};
    const Polygon out = clipped(polygon, atlas_tile({0x1p-400, -1.0}, {2.0, 1.0}));
    REQUIRE(out.size() == 4);
    for (const ClipVertex& v : out)
        CHECK_MESSAGE((v.position.x == 0x1p26f || v.position.x == 1.0f || v.position.x == 3.0f), hex(v.position));
}

TEST_CASE("the area on the slide is that of the exact clip") {
    Random random(1107);
    int partial = 0, whole = 0, through_projector_plane = 0;
    for (int i = 0; i < 4000; ++i) {
        const TextureRegion region = some_region(random);
        const Polygon polygon = i % 2 == 0 ? slide_polygon(random, region)
                                           : Polygon{slide_vertex(random, region), slide_vertex(random, region),
                                                     slide_vertex(random, region)};
        const std::vector<Point> exact = clipped_exactly(polygon, region);
        // The projector itself has no place on the slide.
        if (std::any_of(exact.begin(), exact.end(), [](const Point& p) { return p.q == 0; })) continue;
        const Rational area = area_of(exact);
        const Rational off = magnitude(area_of(clipped(polygon, region)) - area);
        const glm::dvec2 size = region.max() - region.min();
        const double largest = std::max({std::fabs(region.min().x), std::fabs(region.min().y),
                                         std::fabs(region.max().x), std::fabs(region.max().y)});
        // A side of the polygon moves by the rounding of its ends, which are larger than the region by far.
        REQUIRE_MESSAGE(off <= exactly(1e-2 * largest * (size.x + size.y) * 0x1p-10), hex_of(polygon, region));
        partial += area > 0 && area < exactly(1.99 * size.x * size.y);
        whole += area >= exactly(1.99 * size.x * size.y);
        through_projector_plane +=
            area > 0 && std::any_of(polygon.begin(), polygon.end(), [](const ClipVertex& v) { return v.strq.w < 0; });
    }
    CHECK(partial > 1000);
    CHECK(whole > 20);
    CHECK(through_projector_plane > 200);
}

TEST_CASE("two polygons that share an edge have the same vertices on it, whatever else they hold") {
    Random random(1108);
    int cut_once = 0, cut_twice = 0, through_projector_plane = 0, at_projector = 0, lost = 0, slivers = 0;
    int quadrilaterals = 0;
    for (int i = 0; i < 30000; ++i) {
        const TextureRegion region = some_region(random);
        // position.z is 0 on the edge, and on no other vertex of either polygon.
        ClipVertex a = slide_vertex(random, region), b = slide_vertex(random, region);
        a.position.z = b.position.z = 0.0f;
        const auto around = [&](const ClipVertex& from, const ClipVertex& to) {
            Polygon polygon{from, to};
            const auto add = [&] {
                polygon.push_back(slide_vertex(random, region));
                glm::vec4& strq = polygon.back().strq;
                if (random.integer(0, 3) == 0) {
                    // A sliver along the edge.
                    strq = random.coin() ? from.strq : to.strq;
                    strq[random.integer(0, 1)] *= 1.0f + 0x1p-22f;
                    ++slivers;
                }
                polygon.back().position.z = 1.0f;
            };
            add();
            add();
            if (is_convex(polygon))
                ++quadrilaterals;
            else
                polygon.pop_back();
            std::rotate(polygon.begin(), polygon.begin() + random.integer(0, 2), polygon.end());
            return polygon;
        };
        const Polygon left = around(a, b), right = around(b, a);
        const auto on_edge = [&](const Polygon& polygon) {
            std::vector<Bits> result;
            for (const ClipVertex& v : clipped(polygon, region))
                if (v.position.z == 0.0f) result.push_back(bits(v));
            std::sort(result.begin(), result.end());
            result.erase(std::unique(result.begin(), result.end()), result.end());
            return result;
        };
        const std::vector<Bits> one = on_edge(left), other = on_edge(right);
        const std::string context = hex_of(left, region) + " and " + hex_of(right, region);
        // A polygon that only touches the region is dropped, with its edge.
        if (one.empty() || other.empty()) {
            if (one.size() + other.size() < 2) continue;
            const std::vector<Point> exact = clipped_exactly(one.empty() ? left : right, region);
            if (std::any_of(exact.begin(), exact.end(), [](const Point& p) { return p.q == 0; })) continue;
            ++lost;
            const glm::dvec2 size = region.max() - region.min();
            REQUIRE_MESSAGE(area_of(exact) <= exactly(1e-5 * size.x * size.y), context);
            continue;
        }
        REQUIRE_MESSAGE(one == other, context);
        if (one.size() < 2) continue;
        const auto made = 2 - std::count(one.begin(), one.end(), bits(a)) - std::count(one.begin(), one.end(), bits(b));
        cut_once += made == 1;
        cut_twice += made == 2;
        through_projector_plane += a.strq.w * b.strq.w < 0.0f;
        at_projector += a.strq == glm::vec4(0, 0, a.strq.z, 0) || b.strq == glm::vec4(0, 0, b.strq.z, 0);
    }
    CHECK(cut_once > 500);
    CHECK(cut_twice > 500);
    CHECK(through_projector_plane > 200);
    CHECK(at_projector > 20);
    CHECK(slivers > 1000);
    CHECK(quadrilaterals > 1000);
    CHECK(lost < 400);
}

TEST_CASE("a mesh stays closed: the pieces of a fan cover what the whole does") {
    Random random(1109);
    int cut = 0;
    for (int i = 0; i < 2000; ++i) {
        const TextureRegion region = some_region(random);
        const Polygon whole = slide_polygon(random, region);
        // The fan is about a vertex: its diagonals are shared, and every area has the same sign.
        Rational pieces = 0;
        for (std::size_t k = 1; k + 1 < whole.size(); ++k)
            pieces += area_of(clipped({whole[0], whole[k], whole[k + 1]}, region));
        const Rational area = area_of(clipped(whole, region));
        const double largest = std::max({std::fabs(region.min().x), std::fabs(region.min().y),
                                         std::fabs(region.max().x), std::fabs(region.max().y)});
        const glm::dvec2 size = region.max() - region.min();
        REQUIRE_MESSAGE(magnitude(pieces - area) <= exactly(1e-4 * largest * (size.x + size.y)), hex_of(whole, region));
        cut += area > 0 && area < area_of(whole);
    }
    CHECK(cut > 300);
}

TEST_CASE("at the projector itself there is no coordinate: a polygon that reaches it is cut just before") {
    const auto vertex = [](float s, float t, float q) { return ClipVertex{{s, t, q, 1}, {s, t, 0, q}}; };
    SUBCASE("a corner") {
        const Polygon out = clipped(
            {
                vertex(0, 0, 0),
                vertex(1, 1, 4),
                vertex(3, 3, 4),
            },
            whole_texture());
        REQUIRE(out.size() == 4);
        CHECK(std::count_if(out.begin(), out.end(), [](const ClipVertex& v) { return v.strq.w == 0x1p-18f; }) == 2);
    }
    SUBCASE("seen edge on, with the projector inside it") {
        // The plane t = q / 2, from behind the projector to in front of it: a wedge is left, without its tip.
        const Polygon plane{vertex(-4, -1, -2), vertex(6, -1, -2), vertex(6, 2, 4), vertex(-4, 2, 4)};
        const Polygon out = clipped(plane, whole_texture());
        REQUIRE(out.size() == 4);
        for (const ClipVertex& v : out) {
            CHECK(v.strq.w > 0.0f);
            CHECK(v.strq.y == 0.5f * v.strq.w);
            const bool at_side = v.strq.x == 0.0f || v.strq.x == v.strq.w;
            CHECK(at_side);
            const bool at_end = v.strq.w == 4.0f || v.strq.w == 0x1p-18f;
            CHECK(at_end);
        }
    }
    SUBCASE("on an edge") {
        const Polygon out = clipped({vertex(-1, -1, -2), vertex(2, 2, 4), vertex(1, 2, 4)}, whole_texture());
        REQUIRE(out.size() >= 3);
        for (const ClipVertex& v : out) CHECK(v.strq.w > 0.0f);
        CHECK(std::any_of(out.begin(), out.end(), [](const ClipVertex& v) { return v.strq.w == 4.0f; }));
    }
    SUBCASE("all of it") {
        CHECK(clipped({vertex(0, 0, 0), vertex(0, 0, 0), vertex(0, 0, 0)}, whole_texture()).empty());
        CHECK(clipped({vertex(1, 0, 0), vertex(0, 1, 0), vertex(-1, -1, 0)}, whole_texture()).empty());
    }
}

TEST_CASE("a region without a point leaves nothing; sides at infinity cut nothing") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Random random(1110);
    int left = 0;
    for (int i = 0; i < 2000; ++i) {
        const Polygon polygon{slide_vertex(random, whole_texture()), slide_vertex(random, whole_texture()),
                              slide_vertex(random, whole_texture())};
        CHECK(clipped(polygon, atlas_tile({1, 0}, {0, 1})).empty());
        CHECK(clipped(polygon, atlas_tile({0, 0}, {1, nan})).empty());
        CHECK(clipped(polygon, atlas_tile({nan, 0}, {1, 1})).empty());
        const TextureRegion strip = atlas_tile({0.0, -HUGE_VAL}, {1.0, HUGE_VAL});
        const Polygon out = clipped(polygon, strip);
        left += !out.empty();
        const TextureRegion tall = atlas_tile({0.0, -1e30}, {1.0, 1e30});
        require_inside(out, polygon, tall);
        const TextureRegion any = atlas_tile({-HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL});
        if (std::all_of(polygon.begin(), polygon.end(), [](const ClipVertex& v) { return v.strq.w > 0.0f; }))
            CHECK(bits(clipped(polygon, any)) == bits(polygon));
    }
    CHECK(left > 500);
}

TEST_CASE("a depth without a point leaves nothing, one to infinity cuts nothing, and r must be a number then") {
    const auto vertex = [](float s, float t, float r) { return ClipVertex{{s, t, r, 1}, {s, t, r, 1}}; };
    const Polygon polygon{vertex(0.25f, 0.25f, -2.0f), vertex(0.75f, 0.25f, 0.5f), vertex(0.5f, 0.75f, 3.0f)};
    const double infinite = HUGE_VAL, nan = std::numeric_limits<double>::quiet_NaN();
    for (const TextureRegion& region : {whole_texture().with_depth(1.0, 0.0), whole_texture().with_depth(nan, 1.0),
                                        whole_texture().with_depth(0.0, nan), whole_texture().with_depth(4.0, 5.0)})
        CHECK(clipped(polygon, region).empty());
    CHECK(bits(clipped(polygon, whole_texture().with_depth(-infinite, infinite))) == bits(polygon));
    CHECK(clipped(polygon, whole_texture().with_depth(0.0, infinite)).size() == 4);
    CHECK(clipped(polygon, whole_texture().with_depth()).size() == 5);
    for (const float bad : {nan_float, infinity_float}) {
        Polygon spoilt = polygon;
        spoilt[1].strq.z = bad;
        CHECK(bits(clipped(spoilt, whole_texture())) == bits(spoilt));
        CHECK(clipped(spoilt, whole_texture().with_depth()).empty());
    }
    // In the place of an infinite limit stands q, so that all planes hold where a point is lit.
    glm::dmat4 matrix(1.0);
    matrix[2] = {0.25, 0.5, 2.0, 1.0};
    const auto planes = clip_planes(texgen::WorldTexgen(matrix), whole_texture().with_depth(0.5, infinite));
    REQUIRE(planes.size() == 7);
    CHECK(planes[5] == glm::vec4(0.0f, 0.0f, 1.5f, -0.5f));
    CHECK(planes[6] == planes[0]);
}

TEST_CASE("NaN and infinity: s, t, q drop the polygon, r and the position spoil themselves only, nothing crashes") {
    const Polygon good{{{0, 0, 0, 1}, {0.5f, 0.5f, 0, 1}}, {{1, 0, 0, 1}, {3, 0, 0, 1}}, {{0, 1, 0, 1}, {0, 3, 0, 1}}};
    const Polygon clean = clipped(good, whole_texture());
    REQUIRE(clean.size() >= 3);
    for (const float bad : {nan_float, infinity_float, -infinity_float}) {
        for (std::size_t i = 0; i < 3; ++i) {
            for (const int k : {0, 1, 3}) {
                Polygon polygon = good;
                polygon[i].strq[k] = bad;
                CHECK(clipped(polygon, whole_texture()).empty());
            }
            Polygon polygon = good;
            polygon[i].strq.z = bad;
            polygon[i].position.y = bad;
            const Polygon spoiled = clipped(polygon, whole_texture());
            REQUIRE(spoiled.size() == clean.size());
            for (std::size_t v = 0; v < clean.size(); ++v) {
                for (const int k : {0, 1, 3}) CHECK(spoiled[v].strq[k] == clean[v].strq[k]);
                for (const int k : {0, 2, 3}) CHECK(spoiled[v].position[k] == clean[v].position[k]);
            }
        }
    }
    Random random(1111);
    int left = 0;
    for (int i = 0; i < 40000; ++i) {
        Polygon polygon(static_cast<std::size_t>(random.integer(0, 6)));
        for (ClipVertex& v : polygon) {
            for (int k = 0; k < 4; ++k) {
                v.position[k] = random.any_float();
                v.strq[k] = random.any_float();
            }
        }
        const auto side = [&] {
            return random.coin() ? static_cast<double>(random.any_float()) : random.power_of_ten(-300.0, 300.0);
        };
        const TextureRegion region =
            random.coin() ? atlas_tile({side(), side()}, {side(), side()}) : atlas_tile({-1e3, -1e3}, {1e3, 1e3});
        const Polygon out = clipped(polygon, region);
        left += !out.empty();
        for (const ClipVertex& v : out) REQUIRE_MESSAGE(v.strq.w > 0.0f, hex_of(polygon, region));
    }
    CHECK(left > 500);
}

TEST_CASE("fewer than three vertices have no area, and a zigzag is cut as it is while there is room") {
    const ClipVertex in{{}, {0.5f, 0.5f, 0, 1}}, out{{}, {2, 0.5f, 0, 1}};
    CHECK(clipped({}, whole_texture()).empty());
    CHECK(clipped({in}, whole_texture()).empty());
    CHECK(clipped({in, in}, whole_texture()).empty());
    CHECK(clipped({in, out, in, out}, whole_texture()).size() == 6);
    Polygon zigzag;
    for (int i = 0; i < 5; ++i) zigzag.insert(zigzag.end(), {in, out});
    CHECK(clipped(zigzag, whole_texture()).size() == 15);
    zigzag.insert(zigzag.end(), {in, out});
    CHECK(clipped(zigzag, whole_texture()).empty());
}

TEST_CASE("a polygon may be clipped to the slide where it lies, and in more room than it needs") {
    Random random(1112);
    for (int i = 0; i < 2000; ++i) {
        const TextureRegion region = some_region(random);
        const Polygon polygon = slide_polygon(random, region);
        Polygon storage = polygon;
        storage.resize(polygon.size() + (region.depth() ? 7 : 5) + static_cast<std::size_t>(random.integer(0, 3)));
        const std::span<ClipVertex> all(storage);
        storage.resize(clip_to_slide(all.first(polygon.size()), region, all));
        REQUIRE_MESSAGE(bits(storage) == bits(clipped(polygon, region)), hex_of(polygon, region));
    }
}
