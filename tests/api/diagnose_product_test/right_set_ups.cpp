// What the library itself makes, of every lens, size and angle, is not found fault with.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "api/diagnose_product_test/users_code.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/windows.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/surface.hpp"

namespace product_cases {

TEST_CASE("cameras, narrowed lenses, cropped pictures, mirrors and flashlights are not found fault with") {
    Random random(624);
    const int count = valid_setups() / 4;
    for (int i = 0; i < count; ++i) {
        Meant m = any_meant(Mistake::none, random);
        const int kind = random.integer(0, 4);
        std::optional<Projector> projector;
        texgen::LensFacts facts;
        if (kind == 0) {
            const double width = random.integer(320, 4000), height = random.integer(240, 3000);
            const double focal = width * random.uniform(0.3, 4.0);
            projector = make_projector(
                texgen::PinholeLens{focal, focal * random.uniform(0.9, 1.1), width * random.uniform(0.4, 0.6),
                                    height * random.uniform(0.4, 0.6), width, height, m.z_near,
                                    random.coin() ? infinity_double : m.z_far,
                                    random.coin() ? texgen::PixelCentre::half : texgen::PixelCentre::integer,
                                    random.coin() ? 0.0 : focal * random.uniform(-0.01, 0.01)},
                m.aim, m.conventions);
        } else {
            texgen::PerspectiveLens lens{texgen::degrees(m.fovy), m.aspect, m.z_near, m.z_far, random.coin()};
            if (kind == 1) lens = contain(lens, random.uniform(0.3, 3.0));
            if (kind == 2) m.region = cover(lens, random.uniform(0.3, 3.0), m.region);
            projector = make_projector(lens, m.aim, m.conventions);
            if (random.coin()) facts = {lens.fovy, lens.aspect, lens.z_near, lens.z_far};
        }
        if (!projector) continue;
        if (kind == 3) {
            const glm::dvec3 n = random.direction();
            projector->view = *mirrored(projector->view, {n.x, n.y, n.z, random.uniform(-5.0, 5.0)});
            facts.mirrored = true;
        }
        if (random.coin()) m.region = m.region.with_depth(m.conventions, m.depth);
        // A flashlight is told without its projector, and so is in its camera's space.
        const bool is_flashlight = kind == 4;
        const glm::dmat4 product =
            is_flashlight ? eye_linear(projector->projection,
                                       texgen::Transform<texgen::ProjectorEye, texgen::Eye>(projector->view.matrix()),
                                       m.conventions, m.region, m.depth)
                                .matrix()
                          : object_linear(*projector, texgen::ModelMatrix(m.pose), m.region, m.depth).matrix();
        const glm::dmat4 texgen = random.coin() ? product : glm::dmat4(support::rounded(product));
        if (is_flashlight) {
            require_valid(
                m, texgen,
                diagnose(texgen::EyeTexgen(texgen),
                         {.region = m.region, .depth = m.depth, .conventions = m.conventions, .lens = facts}));
            continue;
        }
        texgen::ProjectionSetup<Object> setup{.region = m.region, .depth = m.depth, .lens = facts};
        if (random.coin()) setup.projector = projector;
        if (random.coin()) setup.world_from_space = texgen::ModelMatrix(m.pose);
        if (random.coin()) setup.conventions = m.conventions;
        require_valid(m, texgen, diagnose(texgen::ObjectTexgen(texgen), setup));
    }
}

TEST_CASE("the fragments of a camera's window are not found fault with, nor what fills a quadrilateral of it") {
    Random random(644);
    for (int i = 0; i < 2000; ++i) {
        const Meant m = any_meant(Mistake::none, random), of_camera = any_meant(Mistake::none, random);
        const std::optional<Projector> projector = right_projector(m), camera = right_projector(of_camera);
        if (!projector || !camera) continue;
        const auto texgen = window_linear(*projector, *camera, {0, 0, 640, 480}, m.region, m.depth);
        if (!texgen) continue;
        const bool has_projector = random.coin(), is_rounded = random.coin();
        const texgen::WindowTexgen given = is_rounded ? texgen::WindowTexgen(texgen->rounded()) : *texgen;
        texgen::ProjectionSetup<texgen::Window> setup{.region = m.region, .depth = m.depth};
        if (has_projector) setup.projector = projector;
        const Diagnosis diagnosis = diagnose(given, setup);
        if (!is_rounded) require_valid(m, given.matrix(), diagnosis);
        for (const texgen::Finding& finding : diagnosis)
            REQUIRE_MESSAGE((finding.defect == Defect::precision_lost || finding.defect == Defect::rank_below_three),
                            text(m, given.matrix(), diagnosis));
    }
    const auto keystone = texgen::keystone({glm::dvec2(0, 0), {640, 20}, {600, 440}, {30, 480}});
    REQUIRE(keystone);
    CHECK(diagnose(*keystone).empty());
}

TEST_CASE("models of any size, and lenses whose planes are next to one another, are not found fault with") {
    Random random(3711);
    const auto named = [](const auto& setup) {
        const Diagnosis diagnosis = diagnose(setup);
        return std::any_of(diagnosis.begin(), diagnosis.end(),
                           [](const auto& finding) { return finding.defect != Defect::precision_lost; });
    };
    const Projector projector =
        make_projector(texgen::PerspectiveLens{texgen::degrees(40.0), 1.3, 0.1, 100.0},
                       texgen::Aim{{1.0, 2.0, 3.0}, {0.0, 0.3, 0.1}, {0.0, 1.0, 0.0}}, texgen::opengl)
            .value();
    for (int exponent = -1000; exponent <= 1000; ++exponent) {
        const double size = std::ldexp(random.uniform(0.5, 1.0), exponent);
        glm::dmat4 matrix = glm::rotate(glm::translate(glm::dmat4(1.0), 0.5 * random.direction()),
                                        random.uniform(0.0, 6.0), random.direction()) *
                            glm::scale(glm::dmat4(1.0), glm::dvec3(size));
        const texgen::ModelMatrix model(matrix);
        texgen::ProjectionSetup<Object> setup{
            .projector = projector, .world_from_space = model, .texgen = object_linear(projector, model)};
        INFO(exponent, ": ", hex(matrix));
        REQUIRE(!named(setup));
        if (exponent < -148 || exponent > 126) continue;
        setup.texgen = texgen::ObjectTexgen(setup.texgen->rounded());
        REQUIRE(!named(setup));
    }
    // In float, and in double. Depth is a difference of large numbers there: two that once fell on the other low end.
    const auto check = [&](const texgen::PerspectiveLens& lens, const texgen::Aim& aim, Conventions conventions,
                           bool is_float) {
        std::optional<Projector> of_lens = make_projector(lens, aim, conventions);
        if (!of_lens) return;
        if (is_float) {
            of_lens->projection = texgen::ProjectorProjection(of_lens->projection.rounded());
            of_lens->view = texgen::ProjectorView(of_lens->view.rounded());
        }
        texgen::ProjectionSetup<texgen::World> setup{.projector = of_lens,
                                                     .lens = {.z_near = lens.z_near, .z_far = lens.z_far}};
        INFO(hex(lens.z_near), " to ", hex(lens.z_far), is_float ? " in float" : "");
        REQUIRE(!named(setup));
        setup.texgen = texture_from_world(*of_lens);
        REQUIRE(!named(setup));
    };
    for (const auto& [fovy, z_near, z_far] :
         {std::array{35.0, 0x1.999999999999ap+2, 0x1.99999e6b26844p+2}, {43.0, 0x1.cp+1, 0x1.c00005a70aa6ep+1}})
        for (const Conventions& api : {texgen::opengl, texgen::direct3d})
            for (const Conventions& conventions : {api, left_handed(api)})
                for (const bool is_reversed : {false, true})
                    check({texgen::degrees(fovy), 1.3, z_near, z_far, is_reversed},
                          {{1.0, 2.0, 3.0}, {0.0, 0.3, 0.1}, {0.0, 1.0, 0.0}}, conventions, true);
    for (int i = 0; i < 20000; ++i) {
        const double z_near = random.uniform(0.1, 10.0);
        const bool is_float = random.coin();
        const double gap = random.power_of_ten(is_float ? -7.0 : -15.0, -1.0);
        check({texgen::degrees(random.uniform(20.0, 100.0)), 1.3, z_near, z_near * (1.0 + gap), random.coin()},
              {random.direction(), 9.0 * random.direction(), random.direction()}, any_conventions(random), is_float);
    }
}

TEST_CASE("angles in whole radians, and tiny ones, are not taken for degrees") {
    Random random(3712);
    int lenses = 0;
    for (int i = 0; i < 2000; ++i) {
        const bool is_whole = i % 2 == 0;
        const texgen::Angle fovy =
            texgen::radians(is_whole ? random.integer(1, 12) / 4.0 : random.power_of_ten(-9.0, -2.0));
        const texgen::Aim aim{9.0 * random.direction(), 9.0 * random.direction(), random.direction()};
        const std::optional<Projector> projector =
            make_projector(texgen::PerspectiveLens{fovy, 1.5, 0.1, 100.0}, aim, any_conventions(random));
        if (!projector) continue;
        ++lenses;
        const auto takes_for_degrees = [&](const texgen::ProjectionSetup<texgen::World>& setup) {
            const Diagnosis diagnosis = diagnose(setup);
            return std::any_of(diagnosis.begin(), diagnosis.end(),
                               [](const auto& finding) { return finding.defect == Defect::angle_unit_mistaken; });
        };
        INFO(hex(fovy.in_radians()));
        const texgen::WorldTexgen texgen = texture_from_world(*projector);
        REQUIRE(!takes_for_degrees({.projector = projector}));
        REQUIRE(!takes_for_degrees({.projector = projector, .texgen = texgen}));
        REQUIRE(!takes_for_degrees({.texgen = texgen}));
        REQUIRE(!takes_for_degrees({.texgen = texgen, .lens = {.fovy = fovy}}));
        REQUIRE(!takes_for_degrees({.projector = projector, .lens = {.fovy = fovy}}));
    }
    CHECK(lenses > 1500);
}

}  // namespace product_cases
