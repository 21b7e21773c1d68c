#pragma once

// Floor 3: the texture coordinate generation of one OpenGL texture unit, as the fixed function has it: per coordinate an
// enable, a mode, an object plane and an eye plane; and the texture matrix behind them.

#include "detail/language.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "detail/arithmetic/inverse.hpp"
#include "detail/arithmetic/rounding.hpp"
#include "detail/arithmetic/widen.hpp"
#include "detail/assert.hpp"

namespace TEXGEN_NAMESPACE {

// What glTexGen calls GL_OBJECT_LINEAR and so on, and GL_S to GL_Q.
enum class TexGenMode { object_linear, eye_linear, sphere_map, reflection_map, normal_map };
enum class Coordinate { s, t, r, q };

// What glVertex, glNormal and glTexCoord say. Position and normal are in object space.
struct FixedFunctionVertex {
    glm::vec4 position;
    glm::vec3 normal{0.0f, 0.0f, 1.0f};
    glm::vec4 texcoord{0.0f, 0.0f, 0.0f, 1.0f};
};

// One unit's state, as glGetTexGen would return it. It starts with OpenGL's defaults: every coordinate off, mode
// eye_linear, both planes S = (1,0,0,0), T = (0,1,0,0), R = Q = (0,0,0,0), the identity as texture matrix. Enabling q
// without giving it a plane therefore makes q = 0.
// No function allocates, throws or keeps anything outside the object. A Coordinate, TexGenMode or NormalScaling that is
// none of its enumerators is ignored, as OpenGL ignores what it answers with INVALID_ENUM.
// Source: OpenGL 2.1 specification (and later compatibility profiles), 2.11.4, Generating Texture Coordinates.
class TexGenUnit {
public:
    // How a normal n M^-1 is treated in eye space: left alone, scaled by 1/|third row of M^-1| (GL_RESCALE_NORMAL: unit
    // again where M scales uniformly), or divided by its length (GL_NORMALIZE).
    enum class NormalScaling { none, rescale, normalize };

    void enable(Coordinate coordinate, bool on = true) noexcept {
        if (valid(coordinate)) state(coordinate).enabled = on;
    }
    bool enabled(Coordinate coordinate) const noexcept { return valid(coordinate) && state(coordinate).enabled; }

    // Guarantee: false, and the state as it was, where OpenGL says INVALID_ENUM: sphere_map is for s and t,
    // reflection_map and normal_map for s, t and r, the linear modes for all; a value outside the enumerations is
    // nobody's.
    [[nodiscard]] bool set_mode(Coordinate coordinate, TexGenMode mode) noexcept;
    TexGenMode mode(Coordinate coordinate) const noexcept {
        return valid(coordinate) ? state(coordinate).mode : TexGenMode::eye_linear;
    }

    // Guarantee: stores the plane as it is.
    // Shape: a row over object space; object_linear gives plane . position.
    void set_object_plane(Coordinate coordinate, glm::vec4 plane) noexcept {
        if (valid(coordinate)) state(coordinate).object_plane = plane;
    }

    // Guarantee: stores p M^-1, solved in double and rounded once: each component within 0.54 float ulp of the exact one,
    // or within 2^-60 of the largest one, while the condition of M (rows and columns scaled) stays below 1e8. It is a
    // snapshot: whatever MODELVIEW becomes later, the stored plane stays. T(10, 20, 30) with p = (1, 2, 3, 4) stores
    // (1, 2, 3, -136).
    // Shape: `plane` is a row p over the space that `modelview` takes to the eye; the stored plane is a row over the eye.
    // Bad input: false, and the state as it was, where M is singular to working precision (by its residual, never by the
    // size of a determinant: any uniform scale is regular), where M or p is not finite, or where a component of the
    // result is beyond the largest float.
    // Far from the origin a float plane is itself the error; eye_linear() in linear.hpp composes in double.
    [[nodiscard]] bool set_eye_plane(Coordinate coordinate, glm::vec4 plane, const glm::mat4& modelview) noexcept;

    // Guarantee: how far each component of the stored eye plane of this coordinate is from p M^-1, at most, the rounding to
    // float included. Next to the error itself while the condition of M (rows and columns scaled) stays below 1e7.
    // Bad input: infinite where set_eye_plane() refuses M; a NaN or an infinity of p stays one.
    glm::dvec4 eye_plane_error_bound(Coordinate coordinate, glm::vec4 plane,
                                     const glm::mat4& modelview) const noexcept {
        return detail::CertifiedInverse(detail::widened(modelview))
            .error_of(detail::widened(eye_plane(coordinate)), detail::widened(plane));
    }

