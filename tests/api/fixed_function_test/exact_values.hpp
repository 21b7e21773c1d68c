#pragma once

// The same mathematics in other numbers: an exact inverse in rationals, the modes in long double.

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "judges/rational_matrix.hpp"

namespace fixed_function_cases {

using support::Rational;
using support::RationalMatrix;

// Empty exactly where M is singular.
inline std::optional<RationalMatrix> exact_inverse(const glm::mat4& m) {
    return support::inverse(support::exactly(glm::dmat4(m)));
}

using LongVector = std::array<long double, 4>;
using LongMatrix = std::array<LongVector, 4>;  // [row][column]

// Nearer than a rounding of long double: high part and rest.
inline long double to_long(const Rational& value) {
    const double high = nearest<double>(value);
    if (!std::isfinite(high)) return static_cast<long double>(high);
    const Rational rest = value - Rational(high);
    return static_cast<long double>(high) + static_cast<long double>(nearest<double>(rest));
}

inline LongMatrix to_long(const RationalMatrix& m) {
    LongMatrix result{};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) result[i][j] = to_long(m[i][j]);
    return result;
}

inline LongVector row_times(const glm::vec4& row, const RationalMatrix& m) {
    LongVector result{};
    for (std::size_t j = 0; j < 4; ++j) {
        Rational sum = 0;
        for (std::size_t i = 0; i < 4; ++i) sum += Rational(static_cast<double>(row[static_cast<int>(i)])) * m[i][j];
        result[j] = to_long(sum);
    }
    return result;
}

// |value - exact| in units of the last place of exact as a float.
inline long double ulps(float value, long double exact) {
    int exponent = 0;
    (void)std::frexp(exact, &exponent);
    const long double ulp = std::ldexp(1.0L, (exact == 0.0L || exponent < -125 ? -125 : exponent) - 24);
    return std::fabs(static_cast<long double>(value) - exact) / ulp;
}

// As ulps(), less what `slack` and the rounding in double explain.
inline long double excess_ulps(float value, long double exact, long double slack) {
    const long double error = std::fabs(static_cast<long double>(value) - exact);
    const long double explained = slack + 0x1p-50L * std::fabs(exact);
    return error <= explained ? 0.0L : ulps(value, exact) * (error - explained) / error;
}

inline LongVector times(const glm::mat4& m, const glm::vec4& v) {
    LongVector result{};
    for (std::size_t i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k)
            result[i] += static_cast<long double>(m[k][static_cast<int>(i)]) * static_cast<long double>(v[k]);
    return result;
}

}  // namespace fixed_function_cases
