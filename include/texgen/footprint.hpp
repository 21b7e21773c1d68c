#pragma once

// Floor 8: footprints. What a fragment covers of the texture: the derivatives of s/q and t/q by the window's x and y,
// and what filters make of them. Projection varies them wildly within one triangle, and where q is near 0 a difference
// of two fragments tells nothing; so they are computed in closed form, from the set-up that interpolates.

#include "detail/language.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/vec2.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/nearest.hpp"
#include "detail/inside.hpp"
#include "detail/simd/lanes.hpp"
#include "detail/triangle/footprint_extremes.hpp"
#include "detail/triangle/slopes.hpp"
#include "interpolate.hpp"
#include "primitives.hpp"
#include "texcoord.hpp"

namespace TEXGEN_NAMESPACE {

// How many texels one unit of s and of t spans: the size of the texture for normalised coordinates, those of an
// atlas_tile too; 1 for a rectangle texture. Texels are those of level 0. Bad values (not above 2^-200 and below 2^200)
// make what is measured in texels NaN.
struct TexelsPerUnit {
    double s, t;
};

// Returns the texels per unit of a region that covers width x height of them.
constexpr TexelsPerUnit texels_per_unit(const TextureRegion& region, double width, double height) noexcept {
    return {width / ((region.max)().x - (region.min)().x), height / ((region.max)().y - (region.min)().y)};
}

// The footprint of one fragment.
//   dx, dy            d(s, t)/dx and d(s, t)/dy a pixel, in units of s and t: dPdx and dPdy of textureGrad
//   level             lambda_base = log2(rho) of OpenGL, rho = max(|dx|, |dy|) in texels; -infinity where both are 0
//   singular_values   of J in texels, the larger first: the half axes of the ellipse that a pixel's circle becomes
//   anisotropy        their ratio, at least 1; infinite where J has rank 1 (but for elements, in texels, 2^900 apart),
//                     and maybe where it is beyond 2^900; 1 where J is 0
//   major             the longer half axis, in units of s and t; (1, 0) times its length where they are equal
// `level` is neither biased nor clamped, as textureQueryLod's second result.
// Source: OpenGL 4.6 compatibility specification, 8.14.1, Scale Factor and Level of Detail; for the ellipse, Heckbert,
// Fundamentals of Texture Mapping and Image Warping (1989).
struct Footprint {
    glm::dvec2 dx, dy;
    double level;
    glm::dvec2 singular_values;
    double anisotropy;
    glm::dvec2 major;
};

// Footprints, planar; an empty span is not computed. The derivatives are named as GLSL would: dsdx is d(s/q)/dx.
struct Footprints {
    std::span<float> dsdx = {}, dtdx = {}, dsdy = {}, dtdy = {};
    std::span<float> level = {}, anisotropy = {}, major_s = {}, major_t = {};
};

// The extremes of footprints over the fragments in front of the projector.
//   least_level, largest_level   the range of `level`: 2^largest_level texels a pixel is the strongest minification,
//                                2^-least_level pixels a texel the strongest magnification
//   least_area, largest_area     the range of |det J| in texels: the texels that a pixel covers
//   largest_anisotropy           as in a Footprint
struct FootprintExtremes {
    double least_level, largest_level;
    double least_area, largest_area;
    double largest_anisotropy;
};

inline namespace TEXGEN_COMPILER {

// How far footprint_of() may be from the exact footprint of its derivatives.
inline constexpr double footprint_of_error = 0x1p-48;

// Computes the footprint of derivatives that come from elsewhere.
// Guarantee: singular values and anisotropy within footprint_of_error of themselves (of the larger singular value for
// the smaller; so with the anisotropy, relative to its square), level within footprint_of_error max(1, |level|): of any
// finite derivatives, while what comes out is a normal number; what is beyond the largest is infinite. No allocation,
// noexcept.
// Shapes: units of s and t a pixel.
// Bad input: what is not finite makes all but dx and dy NaN.
inline Footprint footprint_of(const glm::dvec2& dx, const glm::dvec2& dy, const TexelsPerUnit& texels) noexcept;

// A triangle made ready for footprints, beside the set-up for its coordinates.
class FootprintSetup {
public:
    // Makes footprints of a triangle ready.
    // Guarantee: in double, about the vertex with the largest clip_w; no allocation, noexcept.
    FootprintSetup(const TriangleSetup& triangle, const TexelsPerUnit& texels) noexcept;

    // Computes the footprint of the fragment (x, y), empty behind the projector; the sign of q is decided exactly.
    // Guarantee: dx and dy within error_bound() without its rounding to float. The rest has no bound: it is computed
    // from more digits of J, which dx and dy have lost where J is almost singular. No allocation, noexcept.
    std::optional<Footprint> at(int x, int y) const noexcept;

    // Bounds the error of what footprint() writes to dsdx and dsdy (x), dtdx and dtdy (y).
    // Guarantee: |computed - exact| is at most this at every fragment of the rectangle with q > 0; infinite where none
    // is known, as next to q = 0. noexcept.
    glm::dvec2 error_bound(const FragmentRect& rect) const noexcept;

    // Finds the extremes of the footprints over a rectangle.
    // Guarantee: no fragment of the rectangle that is in front of the projector has a level, an area or an anisotropy
    // outside of these (they hold for exact footprints and for those of `exact`; a tolerance may add its share). Each
    // is reached within 1 % at some point of the rectangle (that is levels within 0.015) where q is well away from 0,
    // and neither q nor the derivatives cancel to less than 2^-13 of their terms, as they may far off slivers.
    // largest_level, largest_area and largest_anisotropy are infinite where q is next to 0, the last one also where J
    // is so nearly singular that its smaller axis is not known: beyond 2^40, and sooner where terms cancel. Empty where
    // all is behind the projector or the rectangle is empty. A level of the Jacobian 0 is -infinity, and NaN where the
    // texels are bad. It takes as long as some hundreds of fragments, and never visits them. No allocation, noexcept.
    std::optional<FootprintExtremes> extremes(const FragmentRect& rect) const noexcept;

    // Finds those over all fragments inside the triangle.
    std::optional<FootprintExtremes> extremes() const noexcept;

private:
    friend detail::Inside;

    detail::FootprintFunctions functions_;
    TexelsPerUnit texels_;
};

// Scores how much a triangle is the "deer in headlights": lit by a projector that faces the camera, so that what is
// near to the camera is far from the projector and gets few texels on many pixels, and what is far gets many on few.
//
// The area of the footprint goes with 1 / Q^3 = (w/q)^3, so between the vertices nearest to the camera and farthest
// from it the level of detail rises by 3/2 log2(w_far / w_near) for the camera, and by 3/2 log2(q_near / q_far) for the
// projector. The latter is the score, in levels: 0 for a parallel projector, negative where the projector stands with
// the camera and evens out what the camera does, positive where both add up; infinite where the projector's plane is
// reached. Of vertices as near, or as far, those count that score the most. No allocation, noexcept.
// Bad input: NaN where a clip_w is not positive, a clip_w or q not finite, or q is not positive at the vertex nearest
// to the camera.
// Source: Everitt, Projective Texture Mapping; the dueling frusta of Stamminger and Drettakis, Perspective Shadow Maps,
// SIGGRAPH 2002.
inline double headlights(const Triangle& triangle) noexcept;

}  // namespace TEXGEN_COMPILER

inline namespace TEXGEN_BUILD {

// Writes the footprints of a rectangle's fragments in front of the projector. Returns whether the slide may light any
// of its fragments; where it lights none, nothing is written, as interpolate() does not for Work::nothing.
// Guarantee: in front of the projector the derivatives are within setup.error_bound(rect): with `exact` next to half an
// ulp, with a tolerance within max(tolerance, that), in units of s and t a pixel. level is within 2^-16 max(1, |level|
// / 32) of that of derivatives within the bound, anisotropy and major within 2^-16 of theirs (major relative to its
// length, in texels; where the anisotropy is near 1 its direction means nothing). Behind, all are 0, the sign of q
// decided exactly. No allocation, noexcept.
// Shapes: as interpolate(), for fragments outside the triangle, too.
// Bad input: an empty rectangle does nothing. With bad texels level, anisotropy and major are NaN, the derivatives
// right. A Jacobian that is 0 has level -infinity, anisotropy 1 and major 0.
template <class CompiledWhereCalled = void>
bool footprint(const FootprintSetup& setup, const FragmentRect& rect, const Footprints& out) noexcept;

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_NAMESPACE

#include "detail/triangle/footprint.inc.hpp"

#include "detail/triangle/footprinter.inc.hpp"
