#pragma once

// Floor 4: texture coordinates of points. generate() gives the homogeneous (s, t, r, q) that a fragment shader divides
// (see README.md, "In a shader"); project() divides them here, and says which points the slide falls on.

#include "detail/language.hpp"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/nearest.hpp"
#include "detail/arithmetic/widen.hpp"
#include "detail/assert.hpp"
#include "detail/culling/lit_test.hpp"
#include "detail/points/forms.hpp"
#include "detail/simd/lanes.hpp"
#include "primitives.hpp"
#include "transform.hpp"

namespace TEXGEN_NAMESPACE {

// Divided coordinates, planar. An empty span is not computed. lit is 1 where the slide falls and 0 elsewhere: in the
// sides of its region and, where it has one, in its depth. Name them, {.s = s, .t = t, .lit = lit}: a third one without
// a name is r.
struct Texcoords {
    std::span<float> s = {}, t = {}, r = {}, lit = {};
};

// Homogeneous coordinates, planar. An empty span is not computed.
struct HomogeneousTexcoords {
    std::span<float> s = {}, t = {}, r = {}, q = {};
};

// A view of points with w = 1 in a known space: three arrays of floats that share a stride. It owns nothing, so that a
// view of a temporary array lives for the same expression alone, and it reads floats at any alignment. Made by
// object_space(), world_space(), eye_space() and window_space().
template <class Space>
class Positions {
public:
    // Three pointers, each to `count` floats that are `stride_bytes` apart (a precondition).
    Positions(const float* x, const float* y, const float* z, std::size_t count, std::size_t stride_bytes) noexcept
        : x_(x), y_(y), z_(z), count_(count), stride_bytes_(stride_bytes) {}

    // An array of vectors; three arrays (of one size, asserted; else there are no points); x, y, z that follow one
    // another every stride_bytes.
    explicit Positions(const std::span<const glm::vec3>& points) noexcept
        : Positions(points.empty() ? nullptr : &points[0].x, points.size(), sizeof(glm::vec3)) {}
    explicit Positions(const std::span<const float>& x, const std::span<const float>& y,
                       const std::span<const float>& z) noexcept
        : Positions(x.data(), y.data(), z.data(), common_size(x, y, z), sizeof(float)) {}
    explicit Positions(const float* first, std::size_t count, std::size_t stride_bytes) noexcept
        : Positions(first, first + (count != 0 ? 1 : 0), first + (count != 0 ? 2 : 0), count, stride_bytes) {}

    std::size_t size() const noexcept { return count_; }

    // Returns the same points with the caller's word that all of them lie in a box (asserted), as an engine has one of
    // each mesh: project() then bounds its errors once instead of block by block. Values are right by the same promises;
    // `exact` has the same bits. Without assertions a point that is not in the box, such as a NaN, gets values that
    // nothing bounds, and spoils no other. A box with min > max or a NaN is none, and takes the place of a former one.
    [[nodiscard]] Positions within(const Box& box) const noexcept;

    // The box that within() was given; min > max without one.
    const Box& bounds() const noexcept { return bounds_; }

    // Whether the layout is one that needs no gathering: one array of vectors, or three arrays of floats, aligned.
    bool is_interleaved() const noexcept {
        return count_ != 0 && stride_bytes_ == 3 * sizeof(float) && y_ == x_ + 1 && z_ == x_ + 2 && is_aligned(x_);
    }
    bool is_planar() const noexcept {
        return stride_bytes_ == sizeof(float) && is_aligned(x_) && is_aligned(y_) && is_aligned(z_);
    }

    const float* x() const noexcept { return x_; }
    const float* y() const noexcept { return y_; }
    const float* z() const noexcept { return z_; }
    std::size_t stride_bytes() const noexcept { return stride_bytes_; }

    glm::vec3 operator[](std::size_t i) const noexcept {
        return {load(x_, i * stride_bytes_), load(y_, i * stride_bytes_), load(z_, i * stride_bytes_)};
    }

private:
    static std::size_t common_size(const std::span<const float>& x, const std::span<const float>& y,
                                   const std::span<const float>& z) noexcept {
        const bool is_common = x.size() == y.size() && x.size() == z.size();
        TEXGEN_ASSERT(is_common);
        return is_common ? x.size() : 0;
    }
    static bool is_aligned(const float* first) noexcept {
        return reinterpret_cast<std::uintptr_t>(first) % alignof(float) == 0;
    }
    static float load(const float* first, std::size_t offset_bytes) noexcept {
        float value;
        std::memcpy(&value, reinterpret_cast<const std::byte*>(first) + offset_bytes, sizeof value);
        return value;
    }

