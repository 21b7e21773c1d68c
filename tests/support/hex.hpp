#pragma once

// Failing inputs, numbers in hexadecimal, so that they can be run again bit for bit.

#include <cmath>
#include <cstdio>
#include <string>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "texgen/conventions.hpp"

namespace support {

inline std::string hex(double value) {
    char text[64];
    std::snprintf(text, sizeof text, "%a", value);
    return text;
}
inline std::string hex(float value) { return hex(static_cast<double>(value)); }

template <glm::length_t N, class T, glm::qualifier Q>
std::string hex(const glm::vec<N, T, Q>& v) {
    std::string text = "(";
    for (glm::length_t i = 0; i < N; ++i) text += (i == 0 ? "" : ", ") + hex(v[i]);
    return text + ")";
}

// Column by column, as GLM's constructors take them.
template <glm::length_t C, glm::length_t R, class T, glm::qualifier Q>
std::string hex(const glm::mat<C, R, T, Q>& m) {
    std::string text = "{";
    for (glm::length_t i = 0; i < C; ++i) text += (i == 0 ? "" : ", ") + hex(m[i]);
    return text + "}";
}

inline std::string hex(const texgen::TextureRegion& region) {
    const std::string sides = "region " + hex(region.min()) + " to " + hex(region.max());
    return region.depth() ? sides + ", depth " + hex(*region.depth()) : sides;
}

inline std::string text(const texgen::Conventions& c) {
    return std::string(c.depth == texgen::DepthRange::zero_to_one ? "depth 0..1" : "depth -1..1") +
           (c.ndc_y == texgen::NdcY::up ? ", y up" : ", y down") +
           (c.origin == texgen::TextureOrigin::top_left ? ", origin top left" : ", origin bottom left") +
           (c.handedness == texgen::Handedness::left ? ", left-handed" : ", right-handed");
}

// The largest of many errors, which a NaN is as well, and the input that has it.
struct Worst {
    double error = 0.0;
    std::string input;

    template <class Describe>
    void take(double other, const Describe& describe) {
        if (other <= error) return;
        error = std::isnan(other) ? HUGE_VAL : other;
        input = describe();
    }
};

}  // namespace support
