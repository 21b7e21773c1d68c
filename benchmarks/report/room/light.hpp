#pragma once

// What a frame of the room shows, and what its projectors give to it by each set of rules.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/vec4.hpp>
#include <texgen/interpolate.hpp>
#include <texgen/linear.hpp>
#include <texgen/scene.hpp>

#include "../rasterizer.hpp"
#include "objects.hpp"

namespace report::lit_room {

// What a frame shows: the workload of each object, and the triangle that is seen at each pixel.
struct Seen {
    struct Triangle {
        std::uint32_t object, triangle;
        friend bool operator==(const Triangle&, const Triangle&) = default;
    };
    static constexpr std::uint32_t nothing = 0xffffffff;

    std::vector<Workload> work;  // of each object
    std::vector<Triangle> nearest;
    int width;

    std::size_t pixel(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }

    // visit(index in the rect, x, y) for the fragments of a rect that its triangle covers, or where it is seen.
    template <class Visit>
    static void for_each_covered(const Workload& work, std::size_t r, const Visit& visit) {
        const texgen::FragmentRect& rect = work.rects[r];
        for (int row = 0; row < rect.height; ++row) {
            const auto [begin, end] = work.coverage[r][static_cast<std::size_t>(row)];
            for (int column = begin; column < end; ++column)
                visit(static_cast<std::size_t>(row * rect.width + column), rect.x + column, rect.y + row);
        }
    }
    template <class Visit>
    void for_each_seen(Triangle triangle, std::size_t r, const Visit& visit) const {
        for_each_covered(work[triangle.object], r, [&](std::size_t i, int x, int y) {
            if (nearest[pixel(x, y)] == triangle) visit(i, x, y);
        });
    }
};

inline Seen look(const Room& room, const Camera& camera, int width, int height) {
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    Seen seen{{}, std::vector<Seen::Triangle>(pixels, {Seen::nothing, 0}), width};
    std::vector<float> depth(pixels, std::numeric_limits<float>::infinity());
    for (std::uint32_t o = 0; o < room.objects.size(); ++o) {
        // In the place of texture coordinates the vertices carry their position, of which each projector makes its own.
        const Object& object = room.objects[o];
        Surface surface{object.mesh, room.models[o], {}, object.colour};
        for (const glm::vec3& position : object.mesh.positions) surface.strq.emplace_back(position, 1.0f);
        seen.work.push_back(rasterize(std::span(&surface, 1), camera, width, height));
        const Workload& work = seen.work.back();
        for (const Workload::Job& job : work.jobs) {
            const AttributePlane plane(work.triangles[job.triangle]);
            for (std::size_t r = job.first_rect; r < job.first_rect + job.rect_count; ++r) {
                Seen::for_each_covered(work, r, [&](std::size_t, int x, int y) {
                    const float at = plane.depth(x, y);
                    if (!(at < depth[seen.pixel(x, y)])) return;
                    depth[seen.pixel(x, y)] = at;
                    seen.nearest[seen.pixel(x, y)] = {o, static_cast<std::uint32_t>(job.triangle)};
                });
            }
        }
    }
    return seen;
}

struct Rules {
    const char* name;
    bool scene, triangles, rects;
    texgen::Tolerance tolerance = texgen::exact;
    texgen::TextureRegion region = slide_region;
};
inline constexpr std::array rules{Rules{"none", false, false, false},
                                  Rules{"rectangles", false, false, true},
                                  Rules{"triangles, rectangles", false, true, true},
                                  Rules{"pairs", true, false, false},
                                  Rules{"pairs, triangles", true, true, false},
                                  Rules{"pairs, triangles, rectangles", true, true, true},
                                  Rules{"pairs, rectangles", true, false, true}};

// Another picture: what is beyond the reach of a projector is dark.
inline constexpr Rules in_reach{"pairs, rectangles, depth", true, false, true, texgen::exact, volume_region};

struct Counts {
    std::size_t pairs = 0, triangles = 0, rects = 0, fragments = 0;
};

inline texgen::FragmentRect around(std::span<const texgen::FragmentRect> rects) {
    texgen::FragmentRect all = rects.front();
    for (const texgen::FragmentRect& rect : rects) {
        const int right = std::max(all.x + all.width, rect.x + rect.width);
        const int top = std::max(all.y + all.height, rect.y + rect.height);
        all.x = std::min(all.x, rect.x);
        all.y = std::min(all.y, rect.y);
        all.width = right - all.x;
        all.height = top - all.y;
    }
    return all;
}

// The coordinates that one projector gives an object. Without the rule of the rectangles each fragment is evaluated and
// compared. use(triangle, rect, work, coordinates) gets what may be lit.
template <class Use>
void light(const Rules& rule, const Workload& work, const texgen::ObjectTexgen& texgen, Counts& counts,
           const Use& use) {
    static RectCoordinates coordinates;
    const texgen::TextureRegion everywhere = texgen::atlas_tile({-HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL});
    ++counts.pairs;
    for (const Workload::Job& job : work.jobs) {
        texgen::Triangle triangle = work.triangles[job.triangle].window;
        for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c})
            vertex->strq = glm::vec4(texgen.matrix() * glm::dvec4(vertex->strq));
        const auto setup = texgen::TriangleSetup::of(triangle, rule.rects ? rule.region : everywhere, rule.tolerance);
        ++counts.triangles;
        if (!setup) continue;
        if (rule.triangles) {
            const auto tested = rule.rects ? setup : texgen::TriangleSetup::of(triangle, rule.region);
            if (tested->work(around(work.rects_of(job))) == texgen::Work::nothing) continue;
        }
        for (std::size_t r = job.first_rect; r < job.first_rect + job.rect_count; ++r) {
            const texgen::Texcoords out = coordinates.of(work.rects[r]);
            const texgen::Work done = texgen::interpolate(*setup, work.rects[r], out);
            ++counts.rects;
            if (done == texgen::Work::nothing) continue;
            counts.fragments += out.lit.size();
            if (!rule.rects) {
                // Without branches, so that the compiler can make vectors of the loop.
                for (std::size_t i = 0; i < out.lit.size(); ++i) {
                    const float in_s = out.s[i] >= 0.0f && out.s[i] <= 1.0f ? out.lit[i] : 0.0f;
                    out.lit[i] = out.t[i] >= 0.0f && out.t[i] <= 1.0f ? in_s : 0.0f;
                }
            }
            use(job.triangle, r, done, coordinates);
        }
    }
}

// All pairs of an object in view, or those of the scene; use() as above, with the pair before.
template <class Use>
Counts light_all(const Rules& rule, const Room& room, const Seen& seen, const texgen::Scene& scene, const Use& use) {
    Counts counts;
    const auto light_pair = [&](std::uint32_t o, std::uint32_t p, const texgen::ObjectTexgen& texgen) {
        light(rule, seen.work[o], texgen, counts,
              [&](std::size_t triangle, std::size_t rect, texgen::Work work, const RectCoordinates& coordinates) {
                  use(o, p, triangle, rect, work, coordinates);
              });
    };
    if (rule.scene) {
        for (const texgen::LitPair& pair : scene.pairs())
            if (!seen.work[pair.object].jobs.empty()) light_pair(pair.object, pair.projector, scene.texgen(pair));
        return counts;
    }
    for (std::uint32_t o = 0; o < room.objects.size(); ++o) {
        if (seen.work[o].jobs.empty()) continue;
        for (std::uint32_t p = 0; p < room.projectors.size(); ++p)
            light_pair(o, p, texgen::object_linear(room.projectors[p], room.models[o]));
    }
    return counts;
}

}  // namespace report::lit_room
