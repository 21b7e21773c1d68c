#pragma once

// Triangles with their rectangles, drawn among all that a batch may be given, and what a set-up of each writes.

#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "judges/fragments.hpp"
#include "support/hard_triangles.hpp"
#include "support/near_cut.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/triangles.hpp"
#include "texgen/interpolate.hpp"

namespace batch_cases {

using support::count_of;
using support::Outputs;
using support::Random;
using support::Shot;
using texgen::FragmentRect;
using texgen::Tolerance;
using texgen::Triangle;
using texgen::TriangleSetup;
using texgen::Work;

// Not to be accepted: a number that is none, a w that is not positive, no area.
inline Triangle refused(Random& random) {
    Triangle triangle = support::make_triangle(support::Family::friendly, random);
    texgen::WindowVertex& vertex = random.coin() ? triangle.b : triangle.c;
    switch (random.integer(0, 4)) {
        case 0:
            vertex.strq[random.integer(0, 3)] = std::numeric_limits<float>::quiet_NaN();
            break;
        case 1:
            vertex.window.x = std::numeric_limits<float>::infinity();
            break;
        case 2:
            vertex.clip_w = random.coin() ? 0.0f : -1.0f;
            break;
        case 3:
            vertex.clip_w = std::numeric_limits<float>::quiet_NaN();
            break;
        default:
            vertex.window = triangle.a.window;
            break;
    }
    return triangle;
}

// An area whose sign doubles leave open.
inline Shot almost_without_area(Random& random) {
    const float tiny = std::ldexp(random.coin() ? 1.0f : -1.0f, random.integer(-45, -38));
    Triangle triangle = support::make_triangle(support::Family::friendly, random);
    triangle.a.window = {tiny, 0.0f};
    triangle.b.window = {0x1p20f, 0x1p20f};
    triangle.c.window = {0x1p21f, 0x1p21f};
    return {triangle, {random.integer(0, 9), random.integer(0, 9), 4, 3}};
}

// q/w grows several times over a tile.
inline Shot steep(Random& random) {
    Triangle triangle = support::make_triangle(support::Family::friendly, random);
    const double size = random.uniform(16.0, 60.0);
    triangle.a.window = {0.0f, 0.0f};
    triangle.b.window = {support::to_float(size), 0.0f};
    triangle.c.window = {0.0f, support::to_float(size)};
    const double ratio = random.uniform(1.0, 12.0);
    for (glm::length_t k = 0; k < 4; ++k) triangle.b.strq[k] = support::to_float(triangle.b.strq[k] * ratio);
    return {triangle, {random.integer(0, 9), random.integer(0, 9), 8, 8}};
}

// Where pixels leave the ints u is half-way at every fragment, s = t = 2^-24 x - 127.5, but for a corner that is off
// its place.
inline Shot ties_at_the_last_int(Random& random) {
    const float off = std::ldexp(random.coin() ? 1.0f : -1.0f, random.integer(-80, -20));
    const auto corner = [](float x, float y, float u) {
        return texgen::WindowVertex{{x, y}, 1.0f, {u, u, 0.25f, 1.0f}};
    };
    return {{corner(off, 0.0f, -127.5f), corner(0x1p31f, 0.0f, 0.5f), corner(0.0f, 0x1p31f, -127.5f)},
            {0x7fffffff - random.integer(0, 7), random.integer(0, 9), random.integer(1, 16), random.integer(1, 4)}};
}

// u = 1/2 + 2^-24 (a x + b y) at w = q is half-way between two floats at every fragment of the tile, or next to it: a
// corner may be `off` the pixels' by less than a double sees in u.
inline Shot ties_everywhere(Random& random, float off = 1.0f) {
    const int dx = 2 * random.integer(0, 3) + 1, dy = 2 * random.integer(0, 3);
    const float w = std::ldexp(random.coin() ? 1.0f : 1.5f, random.integer(-3, 3));
    const float sign = random.coin() ? 1.0f : -1.0f;
    const int far = random.integer(20, 1000);
    const auto corner = [&](int x, int y) {
        const double s = 0.5 + std::ldexp(dx * x + dy * y, -24), t = 0.5 + std::ldexp(dy * x + dx * y, -24);
        return texgen::WindowVertex{
            glm::vec2(x, y), w, {sign * support::to_float(s), support::to_float(t), 0.25f, 1.0f}};
    };
    Triangle triangle{corner(0, 0), corner(far, 0), corner(0, far)};
    if (random.coin()) triangle.a.window.x = std::ldexp(random.coin() ? off : -off, random.integer(-60, -20));
    if (random.coin()) triangle.b.window.y = std::ldexp(random.coin() ? off : -off, random.integer(-60, -20));
    if (random.coin()) std::swap(triangle.b, triangle.c);
    return {triangle, {random.integer(0, 3), random.integer(0, 3), 8, 8}};
}

inline Shot draw(Random& random) {
    Shot shot{};
    const int kind = random.integer(0, 33);
    if (kind >= 32) {
        shot = support::detail::zeros_along_edges(random);
    } else if (kind < 18) {
        shot = support::hard_families[static_cast<std::size_t>(kind)].make(random);
    } else if (kind < 21) {
        const support::NearCut cut = support::near_cut(random, random.integer(1, 20), random.integer(1, 8));
        shot = {cut.triangle, cut.rect};
    } else if (kind < 23) {
        shot = {refused(random), {random.integer(-9, 9), random.integer(-9, 9), 3, 5}};
    } else if (kind == 23) {
        shot = almost_without_area(random);
    } else if (kind == 24) {
        return ties_at_the_last_int(random);
    } else if (kind >= 30) {
        shot = ties_everywhere(random);
    } else {
        shot = kind < 27 ? steep(random) : support::hard_families[0].make(random);
    }
    switch (random.integer(0, 11)) {
        case 0:
            shot.rect.width = shot.rect.height = 8;
            break;
        case 1:
            shot.rect.width = 64, shot.rect.height = 1;
            break;
        case 2:
            shot.rect.width = 1, shot.rect.height = random.integer(1, 40);
            break;
        case 3:
            shot.rect.width = random.coin() ? 0 : 3, shot.rect.height = 0;
            break;
        case 4:
            shot.rect.width = 16, shot.rect.height = random.integer(1, 8);
            break;
        default:
            break;
    }
    if (random.integer(0, 15) == 0) shot.rect.width = random.integer(1, 160), shot.rect.height = random.integer(1, 60);
    return shot;
}

inline texgen::TextureRegion draw_region(Random& random) {
    const texgen::TextureRegion region = [&] {
        switch (random.integer(0, 3)) {
            case 0:
                return support::everywhere();
            case 1:
                return texgen::atlas_tile({0.25, 0.125}, {0.5, 0.75});
            default:
                return texgen::whole_texture();
        }
    }();
    switch (random.integer(0, 5)) {
        case 0:
            return region.with_depth();
        case 1:
            return region.with_depth(random.uniform(-1.0, 1.0), random.uniform(0.0, 4.0));
        case 2: {
            constexpr double infinity = std::numeric_limits<double>::infinity();
            const double limit = random.uniform(-1.0, 2.0);
            return random.coin() ? region.with_depth(limit, infinity) : region.with_depth(-infinity, limit);
        }
        default:
            return region;
    }
}

// What a TriangleSetup writes for a rectangle, and whether it writes s, t and r; 0 where there is none.
struct Expected {
    Outputs out;
    Work work = Work::nothing;

