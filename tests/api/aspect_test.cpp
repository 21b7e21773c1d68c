// Pictures in lenses of another aspect: contained with bars beside them, or cropped to cover.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "judges/oracle.hpp"
#include "judges/real.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace {

using support::exactly;
using support::hex;
using support::Random;
using support::Rational;
using support::Real;
using texgen::FrustumLens;
using texgen::OrthographicLens;
using texgen::PerspectiveLens;
using texgen::TextureRegion;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan_double = std::numeric_limits<double>::quiet_NaN();

double largest_of(std::initializer_list<double> sides) {
    double largest = 0.0;
    for (const double side : sides) largest = std::max(largest, std::fabs(side));
    return largest;
}

// Whether s and t of the texgen's rows grow by the same number of picture heights a unit of length: a circle stays one.
bool is_undistorted(const glm::dmat4& texture_from_eye, double picture_aspect, double extent_s, double extent_t) {
    const double s = std::fabs(texture_from_eye[0][0]) / extent_s, t = std::fabs(texture_from_eye[1][1]) / extent_t;
    return std::fabs(s * picture_aspect / t - 1.0) <= 1e-10;
}

template <class RectangularLens>
RectangularLens random_rectangle(Random& random) {
    const double centre_x = random.uniform(-2.0, 2.0), centre_y = random.uniform(-2.0, 2.0);
    const double half_x = random.power_of_ten(-2.0, 1.0) * (random.integer(0, 3) == 0 ? -1.0 : 1.0);
    const double half_y = random.power_of_ten(-2.0, 1.0) * (random.integer(0, 3) == 0 ? -1.0 : 1.0);
    return {centre_x - half_x, centre_x + half_x, centre_y - half_y, centre_y + half_y, 0.5, 50.0};
}

// [low, high] at that fraction about its middle, exactly, against what was computed; in units of 2^-53 of the largest side.
double narrowing_error(double low, double high, const Rational& fraction, double new_low, double new_high,
                       double unit) {
    const Rational middle = (exactly(low) + exactly(high)) / 2, half = fraction * (exactly(high) - exactly(low)) / 2;
    const double error = std::max(support::absolute_error(new_low, Rational(middle - half)),
                                  support::absolute_error(new_high, Rational(middle + half)));
    return error / (0x1p-53 * unit);
}

}  // namespace

TEST_CASE(
    "a perspective contains the picture's own: a side keeps its angle, the other has the picture's aspect, within 4 "
    "ulp") {
    Random random(331);
    double worst = 0.0;
    for (int i = 0; i < 3000; ++i) {
        const PerspectiveLens lens{.fovy = texgen::degrees(random.uniform(0.1, 179.9)),
                                   .aspect = random.power_of_ten(-1.0, 1.0),
                                   .z_near = 0.1,
                                   .z_far = infinity,
                                   .reversed_depth = random.coin()};
        const double aspect = i % 10 == 0 ? lens.aspect : random.power_of_ten(-1.0, 1.0);
        const PerspectiveLens contained = contain(lens, aspect);
        REQUIRE(contained.aspect == aspect);
        REQUIRE(contained.z_near == lens.z_near);
        REQUIRE(contained.z_far == lens.z_far);
        REQUIRE(contained.reversed_depth == lens.reversed_depth);
        if (aspect <= lens.aspect) {
            REQUIRE(contained.fovy == lens.fovy);
            continue;
        }
        // The widths are one: tan(fovy'/2) aspect = tan(fovy/2) of the lens's aspect.
        const Real tangent = tan(Real(Real(lens.fovy.in_radians()) / 2)) * Real(lens.aspect) / Real(aspect);
        worst = std::max(worst, support::error_in_ulps(contained.fovy.in_radians(), 2 * atan(tangent)));
        const auto projection = perspective(contained, texgen::opengl);
        REQUIRE(projection);
        REQUIRE(is_undistorted((scale_bias(texgen::opengl) * *projection).matrix(), aspect, 1.0, 1.0));
    }
    CHECK(worst <= 4.0);
    MESSAGE(worst, " ulp at most");
}

