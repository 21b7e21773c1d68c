// one point in world space projected by an object texgen
#include <texgen/texcoord.hpp>

using namespace texgen;

std::optional<glm::vec2> coordinates(const ObjectTexgen& texgen, const glm::vec3& point) {
#ifndef MISUSE
    return project(texgen, object_space(point));
#else
    return project(texgen, world_space(point));
#endif
}
