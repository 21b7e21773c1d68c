#pragma once

// Floor 2: the projector P_p V_p. Its eye has x to the right and y up; the conventions decide the rest: whether it
// looks down -z or +z, where near and far land, and which way y points in NDC.

#include "detail/language.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/expansion.hpp"
#include "detail/arithmetic/inverse.hpp"
#include "detail/arithmetic/rounding.hpp"
#include "detail/matrices/required.hpp"
#include "detail/matrices/vectors.hpp"
#include "transform.hpp"

namespace TEXGEN_NAMESPACE {

// A symmetric lens by its angle. z_near and z_far are distances in front of the eye, in the units of the world; z_far
// may be infinite. reversed_depth, of any lens, maps near to 1 and far to the other end of the range, so that r = 1 at
// near.
struct PerspectiveLens {
    Angle fovy;  // the full vertical angle, between 0 and 180 degrees, both excluded
    double aspect;
    double z_near, z_far;
    bool reversed_depth = false;
};

// A lens by the rectangle that it sees of the near plane. left > right or bottom > top mirrors the picture, as in
// OpenGL. z_far is finite: 1e30 times z_near serves for an infinite one.
struct FrustumLens {
    double left, right, bottom, top, z_near, z_far;
    bool reversed_depth = false;
};

// A lens of parallel rays. z_near and z_far may have any sign; left > right or bottom > top mirrors the picture, as in
// OpenGL.
struct OrthographicLens {
    double left, right, bottom, top, z_near, z_far;
    bool reversed_depth = false;
};

// Where the coordinates of pixels are whole: in the centres of pixels, as OpenCV counts them, so that the picture
// begins at -0.5; or at their corners, so that the picture begins at 0 and the centre of its first pixel is (0.5, 0.5).
enum class PixelCentre { integer, half };

// The lens of a calibrated camera, in pixels, y down: K = (fx skew cx; 0 fy cy; 0 0 1), and the size of the picture.
// z_near and z_far as those of a PerspectiveLens.
struct PinholeLens {
    double fx, fy, cx, cy, width, height, z_near, z_far;
    detail::Required<PixelCentre> centre;
    double skew = 0.0;
    bool reversed_depth = false;
};

// Where a projector stands, what it looks at, and what is above, in the world.
struct Aim {
    glm::dvec3 position, target, up;
};

// A slide projector: where its light goes, and the conventions of its numbers. A view with a scale, as the inverse of a
// scaled node's pose, has the lens's z_near and z_far in the node's units, and r by them.
struct Projector {
    ProjectorProjection projection;
    ProjectorView view;
    Conventions conventions;

