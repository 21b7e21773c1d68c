#pragma once

// The planes of a slide, which all of its culling goes by: q >= 0, and the sides of its region.

#include <array>
#include <cmath>
#include <limits>

#include "../../conventions.hpp"
#include "../language.hpp"

namespace TEXGEN_DETAIL {

// sign (u - bound q) >= 0 for a coordinate u of (s, t, r, q); of q itself it is q >= 0.
struct SlidePlane {
    glm::length_t coordinate;
    double sign, bound;

    // The bound at which the side is none: every point is inside. At its negative none is.
    double none() const noexcept { return -sign * std::numeric_limits<double>::infinity(); }

    double at(double u, double q) const noexcept { return coordinate == 3 ? q : std::fma(-sign * bound, q, sign * u); }
};

// Whether no (s, t) is in a region; so is one with a NaN.
inline bool is_empty(const TextureRegion& region) noexcept {
    return !((region.min)().x <= (region.max)().x && (region.min)().y <= (region.max)().y);
}

inline std::array<SlidePlane, 5> slide_planes(const TextureRegion& region) noexcept {
    const glm::dvec2& min = (region.min)();
    const glm::dvec2& max = (region.max)();
    return {{{3, 1.0, 0.0}, {0, 1.0, min.x}, {0, -1.0, max.x}, {1, 1.0, min.y}, {1, -1.0, max.y}}};
}

}  // namespace TEXGEN_DETAIL
