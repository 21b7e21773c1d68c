#pragma once

// Workloads of surfaces: triangles as the projector sees them, and quadrilaterals.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "support/limits.hpp"
#include "support/random.hpp"
#include "support/stopwatch.hpp"
#include "support/workloads/numbers.hpp"
#include "texgen/surface.hpp"

namespace support::detail {

inline Numbers ordinary_corners(Random& random) {
    Numbers n;
    for (int i = 0; i < 3; ++i)
        for (const double x : ordinary_strq(random)) n.push_back(x);
    return n;
}
// Edge on or next to it: sums and multiples of one another, up to units and to a bit.
inline Numbers draw_corners(Random& random) {
    if (random.integer(0, 3) == 0) return any_numbers<12>(random);
    Numbers n = ordinary_corners(random);
    for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t i : {k, 4 + k}) n[i] = std::ldexp(random.integer(1, 1 << 21), -20);
        n[8 + k] = n[k] + n[4 + k];
        const double unit = random.coin() ? 1.0 : std::ldexp(1.0, random.integer(-20, 20));
        for (std::size_t i : {k, 4 + k, 8 + k}) n[i] *= unit;
    }
    const double unit = std::ldexp(1.0, random.integer(-8, 8));
    for (std::size_t k = 0; k < 4; ++k) n[k] = random.coin() ? unit * n[k] : unit * n[4 + k];
    if (random.coin()) n[static_cast<std::size_t>(random.integer(0, 11))] *= 1.0 + 0x1p-22;
    return n;
}
inline constexpr Inputs corner_inputs{12, ordinary_corners, draw_corners,
                                      "drawn: triangles edge on or next to it, in mixed units"};
template <class Ask>
Calls corner_calls(const Numbers& n, Ask ask) {
    Reader reader(n);
    const glm::vec4 a = reader.vec4(), b = reader.vec4(), c = reader.vec4();
    return calls_of([a, b, c, ask] { ask(a, b, c); });
}
// Where numbers of all sizes meet in products of three, no two doubles hold what is left.
inline double facing_limit(const Numbers& n) {
    double least = HUGE_VAL, largest = 0.0;
    for (const double x : n) {
        if (x != 0.0) least = std::min(least, std::fabs(x));
        largest = std::max(largest, std::fabs(x));
    }
    return largest > 0x1p8 * least ? limit::all_sizes : limit::any;
}
inline Calls facing_calls(const Numbers& n) {
    return corner_calls(n, [](const glm::vec4& a, const glm::vec4& b, const glm::vec4& c) {
        keep(texgen::facing(a, b, c, texgen::TextureOrigin::bottom_left));
    });
}
inline Calls slide_area_calls(const Numbers& n) {
    return corner_calls(
        n, [](const glm::vec4& a, const glm::vec4& b, const glm::vec4& c) { keep(texgen::slide_area(a, b, c)); });
}
inline Calls receiver_plane_calls(const Numbers& n) {
    return corner_calls(
        n, [](const glm::vec4& a, const glm::vec4& b, const glm::vec4& c) { keep(texgen::receiver_plane(a, b, c)); });
}
inline Numbers ordinary_quadrilateral(Random& random) {
    Numbers n = {0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0};
    for (double& x : n) x += random.uniform(-0.2, 0.2);
    return n;
}
// Next to a line, or with a corner on the diagonal of its neighbours, but for an ulp.
inline Numbers draw_quadrilateral(Random& random) {
    Numbers n = ordinary_quadrilateral(random);
    const std::size_t last = random.coin() ? 2 : 0;
    for (std::size_t i : {std::size_t{2}, std::size_t{6}}) {
        const double along = random.uniform(0.1, 0.9);
        for (std::size_t k = 0; k < 2; ++k) n[i + k] = n[k] + along * (n[4 + k] - n[k]);
        n[i + random.bits() % 2] *= 1.0 + random.integer(-2, 2) * 0x1p-52;
        if (last == 0) break;
    }
    if (random.integer(0, 3) == 0)
        for (double& x : n) x += 1e3;
    return n;
}
inline constexpr Inputs quadrilateral_inputs{0, ordinary_quadrilateral, draw_quadrilateral,
                                             "drawn: quadrilaterals next to a triangle or a line"};
template <bool IsMatrix>
Calls quadrilateral_calls(const Numbers& n) {
    const std::array<glm::dvec2, 4> corners{glm::dvec2(n[0], n[1]), glm::dvec2(n[2], n[3]), glm::dvec2(n[4], n[5]),
                                            glm::dvec2(n[6], n[7])};
    return calls_of([corners] {
        if constexpr (IsMatrix)
            keep(texgen::keystone(corners));
        else
            keep(texgen::quadrilateral(corners, texgen::rectangle_texture(640.0, 480.0)));
    });
}

}  // namespace support::detail
