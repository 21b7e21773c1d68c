#pragma once

// 4x4 matrices of exact rationals.

#include <algorithm>
#include <array>
#include <optional>

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

inline RationalMatrix magnitudes(RationalMatrix m) {
    for (auto& row : m)
        for (Rational& element : row) element = magnitude(element);
    return m;
}

inline RationalMatrix operator*(const RationalMatrix& a, const RationalMatrix& b) {
    RationalMatrix result;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            for (std::size_t k = 0; k < 4; ++k) result[i][j] += a[i][k] * b[k][j];
    return result;
}

// Empty for a singular matrix. By cofactors: the denominators of sums and products of doubles stay powers of two.
inline std::optional<RationalMatrix> inverse(const RationalMatrix& m) {
    RationalMatrix cofactor, result;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            const auto at = [&](std::size_t row, std::size_t column) { return m[(i + row) % 4][(j + column) % 4]; };
            const auto minor_of = [&](std::size_t a, std::size_t b) {
                return at(2, a) * at(3, b) - at(2, b) * at(3, a);
            };
            const Rational value = at(1, 1) * minor_of(2, 3) + at(1, 2) * minor_of(3, 1) + at(1, 3) * minor_of(1, 2);
            cofactor[i][j] = (i + j) % 2 == 0 ? value : -value;
        }
    }
    Rational determinant;
    for (std::size_t j = 0; j < 4; ++j) determinant += m[0][j] * cofactor[0][j];
    if (determinant == 0) return std::nullopt;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) result[j][i] = cofactor[i][j] / determinant;
    return result;
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

// A matrix whose rows and columns are scaled by powers of two, near 1.
struct ScaledMatrix {
    RationalMatrix matrix;
    std::array<int, 4> row_exponent{}, column_exponent{};

    explicit ScaledMatrix(const RationalMatrix& m) : matrix(m) {
        for (int pass = 0; pass < 3; ++pass) {
            for (std::size_t i = 0; i < 4; ++i) {
                Rational row = 0;
                for (std::size_t k = 0; k < 4; ++k) row = std::max(row, magnitude(matrix[i][k]));
                const int exponent = -exponent_of(row);
                for (std::size_t k = 0; k < 4; ++k) matrix[i][k] *= power_of_two(exponent);
                row_exponent[i] += exponent;
            }
            for (std::size_t k = 0; k < 4; ++k) {
                Rational column = 0;
                for (std::size_t i = 0; i < 4; ++i) column = std::max(column, magnitude(matrix[i][k]));
                const int exponent = -exponent_of(column);
                for (std::size_t i = 0; i < 4; ++i) matrix[i][k] *= power_of_two(exponent);
                column_exponent[k] += exponent;
            }
        }
    }
};

// The condition of a regular matrix whose rows and columns are scaled near 1.
inline double scaled_condition(const RationalMatrix& m) {
    const RationalMatrix scaled = ScaledMatrix(m).matrix;
    return nearest<double>(norm(scaled) * norm(*inverse(scaled)));
}

// The largest error of an element of a computed inverse, in double ulps of the largest term in the sum that makes it, X =
// X A X: the terms X_ij A_jk X_kl of element (i, l). Elements are left out whose terms, with rows and columns scaled,
// are below `least`: nothing is said of them.
inline double worst_error_of_inverse(const RationalMatrix& a, const RationalMatrix& computed, const Rational& least) {
    const RationalMatrix exact = *inverse(a);
    const ScaledMatrix scaled(a);
    double worst = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t l = 0; l < 4; ++l) {
            Rational largest = 0;
            for (std::size_t j = 0; j < 4; ++j)
                for (std::size_t k = 0; k < 4; ++k)
                    largest = std::max(largest, magnitude(exact[i][j] * a[j][k] * exact[k][l]));
            const Rational error = magnitude(computed[i][l] - exact[i][l]);
            if (error == 0) continue;
            const int scale = scaled.column_exponent[i] + scaled.row_exponent[l];
            if (largest != 0 && largest < least * power_of_two(scale)) continue;
            worst = std::max(worst, nearest<double>(error * power_of_two(-ulp_exponent<double>(largest))));
        }
    }
    return worst;
}

}  // namespace support
