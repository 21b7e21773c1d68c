#pragma once

// Floor 0: what the numbers mean. Every convention is said once, here, and carried by the values that depend on it.

#include "detail/language.hpp"

#include <numbers>
#include <optional>

#include <glm/vec2.hpp>

#include "detail/matrices/required.hpp"

// 0.4.38: 10000 major + 100 minor + patch.
#define TEXGEN_VERSION 438

namespace TEXGEN_NAMESPACE {

enum class DepthRange { negative_one_to_one, zero_to_one };  // NDC depth of the near and of the far plane
enum class NdcY { up, down };                                // where y grows to in NDC
enum class TextureOrigin { bottom_left, top_left };          // the corner of the picture that (s, t) = (0, 0) addresses

// The handedness of the world and of the projector's eye, whose x is to the right and whose y is up: a right-handed eye
// looks down -z, a left-handed one down +z.
enum class Handedness { right, left };

// Three independent choices of a graphics API, and the world's handedness. There is no default: the caller says which
// ones the numbers follow.
struct Conventions {
    detail::Required<DepthRange> depth;
    detail::Required<NdcY> ndc_y;
    detail::Required<TextureOrigin> origin;
    detail::Required<Handedness> handedness;

    friend constexpr bool operator==(const Conventions&, const Conventions&) = default;
};

// What the graphics APIs do unless they are told otherwise, in a right-handed world.
inline constexpr Conventions opengl{DepthRange::negative_one_to_one, NdcY::up, TextureOrigin::bottom_left,
                                    Handedness::right};
inline constexpr Conventions direct3d{DepthRange::zero_to_one, NdcY::up, TextureOrigin::top_left, Handedness::right};
inline constexpr Conventions metal{DepthRange::zero_to_one, NdcY::up, TextureOrigin::top_left, Handedness::right};
inline constexpr Conventions vulkan{DepthRange::zero_to_one, NdcY::down, TextureOrigin::top_left, Handedness::right};

// Makes the conventions of the same API in a left-handed world, as Unity's, Unreal's and that of XMMatrixLookAtLH:
// left_handed(direct3d).
[[nodiscard]] constexpr Conventions left_handed(const Conventions& api) noexcept {
    return {api.depth, api.ndc_y, api.origin, Handedness::left};
}

// What r holds after the division: with unit a depth in [0, 1], as Everitt's matrix has it; with ndc the projector's
// own depth, as SGI's recipe leaves it.
enum class DepthMapping { unit, ndc };

// The closed rectangle of texture coordinates that the slide covers, and how deep its light reaches where with_depth()
// says so: else to infinity. min() is the corner that TextureOrigin addresses.
// A region with min() > max() in a component or in its depth, or with a NaN, contains no point, so nothing is lit in
// it. An infinite side is no limit to what is lit: of a region of such sides alone s and t are written for all that is
// in front, as textures that repeat need them; but a slide has no place there. The functions of a TextureRegion are
// constexpr where GLM's are: not under GLM_FORCE_INTRINSICS. min and max stand in parentheses because <windows.h> makes
// macros of them; where it is included, a call is (region.min)().
class TextureRegion {
public:
    constexpr const glm::dvec2&(min)() const noexcept { return min_; }
    constexpr const glm::dvec2&(max)() const noexcept { return max_; }

    // Makes the region of the same rectangle that is lit only where r_min <= r <= r_max too: in a projector's volume,
    // from its near plane to its far one, as the matrix maps them to r. An r_min of -infinity is no limit, nor is
    // an r_max of infinity.
    [[nodiscard]] GLM_CONSTEXPR TextureRegion with_depth(double r_min = 0.0, double r_max = 1.0) const noexcept {
        TextureRegion region(min_, max_);
        region.depth_ = glm::dvec2(r_min, r_max);
        region.has_depth_ = true;
        return region;
    }
    // Makes the region with the whole depth of a projector, reversed or not, with r as the mapping has it: [0, 1], or
    // the range of NDC.
    [[nodiscard]] GLM_CONSTEXPR TextureRegion with_depth(const Conventions& conventions,
                                                         DepthMapping mapping) const noexcept {
        return with_depth(
            mapping == DepthMapping::ndc && conventions.depth == DepthRange::negative_one_to_one ? -1.0 : 0.0, 1.0);
    }

