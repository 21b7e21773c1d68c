// a transform times a vector, whose space nobody knows
#include <texgen/transform.hpp>

using namespace texgen;

auto strq_of(const WorldTexgen& texgen, const glm::dvec4& position) {
#ifndef MISUSE
    return texgen.matrix() * position;
#else
    return texgen * position;
#endif
}
