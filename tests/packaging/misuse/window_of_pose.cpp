// a camera's pose given for the camera, whose lens and conventions its window depends on
#include <texgen/linear.hpp>

using namespace texgen;

auto texgen_of(const Projector& projector, const Projector& camera, [[maybe_unused]] const CameraPose& pose) {
#ifndef MISUSE
    return window_linear(projector, camera, {0, 0, 640, 480});
#else
    return window_linear(projector, pose, {0, 0, 640, 480});
#endif
}
