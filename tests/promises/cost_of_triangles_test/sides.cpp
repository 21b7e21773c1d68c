// What masks cost, and coordinates next to the sides of their region.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "judges/fragments.hpp"
#include "promises/cost_of_triangles_test/ordinary.hpp"
#include "support/hex.hpp"
#include "support/shot.hpp"
#include "support/stopwatch.hpp"
#include "texgen/batch.hpp"
#include "texgen/interpolate.hpp"

namespace triangle_costs {

namespace {

// t is 0 along the upper edge, s along the left one: as of a quadrilateral of a user interface, or of a chart of a
// lightmap, whose corners are centres of fragments.
Triangle with_edges_at(float x, float y) {
    return {vertex(x, y, 1.0f, 0.0f, 0.0f, 1.25f), vertex(x + 600.0f, y, 2.0f, 1.5f, 0.0f, 2.0f),
            vertex(x, y + 512.0f, 1.5f, 0.0f, 1.0f, 1.5f)};
}

}  // namespace

TEST_CASE("fragments on an edge along which a coordinate is 0 cost at most 8 times the ordinary ones, 20 in a column") {
    for (const Tolerance tolerance : tolerances) {
        for (const glm::ivec2 size : {glm::ivec2{1, 1}, {8, 1}, {1, 8}, {8, 8}, {64, 1}, {1, 64}, {64, 4}, {512, 1}}) {
            std::vector<float> s(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y)), t(s.size());
            const auto call = [&](const Triangle& triangle, FragmentRect rect, bool is_mask) {
                return [&, rect, is_mask, setup = support::setup_of(triangle, texgen::whole_texture(), tolerance)] {
                    if (is_mask)
                        interpolate(setup, rect, {{}, {}, {}, s});
                    else
                        interpolate(setup, rect, {s, t});
                };
            };
            for (const bool is_mask : {false, true}) {
                if (is_mask && size.y > 8) continue;  // each row has a span
                const double most = is_mask ? 16.0 * masks_by_vectors : size.x == 1 && size.y > 1 ? 20.0 : 8.0;
                const auto ratio = [&](float x, float y, FragmentRect rect) {
                    return support::worst_over_ordinary_within(most, call(with_edges_at(90.3f, 190.3f), rect, is_mask),
                                                               call(with_edges_at(x, y), rect, is_mask));
                };
                INFO(size.x, " x ", size.y, ", tolerance ", tolerance.value, std::string(is_mask ? ", mask" : ""));
                CHECK(ratio(90.3f, 200.5f, {140, 200, size.x, size.y}) <= most);
                CHECK(ratio(100.5f, 190.3f, {100, 240, size.x, size.y}) <= most);
            }
        }
    }
}

TEST_CASE("tiles of a batch on such edges cost at most 8 times the ordinary ones, and their masks alone 32 times") {
    for (const glm::ivec2 size : {glm::ivec2{8, 8}, {64, 1}, {1, 64}, {64, 4}, {16, 16}}) {
        const std::vector<FragmentRect> rects(8, {100, 200, size.x, size.y});
        std::vector<float> s(8 * support::count_of(rects[0])), t(s.size());
        for (const bool is_mask : {false, true}) {
            const auto call = [&](float x, float y) {
                texgen::TriangleBatch batch(texgen::whole_texture());
                batch.assign(std::vector<Triangle>(8, with_edges_at(x, y)));
                return [&, is_mask, batch] {
                    interpolate(batch, rects, is_mask ? texgen::Texcoords{{}, {}, {}, s} : texgen::Texcoords{s, t});
                };
            };
            const double most = is_mask ? 32.0 * masks_by_vectors : 8.0;
            for (const auto& [x, y] : {std::pair{90.3f, 200.5f}, {100.5f, 190.3f}, {100.5f, 200.5f}}) {
                const double ratio = support::worst_over_ordinary_within(most, call(90.3f, 190.3f), call(x, y));
                CHECK_MESSAGE(ratio <= most, size.x, " x ", size.y, std::string(is_mask ? ", mask: " : ": "), ratio,
                              " times");
            }
        }
    }
}