TEST_CASE(
    "a rectangle contains the picture's own about its middle, and a picture is cropped about its own to cover it") {
    Random random(332);
    double worst_side = 0.0, worst_region = 0.0;
    std::string worst_input;
    for (int i = 0; i < 3000; ++i) {
        const auto check = [&](const auto& lens, const auto& make) {
            const Rational width = support::magnitude(exactly(lens.right) - exactly(lens.left));
            const Rational height = support::magnitude(exactly(lens.top) - exactly(lens.bottom));
            const double aspect = random.power_of_ten(-1.0, 1.0);
            const bool is_wider = exactly(aspect) * height > width;
            const Rational across = is_wider ? Rational(1) : Rational(exactly(aspect) * height / width);
            const Rational upwards = is_wider ? Rational(width / (exactly(aspect) * height)) : Rational(1);

            const auto contained = contain(lens, aspect);
            const double unit = largest_of({lens.left, lens.right, lens.bottom, lens.top});
            const double error =
                std::max(narrowing_error(lens.left, lens.right, across, contained.left, contained.right, unit),
                         narrowing_error(lens.bottom, lens.top, upwards, contained.bottom, contained.top, unit));
            if (error > worst_side) worst_side = error, worst_input = hex(aspect);
            REQUIRE((is_wider ? contained.left == lens.left && contained.right == lens.right
                              : contained.bottom == lens.bottom && contained.top == lens.top));
            REQUIRE(contained.z_near == lens.z_near);
            REQUIRE(contained.z_far == lens.z_far);
            REQUIRE(is_undistorted((scale_bias(texgen::vulkan) * make(contained)).matrix(), aspect, 1.0, 1.0));

            // What of the picture is seen is as much as what of the light would be bars.
            const TextureRegion picture =
                random.coin() ? texgen::whole_texture() : texgen::atlas_tile({0.25, 0.5}, {0.75, 0.625});
            const TextureRegion crop = cover(lens, aspect, picture);
            const glm::dvec2 low = picture.min(), high = picture.max(), extent = high - low;
            const double size = largest_of({low.x, low.y, high.x, high.y});
            const double of_region = std::max(narrowing_error(low.x, high.x, upwards, crop.min().x, crop.max().x, size),
                                              narrowing_error(low.y, high.y, across, crop.min().y, crop.max().y, size));
            worst_region = std::max(worst_region, of_region);
            const auto texture_from_eye = scale_bias(texgen::vulkan, crop) * make(lens);
            REQUIRE(is_undistorted(texture_from_eye.matrix(), aspect, extent.x, extent.y));
        };
        check(random_rectangle<FrustumLens>(random),
              [](const FrustumLens& lens) { return frustum(lens, texgen::vulkan).value(); });
        check(random_rectangle<OrthographicLens>(random),
              [](const OrthographicLens& lens) { return orthographic(lens, texgen::vulkan).value(); });
    }
    CHECK_MESSAGE(worst_side <= 8.0, worst_input);
    CHECK(worst_region <= 4.0);
    MESSAGE(worst_side, " and ", worst_region, " times 2^-53 of the largest side at most");
}

TEST_CASE("a 4:3 picture in a 16:9 light has bars at its sides, or loses its top and bottom") {
    const PerspectiveLens lens{.fovy = texgen::degrees(40), .aspect = 16.0 / 9.0, .z_near = 0.1, .z_far = 100.0};
    const PerspectiveLens contained = contain(lens, 4.0 / 3.0);
    CHECK(contained.fovy == lens.fovy);
    CHECK(contained.aspect == 4.0 / 3.0);
    const TextureRegion crop = cover(lens, 4.0 / 3.0);
    CHECK(crop.min().x == 0.0);
    CHECK(crop.max().x == 1.0);
    CHECK(crop.min().y == doctest::Approx(0.125).epsilon(1e-15));
    CHECK(crop.max().y == doctest::Approx(0.875).epsilon(1e-15));
    CHECK(cover(lens, 4.0 / 3.0, texgen::whole_texture().with_depth(0.25, 0.5)) == crop.with_depth(0.25, 0.5));
    // The same light, the same picture: nothing changes.
    CHECK(cover(lens, lens.aspect, texgen::rectangle_texture(640, 480)) == texgen::rectangle_texture(640, 480));
    CHECK(contain(lens, lens.aspect).fovy == lens.fovy);
}

TEST_CASE("an aspect that is none makes no lens, and a region without points") {
    const PerspectiveLens lens{.fovy = texgen::degrees(40), .aspect = 1.5, .z_near = 0.1, .z_far = 100.0};
    const FrustumLens frustum_lens{-1.0, 2.0, -1.0, 1.0, 0.5, 10.0};
    const OrthographicLens orthographic_lens{-1.0, 2.0, -1.0, 1.0, 0.5, 10.0};
    const auto has_points = [](const TextureRegion& region) {
        return region.min().x <= region.max().x && region.min().y <= region.max().y;
    };
    for (const double bad : {0.0, -1.5, nan_double, infinity, -infinity}) {
        CAPTURE(bad);
        CHECK_FALSE(perspective(contain(lens, bad), texgen::opengl));
        CHECK_FALSE(frustum(contain(frustum_lens, bad), texgen::opengl));
        CHECK_FALSE(orthographic(contain(orthographic_lens, bad), texgen::opengl));
        CHECK_FALSE(has_points(cover(lens, bad)));
        CHECK_FALSE(has_points(cover(frustum_lens, bad)));
        CHECK_FALSE(has_points(cover(orthographic_lens, bad)));
        PerspectiveLens without_aspect = lens;
        without_aspect.aspect = bad;
        CHECK_FALSE(perspective(contain(without_aspect, 1.0), texgen::opengl));
        CHECK_FALSE(has_points(cover(without_aspect, 1.0)));
    }
    CHECK_FALSE(frustum(contain(FrustumLens{1.0, 1.0, -1.0, 1.0, 0.5, 10.0}, 1.0), texgen::opengl));
    // An angle beyond the range stays there, even where its tangent is that of another.
    for (const double fovy : {0.0, -40.0, 180.0, 400.0, nan_double}) {
        PerspectiveLens without_angle = lens;
        without_angle.fovy = texgen::degrees(fovy);
        CHECK_FALSE(perspective(contain(without_angle, 3.0), texgen::opengl));
    }
}
