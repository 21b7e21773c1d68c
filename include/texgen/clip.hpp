#pragma once

// Floor 6: what a scene needs before its polygons can be interpolated. A vertex behind the camera has no place in the
// window, so polygons are cut at the near plane while they are homogeneous, and only then divided; likewise with what is
// behind the projector or outside its slide. The slide's planes, for hardware that clips, stand here too.

#include "detail/language.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/nearest.hpp"
#include "detail/arithmetic/widen.hpp"
#include "detail/assert.hpp"
#include "detail/culling/slide_planes.hpp"
#include "primitives.hpp"
#include "transform.hpp"

namespace TEXGEN_NAMESPACE {

// position: the camera's clip space. strq: homogeneous texture coordinates, which belong to it linearly.
struct ClipVertex {
    glm::vec4 position;
    glm::vec4 strq;
};

namespace detail {
inline namespace TEXGEN_COMPILER {

inline bool is_finite(const glm::vec4& v) noexcept {
    constexpr float largest = (std::numeric_limits<float>::max)();
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
    // In front of the eye, w > 0: the smallest float is the first. (As a double: where subnormal floats count as 0 it would
    // be 0.)
    static ClipDistance from_eye() noexcept { return {0.0, 1.0, 0x1p-149}; }

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
    for (glm::length_t i = 0; i < 4; ++i) {
        result.position[i] = between(weight_a, a.position[i], weight_b, b.position[i]);
        result.strq[i] = between(weight_a, a.strq[i], weight_b, b.strq[i]);
    }
    return result;
}

// The w, or q, at which an edge is cut that leads behind: a small part of that of its end in front, and above 0.
inline float just_in_front(float inside) noexcept {
    constexpr float least = std::numeric_limits<float>::denorm_min();
    return 0x1p-20f * inside > least ? 0x1p-20f * inside : least;
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
    // A rotation; <algorithm> would take every user longer to compile than all of this header.
    const auto reverse = [storage](std::size_t begin, std::size_t end) {
        for (; begin + 1 < end; ++begin, --end) std::swap(storage[begin], storage[end - 1]);
    };
    reverse(0, entry);
    reverse(entry, count);
    reverse(0, count);

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

}  // namespace TEXGEN_COMPILER
}  // namespace detail

inline namespace TEXGEN_COMPILER {

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
// first vertex may be another. Returns the count of vertices written to `out`; 0 where nothing is in front, or where what is
// not behind only touches the plane, with any number of corners. A polygon whose own corners are collinear, or become so by
// rounding, is cut as any other: TriangleSetup::of() refuses it.
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
    const auto near_plane = detail::ClipDistance::from_near(range, reversed_depth);
    bool any_in_front = false;
    bool any_behind = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        if (!detail::is_finite(polygon[i].position)) return 0;
        out[i] = polygon[i];
        any_in_front = any_in_front || near_plane(out[i]) > 0.0;
        any_behind = any_behind || near_plane(out[i]) < 0.0;
    }
    if (any_behind && !any_in_front) return 0;
    const auto cut_at_near = [&](const ClipVertex& inside, const ClipVertex& outside) {
        ClipVertex cut = detail::between(-near_plane(outside), inside, near_plane(inside), outside);
        cut.position.z = near_plane.depth_on_plane(cut.position.w);
        return cut;
    };
    const std::size_t count = detail::cut_convex(out, polygon.size(), near_plane, cut_at_near);

    // The terms of w are at most 2^20 of it, so that double errs by 2^-33 of it and the nearest float is the w aimed at;
    // for the same reason z stays in front of the near plane, as that of both ends is.
    const auto cut_before_eye = [](const ClipVertex& inside, const ClipVertex& outside) {
        const double w = detail::widened(detail::just_in_front(inside.position.w));
        return detail::between(w - detail::widened(outside.position.w), inside, detail::widened(inside.position.w) - w,
                               outside);
    };
    return detail::cut_convex(out, count, detail::ClipDistance::from_eye(), cut_before_eye);
}

}  // namespace TEXGEN_COMPILER

