#pragma once

// Floor 7: (s, t, r) over the fragments of triangles: interpolate s, t, r, q perspective-correctly, then divide by q,
// per fragment. Segments are in segment.hpp.
//
// The tolerance chooses how it is computed: `exact` by a division in double with a certificate, and what that leaves in
// doubt by exact sums; others by the first polynomial whose bound fits, or in short rows without one, else by a
// division in float, if that fits, else as `exact`.

#include "detail/language.hpp"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include <glm/vec2.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/nearest.hpp"
#include "detail/culling/lit_test.hpp"
#include "detail/inside.hpp"
#include "detail/on_demand.hpp"
#include "detail/simd/lanes.hpp"
#include "detail/triangle/close_planes.hpp"
#include "detail/triangle/corners.hpp"
#include "detail/triangle/doubt.hpp"
#include "detail/triangle/exact_fragment.hpp"
#include "primitives.hpp"
#include "segment.hpp"
#include "texcoord.hpp"

namespace TEXGEN_NAMESPACE {
inline namespace TEXGEN_COMPILER {

// A triangle made ready for interpolation over any number of rectangles of fragments.
class TriangleSetup {
    struct Key {
        explicit Key() = default;
    };

public:
    // Makes a triangle ready.
    // Guarantee: everything in double, about the vertex with the largest clip_w; no allocation, noexcept.
    // Shapes: window positions in pixels, the camera's clip w, and homogeneous (s, t, r, q), in either winding.
    // Bad input: empty where a number is not finite, a clip_w is not positive, or the area is zero (decided exactly).
    static std::optional<TriangleSetup> of(const Triangle& triangle, const TextureRegion& region,
                                           const Tolerance& tolerance = exact) noexcept;

    // For of() alone, which makes it in place: Key is private.
    TriangleSetup(Key, const Triangle& triangle, const TextureRegion& region, const Tolerance& tolerance) noexcept
        : functions_(triangle, region, detail::accepted(tolerance)) {}

    // Tells the work that the fragments of a rectangle need.
    // Guarantee: the least that is certified to stay inside the tolerance for every fragment of the rectangle; never
    // nothing where a fragment is lit. noexcept. An empty rectangle needs nothing.
    Work work(const FragmentRect& rect) const noexcept;

    // Bounds the error of s (x) and t (y) over a rectangle.
    // Guarantee: |computed - exact| is at most this for every fragment of the rectangle with q > 0, the rounding to
    // float included; infinite where none is known, as next to q = 0. noexcept.
    glm::dvec2 error_bound(const FragmentRect& rect) const noexcept;

private:
    friend detail::Inside;

    detail::TriangleFunctions functions_;
};

}  // namespace TEXGEN_COMPILER

static_assert(sizeof(TriangleSetup) <= 512);

inline namespace TEXGEN_BUILD {

// Writes s/q, t/q and r/q of every fragment of a rectangle in front of the projector, and whether it is lit. Returns
// setup.work(rect).
// Guarantee: in front each is within max(tolerance, 1/2 ulp) of the exact value of the given floats (r: the tolerance
// relative to max(1, |r|)). With `exact` each is the nearest float, so that its bits depend on neither the rectangle,
// the length, the alignment nor the build. lit = 1 inside the closed region, decided from the s and t, and with a depth
// from the r, that are written; where one is not asked for, from a float as near to the exact value, so that with a
// tolerance either answer may be right next to a side. Where r is certainly in the depth, or s and t leave all of a
// part of the rectangle dark, it is not computed for that. Behind, s = t = r = lit = 0, the sign of q decided exactly.
// For Work::nothing lit is 0 and s, t, r are not written. No allocation, noexcept.
// Shapes: each output has width * height floats, row-major, or none (asserted). Fragments outside the triangle get the
// values of its plane; where the interpolated 1/w is not positive nothing is promised.
// Bad input: an empty rectangle does nothing, whatever the outputs.
// Source: OpenGL compatibility specification, polygon rasterization; Everitt, Projective Texture Mapping, section 2.
template <class CompiledWhereCalled = void>
Work interpolate(const TriangleSetup& setup, const FragmentRect& rect, const Texcoords& out) noexcept;

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_NAMESPACE

#include "detail/triangle/survey.inc.hpp"

#include "detail/triangle/units.inc.hpp"

#include "detail/triangle/interpolator.inc.hpp"
#include "detail/triangle/mask_spans.inc.hpp"
#include "detail/triangle/small_tile.inc.hpp"

#include "detail/triangle/interpolate.inc.hpp"
