// the matrix of a wall's plane for the points of a mesh
#include <array>
#include <span>

#include <texgen/surface.hpp>
#include <texgen/texcoord.hpp>

using namespace texgen;

void coordinates(const std::array<glm::dvec2, 4>& corners, std::span<const glm::vec3> points,
                 std::span<glm::vec4> strq) {
    if (const auto texgen = keystone(corners))
#ifndef MISUSE
        generate(*texgen, window_space(points), strq);
#else
        generate(*texgen, object_space(points), strq);
#endif
}
