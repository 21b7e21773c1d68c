#pragma once

// 4x4 matrices of exact rationals.

#include <array>
#include <optional>
#include <utility>

#include <glm/mat4x4.hpp>

#include "judges/oracle.hpp"

namespace support {

using RationalMatrix = std::array<std::array<Rational, 4>, 4>;  // [row][column]

inline RationalMatrix exactly(const glm::dmat4& m) {
    RationalMatrix result;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            result[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] = exactly(m[column][row]);
    return result;
}

inline RationalMatrix operator*(const RationalMatrix& a, const RationalMatrix& b) {
    RationalMatrix result;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            for (std::size_t k = 0; k < 4; ++k) result[i][j] += a[i][k] * b[k][j];
    return result;
}

// Gauss-Jordan; empty for a singular matrix.
inline std::optional<RationalMatrix> inverse(RationalMatrix left) {
    RationalMatrix right;
    for (std::size_t i = 0; i < 4; ++i) right[i][i] = 1;
    for (std::size_t column = 0; column < 4; ++column) {
        std::size_t pivot = column;
        while (pivot < 4 && left[pivot][column] == 0) ++pivot;
        if (pivot == 4) return std::nullopt;
        std::swap(left[pivot], left[column]);
        std::swap(right[pivot], right[column]);
        const Rational divisor = left[column][column];
        for (std::size_t k = 0; k < 4; ++k) {
            left[column][k] /= divisor;
            right[column][k] /= divisor;
        }
        for (std::size_t row = 0; row < 4; ++row) {
            if (row == column) continue;
            const Rational factor = left[row][column];
            for (std::size_t k = 0; k < 4; ++k) {
                left[row][k] -= factor * left[column][k];
                right[row][k] -= factor * right[column][k];
            }
        }
    }
    return right;
}

// The largest row sum of magnitudes.
inline Rational norm(const RationalMatrix& m) {
    Rational largest = 0;
    for (const auto& row : m) {
        Rational sum = 0;
        for (const Rational& element : row) sum += magnitude(element);
        if (sum > largest) largest = sum;
    }
    return largest;
}

}  // namespace support