    const float* x_;
    const float* y_;
    const float* z_;
    std::size_t count_;
    std::size_t stride_bytes_;
    Box bounds_{glm::vec3(1.0f), glm::vec3(-1.0f)};
};

// One point with w = 1 in a known space.
template <class Space>
struct Position {
    glm::vec3 point;

    explicit Position(const glm::vec3& of_space) noexcept : point(of_space) {}
    explicit Position(const detail::MoreThanVec3 auto&) = delete;
};

// Points of a space from an array of vectors, from three arrays (of one size, asserted), or from x, y, z that follow
// one another every stride_bytes; and one point, which is a glm::vec3: what has doubles or a w does not compile.
inline Positions<Object> object_space(const std::span<const glm::vec3>& points) noexcept {
    return Positions<Object>(points);
}
inline Positions<Object> object_space(const std::span<const float>& x, const std::span<const float>& y,
                                      const std::span<const float>& z) noexcept {
    return Positions<Object>(x, y, z);
}
inline Positions<Object> object_space(const float* first, std::size_t count, std::size_t stride_bytes) noexcept {
    return Positions<Object>(first, count, stride_bytes);
}
inline Position<Object> object_space(const glm::vec3& point) noexcept { return Position<Object>(point); }
Position<Object> object_space(const detail::MoreThanVec3 auto& point) = delete;

// Views the same as points in the world.
inline Positions<World> world_space(const std::span<const glm::vec3>& points) noexcept {
    return Positions<World>(points);
}
inline Positions<World> world_space(const std::span<const float>& x, const std::span<const float>& y,
                                    const std::span<const float>& z) noexcept {
    return Positions<World>(x, y, z);
}
inline Positions<World> world_space(const float* first, std::size_t count, std::size_t stride_bytes) noexcept {
    return Positions<World>(first, count, stride_bytes);
}
inline Position<World> world_space(const glm::vec3& point) noexcept { return Position<World>(point); }
Position<World> world_space(const detail::MoreThanVec3 auto& point) = delete;

// Views the same as points in the eye's space.
inline Positions<Eye> eye_space(const std::span<const glm::vec3>& points) noexcept { return Positions<Eye>(points); }
inline Positions<Eye> eye_space(const std::span<const float>& x, const std::span<const float>& y,
                                const std::span<const float>& z) noexcept {
    return Positions<Eye>(x, y, z);
}
inline Positions<Eye> eye_space(const float* first, std::size_t count, std::size_t stride_bytes) noexcept {
    return Positions<Eye>(first, count, stride_bytes);
}
inline Position<Eye> eye_space(const glm::vec3& point) noexcept { return Position<Eye>(point); }
Position<Eye> eye_space(const detail::MoreThanVec3 auto& point) = delete;

// Views the same as fragments: x and y in pixels, z the depth that the buffer holds.
inline Positions<Window> window_space(const std::span<const glm::vec3>& points) noexcept {
    return Positions<Window>(points);
}
inline Positions<Window> window_space(const std::span<const float>& x, const std::span<const float>& y,
                                      const std::span<const float>& z) noexcept {
    return Positions<Window>(x, y, z);
}
inline Positions<Window> window_space(const float* first, std::size_t count, std::size_t stride_bytes) noexcept {
    return Positions<Window>(first, count, stride_bytes);
}
inline Position<Window> window_space(const glm::vec3& point) noexcept { return Position<Window>(point); }
Position<Window> window_space(const detail::MoreThanVec3 auto& point) = delete;

inline namespace TEXGEN_BUILD {

// How far generate() may be from the exact value, before its one rounding to float: relative to sum |T_ij v_j|.
inline constexpr double generate_error = 0x1p-50;

// Writes T v of every position, homogeneous: q <= 0 is kept, and is the caller's to test.
// Guarantee: each coordinate within 1/2 ulp + generate_error of its exact value, as long as no product of a matrix
// element and a coordinate reaches 2^1000; no allocation, noexcept.
// Shapes: as many outputs as positions (asserted); outputs must not overlap the positions. Units of T's region.
// Bad input: NaN and infinity spoil their own point only.
// Source: Everitt, Projective Texture Mapping, (3) and (4).
template <class Space>
void generate(const Transform<Texture, Space>& texture_from_space, const Positions<Space>& positions,
              const std::span<glm::vec4>& strq) noexcept;

// Generates the same into one array a coordinate; an empty one is left out.
template <class Space>
void generate(const Transform<Texture, Space>& texture_from_space, const Positions<Space>& positions,
              const HomogeneousTexcoords& out) noexcept;

// Writes s/q, t/q and r/q of every position in front of the projector, and whether it is lit.
// Guarantee, as long as no product of a matrix element and a coordinate, but 0, leaves 2^-900 .. 2^1000: in front (q >
// 0, decided exactly) each is within max(tolerance, 1/2 ulp) of the exact value of the given numbers (r: the tolerance
// relative to max(1, |r|)). With `exact` each is the nearest float, whatever the layout, the count, the place or the
// build (but the sign of a 0 below 2^-1074). lit = 1 inside the closed region, decided from the s and t, and with a
// depth from the r, that are written, or with `exact` would be; with a tolerance, where one is not asked for, from some
// value inside that tolerance. Behind, s = t = r = lit = 0. A depth costs at most what r costs; where s and t leave
// many neighbours dark, r is not computed for them. No allocation, noexcept.
// Shapes: as many values of an output as positions, or none (asserted; else that output is not written); outputs must
// not overlap the positions.
// Bad input: NaN and infinity spoil their own point only; a point whose q is NaN is behind.
// Source: Everitt, Projective Texture Mapping, section 2; the reverse projection is behind q = 0.
template <class Space>
void project(const Transform<Texture, Space>& texture_from_space, const Positions<Space>& positions,
             const TextureRegion& region, const Texcoords& out, const Tolerance& tolerance = exact) noexcept;

// Writes the same in pairs, without a mask: behind the projector both are 0.
template <class Space>
void project(const Transform<Texture, Space>& texture_from_space, const Positions<Space>& positions,
             const std::span<glm::vec2>& st, const Tolerance& tolerance = exact) noexcept;

// Divides one point: (s/q, t/q), empty behind the projector.
// Guarantee: the floats that the others give with `exact`: each the nearest; empty for q <= 0, decided exactly, and for
// a NaN q. No allocation, noexcept.
// Source: as above.
template <class Space>
std::optional<glm::vec2> project(const Transform<Texture, Space>& texture_from_space,
                                 const Position<Space>& position) noexcept;

}  // namespace TEXGEN_BUILD

// Bounds the error of each coordinate (s, t, r, q) that generate() gives of these positions.
// Guarantee: |computed - exact| is at most this for every position, the rounding to float included: 1/2 ulp +
// generate_error, where that is largest. No allocation, noexcept; it looks at every position, one by one, for some
// twenty times what generate() takes.
// Bad input: a NaN or an infinity of a matrix's row or of a position makes the bounds that it reaches NaN or infinite.
template <class Space>
glm::dvec4 generate_error_bound(const Transform<Texture, Space>& texture_from_space,
                                const Positions<Space>& positions) noexcept;

// Bounds the error of s (x) and t (y) that project() gives of these positions.
// Guarantee: |computed - exact| is at most this for every position with q > 0, the rounding to float included; infinite
// where none is known, as where a product leaves what project() says. No allocation, noexcept; it looks at every
// position, one by one, for some fifty times what project() takes.
// Bad input: a NaN or an infinity of a position, or of the rows of s, t and q, makes the bounds that it reaches
// infinite.
template <class Space>
glm::dvec2 project_error_bound(const Transform<Texture, Space>& texture_from_space, const Positions<Space>& positions,
                               const Tolerance& tolerance = exact) noexcept;

// Divides one homogeneous coordinate: (s/q, t/q), empty behind the projector.
// Guarantee: each is the nearest float; empty for q <= 0 and for a NaN q. noexcept.
// A fragment shader does the same, and takes the light where it is lit (README.md has the whole of it):
//
//     vec3 light = textureProj(slide, strq).rgb;
//     bool lit = strq.q > 0.0 && st == clamp(st, region.xy, region.zw);
//
inline std::optional<glm::vec2> divide(const glm::vec4& strq) noexcept {
    if (!(strq.w > 0.0f)) return std::nullopt;
    return glm::vec2(strq.x / strq.w, strq.y / strq.w);
}
// Not of doubles, which would be rounded first.
template <glm::qualifier Q>
std::optional<glm::vec2> divide(const glm::vec<4, double, Q>& strq) = delete;

}  // namespace TEXGEN_NAMESPACE

#include "detail/points/one_point.inc.hpp"
#include "detail/points/outputs.inc.hpp"
#include "detail/points/texcoord.inc.hpp"
