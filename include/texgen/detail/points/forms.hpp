#pragma once

// A row of a texgen matrix as a linear form of points with w = 1: its value with a bound, exactly, and accurately.

#include <cmath>
#include <type_traits>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "../arithmetic/expansion.hpp"
#include "../arithmetic/rounding.hpp"
#include "../language.hpp"
#include "../simd/jobs.hpp"

namespace TEXGEN_DETAIL {

// Whether GLM would make a vec3 of a vector without a word, and lose a w or the digits of doubles.
template <class Vector>
inline constexpr bool is_more_than_vec3 = false;
template <glm::length_t Length, class Number, glm::qualifier Q>
inline constexpr bool is_more_than_vec3<glm::vec<Length, Number, Q>> = Length != 3 || !std::is_same_v<Number, float>;
template <class Vector>
concept MoreThanVec3 = is_more_than_vec3<Vector>;

inline PointForm form(const glm::dmat4& matrix, int row) noexcept {
    const auto i = static_cast<glm::length_t>(row);
    return {matrix[0][i], matrix[1][i], matrix[2][i], matrix[3][i]};
}

// The sum of the terms' magnitudes.
inline double terms_at(const PointForm& form, const glm::dvec3& v) noexcept {
    return std::fabs(form.x * v.x) + std::fabs(form.y * v.y) + std::fabs(form.z * v.z) + std::fabs(form.w);
}

// Three products and three sums: each term is rounded four times at most.
inline Bounded value_at(const PointForm& form, const glm::dvec3& v) noexcept {
    return {form.x * v.x + form.y * v.y + form.z * v.z + form.w, gamma(5) * terms_at(form, v)};
}

inline Expansion<8> exactly_at(const PointForm& form, const glm::dvec3& v) noexcept {
    Expansion<8> sum;
    sum.add_product(form.x, v.x);
    sum.add_product(form.y, v.y);
    sum.add_product(form.z, v.z);
    sum.add(form.w);
    return sum;
}

// Whether a product is so small that the rounding error it leaves may be no double.
inline bool has_small_product(const PointForm& form, const glm::dvec3& v) noexcept {
    const auto is_small = [](double a, double b) { return a != 0.0 && b != 0.0 && std::fabs(a * b) < 0x1p-900; };
    return is_small(form.x, v.x) || is_small(form.y, v.y) || is_small(form.z, v.z);
}

// The value with an error that is small beside it: from the exact sum where the terms cancel. A NaN or an infinity
// stays one in the error, which is infinite where products are too small to be bounded.
inline Bounded accurately_at(const PointForm& form, const glm::dvec3& v) noexcept {
    if (has_small_product(form, v)) return {0.0, infinity};
    const Bounded close = value_at(form, v);
    if (std::fabs(close.value) > 0x1p20 * close.error || !(close.error < 0x1p1000)) return close;
    const double value = exactly_at(form, v).estimate();
    return {value, 0x1p-48 * std::fabs(value)};
}

}  // namespace TEXGEN_DETAIL
