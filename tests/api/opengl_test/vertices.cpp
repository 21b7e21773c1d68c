// The five modes, and recipes of others, at vertices.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "api/opengl_test/both.hpp"
#include "support/fixed_function.hpp"
#include "support/hex.hpp"
#include "support/opengl.hpp"
#include "support/random.hpp"
#include "texgen/fixed_function.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace judged {

using support::hex;

namespace {

TEST_CASE(
    "the linear modes are OpenGL's at vertices, per coordinate, off coordinates and the texture matrix included") {
    const gl::Context& g = opengl();
    Random random(103);
    double worst = 0.0;
    for (int round = 0; round < 60; ++round) {
        Both both(g);
        const Kind kind = kinds[static_cast<std::size_t>(round) % kinds.size()];
        const bool with_texture_matrix = random.coin();
        for (const Coordinate coordinate : coordinates) {
            both.enable(coordinate, random.integer(0, 3) != 0);
            both.set_mode(coordinate, random.coin() ? TexGenMode::object_linear : TexGenMode::eye_linear);
        }
        if (with_texture_matrix)
            both.set_texture_matrix(
                {random.vector4(1.0), random.vector4(1.0), random.vector4(1.0), random.vector4(1.0)});
        for (int i = 0; i < 40; ++i) {
            for (const Coordinate coordinate : coordinates) {
                both.set_object_plane(coordinate, random.vector4(2.0));
                // Judged apart: here both have the very same plane in eye space.
                both.set_eye_plane(coordinate, random.vector4(2.0), identity);
            }
            const glm::mat4 modelview = random_modelview(random, kind, 10.0);
            const FixedFunctionVertex vertex{
                .position = random.vector4(5.0), .normal = random.vector3(1.0), .texcoord = random.vector4(3.0)};
            const glm::vec4 theirs = both.judge(vertex, modelview);
            const glm::vec4 ours = both.ours().generate(vertex, modelview);
            // The sum of the absolute terms of each coordinate, through the texture matrix.
            glm::dvec4 terms(0.0);
            for (const Coordinate coordinate : coordinates) {
                const int c = static_cast<int>(coordinate);
                if (!both.ours().enabled(coordinate)) {
                    terms[c] = std::fabs(static_cast<double>(vertex.texcoord[c]));
                } else if (both.ours().mode(coordinate) == TexGenMode::object_linear) {
                    for (int k = 0; k < 4; ++k)
                        terms[c] += std::fabs(static_cast<double>(both.ours().object_plane(coordinate)[k]) *
                                              static_cast<double>(vertex.position[k]));
                } else {
                    for (int k = 0; k < 4; ++k)
                        for (int j = 0; j < 4; ++j)
                            terms[c] += std::fabs(static_cast<double>(both.ours().eye_plane(coordinate)[k]) *
                                                  static_cast<double>(modelview[j][k]) *
                                                  static_cast<double>(vertex.position[j]));
                }
            }
            glm::dvec4 through(0.0);
            for (int row = 0; row < 4; ++row)
                for (int k = 0; k < 4; ++k)
                    through[row] += std::fabs(static_cast<double>(both.ours().texture_matrix()[k][row])) * terms[k];
            INFO("modelview ", hex(modelview), " position ", hex(vertex.position), " texture matrix ",
                 hex(both.ours().texture_matrix()));
            INFO("OpenGL ", hex(theirs), " ours ", hex(ours));
            for (int c = 0; c < 4; ++c) {
                const double error = std::fabs(static_cast<double>(theirs[c]) - static_cast<double>(ours[c]));
                worst = std::max(worst, error / through[c]);
                REQUIRE(error <= 3e-7 * through[c]);
            }
        }
    }
    MESSAGE("linear modes at vertices: worst error ", worst, " of the absolute terms");
}

TEST_CASE("sphere, reflection and normal map are OpenGL's at vertices, under its three treatments of normals") {
    const gl::Context& g = opengl();
    Random random(104);
    double worst_normal = 0.0, worst_reflection = 0.0, worst_sphere = 0.0;
    for (const Kind kind : kinds) {
        for (const NormalScaling scaling : support::scalings) {
            for (int round = 0; round < 8; ++round) {
                Both both(g);
                both.set_normal_scaling(scaling);
                // s and t differ in mode, so that each is seen in each place.
                constexpr std::array normal_modes{TexGenMode::sphere_map, TexGenMode::reflection_map,
                                                  TexGenMode::normal_map};
                both.set_mode(Coordinate::s, normal_modes[static_cast<std::size_t>(round) % 3]);
                both.set_mode(Coordinate::t, normal_modes[static_cast<std::size_t>(round / 3) % 3]);
                both.set_mode(Coordinate::r, normal_modes[1 + static_cast<std::size_t>(round) % 2]);
                for (const Coordinate coordinate : {Coordinate::s, Coordinate::t, Coordinate::r})
                    both.enable(coordinate);
                for (int i = 0; i < 60; ++i) {
                    const glm::mat4 modelview = random_modelview(random, kind, 10.0);
                    const FixedFunctionVertex vertex{.position = random.vector4(5.0),
                                                     .normal = glm::vec3(random.direction()),
                                                     .texcoord = random.vector4(3.0)};
                    const glm::vec4 theirs = both.judge(vertex, modelview);
                    const glm::vec4 ours = both.ours().generate(vertex, modelview);

                    TexGenUnit helper;
                    helper.set_normal_scaling(scaling);
                    for (const Coordinate coordinate : {Coordinate::s, Coordinate::t, Coordinate::r}) {
                        helper.enable(coordinate);
                        REQUIRE(helper.set_mode(coordinate, TexGenMode::normal_map));
                    }
                    const glm::dvec3 n(glm::vec3(helper.generate(vertex, modelview)));
                    for (const Coordinate coordinate : {Coordinate::s, Coordinate::t, Coordinate::r})
                        REQUIRE(helper.set_mode(coordinate, TexGenMode::reflection_map));
                    const glm::dvec3 r(glm::vec3(helper.generate(vertex, modelview)));
                    const double n_squared = n.x * n.x + n.y * n.y + n.z * n.z;
                    const double m = 2.0 * std::sqrt(r.x * r.x + r.y * r.y + (r.z + 1.0) * (r.z + 1.0));

                    INFO("kind ", static_cast<int>(kind), " scaling ", static_cast<int>(scaling), " modelview ",
                         hex(modelview), " position ", hex(vertex.position), " normal ", hex(vertex.normal));
                    INFO("OpenGL ", hex(theirs), " ours ", hex(ours));
                    // Theirs inverts in float: everything is as far off as the inverse.
                    const double float_inverse = std::max(1e-6, 5e-8 * condition(modelview));
                    for (const Coordinate coordinate : {Coordinate::s, Coordinate::t, Coordinate::r}) {
                        const int c = static_cast<int>(coordinate);
                        const double error = std::fabs(static_cast<double>(theirs[c]) - static_cast<double>(ours[c]));
                        switch (both.ours().mode(coordinate)) {
                            case TexGenMode::normal_map:
                                worst_normal = std::max(worst_normal, error / (float_inverse * std::sqrt(n_squared)));
                                REQUIRE(error <= float_inverse * std::sqrt(n_squared));
                                break;
                            case TexGenMode::reflection_map:
                                worst_reflection =
                                    std::max(worst_reflection, error / (float_inverse * (1.0 + 4.0 * n_squared)));
                                REQUIRE(error <= float_inverse * (1.0 + 4.0 * n_squared));
                                break;
                            default:
                                worst_sphere =
                                    std::max(worst_sphere, error * m / (float_inverse * (1.0 + 4.0 * n_squared)));
                                REQUIRE(error <= float_inverse * (1.0 + 4.0 * n_squared) / m);
                        }
                    }
                    CHECK(theirs.w == ours.w);
                }
            }
        }
    }
    MESSAGE("of the tolerance: normal ", worst_normal, ", reflection ", worst_reflection, ", sphere ", worst_sphere);
}

TEST_CASE("SGI's recipe, the projector in the texture matrix, is OpenGL's") {
    const gl::Context& g = opengl();
    Random random(105);
    const texgen::Projector projector = support::slide_projector();
    glm::dmat4 half(1.0);
    half[0][0] = half[1][1] = half[3][0] = half[3][1] = 0.5;
    const glm::mat4 texture_matrix = rounded(half * projector.projection.matrix() * projector.view.matrix());
    for (int i = 0; i < 500; ++i) {
        const glm::mat4 view = rounded(random.rigid(20.0));
        const glm::mat4 model = rounded(random.rigid(5.0));
        Both both(g);
        both.set_texture_matrix(texture_matrix);
        for (const Coordinate coordinate : coordinates) {
            glm::vec4 plane(0.0f);
            plane[static_cast<int>(coordinate)] = 1.0f;
            both.set_eye_plane(coordinate, plane, view);
            both.enable(coordinate);
        }
        const FixedFunctionVertex vertex{.position = {random.vector3(5.0), 1.0f}};
        const glm::mat4 modelview = rounded(glm::dmat4(view) * glm::dmat4(model));
        const glm::vec4 theirs = both.judge(vertex, modelview);
        const glm::vec4 ours = both.ours().generate(vertex, modelview);
        const auto texgen = texgen::object_linear(projector, texgen::ModelMatrix(model), texgen::whole_texture(),
                                                  texgen::DepthMapping::ndc);
        const glm::dvec4 definition = texgen.matrix() * glm::dvec4(vertex.position);
        INFO("view ", hex(view), " model ", hex(model), " position ", hex(vertex.position));
        INFO("OpenGL ", hex(theirs), " ours ", hex(ours));
        // Planes, view and modelview are floats some tens of units away from the origin.
        for (int c = 0; c < 4; ++c) {
            CHECK(std::fabs(static_cast<double>(theirs[c]) - static_cast<double>(ours[c])) <= 2e-4);
            CHECK(std::fabs(static_cast<double>(theirs[c]) - definition[c]) <= 2e-4);
        }
    }
}

}  // namespace

}  // namespace judged