    Expected(const Triangle& triangle, const texgen::TextureRegion& region, const FragmentRect& rect, unsigned asked,
             Tolerance tolerance)
        : out(count_of(rect), asked) {
        if (const auto setup = TriangleSetup::of(triangle, region, tolerance))
            work = interpolate(*setup, rect, out.spans());
    }
};

// Whether `count` values of a batch from `first` on are what a setup says with `exact` of those from `alone` on.
inline bool agree(const Expected& expected, std::size_t alone, const Outputs& out, std::size_t first,
                  std::size_t count) {
    bool all = true;
    for (std::size_t k = 0; k < 4; ++k) {
        if (!out.asked(k)) continue;
        for (std::size_t i = 0; i < count; ++i) {
            const float value = out[k][first + i];
            if (expected.work != Work::nothing)
                all = all && support::same_bits(value, expected.out[k][alone + i]);
            else
                all = all && (k == 3 ? support::same_bits(value, 0.0f) : !Outputs::is_poison(value));
        }
    }
    return all;
}

struct Drawn {
    std::vector<Triangle> triangles;
    std::vector<FragmentRect> rects;
    std::size_t fragments = 0;

    Drawn(Random& random, int count) : Drawn(count, [&] { return draw(random); }) {}
    Drawn(int count, const auto& make) {
        for (int i = 0; i < count; ++i) {
            const Shot shot = make();
            triangles.push_back(shot.triangle);
            rects.push_back(shot.rect);
            fragments += count_of(shot.rect);
        }
    }
};

}  // namespace batch_cases
