// The derivatives and levels of detail of the README's shaders.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "api/shaders_test/comparison.hpp"
#include "api/shaders_test/readme.hpp"
#include "api/shaders_test/scenes.hpp"
#include "api/shaders_test/textures.hpp"
#include "support/opengl.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"

namespace shaded {

namespace {

std::optional<texgen::Footprint> footprint_at(const Scene& scene, const Fragment& fragment) {
    return texgen::FootprintSetup(texgen::TriangleSetup::of(scene.triangle, scene.region).value(), {detailed, detailed})
        .at(fragment.x, fragment.y);
}

// The derivatives themselves, in the place of what would be sampled with them.
TEST_CASE("the gradients of the README's shader are the derivatives of footprint.hpp") {
    const gl::Context& g = gl::Context::or_skip();
    for (const bool by_x : {true, false}) {
        const std::string macro =
            std::string("#define textureGrad(slide, st, dx, dy) vec3(") + (by_x ? "dx" : "dy") + ", 0.0)\nuniform";
        const std::string source = changed(shaders()[gradients], {"uniform", macro});
        const Expect expect = [by_x](const Scene& scene, const Fragment& fragment) -> std::optional<Expected> {
            if (!fragment.lit) return Expected{surface * border, 1e-6};
            const texgen::Footprint footprint = footprint_at(scene, fragment).value();
            return Expected{surface * glm::vec3(by_x ? footprint.dx : footprint.dy, 0.0f),
                            std::max(fragment.allowed.x, fragment.allowed.y)};
        };
        const Comparison right = comparison(g, shaders()[vertex], source, expect, 203);
        MESSAGE(right.compared, " fragments, ", right.lit, " lit");
        CHECK(right.wrong == 0);
        CHECK(right.lit > 10000);
        for (const Change& change :
             {Change{"strq * gl_FragCoord.w", "strq"}, Change{"st * dx.q", "0.0"}, Change{"st * dy.q", "0.0"},
              Change{"st * dx.q) / affine.q", "st * dx.q)"}, Change{"st * dy.q) / affine.q", "st * dy.q)"}}) {
            const bool concerns_this = change.from.find(by_x ? "dy" : "dx") == std::string::npos;
            INFO("with ", change.to);
            const std::size_t wrong = comparison(g, shaders()[vertex], changed(source, change), expect, 203).wrong;
            CHECK(concerns_this == (wrong > 500));
        }
    }
}

TEST_CASE("the README's shader samples the level of detail of footprint.hpp") {
    const gl::Context& g = gl::Context::or_skip();
    // Each level has its number as its color.
    bind_new_texture(g, gl::linear_mipmap_linear);
    for (int level = 0; level <= 10; ++level) {
        const int side = detailed >> level;
        const std::vector<float> texels(static_cast<std::size_t>(4 * side * side), static_cast<float>(level));
        g.TexImage2D(gl::texture_2d, level, static_cast<int>(gl::rgba32f), side, side, 0, gl::rgba, gl::float_type,
                     texels.data());
    }
    std::size_t between = 0;
    const Expect expect = [&between](const Scene& scene, const Fragment& fragment) -> std::optional<Expected> {
        if (!fragment.lit) return Expected{surface * border, 1e-6};
        const double level = std::clamp(footprint_at(scene, fragment).value().level, 0.0, 10.0);
        between += level > 0.5 && level < 9.5;
        return Expected{surface * static_cast<float>(level), 0.1};  // what Mesa's logarithm may be off
    };
    const Comparison right = comparison(g, shaders()[vertex], shaders()[gradients], expect, 204);
    CHECK(right.wrong == 0);
    CHECK(right.lit > 10000);
    CHECK(between > 1000);
}

}  // namespace

}  // namespace shaded
