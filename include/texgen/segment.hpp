#pragma once

// Floor 6: (s, t, r) along segments: C_u = ((1-a) A_u + a B_u) / ((1-a) A_q + a B_q), the C_u note's (2).

#include "detail/language.hpp"

#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/expansion.hpp"
#include "detail/arithmetic/nearest.hpp"
#include "detail/arithmetic/widen.hpp"
#include "detail/assert.hpp"
#include "detail/culling/lit_test.hpp"
#include "detail/simd/lanes.hpp"
#include "detail/triangle/corners.hpp"
#include "primitives.hpp"
#include "texcoord.hpp"

namespace TEXGEN_NAMESPACE_BUILD {

// Writes s/q, t/q and r/q along a segment, C_u = ((1-a) A_u + a B_u) / ((1-a) A_q + a B_q) for u = s, t, r.
// Guarantee: each within max(tolerance, 1/2 ulp) of the exact value of the given floats (r: the tolerance relative to
// max(1, |r|)); with `exact` the nearest float, the ends included. The sign of q is exact, and behind the projector all
// are 0. lit as for triangles. No allocation, noexcept.
// Shapes: each output as long as alpha, or empty (asserted; else it is not written), and outputs must not overlap it;
// alpha in [0, 1] (asserted).
// Bad input: NaN and infinity spoil their own value only; an alpha that is NaN is never lit, and not asserted.
// Source: the C_u note, (2).
template <class CompiledWhereCalled = void>
void interpolate(const Segment& segment, const std::span<const float>& alpha, const TextureRegion& region,
                 const Texcoords& out, const Tolerance& tolerance = exact) noexcept;

}  // namespace TEXGEN_NAMESPACE_BUILD

namespace TEXGEN_NAMESPACE_COMPILER {

// Tells the work that the values of a segment need, for all alpha in [0, 1].
// Guarantee: never nothing where a value is lit (in the region, and its depth where it has one); else affine where q is
// the same at both ends, and never less than divide_and_test where it is not and a value is dark or behind. noexcept.
// Bad input: an end whose s, t or q is not finite needs divide_and_test; a NaN for r is in no depth.
inline Work work(const Segment& segment, const TextureRegion& region, const Tolerance& tolerance = exact) noexcept;

// Bounds the error of s (x) and t (y) along a segment.
// Guarantee: |computed - exact| is at most this for every alpha in [0, 1] with q > 0, the rounding to float included;
// infinite where q reaches 0 and no finite bound exists. noexcept.
// Bad input: infinite where an s, t or q of an end is not finite.
inline glm::dvec2 error_bound(const Segment& segment, const Tolerance& tolerance = exact) noexcept;

}  // namespace TEXGEN_NAMESPACE_COMPILER

#include "detail/points/segment_forms.inc.hpp"

#include "detail/points/segment.inc.hpp"
