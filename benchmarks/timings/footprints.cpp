// Footprints beside the coordinates of the same fragments.

#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <texgen/footprint.hpp>
#include <texgen/interpolate.hpp>

#include "bench.hpp"
#include "derivatives.hpp"

namespace bench {

namespace {

using texgen::FragmentRect;
using texgen::Triangle;

Triangle large_triangle(double q_ratio) {
    const auto vertex = [](float x, float y, float w, double q_over_w, float s, float t) {
        const auto q = static_cast<float>(w * q_over_w);
        return texgen::WindowVertex{{x, y}, w, {s * q, t * q, 0.5f * q, q}};
    };
    return {vertex(20, 10, 1.5f, 2, 0.1f, 0.15f), vertex(1100, 12, 2.25f, 2 * q_ratio, 0.9f, 0.2f),
            vertex(22, 1000, 3.0f, 2 * std::sqrt(q_ratio), 0.2f, 0.9f)};
}

struct Fragments {
    Scene scene;
    Triangle triangle;
    std::vector<FragmentRect> rects;
};

std::span<float> array(std::size_t count, std::size_t k) { return {output(count, k), count}; }

void add_scene(const std::string& name, double q_ratio, int width, int height) {
    const auto fragments = std::make_shared<Fragments>();
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    for (int i = 0; i < 8; ++i) fragments->rects.push_back({40 + 3 * i, 30 + 9 * i, width, height});
    fragments->scene = {"Footprints, " + name, fragments->rects.size(), count};
    fragments->triangle = large_triangle(q_ratio);
    const Scene& scene = fragments->scene;
    for (const NamedTolerance& given : {tolerances[0], tolerances[1]}) {
        const auto setup = texgen::TriangleSetup::of(fragments->triangle, texgen::whole_texture(), given.tolerance);
        if (!setup) fail("footprints: the triangle was refused");
        const texgen::FootprintSetup footprints(*setup, {4096, 4096});
        const std::string after = ": " + std::string(given.name);
        add_unchecked(scene, "s and t" + after, [=](std::size_t i) {
            texgen::interpolate(*setup, fragments->rects[i],
                                {.s = array(count, 0), .t = array(count, 1), .r = {}, .lit = {}});
        });
        add_unchecked(scene, "s, t and lit" + after, [=](std::size_t i) {
            texgen::interpolate(*setup, fragments->rects[i],
                                {.s = array(count, 0), .t = array(count, 1), .r = {}, .lit = array(count, 2)});
        });
        const auto differentiate = [=](std::size_t i) {
            texgen::footprint(footprints, fragments->rects[i],
                              {.dsdx = array(count, 0),
                               .dtdx = array(count, 1),
                               .dsdy = array(count, 2),
                               .dtdy = array(count, 3),
                               .level = {},
                               .anisotropy = {},
                               .major_s = {},
                               .major_t = {}});
        };
        const auto check = [=](std::size_t i, Errors& errors) {
            const FragmentRect& rect = fragments->rects[i];
            for (std::size_t k = 0; k < count; k += 97) {
                const auto column = static_cast<int>(k) % rect.width, row = static_cast<int>(k) / rect.width;
                judge(Derivatives(fragments->triangle, rect.x + column, rect.y + row), count, k, errors);
            }
        };
        add_row(scene, "four derivatives" + after, given.tolerance.value, differentiate, check);
        const auto filters = [=](bool anisotropy, bool major) {
            return [=](std::size_t i) {
                texgen::footprint(footprints, fragments->rects[i],
                                  {.dsdx = {},
                                   .dtdx = {},
                                   .dsdy = {},
                                   .dtdy = {},
                                   .level = array(count, 0),
                                   .anisotropy = anisotropy ? array(count, 1) : std::span<float>(),
                                   .major_s = major ? array(count, 2) : std::span<float>(),
                                   .major_t = major ? array(count, 3) : std::span<float>()});
            };
        };
        add_unchecked(scene, "level of detail" + after, filters(false, false));
        add_unchecked(scene, "level, anisotropy" + after, filters(true, false));
        add_unchecked(scene, "level, anisotropy, major axis" + after, filters(true, true));
        add_unchecked(scene, "the extremes of the rectangle" + after, [=](std::size_t i) {
            auto extremes = footprints.extremes(fragments->rects[i]);
            benchmark::DoNotOptimize(&extremes);
        });
    }
}

}  // namespace

void add_footprints() {
    add_scene("1024x16, q/w by 1.3", 1.3, 1024, 16);
    add_scene("1024x16, q/w by 30", 30, 1024, 16);
    add_scene("64x8 of a large triangle", 1.3, 64, 8);
}

}  // namespace bench
