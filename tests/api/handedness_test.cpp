// Left-handed worlds: DirectX's own formulas, from their published definitions, and the mirror that makes a
// right-handed world of one.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "judges/real.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::hex;
using support::Random;
using support::Real;
using support::RealMatrix;
using support::RealVector;
using texgen::Aim;
using texgen::Conventions;
using texgen::Handedness;
using texgen::left_handed;
using texgen::Projector;

// DirectXMath's functions as their documentation states them, for row vectors: element [row][column] of M in v M.
namespace direct3d_math {

RealMatrix look_at(const Aim& aim, Handedness handedness) {
    const RealVector eye = support::real(aim.position), at = support::real(aim.target);
    const RealVector zaxis = handedness == Handedness::left
                                 ? support::normalized({at[0] - eye[0], at[1] - eye[1], at[2] - eye[2]})
                                 : support::normalized({eye[0] - at[0], eye[1] - at[1], eye[2] - at[2]});
    const RealVector xaxis = support::normalized(support::cross(support::real(aim.up), zaxis));
    const RealVector yaxis = support::cross(zaxis, xaxis);
    RealMatrix m = support::identity();
    for (std::size_t i = 0; i < 3; ++i) {
        m[i][0] = xaxis[i];
        m[i][1] = yaxis[i];
        m[i][2] = zaxis[i];
    }
    m[3] = {-support::dot(xaxis, eye), -support::dot(yaxis, eye), -support::dot(zaxis, eye), Real(1)};
    return m;
}

RealMatrix perspective_fov_lh(double fovy, double aspect, double zn, double zf) {
    const Real height = 1 / tan(Real(Real(fovy) / 2)), range = Real(zf) / (Real(zf) - Real(zn));
    RealMatrix m{};
    m[0][0] = height / Real(aspect);
    m[1][1] = height;
    m[2][2] = range;
    m[2][3] = 1;
    m[3][2] = -range * Real(zn);
    return m;
}

RealMatrix perspective_fov_rh(double fovy, double aspect, double zn, double zf) {
    const Real range = Real(zf) / (Real(zn) - Real(zf));
    RealMatrix m = perspective_fov_lh(fovy, aspect, zn, zf);
    m[2][2] = range;
    m[2][3] = -1;
    m[3][2] = range * Real(zn);
    return m;
}

RealMatrix perspective_off_center_lh(double l, double r, double b, double t, double zn, double zf) {
    const Real width = Real(r) - Real(l), height = Real(t) - Real(b), range = Real(zf) / (Real(zf) - Real(zn));
    RealMatrix m{};
    m[0][0] = 2 * Real(zn) / width;
    m[1][1] = 2 * Real(zn) / height;
    m[2] = {(Real(l) + Real(r)) / -width, (Real(t) + Real(b)) / -height, range, Real(1)};
    m[3][2] = -range * Real(zn);
    return m;
}

RealMatrix orthographic_off_center_lh(double l, double r, double b, double t, double zn, double zf) {
    const Real width = Real(r) - Real(l), height = Real(t) - Real(b), depth = Real(zf) - Real(zn);
    RealMatrix m{};
    m[0][0] = 2 / width;
    m[1][1] = 2 / height;
    m[2][2] = 1 / depth;
    m[3] = {(Real(l) + Real(r)) / -width, (Real(t) + Real(b)) / -height, -Real(zn) / depth, Real(1)};
    return m;
}

}  // namespace direct3d_math

// The worst element of a matrix against one of row vectors, in double ulps of the element.
double worst_error(const glm::dmat4& computed, const RealMatrix& row_vectors) {
    double worst = 0.0;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) {
            const Real& exact = row_vectors[static_cast<std::size_t>(column)][static_cast<std::size_t>(row)];
            const double value = computed[column][row];
            worst =
                std::max(worst, exact == 0 ? (value == 0.0 ? 0.0 : HUGE_VAL) : support::error_in_ulps(value, exact));
        }
    return worst;
}

