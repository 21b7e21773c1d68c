// an inverse that was not checked
#include <texgen/linear.hpp>

using namespace texgen;

auto texgen_of(const Projector& projector, const ViewMatrix& view) {
#ifndef MISUSE
    return eye_linear(projector, inverse(view).value());
#else
    return eye_linear(projector, inverse(view));
#endif
}
