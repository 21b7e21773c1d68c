#pragma once

// The worst of triangles, of their footprints and of segments.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "promises/ceilings_test/errors.hpp"
#include "support/hard_triangles.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/texcoord.hpp"

namespace ceilings {

using support::everywhere;
using support::Random;

inline Worst of_triangles(const support::HardFamily& family, std::uint64_t seed) {
    Random random(seed);
    Worst worst;
    for (int i = 0; i < 60; ++i) {
        const support::Shot shot = family.make(random);
        const Tolerance tolerance = tolerance_of(random.power_of_ten(-1.0, 2.0));
        Outputs exact(support::count_of(shot.rect), 3u), within(exact.size(), 3u);
        const auto setup = support::setup_of(shot.triangle);
        const auto loose = support::setup_of(shot.triangle, everywhere(), tolerance);
        if (interpolate(setup, shot.rect, exact.spans()) == texgen::Work::nothing) continue;
        if (interpolate(loose, shot.rect, within.spans()) == texgen::Work::nothing) continue;
        const glm::dvec2 bound = loose.error_bound(shot.rect);
        const support::ExactTriangle judge(shot.triangle);
        for (std::size_t f = 0; f < exact.size(); ++f) {
            const auto [x, y] = shot.fragment(f);
            if (!judge.has_positive_w(x, y)) continue;
            const Homogeneous at = judge.at(x, y);
            take(worst, at, exact, within, tolerance, f);
            for (std::size_t k = 0; k < 2 && at.q.sign() > 0; ++k)
                if (const double b = bound[static_cast<int>(k)]; b > 0.0 && std::isfinite(b))
                    worst.bound = std::max(worst.bound, distance(static_cast<double>(within[k][f]), at.over_q(k)) / b);
        }
    }
    return worst;
}

// The derivatives of the same triangles, whose numerators are the differences of neighbours.
inline double of_footprints(const support::HardFamily& family, std::uint64_t seed) {
    Random random(seed);
    double worst = 0.0;
    for (int i = 0; i < 30; ++i) {
        const support::Shot shot = family.make(random);
        const texgen::FootprintSetup setup(support::setup_of(shot.triangle), {256.0, 256.0});
        Outputs out(support::count_of(shot.rect));
        const texgen::Texcoords spans = out.spans();
        const bool written = footprint(setup, shot.rect,
                                       {.dsdx = spans.s,
                                        .dtdx = spans.t,
                                        .dsdy = spans.r,
                                        .dtdy = spans.lit,
                                        .level = {},
                                        .anisotropy = {},
                                        .major_s = {},
                                        .major_t = {}});
        const glm::dvec2 bound = setup.error_bound(shot.rect);
        const support::ExactTriangle judge(shot.triangle);
        for (std::size_t f = 0; f < out.size() && written; f += 7) {
            const auto [x, y] = shot.fragment(f);
            const Homogeneous at = judge.at(x, y);
            if (!judge.has_positive_w(x, y) || at.q.sign() <= 0) continue;
            for (std::size_t k = 0; k < 4; ++k) {
                const double b = bound[static_cast<int>(k % 2)];
                const auto value = static_cast<double>(out[k][f]);
                if (!std::isfinite(b) || !std::isfinite(value)) continue;
                const Homogeneous next = k < 2 ? judge.at(x + 1, y) : judge.at(x, y + 1);
                const support::Dyadic here = at.over_q(k % 2).n;
                const support::Dyadic slope = (next.over_q(k % 2).n - here) * at.q - here * (next.q - at.q);
                worst = std::max(worst, support::distance(value, {slope, at.q * at.q}) / b);
            }
        }
    }
    return worst;
}

struct SegmentFamily {
    const char* name;
    texgen::Segment (*make)(Random&);
    double (*alpha)(Random&);
};

inline glm::vec4 end(Random& random, double size, double q) {
    return {random.uniform_float(-size, size), random.uniform_float(-size, size), 0.0f, support::to_float(q)};
}
inline const std::array segment_families{
    SegmentFamily{"q of one sign",
                  [](Random& random) {
                      return texgen::Segment{end(random, 2.0, random.uniform(0.5, 4.0)),
                                             end(random, 2.0, random.uniform(0.5, 4.0))};
                  },
                  [](Random& random) { return random.uniform(0.0, 1.0); }},
    SegmentFamily{"to the near plane",
                  [](Random& random) {
                      const double size = random.power_of_ten(5.0, 12.0);
                      return texgen::Segment{end(random, size, size), end(random, 1.0, 1.0)};
                  },
                  [](Random& random) { return 1.0 - random.power_of_ten(-7.2, -5.0); }},
    SegmentFamily{"through q = 0",
                  [](Random& random) {
                      return texgen::Segment{end(random, 2.0, random.uniform(0.5, 4.0)),
                                             end(random, 2.0, random.uniform(-4.0, -0.5))};
                  },
                  [](Random& random) { return random.uniform(0.0, 1.0); }},
    // q_a = -q_b, up to a few units: the root of q is within some units of 1/2.
    SegmentFamily{
        "at the root of q",
        [](Random& random) {
            const double q = random.uniform(0.5, 4.0);
            return texgen::Segment{end(random, 2.0, q), end(random, 2.0, -q * (1.0 + random.integer(-4, 4) * 0x1p-23))};
        },
        [](Random& random) { return 0.5 + random.integer(-8, 8) * 0x1p-24; }},
};

inline Worst of_segments(const SegmentFamily& family, std::uint64_t seed) {
    Random random(seed);
    Worst worst;
    for (int i = 0; i < 300; ++i) {
        const texgen::Segment segment = family.make(random);
        const Tolerance tolerance = tolerance_of(random.power_of_ten(-1.0, 2.0));
        std::vector<float> alpha(64);
        for (float& a : alpha) a = std::min(support::to_float(family.alpha(random)), 1.0f);
        Outputs exact(alpha.size(), 3u), within(alpha.size(), 3u);
        interpolate(segment, alpha, everywhere(), exact.spans());
        interpolate(segment, alpha, everywhere(), within.spans(), tolerance);
        for (std::size_t k = 0; k < alpha.size(); ++k)
            take(worst, support::exactly_at(segment, alpha[k]), exact, within, tolerance, k);
    }
    return worst;
}

}  // namespace ceilings