    // As glGetTexGenfv returns them: the eye plane is p M^-1, in eye space. Zero for no coordinate.
    glm::vec4 object_plane(Coordinate coordinate) const noexcept {
        return valid(coordinate) ? state(coordinate).object_plane : glm::vec4(0.0f);
    }
    glm::vec4 eye_plane(Coordinate coordinate) const noexcept {
        return valid(coordinate) ? state(coordinate).eye_plane : glm::vec4(0.0f);
    }

    // The texture matrix multiplies (s, t, r, q), generated or the vertex's own.
    void set_texture_matrix(const glm::mat4& matrix) noexcept { texture_matrix_ = matrix; }
    const glm::mat4& texture_matrix() const noexcept { return texture_matrix_; }

    void set_normal_scaling(NormalScaling scaling) noexcept {
        if (scaling == NormalScaling::none || scaling == NormalScaling::rescale || scaling == NormalScaling::normalize)
            normal_scaling_ = scaling;
    }
    NormalScaling normal_scaling() const noexcept { return normal_scaling_; }

    // Guarantee: (s, t, r, q) in double from the float state and input, rounded once. With the identity as texture matrix
    // a coordinate's error is at most 1/2 float ulp + 2^-50 of its exact value and, below condition 1e6 of M (rows and
    // columns scaled),
    //     object_linear   2^-100 sum |p_i v_i|
    //     eye_linear      2^-50 sum |p'_i e_i|
    //     normal_map      2^-48 k         with k the length of (sum_i |normal_i| |M^-1_ij|)_j under the normal scaling:
    //     reflection_map  2^-48 (1 + k)^2      |n| where nothing cancels
    //     sphere_map      2^-48 (1 + k)^2 / m  and never outside [0, 1]
    // Another texture matrix multiplies these errors, before the rounding, and adds 2^-50 of its terms. A coordinate that
    // is off is the vertex's own.
    // Shape: `modelview` takes the vertex's object space to the eye. With e = M v, u = e.xyz / |e.xyz| (not divided by
    // e.w), n = normal M^-1 under the normal scaling, and r = u - 2 n (n . u):
    //     object_linear   object plane . v        eye_linear   eye plane . e  (no inverse is taken here)
    //     reflection_map  (s, t, r) = r           normal_map   (s, t, r) = n
    //     sphere_map      m = 2 sqrt(rx^2 + ry^2 + (rz + 1)^2), s = rx / m + 1/2, t = ry / m + 1/2
    // n uses the upper 3x3 of M^-1. For a MODELVIEW with a projective last row OpenGL leaves a choice; this is Mesa's.
    // Bad input: m = 0, the singularity of the sphere map, gives (1/2, 1/2). A vertex at the eye has no direction: u = 0.
    // A zero normal stays zero under normalize. Where M is singular or not finite, OpenGL leaves normals undefined:
    // sphere_map, reflection_map and normal_map give NaN, and the other modes are not touched by it. A NaN or an infinity
    // spoils the coordinates that are made from it (a texture matrix other than the identity mixes them).
    // Source: OpenGL 2.1 specification, 2.11.3, Normal Transformation, and 2.11.4, Generating Texture Coordinates.
    glm::vec4 generate(const FixedFunctionVertex& vertex, const glm::mat4& modelview) const noexcept {
        return generate(vertex, EyeSpace(modelview, *this));
    }

    // The same bits for many vertices under one MODELVIEW, whose inverse is taken once, and only where a mode needs it.
    // Precondition, asserted: as many outputs as vertices.
    void generate(std::span<const FixedFunctionVertex> vertices, const glm::mat4& modelview,
                  std::span<glm::vec4> strq) const noexcept {
        TEXGEN_ASSERT(vertices.size() == strq.size());
        const EyeSpace eye_space(modelview, *this);
        for (std::size_t i = 0; i < vertices.size(); ++i) strq[i] = generate(vertices[i], eye_space);
    }

private:
    struct CoordinateState {
        bool enabled = false;
        TexGenMode mode = TexGenMode::eye_linear;
        glm::vec4 object_plane{0.0f};
        glm::vec4 eye_plane{0.0f};
    };

    // The way from object space to the eye, prepared once for a MODELVIEW, as far as the unit's modes need it.
    class EyeSpace {
    public:
        EyeSpace(const glm::mat4& modelview, const TexGenUnit& unit) noexcept;

        bool wants_position() const noexcept { return wants_position_; }
        bool wants_normal() const noexcept { return wants_normal_; }
        glm::dvec4 position(const glm::vec4& position) const noexcept;
        glm::dvec3 normal(const glm::vec3& normal) const noexcept;  // under the unit's normal scaling

    private:
        bool wants_position_ = false, wants_normal_ = false;
        NormalScaling scaling_;
        glm::mat4 rows_;
        glm::dmat3 inverse_{1.0};  // the upper 3x3 of M^-1
        double rescale_ = 1.0;
    };

