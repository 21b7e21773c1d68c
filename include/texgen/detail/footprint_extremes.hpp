#pragma once

// The extremes of footprints over a convex part of the window, without visiting fragments.
//
// With X(y) = d(s,t)/dx Q^2 and Y(x) = d(s,t)/dy Q^2 in texels (planes.hpp: each is affine in one coordinate of the
// window), rho = max(|X|, |Y|) / Q^2, |det J| = |D| / Q^3, and the ratio of the singular values is L^2 / (|D| Q), L the
// spectral norm of (X, Y). X, Y and Q are affine, so |X|, |Y| and L are convex.

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "rounding.hpp"

namespace TEXGEN_DETAIL {

// A convex polygon of the window: a triangle or a rectangle, cut by the sides of a box.
class WindowPolygon {
public:
    void add(const glm::dvec2& corner) noexcept { corners_[count_++] = corner; }

    std::size_t count() const noexcept { return count_; }
    const glm::dvec2& operator[](std::size_t i) const noexcept { return corners_[i]; }
    const glm::dvec2& after(std::size_t i) const noexcept { return corners_[i + 1 < count_ ? i + 1 : 0]; }

    // What has sign * p[axis] <= bound.
    WindowPolygon cut(glm::length_t axis, double sign, double bound) const noexcept {
        WindowPolygon result;
        for (std::size_t i = 0; i < count_; ++i) {
            const glm::dvec2& from = corners_[i];
            const glm::dvec2& to = after(i);
            const double from_excess = sign * from[axis] - bound;
            const double to_excess = sign * to[axis] - bound;
            if (from_excess <= 0.0) result.add(from);
            if ((from_excess < 0.0 && to_excess > 0.0) || (from_excess > 0.0 && to_excess < 0.0))
                result.add(from + (from_excess / (from_excess - to_excess)) * (to - from));
        }
        return result;
    }

private:
    // A convex polygon has at most one corner more after a cut, and rounding may leave another.
    std::array<glm::dvec2, 4 + 2 * 4> corners_{};
    std::size_t count_ = 0;
};

// X(y), Y(x) and Q about the first vertex of the triangle, and bounds on their errors over the polygon.
struct FootprintField {
    glm::dvec2 x, y, twist;  // X = x + p.y twist, Y = y - p.x twist
    double q, q_dx, q_dy;
    double error, q_error;

    glm::dvec2 x_at(const glm::dvec2& p) const noexcept { return x + p.y * twist; }
    glm::dvec2 y_at(const glm::dvec2& p) const noexcept { return y - p.x * twist; }
    double q_at(const glm::dvec2& p) const noexcept { return q + (p.x * q_dx + p.y * q_dy); }

    // rho^2 Q^4.
    double square_at(const glm::dvec2& p) const noexcept {
        const glm::dvec2 at_x = x_at(p);
        const glm::dvec2 at_y = y_at(p);
        return larger(glm::dot(at_x, at_x), glm::dot(at_y, at_y));
    }
    // L^2.
    double spectral_square_at(const glm::dvec2& p) const noexcept {
        const glm::dvec2 at_x = x_at(p);
        const glm::dvec2 at_y = y_at(p);
        const double a = at_x.x * at_x.x + at_y.x * at_y.x;
        const double b = at_x.x * at_x.y + at_y.x * at_y.y;
        const double c = at_x.y * at_x.y + at_y.y * at_y.y;
        const double half = 0.5 * (a - c);
        return 0.5 * (a + c) + std::sqrt(half * half + b * b);
    }
};

struct Range {
    double least, largest;
};

inline Range range_of_q(const FootprintField& field, const WindowPolygon& polygon) noexcept {
    Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < polygon.count(); ++i) {
        const double q = field.q_at(polygon[i]);
        range = {smaller(q, range.least), larger(q, range.largest)};
    }
    return range;
}

// The largest |a + k b|^2 / (c + k d)^4 for k in [0, 1], where the denominator is not 0: at an end, or where the derivative
// vanishes, d b.b k^2 + (3 d a.b - c b.b) k + 2 d a.a - c a.b = 0.
inline double largest_along(const glm::dvec2& a, const glm::dvec2& b, double c, double d) noexcept {
    double largest = 0.0;
    const auto consider = [&](double k) {
        if (!(k >= 0.0 && k <= 1.0)) return;
        const glm::dvec2 numerator = a + k * b;
        const double square = (c + k * d) * (c + k * d);
        largest = larger(glm::dot(numerator, numerator) / (square * square), largest);
    };
    consider(0.0);
    consider(1.0);
    const double second = d * glm::dot(b, b);
    const double first = 3.0 * d * glm::dot(a, b) - c * glm::dot(b, b);
    const double constant = 2.0 * d * glm::dot(a, a) - c * glm::dot(a, b);
    const double discriminant = first * first - 4.0 * second * constant;
    if (discriminant >= 0.0) {
        const double root = -0.5 * (first + std::copysign(std::sqrt(discriminant), first));
        consider(root / second);
        consider(constant / root);
    }
    return largest;
}

