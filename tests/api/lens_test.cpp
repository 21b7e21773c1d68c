// Lenses against 400-bit arithmetic, from 0.1 to 179.99 degrees.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "judges/real.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/projector.hpp"

namespace {

using support::hex;
using support::infinity_double;
using support::Random;
using support::Real;
using support::Worst;
using texgen::Conventions;
using texgen::DepthRange;
using texgen::NdcY;
using texgen::PerspectiveLens;

constexpr double bound_in_ulps = 4.0;  // as perspective() states it

Conventions with(DepthRange depth, NdcY y = NdcY::up) {
    return {depth, y, texgen::TextureOrigin::bottom_left, texgen::Handedness::right};
}

struct Depth {
    Real scale, offset;
};

// Clip z = scale * z_eye + offset: the one map of that form that takes near and far to the ends of the range.
Depth exact_depth(double z_near, double z_far, bool reversed, DepthRange range) {
    const Real low = range == DepthRange::zero_to_one ? 0 : -1, high = 1;
    const Real at_near = reversed ? high : low, at_far = reversed ? low : high;
    // At z_eye = -z the NDC is (-scale z + offset) / z = at(z).
    if (!(z_far < infinity_double)) return {-at_far, (at_near - at_far) * Real(z_near)};
    const Real near(z_near), far(z_far);
    return {(at_near * near - at_far * far) / (far - near), (at_near - at_far) * near * far / (far - near)};
}

// The same of parallel rays, where the NDC is clip z.
Depth exact_parallel_depth(double z_near, double z_far, bool reversed, DepthRange range) {
    const Real low = range == DepthRange::zero_to_one ? 0 : -1, high = 1;
    const Real at_near = reversed ? high : low, at_far = reversed ? low : high;
    const Real near(z_near), far(z_far);
    return {(at_near - at_far) / (far - near), (at_near * far - at_far * near) / (far - near)};
}

std::string describe(const PerspectiveLens& lens) {
    return "fovy " + hex(lens.fovy.in_radians()) + " aspect " + hex(lens.aspect) + " near " + hex(lens.z_near) +
           " far " + hex(lens.z_far) + (lens.reversed_depth ? " reversed" : "");
}

}  // namespace

TEST_CASE("a perspective's elements are within 4 double ulp from 0.1 to 179.99 degrees, whatever near and far") {
    Random random(71);
    Worst worst;
    int narrow = 0, wide = 0, infinite = 0, close_planes = 0, far_planes = 0;
    for (int i = 0; i < 3000; ++i) {
        // Half of the sweep is at its ends, by the logarithm of the distance to 0 or to 180 degrees.
        double fovy = random.uniform(0.1, 179.99);
        if (i % 4 == 0) fovy = random.power_of_ten(-1.0, 0.5);
        if (i % 4 == 1) fovy = 180.0 - random.power_of_ten(-2.0, 0.5);
        PerspectiveLens lens{.fovy = texgen::degrees(fovy),
                             .aspect = random.power_of_ten(-2.0, 2.0),
                             .z_near = random.power_of_ten(-6.0, 3.0),
                             .z_far = infinity_double,
                             .reversed_depth = random.coin()};
        switch (random.integer(0, 3)) {
            case 0:
                break;
            case 1:
                lens.z_far = lens.z_near * random.power_of_ten(0.1, 9.0);
                break;
            case 2:
                lens.z_far = lens.z_near * (1.0 + random.power_of_ten(-12.0, -1.0));
                break;
            default:
                lens.z_far = lens.z_near * random.power_of_ten(9.0, 30.0);
                break;
        }
        narrow += fovy < 1.0;
        wide += fovy > 179.0;
        infinite += !(lens.z_far < infinity_double);
        close_planes += lens.z_far < 1.001 * lens.z_near;
        far_planes += lens.z_far > 1e9 * lens.z_near;
        const DepthRange range = random.coin() ? DepthRange::zero_to_one : DepthRange::negative_one_to_one;
        const auto projection = perspective(lens, with(range));
        REQUIRE_MESSAGE(projection, describe(lens));
        const glm::dmat4& m = projection->matrix();
        const Real focal_length = 1 / tan(Real(Real(lens.fovy.in_radians()) / 2));
        const Depth depth = exact_depth(lens.z_near, lens.z_far, lens.reversed_depth, range);
        const std::array<double, 4> computed{m[0][0], m[1][1], m[2][2], m[3][2]};
        const std::array<Real, 4> exact{focal_length / Real(lens.aspect), focal_length, depth.scale, depth.offset};
        for (std::size_t k = 0; k < 4; ++k) {
            const double error = exact[k] == 0 ? (computed[k] == 0.0 ? 0.0 : infinity_double)
                                               : support::error_in_ulps(computed[k], exact[k]);
            worst.take(error, [&] { return describe(lens); });
        }
        REQUIRE(m[2][3] == -1.0);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) {
                const bool element =
                    (column == row && column < 3) || (column == 3 && row == 2) || (column == 2 && row == 3);
                if (!element) REQUIRE(m[column][row] == 0.0);
            }
    }
    CHECK(narrow > 200);
    CHECK(wide > 200);
    CHECK(infinite > 500);
    CHECK(close_planes > 400);
    CHECK(far_planes > 500);
    CHECK_MESSAGE(worst.error <= bound_in_ulps, worst.input);
    MESSAGE(worst.error, " ulp at most: ", worst.input);
}

