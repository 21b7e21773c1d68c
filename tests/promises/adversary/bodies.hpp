#pragma once

// The promises of boxes and clips.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "judges/exact.hpp"
#include "promises/adversary/inputs.hpp"
#include "promises/adversary/points.hpp"
#include "promises/adversary/shares.hpp"
#include "texgen/clip.hpp"
#include "texgen/coverage.hpp"

namespace adversary {

// Boxes: outside means that no vertex is lit (they are points of it), inside that all are.
inline Share coverage_share(const Numbers& n) {
    const glm::dmat4 matrix = batch_of(n, 0).matrix;
    const glm::vec3 a(floats4(n, 12)), b(floats4(n, 15));
    const texgen::Box box{glm::min(a, b), glm::max(a, b)};
    const texgen::TextureRegion region = texgen::whole_texture();
    const texgen::Coverage coverage = texgen::coverage(texgen::ObjectTexgen(matrix), region, box);
    if (coverage == texgen::Coverage::partial) return says_nothing;
    double nearest = HUGE_VAL;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 point{((corner & 1) != 0 ? box.max : box.min).x, ((corner & 2) != 0 ? box.max : box.min).y,
                              ((corner & 4) != 0 ? box.max : box.min).z};
        const Homogeneous at = support::exactly_at(matrix, point);
        const bool lit = at.q.sign() > 0 && at.s.sign() >= 0 && at.t.sign() >= 0 && at.s <= at.q && at.t <= at.q;
        if (lit != (coverage == texgen::Coverage::inside)) return broken;
        if (at.q.sign() > 0) nearest = std::min(nearest, distance_to_region(at));
    }
    return std::isfinite(nearest) ? share_of_decision(nearest) : says_nothing;
}

inline std::vector<texgen::ClipVertex> polygon_of(const Numbers& n) {
    return {{floats4(n, 0), floats4(n, 4)}, {floats4(n, 8), floats4(n, 12)}, {floats4(n, 16), floats4(n, 20)}};
}

// What comes out of the clip to the slide is inside the region but for slide_clip_error.
inline Share clip_to_slide_share(const Numbers& n) {
    if (!is_in_range(n, 0x1p-60, 0x1p60)) return says_nothing;
    std::array<texgen::ClipVertex, 8> out{};
    // Sides that are no floats: on those of the whole texture s, t and q are rounded alike.
    const texgen::TextureRegion region = texgen::atlas_tile({0.1, 0.3}, {0.7, 0.9});
    const std::size_t count = clip_to_slide(polygon_of(n), region, out);
    Share worst = says_nothing;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec4& strq = out[i].strq;
        if (!(strq.w > 0.0f)) return broken;
        for (int k = 0; k < 2; ++k) {
            const auto u = static_cast<double>(strq[k]), q = static_cast<double>(strq.w);
            const double min = region.min()[k], max = region.max()[k];
            worst = std::max(worst,
                             share_of_error(std::max(min * q - u, u - max * q) / (texgen::slide_clip_error * max * q)));
        }
    }
    return worst;
}

// What comes out of the clip to the near plane is in front of it and of the eye, each component of a new vertex within
// 1/2 ulp + clip_error of the intersection; here the component x of the vertex on the first edge.
inline Share clip_to_near_share(const Numbers& n) {
    if (!is_in_range(n, 0x1p-60, 0x1p60)) return says_nothing;
    const std::vector<texgen::ClipVertex> polygon = polygon_of(n);
    std::array<texgen::ClipVertex, 5> out{};
    const std::size_t count = clip_to_near(polygon, out, texgen::DepthRange::negative_one_to_one);
    Share worst = says_nothing;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec4& p = out[i].position;
        if (!(p.w > 0.0f) || !(static_cast<double>(p.z) + static_cast<double>(p.w) >= 0.0)) return broken;
    }
    for (std::size_t e = 0; e < 3 && count != 0; ++e) {
        const glm::vec4 &a = polygon[e].position, &b = polygon[(e + 1) % 3].position;
        const Dyadic da = Dyadic(a.z) + Dyadic(a.w), db = Dyadic(b.z) + Dyadic(b.w);
        // Where the near plane leaves no room for w <= 0 the edge is cut once.
        if (!(da.sign() * db.sign() < 0) || !(a.w > 0.0f && b.w > 0.0f)) continue;
        const Dyadic weight_a = magnitude(db), weight_b = magnitude(da);
        const Quotient x{weight_a * Dyadic(a.x) + weight_b * Dyadic(b.x), weight_a + weight_b};
        const Quotient terms{weight_a * magnitude(Dyadic(a.x)) + weight_b * magnitude(Dyadic(b.x)),
                             weight_a + weight_b};
        Share nearest = broken;
        for (std::size_t i = 0; i < count; ++i) {
            const float value = out[i].position.x;
            const double half = std::fabs(support::detail::middle(value, compare(x, static_cast<double>(value)) > 0) -
                                          static_cast<double>(value));
            const double bound = half + texgen::clip_error * terms.estimate();
            if (bound > 0.0) nearest = std::min(nearest, distance(static_cast<double>(value), x) / bound);
        }
        // Another plane of the eye may cut the vertex off again.
        if (count == 3 || count == 4) worst = std::max(worst, nearest);
    }
    return worst;
}

}  // namespace adversary
