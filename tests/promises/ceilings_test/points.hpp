#pragma once

// The worst of points, of clips to the slide and of depths.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "promises/ceilings_test/errors.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "texgen/clip.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/texcoord.hpp"

namespace ceilings {

using support::everywhere;
using support::Random;

struct PointFamily {
    const char* name;
    double distance, noise;  // from the origin, and of the matrix's elements
    bool at_root = false;    // the middle of the points has q = 0
};
inline const std::array point_families{
    PointFamily{"about the origin", 0.0, 1.0}, PointFamily{"1e5 from the origin", 1e5, 1.0},
    PointFamily{"orthographic", 0.0, 0.0}, PointFamily{"about q = 0", 1.0, 1.0, true}};

struct WorstPoints : Worst {
    double generate = 0.0;  // in ulps of the sum of the terms' magnitudes
};

inline WorstPoints of_points(const PointFamily& family, std::uint64_t seed) {
    Random random(seed);
    WorstPoints worst;
    for (int i = 0; i < 200; ++i) {
        glm::dmat4 matrix(0.0);
        for (int j = 0; j < 3; ++j)
            matrix[j] = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                         family.noise * random.uniform(-0.3, 0.3)};
        const glm::dvec3 middle = family.distance * random.direction();
        matrix[3] = glm::dvec4(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.0, random.uniform(1.0, 2.0)) -
                    matrix[0] * middle.x - matrix[1] * middle.y - matrix[2] * middle.z;
        if (family.at_root) matrix[3].w = -(matrix[0].w * middle.x + matrix[1].w * middle.y + matrix[2].w * middle.z);
        std::vector<glm::vec3> points(64);
        for (glm::vec3& point : points) {
            const glm::dvec3 p = middle + (family.at_root ? random.power_of_ten(-7.0, 0.0) : 1.0) * random.direction();
            point = {support::to_float(p.x), support::to_float(p.y), support::to_float(p.z)};
        }
        const Tolerance tolerance = tolerance_of(random.power_of_ten(-1.0, 2.0));
        const texgen::ObjectTexgen texgen(matrix);
        Outputs exact(points.size(), 3u), within(points.size(), 3u);
        std::vector<glm::vec4> strq(points.size());
        project(texgen, texgen::object_space(points), everywhere(), exact.spans());
        project(texgen, texgen::object_space(points), everywhere(), within.spans(), tolerance);
        generate(texgen, texgen::object_space(points), strq);
        for (std::size_t k = 0; k < points.size(); ++k) {
            const Homogeneous at = support::exactly_at(matrix, points[k]);
            take(worst, at, exact, within, tolerance, k);
            worst.generate = std::max(worst.generate, error_in_ulps(strq[k].x, {at.s, support::Dyadic(1.0)}));
        }
    }
    return worst;
}

// How far vertices that clip_to_slide() makes are outside the region, as a share of slide_clip_error.
inline double of_clips(bool about_apex, bool has_depth, std::uint64_t seed) {
    Random random(seed);
    double worst = 0.0;
    for (int i = 0; i < 3000; ++i) {
        std::array<texgen::ClipVertex, 12> storage{};
        for (std::size_t v = 0; v < 3; ++v) {
            const double size = about_apex ? random.power_of_ten(-6.0, 0.0) : 1.0;
            storage[v].position = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
            const double s = size * random.uniform(-2.0, 3.0), t = size * random.uniform(-2.0, 3.0);
            const double q = size * random.uniform(-0.5, 1.0);
            storage[v].strq = glm::vec4(s, t, has_depth ? size * random.uniform(-2.0, 3.0) : 0.0, q);
        }
        const texgen::TextureRegion sides = texgen::atlas_tile({-0.1, 0.3}, {0.7, 1.1});
        const texgen::TextureRegion region = has_depth ? sides.with_depth(-0.2, 0.9) : sides;
        const std::size_t count = clip_to_slide(std::span(storage).first(3), region, storage);
        for (std::size_t v = 0; v < count; ++v) {
            for (int k = 0; k < (has_depth ? 3 : 2); ++k) {
                const double u = static_cast<double>(storage[v].strq[k]), q = static_cast<double>(storage[v].strq.w);
                const double min = k == 2 ? region.depth()->x : region.min()[k];
                const double max = k == 2 ? region.depth()->y : region.max()[k];
                worst = std::max(worst, std::max(min * q - u, u - max * q) /
                                            (texgen::slide_clip_error * std::max(std::fabs(min), std::fabs(max)) * q));
            }
        }
    }
    return worst;
}

// The r that a depth is asked of, and the planes of a region with a depth, in float ulps.
struct WorstDepths {
    double r = 0.0, planes = 0.0;
};
inline WorstDepths of_depths(double z_far, bool is_reversed, std::uint64_t seed) {
    Random random(seed);
    WorstDepths worst;
    for (int i = 0; i < 100; ++i) {
        const texgen::Aim aim{random.vector3(5.0), random.vector3(5.0), random.direction()};
        const texgen::PerspectiveLens lens{texgen::degrees(random.uniform(20.0, 120.0)), 1.5, 0.5, z_far, is_reversed};
        const auto projector = make_projector(lens, aim, random.coin() ? texgen::opengl : texgen::direct3d);
        if (!projector) continue;
        const double r_min = random.uniform(0.0, 0.9);
        const texgen::TextureRegion region = texgen::whole_texture().with_depth(r_min, random.uniform(r_min, 1.0));
        const auto texgen = texture_from_world(*projector, region);
        std::vector<glm::vec3> points(64);
        for (glm::vec3& point : points) point = random.vector3(random.power_of_ten(-1.0, 2.0));
        Outputs out(points.size(), 4u);
        project(texgen, texgen::world_space(points), region, out.spans());
        for (std::size_t k = 0; k < points.size(); ++k) {
            const Homogeneous at = support::exactly_at(texgen.matrix(), points[k]);
            if (at.q.sign() > 0) worst.r = std::max(worst.r, error_in_ulps(out[2][k], at.over_q(2)));
        }
        const texgen::ClipPlanes planes = clip_planes(texgen, region);
        for (std::size_t k = 5; k < planes.size(); ++k) {
            const double sign = k == 5 ? 1.0 : -1.0;
            for (int j = 0; j < 4; ++j) {
                const glm::dvec4& column = texgen.matrix()[j];
                const support::Dyadic exact =
                    support::Dyadic(sign) *
                    (support::Dyadic(column.z) -
                     support::Dyadic(k == 5 ? region.depth()->x : region.depth()->y) * support::Dyadic(column.w));
                worst.planes = std::max(worst.planes, error_in_ulps(planes[k][j], {exact, support::Dyadic(1.0)}));
            }
        }
    }
    return worst;
}

}  // namespace ceilings
