#pragma once

// How far a computed coordinate is from the exact one.

#include <algorithm>
#include <cmath>
#include <limits>

namespace report {

constexpr double texture_size = 4096;           // of the texture whose texels errors are counted in
constexpr double promised_ulp = 0.5 + 0x1p-16;  // half an ulp, and room for the rounding of what it is judged by

// NaN counts as the worst error there is.
inline double finite(double error) { return error <= 1e30 ? error : 1e30; }

inline double in_ulp(double error, double exact) {
    const int exponent = std::max(std::ilogb(exact), std::numeric_limits<float>::min_exponent - 1);
    return std::fabs(error) / std::ldexp(1.0, exponent - 23);
}

}  // namespace report
