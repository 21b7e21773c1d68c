// Pictures in lenses of another aspect: contained with bars beside them, or cropped to cover.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "judges/oracle.hpp"
#include "support/aspects.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace {

using support::infinity_double;
using support::nan_double;
using support::Random;
using texgen::FrustumLens;
using texgen::OrthographicLens;
using texgen::PerspectiveLens;
using texgen::TextureRegion;

// Whether s and t of the texgen's rows grow by the same number of picture heights a unit of length: a circle stays one.
bool is_undistorted(const glm::dmat4& texture_from_eye, double picture_aspect, double extent_s, double extent_t) {
    const double s = std::fabs(texture_from_eye[0][0]) / extent_s, t = std::fabs(texture_from_eye[1][1]) / extent_t;
    return std::fabs(s * picture_aspect / t - 1.0) <= 1e-10;
}

}  // namespace

TEST_CASE(
    "a perspective contains the picture's own: a side keeps its angle, the other has the picture's aspect, within 4 "
    "ulp") {
    Random random(331);
    double worst = 0.0;
    for (int i = 0; i < 3000; ++i) {
        const PerspectiveLens lens = support::random_perspective(random);
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
        worst = std::max(worst, support::narrowed_angle_error(lens, contained));
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
    double worst_region = 0.0;
    support::Worst worst_side;
    for (int i = 0; i < 3000; ++i) {
        const auto check = [&](const auto& lens, const auto& make) {
            const double aspect = random.power_of_ten(-1.0, 1.0);
            const support::Narrowing narrowing(lens, aspect);
            const auto contained = contain(lens, aspect);
            const double error = narrowing.measured_contain_error(lens, contained);
            worst_side.take(error, [&] { return support::hex(aspect); });
            REQUIRE((narrowing.is_wider() ? contained.left == lens.left && contained.right == lens.right
                                          : contained.bottom == lens.bottom && contained.top == lens.top));
            REQUIRE(contained.z_near == lens.z_near);
            REQUIRE(contained.z_far == lens.z_far);
            REQUIRE(is_undistorted((scale_bias(texgen::vulkan) * make(contained)).matrix(), aspect, 1.0, 1.0));

            // What of the picture is seen is as much as what of the light would be bars.
            const TextureRegion picture =
                random.coin() ? texgen::whole_texture() : texgen::atlas_tile({0.25, 0.5}, {0.75, 0.625});
            const TextureRegion crop = cover(lens, aspect, picture);
            const glm::dvec2 extent = picture.max() - picture.min();
            worst_region = std::max(worst_region, narrowing.measured_cover_error(picture, crop));
            const auto texture_from_eye = scale_bias(texgen::vulkan, crop) * make(lens);
            REQUIRE(is_undistorted(texture_from_eye.matrix(), aspect, extent.x, extent.y));
        };
        check(support::random_rectangle<FrustumLens>(random),
              [](const FrustumLens& lens) { return frustum(lens, texgen::vulkan).value(); });
        check(support::random_rectangle<OrthographicLens>(random),
              [](const OrthographicLens& lens) { return orthographic(lens, texgen::vulkan).value(); });
    }
    CHECK_MESSAGE(0x1p-53 * worst_side.error <= texgen::contain_error, worst_side.input);
    CHECK(0x1p-53 * worst_region <= texgen::cover_error);
    MESSAGE(worst_side.error, " and ", worst_region, " times 2^-53 of the largest side at most");
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
    for (const double bad : {0.0, -1.5, nan_double, infinity_double, -infinity_double}) {
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

TEST_CASE("a picture of a lens's aspect stays as it is where the sides are the least doubles, or the largest") {
    for (const int exponent : {-1074, -1060, 0, 1000, 1021}) {
        const double unit = std::ldexp(1.0, exponent);
        for (const auto& [width, height] : {std::array{3.0, 2.0}, {1.0, 1.0}, {3.0, 1.0}}) {
            const FrustumLens lens{0.0, width * unit, 0.0, height * unit, 0.5, 10.0};
            CAPTURE(exponent);
            CHECK(cover(lens, width / height) == texgen::whole_texture());
            CHECK(contain(lens, width / height).right == lens.right);
        }
    }
}