    // The limits of r, as they were given; empty: r does not matter.
    GLM_CONSTEXPR std::optional<glm::dvec2> depth() const noexcept {
        if (!has_depth_) return std::nullopt;
        return depth_;
    }

    friend constexpr bool operator==(const TextureRegion& a, const TextureRegion& b) noexcept {
        return a.min_.x == b.min_.x && a.min_.y == b.min_.y && a.max_.x == b.max_.x && a.max_.y == b.max_.y &&
               a.has_depth_ == b.has_depth_ && a.depth_.x == b.depth_.x && a.depth_.y == b.depth_.y;
    }

    friend GLM_CONSTEXPR TextureRegion atlas_tile(const glm::dvec2& min, const glm::dvec2& max) noexcept;

private:
    GLM_CONSTEXPR TextureRegion(const glm::dvec2& min, const glm::dvec2& max) noexcept
        : min_(min), max_(max), depth_(0.0, 0.0) {}

    glm::dvec2 min_;
    glm::dvec2 max_;
    glm::dvec2 depth_;
    bool has_depth_ = false;
};

// Makes the region from min to max: a tile of a larger texture, in the units of that texture.
inline GLM_CONSTEXPR TextureRegion atlas_tile(const glm::dvec2& min, const glm::dvec2& max) noexcept {
    return {min, max};
}

// Makes the region [0, width] x [0, height] in texels, as GL_TEXTURE_RECTANGLE addresses its image.
inline GLM_CONSTEXPR TextureRegion rectangle_texture(double width, double height) noexcept {
    return atlas_tile(glm::dvec2(0.0, 0.0), glm::dvec2(width, height));
}

// Makes the region [0, 1] x [0, 1]: all of a texture that is addressed by fractions.
inline GLM_CONSTEXPR TextureRegion whole_texture() noexcept { return rectangle_texture(1.0, 1.0); }

// An angle that knows its unit: made by radians() or degrees() only, so that a bare number does not convert.
class Angle {
public:
    constexpr double in_radians() const noexcept { return radians_; }
    constexpr double in_degrees() const noexcept { return radians_ * (180.0 / std::numbers::pi); }

    friend constexpr bool operator==(const Angle& a, const Angle& b) noexcept { return a.radians_ == b.radians_; }

    friend constexpr Angle radians(double) noexcept;

private:
    explicit constexpr Angle(double value) noexcept : radians_(value) {}

    double radians_;
};

// Make an angle of its number in that unit.
constexpr Angle radians(double value) noexcept { return Angle(value); }
constexpr Angle degrees(double value) noexcept { return radians(value * (std::numbers::pi / 180.0)); }

// The largest |error| that the caller accepts in s and in t, in the units of the region; in r the same relative to
// max(1, |r|). The rounding of the nearest float is always allowed: |error| <= max(value, 1/2 ulp). A value that is not
// positive (zero, negative, NaN) means exact.
struct Tolerance {
    double value;
};

inline constexpr Tolerance exact{0.0};  // the nearest float

// Makes the tolerance of a fraction of a texel of a texture of that size, for a region of one unit. (The unit of a
// rectangle texture is the texel: Tolerance{fraction}.) Exact where the size is not positive, or so small that the
// quotient is 1e300 and more.
constexpr Tolerance texels(double fraction, double texture_size) noexcept {
    return texture_size > 0.0 && fraction < texture_size * 1e300 ? Tolerance{fraction / texture_size} : exact;
}

}  // namespace TEXGEN_NAMESPACE
