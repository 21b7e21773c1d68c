// a refusal of the texgen unit that is not looked at
#include <texgen/fixed_function.hpp>

using namespace texgen;

bool refused(TexGenUnit& unit) {
#ifndef MISUSE
    return !unit.set_mode(Coordinate::q, TexGenMode::sphere_map);
#else
    unit.set_mode(Coordinate::q, TexGenMode::sphere_map);
    return false;
#endif
}
