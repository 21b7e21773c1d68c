#pragma once

// Workloads of triangles and their tiles of fragments.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "support/limits.hpp"
#include "support/near_cut.hpp"
#include "support/random.hpp"
#include "support/stopwatch.hpp"
#include "support/triangles.hpp"
#include "support/workloads/numbers.hpp"
#include "support/workloads/outputs.hpp"
#include "texgen/interpolate.hpp"

namespace support::detail {

// Seven numbers a corner, and the first fragment of the rectangle.
inline Numbers ordinary_triangle(Random& random) {
    texgen::Triangle triangle{};
    const glm::vec2 window[] = {{-10.0f, -20.0f}, {1400.0f, 40.0f}, {60.0f, 1200.0f}};
    std::size_t i = 0;
    for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c}) {
        const Numbers strq = ordinary_strq(random);
        *vertex = {window[i++] + glm::vec2(random.uniform_float(-20.0, 20.0), random.uniform_float(-20.0, 20.0)),
                   random.uniform_float(1.0, 4.0), Reader(strq).vec4()};
    }
    return numbers(triangle, static_cast<float>(random.integer(150, 300)),
                   static_cast<float>(random.integer(150, 300)));
}

// u half-way between two floats at every fragment: s = 1/2 + 2^-24 x at w = q = 1, corners on the pixels' corners.
inline Numbers triangle_of_ties(Random& random) {
    texgen::Triangle triangle{};
    const int dx = random.integer(0, 3), dy = random.integer(0, 3);
    const float w = random.coin() ? 1.0f : std::ldexp(1.0f, random.integer(-3, 3));
    for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c}) {
        const int x = random.integer(0, 1023), y = random.integer(0, 1023);
        const double s = 0.5 + std::ldexp((2 * dx + 1) * x + 2 * dy * y, -24);
        const double t = 0.5 + std::ldexp(2 * dy * x + (2 * dx + 1) * y, -24);
        *vertex = {{static_cast<float>(x), static_cast<float>(y)}, w, {to_float(s), to_float(t), 0.25f, 1.0f}};
    }
    return numbers(triangle, static_cast<float>(random.integer(0, 900)), static_cast<float>(random.integer(0, 900)));
}

inline Numbers draw_triangle(Random& random) {
    switch (random.integer(0, 7)) {
        case 0:
        case 1: {
            const NearCut cut = near_cut(random);
            return numbers(cut.triangle, static_cast<float>(cut.rect.x), static_cast<float>(cut.rect.y));
        }
        case 2:
            return triangle_of_ties(random);
        case 3: {
            Numbers n = ordinary_triangle(random);
            n[21 + static_cast<std::size_t>(random.integer(0, 1))] =
                static_cast<double>(to_float(random.power_of_ten(4.0, 9.3)));
            return n;
        }
        case 4: {  // all units of any size
            Numbers n = ordinary_triangle(random);
            for (std::size_t k = 0; k < 7; ++k) {
                const double unit = random.coin() ? 1.0 : random.power_of_ten(-38.0, 30.0);
                for (std::size_t i = 0; i < 3; ++i) n[7 * i + k] = static_cast<double>(to_float(n[7 * i + k] * unit));
            }
            return n;
        }
        case 5: {  // all corners far out
            Numbers n = ordinary_triangle(random);
            const double unit = random.power_of_ten(2.0, 6.0);
            for (std::size_t k = 0; k < 2; ++k)
                for (std::size_t i = 0; i < 3; ++i)
                    n[7 * i + k] = static_cast<double>(to_float((n[7 * i + k] - 400.0) * unit));
            return n;
        }
        default: {
            const Family family =
                families[static_cast<std::size_t>(random.integer(0, static_cast<int>(families.size()) - 1))];
            const texgen::Triangle triangle = make_triangle(family, random);
            const texgen::FragmentRect pixel = pixel_near(triangle, random);
            return numbers(triangle, static_cast<float>(pixel.x), static_cast<float>(pixel.y));
        }
    }
}
inline constexpr Inputs triangle_inputs{
    23, ordinary_triangle, draw_triangle,
    "drawn: cut by the near plane, half-way between floats, far away, in mixed units, or of a hard family"};

inline texgen::Triangle triangle_of(const Numbers& n) {
    Reader reader(n);
    const auto vertex = [&] {
        const glm::vec2 window = reader.vec2();
        const float w = reader.single();
        return texgen::WindowVertex{window, w, reader.vec4()};
    };
    const texgen::WindowVertex a = vertex(), b = vertex(), c = vertex();
    return {a, b, c};
}
template <int Width, int Height>
texgen::FragmentRect rect_of(const Numbers& n) {
    const auto pixel = [](double x) { return static_cast<int>(std::clamp(x, -2147480000.0, 2147480000.0)); };
    return {pixel(n[21]), pixel(n[22]), Width, Height};
}

// A triangle of a window, with pixels as they may be outside of it.
inline bool is_of_a_scene(const texgen::Triangle& triangle) {
    bool all = true;
    for (const texgen::WindowVertex* v : {&triangle.a, &triangle.b, &triangle.c})
        all = all && is_of_a_scene(v->clip_w) && is_between(v->window, 0x1p-10, 0x1p30) && is_of_a_scene(v->strq);
    return all;
}