TEST_CASE(
    "a small tile takes little more where a coordinate has one side or none, or sides far away, than in a texture") {
    constexpr double most = 1.5;
    std::vector<float> s(64), t(64), lit(64);
    for (const Tolerance tolerance : tolerances) {
        const Triangle triangle = ordinary(1, 1).triangle;
        const texgen::TriangleSetup both = support::setup_of(triangle, texgen::whole_texture(), tolerance);
        for (const glm::dvec3 ends : {glm::dvec3{0.0, 0.0, HUGE_VAL},
                                      {-HUGE_VAL, -HUGE_VAL, HUGE_VAL},
                                      {-HUGE_VAL, 0.0, HUGE_VAL},
                                      {0.0, 0.0, 1e30}}) {
            const texgen::TriangleSetup open =
                support::setup_of(triangle, texgen::atlas_tile(glm::dvec2(ends), glm::dvec2(ends.z)), tolerance);
            for (const int width : {1, 8}) {
                const FragmentRect rect{300, 100, width, width};
                const auto part = [&](std::vector<float>& all) {
                    return std::span(all).first(support::count_of(rect));
                };
                const texgen::Texcoords out{part(s), part(t), {}, part(lit)};
                REQUIRE(both.work(rect) == texgen::Work::divide);
                REQUIRE(open.work(rect) == texgen::Work::divide);
                const double ratio = support::worst_over_ordinary_within(
                    most, [&] { interpolate(both, rect, out); }, [&] { interpolate(open, rect, out); });
                INFO(width, " x ", width, ", tolerance ", tolerance.value, ", from ", ends.x, ", ", ends.y, " to ",
                     ends.z);
                CHECK(ratio <= most);
            }
        }
    }
}

namespace {

// Ordinary triangles of which a side of the region crosses a tile next to its middle.
std::array<Shot, 3> crossed(const glm::ivec2& size) {
    const glm::vec2 middle(300.3f + 0.5f * static_cast<float>(size.x), 100.2f + 0.5f * static_cast<float>(size.y));
    const auto with = [&](glm::length_t coordinate, float side, const glm::vec2& slope) {
        Shot shot = ordinary(size.x, size.y);
        for (WindowVertex* corner : support::vertices(shot.triangle))
            corner->strq[coordinate] =
                side * corner->strq.w + glm::dot(corner->window - middle, slope) / 1000.0f * corner->clip_w;
        return shot;
    };
    return {with(0, 0.0f, {1.0f, 0.3f}), with(1, 0.0f, {-0.2f, 0.8f}), with(1, 1.0f, {0.7f, -0.7f})};
}

// Those that lie on a side.
std::array<Shot, 2> on_sides(const glm::ivec2& size) {
    Shot left = ordinary(size.x, size.y), corner = left;
    for (WindowVertex* vertex : support::vertices(left.triangle)) vertex->strq.x = 0.0f;
    for (WindowVertex* vertex : support::vertices(corner.triangle)) vertex->strq.x = vertex->strq.y = vertex->strq.w;
    return {left, corner};
}

}  // namespace

