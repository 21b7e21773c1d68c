#pragma once

// A triangle as linear functions of the window: s, t, r, q times a common positive factor.
//
// With c_i = f_i w_j w_k and E_i the window's edge function of the side opposite vertex i, the perspective-correct
// f = (sum E_i f_i / w_i) / (sum E_i / w_i) (OpenGL compatibility specification, polygon rasterization) has the
// numerator F = sum E_i c_i, up to a factor that s, t, r and q share. So s/q = S/Q, and neither 1/w nor the area is
// ever formed.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <utility>

#include <glm/vec2.hpp>

#include "../../conventions.hpp"
#include "../../primitives.hpp"
#include "../arithmetic/determinant.hpp"
#include "../arithmetic/expansion.hpp"
#include "../arithmetic/rounding.hpp"
#include "../arithmetic/widen.hpp"
#include "../culling/lit_test.hpp"
#include "../language.hpp"
#include "../simd/lanes.hpp"

namespace TEXGEN_DETAIL {

// A rectangle of fragments inside the one that the caller asked for. Wide enough for any int plus any int.
struct Tile {
    std::int64_t x, y;
    int width, height;

    std::int64_t count() const noexcept { return static_cast<std::int64_t>(width) * height; }

    // Cuts across the longer side, or a given one.
    std::array<Tile, 2> halves() const noexcept { return halves(width >= height); }
    std::array<Tile, 2> halves(bool across_width) const noexcept {
        Tile first = *this;
        Tile second = *this;
        if (across_width) {
            first.width = width / 2;
            second.x += first.width;
            second.width -= first.width;
        } else {
            first.height = height / 2;
            second.y += first.height;
            second.height -= first.height;
        }
        return {first, second};
    }

    bool is_column() const noexcept { return width == 1 && height > 1; }
    Tile mirrored() const noexcept { return {y, x, height, width}; }
};

inline Tile tile_of(const FragmentRect& rect) noexcept { return {rect.x, read_alone(rect.y), rect.width, rect.height}; }

// How many fragments a rectangle has: where std::size_t cannot say it, more than any array holds. An empty one has a
// product of 0 and not a branch: GCC 15 and 16, at -O3 for AVX-512, lose terms of a sum that leaves products out.
inline std::size_t count_of(const FragmentRect& rect) noexcept {
    constexpr std::size_t most = (std::numeric_limits<std::size_t>::max)();
    const auto length = [](int side) { return static_cast<std::size_t>(side > 0 ? side : 0); };
    const std::size_t width = length(rect.width), height = length(rect.height);
    return height == 0 || width <= most / height ? width * height : most;
}

inline void store_ramps(const RampOf<Double2>& ramps, TwoRamps& to) noexcept {
    std::memcpy(to.base, &ramps.base, sizeof to.base);
    std::memcpy(to.dx, &ramps.dx, sizeof to.dx);
    std::memcpy(to.dy, &ramps.dy, sizeof to.dy);
}

// Where a fragment stands in the row-major outputs of a rectangle.
inline std::size_t offset_in(const Tile& rect, std::int64_t x, std::int64_t y) noexcept {
    return static_cast<std::size_t>((y - rect.y) * rect.width + (x - rect.x));
}

// Gives all fragments of a tile one value in such an output, unless it is empty.
TEXGEN_APART inline void fill_rows(const std::span<float>& output, const Tile& rect, const Tile& tile,
                                   float value) noexcept {
    if (output.empty()) return;
    for (std::int64_t y = tile.y; y < tile.y + tile.height; ++y) {
        float* const row = output.data() + offset_in(rect, tile.x, y);
        for (int i = 0; i < tile.width; ++i) row[i] = value;
    }
}

// The derivatives of f/q by x and y, times Q^2, as functions of p - a. With mu_ij = (f_i q_j - f_j q_i) times the
// weights of i and j, and twice the signed area,
//   d(f/q)/dx Q^2 = F_x Q - F Q_x = -area (mu_ab (c - p).y + mu_bc (a - p).y + mu_ca (b - p).y)
//   d(f/q)/dy Q^2 = F_y Q - F Q_y =  area (mu_ab (c - p).x + mu_bc (a - p).x + mu_ca (b - p).x):
// the one does not depend on x, nor the other on y. `magnitude` is the same with the absolute values of all terms.
struct BoundedSlope {
    FootprintJob::Slope value, magnitude;  // at the first vertex
};

class TrianglePlanes {
public:
    explicit TrianglePlanes(const Triangle& triangle) noexcept
        : triangle_(about_farthest(triangle)),
          a_(window(triangle_.a)),
          to_b_(window(triangle_.b) - a_),
          to_c_(window(triangle_.c) - a_) {
        const double left = to_b_.x * to_c_.y;
        const double right = to_b_.y * to_c_.x;
        area_ = left - right;
        area_terms_ = std::fabs(left) + std::fabs(right);
        orientation_ = std::fabs(area_) > gamma(4) * area_terms_ ? (area_ > 0.0 ? 1 : -1) : exact_area().sign();
        const double a = widened(triangle_.a.clip_w);
        const double b = widened(triangle_.b.clip_w);
        const double c = widened(triangle_.c.clip_w);
        weight_[0] = b * c;
        weight_[1] = a * c;
        weight_[2] = a * b;
        // The common factor is free: with this one F is about as large as its f, and products of several stay in range.
        factor_ = orientation_ * reciprocal_power_of_two(area_terms_ * (weight_[1] + weight_[2]));
    }

