// an angle for a bare number
#include <texgen/conventions.hpp>

using namespace texgen;

double number() {
#ifndef MISUSE
    return degrees(90.0).in_radians();
#else
    return degrees(90.0);
#endif
}
