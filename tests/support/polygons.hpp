// The corners of a clipped polygon: their bits, and how a failing input is printed.

#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "support/hex.hpp"
#include "texgen/clip.hpp"

namespace support {

using Polygon = std::vector<texgen::ClipVertex>;
using Bits = std::array<std::uint32_t, 8>;

inline Bits bits(const texgen::ClipVertex& v) {
    Bits result{};
    for (std::size_t i = 0; i < 4; ++i) {
        result[i] = std::bit_cast<std::uint32_t>(v.position[static_cast<int>(i)]);
        result[i + 4] = std::bit_cast<std::uint32_t>(v.strq[static_cast<int>(i)]);
    }
    return result;
}

inline std::vector<Bits> bits(const Polygon& polygon) {
    std::vector<Bits> result;
    for (const texgen::ClipVertex& v : polygon) result.push_back(bits(v));
    return result;
}

inline std::string hex_of(const Polygon& polygon) {
    std::string text;
    for (const texgen::ClipVertex& v : polygon) text += hex(v.position) + " " + hex(v.strq) + "; ";
    return text;
}

}  // namespace support
