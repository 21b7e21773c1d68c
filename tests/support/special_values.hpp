// What is no number, and what is no finite one.
#pragma once

#include <limits>

namespace support {

inline constexpr float nan_float = std::numeric_limits<float>::quiet_NaN();
inline constexpr double nan_double = std::numeric_limits<double>::quiet_NaN();
inline constexpr float infinity_float = std::numeric_limits<float>::infinity();
inline constexpr double infinity_double = std::numeric_limits<double>::infinity();

}  // namespace support
