#pragma once

// A texture coordinate generation of ours beside OpenGL's, and MODELVIEWs for both.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "support/fixed_function.hpp"
#include "support/opengl.hpp"
#include "support/random.hpp"
#include "texgen/fixed_function.hpp"
#include "texgen/linear.hpp"

namespace judged {

namespace gl = support::gl;
using support::Coordinate;
using support::coordinates;
using support::NormalScaling;
using support::Random;
using support::rounded;
using support::TexGenMode;
using support::TexGenUnit;
using texgen::FixedFunctionVertex;

inline const glm::mat4 identity(1.0f);

inline const gl::Context& opengl() { return gl::Context::or_skip(); }

inline gl::Enum name(TexGenMode mode) {
    constexpr std::array names{gl::object_linear, gl::eye_linear, gl::sphere_map, gl::reflection_map, gl::normal_map};
    return names[static_cast<std::size_t>(mode)];
}
inline gl::Enum name(Coordinate coordinate) { return gl::s + static_cast<gl::Enum>(coordinate); }
inline gl::Enum switch_of(Coordinate coordinate) { return gl::texture_gen_s + static_cast<gl::Enum>(coordinate); }

inline glm::vec4 plane_of(const gl::Context& g, Coordinate coordinate, gl::Enum which) {
    glm::vec4 plane(-7.0f);
    g.GetTexGenfv(name(coordinate), which, &plane[0]);
    return plane;
}

// One unit of ours and OpenGL's, told the same.
class Both {
public:
    explicit Both(const gl::Context& context) : gl_(context) { gl_.reset(); }

    const TexGenUnit& ours() const { return ours_; }

    void enable(Coordinate coordinate, bool on = true) {
        ours_.enable(coordinate, on);
        on ? gl_.Enable(switch_of(coordinate)) : gl_.Disable(switch_of(coordinate));
    }
    void set_mode(Coordinate coordinate, TexGenMode mode) {
        REQUIRE(ours_.set_mode(coordinate, mode));
        gl_.TexGeni(name(coordinate), gl::texture_gen_mode, static_cast<int>(name(mode)));
    }
    void set_object_plane(Coordinate coordinate, const glm::vec4& plane) {
        ours_.set_object_plane(coordinate, plane);
        gl_.TexGenfv(name(coordinate), gl::object_plane, &plane[0]);
    }
    void set_eye_plane(Coordinate coordinate, const glm::vec4& plane, const glm::mat4& modelview) {
        REQUIRE(ours_.set_eye_plane(coordinate, plane, modelview));
        gl_.load_matrix(gl::modelview, modelview);
        gl_.TexGenfv(name(coordinate), gl::eye_plane, &plane[0]);
    }
    void set_texture_matrix(const glm::mat4& matrix) {
        ours_.set_texture_matrix(matrix);
        gl_.load_matrix(gl::texture, matrix);
    }
    void set_normal_scaling(NormalScaling scaling) {
        ours_.set_normal_scaling(scaling);
        gl_.Disable(gl::rescale_normal);
        gl_.Disable(gl::normalize);
        if (scaling == NormalScaling::rescale) gl_.Enable(gl::rescale_normal);
        if (scaling == NormalScaling::normalize) gl_.Enable(gl::normalize);
    }

    void load_projection(const glm::mat4& matrix) { gl_.load_matrix(gl::projection, matrix); }

    // A projection that puts this vertex into the middle of the view, whatever its eye coordinates are.
    glm::vec4 judge(const FixedFunctionVertex& vertex, const glm::mat4& modelview) {
        const glm::dvec4 eye = glm::dmat4(modelview) * glm::dvec4(vertex.position);
        double squared = 0.0;
        for (int i = 0; i < 4; ++i) squared += eye[i] * eye[i];
        glm::mat4 projection(0.0f);
        for (int i = 0; i < 4; ++i) projection[i][3] = static_cast<float>(eye[i] / squared);
        gl_.load_matrix(gl::projection, projection);
        gl_.load_matrix(gl::modelview, modelview);
        const gl::Context::Feedback feedback = gl_.vertex_texcoord(vertex.position, vertex.normal, vertex.texcoord);
        REQUIRE(feedback.valid);
        REQUIRE(gl_.GetError() == gl::no_error);
        return feedback.texcoord;
    }

private:
    const gl::Context& gl_;
    TexGenUnit ours_;
};

inline double norm(const glm::dmat4& m) {
    double largest = 0.0;
    for (int column = 0; column < 4; ++column) {
        double sum = 0.0;
        for (int row = 0; row < 4; ++row) sum += std::fabs(m[column][row]);
        largest = std::max(largest, sum);
    }
    return largest;
}

inline double condition(const glm::mat4& modelview) {
    const texgen::ModelviewMatrix matrix(modelview);
    return norm(matrix.matrix()) * norm(texgen::inverse(matrix).value().matrix());
}

inline double largest(const glm::vec4& v) {
    return static_cast<double>(std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z), std::fabs(v.w)}));
}

enum class Kind { rigid, scaled, sheared, projective };
inline constexpr std::array kinds{Kind::rigid, Kind::scaled, Kind::sheared, Kind::projective};

inline glm::mat4 random_modelview(Random& random, Kind kind, double distance) {
    glm::dmat4 m = random.rigid(distance);
    switch (kind) {
        case Kind::rigid:
            break;
        case Kind::scaled:
            for (int column = 0; column < 3; ++column) m[column] *= random.power_of_ten(-1.5, 1.5);
            break;
        case Kind::sheared:
            m[1] += random.uniform(-3.0, 3.0) * m[0];
            m[2] += random.uniform(-3.0, 3.0) * m[1];
            break;
        case Kind::projective:
            for (int column = 0; column < 4; ++column) m[column] += glm::dvec4(random.vector4(0.3));
            break;
    }
    return rounded(m);
}

}  // namespace judged
