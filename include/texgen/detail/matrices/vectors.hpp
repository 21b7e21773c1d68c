#pragma once

// Vectors of doubles as the matrices need them: where range, cancellation or bits matter. Sums of products are fused by
// hand: a compiler that fuses where it likes would make the bits depend on what is inlined.

#include <cmath>

#include <glm/vec3.hpp>

#include "../arithmetic/inverse.hpp"
#include "../arithmetic/rounding.hpp"
#include "../language.hpp"

namespace TEXGEN_DETAIL {

inline double length(const glm::dvec3& v) noexcept {
    return std::sqrt(std::fma(v.z, v.z, std::fma(v.y, v.y, v.x * v.x)));
}

// Each component within 1.5 ulp, however its products cancel.
inline glm::dvec3 cross(const glm::dvec3& a, const glm::dvec3& b) noexcept {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}

// The magnitude of the largest component; NaN counts only where all are.
inline double largest(const glm::dvec3& v) noexcept {
    return std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z)));
}

inline glm::dvec3 times_power_of_two(const glm::dvec3& v, int exponent) noexcept {
    return {times_power_of_two(v.x, exponent), times_power_of_two(v.y, exponent), times_power_of_two(v.z, exponent)};
}

// v times a power of two, so that its largest component is in [1, 2); 0 for zero and for what is not finite.
inline glm::dvec3 scaled_near_one(const glm::dvec3& v) noexcept {
    if (!is_finite(v)) return glm::dvec3(0.0);
    return largest(v) > 0.0 ? times_power_of_two(v, -exponent_of(largest(v))) : v;
}

// v / |v| for a v near 1. The length is that of the exact squares, rounded once, so that it adds next to no error.
inline glm::dvec3 normalized(const glm::dvec3& v) noexcept {
    DoubleDouble square{0.0, 0.0};
    for (glm::length_t i = 0; i < 3; ++i) square = add_product(square, v[i], v[i]);
    const double root = std::sqrt(square.high);
    return v / (root + 0.5 * (std::fma(-root, root, square.high) + square.low) / root);
}

}  // namespace TEXGEN_DETAIL
