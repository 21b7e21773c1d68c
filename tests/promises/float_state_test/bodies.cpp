// Bodies, scenes and clips, with subnormal numbers taken as 0.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "judges/oracle.hpp"
#include "promises/float_state_test/inputs.hpp"
#include "support/float_state.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "texgen/clip.hpp"
#include "texgen/coverage.hpp"
#include "texgen/projector.hpp"
#include "texgen/scene.hpp"
#include "texgen/texcoord.hpp"

namespace float_state {

using texgen::Box;

TEST_CASE("what is cut next to the eye or q = 0 is in front") {
    const std::array<texgen::ClipVertex, 3> by_eye{{{{0.0f, 0.0f, 1.0f, 0x1p-110f}, {0.0f, 0.0f, 0.0f, 1.0f}},
                                                    {{1.0f, 0.0f, 1.0f, -1.0f}, {1.0f, 0.0f, 0.0f, 1.0f}},
                                                    {{0.0f, 1.0f, 1.0f, -1.0f}, {0.0f, 1.0f, 0.0f, 1.0f}}}};
    const std::array<texgen::ClipVertex, 3> by_q{{{{0.0f, 0.0f, 1.0f, 1.0f}, {0.0f, 0.0f, 0.0f, 0.0f}},
                                                  {{1.0f, 0.0f, 1.0f, 1.0f}, {0.0f, 0.0f, 0.0f, 0x1p-110f}},
                                                  {{0.0f, 1.0f, 1.0f, 1.0f}, {0x1p-111f, 0x1p-111f, 0.0f, 0x1p-110f}}}};
    in_every_state([&](const FloatState& state, Random&) {
        std::array<texgen::ClipVertex, 10> out{};
        std::size_t count = 0;
        under(state, [&] { count = clip_to_near(by_eye, out, texgen::DepthRange::zero_to_one); });
        CHECK(count >= 3);
        for (std::size_t i = 0; i < count; ++i) CHECK(as_read(out[i].position.w, state) > 0.0f);
        under(state, [&] { count = clip_to_slide(by_q, texgen::whole_texture(), out); });
        CHECK(count >= 3);
        for (std::size_t i = 0; i < count; ++i) CHECK(as_read(out[i].strq.w, state) > 0.0f);
    });
}

TEST_CASE("coverage and scenes answer as in the default state, or leave it open") {
    in_every_state([](const FloatState& state, Random& random) {
        int decided = 0, open = 0, touching = 0;
        for (int i = 0; i < 400; ++i) {
            // Small integers, so that planes are touched exactly; or any numbers.
            glm::dmat4 matrix(0.0);
            const bool is_small = random.coin();
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 4; ++row)
                    matrix[column][row] =
                        is_small ? random.integer(-2, 2) * (1.0 + 0x1p-50) : random.uniform(-1.0, 1.0);
            const TextureRegion region =
                is_small ? texgen::atlas_tile({0.0, -1.0}, {1.0, 2.0}) : texgen::atlas_tile({0.1, 0.2}, {0.9, 0.7});
            std::vector<Box> boxes(40);
            for (Box& box : boxes) {
                for (int j = 0; j < 3; ++j) {
                    const float a =
                        is_small ? static_cast<float>(random.integer(-3, 3)) : random.uniform_float(-3.0, 3.0);
                    const float b =
                        is_small ? static_cast<float>(random.integer(-3, 3)) : random.uniform_float(-3.0, 3.0);
                    box.min[j] = std::min(a, b);
                    box.max[j] = std::max(a, b);
                    if (random.integer(0, 9) == 0) box.max[j] = box.min[j];
                    if (random.integer(0, 29) == 0) box.min[j] = box.max[j] = 0x1p-140f;
                }
            }
            std::vector<Box> read = boxes;
            for (Box& box : read) box = {as_read(box.min, state), as_read(box.max, state)};
            const ObjectTexgen texgen(matrix);
            std::vector<Coverage> expected(boxes.size()), answers(boxes.size()), alone(boxes.size());
            coverage(texgen, region, read, expected);
            under(state, [&] {
                coverage(texgen, region, boxes, answers);
                for (std::size_t k = 0; k < boxes.size(); ++k) alone[k] = coverage(texgen, region, boxes[k]);
            });
            for (std::size_t k = 0; k < boxes.size(); ++k) {
                CHECK(alone[k] == answers[k]);
                ++(answers[k] == Coverage::partial ? open : decided);
                touching += is_small;
                const bool is_same = answers[k] == expected[k] || answers[k] == Coverage::partial;
                REQUIRE_MESSAGE(is_same, static_cast<int>(answers[k]), " for ", static_cast<int>(expected[k]), ": box ",
                                hex(boxes[k].min), hex(boxes[k].max), " by ", hex(matrix));
            }
        }
        CHECK(decided > 5000);
        CHECK(open > 1000);
        CHECK(touching > 1000);
    });
}

