#pragma once

// The judge of millions of values: the homogeneous coordinates exactly, as integers times powers of two. Rationals
// (oracle.hpp) do the same and are reduced at every step, which is too slow for that many; exact_test.cpp compares
// them. Nothing is divided: whether a float is nearest to n/d is asked of n and d.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "judges/oracle.hpp"
#include "texgen/conventions.hpp"
#include "texgen/primitives.hpp"

namespace support {

inline Dyadic magnitude(const Dyadic& value) { return value.sign() < 0 ? -value : value; }

// n/d: a coordinate and its q. It is asked about only where d > 0.
struct Quotient {
    Dyadic n, d;

    // Within a few double ulp.
    double estimate() const {
        const double quotient = n.estimate() / d.estimate();
        return quotient > 0.0 || quotient < 0.0 ? quotient : n.sign() == 0 ? 0.0 : nearest<double>(rational());
    }
    Rational rational() const { return n.rational() / d.rational(); }
};

// -1, 0, 1: n/d against a number, which may be infinite; 0 against a NaN.
inline int compare(const Quotient& u, double number) {
    if (std::isnan(number)) return 0;
    if (std::isinf(number)) return number > 0.0 ? -1 : 1;
    return (u.n - Dyadic(number) * u.d).sign();
}

// |number - n/d|, within a few double ulp.
inline double distance(double number, const Quotient& u) {
    if (!std::isfinite(number)) return std::numeric_limits<double>::infinity();
    return std::fabs((Dyadic(number) * u.d - u.n).estimate() / u.d.estimate());
}

namespace detail {

// The middle of a float and its neighbour towards `up` or down. Beyond the largest float stands 2^128.
inline double middle(float value, bool up) {
    const float next = std::nextafter(value, up ? HUGE_VALF : -HUGE_VALF);
    const auto unbounded = [](float x) { return std::isinf(x) ? std::copysign(0x1p128, x) : static_cast<double>(x); };
    return 0.5 * unbounded(value) + 0.5 * unbounded(next);
}

}  // namespace detail

// Whether `value` is the float nearest to n/d, ties to even (to any of both, where `ties_to_even` is false).
inline bool is_nearest(float value, const Quotient& u, bool ties_to_even = true) {
    if (std::isnan(value)) return false;
    const bool even = (std::bit_cast<std::uint32_t>(value) & 1u) == 0u;
    const bool takes_ties = even || !ties_to_even;
    if (std::isinf(value)) {
        const int beyond = compare(u, std::copysign(0x1.ffffffp127, value));
        return (value > 0.0f ? beyond : -beyond) > (takes_ties ? -1 : 0);
    }
    const int above_low = compare(u, detail::middle(value, false));
    const int above_high = compare(u, detail::middle(value, true));
    return takes_ties ? above_low >= 0 && above_high <= 0 : above_low > 0 && above_high < 0;
}

// The float nearest to n/d, ties to even.
inline float nearest_float(const Quotient& u) {
    const auto guess = static_cast<float>(u.estimate());
    for (const float value : {guess, std::nextafter(guess, HUGE_VALF), std::nextafter(guess, -HUGE_VALF)})
        if (is_nearest(value, u)) return value;
    return std::numeric_limits<float>::quiet_NaN();
}

// Whether n/d lies exactly in the middle of two floats. Precondition: its size is below 2^128.
inline bool is_tie(const Quotient& u) {
    const auto guess = static_cast<float>(u.estimate());
    return compare(u, detail::middle(guess, false)) == 0 || compare(u, detail::middle(guess, true)) == 0;
}

// How far n/d is from the middle of two floats.
inline double distance_to_tie(const Quotient& u) {
    const auto guess = static_cast<float>(u.estimate());
    return std::min(distance(detail::middle(guess, false), u), distance(detail::middle(guess, true), u));
}

// |value - n/d| <= max(limit, 1/2 ulp).
inline bool is_within(float value, const Quotient& u, double limit) {
    if (std::isnan(value)) return false;
    if (is_nearest(value, u, false)) return true;
    if (std::isinf(limit)) return true;
    return std::isfinite(value) && magnitude(Dyadic(value) * u.d - u.n) <= Dyadic(limit) * u.d;
}

// What a tolerance promises of r: relative to max(1, |r|).
inline bool is_within_relatively(float value, const Quotient& u, double limit) {
    if (is_within(value, u, limit)) return true;
    return std::isfinite(value) && magnitude(Dyadic(value) * u.d - u.n) <= Dyadic(limit) * magnitude(u.n);
}

// (s, t, r, q) of a point, up to a positive factor.
struct Homogeneous {
    Dyadic s, t, r, q;

