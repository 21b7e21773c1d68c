// Cameras that were calibrated: the lens K, the pose of OpenCV, and the pixel that both give.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "judges/oracle.hpp"
#include "judges/rational_matrix.hpp"
#include "judges/real.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::exactly;
using support::hex;
using support::infinity_double;
using support::nan_double;
using support::Random;
using support::Rational;
using support::Real;
using support::Worst;
using texgen::PinholeLens;
using texgen::PixelCentre;

PinholeLens random_lens(Random& random) {
    const double width = random.integer(320, 8192), height = random.integer(240, 8192);
    return {.fx = width * random.power_of_ten(-0.5, 1.0),
            .fy = height * random.power_of_ten(-0.5, 1.0),
            .cx = random.coin() ? 0.5 * width + random.uniform(-9.0, 9.0) : random.uniform(-width, 2.0 * width),
            .cy = random.coin() ? 0.5 * height + random.uniform(-9.0, 9.0) : random.uniform(-height, 2.0 * height),
            .width = width,
            .height = height,
            .z_near = random.power_of_ten(-3.0, 0.0),
            .z_far = random.coin() ? infinity_double : random.power_of_ten(0.1, 6.0),
            .centre = random.coin() ? PixelCentre::integer : PixelCentre::half,
            .skew = random.coin() ? 0.0 : width * random.uniform(-0.1, 0.1),
            .reversed_depth = random.coin()};
}

std::string describe(const PinholeLens& lens) {
    return "fx " + hex(lens.fx) + " fy " + hex(lens.fy) + " cx " + hex(lens.cx) + " cy " + hex(lens.cy) + " size " +
           hex(lens.width) + " " + hex(lens.height) + " skew " + hex(lens.skew) +
           (lens.centre == PixelCentre::half ? " half" : " integer");
}

// The pixel K (R x + t), from its definition, counted from the edge of the picture.
std::array<Real, 2> pixel(const PinholeLens& lens, const glm::dmat3& rotation, const glm::dvec3& translation,
                          const glm::vec3& point) {
    std::array<Real, 3> camera;
    for (int row = 0; row < 3; ++row) {
        Real sum(translation[row]);
        for (int column = 0; column < 3; ++column) sum += Real(rotation[column][row]) * Real(point[column]);
        camera[static_cast<std::size_t>(row)] = sum;
    }
    const Real edge = lens.centre == PixelCentre::integer ? Real(0.5) : Real(0);
    return {(Real(lens.fx) * camera[0] + Real(lens.skew) * camera[1]) / camera[2] + Real(lens.cx) + edge,
            Real(lens.fy) * camera[1] / camera[2] + Real(lens.cy) + edge};
}

glm::dvec3 back_into_the_world(const glm::dmat3& rotation, const glm::dvec3& camera) {
    return {glm::dot(rotation[0], camera), glm::dot(rotation[1], camera), glm::dot(rotation[2], camera)};
}

}  // namespace

TEST_CASE("the texture coordinate is the pixel K [R|t] over the size, within 2 ulp of the size, for 100000 cameras") {
    Random random(311);
    Worst worst;
    int projected = 0;
    for (int i = 0; i < 100000; ++i) {
        const PinholeLens lens = random_lens(random);
        const glm::dmat3 rotation(random.rotation());
        const glm::dvec3 translation = random.power_of_ten(-2.0, 4.0) * random.direction();
        // What is seen at a pixel of the picture.
        const double z = random.power_of_ten(-1.0, 4.0);
        const double y = (random.uniform(0.0, lens.height) - lens.cy) / lens.fy * z;
        const double x = (random.uniform(0.0, lens.width) - lens.cx - lens.skew * y / z) / lens.fx * z;
        const glm::vec3 point(back_into_the_world(rotation, glm::dvec3(x, y, z) - translation));

        const bool upright = random.coin();
        const texgen::Conventions conventions = upright ? texgen::direct3d : texgen::opengl;
        const auto projection = pinhole(lens, conventions);
        const auto view = texgen::view_from_opencv(rotation, translation);
        REQUIRE_MESSAGE((projection && view), describe(lens));
        const auto texgen = texture_from_world(texgen::Projector{*projection, *view, conventions});
        glm::vec2 st;
        project(texgen, texgen::world_space(std::span(&point, 1)), std::span(&st, 1));

        const std::array<Real, 2> exact = pixel(lens, rotation, translation, point);
        const Real t = upright ? Real(st.y) : 1 - Real(st.y);
        const double size = std::max(lens.width, lens.height);
        const double ulp = std::ldexp(1.0, std::ilogb(size) - 23);
        // Far outside the picture, where rounding the point to float took it, an ulp of the coordinate is larger.
        if (abs(exact[0]) > 2 * lens.width || abs(exact[1]) > 2 * lens.height) continue;
        ++projected;
        const double error = std::max(static_cast<double>(abs(Real(st.x) * Real(lens.width) - exact[0])),
                                      static_cast<double>(abs(t * Real(lens.height) - exact[1]))) /
                             ulp;
        worst.take(error, [&] { return describe(lens); });
    }
    CHECK(projected > 95000);
    CHECK_MESSAGE(worst.error <= 2.0, worst.input);
    MESSAGE(worst.error, " ulp of the size at most, of ", projected, ": ", worst.input);
}

