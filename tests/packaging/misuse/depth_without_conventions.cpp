// a depth from near to far whose conventions nobody named
#include <texgen/conventions.hpp>

using namespace texgen;

TextureRegion lit() {
#ifndef MISUSE
    return whole_texture().with_depth(opengl, DepthMapping::ndc);
#else
    return whole_texture().with_depth(DepthMapping::ndc);
#endif
}
