// The README's deferred light.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "api/shaders_test/comparison.hpp"
#include "api/shaders_test/readme.hpp"
#include "api/shaders_test/scenes.hpp"
#include "api/shaders_test/textures.hpp"
#include "support/opengl.hpp"
#include "support/random.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/texcoord.hpp"

namespace shaded {

namespace {

// A floor that a camera has drawn into a depth buffer, and a projector that it reaches behind.
struct DeferredScene {
    texgen::WindowTexgen texgen;
    texgen::TextureRegion region;
    std::vector<glm::vec4> texels;  // the depth, and two numbers that no other texel has
};

DeferredScene deferred_scene(Random& random) {
    const texgen::Conventions reversed{texgen::DepthRange::zero_to_one, texgen::NdcY::up,
                                       texgen::TextureOrigin::bottom_left, texgen::Handedness::right};
    const auto camera =
        texgen::make_projector(
            texgen::PerspectiveLens{
                .fovy = texgen::degrees(50.0), .aspect = 1.0, .z_near = 0.5, .z_far = HUGE_VAL, .reversed_depth = true},
            texgen::Aim{.position = {random.uniform(-3.0, 3.0), random.uniform(1.0, 8.0), 12.0},
                        .target = {random.uniform(-1.0, 1.0), -2.0, 0.0},
                        .up = {random.uniform(-1.0, 1.0), 1.0, 0.0}},
            reversed)
            .value();
    const auto projector = projector_at({0.0, 0.0, -15.0}, {random.uniform(-1.0, 1.0), -3.0, 0.0}).value();
    const texgen::Viewport viewport{0, 0, width, height};
    const texgen::TextureRegion region =
        random.coin() ? texgen::whole_texture() : texgen::atlas_tile({0.25, 0.125}, {0.75, 0.875});
    DeferredScene scene{texgen::window_linear(projector, camera, viewport, region).value(), region, {}};
    const glm::dmat4 world_from_clip = inverse(camera.matrix()).value().matrix();
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            // The floor is y = -4; beside it is nothing.
            const glm::dvec4 near =
                world_from_clip * glm::dvec4((x + 0.5) / 128.0 - 1.0, (y + 0.5) / 128.0 - 1.0, 1.0, 1.0);
            const glm::dvec4 slope = world_from_clip[2];
            const double down = (near.y + 4.0 * near.w) / (slope.y + 4.0 * slope.w);
            const double depth = 1.0 - down;
            scene.texels.emplace_back(depth > 0.0 && depth < 1.0 ? support::to_float(depth) : 0.0f,
                                      static_cast<float>(x + 1) / 512.0f, static_cast<float>(y + 1) / 512.0f, 1.0f);
        }
    }
    return scene;
}

