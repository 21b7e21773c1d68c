#pragma once

// What a shader draws beside what the library computes for the same fragments.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "api/shaders_test/readme.hpp"
#include "api/shaders_test/scenes.hpp"
#include "api/shaders_test/textures.hpp"
#include "support/opengl.hpp"
#include "support/opengl_fragments.hpp"
#include "support/random.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/reference.hpp"

namespace shaded {

// A fragment, and by how much OpenGL's coordinates may differ from it.
struct Fragment {
    int x, y;
    glm::dvec3 str;
    bool lit, behind;
    glm::dvec3 allowed;
};

// The texel that a coordinate falls into: -1 before the texture, `size` beyond it, and nothing where either of two may
// be right.
inline std::optional<int> texel(double u, double allowed) {
    const double low = std::floor((u - allowed) * size), high = std::floor((u + allowed) * size);
    if (low != high) return std::nullopt;
    return static_cast<int>(std::clamp(low, -1.0, static_cast<double>(size)));
}

struct Comparison {
    std::size_t compared = 0, lit = 0, behind = 0, mirrored = 0, wrong = 0;
};

// The color that a fragment must have, within `tolerance` of it; empty where either of two may be right.
struct Expected {
    glm::vec3 color;
    double tolerance;
};
using Expect = std::function<std::optional<Expected>(const Scene&, const Fragment&)>;

inline void compare(const std::vector<glm::vec4>& pixels, const Scene& scene, const Expect& expect,
                    Comparison& result) {
    const auto setup = texgen::TriangleSetup::of(scene.triangle, scene.region);
    REQUIRE(setup.has_value());
    std::vector<float> s(pixel_count), t(pixel_count), r(pixel_count), lit(pixel_count);
    REQUIRE(texgen::interpolate(*setup, {0, 0, width, height}, {s, t, r, lit}) != texgen::Work::nothing);
    for (std::size_t i = 0; i < pixel_count; ++i) {
        if (pixels[i].x == nothing) continue;
        const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
        const Eigen::Vector4d strq = texgen::reference::strq(scene.triangle, x + 0.5, y + 0.5);
        const glm::dvec4 terms = gl::largest_terms(scene.triangle, x + 0.5, y + 0.5);
        // The matrix is rounded there, and the vertices are computed in float.
        constexpr double tolerance = 4.0 * gl::fragment_tolerance;
        if (2.0 * tolerance * terms.w > std::fabs(strq[3])) continue;
        Fragment fragment{x, y, {s[i], t[i], r[i]}, lit[i] != 0.0f, strq[3] < 0.0, glm::dvec3(0.0)};
        bool near_side = false;
        for (int c = 0; c < 3; ++c) {
            const double u = std::fabs(fragment.str[c]);
            fragment.allowed[c] = tolerance * (terms[c] + u * terms.w) / std::fabs(strq[3]) + 6e-8 * u;
            if (c < 2 && !fragment.behind)
                for (const double side : {scene.region.min()[c], scene.region.max()[c]})
                    near_side = near_side || std::fabs(fragment.str[c] - side) <= fragment.allowed[c];
        }
        const auto expected = near_side ? std::nullopt : expect(scene, fragment);
        if (!expected) continue;
        const glm::dvec2 mirrored(strq[0] / strq[3], strq[1] / strq[3]);
        ++result.compared;
        result.lit += fragment.lit;
        result.behind += fragment.behind;
        result.mirrored += fragment.behind && mirrored.x > scene.region.min().x && mirrored.x < scene.region.max().x &&
                           mirrored.y > scene.region.min().y && mirrored.y < scene.region.max().y;
        bool equal = true;
        for (int c = 0; c < 3; ++c)
            equal = equal && std::fabs(static_cast<double>(pixels[i][c]) - static_cast<double>(expected->color[c])) <=
                                 expected->tolerance;
        result.wrong += equal ? 0 : 1;
    }
}

inline Comparison comparison(const gl::Context& g, const std::string& vertex_source, const std::string& fragment_source,
                             const Expect& expect, std::uint64_t seed) {
    const unsigned program = g.program(vertex_source.c_str(), fragment_source.c_str());
    INFO(gl::Context::reason());
    REQUIRE(program != 0);
    Random random(seed);
    Comparison result;
    for (int i = 0; i < 8; ++i) {
        const Scene scene = random_scene(random, i % 2 == 0);
        compare(draw(g, scene, program), scene, expect, result);
    }
    return result;
}

// The shader is right as it stands, and each change is seen.
inline void judge(Shader shader, const std::vector<Change>& vertex_changes, const std::vector<Change>& changes,
                  const Expect& expect, std::uint64_t seed) {
    const gl::Context& g = gl::Context::or_skip();
    const std::string &vertex_source = shaders()[vertex], &source = shaders()[shader];
    const Comparison right = comparison(g, vertex_source, source, expect, seed);
    MESSAGE(right.compared, " fragments, ", right.lit, " lit, ", right.behind, " behind, where ", right.mirrored,
            " would be lit");
    CHECK(right.wrong == 0);
    CHECK(right.compared > 100000);
    CHECK(right.lit > 10000);
    CHECK(right.compared - right.lit - right.behind > 10000);
    CHECK(right.mirrored > 300);
    for (const Change& change : vertex_changes) {
        INFO("with ", change.to);
        CHECK(comparison(g, changed(vertex_source, change), source, expect, seed).wrong > 500);
    }
    for (const Change& change : changes) {
        INFO("with ", change.to);
        CHECK(comparison(g, vertex_source, changed(source, change), expect, seed).wrong > 500);
    }
}

inline const std::vector<Change> broken_vertices{
    {"vec4(position, 1.0);\n}", "vec4(position, 1.0);\n    strq /= strq.q;\n}"},  // divided too early
    {"texture_from_object * vec4(position, 1.0)", "vec4(position, 1.0) * texture_from_object"},
};

}  // namespace shaded
