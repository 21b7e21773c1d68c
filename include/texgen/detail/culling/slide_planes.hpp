#pragma once

// The planes of a slide: where its region ends, and q = 0.

#include <array>
#include <cstddef>

#include "../../conventions.hpp"
#include "../language.hpp"

namespace TEXGEN_DETAIL {

// sign (u - bound q) >= 0 for a coordinate u of (s, t, r, q).
struct SlidePlane {
    glm::length_t coordinate;
    double sign, bound;
};

// The sides s_min, s_max, t_min, t_max, and q.
inline constexpr std::size_t slide_plane_count = 5;

inline std::array<SlidePlane, slide_plane_count> slide_planes(const TextureRegion& region) noexcept {
    const glm::dvec2& min = (region.min)();
    const glm::dvec2& max = (region.max)();
    return {{{0, 1.0, min.x}, {0, -1.0, max.x}, {1, 1.0, min.y}, {1, -1.0, max.y}, {3, 1.0, 0.0}}};
}

}  // namespace TEXGEN_DETAIL
