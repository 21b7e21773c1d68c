#include "depth_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <texgen/interpolate.hpp>
#include <texgen/surface.hpp>

namespace report {

namespace {

// visit(fragment in the coordinates, x, y) for the covered fragments, once s, t, r and lit are there.
template <class Visit>
void for_each_covered(const Workload& work, const Workload::Job& job, const texgen::TextureRegion& region,
                      RectCoordinates& coordinates, const Visit& visit) {
    const auto setup = texgen::TriangleSetup::of(work.triangles[job.triangle].window, region);
    if (!setup) return;
    for (std::size_t i = job.first_rect; i < job.first_rect + job.rect_count; ++i) {
        const texgen::FragmentRect& rect = work.rects[i];
        if (texgen::interpolate(*setup, rect, coordinates.with_r(rect)) == texgen::Work::nothing) continue;
        for (int row = 0; row < rect.height; ++row) {
            const auto [begin, end] = work.coverage[i][static_cast<std::size_t>(row)];
            for (int column = begin; column < end; ++column)
                visit(static_cast<std::size_t>(row * rect.width + column), rect.x + column, rect.y + row);
        }
    }
}

}  // namespace

std::size_t DepthMap::texel_at(float s, float t) const {
    const auto at = [](float coordinate, int size) {
        return static_cast<std::size_t>(
            std::clamp(static_cast<int>(std::floor(coordinate * static_cast<float>(size))), 0, size - 1));
    };
    return at(t, height) * static_cast<std::size_t>(width) + at(s, width);
}

DepthMap make_depth_map(std::span<const Surface> surfaces, const Camera& projector, int width, int height) {
    const std::size_t texels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    DepthMap map{width, height, std::vector<float>(texels, std::numeric_limits<float>::infinity()),
                 std::vector<std::uint32_t>(texels, DepthMap::nothing)};
    const Workload work = rasterize(surfaces, projector, width, height);
    RectCoordinates coordinates;
    for (const Workload::Job& job : work.jobs) {
        // The centre of a texel at the rim may lie outside the slide by a rounding.
        const texgen::TextureRegion around = texgen::atlas_tile({-1, -1}, {2, 2});
        for_each_covered(work, job, around, coordinates, [&](std::size_t i, int x, int y) {
            const std::size_t texel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            if (!(coordinates.r[i] < map.r[texel])) return;
            map.r[texel] = coordinates.r[i];
            map.triangle[texel] = work.triangles[job.triangle].source;
        });
    }
    return map;
}

Picture picture_of(const DepthMap& map) {
    constexpr glm::vec3 light(1.0f, 0.95f, 0.62f), middle(0.20f, 0.66f, 0.58f), dark(0.13f, 0.11f, 0.38f),
        beyond(0.55f, 0.08f, 0.10f);
    const auto at = [&map](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x);
    };
    const auto colour_of = [&](float r) {
        return r > 1.0f   ? beyond
               : r > 0.5f ? glm::mix(middle, dark, 2.0f * r - 1.0f)
                          : glm::mix(light, middle, 2.0f * std::max(0.0f, r));
    };
    const auto differ = [&map](std::size_t a, std::size_t b) {
        return std::min(map.r[a], map.r[b]) <= 1.0f && std::floor(10.0f * map.r[a]) != std::floor(10.0f * map.r[b]);
    };
    Picture picture(map.width, map.height, backdrop);
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            if (map.triangle[at(x, y)] == DepthMap::nothing) continue;
            const bool is_line = (x > 0 && differ(at(x, y), at(x - 1, y))) || (y > 0 && differ(at(x, y), at(x, y - 1)));
            picture.at(x, map.height - 1 - y) = colour_of(map.r[at(x, y)]) * (is_line ? 0.5f : 1.0f);
        }
    }
    return picture;
}

std::string key_of(const DepthMap& map) {
    const bool has_nothing = std::ranges::count(map.triangle, DepthMap::nothing) != 0;
    const bool has_beyond = std::ranges::any_of(map.r, [](float r) { return r > 1.0f && r < HUGE_VALF; });
    return std::string("the darker the farther, with a line at each tenth of r between the near and the far plane") +
           (has_beyond ? "; red beyond" : "") + (has_nothing ? "; black where nothing is." : ".");
}

double climb(const texgen::Triangle& triangle, const DepthMap& map) {
    const auto plane = texgen::receiver_plane(triangle.a.strq, triangle.b.strq, triangle.c.strq);
    if (!plane) return std::numeric_limits<double>::infinity();
    // The rasteriser moves vertices by up to 1/512 texel each way; the last term is for the rounding of both r.
    constexpr double texel = 0.5 + 1.0 / 256;
    return texel * (std::fabs(plane->x) / map.width + std::fabs(plane->y) / map.height) + 0x1p-23;
}

ShadowTest::ShadowTest(const Shadow& shadow, const DrawnTriangle& triangle)
    : map_(*shadow.map),
      source_(triangle.source),
      bias_(shadow.constant_bias ? *shadow.constant_bias : climb(triangle.window, map_)) {
    const auto& [a, b, c] = triangle.window;
    const bool is_front =
        (b.window.x - a.window.x) * (c.window.y - a.window.y) > (b.window.y - a.window.y) * (c.window.x - a.window.x);
    faces_projector_ = texgen::facing(a.strq, b.strq, c.strq, texgen::TextureOrigin::bottom_left) ==
                       (is_front ? texgen::Facing::towards : texgen::Facing::away);
}

bool ShadowTest::is_shadowed_by_itself(float s, float t, float r) const {
    return faces_projector_ && !is_lit(s, t, r) && map_.triangle[map_.texel_at(s, t)] == source_;
}

ShadowCount count_shadows(const Shadow& shadow, const Workload& work, const texgen::TextureRegion& region) {
    ShadowCount count;
    RectCoordinates coordinates;
    for (const Workload::Job& job : work.jobs) {
        const ShadowTest test(shadow, work.triangles[job.triangle]);
        const ShadowTest by_plane({shadow.map, std::nullopt}, work.triangles[job.triangle]);
        for_each_covered(work, job, region, coordinates, [&](std::size_t i, int, int) {
            const float s = coordinates.s[i], t = coordinates.t[i], r = coordinates.r[i];
            if (coordinates.lit[i] == 0.0f) return;
            count.lit += by_plane.is_lit(s, t, r);
            count.lost += by_plane.is_lit(s, t, r) && !test.is_lit(s, t, r);
            count.by_themselves += test.is_shadowed_by_itself(s, t, r);
        });
    }
    return count;
}

}  // namespace report
