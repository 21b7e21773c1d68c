// a plane of the receiver that is not asked whether there is one
#include <texgen/surface.hpp>

using namespace texgen;

double slope(glm::vec4 a, glm::vec4 b, glm::vec4 c) {
#ifndef MISUSE
    return receiver_plane(a, b, c).value_or(glm::dvec3(0.0)).x;
#else
    return receiver_plane(a, b, c).x;
#endif
}