struct TileCall {
    texgen::TriangleSetup setup;
    texgen::FragmentRect rect;
    std::vector<float> out[8];
};
template <int Width, int Height, bool IsExact>
std::shared_ptr<TileCall> tile_call(const Numbers& n, texgen::TextureRegion region) {
    const texgen::Triangle triangle = triangle_of(n);
    const auto setup = texgen::TriangleSetup::of(triangle, region, IsExact ? texgen::exact : tolerance);
    if (!setup || !is_of_a_scene(triangle)) return nullptr;
    auto call = std::make_shared<TileCall>(TileCall{*setup, rect_of<Width, Height>(n), {}});
    for (std::vector<float>& out : call->out) out.resize(Width * Height);
    return call;
}
template <int Width, int Height, bool IsExact>
Calls triangle_calls(const Numbers& n) {
    const auto call = tile_call<Width, Height, IsExact>(n, texgen::whole_texture());
    if (!call) return {};
    return calls_of([call] {
        keep(texgen::interpolate(call->setup, call->rect,
                                 {.s = call->out[0], .t = call->out[1], .r = call->out[2], .lit = call->out[3]}));
    });
}
// One output alone: r, or the mask.
template <int Width, int Height, bool IsMask, bool HasDepth = false>
Calls one_output_calls(const Numbers& n) {
    const auto call = tile_call<Width, Height, true>(n, HasDepth ? wide_open_from_half() : wide_open());
    if (!call) return {};
    return calls_of([call] {
        const std::span<float> out(call->out[0]);
        keep(texgen::interpolate(
            call->setup, call->rect,
            {.s = {}, .t = {}, .r = IsMask ? std::span<float>() : out, .lit = IsMask ? out : std::span<float>()}));
    });
}
// With a region that leaves no tile dark; or with the texture's, in which small tiles have a certificate of their own.
template <int Width, int Height, bool IsExact, texgen::TextureRegion (*Region)() = wide_open>
Calls open_triangle_calls(const Numbers& n) {
    const auto call = tile_call<Width, Height, IsExact>(n, Region());
    if (!call) return {};
    return calls_of([call] {
        keep(texgen::interpolate(call->setup, call->rect, {.s = call->out[0], .t = call->out[1], .r = {}, .lit = {}}));
    });
}

inline Calls setup_calls(const Numbers& n) {
    return calls_of(
        [triangle = triangle_of(n)] { keep(texgen::TriangleSetup::of(triangle, texgen::whole_texture(), tolerance)); });
}
inline Calls triangle_work_calls(const Numbers& n) {
    const auto call = tile_call<64, 4, false>(n, texgen::whole_texture());
    if (!call) return {};
    return calls_of([call] { keep(call->setup.work(call->rect)); });
}
inline Calls volume_work_calls(const Numbers& n) {
    const auto call = tile_call<64, 4, false>(n, wide_open_from_half());
    if (!call) return {};
    return calls_of([call] { keep(call->setup.work(call->rect)); });
}
inline Calls triangle_bound_calls(const Numbers& n) {
    const auto call = tile_call<64, 4, false>(n, texgen::whole_texture());
    if (!call) return {};
    return calls_of([call] { keep(call->setup.error_bound(call->rect)); });
}

// What the numbers of a triangle are, for the limit: q = 0 crosses the tile, or the near plane has left a corner.
template <int Width, int Height>
double triangle_limit(const Numbers& n) {
    const texgen::Triangle t = triangle_of(n);
    const texgen::FragmentRect rect = rect_of<Width, Height>(n);
    const auto minor = [](const texgen::WindowVertex& a, const texgen::WindowVertex& b, double x, double y) {
        return (static_cast<double>(a.window.x) - x) * (static_cast<double>(b.window.y) - y) -
               (static_cast<double>(a.window.y) - y) * (static_cast<double>(b.window.x) - x);
    };
    const auto over_w = [](const texgen::WindowVertex& v) {
        return static_cast<double>(v.strq.w) / static_cast<double>(v.clip_w);
    };
    bool is_positive = false, is_negative = false;
    for (const double x : {rect.x - 0.5, rect.x + Width + 0.5}) {
        for (const double y : {rect.y - 0.5, rect.y + Height + 0.5}) {
            const double q = (minor(t.b, t.c, x, y) * over_w(t.a) + minor(t.c, t.a, x, y) * over_w(t.b) +
                              minor(t.a, t.b, x, y) * over_w(t.c)) *
                             twice_area(t);
            is_positive = is_positive || q >= 0.0;
            is_negative = is_negative || q <= 0.0;
        }
    }
    if (is_positive && is_negative) return limit::q_is_zero;
    const auto [least, largest] = std::minmax({t.a.clip_w, t.b.clip_w, t.c.clip_w});
    return largest > 100.0f * least ? limit::near_plane : limit::any;
}

}  // namespace support::detail
