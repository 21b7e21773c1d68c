#pragma once

// Families of triangles with magnitudes drawn log-uniformly: the easy ones, and those on which obvious formulas break.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "support/hex.hpp"
#include "support/random.hpp"
#include "texgen/primitives.hpp"

namespace support {

enum class Family {
    friendly,
    horizon,     // clip_w over ten decades, pixels to 1e5
    sliver,      // on a grid of 1/256 pixel, the third vertex as near to the line of the others as the grid allows
    far_away,    // coordinates about 1e6
    wide_q,      // q from 1e-6 to 1e6
    crossing,    // q of both signs: the projector's plane goes through
    cancelling,  // s and t of both signs and of many magnitudes
    parallel,    // w = 1 at all vertices
};
inline constexpr std::array families{Family::friendly, Family::horizon,  Family::sliver,     Family::far_away,
                                     Family::wide_q,   Family::crossing, Family::cancelling, Family::parallel};
inline constexpr std::array family_names{"friendly", "horizon",  "sliver",     "far away",
                                         "wide q",   "crossing", "cancelling", "parallel"};

inline std::string hex(const texgen::WindowVertex& v) {
    return "{" + hex(v.window) + ", " + hex(v.clip_w) + ", " + hex(v.strq) + "}";
}
inline std::string hex(const texgen::Triangle& t) { return "{" + hex(t.a) + ", " + hex(t.b) + ", " + hex(t.c) + "}"; }

inline double twice_area(const texgen::Triangle& t) {
    const glm::dvec2 a(t.a.window), b(t.b.window), c(t.c.window);
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

namespace detail {

inline glm::vec2 on_grid(glm::dvec2 p) {
    return {support::to_float(std::round(p.x * 256.0) / 256.0), support::to_float(std::round(p.y * 256.0) / 256.0)};
}

inline glm::vec4 coordinates(Family family, Random& random) {
    double q = random.uniform(0.5, 4.0);
    if (family == Family::wide_q) q = random.power_of_ten(-6.0, 6.0);
    if (family == Family::crossing) q = random.uniform(-2.0, 2.0);
    double s = random.uniform(-0.5, 1.5), t = random.uniform(-0.5, 1.5);
    if (family == Family::far_away) {
        s += 1e6;
        t -= 1e6;
    }
    if (family == Family::cancelling) {
        s = (random.coin() ? 1.0 : -1.0) * random.power_of_ten(-6.0, 6.0);
        t = (random.coin() ? 1.0 : -1.0) * random.power_of_ten(-6.0, 6.0);
    }
    return {support::to_float(s * q), support::to_float(t * q), random.uniform_float(0.0, q), support::to_float(q)};
}

}  // namespace detail

// A triangle of the family, with an area.
inline texgen::Triangle make_triangle(Family family, Random& random) {
    const double size = family == Family::horizon ? random.power_of_ten(2.0, 5.0) : 1024.0;
    for (;;) {
        const auto window = [&] {
            return glm::vec2(random.uniform_float(-0.2 * size, size), random.uniform_float(-0.2 * size, size));
        };
        const auto clip_w = [&] {
            if (family == Family::parallel) return 1.0f;
            return support::to_float(family == Family::horizon ? random.power_of_ten(-4.0, 6.0)
                                                               : random.uniform(0.5, 8.0));
        };
        std::array<glm::vec2, 3> corner{window(), window(), window()};
        if (family == Family::sliver) {
            corner[0] = detail::on_grid(glm::dvec2(corner[0]));
            corner[1] = detail::on_grid(glm::dvec2(corner[1]));
            const double along = random.uniform(0.1, 0.9);
            const glm::dvec2 a(corner[0]), b(corner[1]);
            const glm::dvec2 offset(random.integer(-1, 1) / 256.0, random.integer(-1, 1) / 256.0);
            corner[2] = detail::on_grid(a + along * (b - a) + offset);
        }
        texgen::Triangle triangle{};
        std::array<texgen::WindowVertex*, 3> vertices{&triangle.a, &triangle.b, &triangle.c};
        for (std::size_t i = 0; i < 3; ++i) *vertices[i] = {corner[i], clip_w(), detail::coordinates(family, random)};
        const double area = std::fabs(twice_area(triangle));
        if (area > (family == Family::sliver ? 0.0 : 0.01 * size)) return triangle;
    }
}

inline int pixel_of(double window) { return static_cast<int>(std::clamp(std::floor(window), -0x1p31, 0x1p31 - 1.0)); }

// The pixel of a random point of the triangle, near its border more often than not.
inline texgen::FragmentRect pixel_near(const texgen::Triangle& t, Random& random) {
    std::array<double, 3> weight{random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), random.uniform(0.0, 1.0)};
    if (random.coin()) weight[static_cast<std::size_t>(random.integer(0, 2))] *= 1e-3;
    const double sum = weight[0] + weight[1] + weight[2];
    const glm::dvec2 point =
        (weight[0] * glm::dvec2(t.a.window) + weight[1] * glm::dvec2(t.b.window) + weight[2] * glm::dvec2(t.c.window)) /
        sum;
    return {pixel_of(point.x), pixel_of(point.y), 1, 1};
}

}  // namespace support
