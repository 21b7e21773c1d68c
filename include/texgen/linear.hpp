#pragma once

// Floor 3: the texgen matrices. Object linear T_o = S P_p V_p M, eye linear T_e = S P_p V_p V_e^-1, and the eye planes
// that glTexGen stores. All are composed in double, nearest spaces first, and rounded once by whoever needs floats: far
// from the origin the large translations of V_p and of M (or V_e^-1) cancel in one another before anything else.

#include "detail/language.hpp"

#include <array>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/inverse.hpp"
#include "projector.hpp"
#include "scale_bias.hpp"
#include "transform.hpp"

namespace TEXGEN_NAMESPACE {

// Makes the texgen matrix of the world, S P_p V_p.
// Guarantee: in double, 12 roundings a term at most; no allocation, noexcept.
// Shape: world points to homogeneous (s, t, r, q) in the units of the region; q > 0 in front of the projector.
// Bad input: NaN and infinity of the projector stay in the elements that they reach.
// Source: Everitt, Projective Texture Mapping, (3) with M = I.
inline WorldTexgen texture_from_world(const Projector& projector, TextureRegion region = whole_texture(),
                                      DepthMapping depth = DepthMapping::unit) noexcept;

// Makes the texgen matrix of an object, T_o = S P_p V_p M. It must be made anew whenever M, V_p or P_p changes. In a vertex
// shader, which gets rounded() and does not divide:
//
//     strq = texture_from_object * vec4(position, 1.0);
//
// Guarantee: in double. Rounded to float it is within 0.002 texel of a 4096 texture, at any distance up to 1e7 from the
// origin, for a slide that the object is near to; no allocation, noexcept.
// Shape: object points to homogeneous (s, t, r, q).
// Bad input: as texture_from_world().
// Source: Everitt, Projective Texture Mapping, (3).
inline ObjectTexgen object_linear(const Projector& projector, const ModelMatrix& world_from_object,
                                  TextureRegion region = whole_texture(),
                                  DepthMapping depth = DepthMapping::unit) noexcept;

// Makes the texgen matrix of a camera's eye space, T_e = S P_p V_p V_e^-1: one matrix serves every object of the frame.
// Guarantee: in double, as accurate as object_linear(); no allocation, noexcept.
// Shape: the camera's eye points to homogeneous (s, t, r, q). The camera is given as its pose, V_e^-1: no inverse is taken.
// Bad input: as texture_from_world().
// Source: Everitt, Projective Texture Mapping, (4).
inline EyeTexgen eye_linear(const Projector& projector, const CameraPose& world_from_eye,
                            TextureRegion region = whole_texture(), DepthMapping depth = DepthMapping::unit) noexcept;

// Makes the texgen matrix of a projector that the camera carries, S P_p V, with V from the camera's eye space to the
// projector's: a flashlight. It holds for all frames, wherever the camera goes; the identity is a light at the eye.
// Guarantee: in double, 8 roundings a term at most; no allocation, noexcept.
// Shape: the camera's eye points to homogeneous (s, t, r, q). Its planes are for glTexGen under the identity as MODELVIEW.
// Bad input: as texture_from_world().
// Source: Segal et al., Fast Shadows and Lighting Effects Using Texture Mapping; SGI's recipe for projective textures.
inline EyeTexgen eye_linear(const ProjectorProjection& projection, const Transform<ProjectorEye, Eye>& view,
                            Conventions conventions, TextureRegion region = whole_texture(),
                            DepthMapping depth = DepthMapping::unit) noexcept;

// Returns what OpenGL stores when the rows of `planes` are given to glTexGen under that MODELVIEW: each row p becomes p M^-1.
// Guarantee: solved and refined, so that rounded to float it is within 0.54 ulp of its largest component while the
// condition of M (rows and columns scaled) stays below 1e8; no allocation, noexcept.
// Shape: planes over the space that M takes to the eye. The rows of S P_p V_p under MODELVIEW = V_e give T_e.
// Bad input: empty where M is singular to working precision, or a plane, M or a result is not finite.
// Source: OpenGL compatibility specification, "Generating Texture Coordinates": p' = p M^-1, M current at the time of
// the call.
template <class Space>
std::optional<EyeTexgen> eye_planes_as_stored(const Transform<Texture, Space>& planes,
                                              const Transform<Eye, Space>& modelview) noexcept;

// Bounds |stored - planes M^-1|, element by element, for any `stored`: what eye_planes_as_stored() answers, the same rounded
// to float, or what glGetTexGen returned.
// Guarantee: next to the error itself while the condition of M (rows and columns scaled) stays below 1e7. No allocation,
// noexcept.
// Shape: elements as in stored.matrix(), planes and M as for eye_planes_as_stored().
// Bad input: infinite where M is refused; a NaN or an infinity of a plane, given or stored, stays in its row.
// Source: see detail/arithmetic/inverse.hpp.
template <class Space>
glm::dmat4 eye_planes_error_bound(const Transform<Texture, Space>& planes, const Transform<Eye, Space>& modelview,
                                  const EyeTexgen& stored) noexcept;

// Returns the rows S, T, R, Q, each element rounded once: what glTexGenfv is given.
template <class Space>
std::array<glm::vec4, 4> planes(const Transform<Texture, Space>& transform) noexcept;

}  // namespace TEXGEN_NAMESPACE

#include "detail/matrices/linear.inc.hpp"
