#pragma once

// libFuzzer's bytes as the arguments of functions, and what a target says when a promise is broken.

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <span>
#include <string>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "texgen/conventions.hpp"
#include "texgen/primitives.hpp"

namespace fuzz {

// Stops at a broken promise: libFuzzer keeps the input.
inline void must(bool holds, const char* promise) {
    if (holds) return;
    std::fprintf(stderr, "broken: %s\n", promise);
    std::abort();
}
inline void must_be_right(const std::string& wrong) { must(wrong.empty(), wrong.c_str()); }

// Reads the bytes from the front; behind the last one all are 0.
class Input {
public:
    Input(const std::uint8_t* data, std::size_t size) : data_(data, size) {}

    bool empty() const { return data_.empty(); }

    template <class T>
    T raw() {
        unsigned char bytes[sizeof(T)] = {};
        const std::size_t count = data_.size() < sizeof(T) ? data_.size() : sizeof(T);
        if (count != 0) std::memcpy(bytes, data_.data(), count);
        data_ = data_.subspan(count);
        return std::bit_cast<T>(bytes);
    }

    // In [low, high].
    int integer(int low, int high) {
        const auto range = static_cast<std::uint64_t>(std::int64_t{high} - low) + 1u;
        const std::uint64_t drawn = range <= 256u ? raw<std::uint8_t>() : raw<std::uint32_t>();
        return static_cast<int>(low + static_cast<std::int64_t>(drawn % range));
    }
    std::size_t size(int high) { return static_cast<std::size_t>(integer(0, high)); }
    bool coin() { return (raw<std::uint8_t>() & 1u) != 0u; }

    // Any bits; small numbers, and the numbers beside those that came before, where the interesting cases are.
    float number() {
        switch (raw<std::uint8_t>() % 6u) {
            case 0:
                last_ = raw<float>();
                break;
            case 1: {
                static constexpr float infinity = std::numeric_limits<float>::infinity();
                static constexpr float special[] = {0.0f,      -0.0f,     1.0f,
                                                    -1.0f,     0.5f,      2.0f,
                                                    0x1p-149f, 0x1p-126f, 0x1.fffffep127f,
                                                    infinity,  -infinity, std::numeric_limits<float>::quiet_NaN()};
                last_ = special[raw<std::uint8_t>() % std::size(special)];
                break;
            }
            case 2:
                last_ = std::bit_cast<float>(std::bit_cast<std::uint32_t>(last_) + raw<std::uint8_t>() - 128u);
                break;
            case 3:
                last_ = -last_;
                break;
            default:
                last_ = static_cast<float>(raw<std::int16_t>()) * 0x1p-8f;
                break;
        }
        return last_;
    }
    double wide_number() { return coin() ? raw<double>() : static_cast<double>(number()); }

    glm::vec3 vector3() {
        glm::vec3 v{};
        for (int i = 0; i < 3; ++i) v[i] = number();
        return v;
    }
    glm::vec4 vector4() {
        glm::vec4 v{};
        for (int i = 0; i < 4; ++i) v[i] = number();
        return v;
    }
    glm::dvec3 wide_vector3() {
        glm::dvec3 v{};
        for (int i = 0; i < 3; ++i) v[i] = wide_number();
        return v;
    }
    glm::mat4 matrix() {
        glm::mat4 m(1.0f);
        for (int i = 0; i < 4; ++i) m[i] = vector4();
        return m;
    }
    glm::dmat4 wide_matrix() {
        glm::dmat4 m(1.0);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) m[column][row] = wide_number();
        return m;
    }

    texgen::Conventions conventions() {
        const unsigned bits = raw<std::uint8_t>();
        return {(bits & 1u) != 0u ? texgen::DepthRange::zero_to_one : texgen::DepthRange::negative_one_to_one,
                (bits & 2u) != 0u ? texgen::NdcY::down : texgen::NdcY::up,
                (bits & 4u) != 0u ? texgen::TextureOrigin::top_left : texgen::TextureOrigin::bottom_left,
                (bits & 8u) != 0u ? texgen::Handedness::left : texgen::Handedness::right};
    }
    texgen::TextureRegion region() {
        switch (integer(0, 3)) {
            case 0:
                return texgen::whole_texture();
            case 1: {
                const double width = wide_number();
                return texgen::rectangle_texture(width, wide_number());
            }
            default: {
                double side[4];
                for (double& s : side) s = wide_number();
                return texgen::atlas_tile({side[0], side[1]}, {side[2], side[3]});
            }
        }
    }
    texgen::TextureRegion region_with_depth() {
        const texgen::TextureRegion sides = region();
        switch (integer(0, 2)) {
            case 0:
                return sides;
            case 1:
                return sides.with_depth();
            default: {
                const double r_min = wide_number();
                return sides.with_depth(r_min, wide_number());
            }
        }
    }
    texgen::Tolerance tolerance() {
        switch (integer(0, 2)) {
            case 0:
                return texgen::exact;
            case 1:
                return {std::ldexp(1.0, integer(-40, 20))};
            default:
                return {wide_number()};
        }
    }

    texgen::WindowVertex vertex() {
        const float x = number(), y = number();
        return {{x, y}, coin() ? 1.0f + static_cast<float>(integer(0, 255)) : number(), vector4()};
    }

private:
    std::span<const std::uint8_t> data_;
    float last_ = 0.0f;
};

inline bool all_finite(const glm::dmat4& m) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(m[column][row])) return false;
    return true;
}
inline bool all_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
inline bool all_finite(const glm::vec4& v) { return all_finite(glm::vec3(v)) && std::isfinite(v.w); }

// One float and another, NaN for NaN.
inline bool same(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || (std::isnan(a) && std::isnan(b));
}
inline bool same(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}
inline bool same(const glm::vec4& a, const glm::vec4& b) {
    return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z) && same(a.w, b.w);
}

}  // namespace fuzz
