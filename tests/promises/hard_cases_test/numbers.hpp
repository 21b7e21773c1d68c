#pragma once

// The numbers of hard_cases.jsonl, as the library and the judges take them.

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <string>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "judges/numbers.hpp"
#include "support/json.hpp"

namespace hard_cases {

using support::Json;
using support::Rational;

inline float as_float(const Json& json) {
    const double value = json.number();
    REQUIRE((std::isnan(value) || static_cast<double>(static_cast<float>(value)) == value));
    return static_cast<float>(value);
}

inline glm::vec4 as_vector(const Json& json) {
    return {as_float(json[0]), as_float(json[1]), as_float(json[2]), as_float(json[3])};
}

inline glm::dvec3 as_point(const Json& json) { return {as_float(json[0]), as_float(json[1]), as_float(json[2])}; }

inline glm::dmat4 from_rows(const Json& json) {
    glm::dmat4 m(0.0);
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            m[column][row] = as_float(json[static_cast<std::size_t>(4 * row + column)]);
    return m;
}

// "-3e/b" and "0", hexadecimal.
inline Rational as_rational(const Json& json) {
    std::string text = json.text;
    if (const std::size_t slash = text.find('/'); slash != std::string::npos) text.insert(slash + 1, "0x");
    return Rational(text.insert(text.front() == '-' ? 1 : 0, "0x"));
}

}  // namespace hard_cases
