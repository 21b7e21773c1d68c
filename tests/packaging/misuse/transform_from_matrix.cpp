// a plain matrix where a transform is wanted
#include <texgen/linear.hpp>

using namespace texgen;

auto texgen_of(const Projector& projector, const glm::mat4& model) {
#ifndef MISUSE
    return object_linear(projector, ModelMatrix(model));
#else
    return object_linear(projector, model);
#endif
}
