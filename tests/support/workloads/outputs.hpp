#pragma once

// What is asked of points, segments and triangles: a tolerance, a region, and which outputs.

#include <cstddef>
#include <span>
#include <vector>

#include "texgen/texcoord.hpp"

namespace support::detail {

inline constexpr texgen::Tolerance tolerance = texgen::texels(1.0 / 512.0, 4096.0);

inline texgen::TextureRegion wide_open() { return texgen::atlas_tile({-1e30, -1e30}, {1e30, 1e30}); }
// Whose depth begins at the r of ordinary coordinates, so that r alone can tell.
inline texgen::TextureRegion wide_open_from_half() { return wide_open().with_depth(0.5, 1.0); }

// What is asked of points and segments.
enum class Outputs { all, lit, r, pairs };
struct Asked {
    bool is_exact = true, has_depth = false, is_within = false, is_planar = false;
    Outputs outputs = Outputs::all;

    constexpr texgen::Tolerance tolerance() const { return is_exact ? texgen::exact : detail::tolerance; }
    texgen::TextureRegion region() const { return has_depth ? wide_open_from_half() : texgen::whole_texture(); }
    texgen::Texcoords texcoords(std::vector<float> (&out)[4]) const {
        const auto span = [&](std::size_t i, Outputs alone) {
            return outputs == Outputs::all || outputs == alone ? std::span<float>(out[i]) : std::span<float>();
        };
        return {span(0, Outputs::all), span(1, Outputs::all), span(2, Outputs::r), span(3, Outputs::lit)};
    }
};

}  // namespace support::detail