    static constexpr bool valid(Coordinate coordinate) noexcept {
        return coordinate == Coordinate::s || coordinate == Coordinate::t || coordinate == Coordinate::r ||
               coordinate == Coordinate::q;
    }
    static constexpr bool uses_normal(TexGenMode mode) noexcept {
        return mode == TexGenMode::sphere_map || mode == TexGenMode::reflection_map || mode == TexGenMode::normal_map;
    }
    CoordinateState& state(Coordinate coordinate) noexcept { return states_[static_cast<std::size_t>(coordinate)]; }
    const CoordinateState& state(Coordinate coordinate) const noexcept {
        return states_[static_cast<std::size_t>(coordinate)];
    }

    // Fused by hand: a compiler that fuses where it likes would make the bits depend on what is inlined.
    static double dot(const glm::dvec3& a, const glm::dvec3& b) noexcept {
        return std::fma(a.z, b.z, std::fma(a.y, b.y, a.x * b.x));
    }
    static double dot(const glm::dvec4& a, const glm::dvec4& b) noexcept {
        return std::fma(a.w, b.w, std::fma(a.z, b.z, std::fma(a.y, b.y, a.x * b.x)));
    }
    static double cancelling_dot(const glm::vec4& a, const glm::vec4& b) noexcept;
    static double largest(const glm::dvec3& v) noexcept {
        return std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z)));
    }
    static glm::dvec3 times_power_of_two(const glm::dvec3& v, int exponent) noexcept {
        return {std::scalbn(v.x, exponent), std::scalbn(v.y, exponent), std::scalbn(v.z, exponent)};
    }
    static glm::dvec3 direction(const glm::dvec3& v) noexcept;

    glm::vec4 generate(const FixedFunctionVertex& vertex, const EyeSpace& eye_space) const noexcept;

    std::array<CoordinateState, 4> states_{
        CoordinateState{.object_plane = {1.0f, 0.0f, 0.0f, 0.0f}, .eye_plane = {1.0f, 0.0f, 0.0f, 0.0f}},
        CoordinateState{.object_plane = {0.0f, 1.0f, 0.0f, 0.0f}, .eye_plane = {0.0f, 1.0f, 0.0f, 0.0f}},
        CoordinateState{}, CoordinateState{}};
    glm::mat4 texture_matrix_{1.0f};
    NormalScaling normal_scaling_ = NormalScaling::none;
};

inline bool TexGenUnit::set_mode(Coordinate coordinate, TexGenMode mode) noexcept {
    if (!valid(coordinate)) return false;
    switch (mode) {
        case TexGenMode::object_linear:
        case TexGenMode::eye_linear:
            break;
        case TexGenMode::sphere_map:
            if (coordinate != Coordinate::s && coordinate != Coordinate::t) return false;
            break;
        case TexGenMode::reflection_map:
        case TexGenMode::normal_map:
            if (coordinate == Coordinate::q) return false;
            break;
        default:
            return false;
    }
    state(coordinate).mode = mode;
    return true;
}

inline bool TexGenUnit::set_eye_plane(Coordinate coordinate, glm::vec4 plane, const glm::mat4& modelview) noexcept {
    if (!valid(coordinate)) return false;
    const detail::CertifiedInverse inverse(detail::widened(modelview));
    if (!inverse.regular()) return false;
    const glm::vec4 stored(inverse.solve_row(detail::widened(plane)));
    for (glm::length_t i = 0; i < 4; ++i)
        if (!(std::fabs(stored[i]) <= (std::numeric_limits<float>::max)())) return false;
    state(coordinate).eye_plane = stored;
    return true;
}

// a . b with one rounding: a vertex near the eye, or far from the origin, is a small difference of large terms. The
// product of two floats is exact in double, so only the sum needs care.
inline double TexGenUnit::cancelling_dot(const glm::vec4& a, const glm::vec4& b) noexcept {
    double sum = 0.0, lost = 0.0;
    for (glm::length_t i = 0; i < 4; ++i) {
        const detail::DoubleDouble next = detail::two_sum(sum, detail::widened(a[i]) * detail::widened(b[i]));
        sum = next.high;
        lost += next.low;
    }
    // What is lost of an infinity is no number.
    return std::fabs(sum) <= (std::numeric_limits<double>::max)() ? sum + lost : sum;
}

// v / |v|, and zero for zero. The power of two keeps the squares inside the range of double.
inline glm::dvec3 TexGenUnit::direction(const glm::dvec3& v) noexcept {
    const double size = largest(v);
    if (!(size > 0.0)) return v;
    const glm::dvec3 near_one = times_power_of_two(v, -std::ilogb(size));
    return near_one / std::sqrt(dot(near_one, near_one));
}