// The largest rho^2, for a polygon in front. Along lines of constant Q it is convex, so it is largest on the polygon's
// border; along a side X, Y and Q are affine.
inline double largest_square_of_rho(const FootprintField& field, const WindowPolygon& polygon) noexcept {
    double largest = 0.0;
    for (std::size_t i = 0; i < polygon.count(); ++i) {
        const glm::dvec2& from = polygon[i];
        const glm::dvec2& to = polygon.after(i);
        const double q = field.q_at(from);
        const double q_change = field.q_at(to) - q;
        const glm::dvec2 x = field.x_at(from);
        const glm::dvec2 y = field.y_at(from);
        largest = larger(largest_along(x, field.x_at(to) - x, q, q_change), largest);
        largest = larger(largest_along(y, field.y_at(to) - y, q, q_change), largest);
    }
    return largest;
}

// Where |a + k b|^2 <= v, or a little more: the interval centre +- sqrt((v - least) / b.b), widened for the roundings.
class Sublevel {
public:
    Sublevel(const glm::dvec2& a, const glm::dvec2& b) noexcept : size_(glm::dot(b, b)) {
        if (!(size_ > 0.0)) {
            least_ = glm::dot(a, a) * (1.0 - 0x1p-40);
            return;
        }
        const double left = a.x * b.y;
        const double right = a.y * b.x;
        const double cross = std::fabs(left - right) - 0x1p-50 * (std::fabs(left) + std::fabs(right));
        least_ = cross > 0.0 ? cross * cross / size_ * (1.0 - 0x1p-40) : 0.0;
        centre_ = -glm::dot(a, b) / size_;
        slack_ = 0x1p-48 * (std::fabs(a.x * b.x) + std::fabs(a.y * b.y)) / size_;
    }

    double least() const noexcept { return least_; }

    // The part of the polygon inside, its coordinate `axis` being k. Precondition: v >= least().
    WindowPolygon cut(const WindowPolygon& polygon, glm::length_t axis, double v) const noexcept {
        if (!(size_ > 0.0)) return polygon;
        const double half = std::sqrt((v - least_) / size_) * (1.0 + 0x1p-40) + slack_;
        return polygon.cut(axis, 1.0, half + centre_).cut(axis, -1.0, half - centre_);
    }

private:
    double size_, least_ = 0.0, centre_ = 0.0, slack_ = 0.0;
};

// A lower bound on rho^2 over the polygon, and within 1 % of it (0.5 % of rho) where the search below is not cut short.
//
// v = max(|X|^2, |Y|^2) <= v1 holds in a box, so where v is in [v0, v1] rho^2 is at least v0 / Q^4 with Q the largest of
// box and polygon. The range of v is halved until that bound is close to a value that is attained.
inline double least_square_of_rho(const FootprintField& field, const WindowPolygon& polygon) noexcept {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Sublevel of_x(field.x, field.twist);
    const Sublevel of_y(field.y, -field.twist);
    double attained = infinity;
    double highest = 0.0;
    for (std::size_t i = 0; i < polygon.count(); ++i) {
        const double v = field.square_at(polygon[i]);
        const double q = field.q_at(polygon[i]);
        highest = larger(v, highest);
        if (q > field.q_error) attained = smaller(v / (q * q * q * q), attained);
    }
    const double lowest = larger(of_x.least(), of_y.least());

    struct Interval {
        double low, high;
    };
    std::array<Interval, 64> pending{};
    std::size_t count = 0;
    pending[count++] = {lowest, larger(highest * (1.0 + 0x1p-40), lowest)};
    double bound = infinity;
    for (int budget = 500; count != 0; --budget) {
        const auto [low, high] = pending[--count];
        const WindowPolygon part = of_y.cut(of_x.cut(polygon, 1, high), 0, high);
        double q = -infinity;
        for (std::size_t i = 0; i < part.count(); ++i) {
            const double q_here = field.q_at(part[i]);
            q = larger(q_here, q);
            if (q_here > field.q_error)
                attained = smaller(field.square_at(part[i]) / (q_here * q_here * q_here * q_here), attained);
        }
        q += field.q_error;
        if (!(q > 0.0)) continue;  // no point in front
        const double size = larger(std::sqrt(low) - field.error, 0.0);
        const double here = size * size / (q * q * q * q);
        if (here >= 0.99 * attained || budget <= 0 || count + 2 > pending.size()) {
            bound = smaller(here, bound);
            continue;
        }
        const double middle = low > 0x1p-7 * high ? std::sqrt(low) * std::sqrt(high) : 0x1p-6 * high;
        if (!(middle > low && middle < high)) {
            bound = smaller(here, bound);
            continue;
        }
        pending[count++] = {middle, high};
        pending[count++] = {low, middle};
    }
    return smaller(bound, attained);
}

// The largest ratio of the singular values times |D|, for a polygon in front: L^2 / Q is convex, as the square of a convex
// function over an affine one, so a corner has it.
inline double largest_anisotropy(const FootprintField& field, const WindowPolygon& polygon) noexcept {
    double largest = 0.0;
    for (std::size_t i = 0; i < polygon.count(); ++i)
        largest = larger(field.spectral_square_at(polygon[i]) / field.q_at(polygon[i]), largest);
    return largest;
}

}  // namespace TEXGEN_DETAIL
