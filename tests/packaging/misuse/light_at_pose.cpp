// a light that the camera carries, by the projector's view from the world
#include <texgen/linear.hpp>

using namespace texgen;

auto texgen_of(const Projector& projector, const CameraPose& pose) {
#ifndef MISUSE
    return eye_linear(projector.projection, projector.view * pose, projector.conventions);
#else
    return eye_linear(projector.projection, projector.view, projector.conventions);
#endif
}
