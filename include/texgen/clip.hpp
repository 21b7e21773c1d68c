#pragma once

// Floor 6: what a scene needs before its polygons can be interpolated. A vertex behind the camera has no place in the
// window, so polygons are cut at the near plane while they are homogeneous, and only then divided; likewise with what
// is behind the projector, outside its slide or beyond its depth. The slide's planes, for hardware that clips, stand
// here too.

#include "detail/language.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include <glm/vec4.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/expansion.hpp"
#include "detail/arithmetic/nearest.hpp"
#include "detail/arithmetic/widen.hpp"
#include "detail/assert.hpp"
#include "detail/culling/slide_planes.hpp"
#include "detail/on_demand.hpp"
#include "primitives.hpp"
#include "transform.hpp"

namespace TEXGEN_NAMESPACE {

// A corner of a polygon that is not divided yet. position: the camera's clip space. strq: homogeneous texture
// coordinates, which belong to it linearly.
struct ClipVertex {
    glm::vec4 position;
    glm::vec4 strq;
};

inline namespace TEXGEN_COMPILER {

// How far to_window() may be from the exact division, before its one rounding to float: relative to |centre of the
// viewport| + |width / 2 * position.x / position.w| in x, likewise in y.
inline constexpr double to_window_error = 0x1p-51;

// Takes the vertex to the window: x = viewport.x + (position.x / position.w + 1) width / 2, y likewise, so that y grows
// as the clip y does.
// Guarantee: x and y within 1/2 float ulp + to_window_error; clip_w and strq unchanged; equal vertices give equal bits.
// No allocation, noexcept.
// Bad input: precondition, asserted: position.w > 0. What is not finite stays so in its component.
// Source: OpenGL 2.1 specification, 2.11.1.
inline WindowVertex to_window(const ClipVertex& vertex, const Viewport& viewport) noexcept;

// How far a new vertex of clip_to_near() may be from the exact intersection, before its one rounding to float: relative
// to (1 - t) |a_i| + t |b_i| in component i of the point (1 - t) a + t b.
inline constexpr double clip_error = 0x1p-50;

// Cuts off what of a convex polygon is behind the camera's near plane; the rest is in the order of the polygon, though
// its first vertex may be another. Returns the count of vertices written to `out`; 0 where all is behind, or what is
// not behind only touches the plane, with any number of corners, or there are fewer than three. What lies in the plane
// as a whole is not behind. A polygon whose own corners are collinear, or become so by rounding, is cut as any other:
// TriangleSetup::of() refuses it.
// Guarantee: every vertex that comes out has w > 0, and z + w >= 0 (negative_one_to_one), z >= 0 (zero_to_one) or,
// where reversed_depth says that the near plane is z = w, z <= w. Vertices in front keep their bits. Each component of
// a new vertex is within 1/2 float ulp + clip_error of the exact intersection, w within that of itself, but z, which is
// the near plane's for the w that comes out. It has the same bits whichever way its edge is walked, so shared edges
// stay closed. No allocation, noexcept.
// Shape: out.size() > polygon.size() (asserted); out may begin where the polygon does, and overlaps it in no other way.
// Bad input: a polygon with a position that is not finite is dropped, as is one that crosses the plane more than twice
// (no convex polygon does). strq may hold anything. Where the near plane leaves room for w <= 0 (an oblique near
// plane), or for a w below all floats, edges are cut a second time, at a millionth (2^-20) of the w of their end in
// front; that can take one vertex more, and where `out` has no room for it the polygon is dropped.
// Source: Blinn and Newell, Clipping Using Homogeneous Coordinates (1978); Sutherland and Hodgman, Reentrant Polygon
// Clipping, CACM 17 (1974).
inline std::size_t clip_to_near(const std::span<const ClipVertex>& polygon, const std::span<ClipVertex>& out,
                                DepthRange range, bool reversed_depth = false) noexcept;

}  // namespace TEXGEN_COMPILER

// The planes that clip_planes() returns, in its order: five, or seven of a region with a depth. Each is the (a, b, c,
// d) of a x + b y + c z + d >= 0.
class ClipPlanes {
public:
    std::size_t size() const noexcept { return size_; }
    const glm::vec4* begin() const noexcept { return planes_.data(); }
    const glm::vec4* end() const noexcept { return planes_.data() + size_; }
    const glm::vec4& operator[](std::size_t i) const noexcept { return planes_[i]; }

private:
    template <class Space>
    friend ClipPlanes clip_planes(const Transform<Texture, Space>&, const TextureRegion&) noexcept;

