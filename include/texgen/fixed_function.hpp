#pragma once

// Floor 3: the texture coordinate generation of one OpenGL texture unit, as the fixed function has it: per coordinate
// an enable, a mode, an object plane and an eye plane; and the texture matrix behind them.

#include "detail/language.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "detail/arithmetic/inverse.hpp"
#include "detail/arithmetic/rounding.hpp"
#include "detail/arithmetic/widen.hpp"
#include "detail/assert.hpp"
#include "detail/matrices/vectors.hpp"

namespace TEXGEN_NAMESPACE {

// The modes that glTexGen calls GL_OBJECT_LINEAR and so on, and its coordinates GL_S to GL_Q.
enum class TexGenMode { object_linear, eye_linear, sphere_map, reflection_map, normal_map };
enum class Coordinate { s, t, r, q };

// A vertex as glVertex, glNormal and glTexCoord give it. Position and normal are in object space.
struct FixedFunctionVertex {
    glm::vec4 position;
    glm::vec3 normal{0.0f, 0.0f, 1.0f};
    glm::vec4 texcoord{0.0f, 0.0f, 0.0f, 1.0f};
};

// One unit: its state, as glGetTexGen would return it, and what it generates. It starts with OpenGL's defaults: every
// coordinate off, mode eye_linear, both planes S = (1,0,0,0), T = (0,1,0,0), R = Q = (0,0,0,0), the identity as texture
// matrix. Enabling q without giving it a plane therefore makes q = 0.
// No function allocates, throws or keeps anything outside the object. A Coordinate, TexGenMode or NormalScaling that is
// none of its enumerators is ignored, as OpenGL ignores what it answers with INVALID_ENUM.
// Source: OpenGL 2.1 specification (and later compatibility profiles), 2.11.4, Generating Texture Coordinates.
class TexGenUnit {
public:
    // How a normal n M^-1 is treated in eye space: left alone, scaled by 1/|third row of M^-1| (GL_RESCALE_NORMAL: unit
    // again where M scales uniformly; left alone where that row is 0), or divided by its length (GL_NORMALIZE).
    enum class NormalScaling { none, rescale, normalize };

    // Turns the generation of a coordinate on or off.
    void enable(Coordinate coordinate, bool on = true) noexcept;
    bool enabled(Coordinate coordinate) const noexcept { return state(coordinate).enabled; }

    // Says how a coordinate is generated.
    // Guarantee: false, and the state as it was, where OpenGL says INVALID_ENUM: sphere_map is for s and t,
    // reflection_map and normal_map for s, t and r, the linear modes for all.
    [[nodiscard]] bool set_mode(Coordinate coordinate, TexGenMode mode) noexcept;
    TexGenMode mode(Coordinate coordinate) const noexcept { return state(coordinate).mode; }

    // Stores a plane of object space as it is: a row; object_linear gives plane . position.
    void set_object_plane(Coordinate coordinate, const glm::vec4& plane) noexcept;

    // Stores p M^-1, the plane of the eye's space that `plane` is under this MODELVIEW. It is a snapshot: whatever
    // MODELVIEW becomes later, the stored plane stays. T(10, 20, 30) with p = (1, 2, 3, 4) stores (1, 2, 3, -136).
    // Guarantee: solved in double and rounded once: each component within 0.54 float ulp of the exact one, or within
    // 2^-60 of the largest one, while the condition of M (rows and columns scaled) stays below 1e8 and no row of M is
    // more than 2^20 times as large as another; beyond that, eye_plane_error_bound() says.
    // Shape: `plane` is a row p over the space that `modelview` takes to the eye; the stored plane is a row over the
    // eye.
    // Bad input: false, and the state as it was, where M is singular to working precision (by its residual, never by
    // the size of a determinant: any uniform scale is regular), where M or p is not finite, or where a component of the
    // result is beyond the largest float.
    // Far from the origin a float plane is itself the error; eye_linear() in linear.hpp composes in double.
    [[nodiscard]] bool set_eye_plane(Coordinate coordinate, const glm::vec4& plane,
                                     const glm::mat4& modelview) noexcept;

    // Bounds how far each component of the stored eye plane of this coordinate is from p M^-1, the rounding to float
    // included.
    // Guarantee: next to the error itself while the condition of M (rows and columns scaled) stays below 1e7 and these
    // are within 2^40 of one another in size; never below it.
    // Bad input: infinite where set_eye_plane() refuses M; a NaN or an infinity of p stays one.
    glm::dvec4 eye_plane_error_bound(Coordinate coordinate, const glm::vec4& plane,
                                     const glm::mat4& modelview) const noexcept;

