#pragma once

// Floor 3: the texgen matrices. Object linear T_o = S P_p V_p M, eye linear T_e = S P_p V_p V_e^-1, and the eye planes
// that glTexGen stores. All are composed in double, nearest spaces first, and rounded once by whoever needs floats: far
// from the origin the large translations of V_p and of M (or V_e^-1) cancel in one another before anything else.

#include "detail/language.hpp"

#include <array>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/inverse.hpp"
#include "detail/arithmetic/widen.hpp"
#include "detail/points/forms.hpp"
#include "primitives.hpp"
#include "projector.hpp"
#include "scale_bias.hpp"
#include "transform.hpp"

namespace TEXGEN_NAMESPACE {

// Makes the texgen matrix of the world, S P_p V_p.
// Guarantee: in double, 8 roundings a term at most; no allocation, noexcept.
// Shape: world points to homogeneous (s, t, r, q) in the units of the region; q > 0 in front of the projector.
// Bad input: NaN and infinity of the projector stay in the elements that they reach.
// Source: Everitt, Projective Texture Mapping, (3) with M = I.
inline WorldTexgen texture_from_world(const Projector& projector, const TextureRegion& region = whole_texture(),
                                      DepthMapping depth = DepthMapping::unit) noexcept;

// Makes the texgen matrix of an object, T_o = S P_p V_p M. It must be made anew whenever M, V_p or P_p changes. In a
// vertex shader, which gets rounded() and does not divide:
//
//     strq = texture_from_object * vec4(position, 1.0);
//
// Guarantee: in double. Rounded to float it is within 0.002 texel of a 4096 texture, at any distance up to 1e7 from the
// origin, for a slide that the object is near to; no allocation, noexcept.
// Shape: object points to homogeneous (s, t, r, q).
// Bad input: as texture_from_world().
// Source: Everitt, Projective Texture Mapping, (3).
inline ObjectTexgen object_linear(const Projector& projector, const ModelMatrix& world_from_object,
                                  const TextureRegion& region = whole_texture(),
                                  DepthMapping depth = DepthMapping::unit) noexcept;

// Makes the texgen matrix of a camera's eye space, T_e = S P_p V_p V_e^-1: one matrix serves every object of the frame.
// Guarantee: in double, as accurate as object_linear(); no allocation, noexcept.
// Shape: the camera's eye points to homogeneous (s, t, r, q). The camera is given as its pose, V_e^-1: no inverse is
// taken.
// Bad input: as texture_from_world().
// Source: Everitt, Projective Texture Mapping, (4).
inline EyeTexgen eye_linear(const Projector& projector, const CameraPose& world_from_eye,
                            const TextureRegion& region = whole_texture(),
                            DepthMapping depth = DepthMapping::unit) noexcept;

// Makes the texgen matrix of a projector that the camera carries, S P_p V, with V from the camera's eye space to the
// projector's: a flashlight. It holds for all frames, wherever the camera goes; the identity is a light at the eye.
// Guarantee: in double, 8 roundings a term at most; no allocation, noexcept.
// Shape: the camera's eye points to homogeneous (s, t, r, q). Its planes are for glTexGen under the identity as
// MODELVIEW.
// Bad input: as texture_from_world().
// Source: Segal et al., Fast Shadows and Lighting Effects Using Texture Mapping; SGI's recipe for projective textures.
inline EyeTexgen eye_linear(const ProjectorProjection& projection, const Transform<ProjectorEye, Eye>& view,
                            const Conventions& conventions, const TextureRegion& region = whole_texture(),
                            DepthMapping depth = DepthMapping::unit) noexcept;

// How far s/q of a fragment by window_linear() may be from the exact value: relative to (m_s + |s/q| m_q) / |q|, with m
// the products of the factors' magnitudes on the fragment.
inline constexpr double window_linear_error = 0x1p-47;

// Makes the texgen matrix of a camera's window, T_w = S P_p V_p (W P_c V_c)^-1: it takes a fragment of the depth buffer
// to the slide, for decals and projectors' light that are deferred, and for a photograph on a g-buffer. In a fragment
// shader:
//
//     vec4 strq = texture_from_window * vec4(gl_FragCoord.xy, texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r, 1.0);
//
// Guarantee: in double, each row solved against V_c and P_c as they are. s/q and t/q of a fragment are within
// window_linear_error of their exact values, as far from the origin as 1e7, while the condition of V_c and of P_c (rows
// and columns scaled) stays below 1e8. No allocation, noexcept.
// Shape: (x, y, depth, 1) to homogeneous (s, t, r, q) over the camera's w: q > 0 in front of the projector for all that
// the camera sees. The depth is what the buffer holds: NDC z, or (z + 1)/2 under OpenGL's range. y grows as NDC y does:
// for pixels from the top down (Direct3D, Metal) give the viewport {x, y + height, width, -height}; with Vulkan's y
// down it is as it is.
// Bad input: empty where inverse() refuses V_c or P_c, but for what overflows, the viewport's width or height is 0, or
// a number is not finite. The camera's conventions are its own.
// Cost: 2 to 3 us. Of a camera with many projectors, eye_linear() of each times one inverse of Transform<Window,
// Eye>(W P_c), made once, takes 40 ns; it errs little more, but nothing bounds that.
// Source: Everitt, Projective Texture Mapping, (4), with the window in the place of the eye.
inline std::optional<WindowTexgen> window_linear(const Projector& projector, const Projector& camera,
                                                 const Viewport& viewport,
                                                 const TextureRegion& region = whole_texture(),
                                                 DepthMapping depth = DepthMapping::unit) noexcept;

enum class DepthBuffer { unorm16, unorm24, float32 };  // what a depth is rounded to

// Bounds how far s and t of a fragment may be off because the depth buffer holds a rounded depth. The fragment is given
// with that rounded depth.
// Guarantee: s/q (x) and t/q (y) of this matrix differ by at most that between the fragment and any depth that is
// stored as this one; infinite where some of those depths are not in front of the projector. A reversed depth in
// float32 has small depths far away, and so small errors. The rounding of the hardware is taken as 0.6 of a step of the
// integers, as Direct3D allows, and half an ulp of float, in which a shader reads it. This holds for a matrix whose
// elements, but for 0, are from 2^-500 to 2^500. No allocation, noexcept.
// Bad input: infinite for what is not finite.
inline glm::dvec2 depth_error_bound(const WindowTexgen& texture_from_window, const glm::vec3& fragment,
                                    DepthBuffer buffer) noexcept;

// Returns what OpenGL stores when the rows of `planes` are given to glTexGen under that MODELVIEW: each row p becomes p
// M^-1.
// Guarantee: solved and refined, so that rounded to float it is within 0.54 ulp of its largest component while the
// condition of M (rows and columns scaled) stays below 1e8 and no row of M is more than 2^20 times as large as another;
// beyond that, eye_planes_error_bound() says. No allocation, noexcept.
// Shape: planes over the space that M takes to the eye. The rows of S P_p V_p under MODELVIEW = V_e give T_e.
// Bad input: empty where inverse() refuses M, but for what overflows, or where a plane, M or a result is not finite.
// Source: OpenGL compatibility specification, "Generating Texture Coordinates": p' = p M^-1, M current at the time of
// the call.
template <class Space>
std::optional<EyeTexgen> eye_planes_as_stored(const Transform<Texture, Space>& planes,
                                              const Transform<Eye, Space>& modelview) noexcept;

// Bounds |stored - planes M^-1|, element by element, for any `stored`: what eye_planes_as_stored() answers, the same
// rounded to float, or what glGetTexGen returned.
// Guarantee: next to the error itself while the condition of M (rows and columns scaled) stays below 1e7. No
// allocation, noexcept.
// Shape: elements as in stored.matrix(), planes and M as for eye_planes_as_stored().
// Bad input: infinite where M is refused; a NaN or an infinity of a plane, given or stored, stays in its row, as does
// one that their products make.
// Source: the residual of a solution bounds its error: Higham, Accuracy and Stability of Numerical Algorithms, 7.
template <class Space>
glm::dmat4 eye_planes_error_bound(const Transform<Texture, Space>& planes, const Transform<Eye, Space>& modelview,
                                  const EyeTexgen& stored) noexcept;

// Returns the rows S, T, R, Q, each element rounded once: what glTexGenfv is given.
template <class Space>
std::array<glm::vec4, 4> planes(const Transform<Texture, Space>& transform) noexcept;

}  // namespace TEXGEN_NAMESPACE

#include "detail/matrices/linear.inc.hpp"