TEST_CASE("an angle given in degrees makes a lens that is right to the last bit of a float") {
    const Real pi = 4 * atan(Real(1));
    Random random(72);
    for (int i = 0; i < 1000; ++i) {
        double fovy = random.uniform(0.1, 179.99);
        if (i % 4 == 0) fovy = random.power_of_ten(-1.0, 0.5);
        if (i % 4 == 1) fovy = 180.0 - random.power_of_ten(-2.0, 0.5);
        const auto projection =
            perspective({.fovy = texgen::degrees(fovy), .aspect = 1.0, .z_near = 0.1, .z_far = 100.0}, texgen::opengl);
        REQUIRE(projection);
        const Real exact = 1 / tan(Real(Real(fovy) * pi / 360));
        const Real error = abs(Real(projection->matrix()[1][1]) - exact) / exact;
        REQUIRE_MESSAGE(error < Real(1e-11), hex(fovy));
        const double float_ulp = 0x1p-23 * std::exp2(std::floor(std::log2(static_cast<double>(exact))));
        const Real rounded_error = abs(Real(projection->rounded()[1][1]) - exact);
        REQUIRE_MESSAGE(rounded_error <= Real(0.5001 * float_ulp), hex(fovy));
    }
}

TEST_CASE("an off-axis frustum is within 4 double ulp, and its corners fall on the corners of the slide") {
    Random random(73);
    double worst = 0.0;
    for (int i = 0; i < 1000; ++i) {
        const double left = random.uniform(-2.0, 2.0), bottom = random.uniform(-2.0, 2.0);
        const texgen::FrustumLens lens{.left = left,
                                       .right = left + random.power_of_ten(-3.0, 1.0) * (random.coin() ? 1.0 : -1.0),
                                       .bottom = bottom,
                                       .top = bottom + random.power_of_ten(-3.0, 1.0),
                                       .z_near = random.power_of_ten(-3.0, 3.0),
                                       .z_far = random.coin() ? 1e4 : 1e33,
                                       .reversed_depth = random.coin()};
        const DepthRange range = random.coin() ? DepthRange::zero_to_one : DepthRange::negative_one_to_one;
        const auto projection = frustum(lens, with(range));
        REQUIRE(projection);
        const glm::dmat4& m = projection->matrix();
        const Depth depth = exact_depth(lens.z_near, lens.z_far, lens.reversed_depth, range);
        const Real width = Real(lens.right) - Real(lens.left), height = Real(lens.top) - Real(lens.bottom);
        const std::array<Real, 6> exact{2 * Real(lens.z_near) / width,
                                        2 * Real(lens.z_near) / height,
                                        (Real(lens.right) + Real(lens.left)) / width,
                                        (Real(lens.top) + Real(lens.bottom)) / height,
                                        depth.scale,
                                        depth.offset};
        const std::array<double, 6> computed{m[0][0], m[1][1], m[2][0], m[2][1], m[2][2], m[3][2]};
        for (std::size_t k = 0; k < 6; ++k) worst = std::max(worst, support::error_in_ulps(computed[k], exact[k]));
        for (const bool right : {false, true}) {
            for (const bool top : {false, true}) {
                const glm::dvec4 clip =
                    m * glm::dvec4(right ? lens.right : lens.left, top ? lens.top : lens.bottom, -lens.z_near, 1.0);
                // The element (right + left) / (right - left) may be large: its rounding is what the corner shows.
                const double slack = 4e-16 * (4.0 + std::fabs(m[2][0]) + std::fabs(m[2][1]));
                REQUIRE(std::fabs(clip.x / clip.w - (right ? 1.0 : -1.0)) <= slack);
                REQUIRE(std::fabs(clip.y / clip.w - (top ? 1.0 : -1.0)) <= slack);
            }
        }
    }
    CHECK(worst <= bound_in_ulps);
}

