// positions in world space projected by an object texgen
#include <texgen/texcoord.hpp>

using namespace texgen;

void coordinates(const ObjectTexgen& texgen, std::span<const glm::vec3> points, std::span<glm::vec2> st) {
#ifndef MISUSE
    project(texgen, object_space(points), st);
#else
    project(texgen, world_space(points), st);
#endif
}
