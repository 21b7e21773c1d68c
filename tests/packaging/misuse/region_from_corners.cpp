// a region whose unit nobody named
#include <texgen/conventions.hpp>

using namespace texgen;

TextureRegion tile() {
#ifndef MISUSE
    return atlas_tile({0.0, 0.0}, {0.5, 0.5});
#else
    return {{0.0, 0.0}, {0.5, 0.5}};
#endif
}
