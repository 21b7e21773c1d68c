// the corners of a quadrilateral that is not asked whether it is convex
#include <array>

#include <texgen/surface.hpp>

using namespace texgen;

float q_of_first(const std::array<glm::dvec2, 4>& corners) {
#ifndef MISUSE
    const auto strq = quadrilateral(corners);
    return strq ? (*strq)[0].w : 0.0f;
#else
    return quadrilateral(corners)[0].w;
#endif
}
