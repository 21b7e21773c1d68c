#pragma once

// Workloads of footprints.

#include <cstddef>

#include <glm/vec2.hpp>

#include "support/stopwatch.hpp"
#include "support/workloads/batches.hpp"
#include "support/workloads/outputs.hpp"
#include "support/workloads/triangles.hpp"
#include "texgen/footprint.hpp"

namespace support::detail {

template <int Width, int Height, bool IsExact, class Ask>
Calls footprint_calls_of(const Numbers& n, Ask ask) {
    const auto call = tile_call<Width, Height, IsExact>(n, wide_open());
    if (!call) return {};
    const texgen::FootprintSetup setup(call->setup, {1024.0, 768.0});
    return calls_of([call, setup, ask] { ask(setup, *call); });
}
template <int Width, int Height, bool IsExact>
Calls footprint_calls(const Numbers& n) {
    return footprint_calls_of<Width, Height, IsExact>(n, [](const texgen::FootprintSetup& setup, TileCall& call) {
        auto& out = call.out;
        keep(texgen::footprint(setup, call.rect, {out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7]}));
    });
}
inline Calls footprint_setup_calls(const Numbers& n) {
    return footprint_calls_of<1, 1, true>(n, [](const texgen::FootprintSetup&, TileCall& call) {
        keep(texgen::FootprintSetup(call.setup, {1024.0, 768.0}));
    });
}
inline Calls footprint_at_calls(const Numbers& n) {
    return footprint_calls_of<1, 1, true>(
        n, [](const texgen::FootprintSetup& setup, TileCall& call) { keep(setup.at(call.rect.x, call.rect.y)); });
}
inline Calls footprint_bound_calls(const Numbers& n) {
    return footprint_calls_of<64, 4, true>(
        n, [](const texgen::FootprintSetup& setup, TileCall& call) { keep(setup.error_bound(call.rect)); });
}
inline Calls extremes_calls(const Numbers& n) {
    return footprint_calls_of<64, 4, true>(
        n, [](const texgen::FootprintSetup& setup, TileCall& call) { keep(setup.extremes(call.rect)); });
}
inline Calls all_extremes_calls(const Numbers& n) {
    return footprint_calls_of<64, 4, true>(
        n, [](const texgen::FootprintSetup& setup, TileCall&) { keep(setup.extremes()); });
}
inline Calls headlights_calls(const Numbers& n) {
    return calls_of([triangle = triangle_of(n)] { keep(texgen::headlights(triangle)); });
}
inline Numbers ordinary_derivatives(Random& random) {
    return numbers(1e-3 * random.direction(), 1e-3 * random.uniform(0.5, 2.0), 1024.0, 768.0);
}
inline constexpr Inputs derivative_inputs{0, ordinary_derivatives, any_numbers<6>, strq_inputs.words};
inline Calls footprint_of_calls(const Numbers& n) {
    return calls_of([dx = glm::dvec2(n[0], n[1]), dy = glm::dvec2(n[2], n[3]),
                     texels = texgen::TexelsPerUnit{n[4], n[5]}] { keep(texgen::footprint_of(dx, dy, texels)); });
}

template <std::size_t Run, std::size_t Count = 8>
Calls footprint_ids_calls(const Numbers& n) {
    return ids_calls<Run, Count>(n, true, wide_open(), [](const auto& batch, const auto& ids, TileCall& call) {
        auto& out = call.out;
        footprint(batch, ids, call.rect, {1024.0, 768.0},
                  {out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7]});
    });
}

}  // namespace support::detail
