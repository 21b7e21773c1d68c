// a projection without conventions
#include <texgen/projector.hpp>

using namespace texgen;

auto projection(const PerspectiveLens& lens) {
#ifndef MISUSE
    return perspective(lens, opengl);
#else
    return perspective(lens);
#endif
}
