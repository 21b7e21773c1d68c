#pragma once

// Seeded random numbers that are the same on every platform: the standard's distributions are not.

#include <bit>
#include <cmath>
#include <cstdint>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace support {

// The nearest float, by way of memory: under -mavx, g++ 12 folds four (double)(float)x side by side to x (its
// vectorised form), so that code which is inlined after the rounding goes on with numbers that no float holds.
inline float to_float(double value) {
    const volatile float rounded = static_cast<float>(value);
    return rounded;
}

// Each element rounded to float.
inline glm::mat4 rounded(const glm::dmat4& m) {
    glm::mat4 result;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) result[column][row] = to_float(m[column][row]);
    return result;
}

// splitmix64 (Steele, Lea, Flood 2014).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }

    // In [low, high).
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
    }
    float uniform_float(double low, double high) { return to_float(uniform(low, high)); }

    // 10^uniform(low, high).
    double power_of_ten(double low, double high) { return std::pow(10.0, uniform(low, high)); }

    // In [low, high], both included.
    int integer(int low, int high) {
        return low +
               static_cast<int>(bits() % (static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low) + 1u));
    }

    bool coin() { return (bits() >> 63) != 0u; }

    // Any float: infinities, NaN and subnormals come up.
    float any_float() { return std::bit_cast<float>(static_cast<std::uint32_t>(bits() >> 32)); }
    float any_finite() {
        for (;;)
            if (const float value = any_float(); std::isfinite(value)) return value;
    }

    glm::dvec3 direction() {
        for (;;) {
            const glm::dvec3 v{uniform(-1.0, 1.0), uniform(-1.0, 1.0),
                               uniform(-1.0, 1.0)};  // braces: from left to right
            const double squared = v.x * v.x + v.y * v.y + v.z * v.z;
            if (squared > 0.01 && squared < 1.0) return v / std::sqrt(squared);
        }
    }

    glm::vec3 vector3(double size) {
        return {uniform_float(-size, size), uniform_float(-size, size), uniform_float(-size, size)};
    }
    glm::vec4 vector4(double size) { return {vector3(size), uniform_float(-size, size)}; }

    // Each element by itself.
    glm::dmat4 matrix(double size = 1.0) {
        glm::dmat4 result;
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) result[column][row] = uniform(-size, size);
        return result;
    }

    // A rotation about a random axis.
    glm::dmat4 rotation() {
        const glm::dvec3 a = direction();
        const double angle = uniform(-3.14159, 3.14159);
        const double c = std::cos(angle), s = std::sin(angle), d = 1.0 - c;
        return {{c + d * a.x * a.x, d * a.x * a.y + s * a.z, d * a.x * a.z - s * a.y, 0.0},
                {d * a.x * a.y - s * a.z, c + d * a.y * a.y, d * a.y * a.z + s * a.x, 0.0},
                {d * a.x * a.z + s * a.y, d * a.y * a.z - s * a.x, c + d * a.z * a.z, 0.0},
                {0.0, 0.0, 0.0, 1.0}};
    }

    // A rotation and a translation of at most `distance` along each axis.
    glm::dmat4 rigid(double distance) {
        glm::dmat4 result = rotation();
        result[3] = {uniform(-distance, distance), uniform(-distance, distance), uniform(-distance, distance), 1.0};
        return result;
    }

private:
    std::uint64_t state_;
};

}  // namespace support