TEST_CASE("an orthographic lens is within 4 double ulp") {
    Random random(74);
    double worst = 0.0;
    for (int i = 0; i < 1000; ++i) {
        const double left = random.uniform(-1e3, 1e3), bottom = random.uniform(-1e3, 1e3);
        const double z_near = random.uniform(-1e3, 1e3);
        const texgen::OrthographicLens lens{.left = left,
                                            .right = left + random.power_of_ten(-3.0, 4.0),
                                            .bottom = bottom,
                                            .top = bottom - random.power_of_ten(-3.0, 4.0),
                                            .z_near = z_near,
                                            .z_far = z_near + random.power_of_ten(-3.0, 4.0),
                                            .reversed_depth = random.coin()};
        const DepthRange range = random.coin() ? DepthRange::zero_to_one : DepthRange::negative_one_to_one;
        const auto projection = orthographic(lens, with(range));
        REQUIRE(projection);
        const glm::dmat4& m = projection->matrix();
        const Real width = Real(lens.right) - Real(lens.left), height = Real(lens.top) - Real(lens.bottom);
        const Depth depth = exact_parallel_depth(lens.z_near, lens.z_far, lens.reversed_depth, range);
        const std::array<Real, 6> exact{2 / width,
                                        2 / height,
                                        depth.scale,
                                        -(Real(lens.right) + Real(lens.left)) / width,
                                        -(Real(lens.top) + Real(lens.bottom)) / height,
                                        depth.offset};
        const std::array<double, 6> computed{m[0][0], m[1][1], m[2][2], m[3][0], m[3][1], m[3][2]};
        for (std::size_t k = 0; k < 6; ++k) worst = std::max(worst, support::error_in_ulps(computed[k], exact[k]));
        REQUIRE(m[3][3] == 1.0);
        REQUIRE(m[2][3] == 0.0);
    }
    CHECK(worst <= bound_in_ulps);
}

TEST_CASE("an orthographic lens has no plane at infinity, in either range of depth") {
    for (const DepthRange range : {DepthRange::negative_one_to_one, DepthRange::zero_to_one}) {
        CHECK(orthographic({-1.0, 1.0, -1.0, 1.0, 0.5, 2.0}, with(range)));
        CHECK_FALSE(orthographic({-1.0, 1.0, -1.0, 1.0, 0.5, infinity_double}, with(range)));
        CHECK_FALSE(orthographic({-1.0, 1.0, -1.0, 1.0, -infinity_double, 2.0}, with(range)));
    }
}

