// Clipping to the camera's near plane, and the way into the window, judged by exact rationals.

#include "texgen/clip.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "judges/oracle.hpp"
#include "support/polygons.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"

namespace {

using support::Bits;
using support::bits;
using support::exactly;
using support::hex;
using support::hex_of;
using support::infinity_float;
using support::nan_float;
using support::Polygon;
using support::Random;
using support::Rational;
using texgen::clip_to_near;
using texgen::ClipVertex;
using texgen::DepthRange;

struct NearPlane {
    DepthRange range;
    bool reversed;
};
constexpr std::array near_planes{NearPlane{DepthRange::negative_one_to_one, false},
                                 NearPlane{DepthRange::zero_to_one, false}, NearPlane{DepthRange::zero_to_one, true},
                                 NearPlane{DepthRange::negative_one_to_one, true}};

Rational distance(const glm::vec4& p, NearPlane plane) {
    if (plane.reversed) return exactly(p.w) - exactly(p.z);
    return plane.range == DepthRange::zero_to_one ? exactly(p.z) : Rational(exactly(p.z) + exactly(p.w));
}

// Whether a float is one rounding away from what is within `slack` of the exact value.
bool is_rounded(float value, const Rational& exact, const Rational& slack) {
    return support::magnitude(exactly(value) - exact) <=
           slack + support::power_of_two(support::ulp_exponent<float>(exact) - 1);
}

Polygon clipped(const Polygon& polygon, NearPlane plane) {
    Polygon out(polygon.size() + 1);
    out.resize(clip_to_near(polygon, out, plane.range, plane.reversed));
    return out;
}

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
            polygon[1].strq.y = infinity_float;
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
    for (const float bad : {nan_float, infinity_float, -infinity_float}) {
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

TEST_CASE("the window: corners of NDC are the viewport's corners, clip_w and the coordinates pass through") {
    const texgen::Viewport viewport{10, 20, 640, 480};
    const glm::vec4 strq(0.1f, 0.2f, 0.3f, 0.4f);
    const auto low = texgen::to_window({{-2, -2, 0, 2}, strq}, viewport);
    const auto high = texgen::to_window({{3, 3, 1, 3}, strq}, viewport);
    CHECK(low.window == glm::vec2(10.0f, 20.0f));
    CHECK(high.window == glm::vec2(650.0f, 500.0f));
    CHECK(low.clip_w == 2.0f);
    CHECK(low.strq == strq);
    CHECK(texgen::to_window({{0, 0, 0, 1}, strq}, viewport).window == glm::vec2(330.0f, 260.0f));
    // A negative height turns the picture over.
    CHECK(texgen::to_window({{1, 1, 0, 1}, strq}, {0, 480, 640, -480}).window == glm::vec2(640.0f, 0.0f));
}

TEST_CASE("the window is within its stated error of the exact division") {
    Random random(39);
    int cancelling = 0;
    for (int i = 0; i < 5000; ++i) {
        const double w = random.power_of_ten(-6.0, 6.0);
        const texgen::Viewport viewport{random.integer(-5000, 5000), random.integer(-5000, 5000),
                                        random.integer(1, 16384), random.integer(-16384, -1)};
        // Every other one next to the window's 0, where the ulp is small beside what is added.
        const auto clip_of = [&](double any, int first, int size) {
            return support::to_float(w * (i % 2 == 0 ? any : -(2.0 * first / size + 1.0)));
        };
        const ClipVertex v{
            {clip_of(random.uniform(-100.0, 100.0), viewport.x, viewport.width),
             clip_of(random.uniform(-1.0, 1.0), viewport.y, viewport.height), 0.0f, support::to_float(w)},
            {0, 0, 0, 1}};
        const auto computed = texgen::to_window(v, viewport);
        const auto check = [&v, &cancelling](float window, float clip, int first, int size) {
            const Rational half(size, 2);
            const Rational offset = half * exactly(clip) / exactly(v.position.w);
            const Rational exact = first + half + offset;
            cancelling += support::magnitude(exact) < support::magnitude(offset) * support::power_of_two(-22);
            const Rational slack =
                exactly(texgen::to_window_error) * (support::magnitude(first + half) + support::magnitude(offset));
            return is_rounded(window, exact, slack);
        };
        REQUIRE_MESSAGE(check(computed.window.x, v.position.x, viewport.x, viewport.width), hex(v.position));
        REQUIRE_MESSAGE(check(computed.window.y, v.position.y, viewport.y, viewport.height), hex(v.position));
    }
    CHECK(cancelling > 3000);
}
