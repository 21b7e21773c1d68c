#pragma once

// The definition of a coordinate in exact rationals, divided wherever it divides, and what its error may be.

#include <array>
#include <cmath>
#include <cstddef>

#include "judges/oracle.hpp"
#include "texgen/reference.hpp"

namespace reference_cases {

namespace reference = texgen::reference;

using support::exactly;
using support::Rational;
using texgen::FragmentRect;
using texgen::Triangle;

inline Rational centre(int pixel) { return Rational(2 * pixel + 1, 2); }

// lambda_i / w_i with barycentrics that sum to 1, divided wherever the definition divides.
inline std::array<Rational, 3> by_the_book(const Triangle& triangle, const Rational& x, const Rational& y) {
    const std::array vertices{triangle.a, triangle.b, triangle.c};
    const auto area = [](const std::array<Rational, 6>& p) {
        return Rational((p[2] - p[0]) * (p[5] - p[1]) - (p[3] - p[1]) * (p[4] - p[0]));
    };
    std::array<Rational, 6> corners;
    for (std::size_t i = 0; i < 3; ++i) {
        corners[2 * i] = exactly(vertices[i].window.x);
        corners[2 * i + 1] = exactly(vertices[i].window.y);
    }
    std::array<Rational, 3> result;
    for (std::size_t i = 0; i < 3; ++i) {
        std::array<Rational, 6> moved = corners;
        moved[2 * i] = x;
        moved[2 * i + 1] = y;
        result[i] = area(moved) / area(corners) / exactly(vertices[i].clip_w);
    }
    return result;
}

// What interpolation_error allows around the exact quotient of a component of strq by q.
struct Exact {
    Rational value;     // s/q
    Rational slack;     // beyond half an ulp
    Rational q_over_w;  // its sign says in front or behind
    Rational q_magnitude;
};

// Below this |q/w| the sign may be wrong.
inline Rational uncertainty(const Exact& exact) { return exactly(reference::interpolation_error) * exact.q_magnitude; }

inline Exact exact_coordinate(const Triangle& triangle, const FragmentRect& pixel, int component) {
    const std::array<Rational, 3> weight = by_the_book(triangle, centre(pixel.x), centre(pixel.y));
    const std::array vertices{triangle.a.strq, triangle.b.strq, triangle.c.strq};
    Rational numerator = 0, numerator_magnitude = 0;
    Exact exact{0, 0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
        const Rational term = weight[i] * exactly(vertices[i][component]);
        numerator += term;
        numerator_magnitude += support::magnitude(term);
        exact.q_over_w += weight[i] * exactly(vertices[i].w);
        exact.q_magnitude += support::magnitude(weight[i] * exactly(vertices[i].w));
    }
    if (support::magnitude(exact.q_over_w) <= uncertainty(exact)) return exact;
    exact.value = numerator / exact.q_over_w;
    exact.slack = exactly(reference::interpolation_error) *
                  (numerator_magnitude + support::magnitude(exact.value) * exact.q_magnitude) /
                  (support::magnitude(exact.q_over_w) - uncertainty(exact));
    return exact;
}

inline bool within(float computed, const Exact& exact) {
    if (!std::isfinite(computed)) return computed == support::nearest<float>(exact.value);
    const Rational half_ulp = support::power_of_two(support::ulp_exponent<float>(exact.value) - 1);
    return support::magnitude(exactly(computed) - exact.value) <= half_ulp + exact.slack;
}

}  // namespace reference_cases
