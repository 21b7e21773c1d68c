// Masks of regions with a depth, over those without: points, and the fragments of a triangle.

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include <texgen/interpolate.hpp>
#include <texgen/reference.hpp>
#include <texgen/texcoord.hpp>

#include "../peers.hpp"
#include "bench.hpp"
#include "points.hpp"

namespace bench {

namespace {

using texgen::TextureRegion;

// A depth, and what its rows are called.
struct Case {
    const char* name;
    TextureRegion region;
};

// `cut` is an r in the middle of what there is; `inside` holds all of it.
std::array<Case, 3> cases(double cut, glm::dvec2 inside) {
    const TextureRegion whole = texgen::whole_texture();
    return {{{"texgen, exact, without a depth", whole},
             {"texgen, exact, with a depth that holds all", whole.with_depth(inside.x, inside.y)},
             {"texgen, exact, with a depth that cuts", whole.with_depth(cut, 1.0)}}};
}

// Whether a mask is right; next to a side either answer is.
void check_lit(Errors& errors, float lit, const TextureRegion& region, const glm::dvec3& str) {
    const glm::dvec2 depth = region.depth().value_or(glm::dvec2(-HUGE_VAL, HUGE_VAL));
    const glm::dvec3 min((region.min)(), depth.x), max((region.max)(), depth.y);
    bool is_lit = true;
    for (glm::length_t k = 0; k < 3; ++k) {
        if (std::fabs(str[k] - min[k]) < 1e-6 || std::fabs(str[k] - max[k]) < 1e-6) return;
        is_lit = is_lit && str[k] > min[k] && str[k] < max[k];
    }
    errors.add(lit, is_lit ? 1.0 : 0.0);
}

bool is_between(float value, float min, float max) { return value >= min && value <= max; }

void add_points(std::size_t count) {
    const auto points = std::make_shared<Points>(count, Layout::planar);
    const Scene scene{"depth, " + std::to_string(count) + " points", matrix_count, count};
    const auto str = [=](std::size_t i, std::size_t k) {
        const Points::Exact exact = points->exact(i, k);
        return glm::dvec3(exact.quotient(0), exact.quotient(1), exact.quotient(2));
    };
    for (const Case& one : cases(str(0, 0).z, {0.0, 1.0})) {
        const auto run = [=](std::size_t i) {
            texgen::project(points->transform(i), points->positions(), one.region,
                            {.s = {}, .t = {}, .r = {}, .lit = {output(count), count}});
        };
        const auto check = [=](std::size_t i, Errors& errors) {
            for (std::size_t k = 0; k < count; k += scene.step())
                check_lit(errors, output(count)[k], one.region, str(i, k));
        };
        add_row(scene, one.name, 0.0, run, check);
    }
    const auto cut = static_cast<float>(str(0, 0).z);
    add_unchecked(scene, "GLM, mat4 * vec4 and six comparisons", [=](std::size_t i) {
        const glm::mat4 matrix = points->matrix(i);
        const float *x = points->axis(0), *y = points->axis(1), *z = points->axis(2);
        float* const lit = output(count);
        for (std::size_t k = 0; k < count; ++k) {
            const glm::vec4 strq = matrix * glm::vec4(x[k], y[k], z[k], 1.0f);
            const glm::vec3 at = glm::vec3(strq) / strq.w;
            lit[k] = strq.w > 0.0f && is_between(at.x, 0.0f, 1.0f) && is_between(at.y, 0.0f, 1.0f) &&
                             is_between(at.z, cut, 1.0f)
                         ? 1.0f
                         : 0.0f;
        }
    });
}

void add_fragments(int side) {
    const auto vertex = [&](float x, float y, float w, const glm::vec3& str) {
        return texgen::WindowVertex{glm::vec2(x, y) * static_cast<float>(side), w, glm::vec4(str * w, w)};
    };
    const texgen::Triangle triangle{vertex(-0.1f, -0.1f, 2.0f, {0.1f, 0.15f, 0.2f}),
                                    vertex(2.3f, -0.1f, 3.0f, {0.9f, 0.2f, 0.7f}),
                                    vertex(0.1f, 2.4f, 2.5f, {0.2f, 0.95f, 0.5f})};
    const auto count = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    const Scene scene{"depth, " + std::to_string(side) + "x" + std::to_string(side) + " fragments", 1, count};
    const texgen::FragmentRect rect{0, 0, side, side};
    const auto str = [=](std::size_t k) {
        const auto quotient = texgen::reference::quotient<long double>(texgen::reference::strq<long double>(
            triangle, static_cast<long double>(k % static_cast<std::size_t>(side)) + 0.5L,
            static_cast<long double>(k / static_cast<std::size_t>(side)) + 0.5L));
        return glm::dvec3(static_cast<double>(quotient[0]), static_cast<double>(quotient[1]),
                          static_cast<double>(quotient[2]));
    };
    for (const Case& one : cases(str(count / 2 + static_cast<std::size_t>(side) / 2).z, {0.0, 1.0})) {
        const std::optional<texgen::TriangleSetup> setup = texgen::TriangleSetup::of(triangle, one.region);
        if (!setup) fail("depth: a triangle was refused");
        const auto run = [=](std::size_t) {
            texgen::interpolate(*setup, rect, {.s = {}, .t = {}, .r = {}, .lit = {output(count), count}});
        };
        const auto check = [=](std::size_t, Errors& errors) {
            for (std::size_t k = 0; k < count; ++k) check_lit(errors, output(count)[k], one.region, str(k));
        };
        add_row(scene, one.name, 0.0, run, check);
    }
}

}  // namespace

void add_depth() {
    for (const std::size_t count : {l1_count, l2_count}) add_points(count);
    for (const int side : {8, 64, 256}) add_fragments(side);
}

}  // namespace bench
