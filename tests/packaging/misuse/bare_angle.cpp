// a bare number for an angle
#include <texgen/conventions.hpp>

using namespace texgen;

Angle right_angle() {
#ifndef MISUSE
    return degrees(90.0);
#else
    return 90.0;
#endif
}
