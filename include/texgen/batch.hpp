#pragma once

// Floor 9: many triangles at once, for a rasteriser, a lightmap baker or a visibility buffer. They are made ready in
// the lanes of vectors, and small tiles are divided without what a large one is surveyed for; what that leaves in doubt
// is done by TriangleSetup, one by one.

#include "detail/language.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "conventions.hpp"
#include "detail/assert.hpp"
#include "detail/culling/lit_test.hpp"
#include "detail/held.hpp"
#include "detail/inside.hpp"
#include "detail/simd/batch_lanes.hpp"
#include "footprint.hpp"
#include "interpolate.hpp"
#include "primitives.hpp"
#include "surface.hpp"
#include "texcoord.hpp"

namespace TEXGEN_NAMESPACE {

// The id of a fragment that no triangle covers.
inline constexpr std::uint32_t no_triangle = 0xffffffff;

inline namespace TEXGEN_COMPILER {

// Triangles made ready for interpolation, in the order in which they were given. A triangle is known by its index.
class TriangleBatch {
public:
    explicit TriangleBatch(const TextureRegion& region, const Tolerance& tolerance = exact) noexcept
        : region_(region), tolerance_(tolerance), lit_(region) {}

    // Makes triangles ready, in place of those that it had.
    // Guarantee: each as TriangleSetup::of() does, in double about the vertex with the largest clip_w; nothing of the
    // caller's is kept but copies, of 276 bytes a triangle. Memory is allocated only when the count exceeds all former
    // ones; noexcept.
    // Shapes: as TriangleSetup::of(). Fewer than 2^32 - 1 triangles (asserted).
    // Bad input: what TriangleSetup::of() refuses, as a triangle without area in the window, is dark: all that is
    // computed of it is 0.
    template <class CompiledWhereCalled = detail::ThisBuild>
    void assign(const std::span<const Triangle>& triangles) noexcept;

    // Makes triangles ready likewise, but those that face away from the projector dark, as the back of a solid body is.
    // Guarantee: as above; dark are exactly those that facing() calls away, besides those that are refused: a
    // lightmap's triangle that has no area in the world is edge_on, and stays lit. noexcept.
    template <class CompiledWhereCalled = detail::ThisBuild>
    void assign_facing(const std::span<const Triangle>& triangles, TextureOrigin origin) noexcept;

    std::size_t size() const noexcept { return size_; }
    const TextureRegion& region() const noexcept { return region_; }
    Tolerance tolerance() const noexcept { return tolerance_; }

private:
    friend detail::Inside;

    void take(const std::span<const Triangle>& triangles) noexcept;
    template <class CompiledWhereCalled>
    void set_up() noexcept;

    TextureRegion region_;
    Tolerance tolerance_;
    detail::LitTest lit_;
    detail::HeldCount size_;
    std::vector<Triangle> triangles_;  // whole blocks and one more
    std::vector<detail::BatchPlanes, detail::AlignedAllocator<detail::BatchPlanes>> planes_;
};

}  // namespace TEXGEN_COMPILER

inline namespace TEXGEN_BUILD {

// Writes s/q, t/q and r/q of every fragment of a rectangle of each triangle, and whether it is lit. The values of
// triangle i over rects[i] stand behind those of the rectangle before it.
// Guarantee: each value as interpolate(TriangleSetup, rects[i], ...) has it: with `exact` the same bits, else within
// the same bound of the exact value. Everything is written: where nothing of a rectangle is lit, lit is 0, and s, t, r
// are 0 or their plane's; where a triangle is refused all outputs are 0. No allocation, noexcept.
// Shapes: as many rectangles as triangles, and outputs of all their fragments together, or empty ones (all asserted;
// else nothing is written where the count is wrong, or not the output whose length is wrong).
// Cost: with its set-up a tile of 8 x 8 takes about half of what a TriangleSetup does, but as eight are made ready at
// once a triangle alone takes up to four times as long, and two twice; beyond 4096 fragments, or 512 to 2048 with a
// tolerance, a tile is left to a TriangleSetup. So is what is in doubt, which takes as long as some tiles of a triangle
// without doubt.
// Bad input: an empty rectangle has no values.
template <class CompiledWhereCalled = void>
void interpolate(const TriangleBatch& batch, const std::span<const FragmentRect>& rects, const Texcoords& out) noexcept;

// Writes the same for a visibility buffer: fragment k of the rectangle, row by row, gets the values of triangle ids[k].
// Guarantee: as above for the fragment of that triangle. Where ids[k] is no_triangle, or its triangle is refused, all
// outputs are 0. A fragment that is not lit has lit = 0, and s, t, r of its triangle's plane or 0. No allocation,
// noexcept.
// Shapes: width * height ids, and as many floats an output, or none (asserted).
// Cost: runs of 64 fragments and more of one id in a row take what interpolate() of a TriangleSetup does, and share the
// set-ups of the last few triangles. Other fragments take least where neighbours have one id, and about twice as long
// with ids in any order.
// Bad input: an empty rectangle does nothing; an id beyond the batch is no_triangle.
template <class CompiledWhereCalled = void>
void interpolate(const TriangleBatch& batch, const std::span<const std::uint32_t>& ids, const FragmentRect& rect,
                 const Texcoords& out) noexcept;

// How far footprint() by ids may be off besides the error_bound() of the triangle's FootprintSetup, relative to the
// length of the derivative: where terms cancel it is not known to more digits.
inline constexpr double batch_footprint_error = 0x1p-34;

// Writes the footprints of a visibility buffer, as textureGrad takes them: fragment k gets that of triangle ids[k].
// Guarantee: as footprint() of a FootprintSetup of the triangle has it for the fragment, but for batch_footprint_error.
// Behind the projector, and where ids[k] is no_triangle or its triangle is refused, all outputs are 0; they may also be
// 0 in a run of 64 fragments and more of one id in a row of which none is lit. No allocation, noexcept.
// Shapes: as above.
// Cost: derivatives take about twice what a visibility buffer's coordinates do; runs of 64 fragments and more of one id
// in a row, and the little that lanes leave, take a FootprintSetup, and share those of the last few triangles.
// Bad input: as of footprint(), and above.
template <class CompiledWhereCalled = void>
void footprint(const TriangleBatch& batch, const std::span<const std::uint32_t>& ids, const FragmentRect& rect,
               const TexelsPerUnit& texels, const Footprints& out) noexcept;

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_NAMESPACE

#include "detail/triangle/batch.inc.hpp"

#include "detail/triangle/visibility.inc.hpp"
