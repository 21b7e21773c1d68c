// What is said of the points that are lit, and of the region: none of it hit, before or beyond its depth, or too small.

#include <doctest/doctest.h>

#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "api/diagnose_test/rigs.hpp"
#include "support/special_values.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/projector.hpp"
#include "texgen/texcoord.hpp"

namespace diagnose_cases {

TEST_CASE("a region without points or below a texel is said without any point") {
    const auto of_region = [](const TextureRegion& region) {
        return diagnose(ProjectionSetup<Object>{.region = region, .texels_per_unit = {256.0, 256.0}});
    };
    CHECK(of_region(texgen::whole_texture()).empty());
    CHECK(of_region(texgen::atlas_tile({0.5, 0.0}, {0.25, 1.0})).contains(Defect::region_never_hit));
    const Diagnosis small = of_region(texgen::atlas_tile({0.5, 0.0}, {0.501, 1.0}));
    REQUIRE(small.contains(Defect::smaller_than_texel));
    CHECK(small[0].number == doctest::Approx(0.256));
}

TEST_CASE("a fan whose vertices all miss the slide may be lit in its middle, and is not found fault with") {
    const glm::vec3 around[] = {{-9.0f, -9.0f, -2.0f}, {9.0f, -9.0f, -2.0f}, {9.0f, 9.0f, -2.0f}, {-9.0f, 9.0f, -2.0f}};
    const texgen::PerspectiveLens lens{.fovy = texgen::degrees(30), .aspect = 1, .z_near = 0.2, .z_far = 1000};
    const auto projector =
        make_projector(lens, {.position = {0, 0, 0}, .target = {0, 0, -1}, .up = {0, 1, 0}}, texgen::opengl);
    REQUIRE(projector);
    ProjectionSetup<World> setup{.projector = projector, .points = texgen::world_space(around)};
    CHECK(diagnose(setup).empty());
    setup.points = texgen::world_space(std::span(around).first(2));
    CHECK(diagnose(setup).contains(Defect::region_never_hit));
}

TEST_CASE("points on the side of the region are in it, and one point alone has no size") {
    // s = x, t = y, q = 1.
    const texgen::WorldTexgen texgen(glm::dmat4(1.0));
    const glm::vec3 on_side[] = {{1.0f, 0.1f, 0.0f}, {1.0f, 0.9f, 0.0f}};
    const glm::vec3 beyond[] = {{1.0001f, 0.1f, 0.0f}, {1.0001f, 0.9f, 0.0f}};
    const glm::vec3 same[] = {{0.3f, 0.1f, 0.0f}, {0.3f, 0.1f, 0.0f}};
    CHECK(diagnose(texgen, {.points = texgen::world_space(on_side)}).empty());
    CHECK(diagnose(texgen, {.points = texgen::world_space(beyond)}).contains(Defect::region_never_hit));
    CHECK(diagnose(texgen, {.points = texgen::world_space(same)}).empty());

    // q = x - y + 2^-60: in front where x = y, by less than the terms' rounding could take.
    glm::dmat4 close(1.0);
    close[0][3] = 1.0;
    close[1][3] = -1.0;
    close[3][3] = 0x1p-60;
    const glm::vec3 in_doubt[] = {{1.0f, 1.0f, 0.0f}, {3.0f, 3.0f, 1.0f}};
    const glm::vec3 behind[] = {{1.0f, 1.5f, 0.0f}, {3.0f, 3.5f, 1.0f}};
    CHECK_FALSE(diagnose(texgen::WorldTexgen(close), {.points = texgen::world_space(in_doubt)})
                    .contains(Defect::everything_behind));
    CHECK(diagnose(texgen::WorldTexgen(close), {.points = texgen::world_space(behind)})
              .contains(Defect::everything_behind));
}

TEST_CASE("points before and beyond the depth of the region are said, and one within it is enough") {
    const texgen::PerspectiveLens lens{.fovy = texgen::degrees(60), .aspect = 1, .z_near = 1, .z_far = 20};
    const texgen::Aim aim{.position = {0, 0, 0}, .target = {0, 0, -1}, .up = {0, 1, 0}};
    for (const texgen::Conventions conventions : {texgen::opengl, texgen::direct3d}) {
        for (const auto mapping : {texgen::DepthMapping::unit, texgen::DepthMapping::ndc}) {
            const TextureRegion region = texgen::whole_texture().with_depth(conventions, mapping);
            const auto at = [&](std::vector<glm::vec3> points, const TextureRegion& seen) {
                return diagnose(ProjectionSetup<World>{.projector = make_projector(lens, aim, conventions),
                                                       .points = texgen::world_space(points),
                                                       .region = seen,
                                                       .depth = mapping});
            };
            const auto beyond = at({{0, 0, -21}, {1, 0, -500}}, region);
            REQUIRE_MESSAGE(beyond.size() == 1, text(beyond));
            CHECK(beyond.contains(Defect::everything_above_depth));
            const auto before = at({{0, 0, -0.9f}, {0.1f, 0, -0.5f}}, region);
            REQUIRE_MESSAGE(before.size() == 1, text(before));
            CHECK(before.contains(Defect::everything_below_depth));
            CHECK(at({{0, 0, -0.9f}, {1, 0, -500}}, region).empty());
            CHECK(at({{0, 0, -21}, {1, 0, -19}}, region).empty());
            CHECK(at({{0, 0, -21}, {1, 0, -500}}, texgen::whole_texture()).empty());
            CHECK(at({{0, 0, -21}, {1, 0, -500}}, texgen::whole_texture().with_depth(0.0, HUGE_VAL)).empty());
            const auto behind = at({{0, 0, 21}, {1, 0, 500}}, region);
            CHECK(behind.contains(Defect::everything_behind));
            CHECK_FALSE(behind.contains(Defect::everything_above_depth));
            CHECK_FALSE(behind.contains(Defect::everything_below_depth));
        }
    }
    const auto of_region = [](const TextureRegion& region) {
        return diagnose(ProjectionSetup<Object>{.region = region});
    };
    CHECK(of_region(texgen::whole_texture().with_depth(0.5, 0.25)).contains(Defect::region_never_hit));
    CHECK(of_region(texgen::whole_texture().with_depth(support::nan_double, 1.0)).contains(Defect::not_finite));
    CHECK(of_region(texgen::whole_texture().with_depth(0.0, HUGE_VAL)).empty());
}

TEST_CASE("points of one ray are smaller than a texel, unless one is behind, and where all are they are in no depth") {
    const texgen::Aim along_z{{0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}};
    for (const Conventions& conventions : {texgen::opengl, texgen::direct3d, left_handed(texgen::vulkan)}) {
        for (const bool is_reversed : {false, true}) {
            const texgen::PerspectiveLens lens{texgen::degrees(40.0), 1.5, 0.5, 100.0, is_reversed};
            Parts parts{.projector = make_projector(lens, along_z, conventions), .in = In::world, .has_points = true};
            const auto place = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c) { parts.points = {a, b, c, a, b, c, a, b}; };
            place({0, 0, -8}, {0, 0, 8}, {0, 0, -8});
            require_said(parts, {});
            place({0, 0, -8}, {0, 0, -9}, {3, 1, 8});
            require_said(parts, {});
            place({0, 0, -8}, {0, 0, -9}, {0, 1e-5f, -8});
            const double size = diagnosis_of(parts)[0].number;
            CHECK(size > 0.0);
            // The texture's size is known where both of its sides are.
            for (const double other : {0.0, -256.0}) {
                for (const glm::dvec2& texels : {glm::dvec2(256.0, other), {other, 256.0}, {other, other}}) {
                    parts.texels_per_unit = texels;
                    require_said(parts, {Defect::smaller_than_texel});
                    CHECK(diagnosis_of(parts)[0].number == size);
                }
            }
            for (const glm::dvec2& corner : {glm::dvec2(1.0, 0.0), {0.0, 1.0}}) {
                const TextureRegion empty = texgen::atlas_tile(corner, glm::dvec2(1.0) - corner);
                require_said({.in = In::world, .region = empty, .texels_per_unit = {256.0, 256.0}},
                             {Defect::region_never_hit});
                parts.texels_per_unit = {0.0, 0.0}, parts.region = empty;
                require_said(parts, {Defect::region_never_hit});
            }
            place({0, 0, 8}, {1, 0, 8}, {0, 2, 9});
            parts.region = texgen::whole_texture().with_depth(0.0, 1.0);
            require_said(parts, {Defect::everything_behind, Defect::region_never_hit});
            parts.projector = std::nullopt;
            require_said(parts, {});
        }
    }
}

}  // namespace diagnose_cases
