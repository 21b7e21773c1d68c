#pragma once

// Floor 6: how much of a box or a sphere the slide lights, within its depth where it has one. What is dark need not be
// drawn.

#include "detail/language.hpp"

#include <cmath>
#include <cstddef>
#include <span>

#include "conventions.hpp"
#include "detail/arithmetic/widen.hpp"
#include "detail/assert.hpp"
#include "detail/culling/lit_forms.hpp"
#include "detail/on_demand.hpp"
#include "detail/simd/lanes.hpp"
#include "primitives.hpp"
#include "transform.hpp"

namespace TEXGEN_NAMESPACE_BUILD {

// The points that a slide lights, prepared once for many questions; the functions below ask one each.
// Guarantee: `outside` and `inside` are never false. They hold for the exact values of the matrix, the region and the
// body as they are given, and for `lit` of project() with `exact`, whose s, t and r are rounded: within a float of a
// side, or of a limit of depth, a body is `partial`. (What a tolerance moves across a side is not looked for here.) A
// batch answers as the single question does. No allocation, noexcept; what is prepared is never changed, so threads may
// share it. `partial` is also said
//   of a box      that touches a plane through an edge or through the apex of the projector's pyramid within 2^-47 of
//                 the terms that the plane's value is the sum of, the largest coefficient for all; where a side of
//                 the box is infinite, or one of 1e30, any plane through an edge may be so near. (The pyramid's own
//                 planes, with its sides at the floats next to the region's, next to 0 the normal ones, are decided
//                 exactly, as are the near and the far plane of a depth.)
//   of a box      about q = 0 where nothing is lit at all: no r in front is in the depth, or no s and t go together
//   of a sphere   that only touches a plane, that no plane but one through a vertex of the volume leaves out, or that a
//                 side would cut if it were moved inwards by those floats, at the largest q that points as far from the
//                 origin may have
// Shape: bodies of Space, in order; both spans have one size (asserted; else nothing is written).
// Bad input, the first that applies: a NaN anywhere in a body: partial. A box with min > max in some axis, a sphere
// with a negative radius: outside. A matrix that is not finite: partial. An empty region (see TextureRegion): outside.
// Exponents so far apart that exact sums leave the range of double (elements below 2^-600 of the matrix's largest,
// which, if it is not 0, is from 2^-1000 to 2^1000, row r left out where there is no depth; sides of the region beyond
// 2^+-200): partial. A q that is 0 everywhere: outside. An infinite side of the region, or limit of its depth, is none.
// Source: the separating axis theorem; Gottschalk, Lin, Manocha, OBBTree, SIGGRAPH 1996.
template <class Space>
class LitVolume {
public:
    LitVolume(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region) noexcept;

    // Says how much of one body the slide lights.
    Coverage coverage(const Box& box) const noexcept;
    Coverage coverage(const Sphere& sphere) const noexcept;

    // Say how much of each of many bodies the slide lights.
    void coverage(const std::span<const Box>& boxes, const std::span<Coverage>& out) const noexcept;
    void coverage(const std::span<const Sphere>& spheres, const std::span<Coverage>& out) const noexcept;

private:
    detail::LitForms forms_;
    detail::FloatForms float_forms_;
    detail::UnitForms unit_forms_;
    detail::SeparatingPlanes separating_;
};

// A LitVolume has the space of its matrix.
template <class Space>
LitVolume(const Transform<Texture, Space>&, const TextureRegion&) -> LitVolume<Space>;

// Says how much of a box or a sphere the slide lights, or of each of many: as a LitVolume that is asked once.
template <class Space>
Coverage coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
                  const Box& box) noexcept;
template <class Space>
Coverage coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
                  const Sphere& sphere) noexcept;
template <class Space>
void coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
              const std::span<const Box>& boxes, const std::span<Coverage>& out) noexcept;
template <class Space>
void coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
              const std::span<const Sphere>& spheres, const std::span<Coverage>& out) noexcept;

}  // namespace TEXGEN_NAMESPACE_BUILD

#include "detail/culling/bodies.inc.hpp"

#include "detail/culling/spheres.inc.hpp"

#include "detail/culling/coverage.inc.hpp"
