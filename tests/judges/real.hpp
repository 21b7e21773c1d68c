#pragma once

// The judge where a root or a tangent enters: vectors and matrices of reals.

#include <array>
#include <cmath>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "judges/numbers.hpp"

namespace support {

using RealVector = std::array<Real, 3>;
using RealMatrix = std::array<std::array<Real, 4>, 4>;  // [row][column]

// One unit in the last place of a double of that size.
inline double double_ulp(double value) { return std::nextafter(std::fabs(value), HUGE_VAL) - std::fabs(value); }

inline double error_in_ulps(double computed, const Real& exact) {
    if (!std::isfinite(computed)) return HUGE_VAL;
    const auto rounded = static_cast<double>(exact);
    return static_cast<double>(abs(Real(computed) - exact) / Real(double_ulp(rounded)));
}

inline RealVector real(const glm::dvec3& v) { return {Real(v.x), Real(v.y), Real(v.z)}; }

inline Real dot(const RealVector& a, const RealVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline RealVector cross(const RealVector& a, const RealVector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline RealVector normalized(const RealVector& v) {
    const Real length = sqrt(dot(v, v));
    return {v[0] / length, v[1] / length, v[2] / length};
}

inline RealMatrix identity() {
    RealMatrix result{};
    for (std::size_t i = 0; i < 4; ++i) result[i][i] = 1;
    return result;
}

inline RealMatrix real(const glm::dmat4& m) {
    RealMatrix result;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            result[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] = Real(m[column][row]);
    return result;
}

inline RealMatrix operator*(const RealMatrix& a, const RealMatrix& b) {
    RealMatrix result;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            result[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j] + a[i][3] * b[3][j];
    return result;
}

// gluLookAt, from its definition.
inline RealMatrix look_at(const glm::dvec3& position, const glm::dvec3& target, const glm::dvec3& up) {
    const RealVector eye = real(position), to = real(target);
    const RealVector back = normalized({eye[0] - to[0], eye[1] - to[1], eye[2] - to[2]});
    const RealVector side = normalized(cross(real(up), back));
    const std::array<RealVector, 3> rows{side, cross(back, side), back};
    RealMatrix result = identity();
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) result[row][column] = rows[row][column];
        result[row][3] = -dot(rows[row], eye);
    }
    return result;
}

// gluPerspective's lens in OpenGL's conventions, from its definition; an infinite z_far is the limit.
inline RealMatrix perspective(const Real& fovy, const Real& aspect, const Real& z_near, double z_far) {
    const Real focal_length = 1 / tan(Real(fovy / 2));
    RealMatrix result{};
    result[0][0] = focal_length / aspect;
    result[1][1] = focal_length;
    result[3][2] = -1;
    if (std::isfinite(z_far)) {
        const Real depth = z_near - Real(z_far);
        result[2][2] = (Real(z_far) + z_near) / depth;
        result[2][3] = 2 * Real(z_far) * z_near / depth;
    } else {
        result[2][2] = -1;
        result[2][3] = -2 * z_near;
    }
    return result;
}

// Everitt's scale-bias for the whole texture.
inline RealMatrix scale_bias() {
    RealMatrix result = identity();
    for (std::size_t i = 0; i < 3; ++i) result[i][i] = result[i][3] = Real(0.5);
    return result;
}

}  // namespace support