    // Exchanges x and y of the window.
    void mirror() noexcept {
        for (WindowVertex* const vertex : {&triangle_.a, &triangle_.b, &triangle_.c})
            std::swap(vertex->window.x, vertex->window.y);
        for (glm::dvec2* const vector : {&a_, &to_b_, &to_c_}) std::swap(vector->x, vector->y);
        orientation_ = -orientation_;
        area_ = -area_;
        factor_ = -factor_;
    }

    // False where a number is not finite, a clip_w is not positive, or the area is zero (decided exactly): then nothing
    // that follows means anything.
    bool is_usable() const noexcept {
        constexpr float largest = (std::numeric_limits<float>::max)();
        // That of a is the largest, if none is a NaN.
        return triangle_.a.clip_w <= largest && triangle_.b.clip_w > 0.0f && triangle_.c.clip_w > 0.0f &&
               orientation_ != 0 && are_finite();
    }

    // The plane of one coordinate, 0 to 3 for s, t, r, q, in both lanes.
    TEXGEN_APART PlaneOf<Double2> plane_twice(glm::length_t coordinate) const noexcept {
        const auto corner = [&](const WindowVertex& vertex) {
            const double value = widened(vertex.strq[coordinate]);
            return double2_of(value, value);
        };
        return plane_through(corner(triangle_.a), corner(triangle_.b), corner(triangle_.c));
    }

    // The planes of s and t, and that of q.
    void planes_of_stq(PlaneOf<Double2>& st, Plane& q) const noexcept {
        const PlaneOf<Double4> all = plane_through(four_widened(triangle_.a.strq), four_widened(triangle_.b.strq),
                                                   four_widened(triangle_.c.strq));
        const auto take = [](const RampOf<Double4>& ramp, RampOf<Double2>& of_st, Ramp& of_q) {
            of_st = {first_two(ramp.base), first_two(ramp.dx), first_two(ramp.dy)};
            of_q = {last_two(ramp.base)[1], last_two(ramp.dx)[1], last_two(ramp.dy)[1]};
        };
        take(all.value, st.value, q.value);
        take(all.magnitude, st.magnitude, q.magnitude);
    }

    // The slope of one coordinate, 0 to 2 for s, t, r. Each mu carries 3 u: products of two floats are exact, so s and
    // t that are large everywhere cancel without harm. The area carries 4 u, a difference of points 1 u, products and
    // sums 5 u: gamma(16) of the magnitudes covers the values, and a step from the first vertex. A weight times the
    // area is at most 2, so only the last product of a mu may be below the normal numbers, and errs by 2^-1074 there,
    // as what it is multiplied by does; gamma(16) 2^-1020 covers both.
    BoundedSlope slope(glm::length_t coordinate) const noexcept {
        const WindowVertex* const corner[] = {&triangle_.a, &triangle_.b, &triangle_.c};
        const double area = twice_area();
        double least = 0.0;
        const auto mu = [&](std::size_t i, std::size_t j) {
            const double difference = widened(corner[i]->strq[coordinate]) * widened(corner[j]->strq.w) -
                                      widened(corner[j]->strq[coordinate]) * widened(corner[i]->strq.w);
            if (difference != 0.0) least = 0x1p-1020;
            return difference * weight(j) * (weight(i) * area);
        };
        const double ab = mu(0, 1);
        const double bc = mu(1, 2);
        const double ca = mu(2, 0);
        const double size_ab = std::fabs(ab) + least;
        const double size_ca = std::fabs(ca) + least;
        return {
            {-(ab * to_c_.y + ca * to_b_.y), ab * to_c_.x + ca * to_b_.x, ab + bc + ca},
            {size_ab * std::fabs(to_c_.y) + size_ca * std::fabs(to_b_.y) + least,
             size_ab * std::fabs(to_c_.x) + size_ca * std::fabs(to_b_.x) + least, size_ab + std::fabs(bc) + size_ca}};
    }

