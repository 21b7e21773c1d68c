// Products that users' own code gets right, with numbers that could be those of a mistake: none is found fault with.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "api/diagnose_product_test/users_code.hpp"
#include "support/random.hpp"
#include "support/windows.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/scale_bias.hpp"

namespace product_cases {

TEST_CASE("the quarters of a lens of 90 degrees are not found fault with, whose sides are as long as near is far") {
    Random random(641);
    for (int i = 0; i < 4096; ++i) {
        const auto bit = [&](int k) { return (i >> k) % 2 != 0; };
        Meant m;
        m.kind = LensKind::frustum;
        m.aim = {{2.0 + random.integer(0, 9), 5.0, 5.0}, {-2.0, -4.0, 0.0}, {0.0, 1.0, 0.0}};
        m.conventions = any_conventions(random);
        m.depth = bit(0) ? DepthMapping::unit : DepthMapping::ndc;
        m.z_near = bit(1) ? 0.125 : 0.02 * random.integer(1, 30);
        m.z_far = (bit(2) ? 1e4 : 40.0) * m.z_near;
        const double height = m.z_near * (bit(3) ? 1.0 : 2.0), width = height * (bit(4) ? 1.0 : 1.5);
        m.left = bit(5) ? 0.0 : -width, m.bottom = bit(6) ? 0.0 : -height;
        m.right = m.left + width, m.top = m.bottom + height;
        const texgen::WorldTexgen texgen = texture_from_world(*right_projector(m), m.region, m.depth);
        const texgen::Projector p = *right_projector(m);
        const glm::mat4 in_float =
            scale_bias(m.conventions, m.region, m.depth).rounded() * p.projection.rounded() * p.view.rounded();
        const glm::dmat4 given = bit(7)   ? texgen.matrix()
                                 : bit(9) ? glm::dmat4(texgen.rounded())
                                          : glm::dmat4(in_float);
        for (const Told told : {Told::nothing, Told::projector}) {
            const bool has_conventions = bit(8);
            require_valid(m, given, diagnosis_of(m, In::world, right_projector(m), told, has_conventions, given));
        }
    }
}

TEST_CASE("the sides of an object that is stretched by an unknown pose are not taken for those of the lens") {
    Random random(642);
    for (int i = 0; i < 2000; ++i) {
        Meant m = human(Mistake::none, random);
        m.aspect = random.coin() ? 1.5 : 2.0;
        m.depth = DepthMapping::unit;
        const int axis = random.integer(0, 2);  // level, along an axis of the world
        m.aim.target = m.aim.position;
        m.aim.target[axis == 1 ? 0 : axis] += random.coin() ? 5.0 : -5.0;
        m.pose[1] *= random.coin() ? 1.0 / (m.aspect * m.aspect) : m.aspect * m.aspect;
        const std::optional<Projector> projector = right_projector(m);
        const glm::dmat4 texgen = object_linear(*projector, texgen::ModelMatrix(m.pose), m.region, m.depth).matrix();
        require_valid(
            m, texgen,
            diagnose(texgen::ObjectTexgen(texgen), {.projector = projector, .region = m.region, .depth = m.depth}));
    }
}

TEST_CASE("through a pose far away a lens shows no more than the rounding of the matrix leaves of it there") {
    Random random(645);
    for (int i = 0; i < 20000; ++i) {
        const auto place = [&](double reach) {
            const double x = random.uniform(-reach, reach), y = random.uniform(-reach, reach);
            return glm::dvec3(x, y, random.uniform(-reach, reach));
        };
        Meant m;
        m.conventions = texgen::direct3d;
        m.depth = DepthMapping::unit;
        m.aim = {place(20.0), {3.0, 5.5, 1.25}, {0.0, 1.0, 0.0}};
        m.pose = glm::dmat4(glm::dvec4(0.0, 1.0, 0.0, 0.0), glm::dvec4(-1.0, 0.0, 0.0, 0.0),
                            glm::dvec4(0.0, 0.0, 1.0, 0.0), glm::dvec4(place(1e7), 1.0));
        m.z_near = i % 2 == 0 ? 10.0 : 0.05;
        m.z_far = i % 2 == 0 ? 30.0 : 5000.0;
        const texgen::ObjectTexgen texgen = object_linear(*right_projector(m), texgen::ModelMatrix(m.pose));
        // The numbers that people write are looked for in double, the planes that are known in float as well.
        const bool in_float = i % 2 != 0;
        const texgen::ObjectTexgen given = in_float ? texgen::ObjectTexgen(texgen.rounded()) : texgen;
        texgen::ProjectionSetup<Object> setup{.world_from_space = texgen::ModelMatrix(m.pose),
                                              .conventions = m.conventions};
        if (in_float) setup.lens.z_near = m.z_near;
        require_valid(m, given.matrix(), diagnose(given, setup));
    }
}

TEST_CASE("factors that commute are not taken for a wrong order, where floats fit it no worse") {
    Random random(643);
    for (int i = 0; i < 20000; ++i) {
        Meant m = human(Mistake::none, random);
        m.depth = DepthMapping::unit;
        m.aim.position = {0.0, 0.0, 0.0};
        if (random.coin()) m.aim.target = {0.0, 0.0, m.is_left() ? 5.0 : -5.0};
        m.pose = glm::dmat4(1.0);
        for (int k = 0; k < 3; ++k) m.pose[k] *= 74.6;
        const std::optional<Projector> projector = right_projector(m);
        const glm::dmat4 texgen = made<float>(m, Mistake::none, random);
        require_valid(m, texgen, diagnosis_of(m, In::object, projector, Told::projector, false, texgen));
    }
}

TEST_CASE("factors that cancel, as a lamp's view and its camera's pose, leave floats that fit no wrong order better") {
    Random random(646);
    for (int i = 0; i < 100000; ++i) {
        Meant m;
        m.conventions = any_conventions(random);
        m.kind = random.coin() ? LensKind::orthographic : LensKind::perspective;
        m.fovy = 10.0 * random.integer(3, 12);
        m.z_far = std::pow(10.0, random.integer(1, 3));
        m.right = m.top = random.integer(1, 50);
        m.left = m.bottom = -m.right;
        const auto place = [&] {
            const double x = random.integer(-10, 10), y = random.integer(-10, 10);
            return glm::dvec3(x, y, random.integer(-10, 10));
        };
        m.aim = {place(), place(), {0.0, 1.0, 0.0}};
        if (m.aim.target.x == m.aim.position.x && m.aim.target.z == m.aim.position.z) continue;
        // The view of a light that looks along z from the origin is 1: P V is V P.
        const bool is_lamp = i % 2 == 0;
        if (!is_lamp) {
            m.aim = {{0.0, 0.0, 0.0}, {0.0, 0.0, m.is_left() ? 1.0 : -1.0}, {0.0, 1.0, 0.0}};
            m.pose = random.rotation();
            m.pose[3] = glm::dvec4(random.power_of_ten(0.0, 3.0) * random.direction(), 1.0);
        }
        const glm::mat4 s = Code<float>::bias(m), p = Code<float>::lens(m), v = Code<float>::view(m);
        const glm::mat4 pose = is_lamp ? glm::inverse(v) : Code<float>::pose(m);
        const glm::dmat4 texgen(random.coin() ? s * p * v * pose : s * (p * (v * pose)));
        m.pose = pose;
        const bool is_double = is_lamp && random.coin();  // the pose that is told of
        if (is_double) m.pose = glm::inverse(glm::dmat4(v));
        require_valid(
            m, texgen,
            diagnosis_of(m, is_lamp ? In::eye : In::object, own_projector(m), Told::projector, false, texgen));
    }
}

TEST_CASE("planes that are no round numbers only in the units of an object are not found fault with") {
    Meant m;
    m.aim = {{1.0, 5.0, 2.0}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    for (const DepthRange range : {DepthRange::negative_one_to_one, DepthRange::zero_to_one}) {
        m.conventions.depth = range;
        for (int scale = 1; scale < 10; ++scale) {
            for (int i = 0; i < 3; ++i) m.pose[i][i] = scale;
            for (int ratio = 2; ratio < 100; ++ratio) {
                for (int first = 1; first < 10; ++first) {
                    m.z_near = 0.1 * first;
                    m.z_far = ratio * m.z_near;
                    const glm::dmat4 clip = Code<double>::lens(m) * Code<double>::view(m);
                    const glm::dmat4 texgen = Code<double>::bias(m) * clip * m.pose;
                    require_valid(m, texgen, diagnosis_of(m, In::object, std::nullopt, Told::nothing, true, texgen));
                }
            }
        }
    }
}

TEST_CASE("an angle or an aspect that a stretched object, whose pose is not given, shows by chance is none") {
    // Each is one of millions that a search has found.
    const Conventions ndc{DepthRange::zero_to_one, NdcY::up, TextureOrigin::top_left, texgen::Handedness::right};
    glm::dmat4 stretched(1.0);
    stretched[0].x = 0x1.10a6bf42cadddp-1;
    stretched[1].y = 0x1.f464dbf40864dp-1;
    stretched[2].z = 0x1.05a4ef11fb949p-1;
    stretched[3] = {4.0, 0.0, -14.0, 1.0};
    const texgen::TextureRegion tile = texgen::atlas_tile({0.25, 0.5}, {1.0, 1.0});
    const Projector level =
        make_projector(
            texgen::PerspectiveLens{texgen::degrees(0x1.b16311424236ep+5), 0x1.583b4d5d15089p+1, 0.5,
                                    0x1.ae7f9f3d27ad4p+17},
            texgen::Aim{{0.0, -3.5, 0x1.19bc29ca27f35p+7}, {0.0, -2.5, 0x1.19bc29ca27f35p+7}, {0.0, 0.0, -1.0}}, ndc)
            .value();
    const auto of_level = object_linear(level, texgen::ModelMatrix(stretched), tile, DepthMapping::ndc).rounded();
    CHECK(diagnose(texgen::ObjectTexgen(of_level), {.region = tile, .depth = DepthMapping::ndc, .conventions = ndc})
              .empty());

    const Conventions left{DepthRange::zero_to_one, NdcY::down, TextureOrigin::top_left, texgen::Handedness::left};
    const Projector mirrored =
        make_projector(texgen::FrustumLens{0x1.f299f26348105p-6, -0x1.88a2eada892dap-1, -0x1.0eb3aad514c56p+0,
                                           0x1.494b659823dd7p-5, 0x1.0eb3aad514c56p+0, 0x1.9d0ee68b62d1bp+16},
                       texgen::Aim{{-0x1.0b8331f08e874p+3, -0x1.68p+6, -0x1.92c785ae03caap-11},
                                   {-0x1.f4eceef1281f9p+2, -0x1.4a0fa6c537d56p+6, 0x1.2e368ba8b60dbp+5},
                                   {0.0, 1.0, 0.0}},
                       left)
            .value();
    glm::dmat4 higher(1.0);
    higher[1].y = 2.0;
    const auto of_mirrored = object_linear(mirrored, texgen::ModelMatrix(higher)).rounded();
    CHECK(diagnose(texgen::ObjectTexgen(of_mirrored), {.projector = mirrored, .lens = {.mirrored = true}}).empty());
}

TEST_CASE("what users' own code gets right is not found fault with, whatever else is told") {
    Random random(623);
    const int count = valid_setups();
    for (int i = 0; i < count; ++i) {
        // All numbers as people write them, or some, or none.
        Meant m = random.coin() ? human(Mistake::none, random) : any_meant(Mistake::none, random);
        if (random.coin()) m.fovy = random.uniform(0.5, 170.0);
        if (random.coin()) m.z_near = random.power_of_ten(-2.0, 0.0);
        m.z_far = std::max(m.z_far, 3.0 * m.z_near);
        const bool is_quarter = random.integer(0, 7) == 0;
        if (is_quarter) {
            // Of a lens, of numbers that are as round as its corner; without its depth range it is that of a whole one.
            m = human(Mistake::none, random);
            m.conventions.depth = DepthRange::negative_one_to_one;
            m.depth = DepthMapping::unit;
            m.kind = LensKind::frustum;
            m.z_far = m.z_near * random.integer(2, 50);  // in float the planes do not say it where far is farther
            m.left = m.bottom = 0.0;
            m.right = m.z_near * std::ldexp(1.0, random.integer(-2, 1));
            m.top = m.z_near * std::ldexp(1.0, random.integer(-2, 1));
        }
        const In in = put_in_space(m, random);
        const std::optional<Projector> projector = right_projector(m);
        if (!projector) continue;
        const glm::dmat4 texgen = made_somehow(m, Mistake::none, random);
        const Told told = static_cast<Told>(random.integer(0, 2));
        require_valid(m, texgen,
                      diagnosis_of(m, in, random.coin() ? *projector : own_projector(m), told,
                                   is_quarter || random.coin(), texgen));
    }
}

TEST_CASE(
    "an angle that degrees make as radians is one where the picture stands upright, or floats leave it in doubt") {
    Random random(630);
    for (int i = 0; i < 1000; ++i) {
        Meant m = human(Mistake::none, random);
        const double number = random.coin() ? 30.0 : 60.0;
        m.fovy = glm::degrees(2.0 * std::atan(std::fabs(std::tan(0.5 * number))));
        const In in = random.coin() ? In::object : In::world;
        if (in == In::world) m.pose = glm::dmat4(1.0);
        const glm::dmat4 upright = made<double>(m, Mistake::none, random);
        require_valid(m, upright, diagnosis_of(m, in, std::nullopt, Told::nothing, true, upright));
        // Which way t grows is not told: it may hang down as a picture whose origin is at its top.
        const glm::dmat4 in_float = made<float>(m, Mistake::none, random);
        require_valid(m, in_float, diagnosis_of(m, in, std::nullopt, Told::nothing, false, in_float));
        m.aim.up = random.direction();
        const glm::dmat4 askew = made<float>(m, Mistake::none, random);
        require_valid(m, askew, diagnosis_of(m, in, std::nullopt, Told::nothing, true, askew));
    }
}

}  // namespace product_cases
