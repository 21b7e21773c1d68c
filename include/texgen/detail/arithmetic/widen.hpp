#pragma once

// Widens the very float that was given to double. g++ 12 from -O2 on takes (double)(float)x of two or four neighbours
// for x itself: where a caller rounds to float and a function that widens is inlined behind it, the rounding is lost,
// and the results are not those of the floats. Reading it as a volatile keeps the rounding; the reference lets a float
// in memory be read there, without being stored once more. For set-ups and single points; loops over arrays load their
// floats from memory, and need none of this.

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "../language.hpp"

namespace TEXGEN_DETAIL {

inline double widened(const float& value) noexcept {
    const volatile float& given = value;
    return static_cast<double>(given);
}

inline glm::dvec3 widened(const glm::vec3& v) noexcept { return {widened(v.x), widened(v.y), widened(v.z)}; }

inline glm::dvec4 widened(const glm::vec4& v) noexcept {
    return {widened(v.x), widened(v.y), widened(v.z), widened(v.w)};
}

inline glm::dmat4 widened(const glm::mat4& m) noexcept {
    return {widened(m[0]), widened(m[1]), widened(m[2]), widened(m[3])};
}

}  // namespace TEXGEN_DETAIL
