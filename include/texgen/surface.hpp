#pragma once

// Floor 2: what the projection makes of a surface: which side of a triangle the projector sees, how large it is on the
// slide and how its depth changes there; and the q of a quadrilateral that is given by its corners.

#include "detail/language.hpp"

#include <array>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/determinant.hpp"
#include "detail/arithmetic/inverse.hpp"
#include "detail/arithmetic/widen.hpp"
#include "transform.hpp"

namespace TEXGEN_NAMESPACE {

// The side of a triangle that the projector sees.
enum class Facing { towards, away, edge_on };

// Tells which side of a triangle the projector sees: `towards` where the corners run counter-clockwise as the slide is
// seen upright.
// Guarantee: the exact sign of det [s t q], whatever cancels; also where some or all corners are behind the projector,
// as the plane of the triangle has one side. A back face is lit by nothing: this is what to skip. No allocation,
// noexcept.
// Shape: (s, t, r, q) of the corners in order; r is not looked at. t grows upwards with bottom_left.
// Bad input: edge_on where an s, t or q is NaN or infinite, as where the projector is in the plane of the triangle, or
// the triangle has no area.
// Source: Olano, Greer, Triangle Scan Conversion using 2D Homogeneous Coordinates (1997).
inline Facing facing(const glm::vec4& a, const glm::vec4& b, const glm::vec4& c, TextureOrigin origin) noexcept;

// How far slide_area() may be from the exact area, relative to it.
inline constexpr double slide_area_error = 0x1p-50;

// Measures the area of a triangle on the slide, in units of s times units of t: of texels, for a rectangle texture.
// Guarantee: within slide_area_error, whatever cancels; positive where t grows from the edge a b towards c when s grows
// to the right from a to b, as det [s t q]; 0 where it is exactly that. Over the triangle's area in the scene it is the
// density of texels there. No allocation, noexcept.
// Shape: (s, t, r, q) of the corners in order; r is not looked at.
// Bad input: empty unless all q > 0, and where an s, t or q is NaN or infinite.
inline std::optional<double> slide_area(const glm::vec4& a, const glm::vec4& b, const glm::vec4& c) noexcept;

// How far each number of receiver_plane() may be from the exact one, relative to it.
inline constexpr double receiver_plane_error = 0x1p-49;

// Finds how depth changes over the slide on the plane of a triangle: (A, B, C) with r/q = A s/q + B t/q + C. So the
// slopes of r are two constants, dr/ds = A and dr/dt = B: what a shadow map's texels that lie beside the fragment are
// biased by, without a constant to fit.
// Guarantee: each within receiver_plane_error, whatever cancels; some or all corners may be behind. No allocation,
// noexcept.
// Shape: (s, t, r, q) of the corners in any order. In a fragment shader, for a map that has r and texels of that size,
//
//     float bias = dot(abs(plane.xy), 0.5 * texel);  // to any point of the texel that the fragment falls on
//     bool lit = strq.z / strq.w <= texture(map, strq.xy / strq.w).r + bias;  // of a reversed depth: >= and - bias
//
// Bad input: empty where the projector sees the triangle edge on (facing()), or a number is NaN or infinite.
// Source: Isidoro, Shadow Mapping: GPU-based Tips and Techniques, GDC 2006 (receiver plane depth bias).
inline std::optional<glm::dvec3> receiver_plane(const glm::vec4& a, const glm::vec4& b, const glm::vec4& c) noexcept;

// Makes the (s, t, 0, q) of a quadrilateral's corners with which textureProj shows the slide on it in perspective,
// where s and t alone would break along the diagonal.
// Guarantee: strict convexity is decided exactly. The q are those of the homography that takes the corners to the
// region's, the largest about 1, each within 2.5 float ulp. s/q and t/q rounded to float are the region's corner
// rounded to float: always where that is 0 or a power of two, as in the whole texture, else where one of the five q
// about the exact one allows it, and within 1 ulp where none does. Between the corners they stay within 2^-20 of the
// largest of those. No allocation, noexcept.
// Shape: the corners that get (min, min), (max, min), (max, max), (min, max) of the region, in either winding, in any
// unit.
// Bad input: empty for corners that are not strictly convex in that order, or a NaN; for a coordinate other than 0
// whose magnitude is not from 2^-400 to 2^400; and where a q, or an s or t whose side is not 0 as a float, would be
// below 2^-126. A NaN of the region stays in its coordinate.
// Source: Everitt, Projective Texture Mapping, figure 2; Heckbert, Fundamentals of Texture Mapping and Image Warping
// (1989), 2.2.3.
inline std::optional<std::array<glm::vec4, 4>> quadrilateral(const std::array<glm::dvec2, 4>& corners,
                                                             const TextureRegion& region = whole_texture()) noexcept;

// How far an element of keystone() may be from the exact one, relative to the magnitudes of its two terms.
inline constexpr double keystone_error = 0x1p-48;

// Makes the matrix of the same homography: for a slide that is to fill a quadrilateral of a window, or of a wall that
// was measured.
// Guarantee: as quadrilateral(), with the same q; each element is the difference of two terms, or their sum, and within
// keystone_error of their magnitudes, unless a term is below 2^-1000 for the whole texture. No allocation, noexcept.
// Shape: (x, y, z, 1) to (s, t, 0, q), whatever z is. q > 0 on the side of the horizon where the quadrilateral is, but
// for that error: a corner between two that are nearly on a line with it is next to the horizon.
// Bad input: empty as quadrilateral(), though q, s and t may be of any size, and where an element is not finite.
inline std::optional<WindowTexgen> keystone(const std::array<glm::dvec2, 4>& corners,
                                            const TextureRegion& region = whole_texture()) noexcept;

}  // namespace TEXGEN_NAMESPACE

#include "detail/triangle/surface.inc.hpp"
