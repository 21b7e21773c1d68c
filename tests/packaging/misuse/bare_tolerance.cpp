// a bare number for a tolerance
#include <texgen/texcoord.hpp>

using namespace texgen;

void coordinates(const ObjectTexgen& texgen, Positions<Object> points, std::span<glm::vec2> st) {
#ifndef MISUSE
    project(texgen, points, st, texels(0.5, 4096.0));
#else
    project(texgen, points, st, 0.5);
#endif
}
