// a depth mapping in the place of the conventions that say what it maps
#include <texgen/conventions.hpp>

using namespace texgen;

TextureRegion lit() {
#ifndef MISUSE
    return whole_texture().with_depth(direct3d, DepthMapping::unit);
#else
    return whole_texture().with_depth(DepthMapping::unit, direct3d);
#endif
}