TEST_CASE("the elements of a pinhole's matrix are within 4 double ulp of exact rationals") {
    Random random(312);
    Worst worst;
    for (int i = 0; i < 5000; ++i) {
        PinholeLens lens = random_lens(random);
        // Centres a few bits from where the term cancels to 0.
        if (i % 3 == 0) lens.cx = 0.5 * lens.width * (1.0 + 0x1p-52 * random.integer(-3, 3));
        if (i % 5 == 0) {
            const double factor = random.power_of_ten(-150.0, 150.0);
            for (double* number : {&lens.fx, &lens.cx, &lens.width, &lens.skew}) *number *= factor;
        }
        const texgen::Conventions conventions = random.coin() ? texgen::vulkan : texgen::opengl;
        const auto projection = pinhole(lens, conventions);
        REQUIRE_MESSAGE(projection, describe(lens));
        const glm::dmat4& m = projection->matrix();
        const Rational edge = lens.centre == PixelCentre::integer ? Rational(1, 2) : Rational(0);
        const Rational width = exactly(lens.width), height = exactly(lens.height);
        const int up = conventions.ndc_y == texgen::NdcY::down ? -1 : 1;
        const std::array<double, 5> computed{m[0][0], m[1][0], m[1][1], m[2][0], m[2][1]};
        const std::array<Rational, 5> exact{
            2 * exactly(lens.fx) / width, -2 * exactly(lens.skew) / width, up * 2 * exactly(lens.fy) / height,
            1 - 2 * (exactly(lens.cx) + edge) / width, up * (2 * (exactly(lens.cy) + edge) / height - 1)};
        for (std::size_t k = 0; k < exact.size(); ++k) {
            const double error = support::ulp_error(computed[k], exact[k]);
            worst.take(error, [&] { return describe(lens); });
        }
        REQUIRE(m[2][3] == -1.0);
        for (const double zero : {m[0][1], m[0][2], m[0][3], m[1][2], m[1][3], m[3][0], m[3][1], m[3][3]})
            REQUIRE(zero == 0.0);
        // Depth is that of the other lenses.
        const auto other = perspective({.fovy = texgen::degrees(60),
                                        .aspect = 1.0,
                                        .z_near = lens.z_near,
                                        .z_far = lens.z_far,
                                        .reversed_depth = lens.reversed_depth},
                                       conventions);
        REQUIRE(m[2][2] == other->matrix()[2][2]);
        REQUIRE(m[3][2] == other->matrix()[3][2]);
    }
    CHECK_MESSAGE(worst.error <= 4.0, worst.input);
    MESSAGE(worst.error, " ulp at most: ", worst.input);
}

