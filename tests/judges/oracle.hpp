#pragma once

// The judge: exact rationals. Every float and double is one, so the exact value of a formula of floats is known, and so
// is its nearest float.

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "judges/numbers.hpp"

namespace support {

inline Rational magnitude(const Rational& value) { return value < 0 ? -value : value; }

// The distance between neighbouring Floats where `value` is; that of the subnormals below them.
template <class Float>
int ulp_exponent(const Rational& value) {
    constexpr int lowest = std::numeric_limits<Float>::min_exponent - std::numeric_limits<Float>::digits;
    if (value == 0) return lowest;
    const int exponent = exponent_of(value) - (std::numeric_limits<Float>::digits - 1);
    return exponent < lowest ? lowest : exponent;
}

// |computed - exact| in ulps of `exact`; infinite for NaN, and for an infinity that is not the nearest Float.
template <class Float>
double ulp_error(Float computed, const Rational& exact) {
    if (!(std::fabs(computed) <= std::numeric_limits<Float>::max()))
        return computed == nearest<Float>(exact) ? 0.0 : std::numeric_limits<double>::infinity();
    return nearest<double>(magnitude(exactly(computed) - exact) * power_of_two(-ulp_exponent<Float>(exact)));
}

// |computed - exact|; infinite for NaN and infinity.
inline double absolute_error(double computed, const Rational& exact) {
    if (!(std::fabs(computed) <= std::numeric_limits<double>::max())) return std::numeric_limits<double>::infinity();
    return nearest<double>(magnitude(exactly(computed) - exact));
}

// `steps` floats further up (or down): the neighbours where decisions turn.
inline float neighbour(float value, int steps) {
    const auto ordered = [](std::int32_t bits) {
        return bits < 0 ? std::numeric_limits<std::int32_t>::min() - bits : bits;
    };
    return std::bit_cast<float>(ordered(ordered(std::bit_cast<std::int32_t>(value)) + steps));
}

}  // namespace support
