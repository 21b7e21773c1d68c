// Vertices at the eye, near planes that are oblique, cameras whose w is 1, and positions that are no numbers.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "api/clip_test/near_planes.hpp"
#include "support/polygons.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/clip.hpp"

namespace clip_cases {

using support::infinity_float;
using support::Random;

TEST_CASE("a vertex at the eye itself does not come out, with a near plane that lets it through") {
    // z >= 0 everywhere: the near plane of this camera leaves w <= 0 in front of it.
    const ClipVertex in_front{{0.5f, 0.25f, 1.0f, 2.0f}, {1, 2, 3, 4}}, at_eye{{1.0f, 0.0f, 1.0f, 0.0f}, {5, 6, 7, 8}};
    const ClipVertex behind{{1.0f, 1.0f, 0.5f, -3.0f}, {0, 0, 0, 1}}, also_in_front{{-1, 0, 1, 1}, {0, 0, 1, 1}};
    Polygon out(4);
    for (const ClipVertex& hidden : {at_eye, behind}) {
        const Polygon polygon{in_front, also_in_front, hidden};
        const std::size_t count = clip_to_near(polygon, out, DepthRange::zero_to_one);
        REQUIRE(count == 4);
        for (const ClipVertex& v : out) {
            CHECK(v.position.w > 0.0f);
            CHECK(v.position.z >= 0.0f);
        }
        // A millionth of the way is left: the cut is where w is 2^-20 of the vertex in front.
        CHECK(std::any_of(out.begin(), out.end(), [](const ClipVertex& v) { return v.position.w == 0x1p-19f; }));
        CHECK(std::any_of(out.begin(), out.end(), [](const ClipVertex& v) { return v.position.w == 0x1p-20f; }));
    }
    const Polygon hidden{at_eye, behind, behind};
    CHECK(clip_to_near(hidden, out, DepthRange::zero_to_one) == 0);
    // The near plane and the eye cut different corners: that takes one vertex more than the contract's room.
    const ClipVertex below{{0, 3, -1.0f, 2.0f}, {0, 0, 0, 1}};
    const Polygon both{in_front, at_eye, below};
    CHECK(clip_to_near(both, out, DepthRange::zero_to_one) == 0);
    Polygon roomy(5);
    const std::size_t count = clip_to_near(both, roomy, DepthRange::zero_to_one);
    REQUIRE(count == 5);
    for (const ClipVertex& v : roomy) CHECK((v.position.w > 0.0f && v.position.z >= 0.0f));
}

TEST_CASE("an oblique near plane keeps its promises over random homogeneous triangles") {
    Random random(35);
    for (const NearPlane plane : near_planes) {
        int cut_twice = 0, kept = 0;
        for (int i = 0; i < 3000; ++i) {
            const auto any = [&random] {
                return ClipVertex{random.vector4(random.power_of_ten(-20.0, 20.0)), random.vector4(1.0)};
            };
            const Polygon triangle{any(), any(), any()};
            Polygon out(5);
            out.resize(clip_to_near(triangle, out, plane.range, plane.reversed));
            cut_twice += out.size() == 5;
            kept += !out.empty();
            for (const ClipVertex& v : out) {
                REQUIRE_MESSAGE(v.position.w > 0.0f, hex_of(triangle));
                REQUIRE_MESSAGE(distance(v.position, plane) >= 0, hex_of(triangle));
            }
        }
        CHECK(cut_twice > 50);
        CHECK(kept > 1000);
    }
}

TEST_CASE("an orthographic camera has w = 1, and its cuts keep it") {
    Random random(36);
    for (const NearPlane plane : near_planes) {
        for (int i = 0; i < 500; ++i) {
            Polygon triangle;
            for (int k = 0; k < 3; ++k) triangle.push_back({{random.vector3(3.0), 1.0f}, random.vector4(2.0)});
            for (const ClipVertex& v : clipped(triangle, plane))
                REQUIRE_MESSAGE(v.position.w == 1.0f, hex_of(triangle));
        }
    }
}

TEST_CASE("NaN and infinity: a position drops its polygon, a coordinate spoils itself only, nothing crashes") {
    const ClipVertex a{{0, 0, 0.5f, 1}, {0, 0, 0, 1}}, b{{1, 0, 0.5f, 1}, {1, 0, 0, 1}}, c{{0, 1, -3, 1}, {0, 1, 0, 1}};
    for (const float bad : {support::nan_float, infinity_float, -infinity_float}) {
        for (int k = 0; k < 4; ++k) {
            for (std::size_t i = 0; i < 3; ++i) {
                Polygon polygon{a, b, c};
                polygon[i].position[k] = bad;
                CHECK(clipped(polygon, near_planes[0]).empty());
            }
            Polygon polygon{a, b, c};
            const Polygon clean = clipped(polygon, near_planes[0]);
            polygon[2].strq[k] = bad;
            const Polygon spoiled = clipped(polygon, near_planes[0]);
            REQUIRE(spoiled.size() == clean.size());
            for (std::size_t i = 0; i < clean.size(); ++i) {
                CHECK(spoiled[i].position == clean[i].position);
                for (int other = 0; other < 4; ++other) {
                    const bool same = spoiled[i].strq[other] == clean[i].strq[other];
                    CHECK(same == (other != k || clean[i].position.z > 0.0f));
                    if (!same) CHECK_FALSE(std::isfinite(spoiled[i].strq[other]));
                }
            }
        }
    }
    Random random(37);
    for (int i = 0; i < 20000; ++i) {
        Polygon polygon(static_cast<std::size_t>(random.integer(0, 6)));
        for (ClipVertex& v : polygon) {
            for (int k = 0; k < 4; ++k) {
                v.position[k] = random.any_float();
                v.strq[k] = random.any_float();
            }
        }
        for (const NearPlane plane : near_planes) {
            for (const ClipVertex& v : clipped(polygon, plane)) {
                REQUIRE_MESSAGE(v.position.w > 0.0f, hex_of(polygon));
                REQUIRE_MESSAGE(distance(v.position, plane) >= 0, hex_of(polygon));
            }
        }
    }
}

}  // namespace clip_cases
