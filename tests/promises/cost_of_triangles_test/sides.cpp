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

TEST_CASE(
    "a mask alone costs at most 12 times one that is lit at once where a side crosses the tile or is its plane, 8 of a "
    "large one, and up to 4 more with a tolerance") {
    const auto shot_with = [](int width, int height, const auto& change) {
        Shot shot = ordinary(width, height);
        for (WindowVertex* corner : support::vertices(shot.triangle)) change(*corner);
        return shot;
    };
    for (const glm::ivec2 size : {glm::ivec2{8, 8}, {64, 4}, {256, 16}, {1024, 4}}) {
        const glm::vec2 middle(300.0f + 0.5f * static_cast<float>(size.x), 100.0f + 0.5f * static_cast<float>(size.y));
        const auto along = [&](const WindowVertex& corner, glm::vec2 slope) {
            return glm::dot(corner.window - middle, slope) / 1000.0f * corner.clip_w;
        };
        const Shot shots[] = {
            shot_with(size.x, size.y,
                      [&](WindowVertex& c) {
                          c.strq.x = along(c, {1.0f, 0.3f});
                      }),
            shot_with(size.x, size.y,
                      [&](WindowVertex& c) {
                          c.strq.y = along(c, {-0.2f, 0.8f});
                      }),
            shot_with(size.x, size.y,
                      [&](WindowVertex& c) {
                          c.strq.y = c.strq.w + along(c, {0.7f, -0.7f});
                      }),
            shot_with(size.x, size.y, [&](WindowVertex& c) { c.strq.x = 0.0f; }),
            shot_with(size.x, size.y, [&](WindowVertex& c) { c.strq.x = c.strq.y = c.strq.w; }),
        };
        std::vector<float> lit(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
        for (const Tolerance tolerance : {texgen::exact, texgen::texels(1.0 / 16.0, 1024.0)}) {
            // Spans of few fragments, of which some columns are asked for where a side follows a diagonal; and planes of
            // a side, beside which floats within a tolerance may be.
            const double of_exact = size.x == 8 ? 12.0 : size.x == 64 ? 10.0 : 8.0;
            const double most = (tolerance.value > 0.0 ? (size.x == 8 ? 16.0 : 12.0) : of_exact) * masks_by_vectors;
            const auto call = [&](const Shot& shot) {
                return [&lit, setup = support::setup_of(shot.triangle, texgen::whole_texture(), tolerance),
                        rect = shot.rect] {
                    interpolate(setup, rect, {{}, {}, {}, lit});
                };
            };
            for (const Shot& shot : shots) {
                const double ratio =
                    support::worst_over_ordinary_within(most, call(ordinary(size.x, size.y)), call(shot));
                REQUIRE_MESSAGE(ratio <= most, size.x, " x ", size.y, ", tolerance ", tolerance.value, ": ", ratio,
                                " times in ", hex(shot));
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
