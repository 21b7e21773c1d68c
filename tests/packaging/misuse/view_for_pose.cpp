// eye_linear with the view for the camera's pose
#include <texgen/linear.hpp>

using namespace texgen;

auto texgen_of(const Projector& projector, const ViewMatrix& view) {
#ifndef MISUSE
    return eye_linear(projector, inverse_rigid(view));
#else
    return eye_linear(projector, view);
#endif
}
