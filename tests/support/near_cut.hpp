#pragma once

// Triangles that the camera's near plane has just cut, with a rectangle of fragments inside: a corner of theirs lies
// ten thousands to millions of pixels away, with a clip w that is next to the near distance.

#include <algorithm>
#include <array>
#include <cstddef>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "support/random.hpp"
#include "support/triangles.hpp"
#include "texgen/clip.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace support {

struct NearCut {
    texgen::Triangle triangle;
    texgen::FragmentRect rect;
};

// The same triangle with its corners in another order.
inline texgen::Triangle rotated(const texgen::Triangle& t, int by) {
    return by % 3 == 0 ? t : by % 3 == 1 ? texgen::Triangle{t.b, t.c, t.a} : texgen::Triangle{t.c, t.a, t.b};
}

inline NearCut near_cut(Random& random, int width = 64, int height = 4) {
    constexpr texgen::Viewport viewport{0, 0, 1024, 768};
    for (;;) {
        const texgen::PerspectiveLens eye{texgen::degrees(60.0), 4.0 / 3.0, random.power_of_ten(-2.0, 0.0), 1000.0};
        const glm::dmat4 camera = texgen::perspective(eye, texgen::opengl).value().matrix();
        const texgen::PerspectiveLens lens{texgen::degrees(random.uniform(20.0, 90.0)), 1.0, 0.5, 500.0};
        const texgen::Aim aim{40.0 * random.direction(), glm::dvec3(0.0, 0.0, -20.0) + 10.0 * random.direction(),
                              glm::dvec3(0.1, 1.0, 0.2)};
        const glm::dmat4 texgen =
            texture_from_world(texgen::make_projector(lens, aim, texgen::opengl).value()).matrix();
        std::array<texgen::ClipVertex, 3> corners{};
        for (texgen::ClipVertex& corner : corners) {
            const glm::dvec4 point(random.uniform(-60.0, 60.0), random.uniform(-30.0, 30.0),
                                   random.uniform(-100.0, 60.0), 1.0);
            const auto as_floats = [](const glm::dvec4& v) {
                return glm::vec4(to_float(v.x), to_float(v.y), to_float(v.z), to_float(v.w));
            };
            corner = {as_floats(camera * point), as_floats(texgen * point)};
        }
        std::array<texgen::ClipVertex, 5> cut{};
        const std::size_t count = clip_to_near(corners, cut, texgen::DepthRange::negative_one_to_one);
        if (count < 3) continue;
        std::array<texgen::WindowVertex, 5> window{};
        for (std::size_t i = 0; i < count; ++i) window[i] = to_window(cut[i], viewport);
        const auto second = static_cast<std::size_t>(random.integer(1, static_cast<int>(count) - 2));
        const texgen::Triangle triangle =
            rotated({window[0], window[second], window[second + 1]}, random.integer(0, 2));
        const auto [least, largest] = std::minmax({triangle.a.clip_w, triangle.b.clip_w, triangle.c.clip_w});
        if (!(largest > 10.0f * least) || twice_area(triangle) == 0.0) continue;
        // A tile in the viewport whose middle is in the triangle.
        for (int attempt = 0; attempt < 50; ++attempt) {
            const texgen::FragmentRect rect{random.integer(0, viewport.width - width),
                                            random.integer(0, viewport.height - height), width, height};
            const glm::dvec2 p(rect.x + 0.5 * width, rect.y + 0.5 * height);
            const auto side = [&](const texgen::WindowVertex& a, const texgen::WindowVertex& b) {
                const glm::dvec2 from(a.window), to(b.window);
                return (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x) > 0.0;
            };
            const bool ab = side(triangle.a, triangle.b);
            if (ab == side(triangle.b, triangle.c) && ab == side(triangle.c, triangle.a)) return {triangle, rect};
        }
    }
}

}  // namespace support
