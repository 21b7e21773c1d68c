// The texgen matrix of a camera's window, T_w, against exact rationals, and what the depth buffer's precision makes of
// it.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "judges/exact.hpp"
#include "judges/oracle.hpp"
#include "judges/rational_matrix.hpp"
#include "judges/real.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/windows.hpp"
#include "texgen/clip.hpp"
#include "texgen/linear.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::at;
using support::hex;
using support::operator*;
using support::Random;
using support::random_fragment;
using support::random_window_scene;
using support::RationalVector;
using support::WindowScene;
using texgen::DepthBuffer;
using texgen::Projector;
using texgen::Viewport;

}  // namespace

TEST_CASE(
    "window_linear is within 2^-47 (m_s + |s| m_q) / |q| of S P_p V_p (W P_c V_c)^-1, up to 1e7 from the origin") {
    Random random(421);
    support::Worst worst;
    for (const double distance : {0.0, 1.0, 1e3, 1e5, 1e7}) {
        for (int i = 0; i < 40; ++i) {
            const WindowScene scene = random_window_scene(random, distance);
            const auto texgen = window_linear(scene.projector, scene.camera, scene.viewport, scene.region, scene.depth);
            REQUIRE(texgen);
            const support::ExactWindow exact(scene);
            for (int k = 0; k < 10; ++k) {
                const glm::dvec3 fragment = random_fragment(random, scene.viewport);
                const double share = exact.share_of_terms(*texgen, fragment);
                worst.take(share, [&] { return hex(fragment) + " " + hex(scene.camera.view.matrix()); });
            }
        }
    }
    CHECK_MESSAGE(worst.error <= texgen::window_linear_error, worst.input);
    MESSAGE((worst.error * 0x1p53), " times 2^-53 at most");
}

TEST_CASE("what the camera sees gets by its fragment the coordinate that it has in the world, with the sign of q") {
    Random random(422);
    int seen = 0, behind = 0;
    for (int i = 0; i < 4000; ++i) {
        const WindowScene scene = random_window_scene(random, random.power_of_ten(-1.0, 2.0));
        const glm::dvec3 point = scene.camera_aim.target + 9.0 * random.direction();
        const glm::dvec4 clip = scene.camera.matrix().matrix() * glm::dvec4(point, 1.0);
        if (!(clip.w > 0.01)) continue;
        const glm::dvec4 window = support::window_from_ndc(scene.viewport, scene.camera.conventions) * (clip / clip.w);
        const auto texgen = window_linear(scene.projector, scene.camera, scene.viewport, scene.region, scene.depth);
        REQUIRE(texgen);
        const glm::dvec4 by_window = clip.w * (texgen->matrix() * window);
        const glm::dvec4 by_world =
            texture_from_world(scene.projector, scene.region, scene.depth).matrix() * glm::dvec4(point, 1.0);
        const double slack = 1e-8 * (1.0 + glm::dot(glm::abs(by_world), glm::dvec4(1.0)));
        for (int k = 0; k < 4; ++k) REQUIRE(std::fabs(by_window[k] - by_world[k]) <= slack);
        ++seen;
        behind += by_world.w < -slack;
    }
    CHECK(seen > 2000);
    CHECK(behind > 100);
}

