#pragma once

// Floor 2: the scale-bias S of Everitt (3) and (4), which takes the projector's clip space to texture coordinates, and
// the same remap without a matrix.

#include "detail/language.hpp"

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/widen.hpp"
#include "transform.hpp"

namespace TEXGEN_NAMESPACE {

namespace detail {
inline namespace TEXGEN_COMPILER {

// Per coordinate: texture = at_minus_w * (w - c)/2 + at_plus_w * (w + c)/2, c the clip coordinate. The two ends say
// everything about the conventions.
struct RemapEnds {
    double at_minus_w, at_plus_w;

    constexpr double scale() const noexcept { return 0.5 * at_plus_w - 0.5 * at_minus_w; }
    constexpr double bias() const noexcept { return 0.5 * at_plus_w + 0.5 * at_minus_w; }
};

struct TextureRemap {
    RemapEnds s, t, r;
};

constexpr TextureRemap texture_remap(Conventions conventions, const TextureRegion& region,
                                     DepthMapping depth) noexcept {
    // t grows with the clip y where the corner that (s, t) = (0, 0) addresses is where clip y is -w.
    const bool t_follows_y = (conventions.ndc_y == NdcY::up) == (conventions.origin == TextureOrigin::bottom_left);
    const RemapEnds up{(region.min)().y, (region.max)().y};
    const RemapEnds down{(region.max)().y, (region.min)().y};
    const bool halve_depth = depth == DepthMapping::unit && conventions.depth == DepthRange::negative_one_to_one;
    return {{(region.min)().x, (region.max)().x},
            t_follows_y ? up : down,
            halve_depth ? RemapEnds{0.0, 1.0} : RemapEnds{-1.0, 1.0}};
}

}  // namespace TEXGEN_COMPILER
}  // namespace detail

// Guarantee: S in double, each element within one rounding (exact for the whole texture); no allocation, noexcept.
// For OpenGL's conventions, the whole texture and unit depth this is Everitt's
//
//     | 1/2   0    0   1/2 |
//     |  0   1/2   0   1/2 |
//     |  0    0   1/2  1/2 |
//     |  0    0    0    1  |
//
// In general s runs from region.min().x at clip x = -w to region.max().x at x = w; t likewise with y, upside down where
// the y direction and the texture origin disagree; r is depth in [0, 1] (unit) or as the projector has it (ndc).
// Bad input: a region with NaN gives a matrix with NaN.
// Source: Everitt, Projective Texture Mapping, (3); the same matrix with r in NDC is SGI's recipe.
inline ScaleBias scale_bias(Conventions conventions, TextureRegion region = whole_texture(),
                            DepthMapping depth = DepthMapping::unit) noexcept {
    const detail::TextureRemap remap = detail::texture_remap(conventions, region, depth);
    glm::dmat4 matrix(1.0);
    matrix[0][0] = remap.s.scale();
    matrix[3][0] = remap.s.bias();
    matrix[1][1] = remap.t.scale();
    matrix[3][1] = remap.t.bias();
    matrix[2][2] = remap.r.scale();
    matrix[3][2] = remap.r.bias();
    return ScaleBias(matrix);
}

// Guarantee: S times the clip coordinate without the matrix: x, y in [-w, w] become [0, w] for the whole texture. Each
// component is computed in double and rounded once: within 1/2 float ulp + 2^-51 max(|min|, |max|) max(|w|, |x|).
// The edges of the picture are exact: x = -w gives min * w and x = w gives max * w. No allocation, noexcept.
// Shape: the projector's clip coordinates in, homogeneous (s, t, r, q) out; q = w.
// Bad input: NaN and infinity stay in their component (w is in all of them).
inline glm::vec4 to_texture(glm::vec4 projector_clip, Conventions conventions, TextureRegion region = whole_texture(),
                            DepthMapping depth = DepthMapping::unit) noexcept {
    const detail::TextureRemap remap = detail::texture_remap(conventions, region, depth);
    const glm::dvec4 clip = detail::widened(projector_clip);
    const auto component = [w = clip.w](double coordinate, const detail::RemapEnds& ends) {
        return static_cast<float>(ends.at_minus_w * (0.5 * (w - coordinate)) +
                                  ends.at_plus_w * (0.5 * (w + coordinate)));
    };
    return {component(clip.x, remap.s), component(clip.y, remap.t), component(clip.z, remap.r), projector_clip.w};
}

}  // namespace TEXGEN_NAMESPACE