    std::array<glm::vec4, detail::SlidePlanes::max_size> planes_{};
    std::size_t size_ = 0;
};

// Says the planes of the slide's region: q, s - min.x q, max.x q - s, t - min.y q, max.y q - t, and with a depth
// r - r_min q, r_max q - r. A point of the space is lit where all are >= 0 (and q > 0): for gl_ClipDistance, or in eye
// space for glClipPlane. An infinite limit of depth is none: in its place q stands again.
// Guarantee: each coefficient is the exact one of the matrix in double, rounded to double and then to float: within
// (1/2 + 2^-29) float ulp, and with its sign, or 0. No allocation, noexcept.
// Shape: coefficients (x, y, z, w) of points (x, y, z, 1) of the space that the matrix takes to the texture.
// Bad input: NaN and infinity of the matrix or the region stay in the coefficients that they reach.
// Source: Segal, Korobkin, van Widenfelt, Foran, Haeberli, Fast Shadows and Lighting Effects Using Texture Mapping
// (SIGGRAPH 1992): what is not to be lit is clipped.
template <class Space>
ClipPlanes clip_planes(const Transform<Texture, Space>& texgen, const TextureRegion& region) noexcept;

// How far outside a side of the region a vertex from clip_to_slide() may be: min q - u and u - max q are at most
// slide_clip_error max(|min|, |max|) q for u = s and t, and for r where the region has a depth, while no number, times
// a side or not, is below the normal floats.
//
// A vertex that comes out has at most seven cuts behind it. A cut of vertices with u - min q >= -e q satisfies that
// too, as it is linear, and rounding u and q moves u - min q by 2^-24 (|u| + |min| q) <= 2^-23 max(|min|, |max|) q
// more. The largest seen in four million triangles is 2^-22.
inline constexpr double slide_clip_error = 0x1p-20;

inline namespace TEXGEN_COMPILER {

// Cuts off what of a convex polygon the slide does not fall on: q > 0, s and t in the region's four sides, and r in its
// depth where it has one, are what is left. Returns the count of vertices written to `out`, in the order of
// clip_to_near(); 0 where nothing is inside a side, or what is not outside only touches it. Collinear corners are cut
// as there.
// Guarantee: every vertex that comes out has q > 0 and is inside the region but for slide_clip_error. Vertices inside
// keep their bits; sides are decided exactly, so a vertex on a side stays. A new vertex is the exact intersection of
// its edge (of a new edge's ends as they were rounded), each component of position and strq the nearest float. Shared
// edges stay closed, to the bit: the edges are cut one after another at q = 0, at the four sides and at the limits of
// depth, and what becomes of an edge at each is a function of its two ends, in whatever order and whatever polygon they
// stand. No allocation, noexcept.
// Shape: out.size() >= polygon.size() + 5, or 7 with a depth (asserted); out overlaps the polygon as that of
// clip_to_near() may. At the projector itself (s = t = q = 0, the one point of the sides with q = 0) there is no
// coordinate: a polygon that reaches it is cut at a millionth (2^-20) of the q of the edge's other end.
// Bad input: a polygon with an s, t or q that is not finite is dropped, with a depth also one with such an r; where the
// region holds no point all are. The position may hold anything, as may r without a depth. What is not convex (as
// rounding may leave a polygon with more than three corners) is cut as it is, and may be dropped where `out` has no
// more room than that.
// Source: Sutherland and Hodgman, Reentrant Polygon Clipping, CACM 17 (1974).
inline std::size_t clip_to_slide(const std::span<const ClipVertex>& polygon, const TextureRegion& region,
                                 const std::span<ClipVertex>& out) noexcept;

}  // namespace TEXGEN_COMPILER
}  // namespace TEXGEN_NAMESPACE

#include "detail/culling/near_clip.inc.hpp"
#include "detail/culling/slide_clip.inc.hpp"
