#pragma once

// Numbers as inputs of workloads: read one after another, put together, without a meaning or as a scene has them.

#include <cmath>
#include <cstddef>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "support/limits.hpp"
#include "support/random.hpp"
#include "support/workloads/workload.hpp"
#include "texgen/primitives.hpp"

namespace support::detail {

// Takes numbers one after another.
class Reader {
public:
    explicit Reader(const Numbers& numbers) : next_(numbers.data()) {}

    double real() { return *next_++; }
    float single() { return to_float(real()); }
    glm::vec2 vec2() { return {single(), single()}; }
    glm::vec3 vec3() {
        const float x = single(), y = single(), z = single();
        return {x, y, z};
    }
    glm::vec4 vec4() {
        const float x = single(), y = single(), z = single(), w = single();
        return {x, y, z, w};
    }
    glm::dvec3 dvec3() {
        const double x = real(), y = real(), z = real();
        return {x, y, z};
    }
    glm::dvec4 dvec4() {
        const double x = real(), y = real(), z = real(), w = real();
        return {x, y, z, w};
    }
    glm::dmat4 dmat4() {
        const glm::dvec4 a = dvec4(), b = dvec4(), c = dvec4(), d = dvec4();
        return {a, b, c, d};
    }
    glm::mat4 mat4() { return rounded(dmat4()); }

private:
    const double* next_;
};

inline void put(Numbers& n, float x) { n.push_back(static_cast<double>(x)); }
inline void put(Numbers& n, double x) { n.push_back(x); }
template <glm::length_t N, class T, glm::qualifier Q>
void put(Numbers& n, const glm::vec<N, T, Q>& v) {
    for (glm::length_t i = 0; i < N; ++i) put(n, v[i]);
}
template <class T, glm::qualifier Q>
void put(Numbers& n, const glm::mat<4, 4, T, Q>& m) {
    for (glm::length_t i = 0; i < 4; ++i) put(n, m[i]);
}
inline void put(Numbers& n, const texgen::Triangle& t) {
    for (const texgen::WindowVertex* v : {&t.a, &t.b, &t.c}) {
        put(n, v->window);
        put(n, v->clip_w);
        put(n, v->strq);
    }
}
template <class... Parts>
Numbers numbers(const Parts&... parts) {
    Numbers n;
    (put(n, parts), ...);
    return n;
}

inline double of_touching(const Numbers&) { return limit::touching; }

// Numbers without a meaning

inline double any_float(Random& random) {
    const double sign = random.coin() ? 1.0 : -1.0;
    switch (random.integer(0, 9)) {
        case 0:
            return sign * static_cast<double>(to_float(random.power_of_ten(-44.0, 38.0)));
        case 1:
        case 2:
            return sign * static_cast<double>(to_float(random.power_of_ten(-6.0, 6.0)));
        case 3:
        case 4:
        case 5:
            return 0.125 * static_cast<double>(random.integer(-16, 16));
        default:
            return static_cast<double>(random.uniform_float(-2.0, 2.0));
    }
}
template <std::size_t Count>
Numbers any_numbers(Random& random) {
    Numbers n(Count);
    for (double& x : n) x = any_float(random);
    return n;
}

// Numbers of a scene

// What the limits are about: positions and coordinates of a world, of a camera and of slides as they are. Beyond, where
// floats of all sizes meet in one sum, ties may differ from their middle by less than two doubles hold, and are decided
// one by one.
template <class Number>
bool is_between(Number value, double least, double largest) {
    const double size = std::fabs(static_cast<double>(value));
    return size == 0.0 || (size >= least && size <= largest);
}
template <glm::length_t N, class T, glm::qualifier Q>
bool is_between(const glm::vec<N, T, Q>& v, double least, double largest) {
    bool all = true;
    for (glm::length_t i = 0; i < N; ++i) all = all && is_between(v[i], least, largest);
    return all;
}
// A position, or a coordinate.
template <class Value>
bool is_of_a_scene(const Value& value) {
    return is_between(value, 0x1p-20, 0x1p20);
}
// A matrix, whose zeros may be what rounding makes of them.
inline bool is_of_a_scene(const glm::dmat4& matrix) {
    bool all = true;
    for (glm::length_t i = 0; i < 4; ++i) all = all && is_between(matrix[i], 0x1p-60, 0x1p30);
    return all;
}

inline Numbers ordinary_strq(Random& random) {
    const float q = random.uniform_float(1.0, 4.0);
    return numbers(q * random.uniform_float(0.2, 0.8), q * random.uniform_float(0.2, 0.8), 0.5f * q, q);
}
inline constexpr Inputs strq_inputs{4, ordinary_strq, any_numbers<4>, "drawn: any numbers"};

}  // namespace support::detail