    // The Jacobian determinant of (s/q, t/q), times Q^3: the same everywhere. With M the matrix of the corners' (s, t,
    // q), the planes are M times the edge functions, whose determinant is area^2. Within 2^-46 of itself; its sign is
    // exact.
    double jacobian_determinant() const noexcept {
        const auto row = [](const WindowVertex& corner) {
            return glm::dvec3(widened(corner.strq.y), widened(corner.strq.w), widened(corner.strq.x));
        };
        const FloatDeterminant determinant(row(triangle_.a), row(triangle_.b), row(triangle_.c));
        const auto [sum, size] = determinant.nearly();
        const double area = twice_area();
        const double scale = (area * weight(0)) * (area * weight(1)) * weight(2);
        return (std::fabs(sum) > 0x1p-4 * size ? sum : determinant.exactly().estimate()) * scale;
    }

    // What F is made of, c_i = value weight: a coordinate of corner i, which is read where it stands, as GLM's subscript
    // is a switch, and w_j w_k times the common factor; both are exact. scaled_w() is w_i times that factor.
    const WindowVertex& vertex(std::size_t i) const noexcept {
        return i == 0 ? triangle_.a : i == 1 ? triangle_.b : triangle_.c;
    }
    glm::dvec2 corner(std::size_t i) const noexcept { return window(vertex(i)); }
    double value(std::size_t i, glm::length_t coordinate) const noexcept {
        const auto offset = static_cast<std::size_t>(coordinate) * sizeof(float);
        float value;
        std::memcpy(&value, reinterpret_cast<const unsigned char*>(&vertex(i).strq) + offset, sizeof value);
        return widened(value);
    }
    double weight(std::size_t i) const noexcept { return weight_[i] * factor_; }
    double scaled_w(std::size_t i) const noexcept { return widened(vertex(i).clip_w) * factor_; }

    // The window, seen from the first vertex: the centre of a fragment, and the other vertices.
    glm::dvec2 from_a(const Tile& tile) const noexcept {
        const glm::dvec2 first(static_cast<double>(tile.x), static_cast<double>(tile.y));  // integers
        return {(first.x + 0.5) - read_alone(a_.x), (first.y + 0.5) - read_alone(a_.y)};
    }
    const glm::dvec2& to_b() const noexcept { return to_b_; }
    const glm::dvec2& to_c() const noexcept { return to_c_; }

    // F at fragment (tile.x + i, tile.y + j) as a function of i and j.
    template <class Number>
    RampOf<Number> ramp(const PlaneOf<Number>& plane, const Tile& tile) const noexcept {
        const glm::dvec2 p = from_a(tile);
        return {plane.value.base + (plane.value.dx * p.x + plane.value.dy * p.y), plane.value.dx, plane.value.dy};
    }

    // A bound on the error of ramp() at every fragment of the tile, its index applied in any order. With u = 2^-53 the
    // c_i carry 2 u, a difference of points 1 u, the gradients 6 u of their magnitude and the base 8 u; multiplying by
    // p - a adds 2 u, by the index 1 u, and the sums 4 u: 20 u of the magnitude cover them.
    template <class Number>
    Number error(const PlaneOf<Number>& plane, const Tile& tile) const noexcept {
        const glm::dvec2 p = from_a(tile);
        return (plane.magnitude.base + plane.magnitude.dx * (std::fabs(p.x) + tile.width) +
                plane.magnitude.dy * (std::fabs(p.y) + tile.height)) *
               gamma(20);
    }

    // F at one fragment.
    Bounded at(const Plane& plane, std::int64_t x, std::int64_t y) const noexcept {
        const Tile fragment{x, y, 1, 1};
        return {ramp(plane, fragment).base, error(plane, fragment)};
    }

    // w_j w_k of corner i, without the common factor, and that factor.
    double unscaled_weight(std::size_t i) const noexcept { return weight_[i] * orientation_; }
    double factor() const noexcept { return factor_ * orientation_; }

