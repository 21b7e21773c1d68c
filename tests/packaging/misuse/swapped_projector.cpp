// a projector with its view for its projection
#include <texgen/projector.hpp>

using namespace texgen;

auto projector(const ProjectorProjection& projection, const ProjectorView& view) {
#ifndef MISUSE
    return Projector{projection, view, opengl};
#else
    return Projector{view, projection, opengl};
#endif
}
