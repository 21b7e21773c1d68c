#pragma once

// The cases of matrices: eye planes, what is composed, poses and lenses.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "judges/rational_matrix.hpp"
#include "promises/hard_cases_test/numbers.hpp"
#include "support/json.hpp"
#include "texgen/fixed_function.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/scene.hpp"
#include "texgen/transform.hpp"

namespace hard_cases {

using support::exactly;

inline void eyeplane(const Json& json) {
    const texgen::ModelviewMatrix modelview(from_rows(json["in"]["M_rowmajor"]));
    const glm::vec4 plane = as_vector(json["in"]["p"]);
    glm::dmat4 rows(0.0);
    for (int column = 0; column < 4; ++column) rows[column] = glm::dvec4(plane[column]);
    const auto stored = eye_planes_as_stored(texgen::ObjectTexgen(rows), modelview);
    REQUIRE(stored.has_value() != json["singular"].is_true());
    texgen::TexGenUnit unit;
    const glm::mat4 in_float(modelview.rounded());
    REQUIRE(unit.set_eye_plane(texgen::Coordinate::s, plane, in_float) == stored.has_value());
    const glm::dvec4 bound = unit.eye_plane_error_bound(texgen::Coordinate::s, plane, in_float);
    if (!stored) {
        CHECK(std::isinf(bound.x));
        return;
    }
    for (int k = 0; k < 4; ++k) {
        const double kept = static_cast<double>(unit.eye_plane(texgen::Coordinate::s)[k]);
        CHECK(unit.eye_plane(texgen::Coordinate::s)[k] == as_float(json["f32"][static_cast<std::size_t>(k)]));
        // f64 is rounded itself.
        const double exact = json["f64"][static_cast<std::size_t>(k)].number();
        CHECK(std::fabs(kept - exact) <= bound[k] + 0x1p-52 * std::fabs(exact));
    }
    double largest = 0.0;
    for (std::size_t k = 0; k < 4; ++k) largest = std::max(largest, std::fabs(json["f64"][k].number()));
    for (const glm::vec4& row : texgen::planes(*stored))
        for (int k = 0; k < 4; ++k) CHECK(row[k] == as_float(json["f32"][static_cast<std::size_t>(k)]));
    for (int k = 0; k < 4; ++k)
        CHECK(std::fabs(stored->matrix()[k][2] - json["f64"][static_cast<std::size_t>(k)].number()) <=
              0x1p-52 * largest);
}

// Row-major elements against the exact ones, each in float and within a few double ulp of the terms that made it.
inline void check_matrix(const glm::dmat4& computed, const glm::dmat4& terms, double roundings, const Json& json) {
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            const std::size_t i = static_cast<std::size_t>(4 * row + column);
            CAPTURE(row);
            CAPTURE(column);
            CHECK(std::fabs(computed[column][row] - json["f64"][i].number()) <=
                  roundings * 0x1p-53 * std::fabs(terms[column][row]));
        }
    }
}

inline glm::dmat4 magnitudes(glm::dmat4 m) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) m[column][row] = std::fabs(m[column][row]);
    return m;
}

inline void compose_to(const Json& json) {
    const Json& in = json["in"];
    const glm::dmat4 p = from_rows(in["P"]), v = from_rows(in["V"]), m = from_rows(in["M"]);
    const texgen::Projector projector{texgen::ProjectorProjection(p), texgen::ProjectorView(v), texgen::opengl};
    const texgen::ObjectTexgen t_o = object_linear(projector, texgen::ModelMatrix(m));
    const glm::dmat4 s = scale_bias(texgen::opengl).matrix();
    check_matrix(t_o.matrix(), s * magnitudes(p) * magnitudes(v) * magnitudes(m), 13.0, json);
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            CHECK(t_o.rounded()[column][row] == as_float(json["f32"][static_cast<std::size_t>(4 * row + column)]));
}

inline void te_from_poses(const Json& json) {
    const Json& in = json["in"];
    const glm::dvec3 up(0, 1, 0);
    const auto projector = make_projector(texgen::PerspectiveLens{.fovy = texgen::radians(in["fovy_rad"].number()),
                                                                  .aspect = 1.0,
                                                                  .z_near = in["near"].number(),
                                                                  .z_far = in["far"].number()},
                                          {as_point(in["proj_eye"]), as_point(in["proj_center"]), up}, texgen::opengl);
    const auto camera = texgen::look_at({as_point(in["cam_eye"]), as_point(in["cam_center"]), up});
    REQUIRE(projector);
    REQUIRE(camera);
    const texgen::CameraPose pose(texgen::inverse_rigid(*camera).matrix());
    const texgen::EyeTexgen t_e = eye_linear(*projector, pose);
    const glm::dmat4 s = scale_bias(texgen::opengl).matrix();
    const glm::dmat4 terms = s * magnitudes(projector->projection.matrix()) * magnitudes(projector->view.matrix()) *
                             magnitudes(pose.matrix());
    check_matrix(t_e.matrix(), terms, 24.0, json);
    texgen::Scene scene;
    const texgen::ModelMatrix model(glm::dmat4(1.0));
    const texgen::Box bounds{glm::vec3(-1.0f), glm::vec3(1.0f)};
    scene.update({.models = {&model, 1}, .bounds = {&bounds, 1}, .projectors = {&*projector, 1}}, {});
    CHECK(scene.update_eye(pose) == 1);
    check_matrix(scene.eye_texgens()[0].matrix(), terms, 24.0, json);
}

inline void perspective(const Json& json) {
    const Json& in = json["in"];
    const texgen::PerspectiveLens lens{.fovy = texgen::radians(in["fovy_rad"].number()),
                                       .aspect = in["aspect"].number(),
                                       .z_near = in["near"].number(),
                                       .z_far = in["far"].number()};
    const auto projection = texgen::perspective(lens, texgen::opengl);
    // Beyond 180 degrees the formula has a value, of a picture that is upside down; it is no lens.
    const bool is_lens = json["f64"][0].number() > 0.0;
    REQUIRE(projection.has_value() == is_lens);
    if (!is_lens) return;
    const glm::dmat4& m = projection->matrix();
    const std::array computed{m[0][0], m[1][1], m[2][2], m[3][2]};
    for (std::size_t k = 0; k < 4; ++k) {
        const double exact = json["f64"][k].number();
        CHECK(std::fabs(computed[k] - exact) <= 4.0 * 0x1p-52 * std::fabs(exact));
        CHECK(static_cast<float>(computed[k]) == as_float(json["f32"][k]));
    }
}

inline void lookat(const Json& json) {
    const Json& in = json["in"];
    const glm::dvec3 eye = as_point(in["eye"]);
    const auto view = texgen::look_at({eye, as_point(in["center"]), as_point(in["up"])});
    REQUIRE(view);
    const double distance = std::fabs(eye.x) + std::fabs(eye.y) + std::fabs(eye.z);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            const double exact = json["f64"][static_cast<std::size_t>(4 * row + column)].number();
            CHECK(std::fabs(view->matrix()[column][row] - exact) <= 4.0 * 0x1p-52 * (column < 3 ? 1.0 : distance));
        }
    }
    // And back: the pose, which is rigid but for the rounding of the view.
    const auto pose = inverse(*view);
    REQUIRE(pose);
    const auto inverted = support::inverse(support::exactly(view->matrix()));
    REQUIRE(inverted);
    const glm::dmat4 bound = inverse_error_bound(*view, *pose);
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            const Rational& element = (*inverted)[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
            CHECK(support::magnitude(exactly(pose->matrix()[column][row]) - element) <= exactly(bound[column][row]));
        }
    }
}

}  // namespace hard_cases