TEST_CASE("what is outside is not lit, and what is inside is, in every state") {
    in_every_state([](const FloatState& state, Random& random) {
        int outside = 0, inside = 0, lit_beside = 0;
        for (int i = 0; i < 5000; ++i) {
            const double side = random.coin() ? random.uniform(-2.0, 2.0) : random.integer(-1, 1);
            const bool is_min = random.coin();
            const TextureRegion region =
                is_min ? texgen::atlas_tile({side, 0.0}, {4.0, 1.0}) : texgen::atlas_tile({-4.0, 0.0}, {side, 1.0});
            // s = x + offset, about a float of the side.
            const glm::vec3 point(support::neighbour(support::to_float(side), random.integer(-1, 1)), 0.0f, 0.0f);
            glm::dmat4 matrix(0.0);
            matrix[0][0] = 1.0;
            matrix[3] = {random.uniform(-1.5, 1.5) * 0x1p-23 * std::fabs(side), 0.5, 0.0, 1.0};
            const ObjectTexgen texgen(matrix);
            Outputs out(1);
            Coverage answer = Coverage::partial;
            under(state, [&] {
                project(texgen, texgen::object_space(std::span(&point, 1)), region, out.spans());
                answer = coverage(texgen, region, Box{point, point});
            });
            const double s = static_cast<double>(point.x) + matrix[3][0];
            const bool is_lit = out.lit()[0] == 1.0f;
            lit_beside += is_lit && (is_min ? s < side : s > side);
            outside += answer == Coverage::outside;
            inside += answer == Coverage::inside;
            if (answer != Coverage::partial)
                REQUIRE_MESSAGE(is_lit == (answer == Coverage::inside), hex(point), hex(matrix), hex(side));
        }
        CHECK(outside > 300);
        CHECK(inside > 300);
        CHECK(lit_beside > 100);
    });
}

TEST_CASE("a scene has the pairs that it has in the default state") {
    in_every_state([](const FloatState& state, Random& random) {
        std::size_t pairs = 0;
        for (int i = 0; i < 20; ++i) {
            std::vector<texgen::ModelMatrix> models;
            std::vector<Box> bounds;
            for (int k = 0; k < 60; ++k) {
                models.emplace_back(random.rigid(8.0));
                const glm::vec3 a = random.vector3(1.0), b = random.vector3(1.0);
                bounds.push_back({glm::min(a, b), glm::max(a, b)});
            }
            std::vector<texgen::Projector> projectors;
            while (projectors.size() < 4) {
                const auto projector = texgen::make_projector(
                    texgen::PerspectiveLens{.fovy = texgen::degrees(40), .aspect = 1, .z_near = 0.1, .z_far = 100},
                    {.position = 8.0 * random.direction(), .target = {0, 0, 0}, .up = random.direction()},
                    texgen::opengl);
                if (projector) projectors.push_back(*projector);
            }
            const texgen::SceneView view{models, bounds, projectors};
            texgen::Scene scene, expected;
            expected.update(view, {});
            under(state, [&] { scene.update(view, {}); });
            const auto is_same = [](const texgen::LitPair& a, const texgen::LitPair& b) {
                return a.object == b.object && a.projector == b.projector && a.coverage == b.coverage;
            };
            CHECK(std::ranges::equal(scene.pairs(), expected.pairs(), is_same));
            pairs += expected.pairs().size();
        }
        CHECK(pairs > 500);
    });
}

TEST_CASE("what a clip to the slide leaves is inside but for slide_clip_error, and what it drops is outside") {
    in_every_state([](const FloatState& state, Random& random) {
        int cut = 0, dropped = 0, whole = 0;
        for (int i = 0; i < 3000; ++i) {
            std::array<texgen::ClipVertex, 3> polygon{};
            const bool is_small = random.coin();
            for (texgen::ClipVertex& vertex : polygon) {
                vertex.position = random.vector4(1.0);
                vertex.strq = is_small ? glm::vec4(static_cast<float>(random.integer(-2, 2)),
                                                   static_cast<float>(random.integer(-2, 2)), 0.0f,
                                                   static_cast<float>(random.integer(-1, 2)))
                                       : random.vector4(2.0);
            }
            const TextureRegion region = texgen::atlas_tile({0.0, 0.25}, {1.0, 0.7});
            std::array<texgen::ClipVertex, 8> expected{}, out{};
            const std::size_t expected_count = clip_to_slide(polygon, region, expected);
            std::size_t count = 0;
            under(state, [&] { count = clip_to_slide(polygon, region, out); });
            ++(count == 0 ? dropped : count == 3 ? whole : cut);
            CHECK(count == expected_count);
            for (std::size_t k = 0; k < count; ++k) {
                const glm::dvec4 v(out[k].strq);
                REQUIRE_MESSAGE(v.w > 0.0, hex(polygon[0].strq), hex(polygon[1].strq), hex(polygon[2].strq));
                for (int c = 0; c < 2; ++c) {
                    const double slack = texgen::slide_clip_error * region.max()[c] * v.w;
                    REQUIRE(v[c] - region.min()[c] * v.w >= -slack);
                    REQUIRE(region.max()[c] * v.w - v[c] >= -slack);
                }
            }
            // A vertex strictly inside is never dropped.
            for (const texgen::ClipVertex& vertex : polygon) {
                const glm::dvec4 v(vertex.strq);
                const bool is_inside = v.w > 0.0 && v.x > 0.0 && v.x < v.w && v.y > 0.25 * v.w && v.y < 0.69 * v.w;
                if (is_inside && expected_count != 0) REQUIRE(count != 0);
            }
        }
        CHECK(cut > 100);
        CHECK(dropped > 100);
        CHECK(whole > 0);
    });
}

}  // namespace float_state
