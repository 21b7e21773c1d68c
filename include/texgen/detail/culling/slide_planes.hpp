#pragma once

// The planes of a slide, which all of its culling goes by: q >= 0, the sides of its region and the limits of its depth.

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <glm/vec2.hpp>

#include "../../conventions.hpp"
#include "../arithmetic/rounding.hpp"
#include "../language.hpp"

namespace TEXGEN_DETAIL {

// sign (u - bound q) >= 0 for a coordinate u of (s, t, r, q); for q itself it is q >= 0.
struct SlidePlane {
    glm::length_t coordinate;
    double sign, bound;

    // The infinite bound for which all points are inside; for its negative none is.
    double none() const noexcept { return -sign * infinity; }

    double at(double u, double q) const noexcept {
        const bool is_q = coordinate == 3 || (coordinate == 2 && bound == none());
        return is_q ? q : std::fma(-sign * bound, q, sign * u);
    }
};

// Whether no (s, t, r) is in a region; none is where a side is a NaN.
inline bool is_empty(const TextureRegion& region) noexcept {
    const std::optional<glm::dvec2> depth = region.depth();
    return !((region.min)().x <= (region.max)().x && (region.min)().y <= (region.max)().y) ||
           (depth && !(depth->x <= depth->y));
}

// q >= 0, the sides of s (min, max) and of t, and of r where the region has a depth. An infinite side is no limit.
class SlidePlanes {
public:
    static constexpr std::size_t without_depth = 5;
    static constexpr std::size_t max_size = 7;

    explicit SlidePlanes(const TextureRegion& region) noexcept {
        add(3, 1.0, 0.0);
        add_both(0, (region.min)().x, (region.max)().x);
        add_both(1, (region.min)().y, (region.max)().y);
        if (const std::optional<glm::dvec2> depth = region.depth()) add_both(2, depth->x, depth->y);
    }

    std::size_t size() const noexcept { return size_; }
    const SlidePlane* begin() const noexcept { return planes_.data(); }
    const SlidePlane* end() const noexcept { return planes_.data() + size_; }
    const SlidePlane& operator[](std::size_t k) const noexcept { return planes_[k]; }

private:
    void add(glm::length_t coordinate, double sign, double bound) noexcept {
        planes_[size_++] = {coordinate, sign, bound};
    }
    void add_both(glm::length_t coordinate, double min, double max) noexcept {
        add(coordinate, 1.0, min);
        add(coordinate, -1.0, max);
    }

    std::array<SlidePlane, max_size> planes_;
    std::size_t size_ = 0;
};

}  // namespace TEXGEN_DETAIL
