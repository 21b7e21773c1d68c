#pragma once

// Triangles as OpenGL draws them, and their comparison with the definitions, fragment by fragment.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "support/hex.hpp"
#include "support/opengl.hpp"
#include "support/opengl_fragments.hpp"
#include "support/random.hpp"
#include "support/triangles.hpp"
#include "texgen/primitives.hpp"
#include "texgen/reference.hpp"

namespace judged {

namespace gl = support::gl;
using support::hex;
using support::Random;
using support::gl::largest_terms;

// Texture coordinates of every fragment of a triangle whose vertices are at these window positions and have these
// clip-space w; -1e30 where there is no fragment.
inline constexpr float nothing = -1e30f;

inline glm::vec4 clip_position(const texgen::WindowVertex& vertex) {
    const float half_width = gl::Context::width / 2, half_height = gl::Context::height / 2;
    return {(vertex.window.x / half_width - 1.0f) * vertex.clip_w,
            (vertex.window.y / half_height - 1.0f) * vertex.clip_w, 0.0f, vertex.clip_w};
}

// The triangle by itself, as whoever calls has set OpenGL up.
inline std::vector<glm::vec4> draw(const gl::Context& g, const texgen::Triangle& triangle) {
    g.clear(glm::vec4(nothing));
    g.Begin(gl::triangles);
    for (const texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c}) {
        g.TexCoord4fv(&vertex->strq[0]);
        const glm::vec4 position = clip_position(*vertex);
        g.Vertex4fv(&position[0]);
    }
    g.End();
    REQUIRE(g.GetError() == gl::no_error);
    return g.pixels();
}

inline std::vector<glm::vec4> draw_with_texcoords(const gl::Context& g, const texgen::Triangle& triangle) {
    g.reset();
    g.show_texcoord();
    return draw(g, triangle);
}

// A triangle of at least a tenth of the target, window positions on sixteenths of a pixel.
inline texgen::Triangle random_triangle(Random& random, double w_decades) {
    for (;;) {
        const auto vertex = [&random, w_decades] {
            const auto sixteenths = [&random](int size) {
                return static_cast<float>(random.integer(16, 16 * (size - 1))) / 16.0f;
            };
            return texgen::WindowVertex{{sixteenths(gl::Context::width), sixteenths(gl::Context::height)},
                                        static_cast<float>(random.power_of_ten(-0.5 * w_decades, 0.5 * w_decades)),
                                        glm::vec4(0.0f)};
        };
        const texgen::Triangle triangle{vertex(), vertex(), vertex()};
        if (std::fabs(support::twice_area(triangle)) > 0.2 * gl::Context::width * gl::Context::height) return triangle;
    }
}

struct Comparison {
    std::size_t fragments = 0, behind = 0;
    double worst = 0.0, worst_homogeneous = 0.0;
};

inline void compare(const std::vector<glm::vec4>& pixels, const texgen::Triangle& triangle, double tolerance,
                    Comparison& result) {
    INFO("triangle ", hex(triangle));
    for (int row = 0; row < gl::Context::height; ++row) {
        for (int column = 0; column < gl::Context::width; ++column) {
            const glm::vec4 theirs = pixels[static_cast<std::size_t>(row * gl::Context::width + column)];
            if (theirs.x == nothing) continue;
            ++result.fragments;
            const double x = column + 0.5, y = row + 0.5;
            const Eigen::Vector4d strq = texgen::reference::strq(triangle, x, y);
            const Eigen::Vector3d u = texgen::reference::quotient<double>(strq);
            const glm::dvec4 terms = largest_terms(triangle, x, y);
            INFO("fragment ", x, " ", y, " OpenGL ", hex(theirs), " exact ",
                 hex(glm::dvec4(strq[0], strq[1], strq[2], strq[3])));
            if (strq[3] <= 0.0) ++result.behind;
            // s, t, r, q themselves share the error of the w of the fragment, which cancels in the quotients.
            for (int c = 0; c < 4; ++c) {
                const double error = std::fabs(static_cast<double>(theirs[c]) - strq[c]);
                result.worst_homogeneous = std::max(result.worst_homogeneous, error / terms[c]);
                if (!(error <= 4.0 * tolerance * terms[c])) FAIL("homogeneous coordinate ", c, " is off by ", error);
            }
            // At q = 0, as far as floats can tell, a quotient may be anything.
            if (2.0 * tolerance * terms[3] > std::fabs(strq[3])) continue;
            for (int c = 0; c < 3; ++c) {
                const double allowed = (terms[c] + std::fabs(u[c]) * terms[3]) / std::fabs(strq[3]);
                const double error = std::fabs(static_cast<double>(theirs[c]) / static_cast<double>(theirs.w) - u[c]);
                result.worst = std::max(result.worst, error / allowed);
                if (!(error <= tolerance * allowed)) FAIL("quotient ", c, " is off by ", error);
            }
        }
    }
}

}  // namespace judged