Comparison deferred_comparison(const gl::Context& g, const std::string& source) {
    const unsigned program = g.program(shaders()[vertex].c_str(), source.c_str());
    INFO(gl::Context::reason());
    REQUIRE(program != 0);
    g.UseProgram(program);
    const auto at = [&](const char* name) { return g.GetUniformLocation(program, name); };
    Random random(206);
    Comparison result;
    for (int i = 0; i < 8; ++i) {
        const DeferredScene scene = deferred_scene(random);
        bind_new_texture(g, gl::nearest);  // as both the depth and the slide
        g.TexImage2D(gl::texture_2d, 0, static_cast<int>(gl::rgba32f), width, height, 0, gl::rgba, gl::float_type,
                     scene.texels.data());
        const glm::mat4 identity(1.0f), texture_from_window = scene.texgen.rounded();
        const glm::vec4 region(scene.region.min(), scene.region.max());
        g.UniformMatrix4fv(at("clip_from_object"), 1, 0, &identity[0][0]);
        g.UniformMatrix4fv(at("texture_from_window"), 1, 0, &texture_from_window[0][0]);
        g.Uniform4fv(at("region"), 1, &region[0]);
        g.Uniform3fv(at("border"), 1, &border[0]);
        g.clear(glm::vec4(nothing));
        g.Begin(gl::triangles);
        for (const glm::vec3& corner : {glm::vec3(-1, -1, 0), glm::vec3(3, -1, 0), glm::vec3(-1, 3, 0)})
            g.Vertex3fv(&corner[0]);
        g.End();
        REQUIRE(g.GetError() == gl::no_error);
        const std::vector<glm::vec4> pixels = g.pixels();

        std::vector<glm::vec3> fragments;
        for (std::size_t k = 0; k < pixel_count; ++k)
            fragments.emplace_back(static_cast<float>(k % width) + 0.5f, static_cast<float>(k / width) + 0.5f,
                                   scene.texels[k].x);
        std::vector<float> s(pixel_count), t(pixel_count), lit(pixel_count);
        texgen::project(scene.texgen, texgen::window_space(fragments), scene.region, {s, t, {}, lit});
        const glm::dmat4& m = scene.texgen.matrix();
        for (std::size_t k = 0; k < pixel_count; ++k) {
            const glm::dvec4 v(fragments[k], 1.0), strq = m * v;
            const auto terms = [&](int row) {
                double sum = 0.0;
                for (int j = 0; j < 4; ++j) sum += std::fabs(m[j][row] * v[j]);
                return sum;
            };
            constexpr double tolerance = 8.0 * 0x1p-24;
            if (2.0 * tolerance * terms(3) > std::fabs(strq.w)) continue;
            const bool is_lit = lit[k] != 0.0f;
            glm::dvec2 allowed;
            bool near_side = false;
            for (int c = 0; c < 2; ++c) {
                const double u = strq[c] / strq.w;
                allowed[c] = tolerance * (terms(c) + std::fabs(u) * terms(3)) / std::fabs(strq.w);
                for (const double side : {scene.region.min()[c], scene.region.max()[c]})
                    near_side = near_side || std::fabs(u - side) <= allowed[c];
            }
            glm::vec3 expected = border;
            if (is_lit) {
                const auto texel_of = [&](double u, double error) -> std::optional<int> {
                    const double low = std::floor((u - error) * width), high = std::floor((u + error) * width);
                    return low == high ? std::optional(std::clamp(static_cast<int>(low), 0, width - 1)) : std::nullopt;
                };
                const auto column = texel_of(s[k], allowed.x), row = texel_of(t[k], allowed.y);
                if (!column || !row) continue;
                expected = glm::vec3(scene.texels[static_cast<std::size_t>(*row * width + *column)]);
            }
            if (near_side) continue;
            ++result.compared;
            result.lit += is_lit;
            result.behind += strq.w < 0.0;
            result.wrong += glm::vec3(pixels[k]) != expected;
        }
    }
    return result;
}

TEST_CASE("the README's deferred light shows what the library computes for the fragments of the depth buffer") {
    const gl::Context& g = gl::Context::or_skip();
    const Comparison right = deferred_comparison(g, shaders()[deferred]);
    MESSAGE(right.compared, " fragments, ", right.lit, " lit, ", right.behind, " behind");
    CHECK(right.wrong == 0);
    CHECK(right.compared > 300000);
    CHECK(right.lit > 10000);
    CHECK(right.behind > 10000);
    for (const Change& change :
         {Change{"vec4(gl_FragCoord.xy", "vec4(gl_FragCoord.yx"},
          Change{"ivec2(gl_FragCoord.xy)", "ivec2(gl_FragCoord.yx)"}, Change{".r, 1.0)", ".r, 0.0)"},
          Change{"strq.q > 0.0 &&", ""}, Change{"strq.st / strq.q", "strq.st"},
          Change{"&& st == clamp(st, region.xy, region.zw)", ""}, Change{": border", ": vec3(0.0)"}}) {
        INFO("with ", change.to);
        CHECK(deferred_comparison(g, changed(shaders()[deferred], change)).wrong > 500);
    }
}

}  // namespace

}  // namespace shaded