namespace detail {
inline namespace TEXGEN_COMPILER {

// The signed distance of (s, t, r, q) from a plane of the slide: sign (u - bound q), in no unit; inside is >= 0.
class SlideDistance {
public:
    explicit SlideDistance(const SlidePlane& plane) noexcept
        : coordinate_(plane.coordinate), sign_(plane.sign), per_q_(-plane.sign * usable(plane.bound)) {
        const bool has_29_digits = (bit_cast<std::uint64_t>(per_q_) & 0xffffff) == 0;  // times a float: a double
        product_error_ = has_29_digits ? 0.0 : gamma(1);
    }

    // The product's rounding and the sum's.
    Bounded operator()(const ClipVertex& vertex) const noexcept {
        const double product = of_q(vertex);
        const double value = own(vertex) + product;
        return {value, gamma(1) * std::fabs(value) + product_error_ * std::fabs(product)};
    }

    // In two doubles, which leave out `error`: 0 unless the digits are too far apart.
    struct Close {
        DoubleDouble value;
        double error;
    };
    Close closely(const ClipVertex& vertex) const noexcept {
        const DoubleDouble product = two_product(per_q_, widened(vertex.strq.w));
        const DoubleDouble sum = two_sum(own(vertex), product.high);
        const DoubleDouble low = two_sum(sum.low, product.low);
        return {two_sum(sum.high, low.high), std::fabs(low.low)};
    }

    Expansion<3> exactly(const ClipVertex& vertex) const noexcept {
        Expansion<3> sum;
        sum.add(own(vertex));
        sum.add_product(per_q_, widened(vertex.strq.w));
        return sum;
    }

    // A rounded sum has its sign, and what is below the product's error has no rounding: there that of the product decides.
    int sign(const ClipVertex& vertex) const noexcept {
        const double product = of_q(vertex);
        double value = own(vertex) + product;
        if (!(std::fabs(value) >= product_error_ * std::fabs(product)))
            value += two_product(per_q_, widened(vertex.strq.w)).low;
        return value > 0.0 ? 1 : value < 0.0 ? -1 : 0;
    }

private:
    double own(const ClipVertex& vertex) const noexcept { return sign_ * widened(vertex.strq[coordinate_]); }
    double of_q(const ClipVertex& vertex) const noexcept { return per_q_ * widened(vertex.strq.w); }

    // Floats have |u/q| in [2^-277, 2^277], or 0: a side that is brought into a wider range decides the same of them, and
    // its products stay exact.
    static double usable(double side) noexcept {
        if (side == 0.0) return 0.0;
        return std::copysign(smaller(larger(std::fabs(side), 0x1p-300), 0x1p300), side);
    }

    glm::length_t coordinate_;
    double sign_, per_q_;
    double product_error_;  // relative
};

// Where the edge from a vertex inside to one outside crosses the side: (d_i outside - d_o inside) / (d_i - d_o) with
// d_i > 0 > d_o, each component the float nearest to it, where double does not tell which: from the sign of
// d_i (outside - m) - d_o (inside - m) for the middle m of two floats, in two doubles or exactly.
class CloseCrossing {
public:
    CloseCrossing(const SlideDistance& side, const ClipVertex& inside, const ClipVertex& outside) noexcept
        : side_(side),
          inside_(inside),
          outside_(outside),
          of_inside_(side.closely(inside)),
          of_outside_(side.closely(outside)) {}

    // Of a component that is i inside and o outside, with a quotient that may err by `error`.
    float nearest(double i, double o, double quotient, double error) const noexcept {
        if (!(error <= 0x1p-26 * std::fabs(quotient))) {
            const Bounded sum = beyond(0.0, i, o);
            const bool is_close = sum.error <= 0x1p-50 * std::fabs(sum.value);
            quotient = (is_close ? sum.value : exactly_beyond(0.0, i, o).estimate()) /
                       (of_inside_.value.high - of_outside_.value.high);
            if (quotient == 0.0) return 0.0f;
            error = 0x1p-48 * std::fabs(quotient);
        }
        return nearest_to(quotient, error, [&](double middle) {
            const Bounded sum = beyond(middle, i, o);
            if (sum.error > 0.0 && std::fabs(sum.value) <= sum.error) return exactly_beyond(middle, i, o).sign();
            return sum.value > 0.0 ? 1 : sum.value < 0.0 ? -1 : 0;
        });
    }

private:
    // Products and their difference are within 2^-103 of their terms, and exact where each factor is one double.
    Bounded beyond(double middle, double i, double o) const noexcept {
        const DoubleDouble to_i = two_sum(i, -middle);
        const DoubleDouble to_o = two_sum(o, -middle);
        const DoubleDouble from_i = product(of_outside_.value, to_i);
        const DoubleDouble from_o = product(of_inside_.value, to_o);
        const double left_out = of_outside_.error * std::fabs(to_i.high) + of_inside_.error * std::fabs(to_o.high);
        const bool is_exact = of_inside_.value.low == 0.0 && of_outside_.value.low == 0.0 && to_i.low == 0.0 &&
                              to_o.low == 0.0 && left_out == 0.0;
        return {(from_o.high - from_i.high) + (from_o.low - from_i.low),
                is_exact ? 0.0 : 0x1p-100 * (std::fabs(from_i.high) + std::fabs(from_o.high)) + 1.001 * left_out};
    }
    Expansion<24> exactly_beyond(double middle, double i, double o) const noexcept {
        Expansion<24> sum;
        for (const double to : {o, -middle}) sum.add_scaled(side_.exactly(inside_), to);
        for (const double to : {-i, middle}) sum.add_scaled(side_.exactly(outside_), to);
        return sum;
    }

    const SlideDistance& side_;
    const ClipVertex& inside_;
    const ClipVertex& outside_;
    SlideDistance::Close of_inside_, of_outside_;
};

// The same from the begin. With weights v^ = v + e, |e| <= E, the numerator errs by E_o |inside| + E_i |outside| and by three
// roundings, the quotient by that and E_i + E_o of it, over the difference, and by its own.
inline ClipVertex cut_at(const SlideDistance& side, const ClipVertex& inside, const ClipVertex& outside) noexcept {
    const Bounded of_inside = side(inside);
    const Bounded of_outside = side(outside);
    const double difference = of_inside.value - of_outside.value;
    const double difference_error = of_inside.error + of_outside.error + gamma(2) * std::fabs(difference);
    const bool is_apart = difference > 2.0 * difference_error;
    const double per_difference = is_apart ? 1.001 / (difference - difference_error) : 0x1p900;
    std::optional<CloseCrossing> close;
    const auto component = [&](float given_inside, float given_outside) {
        if (given_inside == given_outside) return given_inside;
        const double i = widened(given_inside);
        const double o = widened(given_outside);
        const double from_i = -of_outside.value * i;
        const double from_o = of_inside.value * o;
        const double quotient = (from_i + from_o) / difference;
        const double size = std::fabs(from_i) + std::fabs(from_o);
        if (!(size < 0x1p1000)) return static_cast<float>(quotient);  // not finite
        const double error = per_difference * (of_outside.error * std::fabs(i) + of_inside.error * std::fabs(o) +
                                               difference_error * std::fabs(quotient) + gamma(6) * size);
        if (rounds_alone(quotient, error)) return static_cast<float>(quotient);
        if (!close) close.emplace(side, inside, outside);
        return close->nearest(i, o, quotient, error);
    };
    ClipVertex result{};
    for (glm::length_t k = 0; k < 4; ++k) {
        result.position[k] = component(inside.position[k], outside.position[k]);
        result.strq[k] = component(inside.strq[k], outside.strq[k]);
    }
    return result;
}

// Cuts the polygon in storage[0, count) edge by edge and returns the new count; 0 where nothing is inside but corners on the
// side, or where storage has no room. sign() is that of the distance of a vertex; cut() as for cut_convex. It is read from
// the end of the storage on, so that what is written at its begin grows into the room that is free.
template <class Sign, class Cut>
std::size_t cut_edges(std::span<ClipVertex> storage, std::size_t count, const Sign& sign, const Cut& cut) noexcept {
    std::size_t inside = 0;
    while (inside < count && sign(storage[inside]) >= 0) ++inside;
    if (inside == count) return count;
    const std::size_t first = storage.size() - count;
    for (std::size_t i = count; i-- > 0;) storage[first + i] = storage[i];
    const ClipVertex first_vertex = storage[first];
    ClipVertex to = first_vertex;
    int to_sign = sign(to);
    bool touches = true;  // and no more
    std::size_t written = 0;
    for (std::size_t i = first; i < storage.size(); ++i) {
        const ClipVertex from = to;
        const int from_sign = to_sign;
        to = i + 1 < storage.size() ? storage[i + 1] : first_vertex;
        to_sign = sign(to);
        touches = touches && from_sign <= 0;
        const bool crosses = (from_sign > 0 && to_sign < 0) || (from_sign < 0 && to_sign > 0);
        // Vertices up to i are read.
        if (written + (from_sign >= 0) + crosses > i + 1) return 0;
        if (from_sign >= 0) storage[written++] = from;
        if (crosses) storage[written++] = from_sign > 0 ? cut(from, to) : cut(to, from);
    }
    return written < 3 || touches ? 0 : written;
}

}  // namespace TEXGEN_COMPILER
}  // namespace detail

