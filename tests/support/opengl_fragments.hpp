#pragma once

// What a fragment of OpenGL's may differ by from the definition.

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "support/triangles.hpp"
#include "texgen/primitives.hpp"

namespace support::gl {

// OpenGL interpolates s/w, t/w, r/w and q/w by planes in float, so its errors are measured against the largest of the
// three vertices: max |f_i / w_i|, times the w of the fragment. The error of u = s/q may be
// tolerance * (S + |u| Q) / |q|: next to nothing is asked of a fragment at q = 0, and none is left out.
inline glm::dvec4 largest_terms(const texgen::Triangle& triangle, double x, double y) {
    const std::array<const texgen::WindowVertex*, 3> vertices{&triangle.a, &triangle.b, &triangle.c};
    glm::dvec4 terms(0.0);
    double one_over_w = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        // Plain barycentrics: the definition must not judge itself.
        const glm::dvec2 from = glm::dvec2(vertices[(i + 1) % 3]->window) - glm::dvec2(x, y);
        const glm::dvec2 to = glm::dvec2(vertices[(i + 2) % 3]->window) - glm::dvec2(x, y);
        const double w = static_cast<double>(vertices[i]->clip_w);
        one_over_w += (from.x * to.y - from.y * to.x) / twice_area(triangle) / w;
        for (int c = 0; c < 4; ++c)
            terms[c] = std::max(terms[c], std::fabs(static_cast<double>(vertices[i]->strq[c])) / w);
    }
    return terms / one_over_w;
}

inline constexpr double fragment_tolerance = 1e-6;

}  // namespace support::gl