Aim random_aim(Random& random) {
    const glm::dvec3 position = random.power_of_ten(-2.0, 6.0) * random.direction();
    return {position, position + random.power_of_ten(-2.0, 4.0) * random.direction(), random.direction()};
}

glm::dvec3 in_the_mirror(const glm::dvec3& v) { return {v.x, v.y, -v.z}; }
Aim in_the_mirror(const Aim& aim) {
    return {in_the_mirror(aim.position), in_the_mirror(aim.target), in_the_mirror(aim.up)};
}

}  // namespace

TEST_CASE(
    "left-handed lenses are DirectX's: PerspectiveFovLH, PerspectiveOffCenterLH, OrthographicOffCenterLH, within 4 "
    "ulp") {
    Random random(321);
    const Conventions conventions = left_handed(texgen::direct3d);
    double worst = 0.0;
    for (int i = 0; i < 3000; ++i) {
        const double fovy = random.uniform(0.01, 3.1), aspect = random.power_of_ten(-1.0, 1.0);
        const double zn = random.power_of_ten(-3.0, 1.0), zf = zn * random.power_of_ten(0.01, 6.0);
        const double l = random.uniform(-3.0, 3.0), r = random.uniform(-3.0, 3.0);
        const double b = random.uniform(-3.0, 3.0), t = random.uniform(-3.0, 3.0);
        const texgen::PerspectiveLens lens{texgen::radians(fovy), aspect, zn, zf};
        const auto error = [&](const auto& projection, const RealMatrix& exact) {
            worst = std::max(worst, worst_error(projection.value().matrix(), exact));
        };
        error(perspective(lens, conventions), direct3d_math::perspective_fov_lh(fovy, aspect, zn, zf));
        error(perspective(lens, texgen::direct3d), direct3d_math::perspective_fov_rh(fovy, aspect, zn, zf));
        error(frustum({l, r, b, t, zn, zf}, conventions), direct3d_math::perspective_off_center_lh(l, r, b, t, zn, zf));
        error(orthographic({l, r, b, t, zn, zf}, conventions),
              direct3d_math::orthographic_off_center_lh(l, r, b, t, zn, zf));
    }
    CHECK(worst <= 4.0);
    MESSAGE(worst, " ulp at most");
}

TEST_CASE(
    "look_at in a left-handed world is LookAtLH, and in a right-handed one LookAtRH, within 4 ulp of a rotation's 1") {
    Random random(322);
    for (const Handedness handedness : {Handedness::right, Handedness::left}) {
        support::Worst worst;
        for (int i = 0; i < 2000; ++i) {
            const Aim aim = random_aim(random);
            const auto view = look_at(aim, handedness);
            REQUIRE(view);
            const RealMatrix exact = direct3d_math::look_at(aim, handedness);
            for (int row = 0; row < 3; ++row) {
                double size = 0.0;
                for (int column = 0; column < 4; ++column) {
                    const Real& element = exact[static_cast<std::size_t>(column)][static_cast<std::size_t>(row)];
                    const double error = static_cast<double>(abs(Real(view->matrix()[column][row]) - element));
                    // The translation's terms are as long as the position; so is what the rotation's rounding does to
                    // it.
                    size = column < 3 ? 1.0 : glm::length(aim.position);
                    const double ulps = error / (size * 0x1p-52);
                    worst.take(ulps, [&] { return hex(aim.position) + " " + hex(aim.target) + " " + hex(aim.up); });
                }
            }
        }
        CHECK_MESSAGE(worst.error <= 4.0, worst.input);
        MESSAGE(worst.error, " ulp at most");
    }
}