TEST_CASE(
    "a mask alone costs at most 8 times one that is lit at once where a side crosses the tile, 10 of 8 x 8 and of 32 x "
    "32, and 12 where it is its plane") {
    for (const glm::ivec2 size : {glm::ivec2{8, 8}, {64, 4}, {32, 32}, {256, 16}, {1024, 4}}) {
        std::vector<float> lit(support::count_of(ordinary(size.x, size.y).rect));
        for (const Tolerance tolerance : {texgen::exact, texgen::texels(1.0 / 16.0, 1024.0)}) {
            const auto call = [&](const Shot& shot) {
                return [&lit, setup = support::setup_of(shot.triangle, texgen::whole_texture(), tolerance),
                        rect = shot.rect] {
                    interpolate(setup, rect, {{}, {}, {}, lit});
                };
            };
            const auto require = [&](const Shot& shot, double most) {
                most *= masks_by_vectors;
                const double ratio =
                    support::worst_over_ordinary_within(most, call(ordinary(size.x, size.y)), call(shot));
                REQUIRE_MESSAGE(ratio <= most, size.x, " x ", size.y, ", tolerance ", tolerance.value, ": ", ratio,
                                " times in ", hex(shot));
            };
            for (const Shot& shot : crossed(size)) require(shot, size.x < 64 ? 10.0 : 8.0);
            for (const Shot& shot : on_sides(size)) require(shot, 12.0);
        }
    }
}

TEST_CASE(
    "where a side crosses a tile less output takes no longer than more, nor a tolerance longer than exact values") {
    constexpr double most = 3.0;
    for (const glm::ivec2 size : {glm::ivec2{1, 1}, {4, 4}, {8, 8}, {16, 16}, {64, 4}, {32, 32}}) {
        std::vector<float> s(support::count_of(ordinary(size.x, size.y).rect)), t(s.size()), lit(s.size());
        const texgen::Texcoords both{s, t, {}, lit};
        const texgen::Texcoords asked[] = {{s, {}, {}, lit}, {{}, t, {}, lit}, {{}, {}, {}, lit}, both};
        for (const Shot& shot : crossed(size)) {
            for (const Tolerance tolerance : {texgen::exact, tolerances[1], texgen::texels(1.0, 512.0)}) {
                const auto call = [&](Tolerance accepted, const texgen::Texcoords& out) {
                    return [&out, setup = support::setup_of(shot.triangle, texgen::whole_texture(), accepted),
                            rect = shot.rect] { interpolate(setup, rect, out); };
                };
                for (const texgen::Texcoords& out : asked) {
                    const double over_both =
                        support::worst_over_ordinary_within(most, call(tolerance, both), call(tolerance, out));
                    const double over_exact =
                        support::worst_over_ordinary_within(most, call(texgen::exact, out), call(tolerance, out));
                    INFO(size.x, " x ", size.y, ", tolerance ", tolerance.value, ", output ", &out - asked, " of ",
                         hex(shot));
                    CHECK(over_both <= most);
                    CHECK(over_exact <= most);
                }
            }
        }
    }
}

TEST_CASE("masks of a batch that are lit at once take less than s and t do, the less the larger the tiles are") {
    constexpr std::size_t count = 64;
    constexpr double most_of[3][2] = {{0.75, 0.9}, {0.6, 0.6}, {0.4, 0.5}};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 2; ++j) {
            const int size = 8 << i;
            const double most = most_of[i][j];
            const Tolerance tolerance = tolerances[j];
            const Shot shot = ordinary(size, size);
            texgen::TriangleBatch batch(texgen::atlas_tile({-HUGE_VAL, 0.0}, {HUGE_VAL, 1.0}), tolerance);
            batch.assign(std::vector<Triangle>(count, shot.triangle));
            const std::vector<FragmentRect> rects(count, shot.rect);
            std::vector<float> s(count * support::count_of(shot.rect)), t(s.size()), lit(s.size());
            const double ratio = support::worst_over_ordinary_within(
                most,
                [&] {
                    interpolate(batch, rects, {s, t, {}, {}});
                },
                [&] {
                    interpolate(batch, rects, {{}, {}, {}, lit});
                });
            REQUIRE_MESSAGE(ratio <= most, size, ", tolerance ", tolerance.value, ": ", ratio);
            REQUIRE(std::count(lit.begin(), lit.end(), 1.0f) == static_cast<std::ptrdiff_t>(lit.size()));
        }
    }
}

}  // namespace triangle_costs
