// Polygons at the projector itself, regions and depths without a point or without an end, and what is no number.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "api/clip_slide_test/slide_polygons.hpp"
#include "support/polygons.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/clip.hpp"

namespace clip_slide_cases {

using support::infinity_double;
using support::infinity_float;
using support::nan_double;
using support::nan_float;

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
    Random random(1110);
    int left = 0;
    for (int i = 0; i < 2000; ++i) {
        const Polygon polygon{slide_vertex(random, whole_texture()), slide_vertex(random, whole_texture()),
                              slide_vertex(random, whole_texture())};
        CHECK(clipped(polygon, atlas_tile({1, 0}, {0, 1})).empty());
        CHECK(clipped(polygon, atlas_tile({0, 0}, {1, nan_double})).empty());
        CHECK(clipped(polygon, atlas_tile({nan_double, 0}, {1, 1})).empty());
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
    for (const TextureRegion& region :
         {whole_texture().with_depth(1.0, 0.0), whole_texture().with_depth(nan_double, 1.0),
          whole_texture().with_depth(0.0, nan_double), whole_texture().with_depth(4.0, 5.0)})
        CHECK(clipped(polygon, region).empty());
    CHECK(bits(clipped(polygon, whole_texture().with_depth(-infinity_double, infinity_double))) == bits(polygon));
    CHECK(clipped(polygon, whole_texture().with_depth(0.0, infinity_double)).size() == 4);
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
    const auto planes = clip_planes(texgen::WorldTexgen(matrix), whole_texture().with_depth(0.5, infinity_double));
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

}  // namespace clip_slide_cases
