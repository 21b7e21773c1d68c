#pragma once

// Floor 2: the scale-bias S of Everitt (3) and (4), which takes the projector's clip space to texture coordinates, and
// the same remap without a matrix.

#include "detail/language.hpp"

#include <array>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/widen.hpp"
#include "transform.hpp"

namespace TEXGEN_NAMESPACE {

// Makes the scale-bias S. For OpenGL's conventions, the whole texture and unit depth this is Everitt's
//
//     | 1/2   0    0   1/2 |
//     |  0   1/2   0   1/2 |
//     |  0    0   1/2  1/2 |
//     |  0    0    0    1  |
//
// In general s runs from region.min().x at clip x = -w to region.max().x at x = w; t likewise with y, upside down where
// the y direction and the texture origin disagree; r is depth in [0, 1] (unit) or as the projector has it (ndc). A
// depth of the region (with_depth) changes nothing.
// Guarantee: each element within one rounding of a double (exact for the whole texture), of a region whose sides are 0
// or above 2^-1021; no allocation, noexcept.
// Bad input: a region with NaN gives a matrix with NaN.
// Source: Everitt, Projective Texture Mapping, (3); the same matrix with r in NDC is SGI's recipe.
inline ScaleBias scale_bias(const Conventions& conventions, const TextureRegion& region = whole_texture(),
                            DepthMapping depth = DepthMapping::unit) noexcept;

// How far to_texture() may be from the exact value, before its one rounding to float: relative to max(|min|, |max|)
// max(|w|, |x|), with the sides of the region in that coordinate, in y likewise, in z.
inline constexpr double to_texture_error = 0x1p-51;

// Takes a clip coordinate to the texture as S does, without the matrix: x, y in [-w, w] become [0, w] for the whole
// texture.
// Guarantee: each component is computed in double and rounded once: within 1/2 float ulp + to_texture_error. The edges
// of the picture are products alone: x = -w gives min * w in double, rounded to float, and x = w gives max * w. No
// allocation, noexcept.
// Shape: the projector's clip coordinates in, homogeneous (s, t, r, q) out; q = w.
// Bad input: what is not finite, or a side times a coordinate that is none, leaves its component infinite or a NaN (w
// is in all of them).
inline glm::vec4 to_texture(const glm::vec4& projector_clip, const Conventions& conventions,
                            const TextureRegion& region = whole_texture(),
                            DepthMapping depth = DepthMapping::unit) noexcept;

}  // namespace TEXGEN_NAMESPACE

#include "detail/matrices/scale_bias.inc.hpp"
