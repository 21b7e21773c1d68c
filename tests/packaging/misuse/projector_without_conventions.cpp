// a made projector without conventions
#include <texgen/projector.hpp>

using namespace texgen;

auto projector(const PerspectiveLens& lens, const Aim& aim) {
#ifndef MISUSE
    return make_projector(lens, aim, vulkan);
#else
    return make_projector(lens, aim);
#endif
}
