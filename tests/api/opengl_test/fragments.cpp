// Fragments of triangles, as OpenGL interpolates and divides them.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "api/opengl_test/both.hpp"
#include "api/opengl_test/drawn_triangles.hpp"
#include "support/fixed_function.hpp"
#include "support/hex.hpp"
#include "support/opengl.hpp"
#include "support/opengl_fragments.hpp"
#include "support/random.hpp"
#include "texgen/clip.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace judged {

using support::slide_projector;
using support::gl::fragment_tolerance;

namespace {

TEST_CASE("fragments in front of the projector are OpenGL's, for w ratios up to 1e4") {
    const gl::Context& g = opengl();
    Random random(106);
    Comparison result;
    for (int i = 0; i < 24; ++i) {
        texgen::Triangle triangle = random_triangle(random, i % 3 == 0 ? 0.0 : i % 3 == 1 ? 1.0 : 4.0);
        for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c})
            vertex->strq = {random.vector3(2.0), random.uniform_float(0.5, 3.0)};
        compare(draw_with_texcoords(g, triangle), triangle, fragment_tolerance, result);
    }
    MESSAGE(result.fragments, " fragments, worst error ", result.worst, " of the largest terms, homogeneous ",
            result.worst_homogeneous);
    CHECK(result.fragments > 100000);
    CHECK(result.behind == 0);
}

TEST_CASE("OpenGL interpolates straight through q = 0, and the reverse projection behind it is the definition's") {
    const gl::Context& g = opengl();
    Random random(107);
    Comparison result;
    for (int i = 0; i < 24; ++i) {
        texgen::Triangle triangle = random_triangle(random, i % 2 == 0 ? 0.0 : 2.0);
        for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c}) vertex->strq = random.vector4(2.0);
        triangle.a.strq.w = std::fabs(triangle.a.strq.w) + 0.1f;
        triangle.b.strq.w = -std::fabs(triangle.b.strq.w) - 0.1f;
        compare(draw_with_texcoords(g, triangle), triangle, fragment_tolerance, result);
    }
    MESSAGE(result.fragments, " fragments, ", result.behind, " behind, worst error ", result.worst,
            " of the largest terms, homogeneous ", result.worst_homogeneous);
    CHECK(result.behind > result.fragments / 10);
    CHECK(result.behind < result.fragments * 9 / 10);
}

TEST_CASE("texgen's interpolate gives OpenGL's fragments in front of the projector, and nothing behind it") {
    const gl::Context& g = opengl();
    Random random(108);
    const std::size_t count =
        static_cast<std::size_t>(gl::Context::width) * static_cast<std::size_t>(gl::Context::height);
    const texgen::FragmentRect rect{0, 0, gl::Context::width, gl::Context::height};
    std::vector<float> s(count), t(count), r(count), lit(count);
    std::size_t lit_by_both = 0, dark_behind = 0, dark_outside = 0;
    for (int i = 0; i < 24; ++i) {
        texgen::Triangle triangle = random_triangle(random, i % 2 == 0 ? 0.0 : 3.0);
        for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c})
            vertex->strq = {random.uniform_float(-1.0, 2.0), random.uniform_float(-1.0, 2.0),
                            random.uniform_float(-1.0, 2.0), random.uniform_float(i % 4 < 2 ? 0.5 : -2.0, 2.0)};
        const std::vector<glm::vec4> pixels = draw_with_texcoords(g, triangle);
        const auto setup = texgen::TriangleSetup::of(triangle, texgen::whole_texture());
        REQUIRE(setup.has_value());
        if (texgen::interpolate(*setup, rect, {s, t, r, lit}) == texgen::Work::nothing)
            for (std::vector<float>* values : {&s, &t, &r}) std::fill(values->begin(), values->end(), 0.0f);
        INFO("triangle ", hex(triangle));
        for (std::size_t fragment = 0; fragment < count; ++fragment) {
            const glm::vec4 theirs = pixels[fragment];
            if (theirs.x == nothing) continue;
            const double x = static_cast<double>(fragment % gl::Context::width) + 0.5;
            const double y = static_cast<double>(fragment / gl::Context::width) + 0.5;
            const glm::dvec4 terms = largest_terms(triangle, x, y);
            const double q = static_cast<double>(theirs.w);
            if (fragment_tolerance * 2.0 * terms.w > std::fabs(q)) continue;
            INFO("fragment ", x, " ", y, " OpenGL ", hex(theirs), " ours ",
                 hex(glm::vec4(s[fragment], t[fragment], r[fragment], lit[fragment])));
            if (q < 0.0) {
                ++dark_behind;
                if (lit[fragment] != 0.0f) FAIL_CHECK("lit behind the projector");
                continue;
            }
            bool inside = true, near_border = false;
            const glm::vec3 ours(s[fragment], t[fragment], r[fragment]);
            glm::dvec3 error(0.0), allowed(0.0);
            for (int c = 0; c < 3; ++c) {
                const double u = static_cast<double>(theirs[c]) / q;
                allowed[c] = fragment_tolerance * (terms[c] + std::fabs(u) * terms.w) / q + 6e-8 * std::fabs(u);
                error[c] = std::fabs(static_cast<double>(ours[c]) - u);
                if (c < 2) {
                    inside = inside && u >= 0.0 && u <= 1.0;
                    near_border = near_border || std::min(std::fabs(u), std::fabs(u - 1.0)) <= allowed[c];
                }
            }
            if (near_border) continue;
            if ((lit[fragment] != 0.0f) != inside)
                FAIL_CHECK("lit where OpenGL is outside, or dark where it is inside");
            lit_by_both += inside ? 1 : 0;
            dark_outside += inside ? 0 : 1;
            // What is dark may have been skipped.
            if (inside && !(error.x <= allowed.x && error.y <= allowed.y && error.z <= allowed.z))
                FAIL_CHECK("not OpenGL's coordinate");
        }
    }
    MESSAGE(lit_by_both, " fragments lit by both, ", dark_outside, " outside, ", dark_behind, " behind");
    CHECK(lit_by_both > 20000);
    CHECK(dark_outside > 20000);
    CHECK(dark_behind > 20000);
}