// The planes of the slide's region: q, s - min.x q, max.x q - s, t - min.y q, max.y q - t. A point of the space is lit
// where all five are >= 0 (and q > 0): for gl_ClipDistance, or in eye space for glClipPlane.
// Guarantee: each coefficient is the exact one of the matrix in double, rounded to double and then to float: within
// (1/2 + 2^-29) float ulp, and of its sign. No allocation, noexcept.
// Shape: coefficients (x, y, z, w) of points (x, y, z, 1) of the space that the matrix takes to the texture.
// Bad input: NaN and infinity of the matrix or the region stay in the coefficients that they reach.
// Source: Segal, Korobkin, van Widenfelt, Foran, Haeberli, Fast Shadows and Lighting Effects Using Texture Mapping
// (SIGGRAPH 1992): what is not to be lit is clipped.
template <class Space>
std::array<glm::vec4, 5> clip_planes(const Transform<Texture, Space>& texgen, TextureRegion region) noexcept {
    std::array<glm::vec4, 5> result;
    for (glm::length_t column = 0; column < 4; ++column) {
        const glm::dvec4& from = texgen.matrix()[column];
        result[0][column] = static_cast<float>(from.w);
        for (glm::length_t k = 0; k < 2; ++k) {
            const auto i = static_cast<std::size_t>(1 + 2 * k);
            result[i][column] = static_cast<float>(std::fma(-(region.min)()[k], from.w, from[k]));
            result[i + 1][column] = static_cast<float>(std::fma((region.max)()[k], from.w, -from[k]));
        }
    }
    return result;
}

