// object_linear with the view for a model matrix
#include <texgen/linear.hpp>

using namespace texgen;

auto texgen_of(const Projector& projector, [[maybe_unused]] const ModelMatrix& model,
               [[maybe_unused]] const ViewMatrix& view) {
#ifndef MISUSE
    return object_linear(projector, model);
#else
    return object_linear(projector, view);
#endif
}