TEST_CASE("rows from the top down: Direct3D and Metal by a viewport of negative height, Vulkan by its NDC") {
    const texgen::Aim aim{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}};
    const texgen::PerspectiveLens lens{texgen::degrees(90.0), 1.0, 1.0, 10.0};
    const auto slide = make_projector(lens, aim, texgen::opengl).value();
    // The point (-4, 3, 0) is in the first eighth from the left, and from the top in the second.
    const glm::dvec3 row_from_top(80.0, 160.0, 0.0), row_from_bottom(80.0, 640.0, 0.0);
    struct Case {
        texgen::Conventions conventions;
        Viewport viewport;
        glm::dvec3 fragment;
    };
    for (const auto& [conventions, viewport, fragment] : {Case{texgen::opengl, {0, 0, 800, 800}, row_from_bottom},
                                                          Case{texgen::direct3d, {0, 800, 800, -800}, row_from_top},
                                                          Case{texgen::metal, {0, 800, 800, -800}, row_from_top},
                                                          Case{texgen::vulkan, {0, 0, 800, 800}, row_from_top}}) {
        const auto camera = make_projector(lens, aim, conventions).value();
        const glm::dvec4 clip = camera.matrix().matrix() * glm::dvec4(-4.0, 3.0, 0.0, 1.0);
        const double ndc = clip.z / clip.w;
        const double depth = conventions.depth == texgen::DepthRange::zero_to_one ? ndc : 0.5 + 0.5 * ndc;
        const glm::dvec4 strq =
            window_linear(slide, camera, viewport).value().matrix() * glm::dvec4(fragment.x, fragment.y, depth, 1.0);
        CHECK(strq.x / strq.w == doctest::Approx(0.1).epsilon(1e-12));
        CHECK(strq.y / strq.w == doctest::Approx(0.8).epsilon(1e-12));
        CHECK(strq.w > 0.0);
    }
}

TEST_CASE("project() takes fragments of a depth buffer, and gives the nearest floats") {
    Random random(423);
    for (int i = 0; i < 50; ++i) {
        const WindowScene scene = random_window_scene(random, random.power_of_ten(0.0, 4.0));
        const auto texgen = window_linear(scene.projector, scene.camera, scene.viewport, scene.region, scene.depth);
        REQUIRE(texgen);
        std::vector<glm::vec3> fragments;
        std::vector<float> x, y, z;
        for (int k = 0; k < 50; ++k) {
            fragments.emplace_back(random_fragment(random, scene.viewport));
            x.push_back(fragments.back().x);
            y.push_back(fragments.back().y);
            z.push_back(fragments.back().z);
        }
        std::vector<glm::vec2> st(fragments.size()), of_arrays(fragments.size()), of_strides(fragments.size());
        project(*texgen, texgen::window_space(fragments), st);
        project(*texgen, texgen::window_space(x, y, z), of_arrays);
        project(*texgen, texgen::window_space(&fragments[0].x, fragments.size(), sizeof(glm::vec3)), of_strides);
        CHECK(st == of_arrays);
        CHECK(st == of_strides);
        for (std::size_t k = 0; k < fragments.size(); ++k) {
            const auto exact = support::exactly_at(texgen->matrix(), fragments[k]);
            for (std::size_t c = 0; c < 2; ++c)
                REQUIRE((exact.q.sign() > 0 ? is_nearest(st[k][static_cast<int>(c)], exact.over_q(c))
                                            : st[k][static_cast<int>(c)] == 0.0f));
        }
    }
}

