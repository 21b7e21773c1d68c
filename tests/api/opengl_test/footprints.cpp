// Derivatives and levels of detail, as OpenGL takes them.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "api/opengl_test/both.hpp"
#include "api/opengl_test/drawn_triangles.hpp"
#include "support/hex.hpp"
#include "support/opengl.hpp"
#include "support/random.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"

namespace judged {

namespace {

constexpr int slide_width = 512, slide_height = 128;

// Binds a texture of that size, with all its levels and trilinear filtering.
void bind_slide(const gl::Context& g) {
    unsigned slide = 0;
    g.GenTextures(1, &slide);
    g.BindTexture(gl::texture_2d, slide);
    const std::vector<float> texels(static_cast<std::size_t>(slide_width * slide_height * 4), 1.0f);
    for (int level = 0, width = slide_width, height = slide_height; level <= 9; ++level) {
        g.TexImage2D(gl::texture_2d, level, static_cast<int>(gl::rgba), width, height, 0, gl::rgba, gl::float_type,
                     texels.data());
        width = std::max(1, width / 2);
        height = std::max(1, height / 2);
    }
    g.TexParameteri(gl::texture_2d, gl::texture_min_filter, static_cast<int>(gl::linear_mipmap_linear));
    g.TexParameteri(gl::texture_2d, gl::texture_mag_filter, static_cast<int>(gl::linear));
    REQUIRE(g.GetError() == gl::no_error);
}

std::vector<glm::vec4> draw_with_program(const gl::Context& g, const texgen::Triangle& triangle, unsigned program) {
    g.reset();
    g.UseProgram(program);
    return draw(g, triangle);
}

texgen::Triangle random_slide_triangle(Random& random, int round) {
    texgen::Triangle triangle = random_triangle(random, round % 3 == 0 ? 0.0 : 1.0);
    for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c}) {
        const float q = random.uniform_float(0.5, 3.0);
        vertex->strq = {q * random.uniform_float(-1.0, 2.0), q * random.uniform_float(-1.0, 2.0), 0.0f, q};
    }
    return triangle;
}

// Ours at the four fragments of the 2x2 block that OpenGL takes its differences in: a difference of neighbours is the
// derivative somewhere between them, and along a row or a column of fragments that is monotone.
template <class Value>
std::array<double, 2> range_in_block(int x, int y, const Value& value) {
    std::array<double, 2> range{HUGE_VAL, -HUGE_VAL};
    for (const int column : {x & ~1, x | 1}) {
        for (const int row : {y & ~1, y | 1}) {
            const double here = value(column, row);
            range = {std::min(range[0], here), std::max(range[1], here)};
        }
    }
    return range;
}

TEST_CASE("OpenGL's dFdx and dFdy lie between the derivatives of the fragments that it takes its differences of") {
    const gl::Context& g = opengl();
    const unsigned program = g.program(nullptr,
                                       "#version 120\nvoid main() { vec2 c = gl_TexCoord[0].st / gl_TexCoord[0].q; "
                                       "gl_FragColor = vec4(dFdx(c), dFdy(c)); }\n");
    REQUIRE(program != 0);
    Random random(110);
    std::size_t compared = 0, steep = 0;
    double worst = 0.0;
    for (int round = 0; round < 16; ++round) {
        const texgen::Triangle triangle = random_slide_triangle(random, round);
        const std::vector<glm::vec4> pixels = draw_with_program(g, triangle, program);
        const texgen::FootprintSetup setup(texgen::TriangleSetup::of(triangle, texgen::whole_texture()).value(),
                                           {1.0, 1.0});
        for (std::size_t fragment = 0; fragment < pixels.size(); fragment += 7) {
            if (pixels[fragment].x == nothing) continue;
            const int x = static_cast<int>(fragment) % gl::Context::width;
            const int y = static_cast<int>(fragment) / gl::Context::width;
            const auto here = setup.at(x, y);
            for (int c = 0; c < 4; ++c) {
                const auto range = range_in_block(x, y, [&](int column, int row) {
                    const auto at = setup.at(column, row);
                    return at ? (c < 2 ? at->dx : at->dy)[c % 2] : HUGE_VAL;
                });
                constexpr double allowed = 1e-6;  // of coordinates that are floats, of size 2 at most
                const double theirs = static_cast<double>(pixels[fragment][c]);
                const double outside = std::max(range[0] - theirs, theirs - range[1]);
                worst = std::max(worst, outside / allowed);
                if (!(outside <= allowed))
                    FAIL("fragment ", x, " ", y, " derivative ", c, ": ", theirs, " is not in ", range[0], " ",
                         range[1], hex(triangle));
            }
            ++compared;
            steep += here && std::fabs(here->dx.x) > 0.01;
        }
    }
    MESSAGE(compared, " fragments, at most ", worst, " of what floats allow outside");
    CHECK(compared > 20000);
    CHECK(steep > 1000);
}

TEST_CASE("OpenGL's textureQueryLod is the level of detail, within what its differences allow") {
    const gl::Context& g = opengl();
    const unsigned program =
        g.program(nullptr,
                  "#version 400 compatibility\nuniform sampler2D slide;\n"
                  "void main() { gl_FragColor = vec4(textureQueryLod(slide, gl_TexCoord[0].st / gl_TexCoord[0].q), "
                  "0.0, 1.0); }\n");
    if (program == 0) {
        MESSAGE("this OpenGL has no textureQueryLod");
        return;
    }
    bind_slide(g);
    Random random(111);
    std::size_t compared = 0, minified = 0, magnified = 0;
    double lowest = 0.0, highest = 0.0;
    for (int round = 0; round < 16; ++round) {
        texgen::Triangle triangle = random_slide_triangle(random, round);
        if (round % 4 == 0)  // magnified
            for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c})
                vertex->strq *= glm::vec4(0.05f, 0.05f, 1.0f, 1.0f);
        const std::vector<glm::vec4> pixels = draw_with_program(g, triangle, program);
        const texgen::FootprintSetup setup(texgen::TriangleSetup::of(triangle, texgen::whole_texture()).value(),
                                           {slide_width, slide_height});
        for (std::size_t fragment = 0; fragment < pixels.size(); fragment += 7) {
            if (pixels[fragment].x == nothing) continue;
            const int x = static_cast<int>(fragment) % gl::Context::width;
            const int y = static_cast<int>(fragment) / gl::Context::width;
            const auto range = range_in_block(x, y, [&](int column, int row) {
                const auto at = setup.at(column, row);
                return at ? at->level : HUGE_VAL;
            });
            const double theirs = static_cast<double>(pixels[fragment].y);
            lowest = std::min(lowest, theirs - range[0]);
            highest = std::max(highest, theirs - range[1]);
            ++compared;
            minified += range[0] > 0.5;
            magnified += range[1] < -0.5;
        }
    }
    MESSAGE(compared, " fragments; theirs from ", lowest, " below ours to ", highest, " above");
    CHECK(compared > 20000);
    CHECK(minified > 5000);
    CHECK(magnified > 2000);
    // The specification lets rho be approximated by as little as the larger of m_u and m_v, half a level below; Mesa
    // does not.
    CHECK(lowest > -0.1);
    CHECK(highest < 0.02);
}

}  // namespace

}  // namespace judged