TEST_CASE("a floor under a slide, drawn with OpenGL's own transforms and eye-linear texgen, is texgen's") {
    const gl::Context& g = opengl();
    Random random(109);
    // The second one stands on the far side of the floor and looks at the camera: what is behind it is seen as well.
    const texgen::Projector facing =
        texgen::make_projector(
            texgen::PerspectiveLens{.fovy = texgen::degrees(30.0), .aspect = 1.0, .z_near = 0.2, .z_far = 1000.0},
            texgen::Aim{.position = {0.0, 0.0, -15.0}, .target = {0.0, -4.0, 0.0}, .up = {0.0, 1.0, 0.0}},
            texgen::opengl)
            .value();
    const texgen::Viewport viewport{0, 0, gl::Context::width, gl::Context::height};
    Comparison result;
    for (int i = 0; i < 24; ++i) {
        const auto world_planes = texgen::planes(texgen::texture_from_world(i % 2 == 0 ? slide_projector() : facing));
        // The camera's lens and aim are made as a projector's are.
        const auto camera = texgen::make_projector(
            texgen::PerspectiveLens{.fovy = texgen::degrees(50.0), .aspect = 1.0, .z_near = 0.5, .z_far = 500.0},
            texgen::Aim{.position = {random.uniform(-3.0, 3.0), random.uniform(1.0, 8.0), 12.0},
                        .target = {random.uniform(-1.0, 1.0), -2.0, 0.0},
                        .up = {0.0, 1.0, 0.0}},
            texgen::opengl);
        REQUIRE(camera.has_value());
        const glm::mat4 view = camera->view.rounded();
        const glm::mat4 lens = camera->projection.rounded();

        Both both(g);
        both.load_projection(lens);
        for (const Coordinate coordinate : support::coordinates) {
            both.enable(coordinate);
            both.set_eye_plane(coordinate, world_planes[static_cast<std::size_t>(coordinate)], view);
        }
        // A triangle on the floor, from near the camera to far away, some of it behind the projector.
        const float left = random.uniform_float(-6, -2), right = random.uniform_float(2, 6);
        const float far_x = random.uniform_float(-60, 120), far_z = random.uniform_float(-100, -60);
        const std::array corners{glm::vec4(left, -4, 6, 1), glm::vec4(right, -4, 6, 1), glm::vec4(far_x, -4, far_z, 1)};
        g.show_texcoord();
        g.clear(glm::vec4(nothing));
        g.Begin(gl::triangles);
        for (const glm::vec4& corner : corners) g.Vertex4fv(&corner[0]);
        g.End();
        REQUIRE(g.GetError() == gl::no_error);

        std::array<texgen::WindowVertex, 3> window;
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec4 clip = glm::dmat4(lens) * (glm::dmat4(view) * glm::dvec4(corners[k]));
            window[k] =
                texgen::to_window({glm::vec4(clip), both.ours().generate({.position = corners[k]}, view)}, viewport);
        }
        INFO("view ", hex(view));
        compare(g.pixels(), {window[0], window[1], window[2]}, fragment_tolerance, result);
    }
    MESSAGE(result.fragments, " fragments, ", result.behind, " behind, worst error ", result.worst,
            " of the largest terms, homogeneous ", result.worst_homogeneous);
    CHECK(result.fragments > 100000);
    CHECK(result.behind > 0);
}

}  // namespace

}  // namespace judged