TEST_CASE("depth_error_bound holds for every depth that is stored as the fragment's, and is reached") {
    Random random(424);
    double least_share = 1.0;
    int bounded = 0, unbounded = 0;
    for (int i = 0; i < 3000; ++i) {
        const WindowScene scene = random_window_scene(random, random.power_of_ten(-1.0, 2.0));
        const auto made = window_linear(scene.projector, scene.camera, scene.viewport, scene.region, scene.depth);
        REQUIRE(made);
        // Homogeneous coordinates have no size.
        const texgen::WindowTexgen texgen(made->matrix() * std::ldexp(1.0, 850 * (i % 3 - 1)));
        const glm::vec3 fragment(random_fragment(random, scene.viewport));
        const auto buffer =
            std::array{DepthBuffer::unorm16, DepthBuffer::unorm24, DepthBuffer::float32}[random.bits() % 3];
        const glm::dvec2 bound = depth_error_bound(texgen, fragment, buffer);
        // The extremes are at the ends: s/q is monotone in the depth.
        const double z = fragment.z, half_ulp = 0.5 * (static_cast<double>(support::neighbour(fragment.z, 1)) - z);
        const double step = buffer == DepthBuffer::unorm16 ? 1.0 / 65535.0 : 1.0 / 16777215.0;
        const double rounding = half_ulp + (buffer == DepthBuffer::float32 ? 0.0 : 0.6 * step);
        const support::RationalMatrix matrix = support::exactly(texgen.matrix());
        const RationalVector here = at(matrix, fragment);
        for (int c = 0; c < 2; ++c) {
            double worst = 0.0;
            bool in_front = here[3] > 0;
            for (const double other : {z - rounding, z + rounding}) {
                const RationalVector there = at(matrix, {fragment.x, fragment.y, other});
                in_front = in_front && there[3] > 0;
                if (!in_front) break;
                const auto k = static_cast<std::size_t>(c);
                worst = std::max(worst,
                                 support::nearest<double>(support::magnitude(here[k] / here[3] - there[k] / there[3])));
            }
            if (!in_front) {
                CHECK(bound[c] == HUGE_VAL);
                ++unbounded;
                continue;
            }
            REQUIRE_MESSAGE(worst <= bound[c], hex(fragment));
            if (!std::isfinite(bound[c])) continue;
            ++bounded;
            if (worst > 1e-12) least_share = std::min(least_share, worst / bound[c]);
        }
    }
    CHECK(bounded > 1000);
    CHECK(unbounded > 500);
    CHECK(least_share > 0.4);
    MESSAGE("at least ", least_share, " of the bound is reached");
}

TEST_CASE("a reversed depth in float32 is as good far away as 24 bits are at the near plane") {
    const texgen::Aim aim{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}};
    const auto slide = make_projector(texgen::PerspectiveLens{texgen::degrees(60.0), 1.0, 1.0, 2000.0},
                                      {{100, 0, 0}, {0, 0, -500}, {0, 1, 0}}, texgen::direct3d)
                           .value();
    const auto bound_at = [&](double distance, bool reversed, DepthBuffer buffer) {
        const auto camera = make_projector(texgen::PerspectiveLens{texgen::degrees(60.0), 1.0, 0.1, 10000.0, reversed},
                                           aim, texgen::direct3d)
                                .value();
        const glm::dvec4 clip = camera.projection.matrix() * glm::dvec4(0.0, 0.0, -distance, 1.0);
        const auto texgen = window_linear(slide, camera, {0, 800, 800, -800});
        const glm::vec3 fragment(400.0f, 400.0f, support::to_float(clip.z / clip.w));
        return depth_error_bound(texgen.value(), fragment, buffer).x * 4096.0;
    };
    const double of_integers = bound_at(500.0, false, DepthBuffer::unorm24);
    const double of_floats = bound_at(500.0, false, DepthBuffer::float32);
    const double of_reversed = bound_at(500.0, true, DepthBuffer::float32);
    MESSAGE("500 units away, in texels of 4096: ", of_integers, " with 24 bits, ", of_floats, " in float32, ",
            of_reversed, " reversed");
    CHECK(of_integers > 0.1);
    CHECK(of_floats > 0.1);
    CHECK(of_reversed < 0.001);
}

