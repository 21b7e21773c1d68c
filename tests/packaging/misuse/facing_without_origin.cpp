// the side that the projector sees, with no word on where t grows to
#include <texgen/surface.hpp>

using namespace texgen;

Facing side(glm::vec4 a, glm::vec4 b, glm::vec4 c) {
#ifndef MISUSE
    return facing(a, b, c, TextureOrigin::bottom_left);
#else
    return facing(a, b, c);
#endif
}
