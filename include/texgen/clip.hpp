#pragma once

// Floor 6: what a scene needs before its polygons can be interpolated. A vertex behind the camera has no place in the
// window, so polygons are cut at the near plane while they are homogeneous, and only then divided.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "conventions.hpp"
#include "detail/assert.hpp"
#include "detail/widen.hpp"
#include "primitives.hpp"

namespace texgen {

// position: the camera's clip space. strq: homogeneous texture coordinates, which belong to it linearly.
struct ClipVertex {
    glm::vec4 position;
    glm::vec4 strq;
};

// The window's pixels that NDC [-1, 1] x [-1, 1] covers. A negative width or height mirrors.
struct Viewport {
    int x, y, width, height;
};

namespace detail {

inline bool is_finite(const glm::vec4& v) noexcept {
    constexpr float largest = std::numeric_limits<float>::max();
    return std::fabs(v.x) <= largest && std::fabs(v.y) <= largest && std::fabs(v.z) <= largest &&
           std::fabs(v.w) <= largest;
}

// The signed distance of a homogeneous point from a clipping plane, in no unit; inside is >= 0, and the sign is exact.
class ClipDistance {
public:
    // In front of the near plane z = -w, z = 0 or (reversed) z = w.
    static ClipDistance from_near(DepthRange range, bool reversed_depth) noexcept {
        if (reversed_depth) return {-1.0, 1.0, 0.0};
        return {1.0, range == DepthRange::negative_one_to_one ? 1.0 : 0.0, 0.0};
    }
    // In front of the eye, w > 0: the smallest float is the first.
    static ClipDistance from_eye() noexcept { return {0.0, 1.0, std::numeric_limits<float>::denorm_min()}; }

    double operator()(const ClipVertex& vertex) const noexcept {
        return z_ * widened(vertex.position.z) + w_ * widened(vertex.position.w) - offset_;
    }

    // The z of a near plane where w is given: set, and not computed, it cannot be rounded to the other side.
    float depth_on_plane(float w) const noexcept { return static_cast<float>(0.0 - z_ * w_) * w; }

private:
    ClipDistance(double z, double w, double offset) noexcept : z_(z), w_(w), offset_(offset) {}

    double z_, w_, offset_;
};

inline float between(double weight_a, float a, double weight_b, float b) noexcept {
    return static_cast<float>(std::fma(weight_a, widened(a), weight_b * widened(b)) / (weight_a + weight_b));
}

// (weight_a a + weight_b b) / (weight_a + weight_b) for weights >= 0, each component rounded once. std::fma, so that no
// compiler contracts the two products in different ways on the two sides of a shared edge.
inline ClipVertex between(double weight_a, const ClipVertex& a, double weight_b, const ClipVertex& b) noexcept {
    ClipVertex result{};
    for (int i = 0; i < 4; ++i) {
        result.position[i] = between(weight_a, a.position[i], weight_b, b.position[i]);
        result.strq[i] = between(weight_a, a.strq[i], weight_b, b.strq[i]);
    }
    return result;
}

// Cuts the convex polygon in storage[0, count) and returns the new count. cut(inside, outside) makes the new vertex of
// an edge: given its ends by their sides, and not by the order of the walk, it makes the same one for both neighbours.
template <class Cut>
std::size_t cut_convex(std::span<ClipVertex> storage, std::size_t count, const ClipDistance& distance,
                       const Cut& cut) noexcept {
    std::size_t inside = 0;
    std::size_t entries = 0;  // edges that lead from the outside in
    std::size_t entry = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (distance(storage[i]) >= 0.0) {
            ++inside;
        } else if (distance(storage[i + 1 < count ? i + 1 : 0]) >= 0.0) {
            ++entries;
            entry = i;
        }
    }
    if (inside == count) return count;
    // Otherwise nothing is inside, or the polygon is not convex, or there is no room.
    if (entries != 1 || inside + 2 > storage.size()) return 0;
    const auto first = storage.begin();
    std::rotate(first, first + static_cast<std::ptrdiff_t>(entry), first + static_cast<std::ptrdiff_t>(count));

    // Now storage[0] is outside, storage[1 .. inside] are inside, and the rest is outside.
    const ClipVertex before = storage[0];
    const ClipVertex after = storage[inside + 1 < count ? inside + 1 : 0];
    const ClipVertex last = storage[inside];
    std::size_t written = 0;
    if (distance(storage[1]) > 0.0) storage[written++] = cut(storage[1], before);
    for (std::size_t i = 1; i <= inside; ++i) storage[written++] = storage[i];
    if (distance(last) > 0.0) storage[written++] = cut(last, after);
    return written < 3 ? 0 : written;
}

}  // namespace detail

