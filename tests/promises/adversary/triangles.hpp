#pragma once

// The promises of triangles and footprints.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "promises/adversary/inputs.hpp"
#include "promises/adversary/shares.hpp"
#include "support/hard_triangles.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/triangles.hpp"
#include "texgen/batch.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/texcoord.hpp"

namespace adversary {

using support::Outputs;

// Seven numbers a vertex: the window, w, and s, t, r, q.
inline texgen::Triangle triangle_of(const Numbers& n) {
    const auto vertex = [&](std::size_t i) {
        return texgen::WindowVertex{
            {static_cast<float>(n[i]), static_cast<float>(n[i + 1])}, static_cast<float>(n[i + 2]), floats4(n, i + 3)};
    };
    return {vertex(0), vertex(7), vertex(14)};
}
inline Numbers numbers_of(const texgen::Triangle& triangle) {
    Numbers n;
    for (const texgen::WindowVertex* v : support::vertices(triangle))
        for (const float x : {v->window.x, v->window.y, v->clip_w, v->strq.x, v->strq.y, v->strq.z, v->strq.w})
            n.push_back(static_cast<double>(x));
    return n;
}

// A triangle of a hard family, moved so that its rectangle begins at a small pixel.
inline Numbers begin_triangle(Random& random) {
    const auto family = support::families[static_cast<std::size_t>(random.integer(0, 7))];
    Numbers n = numbers_of(support::make_triangle(family, random));
    for (std::size_t i = 0; i < 21; i += 7)
        for (std::size_t k = 0; k < 2; ++k)
            n[i + k] = static_cast<double>(support::to_float(0.25 * std::clamp(n[i + k], -400.0, 1e3)));
    return n;
}

inline constexpr texgen::FragmentRect wide{0, 0, 64, 4};
inline constexpr std::array<std::size_t, 7> looked_at{0, 21, 31, 32, 63, 130, 255};

inline Share triangle_exact_share(const Numbers& n) {
    const texgen::Triangle triangle = triangle_of(n);
    const auto setup = texgen::TriangleSetup::of(triangle, support::everywhere());
    if (!setup) return says_nothing;
    constexpr texgen::FragmentRect rect{20, 20, 2, 1};
    Outputs out(2, 3u);
    const texgen::Work work = interpolate(*setup, rect, out.spans());
    const support::ExactTriangle exact(triangle);
    if (!exact.has_positive_w(20, 20)) return says_nothing;
    const Homogeneous at = exact.at(20, 20);
    if (work == texgen::Work::nothing) return at.q.sign() > 0 ? broken : says_nothing;
    if (at.q.sign() <= 0) return out.s()[0] == 0.0f ? says_nothing : broken;
    return std::max(share_of_rounding(out.s()[0], at.over_q(0)), share_of_rounding(out.t()[0], at.over_q(1)));
}

template <bool OfBound>
Share triangle_within_share(const Numbers& n) {
    const double tolerance = tolerance_of(n[21]);
    if (!(tolerance > 1e-12 && tolerance < 1e6)) return says_nothing;
    const texgen::Triangle triangle = triangle_of(n);
    const auto setup = texgen::TriangleSetup::of(triangle, support::everywhere(), {tolerance});
    if (!setup) return says_nothing;
    Outputs out(256, 3u);
    const glm::dvec2 bound = setup->error_bound(wide);
    if (interpolate(*setup, wide, out.spans()) == texgen::Work::nothing) return says_nothing;
    const support::ExactTriangle exact(triangle);
    Share worst = says_nothing;
    for (const std::size_t i : looked_at) {
        const auto x = static_cast<std::int64_t>(i % 64), y = static_cast<std::int64_t>(i / 64);
        if (!exact.has_positive_w(x, y)) continue;
        const Homogeneous at = exact.at(x, y);
        if (at.q.sign() <= 0) continue;
        for (std::size_t k = 0; k < 2; ++k) {
            const double of_bound = bound[static_cast<int>(k)];
            if (!OfBound)
                worst = std::max(worst, share_of_tolerance(out[k][i], at.over_q(k), tolerance));
            else if (of_bound > 0.0 && std::isfinite(of_bound))
                worst = std::max(worst, is_within(out[k][i], at.over_q(k), of_bound)
                                            ? distance(static_cast<double>(out[k][i]), at.over_q(k)) / of_bound
                                            : broken);
        }
    }
    return worst;
}

// Derivatives within their bound, whose numerators are the differences of neighbours; and each level of a fragment in
// front inside the extremes of the rectangle: the share that rounding takes of the room that they leave for it.
enum class OfFootprints { bound, extremes, batch };
template <OfFootprints Of>
Share footprint_share(const Numbers& n) {
    constexpr bool OfExtremes = Of == OfFootprints::extremes;
    const texgen::Triangle triangle = triangle_of(n);
    const auto prepared = texgen::TriangleSetup::of(triangle, support::everywhere());
    if (!prepared || !is_in_range(n, 0x1p-30, 0x1p30)) return says_nothing;
    const texgen::FootprintSetup setup(*prepared, {256.0, 1000.0});
    Outputs out(256), levels(256, 1u);
    const texgen::Texcoords spans = out.spans();
    const texgen::Footprints footprints{.dsdx = spans.s,
                                        .dtdx = spans.t,
                                        .dsdy = spans.r,
                                        .dtdy = spans.lit,
                                        .level = levels.spans().s,
                                        .anisotropy = {},
                                        .major_s = {},
                                        .major_t = {}};
    if (Of == OfFootprints::batch) {
        texgen::TriangleBatch batch(support::everywhere());
        const texgen::Triangle both[] = {triangle, {triangle.b, triangle.c, triangle.a}};
        batch.assign(both);
        std::vector<std::uint32_t> ids(256);
        for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = i / 3 % 2;
        footprint(batch, ids, wide, {256.0, 1000.0}, footprints);
    } else if (!footprint(setup, wide, footprints)) {
        return says_nothing;
    }
    const glm::dvec2 of_rect = setup.error_bound(wide);
    const auto extremes = setup.extremes(wide);
    const support::ExactTriangle exact(triangle);
    Share worst = says_nothing;
    for (const std::size_t i : looked_at) {
        const auto x = static_cast<int>(i % 64), y = static_cast<int>(i / 64);
        const Homogeneous at = exact.at(x, y);
        if (!exact.has_positive_w(x, y) || at.q.sign() <= 0) continue;
        if (OfExtremes) {
            const auto one = setup.at(x, y);
            if (!one || !extremes) return broken;
            const auto level = static_cast<double>(levels.s()[i]);
            if (!std::isfinite(level)) continue;
            const double room = std::min(level - extremes->least_level, extremes->largest_level - level);
            if (!(room >= 0.0) || !(one->anisotropy <= extremes->largest_anisotropy)) return broken;
            worst = std::max(worst, share_of_error(1.0 - 0x1p15 * room / std::max(1.0, std::fabs(level) / 32.0)));
            continue;
        }
        const Homogeneous next[] = {exact.at(x + 1, y), exact.at(x, y + 1)};
        glm::dvec2 bound = of_rect;
        if (Of == OfFootprints::batch) {
            const auto turned = texgen::TriangleSetup::of({triangle.b, triangle.c, triangle.a}, support::everywhere());
            if (!turned) return broken;
            const texgen::FootprintSetup setup_of_id(i / 3 % 2 == 0 ? *prepared : *turned, {256.0, 1000.0});
            const auto one = setup_of_id.at(x, y);
            if (!one) return broken;
            const auto length = [&](int k) { return std::hypot(one->dx[k], one->dy[k]); };
            bound = setup_of_id.error_bound({x, y, 1, 1}) +
                    texgen::batch_footprint_error * glm::dvec2(length(0), length(1));
        }
        for (std::size_t k = 0; k < 4; ++k) {
            const Dyadic here = at.over_q(k % 2).n;
            const Homogeneous& neighbour = next[k / 2];
            const Dyadic slope = (neighbour.over_q(k % 2).n - here) * at.q - here * (neighbour.q - at.q);
            worst = std::max(worst, share_of_bound(static_cast<double>(out[k][i]), {slope, at.q * at.q},
                                                   bound[static_cast<int>(k % 2)]));
        }
    }
    return worst;
}

// Nothing is done only where nothing is lit; no test is left out where something is dark.
inline Share work_share(const Numbers& n) {
    const texgen::Triangle triangle = triangle_of(n);
    const texgen::TextureRegion region = texgen::whole_texture();
    const auto setup = texgen::TriangleSetup::of(triangle, region);
    if (!setup) return says_nothing;
    constexpr texgen::FragmentRect rect{20, 20, 3, 2};
    const texgen::Work work = setup->work(rect);
    if (work != texgen::Work::nothing && work != texgen::Work::divide) return says_nothing;
    const support::ExactTriangle exact(triangle);
    double nearest = HUGE_VAL;
    for (std::int64_t i = 0; i < 6; ++i) {
        const std::int64_t x = 20 + i % 3, y = 20 + i / 3;
        if (!exact.has_positive_w(x, y)) return says_nothing;
        const Homogeneous at = exact.at(x, y);
        const bool lit = support::contains(region, at);
        if (lit != (work == texgen::Work::divide)) return broken;
        if (at.q.sign() > 0) nearest = std::min(nearest, distance_to_region(at));
    }
    return std::isfinite(nearest) ? share_of_decision(nearest) : says_nothing;
}

}  // namespace adversary