inline TexGenUnit::EyeSpace::EyeSpace(const glm::mat4& modelview, const TexGenUnit& unit) noexcept
    : scaling_(unit.normal_scaling_), rows_(glm::transpose(modelview)) {
    for (const CoordinateState& coordinate : unit.states_) {
        if (!coordinate.enabled) continue;
        wants_position_ = wants_position_ || coordinate.mode != TexGenMode::object_linear;
        wants_normal_ = wants_normal_ || uses_normal(coordinate.mode);
    }
    if (!wants_normal_) return;
    const detail::CertifiedInverse inverse(detail::widened(modelview));
    inverse_ = glm::dmat3(inverse.regular() ? inverse.matrix() : glm::dmat4(std::numeric_limits<double>::quiet_NaN()));
    const glm::dvec3 third_row(inverse_[0][2], inverse_[1][2], inverse_[2][2]);
    const double size = largest(third_row);
    // A zero row has no scale to take away; only a projective M has one.
    if (size > 0.0) {
        const int exponent = std::ilogb(size);
        const glm::dvec3 near_one = times_power_of_two(third_row, -exponent);
        rescale_ = std::scalbn(1.0 / std::sqrt(dot(near_one, near_one)), -exponent);
    }
}

inline glm::dvec4 TexGenUnit::EyeSpace::position(const glm::vec4& position) const noexcept {
    return {cancelling_dot(rows_[0], position), cancelling_dot(rows_[1], position), cancelling_dot(rows_[2], position),
            cancelling_dot(rows_[3], position)};
}

inline glm::dvec3 TexGenUnit::EyeSpace::normal(const glm::vec3& normal) const noexcept {
    const glm::dvec3 row = detail::widened(normal);
    const glm::dvec3 result(dot(row, inverse_[0]), dot(row, inverse_[1]), dot(row, inverse_[2]));
    switch (scaling_) {
        case NormalScaling::rescale:
            return result * rescale_;
        case NormalScaling::normalize:
            return direction(result);
        case NormalScaling::none:
            break;
    }
    return result;
}

inline glm::vec4 TexGenUnit::generate(const FixedFunctionVertex& vertex, const EyeSpace& eye_space) const noexcept {
    const glm::dvec4 eye = eye_space.wants_position() ? eye_space.position(vertex.position) : glm::dvec4(0.0);

    // The reflection is held as r 4^-k with n 2^-k near 1 at most, because a normal under a tiny scale can be too long to
    // square. r + (0, 0, 1) is m/2 long, so its direction halved is what the sphere map adds to 1/2: no square root of a
    // difference, and zero where m is.
    glm::dvec3 normal(0.0), scaled_reflection(0.0), sphere(0.0);
    int exponent = 0;
    if (eye_space.wants_normal()) {
        normal = eye_space.normal(vertex.normal);
        const double size = largest(normal);
        if (size > 1.0 && size <= (std::numeric_limits<double>::max)()) exponent = std::ilogb(size);
        const glm::dvec3 n = times_power_of_two(normal, -exponent);
        const glm::dvec3 to_vertex = direction({eye.x, eye.y, eye.z});
        const double n_dot_u = dot(n, to_vertex);
        const glm::dvec3 u = times_power_of_two(to_vertex, -2 * exponent);
        for (glm::length_t i = 0; i < 3; ++i) scaled_reflection[i] = std::fma(-2.0 * n[i], n_dot_u, u[i]);
        sphere = direction(scaled_reflection + glm::dvec3(0.0, 0.0, std::scalbn(1.0, -2 * exponent)));
    }

    glm::dvec4 generated = detail::widened(vertex.texcoord);
    for (glm::length_t i = 0; i < 4; ++i) {
        const CoordinateState& coordinate = states_[static_cast<std::size_t>(i)];
        if (!coordinate.enabled) continue;
        switch (coordinate.mode) {
            case TexGenMode::object_linear:
                generated[i] = cancelling_dot(coordinate.object_plane, vertex.position);
                break;
            case TexGenMode::eye_linear:
                generated[i] = dot(detail::widened(coordinate.eye_plane), eye);
                break;
            case TexGenMode::sphere_map:
                generated[i] = 0.5 + 0.5 * sphere[i];
                break;
            case TexGenMode::reflection_map:
                generated[i] = std::scalbn(scaled_reflection[i], 2 * exponent);
                break;
            case TexGenMode::normal_map:
                generated[i] = normal[i];
                break;
        }
    }
    // The identity is left out, so that a NaN stays in its coordinate.
    if (texture_matrix_ == glm::mat4(1.0f)) return glm::vec4(generated);
    const glm::dmat4 texture_rows = detail::widened(glm::transpose(texture_matrix_));
    return {dot(texture_rows[0], generated), dot(texture_rows[1], generated), dot(texture_rows[2], generated),
            dot(texture_rows[3], generated)};
}

}  // namespace TEXGEN_NAMESPACE