TEST_CASE("a lens of any finite numbers has its matrix, each element within 4 ulp, or has none of doubles") {
    Random random(75);
    // Of any size, subnormal too, and often next to another.
    const auto number = [&](double next_to) {
        if (random.integer(0, 3) == 0)
            return next_to * (1.0 + std::ldexp(random.uniform(-1.0, 1.0), -random.integer(0, 52)));
        if (random.integer(0, 9) == 0) return random.coin() ? 0x1p-1074 : std::numeric_limits<double>::max();
        return std::ldexp(random.uniform(0.5, 1.0), random.integer(-1073, 1024)) * (random.coin() ? 1.0 : -1.0);
    };
    const Real largest = std::numeric_limits<double>::max(), smallest = 0x1p-1074;
    Worst worst;
    int accepted = 0, refused = 0;
    for (int i = 0; i < 80000; ++i) {
        const double left = number(1.0), right = number(left), bottom = number(left), top = number(bottom);
        double z_near = number(right), z_far = number(z_near);
        const DepthRange range = random.coin() ? DepthRange::zero_to_one : DepthRange::negative_one_to_one;
        const Conventions conventions = with(range);
        const bool reversed = random.coin();
        const int kind = i % 4;
        if (kind != 1) z_near = std::fabs(z_near), z_far = std::fabs(z_far);
        if (!(z_near < z_far && z_far < infinity_double) || left == right || bottom == top) continue;
        if (kind != 1 && !(z_near > 0.0)) continue;
        const Real n(z_near), width = Real(right) - Real(left), height = Real(top) - Real(bottom);
        const Depth depth = kind == 1 ? exact_parallel_depth(z_near, z_far, reversed, range)
                                      : exact_depth(z_near, z_far, reversed, range);
        const Real sum_x = (Real(right) + Real(left)) / width, sum_y = (Real(top) + Real(bottom)) / height;
        std::optional<texgen::ProjectorProjection> projection;
        std::array<Real, 6> exact;
        std::array<glm::ivec2, 6> place;  // column, row
        std::string input = hex(left) + " " + hex(right) + " " + hex(bottom) + " " + hex(top) + " " + hex(z_near) +
                            " " + hex(z_far) + (reversed ? " reversed" : "");
        if (kind == 0) {
            projection = frustum({left, right, bottom, top, z_near, z_far, reversed}, conventions);
            exact = {2 * n / width, 2 * n / height, sum_x, sum_y, depth.scale, depth.offset};
            place = {glm::ivec2(0, 0), {1, 1}, {2, 0}, {2, 1}, {2, 2}, {3, 2}};
        } else if (kind == 1) {
            projection = orthographic({left, right, bottom, top, z_near, z_far, reversed}, conventions);
            exact = {2 / width, 2 / height, -sum_x, -sum_y, depth.scale, depth.offset};
            place = {glm::ivec2(0, 0), {1, 1}, {3, 0}, {3, 1}, {2, 2}, {3, 2}};
        } else if (kind == 2) {
            const bool at_half = random.coin();
            const texgen::PinholeLens lens{.fx = std::fabs(left),
                                           .fy = std::fabs(bottom),
                                           .cx = right,
                                           .cy = top,
                                           .width = std::fabs(number(left)),
                                           .height = std::fabs(number(top)),
                                           .z_near = z_near,
                                           .z_far = z_far,
                                           .centre = at_half ? texgen::PixelCentre::half : texgen::PixelCentre::integer,
                                           .reversed_depth = reversed};
            input += " " + hex(lens.width) + " " + hex(lens.height) + (at_half ? " half" : "");
            projection = pinhole(lens, conventions);
            const Real edge = at_half ? 0 : 1, pixels_x(lens.width), pixels_y(lens.height);
            exact = {2 * Real(lens.fx) / pixels_x,
                     2 * Real(lens.fy) / pixels_y,
                     (pixels_x - edge - 2 * Real(lens.cx)) / pixels_x,
                     -(pixels_y - edge - 2 * Real(lens.cy)) / pixels_y,
                     depth.scale,
                     depth.offset};
            place = {glm::ivec2(0, 0), {1, 1}, {2, 0}, {2, 1}, {2, 2}, {3, 2}};
        } else {
            const double aspect = std::fabs(left);
            double fovy = random.coin() ? std::min(std::fabs(right), 3.14) : random.uniform(0.0, 3.1415926);
            if (random.integer(0, 3) == 0) fovy = std::ldexp(random.uniform(1.0, 4.0), -1024);  // no double is its half
            input = hex(fovy) + " " + hex(aspect) + " " + hex(z_near) + " " + hex(z_far);
            projection = perspective({texgen::radians(fovy), aspect, z_near, z_far, reversed}, conventions);
            const Real focal_length = 1 / tan(Real(fovy) / 2);
            exact = {focal_length / Real(aspect), focal_length, Real(0), Real(0), depth.scale, depth.offset};
            place = {glm::ivec2(0, 0), {1, 1}, {2, 0}, {2, 1}, {2, 2}, {3, 2}};
        }
        bool is_clear = true, is_double = true;  // not next to a limit; inside them
        for (std::size_t k = 0; k < 6; ++k) {
            const Real size = abs(exact[k]);
            is_clear = is_clear && (size < 0.999 * largest || size > 1.001 * largest);
            is_double = is_double && size < largest;
            if (k >= 2) continue;
            is_clear = is_clear && (size < 0.25 * smallest || size > smallest);
            is_double = is_double && size > 0.5 * smallest;
        }
        if (!is_clear) continue;
        REQUIRE_MESSAGE(projection.has_value() == is_double, input);
        (is_double ? accepted : refused) += 1;
        if (!is_double) continue;
        for (std::size_t k = 0; k < 6; ++k) {
            const double error = support::error_in_ulps(projection->matrix()[place[k].x][place[k].y], exact[k]);
            worst.take(error, [&] { return input; });
        }
    }
    CHECK(accepted > 5000);
    CHECK(refused > 5000);
    CHECK_MESSAGE(worst.error <= bound_in_ulps, worst.input);
    MESSAGE(worst.error, " ulp at most: ", worst.input);
}

