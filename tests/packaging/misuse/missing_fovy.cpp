// a lens without an angle
#include <texgen/projector.hpp>

using namespace texgen;

PerspectiveLens lens() {
#ifndef MISUSE
    return {.fovy = degrees(30.0), .aspect = 1.0, .z_near = 0.2, .z_far = 1000.0};
#else
    return {.aspect = 1.0, .z_near = 0.2, .z_far = 1000.0};
#endif
}
