// a picture that covers a lens and does not say its aspect
#include <texgen/projector.hpp>

using namespace texgen;

TextureRegion crop(const PerspectiveLens& lens) {
#ifndef MISUSE
    return cover(lens, 4.0 / 3.0, whole_texture());
#else
    return cover(lens, whole_texture());
#endif
}
