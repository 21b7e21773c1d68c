// The README's shaders, as they are written there, compiled and run by a real OpenGL and compared with what the library
// computes for the same fragments. Skipped (exit 77) where there is none. Each shader is broken as well, in the ways
// that users break them, and the comparison must notice.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <optional>
#include <string>

#include "api/shaders_test/comparison.hpp"
#include "api/shaders_test/readme.hpp"
#include "api/shaders_test/scenes.hpp"
#include "api/shaders_test/textures.hpp"
#include "support/opengl.hpp"

namespace shaded {

namespace {

TEST_CASE("the lines of GLSL in the headers are those of the README") {
    std::size_t lines = 0;
    for (const char* header : {"linear.hpp", "texcoord.hpp"}) {
        std::ifstream text(std::string(TEXGEN_TEST_DATA "/../include/texgen/") + header);
        for (std::string line; std::getline(text, line);) {
            if (line.rfind("//     ", 0) != 0 || line.back() != ';') continue;
            INFO(header, ": ", line);
            ++lines;
            CHECK(std::any_of(shaders().begin(), shaders().end(), [&](const std::string& shader) {
                return shader.find("    " + line.substr(7)) != std::string::npos;
            }));
        }
    }
    CHECK(lines == 4);
}

std::optional<Expected> slide_color(const Scene&, const Fragment& fragment) {
    if (!fragment.lit) return Expected{surface * border, 1e-6};
    const auto column = texel(fragment.str.x, fragment.allowed.x), row = texel(fragment.str.y, fragment.allowed.y);
    if (!column || !row) return std::nullopt;
    return Expected{surface * slide_texel(*column, *row), 1e-6};
}

TEST_CASE("the README's slide on a surface shows what the library computes, gated, bordered and modulated") {
    bind_slide(gl::Context::or_skip());
    judge(slide, broken_vertices,
          {{"strq.q > 0.0 &&", ""},
           {"textureProj(slide, strq)", "texture(slide, strq.st)"},
           {"textureProj(slide, strq)", "textureProj(slide, strq.tspq)"},
           {"textureProj(slide, strq)", "textureProj(slide, strq.stp)"},
           {"strq.st / strq.q", "strq.st"},
           {"&& st == clamp(st, region.xy, region.zw)", ""},
           {": border", ": vec3(0.0)"},
           {"surface * ", ""}},
          slide_color, 201);
}

TEST_CASE("the README's slide with gradients shows the same") {
    bind_slide(gl::Context::or_skip());
    judge(gradients, broken_vertices,
          {{"strq.q > 0.0 &&", ""},
           {"textureGrad(slide, st,", "textureGrad(slide, st.ts,"},
           {"&& st == clamp(st, region.xy, region.zw)", ""},
           {"light = border", "light = vec3(0.0)"},
           {"surface * ", ""}},
          slide_color, 202);
}

}  // namespace

}  // namespace shaded
