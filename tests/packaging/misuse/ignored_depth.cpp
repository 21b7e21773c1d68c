// a depth that no region keeps
#include <texgen/conventions.hpp>

using namespace texgen;

TextureRegion lit() {
    TextureRegion region = whole_texture();
#ifndef MISUSE
    region = region.with_depth();
#else
    region.with_depth();
#endif
    return region;
}