    // (b - a) x (c - a), every product of two floats being exact in double.
    TEXGEN_RARE Expansion<6> exact_area() const noexcept {
        const glm::dvec2 a = window(triangle_.a);
        const glm::dvec2 b = window(triangle_.b);
        const glm::dvec2 c = window(triangle_.c);
        Expansion<6> sum;
        for (const double term : {a.x * b.y, -a.y * b.x, b.x * c.y, -b.y * c.x, c.x * a.y, -c.y * a.x}) sum.add(term);
        return sum;
    }

private:
    // The plane through values at the corners. The edges take the common factor, as it is known last.
    template <class Number>
    PlaneOf<Number> plane_through(const Number& at_a, const Number& at_b, const Number& at_c) const noexcept {
        const Number a = at_a * weight_[0];
        const Number b = at_b * weight_[1];
        const Number c = at_c * weight_[2];
        const Number b_minus_a = b - a;
        const Number c_minus_a = c - a;
        const Number b_and_a = magnitude(b) + magnitude(a);
        const Number c_and_a = magnitude(c) + magnitude(a);
        const glm::dvec2 to_b = to_b_ * factor_;
        const glm::dvec2 to_c = to_c_ * factor_;
        const double b_x = std::fabs(to_b.x);
        const double b_y = std::fabs(to_b.y);
        const double c_x = std::fabs(to_c.x);
        const double c_y = std::fabs(to_c.y);
        return {
            {a * (area_ * factor_), b_minus_a * to_c.y - c_minus_a * to_b.y, c_minus_a * to_b.x - b_minus_a * to_c.x},
            {magnitude(a) * (area_terms_ * std::fabs(factor_)), b_and_a * c_y + c_and_a * b_y,
             b_and_a * c_x + c_and_a * b_x}};
    }

    // A corner where the camera's w is small may be far outside of the window, where F is large: the planes stand about
    // the one where w is largest.
    static Triangle about_farthest(const Triangle& triangle) noexcept {
        const auto& [a, b, c] = triangle;
        if (b.clip_w > a.clip_w && b.clip_w >= c.clip_w) return {b, c, a};
        if (c.clip_w > a.clip_w) return {c, a, b};
        return triangle;
    }

    static glm::dvec2 window(const WindowVertex& vertex) noexcept {
        return {widened(vertex.window.x), widened(vertex.window.y)};
    }

    // Looks at two floats at a time: only the exponent of one that is not finite is all ones: 1 more carries to the
    // sign.
    bool are_finite() const noexcept {
        std::uint64_t sum = 0;
        for (const WindowVertex* vertex : {&triangle_.a, &triangle_.b, &triangle_.c}) {
            std::uint64_t words[3];
            std::memcpy(words, &vertex->window, sizeof vertex->window);
            std::memcpy(words + 1, &vertex->strq, sizeof vertex->strq);
            for (const std::uint64_t word : words) sum |= (word & 0x7fffffff7fffffff) + 0x0080000000800000;
        }
        return (sum & 0x8000000080000000) == 0;
    }

    // Twice the signed area within 4 u of itself, even where it cancels below the rounding of the differences.
    double twice_area() const noexcept {
        const glm::dvec2 b = window(triangle_.b);
        const glm::dvec2 c = window(triangle_.c);
        const auto is_exact = [](double to, double from) { return two_sum(to, -from).low == 0.0; };
        const bool all_exact = is_exact(b.x, a_.x) && is_exact(b.y, a_.y) && is_exact(c.x, a_.x) && is_exact(c.y, a_.y);
        return all_exact ? difference_of_products(to_b_.x, to_c_.y, to_b_.y, to_c_.x) : exact_area().estimate();
    }

    Triangle triangle_;
    glm::dvec2 a_, to_b_, to_c_;
    int orientation_;
    double area_, area_terms_;  // twice the signed area, and the sizes of its terms
    double weight_[3];          // w_j w_k
    double factor_;             // common to all weights, with the sign of the orientation
};

// A triangle made ready: what its tiles read.
struct TriangleFunctions {
    TrianglePlanes planes;
    PlaneOf<Double2> st;
    Plane q;
    LitTest lit;
    double tolerance;

    TriangleFunctions(const Triangle& triangle, const TextureRegion& region, double accepted) noexcept
        : planes(triangle), lit(region), tolerance(accepted) {
        planes.planes_of_stq(st, q);
    }

    // The same in a window whose x and y are exchanged, where a column is a row.
    TEXGEN_APART TriangleFunctions mirrored() const noexcept {
        TriangleFunctions result = *this;
        result.planes.mirror();
        for (RampOf<Double2>* const ramp : {&result.st.value, &result.st.magnitude}) std::swap(ramp->dx, ramp->dy);
        for (Ramp* const ramp : {&result.q.value, &result.q.magnitude}) std::swap(ramp->dx, ramp->dy);
        return result;
    }
};

}  // namespace TEXGEN_DETAIL
