// conventions that say nothing of the world's handedness
#include <texgen/conventions.hpp>

using namespace texgen;

auto conventions() {
#ifndef MISUSE
    return Conventions{DepthRange::zero_to_one, NdcY::up, TextureOrigin::top_left, Handedness::right};
#else
    return Conventions{DepthRange::zero_to_one, NdcY::up, TextureOrigin::top_left};
#endif
}
