#pragma once

// A matrix of numbers that are drawn one by one.

#include <glm/mat4x4.hpp>

#include "support/random.hpp"

namespace transform_cases {

using support::Random;

inline glm::dmat4 random_matrix(Random& random, double size = 1.0) {
    glm::dmat4 m(0.0);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) m[column][row] = random.uniform(-size, size);
    return m;
}

}  // namespace transform_cases
