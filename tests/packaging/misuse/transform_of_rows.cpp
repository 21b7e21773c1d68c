// a transform of three rows, as APIs of ray tracing have them, that stand in columns
#include <texgen/transform.hpp>

using namespace texgen;

auto model_of(const glm::mat3x4& rows) {
#ifndef MISUSE
    return ModelMatrix(glm::transpose(rows));
#else
    return ModelMatrix(rows);
#endif
}