TEST_CASE("a pinhole in the middle of the picture is a perspective, and its corner pixels are at the corners") {
    const PinholeLens lens{.fx = 500.0,
                           .fy = 500.0,
                           .cx = 320.0,
                           .cy = 240.0,
                           .width = 640.0,
                           .height = 480.0,
                           .z_near = 0.5,
                           .z_far = 50.0,
                           .centre = PixelCentre::half};
    const glm::dmat4 m = pinhole(lens, texgen::opengl)->matrix();
    const glm::dmat4 symmetric = perspective({.fovy = texgen::radians(2.0 * std::atan(240.0 / 500.0)),
                                              .aspect = 640.0 / 480.0,
                                              .z_near = 0.5,
                                              .z_far = 50.0},
                                             texgen::opengl)
                                     ->matrix();
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            CHECK(m[column][row] == doctest::Approx(symmetric[column][row]).epsilon(1e-14));

    // OpenCV counts the centre of the first pixel as (0, 0): its corner, half a pixel from there, is the slide's.
    PinholeLens of_opencv = lens;
    of_opencv.cx = 319.5;
    of_opencv.cy = 239.5;
    of_opencv.centre = PixelCentre::integer;
    CHECK(pinhole(of_opencv, texgen::opengl)->matrix() == m);
}

TEST_CASE("a pinhole that is none is refused") {
    const PinholeLens good{.fx = 500.0,
                           .fy = 510.0,
                           .cx = 319.5,
                           .cy = 239.5,
                           .width = 640.0,
                           .height = 480.0,
                           .z_near = 0.1,
                           .z_far = infinity_double,
                           .centre = PixelCentre::integer};
    CHECK(pinhole(good, texgen::opengl));
    const auto with = [&](double PinholeLens::*number, double value) {
        PinholeLens lens = good;
        lens.*number = value;
        return pinhole(lens, texgen::vulkan);
    };
    for (const auto number : {&PinholeLens::fx, &PinholeLens::fy, &PinholeLens::width, &PinholeLens::height})
        for (const double bad : {0.0, -1.0, nan_double, infinity_double, 1e308 * 1e10}) CHECK(!with(number, bad));
    for (const auto number : {&PinholeLens::cx, &PinholeLens::cy, &PinholeLens::skew})
        for (const double bad : {nan_double, infinity_double, -infinity_double}) CHECK(!with(number, bad));
    for (const double bad : {0.0, -1.0, nan_double, infinity_double}) CHECK(!with(&PinholeLens::z_near, bad));
    for (const double bad : {0.1, 0.0, -1.0, nan_double}) CHECK(!with(&PinholeLens::z_far, bad));
    CHECK(!with(&PinholeLens::fx, 5e-324));     // the scale of x would be 0
    CHECK(!with(&PinholeLens::width, 5e-324));  // an element would be infinite
    CHECK(with(&PinholeLens::cx, -1e9));        // far off the axis is a lens
    const texgen::Aim aim{.position = {0, 0, 0}, .target = {0, 0, -1}, .up = {0, 1, 0}};
    CHECK(make_projector(good, aim, texgen::opengl));
    CHECK(!make_projector(good, {aim.position, aim.position, aim.up}, texgen::opengl));
}

TEST_CASE(
    "a camera of OpenCV looks along its z, with y down: diag(1, -1, -1) [R|t], and what is no number is refused") {
    Random random(313);
    for (int i = 0; i < 1000; ++i) {
        const glm::dmat3 rotation(random.rotation());
        const glm::dvec3 translation = random.power_of_ten(-3.0, 9.0) * random.direction();
        const auto view = texgen::view_from_opencv(rotation, translation);
        REQUIRE(view);
        const glm::dmat4& m = view->matrix();
        for (int row = 0; row < 3; ++row) {
            const double sign = row == 0 ? 1.0 : -1.0;
            for (int column = 0; column < 3; ++column) REQUIRE(m[column][row] == sign * rotation[column][row]);
            REQUIRE(m[3][row] == sign * translation[row]);
        }
        REQUIRE((m[0].w == 0.0 && m[1].w == 0.0 && m[2].w == 0.0 && m[3].w == 1.0));
    }
    for (const double bad : {nan_double, infinity_double, -infinity_double}) {
        glm::dmat3 rotation(1.0);
        CHECK(!texgen::view_from_opencv(rotation, {0.0, bad, 0.0}));
        rotation[1][2] = bad;
        CHECK(!texgen::view_from_opencv(rotation, {0.0, 0.0, 0.0}));
    }
}
