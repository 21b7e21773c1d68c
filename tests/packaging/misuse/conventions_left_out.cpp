// conventions that say nothing of the texture's origin
#include <texgen/conventions.hpp>

using namespace texgen;

auto conventions() {
#ifndef MISUSE
    return Conventions{DepthRange::zero_to_one, NdcY::up, TextureOrigin::top_left};
#else
    return Conventions{DepthRange::zero_to_one, NdcY::up};
#endif
}
