// a transform renamed to other spaces
#include <texgen/transform.hpp>

using namespace texgen;

ModelMatrix model(const ModelMatrix& model, [[maybe_unused]] const ViewMatrix& view) {
#ifndef MISUSE
    return ModelMatrix(model);
#else
    return ModelMatrix(view);
#endif
}
