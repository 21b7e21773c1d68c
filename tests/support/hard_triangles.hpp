#pragma once

// Triangles with the rectangle of fragments where it hurts: a table of families, each with the property that makes it
// hard, so that a test can count how often it came up.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "judges/exact.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/triangles.hpp"
#include "texgen/primitives.hpp"

namespace support {

namespace detail {

inline Shot ordinary(Family family, Random& random) {
    const texgen::Triangle triangle = make_triangle(family, random);
    return {triangle, rect_near(triangle, random)};
}

inline Shot with_root(int coordinate, Random& random) {
    texgen::Triangle triangle = make_triangle(coordinate == 3 ? Family::crossing : Family::friendly, random);
    if (coordinate != 3)
        for (texgen::WindowVertex* vertex : vertices(triangle))
            vertex->strq[coordinate] = random.uniform_float(-1.0, 1.0);
    return {triangle, rect_at_root(triangle, coordinate, random)};
}

// q is exactly 0 in one column of fragments (or one row), or next to it: w = 1, and q/w an affine function of the
// window with small numbers.
inline Shot exact_root(Random& random) {
    texgen::Triangle triangle{};
    do {
        for (texgen::WindowVertex* vertex : vertices(triangle)) {
            vertex->window = {static_cast<float>(random.integer(0, 512)), static_cast<float>(random.integer(0, 512))};
            vertex->clip_w = std::ldexp(1.0f, random.integer(-3, 3));
        }
    } while (std::fabs(twice_area(triangle)) < 1000.0);
    const int column = random.integer(100, 400), row = random.integer(100, 400);
    const int dx = random.integer(-3, 3), dy = random.coin() ? 0 : random.integer(-3, 3);
    const float scale = std::ldexp(1.0f, random.integer(-20, 20));
    for (texgen::WindowVertex* vertex : vertices(triangle)) {
        vertex->strq = {random.uniform_float(-2.0, 2.0), random.uniform_float(-2.0, 2.0),
                        random.uniform_float(-2.0, 2.0),
                        (static_cast<float>(dx) * (vertex->window.x - (static_cast<float>(column) + 0.5f)) +
                         static_cast<float>(dy) * (vertex->window.y - (static_cast<float>(row) + 0.5f))) *
                            scale * vertex->clip_w};
    }
    const int nudge = random.integer(-2, 2);
    if (std::abs(nudge) == 1) triangle.b.strq.w = neighbour(triangle.b.strq.w, nudge);
    return {triangle, rect_about(column, row, random)};
}

// s/q at the rectangle's first fragment lies exactly in the middle of two floats: it is the middle of an edge, and
// s_a + s_b = tie (q_a + q_b).
inline Shot tie(Random& random) {
    texgen::Triangle triangle = make_triangle(Family::parallel, random);
    const int x = random.integer(100, 400), y = random.integer(100, 400);
    const float half = static_cast<float>(random.integer(1, 60));
    triangle.a.window = {static_cast<float>(x) + 0.5f - half, static_cast<float>(y) + 0.5f};
    triangle.b.window = {static_cast<float>(x) + 0.5f + half, static_cast<float>(y) + 0.5f};
    triangle.c.window = {static_cast<float>(x), static_cast<float>(y + random.integer(20, 80))};
    const std::int64_t odd = 2 * static_cast<std::int64_t>(random.integer(1 << 23, (1 << 24) - 1)) + 1;  // 25 bits
    const int q_a = random.integer(1, 7), q_b = random.integer(1, 7);
    const std::int64_t sum = odd * (q_a + q_b);
    const auto s_a = static_cast<float>(sum);
    const auto s_b = static_cast<float>(sum - static_cast<std::int64_t>(s_a));
    triangle.a.strq.x = s_a * 0x1p-25f;
    triangle.b.strq.x = s_b * 0x1p-25f;
    triangle.a.strq.w = static_cast<float>(q_a);
    triangle.b.strq.w = static_cast<float>(q_b);
    texgen::FragmentRect rect = rect_about(x, y, random);
    rect.x = x;
    rect.y = y;
    return {triangle, rect};
}

// Window, w, numerators and q, each in its own unit.
inline Shot scaled(Random& random) {
    texgen::Triangle triangle = make_triangle(random.coin() ? Family::friendly : Family::crossing, random);
    const auto unit = [&] { return static_cast<float>(random.coin() ? 1.0 : random.power_of_ten(-30.0, 30.0)); };
    const float window = unit(), w = unit(), numerators = unit(), q = unit();
    for (texgen::WindowVertex* vertex : vertices(triangle)) {
        vertex->window = (vertex->window - glm::vec2(400.0f)) * window;
        vertex->clip_w *= w;
        vertex->strq *= glm::vec4(numerators, numerators, numerators, q);
    }
    const texgen::FragmentRect pixel = pixel_near(triangle, random);
    return {triangle, rect_about(pixel.x / 2, pixel.y / 2, random)};
}

inline Shot subnormal(Random& random) {
    Shot shot = ordinary(Family::friendly, random);
    const bool small_w = random.coin(), small_q = random.coin();
    for (texgen::WindowVertex* vertex : vertices(shot.triangle)) {
        for (int k = 0; k < 3; ++k)
            vertex->strq[k] =
                static_cast<float>(random.integer(-3000, 3000)) * std::numeric_limits<float>::denorm_min();
        if (small_q)
            vertex->strq.w = static_cast<float>(random.integer(1, 3000)) * std::numeric_limits<float>::denorm_min();
        if (small_w)
            vertex->clip_w = static_cast<float>(random.integer(1, 100)) * std::numeric_limits<float>::denorm_min();
    }
    return shot;
}

// All units so small that the planes (about 2^-580 a pixel here) have no square in double.
inline Shot tiny(Random& random) {
    for (;;) {
        Shot shot = ordinary(Family::friendly, random);
        const float window = std::ldexp(1.0f, random.integer(-145, -120));
        const float w = std::ldexp(1.0f, random.integer(-140, -125));
        const float strq = std::ldexp(1.0f, random.integer(-140, -120));
        for (texgen::WindowVertex* vertex : vertices(shot.triangle)) {
            vertex->window *= window;
            vertex->clip_w *= w;
            vertex->strq *= strq;
        }
        if (twice_area(shot.triangle) == 0.0) continue;
        shot.rect.x = random.integer(-300, 300);
        shot.rect.y = random.integer(-300, 300);
        const ExactTriangle exact(shot.triangle);
        if (exact.has_positive_w(shot.rect.x, shot.rect.y) && exact.at(shot.rect.x, shot.rect.y).q.sign() > 0)
            return shot;
    }
}

// Quotients about the largest float.
inline Shot overflowing(Random& random) {
    Shot shot = ordinary(Family::friendly, random);
    for (texgen::WindowVertex* vertex : vertices(shot.triangle)) {
        vertex->strq.w = random.coin() ? 1.0f : random.uniform_float(0.9, 1.1);
        for (int k = 0; k < 3; ++k)
            vertex->strq[k] = random.coin() ? std::numeric_limits<float>::max()
                                            : std::numeric_limits<float>::max() * random.uniform_float(-0.9, 1.0);
    }
    return shot;
}

// At the ends of int, the window's coordinates in units of 256 pixels.
inline Shot far_fragments(Random& random) {
    Shot shot = ordinary(random.coin() ? Family::friendly : Family::crossing, random);
    const bool high_x = random.coin(), high_y = random.coin();
    for (texgen::WindowVertex* vertex : vertices(shot.triangle)) {
        vertex->window.x = (high_x ? 1.0f : -1.0f) * (0x1p31f - 256.0f * static_cast<float>(random.integer(-6, 20)));
        vertex->window.y = (high_y ? 1.0f : -1.0f) * (0x1p31f - 256.0f * static_cast<float>(random.integer(-6, 20)));
    }
    if (twice_area(shot.triangle) == 0.0) return far_fragments(random);
    constexpr int low = std::numeric_limits<int>::min(), high = std::numeric_limits<int>::max();
    shot.rect.x = high_x ? high - random.integer(0, shot.rect.width) : low + random.integer(0, 70);
    shot.rect.y = high_y ? high - random.integer(0, shot.rect.height) : low + random.integer(0, 70);
    return shot;
}

// q/w is the same at all vertices: a parallel projector.
inline Shot constant_q(Random& random) {
    Shot shot = ordinary(Family::friendly, random);
    const float q = random.uniform_float(0.5, 4.0);
    const bool exactly = random.coin();
    for (texgen::WindowVertex* vertex : vertices(shot.triangle)) {
        vertex->clip_w = exactly ? std::ldexp(1.0f, random.integer(-2, 3)) : random.uniform_float(0.5, 8.0);
        vertex->strq.w = q * vertex->clip_w;
    }
    return shot;
}

// q comes down to almost 0 at one vertex, and the rectangle is there.
inline Shot grazing(Random& random) {
    Shot shot = ordinary(random.coin() ? Family::friendly : Family::horizon, random);
    texgen::WindowVertex& vertex = *vertices(shot.triangle)[static_cast<std::size_t>(random.integer(0, 2))];
    vertex.strq.w *= static_cast<float>(random.power_of_ten(-9.0, -2.0));
    shot.rect = rect_about(pixel_of(vertex.window.x), pixel_of(vertex.window.y), random);
    return shot;
}

// Edges along which a coordinate is 0, and that stand in a row or a column of the rectangle, between the middles of its
// fragments or, most of them, in these; two of them cross at a corner.
inline Shot zeros_along_edges(Random& random) {
    Shot shot = ordinary(Family::friendly, random);
    shot.rect = {random.integer(-50, 200), random.integer(-50, 200), 1, 1};
    if (random.integer(0, 3) != 0) shot.rect.width = random.integer(1, 20);
    if (random.integer(0, 3) != 0) shot.rect.height = random.integer(1, 20);
    const auto put_zeros = [&](std::size_t first, glm::length_t coordinate, glm::length_t axis) {
        const int place = axis == 0 ? shot.rect.x + random.integer(0, shot.rect.width - 1)
                                    : shot.rect.y + random.integer(0, shot.rect.height - 1);
        const float at = random.integer(0, 3) != 0 ? 0.5f : random.uniform_float(0.0, 1.0);
        for (std::size_t j = first; j < first + 2; ++j) {
            texgen::WindowVertex& vertex = *vertices(shot.triangle)[j % 3];
            vertex.window[axis] = static_cast<float>(place) + at;
            vertex.strq[coordinate] = random.coin() ? 0.0f : -0.0f;
        }
    };
    const auto first = static_cast<std::size_t>(random.integer(0, 2));
    const int coordinate = random.integer(0, 2), axis = random.integer(0, 1);
    put_zeros(first, coordinate, axis);
    if (random.coin()) put_zeros(first + 1, (coordinate + 1) % 3, 1 - axis);
    return shot;
}

inline bool changes_sign(const Shot& shot, const ExactTriangle& exact, std::size_t coordinate) {
    bool negative = false, positive = false;
    for (const std::int64_t x : {0, shot.rect.width - 1}) {
        for (const std::int64_t y : {0, shot.rect.height - 1}) {
            const Homogeneous at = exact.at(shot.x(x), shot.y(y));
            const int sign = (coordinate == 0 ? at.s : at.q).sign();
            negative = negative || sign < 0;
            positive = positive || sign > 0;
        }
    }
    return negative && positive;
}

template <class Predicate>
bool any_fragment(const Shot& shot, const ExactTriangle& exact, const Predicate& predicate) {
    for (std::int64_t y = 0; y < shot.rect.height; ++y)
        for (std::int64_t x = 0; x < shot.rect.width; ++x)
            if (predicate(exact.at(shot.x(x), shot.y(y)))) return true;
    return false;
}

inline double spread(const texgen::Triangle& triangle, float (*value)(const texgen::WindowVertex&)) {
    const auto [low, high] =
        std::minmax({std::fabs(value(triangle.a)), std::fabs(value(triangle.b)), std::fabs(value(triangle.c))});
    return static_cast<double>(high) / static_cast<double>(low);
}

}  // namespace detail

// s/q is the middle M of two floats at one column, from 993 to 1023, hundreds to thousands of times that at column 0,
// and a function of more bits than a double. With q = 1 + t for t = (2 column + 1) / 2048 and k = 2 column + 1, in
// units of 2^-25,
//   (M - j k) (1 - t) + (2 M + j (2048 - k)) t = M (1 + t):
// the first is a float as it is a multiple of 2^13, and the second as it is below 2^24.
inline Shot steep_row_with_a_tie(int column, Random& random) {
    const int k = 2 * column + 1;
    std::uint32_t inverse = 1;  // of k, modulo 2^32: Newton's iteration doubles its right bits
    for (int i = 0; i < 5; ++i) inverse *= 2u - static_cast<std::uint32_t>(k) * inverse;
    std::int64_t first = 0, last = 0;
    do {
        const int middle = 2 * random.integer(1 << 23, (1 << 24) - 1) + 1;
        const int range = (1 << 24) / (2048 - k);
        int j = -2 * middle / (2048 - k) + random.integer(range / 2, range);
        j += static_cast<int>((static_cast<std::uint32_t>(middle) * inverse - static_cast<std::uint32_t>(j)) & 0x1fffu);
        first = middle - std::int64_t{j} * k;
        last = 2 * middle + std::int64_t{j} * (2048 - k);
    } while (last < 1 << 22 || last >= 1 << 24 || first >= std::int64_t{1} << 37);
    const auto vertex = [](float x, float y, std::int64_t s, float q) {
        const float value = static_cast<float>(s) * 0x1p-25f;
        return texgen::WindowVertex{{x, y}, 1.0f, {value, 0.25f * q, 0.25f * q, q}};
    };
    return {{vertex(0.0f, 0.0f, first, 1.0f), vertex(1024.0f, 0.0f, last, 2.0f),
             vertex(0.0f, random.uniform_float(512.0, 1024.0), first, 1.0f)},
            {column, 0, 1, 1}};
}

struct HardFamily {
    const char* name;
    Shot (*make)(Random&);
    bool (*is_hard)(const Shot&, const ExactTriangle&);
    double least_share;  // of its members that are hard
};

inline const std::array hard_families{
    HardFamily{"friendly", [](Random& random) { return detail::ordinary(Family::friendly, random); },
               [](const Shot&, const ExactTriangle&) { return true; }, 1.0},
    HardFamily{"w = 1", [](Random& random) { return detail::ordinary(Family::parallel, random); },
               [](const Shot& shot, const ExactTriangle&) { return shot.triangle.b.clip_w == 1.0f; }, 1.0},
    HardFamily{"horizon: w over more than 1e5",
               [](Random& random) { return detail::ordinary(Family::horizon, random); },
               [](const Shot& shot, const ExactTriangle&) {
                   return detail::spread(shot.triangle, [](const texgen::WindowVertex& v) { return v.clip_w; }) > 1e5;
               },
               0.2},
    HardFamily{"slivers thinner than 1/256", [](Random& random) { return detail::ordinary(Family::sliver, random); },
               [](const Shot& shot, const ExactTriangle&) {
                   const glm::vec2 edge = shot.triangle.b.window - shot.triangle.a.window;
                   return std::fabs(twice_area(shot.triangle)) < std::hypot(edge.x, edge.y) / 256.0;
               },
               0.3},
    HardFamily{"coordinates 1e6 away", [](Random& random) { return detail::ordinary(Family::far_away, random); },
               [](const Shot& shot, const ExactTriangle& exact) {
                   return detail::any_fragment(shot, exact, [](const Homogeneous& at) {
                       return at.q.sign() > 0 && std::fabs(at.over_q(0).estimate()) > 9e5;
                   });
               },
               0.8},
    HardFamily{"q over more than 1e6", [](Random& random) { return detail::ordinary(Family::wide_q, random); },
               [](const Shot& shot, const ExactTriangle&) {
                   return detail::spread(shot.triangle, [](const texgen::WindowVertex& v) { return v.strq.w; }) > 1e6;
               },
               0.3},
    HardFamily{"s and t of all sizes, cancelling",
               [](Random& random) { return detail::ordinary(Family::cancelling, random); },
               [](const Shot& shot, const ExactTriangle&) {
                   return detail::spread(shot.triangle, [](const texgen::WindowVertex& v) { return v.strq.x; }) > 1e3;
               },
               0.5},
    HardFamily{"q changes sign in the rectangle", [](Random& random) { return detail::with_root(3, random); },
               [](const Shot& shot, const ExactTriangle& exact) { return detail::changes_sign(shot, exact, 3); }, 0.5},
    HardFamily{"s changes sign in the rectangle", [](Random& random) { return detail::with_root(0, random); },
               [](const Shot& shot, const ExactTriangle& exact) { return detail::changes_sign(shot, exact, 0); }, 0.4},
    HardFamily{"q is exactly 0 at a fragment", detail::exact_root,
               [](const Shot& shot, const ExactTriangle& exact) {
                   return detail::any_fragment(shot, exact, [](const Homogeneous& at) { return at.q.sign() == 0; });
               },
               0.3},
    HardFamily{"s/q is exactly between two floats", detail::tie,
               [](const Shot& shot, const ExactTriangle& exact) {
                   return is_tie(exact.at(shot.rect.x, shot.rect.y).over_q(0));
               },
               0.9},
    HardFamily{"all units from 1e-30 to 1e30", detail::scaled,
               [](const Shot& shot, const ExactTriangle&) {
                   const auto& [window, w, strq] = shot.triangle.a;
                   int extreme = 0;
                   for (const float unit : {window.x, w, strq.x, strq.w})
                       extreme += std::fabs(unit) > 1e10f || std::fabs(unit) < 1e-10f;
                   return extreme >= 2;
               },
               0.2},
    HardFamily{
        "subnormal numbers", detail::subnormal,
        [](const Shot& shot, const ExactTriangle&) { return std::fpclassify(shot.triangle.a.strq.x) == FP_SUBNORMAL; },
        0.9},
    HardFamily{"all units about 1e-40", detail::tiny,
               [](const Shot& shot, const ExactTriangle&) { return shot.triangle.a.clip_w < 1e-36f; }, 0.9},
    HardFamily{"quotients about the largest float", detail::overflowing,
               [](const Shot& shot, const ExactTriangle& exact) {
                   return detail::any_fragment(shot, exact, [](const Homogeneous& at) {
                       return std::fabs(at.over_q(0).estimate()) > 0x1.8p127;
                   });
               },
               0.3},
    HardFamily{"fragments at the ends of int", detail::far_fragments,
               [](const Shot& shot, const ExactTriangle&) {
                   return std::abs(static_cast<std::int64_t>(shot.rect.x)) > 2147483000;
               },
               1.0},
    HardFamily{"q/w constant", detail::constant_q,
               [](const Shot&, const ExactTriangle& exact) { return exact.has_constant_q(); }, 0.3},
    HardFamily{"q almost 0 at a vertex", detail::grazing,
               [](const Shot& shot, const ExactTriangle&) {
                   return detail::spread(shot.triangle, [](const texgen::WindowVertex& v) { return v.strq.w; }) > 1e4;
               },
               0.4},
};

}  // namespace support
