// a window's texgen matrix under points of the world
#include <span>

#include <texgen/surface.hpp>
#include <texgen/texcoord.hpp>

using namespace texgen;

void coordinates(const WindowTexgen& texgen, std::span<const glm::vec3> points, std::span<glm::vec4> strq) {
#ifndef MISUSE
    generate(texgen, window_space(points), strq);
#else
    generate(texgen, world_space(points), strq);
#endif
}