// How far outside a side of the region a vertex of clip_to_slide() may be: min q - u and u - max q are at most
// slide_clip_error max(|min|, |max|) q for u = s and t, while no number is below the normal floats.
//
// A vertex that comes out has at most five cuts behind it. A cut of vertices with u - min q >= -e q satisfies that too,
// as it is linear, and rounding u and q moves u - min q by 2^-24 (|u| + |min| q) <= 2^-23 max(|min|, |max|) q more.
// The largest seen in four million triangles is 2^-22.
inline constexpr double slide_clip_error = 0x1p-20;

inline namespace TEXGEN_COMPILER {

// The part of a convex polygon that the slide falls on, in the order of the polygon, though its first vertex may be another:
// q > 0, and s and t in the region's four sides. Returns the count of vertices written to `out`; 0 where nothing is inside
// a side, or where what is not outside only touches it, with any number of corners. A polygon whose own corners are
// collinear, or become so by rounding, is cut as any other: TriangleSetup::of() refuses it.
// Guarantee: every vertex that comes out has q > 0 and is inside the region but for slide_clip_error. Vertices inside keep
// their bits; sides are decided exactly, so a vertex on a side stays. A new vertex is the exact intersection of its edge
// (of a new edge's ends as they were rounded), each component of position and strq the nearest float. Shared edges stay
// closed, to the bit: the edges are cut one after another at q = 0 and at the four sides, and what becomes of an edge at
// each is a function of its two ends, in whatever order and whatever polygon they stand. No allocation, noexcept.
// Shape: out.size() >= polygon.size() + 5 (asserted); out may begin where the polygon does, and overlaps it in no other way.
// At the projector itself (s = t = q = 0, the one point of the sides with q = 0) there is no coordinate: a polygon that
// reaches it is cut at a millionth (2^-20) of the q of the edge's other end.
// Bad input: a polygon with an s, t or q that is not finite is dropped, and all are where the region holds no point. r and
// the position may hold anything. What is not convex (as rounding may leave a polygon with more than three corners) is
// cut as it is, and dropped where `out` has no room for the vertices that this takes beyond 5.
// Source: Sutherland and Hodgman, Reentrant Polygon Clipping, CACM 17 (1974).
inline std::size_t clip_to_slide(std::span<const ClipVertex> polygon, TextureRegion region,
                                 std::span<ClipVertex> out) noexcept {
    TEXGEN_ASSERT(out.size() >= polygon.size() + 5);
    if (out.size() < polygon.size() + 5 || polygon.size() < 3) return 0;
    if (!((region.min)().x <= (region.max)().x && (region.min)().y <= (region.max)().y)) return 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::vec4& strq = polygon[i].strq;
        if (!detail::is_finite(glm::vec4(strq.x, strq.y, 0.0f, strq.w))) return 0;
        out[i] = polygon[i];
    }

    // q >= 0 comes first, so that what satisfies a side is a cone. Then q = 0 is left only where s = t = 0.
    const auto planes = detail::slide_planes(region);
    const detail::SlidePlane* const order[] = {&planes[4], &planes[0], &planes[1], &planes[2], &planes[3]};
    std::size_t count = polygon.size();
    for (const detail::SlidePlane* plane : order) {
        const detail::SlideDistance side(*plane);
        count = detail::cut_edges(
            out, count, [&](const ClipVertex& v) { return side.sign(v); },
            [&](const ClipVertex& inside, const ClipVertex& outside) { return cut_at(side, inside, outside); });
    }
    const auto in_front = [](const ClipVertex& v) { return v.strq.w > 0.0f ? 1 : -1; };
    const auto cut_before_projector = [](const ClipVertex& inside, const ClipVertex& outside) {
        const double q = detail::widened(detail::just_in_front(inside.strq.w));
        return detail::between(q, inside, detail::widened(inside.strq.w) - q, outside);
    };
    return detail::cut_edges(out, count, in_front, cut_before_projector);
}

}  // namespace TEXGEN_COMPILER

}  // namespace TEXGEN_NAMESPACE
