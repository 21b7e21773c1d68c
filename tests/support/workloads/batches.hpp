#pragma once

// Workloads of batches of triangles, and of fragments by the ids of their triangles.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "support/random.hpp"
#include "support/stopwatch.hpp"
#include "support/workloads/outputs.hpp"
#include "support/workloads/triangles.hpp"
#include "texgen/batch.hpp"
#include "texgen/texcoord.hpp"

namespace support::detail {

// What is asked of a batch: s and t, r as well, or the mask alone, of a depth too.
enum class OutputsOf { s_t, s_t_r, mask, mask_of_depth };
template <OutputsOf Of>
texgen::TextureRegion region_for() {
    return Of == OutputsOf::mask_of_depth ? wide_open_from_half() : wide_open();
}
template <OutputsOf Of>
texgen::Texcoords outputs_for(std::vector<float> (&out)[8]) {
    if constexpr (Of == OutputsOf::s_t) return {.s = out[0], .t = out[1], .r = {}, .lit = {}};
    if constexpr (Of == OutputsOf::s_t_r) return {.s = out[0], .t = out[1], .r = out[2], .lit = {}};
    return {.s = {}, .t = {}, .r = {}, .lit = out[0]};
}
// A batch of `Count` of them, made ready and divided; or with others among them, of which one is dark and one is
// refused.
template <int Width, int Height, std::size_t Count, bool IsExact, OutputsOf Of = OutputsOf::s_t, bool HasOthers = false>
Calls batch_calls(const Numbers& n) {
    const auto call = tile_call<Width, Height, IsExact>(n, region_for<Of>());
    if (!call) return {};
    struct Batch {
        texgen::TriangleBatch batch{region_for<Of>(), IsExact ? texgen::exact : tolerance};
        std::vector<texgen::Triangle> triangles;
        std::vector<texgen::FragmentRect> rects;
        std::vector<float> out[8];
    };
    auto all = std::make_shared<Batch>();
    all->triangles.assign(Count, triangle_of(n));
    if constexpr (HasOthers) {
        Random random(1);
        all->triangles[1] = all->triangles[3] = all->triangles[4] = triangle_of(ordinary_triangle(random));
        for (texgen::WindowVertex* v : {&all->triangles[1].a, &all->triangles[1].b, &all->triangles[1].c})
            v->strq.w *= -1.0f;
        all->triangles[3].a.clip_w = 0.0f;
    }
    all->rects.assign(Count, call->rect);
    for (std::vector<float>& out : all->out) out.resize(Count * Width * Height);
    return calls_of([all] {
        all->batch.assign(all->triangles);
        interpolate(all->batch, all->rects, outputs_for<Of>(all->out));
        keep(all->out[0].data());
    });
}
// Eight of them made ready, those that face away dark.
inline Calls batch_facing_calls(const Numbers& n) {
    const texgen::Triangle triangle = triangle_of(n);
    if (!is_of_a_scene(triangle)) return {};
    auto batch = std::make_shared<texgen::TriangleBatch>(wide_open());
    return calls_of([batch, triangles = std::vector<texgen::Triangle>(8, triangle)] {
        batch->assign_facing(triangles, texgen::TextureOrigin::bottom_left);
        keep(texgen::detail::Inside::planes(*batch));
    });
}
// The fragments of one of `Count` triangles that are the same, in runs of `Run`.
template <std::size_t Run, std::size_t Count = 8, class Ask>
Calls ids_calls(const Numbers& n, bool is_exact, texgen::TextureRegion region, Ask ask) {
    const auto call = tile_call<64, 4, true>(n, region);
    if (!call) return {};
    auto batch = std::make_shared<texgen::TriangleBatch>(region, is_exact ? texgen::exact : tolerance);
    batch->assign(std::vector<texgen::Triangle>(Count, triangle_of(n)));
    std::vector<std::uint32_t> ids(256);
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<std::uint32_t>(i / Run % Count);
    return calls_of([call, batch, ids, ask] {
        ask(*batch, ids, *call);
        keep(call->out[0].data());
    });
}
template <std::size_t Run, bool IsExact, OutputsOf Of = OutputsOf::s_t, std::size_t Count = 8>
Calls visibility_calls(const Numbers& n) {
    return ids_calls<Run, Count>(n, IsExact, region_for<Of>(), [](const auto& batch, const auto& ids, TileCall& call) {
        interpolate(batch, ids, call.rect, outputs_for<Of>(call.out));
    });
}

}  // namespace support::detail
