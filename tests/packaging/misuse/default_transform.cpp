// a transform without a value
#include <texgen/transform.hpp>

using namespace texgen;

ModelMatrix model() {
#ifndef MISUSE
    return ModelMatrix(glm::dmat4(1.0));
#else
    return ModelMatrix();
#endif
}