TEST_CASE("y down turns the second row over and changes nothing else") {
    const PerspectiveLens lens{.fovy = texgen::degrees(30.0), .aspect = 1.5, .z_near = 0.2, .z_far = 1000.0};
    const glm::dmat4 up = perspective(lens, with(DepthRange::zero_to_one))->matrix();
    const glm::dmat4 down = perspective(lens, with(DepthRange::zero_to_one, NdcY::down))->matrix();
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) CHECK(down[column][row] == (row == 1 ? -up[column][row] : up[column][row]));
}

TEST_CASE("reversed depth knows the distance to 2e-7 of it where standard depth cannot tell the distances apart") {
    // near 1e-3, far 1e6, a point at 1e5: r as a float, and back to a distance.
    const auto recovered = [](bool reversed) {
        const auto projection = perspective(
            {.fovy = texgen::degrees(60.0), .aspect = 1.0, .z_near = 1e-3, .z_far = 1e6, .reversed_depth = reversed},
            with(DepthRange::zero_to_one));
        const glm::dvec4 clip = projection->matrix() * glm::dvec4(0.0, 0.0, -1e5, 1.0);
        const double depth = static_cast<float>(clip.z / clip.w);
        return projection->matrix()[3][2] / (depth + projection->matrix()[2][2]);
    };
    CHECK(std::fabs(recovered(true) - 1e5) < 2e-7 * 1e5);
    CHECK_FALSE(std::fabs(recovered(false) - 1e5) < 0.5 * 1e5);
}
