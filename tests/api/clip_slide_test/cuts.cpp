// Where the sides cut: vertices on them, areas, and the edges that polygons share.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "api/clip_slide_test/slide_polygons.hpp"
#include "judges/oracle.hpp"
#include "support/hex.hpp"
#include "support/polygons.hpp"
#include "support/random.hpp"
#include "texgen/clip.hpp"

namespace clip_slide_cases {

using support::Bits;
using support::magnitude;

namespace {

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

}  // namespace

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

}  // namespace clip_slide_cases