    Quotient over_q(std::size_t coordinate) const { return {coordinate == 0 ? s : coordinate == 1 ? t : r, q}; }
};

inline Homogeneous exactly_at(const texgen::Segment& segment, float alpha) {
    const Dyadic to_b(alpha), to_a = Dyadic(1.0) - to_b;
    const auto mix = [&](int k) { return to_a * Dyadic(segment.a[k]) + to_b * Dyadic(segment.b[k]); };
    return {mix(0), mix(1), mix(2), mix(3)};
}

inline Homogeneous exactly_at(const glm::dmat4& matrix, const glm::vec3& point) {
    const auto row = [&](int k) {
        return Dyadic(matrix[0][k]) * Dyadic(point.x) + Dyadic(matrix[1][k]) * Dyadic(point.y) +
               Dyadic(matrix[2][k]) * Dyadic(point.z) + Dyadic(matrix[3][k]);
    };
    return {row(0), row(1), row(2), row(3)};
}

// The perspective-correct (s, t, r, q) of fragments, s = sum lambda_i s_i / w_i, and so on, times one positive number.
class ExactTriangle {
public:
    // Precondition: finite, with an area, and clip_w > 0.
    explicit ExactTriangle(const texgen::Triangle& triangle) {
        const std::array corners{triangle.a, triangle.b, triangle.c};
        const auto x = [&](std::size_t i) { return Dyadic(corners[i % 3].window.x); };
        const auto y = [&](std::size_t i) { return Dyadic(corners[i % 3].window.y); };
        const Dyadic area = (x(1) - x(0)) * (y(2) - y(0)) - (y(1) - y(0)) * (x(2) - x(0));
        for (std::size_t i = 0; i < 3; ++i) {
            const Dyadic weight =
                Dyadic(area.sign()) * Dyadic(corners[(i + 1) % 3].clip_w) * Dyadic(corners[(i + 2) % 3].clip_w);
            const Dyadic constant = x(i + 1) * y(i + 2) - y(i + 1) * x(i + 2);
            for (std::size_t k = 0; k < 5; ++k) {
                const Dyadic f = weight * (k == 4 ? Dyadic(1.0) : Dyadic(corners[i].strq[static_cast<int>(k)]));
                planes_[k].x = planes_[k].x + f * (y(i + 1) - y(i + 2));
                planes_[k].y = planes_[k].y + f * (x(i + 2) - x(i + 1));
                planes_[k].constant = planes_[k].constant + f * constant;
            }
        }
    }

    Homogeneous at(std::int64_t x, std::int64_t y) const {
        return {value(0, x, y), value(1, x, y), value(2, x, y), value(3, x, y)};
    }

    // Where it does not, nothing is promised: the fragment is outside the triangle and behind the camera.
    bool has_positive_w(std::int64_t x, std::int64_t y) const { return value(4, x, y).sign() > 0; }

    bool has_constant_q() const { return planes_[3].x.sign() == 0 && planes_[3].y.sign() == 0; }

private:
    struct Plane {
        Dyadic x, y, constant;
    };

    Dyadic value(std::size_t k, std::int64_t x, std::int64_t y) const {
        return planes_[k].x * Dyadic(2 * x + 1, -1) + planes_[k].y * Dyadic(2 * y + 1, -1) + planes_[k].constant;
    }

    std::array<Plane, 5> planes_;
};

// The limits of s (0), of t (1) and of r (2): infinite where there is no depth.
inline glm::dvec2 limits_of(const texgen::TextureRegion& region, std::size_t coordinate) {
    if (coordinate == 2) return region.depth().value_or(glm::dvec2(-HUGE_VAL, HUGE_VAL));
    const auto k = static_cast<int>(coordinate);
    return {region.min()[k], region.max()[k]};
}

// The closed region, asked about floats as they are.
inline bool contains(const texgen::TextureRegion& region, std::size_t coordinate, float value) {
    if (coordinate == 2 && !region.depth()) return true;
    const glm::dvec2 limits = limits_of(region, coordinate);
    return static_cast<double>(value) >= limits.x && static_cast<double>(value) <= limits.y;
}
inline bool contains(const texgen::TextureRegion& region, float s, float t, float r) {
    return contains(region, 0, s) && contains(region, 1, t) && contains(region, 2, r);
}
inline bool contains(const texgen::TextureRegion& region, const Homogeneous& at) {
    if (at.q.sign() <= 0) return false;
    for (std::size_t k = 0; k < 3; ++k)
        if (!contains(region, k, nearest_float(at.over_q(k)))) return false;
    return true;
}

}  // namespace support
