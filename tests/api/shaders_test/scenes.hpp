#pragma once

// What the shaders draw: a triangle of an object, on which a slide falls.

#include <doctest/doctest.h>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "support/opengl.hpp"
#include "support/random.hpp"
#include "texgen/clip.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/texcoord.hpp"

namespace shaded {

namespace gl = support::gl;
using support::Random;

inline constexpr float nothing = -1e30f;
inline constexpr int width = gl::Context::width, height = gl::Context::height;
inline constexpr std::size_t pixel_count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);

inline const glm::vec3 surface(0.5f, 0.75f, 1.0f), border(0.125f, 0.25f, 3.0f);
inline constexpr float bias = 0.002f;

// A triangle of an object, and what falls on it.
struct Scene {
    glm::mat4 clip_from_object;
    texgen::ObjectTexgen texgen;
    texgen::TextureRegion region;
    std::array<glm::vec3, 3> corners;
    texgen::Triangle triangle;  // the same in the window
};

inline std::optional<texgen::Projector> projector_at(const glm::dvec3& position, const glm::dvec3& target) {
    return texgen::make_projector(
        texgen::PerspectiveLens{.fovy = texgen::degrees(30.0), .aspect = 1.0, .z_near = 2.0, .z_far = 200.0},
        texgen::Aim{.position = position, .target = target, .up = {0.0, 1.0, 0.0}}, texgen::opengl);
}

// A floor from near the camera to far away. The slide falls on it from above; or the projector stands on its far side,
// so that the floor reaches behind it, to where the slide would be seen again without a gate.
inline Scene random_scene(Random& random, bool reaches_behind) {
    const auto projector = reaches_behind ? projector_at({0.0, 0.0, -15.0}, {random.uniform(-1.0, 1.0), 1.0, 0.0})
                                          : projector_at({2.0, 5.0, 5.0}, {-2.0, -4.0, 0.0});
    const auto camera = texgen::make_projector(
        texgen::PerspectiveLens{.fovy = texgen::degrees(50.0), .aspect = 1.0, .z_near = 0.5, .z_far = 500.0},
        texgen::Aim{.position = {random.uniform(-3.0, 3.0), random.uniform(1.0, 8.0), 12.0},
                    .target = {random.uniform(-1.0, 1.0), -2.0, 0.0},
                    .up = {random.uniform(-1.0, 1.0), 1.0, 0.0}},
        texgen::opengl);
    REQUIRE(projector.has_value());
    REQUIRE(camera.has_value());
    const texgen::ModelMatrix model(random.rigid(5.0));
    const texgen::TextureRegion region =
        random.coin() ? texgen::whole_texture() : texgen::atlas_tile({0.25, 0.125}, {0.75, 0.875});
    Scene scene{support::rounded(camera->matrix().matrix() * model.matrix()),
                texgen::object_linear(*projector, model, region),
                region,
                {},
                {}};

    const std::array floor{glm::dvec4(random.uniform(-9, -5), -4, 6, 1), glm::dvec4(random.uniform(5, 9), -4, 6, 1),
                           glm::dvec4(random.uniform(-30, 30), -4, random.uniform(-100, -60), 1)};
    for (std::size_t i = 0; i < 3; ++i) scene.corners[i] = glm::vec3(texgen::inverse_rigid(model).matrix() * floor[i]);
    std::array<glm::vec4, 3> strq;
    texgen::generate(scene.texgen, texgen::object_space(scene.corners), strq);
    std::array<texgen::WindowVertex, 3> window;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec4 clip = glm::dmat4(scene.clip_from_object) * glm::dvec4(scene.corners[i], 1.0);
        window[i] = texgen::to_window({glm::vec4(clip), strq[i]}, {0, 0, width, height});
    }
    scene.triangle = {window[0], window[1], window[2]};
    return scene;
}

inline std::vector<glm::vec4> draw(const gl::Context& g, const Scene& scene, unsigned program) {
    g.UseProgram(program);
    const auto at = [&](const char* name) { return g.GetUniformLocation(program, name); };
    const glm::mat4 texture_from_object = scene.texgen.rounded();
    const glm::vec4 region(scene.region.min(), scene.region.max());
    g.UniformMatrix4fv(at("clip_from_object"), 1, 0, &scene.clip_from_object[0][0]);
    g.UniformMatrix4fv(at("texture_from_object"), 1, 0, &texture_from_object[0][0]);
    g.Uniform4fv(at("region"), 1, &region[0]);
    g.Uniform3fv(at("border"), 1, &border[0]);
    g.Uniform3fv(at("surface"), 1, &surface[0]);
    g.Uniform1f(at("bias"), bias);
    g.clear(glm::vec4(nothing));
    g.Begin(gl::triangles);
    for (const glm::vec3& corner : scene.corners) g.Vertex3fv(&corner[0]);
    g.End();
    REQUIRE(g.GetError() == gl::no_error);
    return g.pixels();
}

}  // namespace shaded
