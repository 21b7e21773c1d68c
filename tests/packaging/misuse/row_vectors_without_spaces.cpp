// a matrix of row vectors that does not say its spaces
#include <texgen/transform.hpp>

using namespace texgen;

ViewMatrix view_of(const glm::mat4& row_vectors) {
#ifndef MISUSE
    return from_row_vectors<Eye, World>(row_vectors);
#else
    return from_row_vectors(row_vectors);
#endif
}
