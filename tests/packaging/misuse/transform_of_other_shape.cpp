// a transform of a matrix of three rows
#include <texgen/transform.hpp>

using namespace texgen;

auto model_of(const glm::mat4x3& three_rows) {
#ifndef MISUSE
    return ModelMatrix(glm::mat4(three_rows));
#else
    return ModelMatrix(three_rows);
#endif
}
