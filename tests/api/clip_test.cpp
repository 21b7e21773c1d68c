// Clipping to the camera's near plane, and the way into the window, judged by exact rationals.

#include "texgen/clip.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "api/clip_test/near_planes.hpp"
#include "judges/oracle.hpp"
#include "support/polygons.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"

namespace clip_cases {

using support::Bits;
using support::bits;
using support::Random;

namespace {

// A camera with near 0.1 and far 1000: clip coordinates of a point in front of it or behind it, or (rarely) exactly at
// the eye or on the near plane.
ClipVertex camera_vertex(Random& random, NearPlane plane, double toward_front = 0.5) {
    const double near = 0.125, far = 1024.0;
    double w = random.power_of_ten(-2.0, 3.0) * (random.uniform(0.0, 1.0) < toward_front ? 1.0 : -1.0);
    const int special = random.integer(0, 19);
    if (special == 0) w = near;
    if (special == 1) w = 0.0;
    double z = plane.range == DepthRange::zero_to_one ? far / (far - near) * (w - near)
                                                      : ((far + near) * w - 2.0 * far * near) / (far - near);
    if (plane.reversed) z = plane.range == DepthRange::zero_to_one ? w - z : -z;
    if (special == 0) z = plane.reversed ? w : plane.range == DepthRange::zero_to_one ? 0.0 : -w;
    return {{support::to_float(w * random.uniform(-2.0, 2.0)), support::to_float(w * random.uniform(-2.0, 2.0)),
             support::to_float(z), support::to_float(w)},
            random.vector4(random.power_of_ten(-3.0, 3.0))};
}

// Now and then: the coordinates of the first edge's intersection become differences of nearly equal terms.
bool cancel_on_first_edge(Polygon& triangle, NearPlane plane, Random& random) {
    ClipVertex& a = triangle[0];
    ClipVertex& b = triangle[1];
    const Rational da = distance(a.position, plane), db = distance(b.position, plane);
    if (da == 0 || (da < 0) == (db < 0) || random.coin()) return false;
    for (int k = 0; k < 4; ++k)
        b.strq[k] = support::neighbour(support::nearest<float>(db * exactly(a.strq[k]) / da), random.integer(-2, 2));
    return true;
}

}  // namespace

TEST_CASE("a polygon in front of the near plane keeps every bit, and its order") {
    Random random(31);
    for (const NearPlane plane : near_planes) {
        for (int i = 0; i < 500; ++i) {
            Polygon polygon;
            while (polygon.size() < static_cast<std::size_t>(random.integer(3, 8))) {
                const ClipVertex v = camera_vertex(random, plane, 1.0);
                if (distance(v.position, plane) >= 0 && v.position.w > 0.0f) polygon.push_back(v);
            }
            polygon[0].strq.x = -0.0f;
            polygon[1].strq.y = support::infinity_float;
            REQUIRE_MESSAGE(bits(clipped(polygon, plane)) == bits(polygon), hex_of(polygon));
        }
        // In the plane itself nothing is behind.
        const float z = plane.reversed ? 1.0f : plane.range == DepthRange::zero_to_one ? 0.0f : -1.0f;
        Polygon polygon;
        for (const glm::vec2 corner : {glm::vec2(0.0f, 0.0f), glm::vec2(1.0f, 0.0f), glm::vec2(0.0f, 1.0f)})
            polygon.push_back({glm::vec4(corner, z, 1.0f), glm::vec4(corner, 0.0f, 1.0f)});
        CHECK(bits(clipped(polygon, plane)) == bits(polygon));
    }
}

TEST_CASE("a polygon behind the near plane leaves nothing, even where it touches") {
    Random random(32);
    for (const NearPlane plane : near_planes) {
        int touching = 0;
        for (int i = 0; i < 500; ++i) {
            Polygon polygon;
            while (polygon.size() < 3) {
                const ClipVertex v = camera_vertex(random, plane, 0.3);
                if (distance(v.position, plane) <= 0) polygon.push_back(v);
            }
            const auto on_plane = std::count_if(polygon.begin(), polygon.end(), [plane](const ClipVertex& v) {
                return distance(v.position, plane) == 0;
            });
            touching += on_plane == 1 || on_plane == 2;
            if (on_plane < 3) REQUIRE_MESSAGE(clipped(polygon, plane).empty(), hex_of(polygon));
        }
        CHECK(touching > 10);
    }
}

TEST_CASE("an edge on the near plane leaves nothing of what is behind it, whatever corners it has") {
    Random random(321);
    for (const NearPlane plane : near_planes) {
        for (int corners = 1; corners <= 5; ++corners) {
            for (int i = 0; i < 100; ++i) {
                const auto at = [&](double along, double depth) {
                    ClipVertex v = camera_vertex(random, plane);
                    const float w = random.uniform_float(0.5, 2.0);
                    const float z = plane.reversed ? w : plane.range == DepthRange::zero_to_one ? 0.0f : -w;
                    const float behind = support::to_float(plane.reversed ? depth : -depth);
                    v.position = {support::to_float(along) * w, 0.0f, z + behind, w};
                    return v;
                };
                Polygon polygon;
                for (int k = 0; k < corners; ++k) polygon.push_back(at(k, 0.0));
                polygon.push_back(at(4.0, 1.0));
                polygon.push_back(at(0.0, 1.0));
                std::rotate(polygon.begin(), polygon.begin() + random.integer(0, corners + 1), polygon.end());
                REQUIRE_MESSAGE(clipped(polygon, plane).empty(), hex_of(polygon));
            }
        }
        // Within the plane, though, it is not behind; and a polygon without an area stays one.
        const auto on_plane = [&](float x, float y) {
            return ClipVertex{{x, y,
                               plane.reversed                           ? 1.0f
                               : plane.range == DepthRange::zero_to_one ? 0.0f
                                                                        : -1.0f,
                               1.0f},
                              {}};
        };
        CHECK(clipped({on_plane(0.0f, 0.0f), on_plane(1.0f, 0.0f), on_plane(0.0f, 1.0f)}, plane).size() == 3);
        CHECK(clipped({on_plane(0.0f, 0.0f), on_plane(1.0f, 0.0f), on_plane(2.0f, 0.0f)}, plane).size() == 3);
    }
}

TEST_CASE("what comes out is in front of the near plane, has w > 0, and lies on the polygon within the stated error") {
    Random random(33);
    for (const NearPlane plane : near_planes) {
        std::array<int, 4> inside_counts{};
        int new_vertices = 0;
        int cancelling = 0;
        for (int i = 0; i < 3000; ++i) {
            Polygon triangle{camera_vertex(random, plane), camera_vertex(random, plane), camera_vertex(random, plane)};
            cancelling += cancel_on_first_edge(triangle, plane, random);
            const auto inside = std::count_if(triangle.begin(), triangle.end(), [plane](const ClipVertex& v) {
                return distance(v.position, plane) >= 0;
            });
            ++inside_counts[static_cast<std::size_t>(inside)];
            const Polygon out = clipped(triangle, plane);
            const std::string input = hex_of(triangle);
            REQUIRE_MESSAGE(out.size() <= 4, input);
            if (inside == 3) REQUIRE_MESSAGE(out.size() >= 3, input);
            for (const ClipVertex& v : out) {
                REQUIRE_MESSAGE(v.position.w > 0.0f, input);
                REQUIRE_MESSAGE(distance(v.position, plane) >= 0, input);
                const bool kept = std::any_of(triangle.begin(), triangle.end(),
                                              [&v](const ClipVertex& old) { return bits(old) == bits(v); });
                if (kept) continue;
                ++new_vertices;
                REQUIRE_MESSAGE(distance(v.position, plane) == 0, input);
                // One of the three edges has this intersection.
                bool found = false;
                for (std::size_t e = 0; e < 3 && !found; ++e) {
                    const ClipVertex& a = triangle[e];
                    const ClipVertex& b = triangle[(e + 1) % 3];
                    const Rational da = distance(a.position, plane), db = distance(b.position, plane);
                    if ((da < 0) == (db < 0)) continue;
                    const Rational t = da / (da - db);
                    bool matches = true;
                    for (const int k : {0, 1, 3, 4, 5, 6, 7}) {
                        const auto component = [k](const ClipVertex& vertex) {
                            return k < 4 ? vertex.position[k] : vertex.strq[k - 4];
                        };
                        const Rational from_a = (1 - t) * exactly(component(a)), from_b = t * exactly(component(b));
                        const Rational exact = from_a + from_b;
                        const Rational slack =
                            exactly(texgen::clip_error) * (support::magnitude(from_a) + support::magnitude(from_b));
                        matches = matches && is_rounded(component(v), exact, slack);
                    }
                    found = matches;
                }
                REQUIRE_MESSAGE(found, input);
            }
        }
        for (const int count : inside_counts) CHECK(count > 100);
        CHECK(new_vertices > 1000);
        CHECK(cancelling > 300);
    }
}

TEST_CASE("an edge that crosses the near plane next to the eye keeps the digits of its w") {
    Random random(48);
    int cancelling = 0;
    for (const NearPlane plane : near_planes) {
        for (int i = 0; i < 2000; ++i) {
            const auto end = [&](float side) {
                const float large = side * random.uniform_float(1.0, 4.0);
                const float small = std::ldexp(random.uniform_float(1.0, 2.0), -random.integer(1, 120));
                const bool is_plain = !plane.reversed && plane.range == DepthRange::zero_to_one;
                const float z = is_plain ? large : plane.reversed ? small : -small;
                return ClipVertex{
                    {random.uniform_float(-1.0, 1.0), random.uniform_float(-1.0, 1.0), z, is_plain ? small : large},
                    random.vector4(1.0)};
            };
            const Polygon triangle{end(1.0f), end(-1.0f), end(1.0f)};
            const Polygon out = clipped(triangle, plane);
            const std::string input = hex_of(triangle);
            REQUIRE_MESSAGE(out.size() == 4, input);
            const auto is_crossing = [&](const ClipVertex& v) {
                for (const ClipVertex* inside : {&triangle[0], &triangle[2]}) {
                    const ClipVertex& outside = triangle[1];
                    const Rational d_i = distance(inside->position, plane), d_o = distance(outside.position, plane);
                    const auto between = [&](float from, float to) {
                        return Rational((d_i * exactly(to) - d_o * exactly(from)) / (d_i - d_o));
                    };
                    const Rational w = between(inside->position.w, outside.position.w);
                    const Rational x = between(inside->position.x, outside.position.x);
                    cancelling += w < exactly(0x1p-60);
                    // The terms of x are at most 1 together.
                    const Rational error = exactly(texgen::clip_error);
                    if (is_rounded(v.position.w, w, w * error) && is_rounded(v.position.x, x, error)) return true;
                }
                return false;
            };
            for (const ClipVertex& v : out) {
                REQUIRE_MESSAGE(distance(v.position, plane) >= 0, input);
                const bool is_kept = bits(v) == bits(triangle[0]) || bits(v) == bits(triangle[2]);
                REQUIRE_MESSAGE((is_kept || is_crossing(v)), input);
            }
        }
    }
    CHECK(cancelling > 1000);
}

TEST_CASE("neighbours that share an edge get the same bits on it, whichever way they walk") {
    Random random(34);
    for (const NearPlane plane : near_planes) {
        int crossing = 0;
        for (int i = 0; i < 2000; ++i) {
            const ClipVertex a = camera_vertex(random, plane), b = camera_vertex(random, plane);
            if ((distance(a.position, plane) < 0) == (distance(b.position, plane) < 0)) continue;
            const Polygon left{a, b, camera_vertex(random, plane)};
            const Polygon right{b, a, camera_vertex(random, plane)};
            // The vertices on the edge a-b are those that both have, and both must have as many.
            const std::vector<Bits> one = bits(clipped(left, plane)), other = bits(clipped(right, plane));
            const auto shared = std::count_if(one.begin(), one.end(), [&other](const Bits& v) {
                return std::find(other.begin(), other.end(), v) != other.end();
            });
            const bool end_on_plane = distance(a.position, plane) == 0 || distance(b.position, plane) == 0;
            if (one.empty() || other.empty() || end_on_plane) continue;
            ++crossing;
            REQUIRE_MESSAGE(shared >= 2, hex_of(left), " and ", hex_of(right));
        }
        CHECK(crossing > 400);
    }
}

TEST_CASE("the triangles of a fan stay a fan: clipping the pieces is clipping the whole") {
    // A square that reaches through the near plane, as two triangles: the cut's vertex on the diagonal is common.
    const ClipVertex a{{-1, -1, 0.5f, 1}, {0, 0, 0, 1}}, b{{1, -1, 0.5f, 1}, {1, 0, 0, 1}};
    const ClipVertex c{{1, 1, -2, 1}, {1, 1, 0, 1}}, d{{-1, 1, -2, 1}, {0, 1, 0, 1}};
    const NearPlane plane = near_planes[0];
    const Polygon whole = clipped({a, b, c, d}, plane);
    REQUIRE(whole.size() == 4);
    CHECK(bits(whole) ==
          bits(Polygon{{{-1, 0.2f, -1, 1}, {0, 0.6f, 0, 1}}, a, b, {{1, 0.2f, -1, 1}, {1, 0.6f, 0, 1}}}));
    const std::vector<Bits> first = bits(clipped({a, b, c}, plane)), second = bits(clipped({c, d, a}, plane));
    const Bits diagonal = bits(ClipVertex{{0.2f, 0.2f, -1, 1}, {0.6f, 0.6f, 0, 1}});
    CHECK(std::find(first.begin(), first.end(), diagonal) != first.end());
    CHECK(std::find(second.begin(), second.end(), diagonal) != second.end());
}

TEST_CASE("fewer than three vertices have no area, and a polygon that zigzags through the plane is no polygon") {
    const ClipVertex in{{0, 0, 1, 1}, {0, 0, 0, 1}}, out{{0, 0, -2, 1}, {0, 0, 0, 1}};
    CHECK(clipped({}, near_planes[0]).empty());
    CHECK(clipped({in}, near_planes[0]).empty());
    CHECK(clipped({in, in}, near_planes[0]).empty());
    CHECK(clipped({in, out, in, out}, near_planes[0]).empty());
    CHECK(clipped({in, in, out, in, out, out}, near_planes[0]).empty());
}

TEST_CASE("a polygon may be clipped where it lies") {
    Random random(38);
    for (int i = 0; i < 200; ++i) {
        Polygon polygon;
        for (int k = 0; k < 3; ++k) polygon.push_back(camera_vertex(random, near_planes[0]));
        const Polygon apart = clipped(polygon, near_planes[0]);
        Polygon storage = polygon;
        storage.resize(4);
        const std::span<ClipVertex> all(storage);
        storage.resize(clip_to_near(all.first(3), all, near_planes[0].range));
        REQUIRE(bits(storage) == bits(apart));
    }
}

}  // namespace clip_cases