    ProjectorMatrix matrix() const noexcept { return projection * view; }  // P_p V_p
};

// Makes the projection P_p of a symmetric lens. For OpenGL's conventions, with f = cot(fovy / 2):
//
//     | f/aspect  0            0                     0           |
//     |    0      f            0                     0           |
//     |    0      0  (far + near)/(near - far)  2 far near/(near - far) |
//     |    0      0           -1                     0           |
//
// zero_to_one has far/(near - far) and far near/(near - far) in row z; y down negates row y, left-handed negates column
// z.
// Guarantee: each element within 4 double ulp (those of subnormal numbers too), for every lens that is not refused; no
// allocation, noexcept.
// Shape: projector eye space (looking down -z, or +z where it is left-handed) to projector clip space.
// Bad input: empty unless 0 < fovy < 180 degrees, aspect > 0 and finite, 0 < z_near < z_far, and z_near finite. Empty,
// too, where doubles cannot hold the matrix: an element would be infinite, or the scale of x or y 0.
// Source: Everitt, Projective Texture Mapping, P_p in (3); OpenGL 2.1 specification, 2.11 (gluPerspective's lens);
// DirectXMath, XMMatrixPerspectiveFovLH.
inline std::optional<ProjectorProjection> perspective(const PerspectiveLens& lens,
                                                      const Conventions& conventions) noexcept;

// Makes the projection of a lens that may be off its axis: (right + left)/(right - left) and (top + bottom)/(top -
// bottom) stand in column z.
// Guarantee, shape: as perspective().
// Bad input: empty unless all fields are finite, left != right, bottom != top, and 0 < z_near < z_far; and where
// doubles cannot hold the matrix, as perspective().
// Source: OpenGL 2.1 specification, 2.11.2 (glFrustum).
inline std::optional<ProjectorProjection> frustum(const FrustumLens& lens, const Conventions& conventions) noexcept;

// Makes the projection of parallel rays: the last row is (0, 0, 0, 1), so q = 1.
// Guarantee, shape: as perspective().
// Bad input: empty unless all fields are finite, left != right, bottom != top, and z_near < z_far; and where doubles
// cannot hold the matrix, as perspective().
// Source: OpenGL 2.1 specification, 2.11.2 (glOrtho).
inline std::optional<ProjectorProjection> orthographic(const OrthographicLens& lens,
                                                       const Conventions& conventions) noexcept;

// Makes the projection of a calibrated camera, so that a projector throws a picture where the camera saw it. With (u,
// v) the pixel K (R X + t), counted from the picture's edge, s is u/width, and t is v/height, or 1 - v/height where the
// texture's origin is at the bottom. For OpenGL, with the pixel centres at half,
//
//     | 2 fx/width  -2 skew/width  1 - 2 cx/width        0      |
//     |     0        2 fy/height   2 cy/height - 1       0      |
//
// and the rows z and w of perspective(). With the pixel centres at integers, cx + 1/2 and cy + 1/2 stand for cx and cy.
// Guarantee, shape: as perspective().
// Bad input: empty unless fx, fy, width, height > 0 and 0 < z_near < z_far, and all but z_far are finite; and where
// doubles cannot hold the matrix, as perspective().
// Source: Hartley and Zisserman, Multiple View Geometry, 6.1; OpenCV's camera model without distortion.
inline std::optional<ProjectorProjection> pinhole(const PinholeLens& lens, const Conventions& conventions) noexcept;

// How far a side of a rectangle by contain() may be from the exact one: relative to the largest of the lens, which is
// above 2^-960.
inline constexpr double contain_error = 0x1p-50;

// Narrows a lens to a picture of another aspect, width over height, so that all of the picture is in the light of the
// lens as it was, about its middle: what remains of the light would be bars.
// Guarantee: the fovy within 4 double ulp where it is above 2^-900, the sides of a rectangle within contain_error; two
// opposite sides keep their places, and a lens of that aspect stays as it is. No allocation, noexcept.
// Bad input: a lens that perspective(), frustum() or orthographic() refuses, where an aspect, the picture's or the
// lens's, is not positive and finite, or where the given lens is refused for more than a scale that is 0 in double.
// Where no two doubles are so near to each other that they have the aspect, two sides are the same.
[[nodiscard]] inline PerspectiveLens contain(const PerspectiveLens& lens, double aspect) noexcept;
[[nodiscard]] inline FrustumLens contain(const FrustumLens& lens, double aspect) noexcept;
[[nodiscard]] inline OrthographicLens contain(const OrthographicLens& lens, double aspect) noexcept;

// How far a side by cover() may be from the exact one: relative to the largest of the picture's region.
inline constexpr double cover_error = 0x1p-51;

// Crops a picture of another aspect, width over height, to the part about its middle that fills the light of a lens.
// Guarantee: within cover_error; a picture of the lens's aspect stays as it is, and the picture's depth is kept. No
// allocation, noexcept.
// Bad input: a region without points where an aspect, the picture's or the lens's, is not positive and finite.
[[nodiscard]] inline TextureRegion cover(const PerspectiveLens& lens, double aspect,
                                         const TextureRegion& picture = whole_texture()) noexcept;
[[nodiscard]] inline TextureRegion cover(const FrustumLens& lens, double aspect,
                                         const TextureRegion& picture = whole_texture()) noexcept;
[[nodiscard]] inline TextureRegion cover(const OrthographicLens& lens, double aspect,
                                         const TextureRegion& picture = whole_texture()) noexcept;

// Makes the view V_p of a projector that stands at the position and looks at the target.
// Guarantee: each element of the rotation within 4 double ulp of 1 (2^-50) of the definition's, its rows orthonormal
// within that, with `up` as near to the view as 2^-97 rad; the translation -R position is within 1 ulp of its exact
// value for the rotation that is returned, at any distance from the origin and however it cancels. No allocation,
// noexcept.
// Shape: world to projector eye space; the position goes to 0, the target onto the negative z axis (positive where
// world and eye are left-handed), up has x = 0.
// Bad input: empty where target equals position, up is zero or parallel to the view to 2^-98 rad, or a number is not
// finite, those of the translation among them.
// Source: Everitt, Projective Texture Mapping, V_p in (3); OpenGL utility library, gluLookAt; DirectXMath,
// XMMatrixLookAtLH.
inline std::optional<ProjectorView> look_at(const Aim& aim, Handedness handedness = Handedness::right) noexcept;

// Makes the view of a camera that OpenCV has posed, x_camera = R x + t, with x to the right, y down and z forwards:
// diag(1, -1, -1) [R|t], or diag(1, -1, 1) [R|t] where the world is left-handed (then R mirrors). rotation[column][row]
// is the element of R, which cv::Rodrigues() makes of solvePnP()'s vector: its memory goes row by row, so that R is
// glm::transpose(glm::make_mat3(...)) of that.
// Guarantee: each element is kept exactly; no allocation, noexcept.
// Shape: world to projector eye space.
// Bad input: empty for what is not finite. Whether R is a rotation is not tested.
inline std::optional<ProjectorView> view_from_opencv(const glm::dmat3& rotation, const glm::dvec3& translation,
                                                     Handedness handedness = Handedness::right) noexcept;

// Makes the view that a mirror shows: V R, R the reflection x - 2 n (n.x + d) / |n|^2 in the plane n.x + d = 0. A
// projector with it throws a picture that was rendered with it back onto the plane: a planar reflection.
// Guarantee: each element within 1 double ulp of its exact value, or 2^-96 of its terms where they cancel to less,
// while no number but 0 leaves 2^-200 .. 2^200; no allocation, noexcept.
// Shape: world to the mirrored eye space; (n, d) over the world, n of any length. As in every mirror the handedness is
// the other one: what was front-facing faces back, and diagnose() is told so by LensFacts::mirrored.
// Bad input: empty where n is zero, and where the plane, the view or an element of the result is not finite.
inline std::optional<ProjectorView> mirrored(const ProjectorView& view, const glm::dvec4& plane) noexcept;

// Makes a projector of a lens and an aim, both of the conventions' handedness: empty where the lens or the aim is
// refused. Guarantees as those of the lens and of look_at().
inline std::optional<Projector> make_projector(const PerspectiveLens& lens, const Aim& aim,
                                               const Conventions& conventions) noexcept;
inline std::optional<Projector> make_projector(const FrustumLens& lens, const Aim& aim,
                                               const Conventions& conventions) noexcept;
inline std::optional<Projector> make_projector(const OrthographicLens& lens, const Aim& aim,
                                               const Conventions& conventions) noexcept;
inline std::optional<Projector> make_projector(const PinholeLens& lens, const Aim& aim,
                                               const Conventions& conventions) noexcept;

}  // namespace TEXGEN_NAMESPACE

#include "detail/matrices/aim.inc.hpp"
#include "detail/matrices/aspect.inc.hpp"
#include "detail/matrices/lens.inc.hpp"
