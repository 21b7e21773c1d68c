#pragma once

// The region in floats: which (s, t, r) are lit, and which real numbers are once they are rounded.

#include <cmath>
#include <cstddef>

#include "../../conventions.hpp"
#include "../arithmetic/nearest.hpp"
#include "../arithmetic/widen.hpp"
#include "../language.hpp"

namespace TEXGEN_DETAIL {

// Whether (s, t) is inside the closed region of these floats. A NaN is not.
inline bool is_inside(float s, float t, const float (&min)[2], const float (&max)[2]) noexcept {
    return s >= min[0] && s <= max[0] && t >= min[1] && t <= max[1];
}

// What rounding makes of a side of a region. A number beyond `outer` is outside the side, and so is the float that it
// is rounded to; one not beyond `inner` is inside, and so is its float. They are the last float outside and the first
// one inside, because rounding keeps the order and leaves floats as they are. Next to 0 both leave room for subnormal
// floats that count as 0. An infinite side stays where it is; a min below all floats has an infinite `outer`.
struct RoundedSide {
    double outer, inner;

    static RoundedSide of_min(double min) noexcept {
        if (!(std::fabs(min) < infinity)) return {min, min};
        const float first = float_at_least(min);
        if (std::fabs(min) < 0x1p-126) return {-0x1p-126, first > 0.0f ? 0x1p-126 : widened(first)};
        return {widened(float_before(first)), widened(first)};
    }
};

// The error that a kernel may make: 0 for exact, and never so much that a float could leave its range.
constexpr double accepted(const Tolerance& tolerance) noexcept {
    return tolerance.value > 0.0 ? (tolerance.value < 0x1p100 ? tolerance.value : 0x1p100) : 0.0;
}

// The closed region in floats: a float is inside the region exactly when it is inside these.
struct LitTest {
    float min[2], max[2];
    // Whether the four sides of s and t are finite, and no further apart than those of the largest textures.
    bool is_narrow, has_depth;
    float r_min = 0.0f, r_max = 0.0f;  // of a depth

    explicit LitTest(const TextureRegion& region) noexcept
        : min{float_at_least((region.min)().x), float_at_least((region.min)().y)},
          max{-float_at_least(-(region.max)().x), -float_at_least(-(region.max)().y)},
          is_narrow(std::fabs(widened(max[0]) - widened(min[0])) + std::fabs(widened(max[1]) - widened(min[1])) <
                    0x1p16),
          has_depth(region.depth().has_value()) {
        if (!has_depth) return;
        r_min = float_at_least(region.depth()->x);
        r_max = -float_at_least(-region.depth()->y);
    }

    // The bounds of s (0) and of t (1).
    double least(std::size_t coordinate) const noexcept { return widened(read_alone(min[coordinate])); }
    double greatest(std::size_t coordinate) const noexcept { return widened(read_alone(max[coordinate])); }

    // The sides of s and t as the kernels take them.
    void copy_to(float (&to_min)[2], float (&to_max)[2]) const noexcept {
        for (std::size_t k = 0; k < 2; ++k) {
            to_min[k] = min[k];
            to_max[k] = max[k];
        }
    }
};

}  // namespace TEXGEN_DETAIL