TEST_CASE(
    "from {0, 0, 0} to {0, 0, 1} at 90 degrees the point (5, 2, 10) of a left-handed world is at s = 0.75, t = 0.4") {
    const texgen::PerspectiveLens lens{.fovy = texgen::degrees(90), .aspect = 1.0, .z_near = 0.1, .z_far = 100.0};
    const Aim aim{.position = {0, 0, 0}, .target = {0, 0, 1}, .up = {0, 1, 0}};
    const glm::vec3 point(5.0f, 2.0f, 10.0f);
    const auto st = [&](Conventions conventions) {
        glm::vec2 result;
        project(texture_from_world(make_projector(lens, aim, conventions).value()),
                texgen::world_space(std::span(&point, 1)), std::span(&result, 1));
        return result;
    };
    CHECK(st(left_handed(texgen::direct3d)) == glm::vec2(0.75f, 0.4f));
    CHECK(st(left_handed(texgen::opengl)) == glm::vec2(0.75f, 0.6f));
    CHECK(st(texgen::direct3d) == glm::vec2(0.25f, 0.4f));
}

TEST_CASE("a left-handed world is a right-handed one in a mirror: the same bits for every lens, API and region") {
    Random random(323);
    for (int i = 0; i < 2000; ++i) {
        const Conventions api = std::array{texgen::opengl, texgen::direct3d, texgen::metal,
                                           texgen::vulkan}[static_cast<std::size_t>(i % 4)];
        const Aim aim = random_aim(random);
        const double z_near = random.power_of_ten(-2.0, 1.0), z_far = z_near * random.power_of_ten(0.1, 4.0);
        const texgen::PerspectiveLens perspective{texgen::degrees(random.uniform(5.0, 170.0)), 1.5, z_near, z_far,
                                                  random.coin()};
        const texgen::FrustumLens frustum{
            random.uniform(-2.0, -1.0), random.uniform(-0.9, 2.0), -1.0, 0.5, z_near, z_far};
        const texgen::OrthographicLens orthographic{-2.0, random.uniform(-1.9, 2.0), -1.0, 0.5, -z_near, z_far};
        const texgen::PinholeLens pinhole{700.0,
                                          710.0,
                                          random.uniform(0.0, 640.0),
                                          250.0,
                                          640.0,
                                          480.0,
                                          z_near,
                                          z_far,
                                          texgen::PixelCentre::integer,
                                          random.uniform(-3.0, 3.0)};
        const auto compare = [&](const auto& lens) {
            const auto left = make_projector(lens, aim, left_handed(api));
            const auto right = make_projector(lens, in_the_mirror(aim), api);
            REQUIRE(left);
            REQUIRE(right);
            const glm::dmat4 of_left = texture_from_world(*left, texgen::rectangle_texture(640, 480)).matrix();
            glm::dmat4 of_right = texture_from_world(*right, texgen::rectangle_texture(640, 480)).matrix();
            of_right[2] = -of_right[2];
            REQUIRE(of_left == of_right);
            // In front is in front: the middle of the view has a positive q.
            const glm::dvec4 ahead = of_left * glm::dvec4(aim.target, 1.0);
            REQUIRE(ahead.w > 0.0);
        };
        compare(perspective);
        compare(frustum);
        compare(orthographic);
        compare(pinhole);
    }
}

TEST_CASE("OpenCV's camera in a left-handed world: the pose of mirrored points, with a reflection for a rotation") {
    Random random(324);
    const texgen::PinholeLens lens{700.0, 710.0, 311.0, 250.0, 640.0, 480.0, 0.1, 100.0, texgen::PixelCentre::integer};
    for (int i = 0; i < 500; ++i) {
        glm::dmat3 rotation(random.rotation());
        const glm::dvec3 translation = 5.0 * random.direction();
        const Projector right{*pinhole(lens, texgen::opengl), *texgen::view_from_opencv(rotation, translation),
                              texgen::opengl};
        rotation[2] = -rotation[2];  // R times diag(1, 1, -1)
        const auto view = texgen::view_from_opencv(rotation, translation, Handedness::left);
        REQUIRE(view);
        const Projector left{*pinhole(lens, left_handed(texgen::opengl)), *view, left_handed(texgen::opengl)};
        glm::dmat4 of_right = texture_from_world(right).matrix();
        of_right[2] = -of_right[2];
        REQUIRE(texture_from_world(left).matrix() == of_right);
    }
}