TEST_CASE("the exact poses' T_w, up to 1e7 from the origin: within 0.002 texel of a 4096 texture") {
    Random random(425);
    for (const double distance : {1.0, 1e3, 1e5, 1e7}) {
        double worst = 0.0;
        for (int i = 0; i < 60; ++i) {
            const glm::dvec3 place = distance * random.direction();
            const texgen::Aim of_slide{place + 5.0 * random.direction(), place, random.direction()},
                of_camera{place + 5.0 * random.direction(), place, random.direction()};
            const double fovy = texgen::degrees(40.0).in_radians();
            const texgen::PerspectiveLens lens{texgen::radians(fovy), 1.0, 0.5, 50.0};
            const auto slide = make_projector(lens, of_slide, texgen::opengl).value();
            const auto camera = make_projector(lens, of_camera, texgen::opengl).value();
            const glm::dmat4 computed = window_linear(slide, camera, {0, 0, 512, 512}).value().matrix();
            const support::RealMatrix projection = support::perspective(fovy, 1.0, 0.5, 50.0);
            const auto view_of = [](const texgen::Aim& aim) {
                return support::look_at(aim.position, aim.target, aim.up);
            };
            // A point about the place, from the exact world to the exact window.
            const glm::dvec3 point = place + random.direction();
            const auto transformed = [](const support::RealMatrix& m, const std::array<support::Real, 4>& v) {
                std::array<support::Real, 4> result;
                for (std::size_t row = 0; row < 4; ++row)
                    result[row] = m[row][0] * v[0] + m[row][1] * v[1] + m[row][2] * v[2] + m[row][3] * v[3];
                return result;
            };
            const std::array<support::Real, 4> world{support::Real(point.x), support::Real(point.y),
                                                     support::Real(point.z), 1};
            const auto clip = transformed(support::operator*(projection, view_of(of_camera)), world);
            std::array<support::Real, 4> window{0, 0, 0, 1};
            for (std::size_t k = 0; k < 3; ++k) window[k] = (clip[k] / clip[3] + 1) * (k == 2 ? 0.5 : 256.0);
            const auto exact = transformed(
                support::operator*(support::operator*(support::scale_bias(), projection), view_of(of_slide)), world);
            const auto got = transformed(support::real(computed), window);
            for (std::size_t k = 0; k < 2; ++k)
                worst = std::max(worst, 4096.0 * std::fabs(static_cast<double>(got[k] / got[3] - exact[k] / exact[3])));
        }
        CHECK(worst < 0.002);
        MESSAGE("at ", distance, ": ", worst, " texel at most");
    }
}

TEST_CASE("a camera without an inverse, a viewport without an area and what is not finite have no T_w") {
    Random random(426);
    const WindowScene scene = random_window_scene(random, 1.0);
    const auto texgen_of = [&](const Projector& camera, const Viewport& viewport) {
        return window_linear(scene.projector, camera, viewport);
    };
    CHECK(texgen_of(scene.camera, {0, 0, 1, 1}));
    CHECK_FALSE(texgen_of(scene.camera, {0, 0, 0, 1}));
    CHECK_FALSE(texgen_of(scene.camera, {0, 0, 1, 0}));
    glm::dmat4 flat(1.0);
    flat[2][2] = 0.0;
    Projector camera = scene.camera;
    camera.view = texgen::ProjectorView(flat);
    CHECK_FALSE(texgen_of(camera, {0, 0, 1, 1}));
    camera = scene.camera;
    camera.projection = texgen::ProjectorProjection(flat);
    CHECK_FALSE(texgen_of(camera, {0, 0, 1, 1}));
    for (const double bad : {support::nan_double, HUGE_VAL}) {
        glm::dmat4 m = scene.camera.view.matrix();
        m[3][1] = bad;
        camera = scene.camera;
        camera.view = texgen::ProjectorView(m);
        CHECK_FALSE(texgen_of(camera, {0, 0, 1, 1}));
        CHECK_FALSE(window_linear({scene.projector.projection, texgen::ProjectorView(m), texgen::opengl}, scene.camera,
                                  {0, 0, 1, 1}));
        const auto texgen = texgen_of(scene.camera, {0, 0, 1, 1}).value();
        const auto number = static_cast<float>(bad);
        for (int k = 0; k < 3; ++k) {
            glm::vec3 fragment(0.5f);
            fragment[k] = number;
            CHECK(depth_error_bound(texgen, fragment, DepthBuffer::float32) == glm::dvec2(HUGE_VAL));
        }
    }
}

TEST_CASE("what is below all doubles is not 0 in a bound") {
    glm::dmat4 m(0.0);
    m[3][3] = 1.0;
    m[2][0] = 0x1p-1060;
    CHECK(depth_error_bound(texgen::WindowTexgen(m), glm::vec3(0.5f), DepthBuffer::float32).x > 0.0);
}
