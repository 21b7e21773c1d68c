// a coordinate divided twice
#include <texgen/texcoord.hpp>

using namespace texgen;

auto coordinate(glm::vec4 strq) {
#ifndef MISUSE
    return divide(strq);
#else
    return divide(divide(strq).value());
#endif
}
