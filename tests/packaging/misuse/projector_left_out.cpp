// a projector put together without its conventions
#include <texgen/projector.hpp>

using namespace texgen;

auto projector(const ProjectorProjection& projection, const ProjectorView& view) {
#ifndef MISUSE
    return Projector{projection, view, vulkan};
#else
    return Projector{projection, view};
#endif
}
