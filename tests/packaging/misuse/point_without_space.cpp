// one point without a word on its space
#include <texgen/texcoord.hpp>

using namespace texgen;

std::optional<glm::vec2> coordinates(const WorldTexgen& texgen, const glm::vec3& point) {
#ifndef MISUSE
    return project(texgen, world_space(point));
#else
    return project(texgen, point);
#endif
}