    // Return what glGetTexGenfv does: the eye plane is p M^-1, in eye space. Zero for no coordinate.
    glm::vec4 object_plane(Coordinate coordinate) const noexcept { return state(coordinate).object_plane; }
    glm::vec4 eye_plane(Coordinate coordinate) const noexcept { return state(coordinate).eye_plane; }

    // The texture matrix multiplies (s, t, r, q), generated or the vertex's own.
    void set_texture_matrix(const glm::mat4& matrix) noexcept { texture_matrix_ = matrix; }
    const glm::mat4& texture_matrix() const noexcept { return texture_matrix_; }

    void set_normal_scaling(NormalScaling scaling) noexcept;
    NormalScaling normal_scaling() const noexcept { return normal_scaling_; }

    // Generates the (s, t, r, q) of a vertex, as this unit does under a MODELVIEW.
    // Guarantee: in double from the float state and input, rounded once. With the identity as texture matrix a
    // coordinate's error is at most 1/2 float ulp + 2^-50 of its exact value and, below condition 1e6 of M (rows and
    // columns scaled),
    //     object_linear   2^-100 sum |p_i v_i|
    //     eye_linear      2^-50 sum |p'_i e_i|
    //     normal_map      2^-48 k
    //     reflection_map  2^-48 (1 + k)^2
    //     sphere_map      2^-48 (1 + k)^2 / m  and never outside [0, 1]
    // with k the length of (sum_i |normal_i| |M^-1_ij|)_j under the normal scaling: |n| where nothing cancels.
    // Another texture matrix multiplies these errors, before the rounding, and adds 2^-50 of its terms. A coordinate
    // that is off is the vertex's own.
    // Shape: `modelview` takes the vertex's object space to the eye. With e = M v, u = e.xyz / |e.xyz| (not divided by
    // e.w), n = normal M^-1 under the normal scaling, and r = u - 2 n (n . u):
    //     object_linear   object plane . v        eye_linear   eye plane . e  (no inverse is taken here)
    //     reflection_map  (s, t, r) = r           normal_map   (s, t, r) = n
    //     sphere_map      m = 2 sqrt(rx^2 + ry^2 + (rz + 1)^2), s = rx / m + 1/2, t = ry / m + 1/2
    // n uses the upper 3x3 of M^-1. For a MODELVIEW with a projective last row OpenGL leaves a choice; this is Mesa's.
    // Bad input: m = 0, the singularity of the sphere map, gives (1/2, 1/2) where no rounding comes before it, and else
    // any direction of 1/2 about that. A vertex at the eye has no direction: u = 0. A zero normal stays zero under
    // normalize. Where M is singular or not finite, OpenGL leaves normals undefined: sphere_map, reflection_map and
    // normal_map give NaN, and the other modes are not touched by it. A NaN or an infinity spoils the coordinates that
    // are made from it (a texture matrix other than the identity mixes them).
    // Source: OpenGL 2.1 specification, 2.11.3, Normal Transformation, and 2.11.4, Generating Texture Coordinates.
    glm::vec4 generate(const FixedFunctionVertex& vertex, const glm::mat4& modelview) const noexcept;

    // Generates the same bits for many vertices under one MODELVIEW, whose inverse is taken once, and only where a mode
    // needs it. Precondition, asserted: as many outputs as vertices; else nothing is written.
    void generate(const std::span<const FixedFunctionVertex>& vertices, const glm::mat4& modelview,
                  const std::span<glm::vec4>& strq) const noexcept;

private:
    struct CoordinateState {
        bool enabled = false;
        TexGenMode mode = TexGenMode::eye_linear;
        glm::vec4 object_plane{0.0f};
        glm::vec4 eye_plane{0.0f};
    };
    struct EyeSpace;

    CoordinateState* find(Coordinate coordinate) noexcept;        // null for no coordinate
    CoordinateState state(Coordinate coordinate) const noexcept;  // off and zero for no coordinate
    glm::vec4 generate(const FixedFunctionVertex& vertex, const EyeSpace& eye_space) const noexcept;

    std::array<CoordinateState, 4> states_{
        CoordinateState{.object_plane = {1.0f, 0.0f, 0.0f, 0.0f}, .eye_plane = {1.0f, 0.0f, 0.0f, 0.0f}},
        CoordinateState{.object_plane = {0.0f, 1.0f, 0.0f, 0.0f}, .eye_plane = {0.0f, 1.0f, 0.0f, 0.0f}},
        CoordinateState{}, CoordinateState{}};
    glm::mat4 texture_matrix_{1.0f};
    NormalScaling normal_scaling_ = NormalScaling::none;
};

}  // namespace TEXGEN_NAMESPACE

#include "detail/matrices/fixed_function.inc.hpp"
