#pragma once

// Units of one mode, and matrices for them.

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "support/fixed_function.hpp"
#include "support/random.hpp"

namespace fixed_function_cases {

using support::Coordinate;
using support::coordinates;
using support::NormalScaling;
using support::Random;
using support::rounded;
using support::TexGenMode;
using support::TexGenUnit;
using texgen::FixedFunctionVertex;

inline const glm::mat4 identity(1.0f);

inline glm::mat4 translation(float x, float y, float z) {
    glm::mat4 result(1.0f);
    result[3] = {x, y, z, 1.0f};
    return result;
}

inline glm::mat4 scale(float x, float y, float z, float w = 1.0f) {
    glm::mat4 result(1.0f);
    result[0][0] = x;
    result[1][1] = y;
    result[2][2] = z;
    result[3][3] = w;
    return result;
}

// A unit with the same mode on every coordinate that takes it.
inline TexGenUnit unit_with(TexGenMode mode, NormalScaling scaling = NormalScaling::none) {
    TexGenUnit unit;
    for (const Coordinate coordinate : coordinates)
        if (unit.set_mode(coordinate, mode)) unit.enable(coordinate);
    unit.set_normal_scaling(scaling);
    return unit;
}

// Every way in which a small matrix of integers can fail to have an inverse; all are exact as floats.
inline glm::mat4 random_singular(Random& random, int kind) {
    const auto small = [&random] { return static_cast<float>(random.integer(-9, 9)); };
    glm::mat4 m;
    for (int column = 0; column < 4; ++column) m[column] = {small(), small(), small(), small()};
    const int a = random.integer(0, 3);
    const int b = (a + random.integer(1, 3)) % 4;
    switch (kind) {
        case 0:  // two equal columns
            m[a] = m[b];
            break;
        case 1:  // two equal rows
            for (int column = 0; column < 4; ++column) m[column][a] = m[column][b];
            break;
        case 2:  // a zero column
            m[a] = glm::vec4(0.0f);
            break;
        case 3:  // a zero row
            for (int column = 0; column < 4; ++column) m[column][a] = 0.0f;
            break;
        case 4:  // a row is a combination of the others
            for (int column = 0; column < 4; ++column) {
                m[column][a] = 0.0f;
                for (int row = 0; row < 4; ++row)
                    if (row != a) m[column][a] += static_cast<float>(row + 2) * m[column][row];
            }
            break;
        default: {  // the product of two factors of rank 3, 2 or 1
            const int rank = random.integer(1, 3);
            const glm::mat4 left = m;
            m = glm::mat4(0.0f);
            for (int k = 0; k < rank; ++k)
                for (int column = 0; column < 4; ++column) m[column] += left[k] * small();
        }
    }
    return m;
}

}  // namespace fixed_function_cases
