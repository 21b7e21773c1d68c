// Clipping to the slide, and the slide's planes, judged by exact rationals.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "api/clip_slide_test/slide_polygons.hpp"
#include "judges/numbers.hpp"
#include "support/polygons.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/clip.hpp"

namespace clip_slide_cases {

namespace {

bool is_inside(const Point& p, const TextureRegion& region) {
    for (std::size_t side = 0; side < distance_count(region); ++side)
        if (distance(side, p, region) < 0) return false;
    return p.q > 0;
}

}  // namespace

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
        polygon[1].position.y = support::infinity_float;
        if (!region.depth()) polygon[2].strq.z = support::nan_float;
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

TEST_CASE("an edge on a side leaves nothing of what is beyond it, whatever corners it has and whatever else cuts it") {
    Random random(1105);
    const TextureRegion region = texgen::rectangle_texture(640.0, 480.0);
    for (int side = 0; side < 4; ++side) {
        for (int corners = 1; corners <= 5; ++corners) {
            for (int i = 0; i < 100; ++i) {
                const auto at = [&](double along, double beyond) {
                    const double q =
                        1.0 + random.integer(0, 1023) / 1024.0;  // of a side's product a float has all digits
                    const double across = side % 2 == 0 ? -beyond : 1.0 + beyond;
                    const glm::dvec2 st = side < 2 ? glm::dvec2(across, along) : glm::dvec2(along, across);
                    return ClipVertex{random.vector4(1.0),
                                      glm::vec4(glm::dvec4(q * 640.0 * st.x, q * 480.0 * st.y, 0.5, q))};
                };
                Polygon polygon;
                for (int k = 0; k < corners; ++k) polygon.push_back(at(-0.25 + 0.35 * k, 0.0));
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
        const std::vector<support::Bits> left = bits(out);
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

}  // namespace clip_slide_cases
