// an area on the slide that is not asked whether there is one
#include <texgen/surface.hpp>

using namespace texgen;

double area(glm::vec4 a, glm::vec4 b, glm::vec4 c) {
#ifndef MISUSE
    return slide_area(a, b, c).value_or(0.0);
#else
    return slide_area(a, b, c);
#endif
}
