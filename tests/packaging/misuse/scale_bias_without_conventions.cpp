// a scale-bias matrix without conventions
#include <texgen/scale_bias.hpp>

using namespace texgen;

auto matrix() {
#ifndef MISUSE
    return scale_bias(metal);
#else
    return scale_bias();
#endif
}