// The vertex in the window: x = viewport.x + (position.x / position.w + 1) width / 2, y likewise, so that y grows as the
// clip y does.
// Guarantee: x within 1/2 float ulp + 2^-51 (|centre of the viewport| + |width / 2 * position.x / position.w|), y
// likewise; clip_w and strq unchanged; equal vertices give equal bits. No allocation, noexcept.
// Bad input: precondition, asserted: position.w > 0. What is not finite stays so in its component.
// Source: OpenGL 2.1 specification, 2.11.1.
inline WindowVertex to_window(const ClipVertex& vertex, Viewport viewport) noexcept {
    TEXGEN_ASSERT(vertex.position.w > 0.0f);
    const auto along = [w = detail::widened(vertex.position.w)](float clip, int first, int size) {
        const double half = 0.5 * size;
        return static_cast<float>(std::fma(half, detail::widened(clip) / w, first + half));
    };
    return {
        {along(vertex.position.x, viewport.x, viewport.width), along(vertex.position.y, viewport.y, viewport.height)},
        vertex.position.w,
        vertex.strq};
}

// How far a new vertex of clip_to_near() may be from the exact intersection, before its one rounding to float: relative
// to (1 - t) |a_i| + t |b_i| in component i of the point (1 - t) a + t b.
inline constexpr double clip_error = 0x1p-50;

// The part of a convex polygon that lies in front of the camera's near plane, in the order of the polygon, though its
// first vertex may be another. Returns the count of vertices written to `out`; 0 where nothing with an area is left.
// Guarantee: every vertex that comes out has w > 0, and z + w >= 0 (negative_one_to_one), z >= 0 (zero_to_one) or, where
// reversed_depth says that the near plane is z = w, z <= w. Vertices in front keep their bits. Each component of a new
// vertex is within 1/2 float ulp + clip_error of the exact intersection, but z, which is the near plane's for the w that
// comes out. It has the same bits whichever way its edge is walked, so shared edges stay closed. No allocation, noexcept.
// Shape: out.size() > polygon.size() (asserted); out may begin where the polygon does, and overlaps it in no other way.
// Bad input: a polygon with a position that is not finite is dropped, as is one that crosses the plane more than twice
// (no convex polygon does). strq may hold anything. Where the near plane leaves room for w <= 0 (an oblique near plane),
// edges are cut a second time, at a millionth of the w of their end in front; that can take one vertex more, and where
// `out` has no room for it the polygon is dropped.
// Source: Blinn and Newell, Clipping Using Homogeneous Coordinates (1978); Sutherland and Hodgman, Reentrant Polygon
// Clipping, CACM 17 (1974).
inline std::size_t clip_to_near(std::span<const ClipVertex> polygon, std::span<ClipVertex> out, DepthRange range,
                                bool reversed_depth = false) noexcept {
    TEXGEN_ASSERT(out.size() > polygon.size());
    if (out.size() <= polygon.size() || polygon.size() < 3) return 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        if (!detail::is_finite(polygon[i].position)) return 0;
        out[i] = polygon[i];
    }

    const auto near_plane = detail::ClipDistance::from_near(range, reversed_depth);
    const auto cut_at_near = [&](const ClipVertex& inside, const ClipVertex& outside) {
        ClipVertex cut = detail::between(-near_plane(outside), inside, near_plane(inside), outside);
        cut.position.z = near_plane.depth_on_plane(cut.position.w);
        return cut;
    };
    const std::size_t count = detail::cut_convex(out, polygon.size(), near_plane, cut_at_near);

    // The terms of w are at most 2^20 of it, so that double errs by 2^-33 of it and the nearest float is the w aimed at;
    // for the same reason z stays in front of the near plane, as that of both ends is.
    const auto cut_before_eye = [](const ClipVertex& inside, const ClipVertex& outside) {
        const float w = std::max(0x1p-20f * inside.position.w, std::numeric_limits<float>::denorm_min());
        return detail::between(w - detail::widened(outside.position.w), inside, detail::widened(inside.position.w) - w,
                               outside);
    };
    return detail::cut_convex(out, count, detail::ClipDistance::from_eye(), cut_before_eye);
}

}  // namespace texgen
