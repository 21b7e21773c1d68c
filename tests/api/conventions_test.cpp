// Every combination of conventions as a table: corners, centre, near and far of the slide land where the conventions
// say.

#include "texgen/conventions.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "support/hex.hpp"
#include "support/special_values.hpp"
#include "texgen/detail/culling/slide_planes.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/scale_bias.hpp"

namespace {

using support::hex;
using support::infinity_double;
using support::nan_double;
using texgen::Conventions;
using texgen::DepthMapping;
using texgen::DepthRange;
using texgen::FrustumLens;
using texgen::Handedness;
using texgen::NdcY;
using texgen::OrthographicLens;
using texgen::PerspectiveLens;
using texgen::TextureOrigin;
using texgen::TextureRegion;

std::vector<Conventions> all_conventions() {
    std::vector<Conventions> result;
    for (const DepthRange depth : {DepthRange::negative_one_to_one, DepthRange::zero_to_one})
        for (const NdcY y : {NdcY::up, NdcY::down})
            for (const TextureOrigin origin : {TextureOrigin::bottom_left, TextureOrigin::top_left})
                for (const Handedness handedness : {Handedness::right, Handedness::left})
                    result.push_back({depth, y, origin, handedness});
    return result;
}

// A lens of any kind as the rectangle of its near plane, and whether rays spread from the eye or run parallel.
struct LensCase {
    std::string name;
    double left, right, bottom, top, z_near, z_far;
    bool spreads, reversed;
    std::optional<texgen::ProjectorProjection> (*make)(const LensCase&, Conventions);
};

std::vector<LensCase> all_lenses() {
    const auto perspective = [](const LensCase& lens, Conventions conventions) {
        return texgen::perspective({.fovy = texgen::radians(2.0 * std::atan2(lens.top, lens.z_near)),
                                    .aspect = lens.right / lens.top,
                                    .z_near = lens.z_near,
                                    .z_far = lens.z_far,
                                    .reversed_depth = lens.reversed},
                                   conventions);
    };
    const auto frustum = [](const LensCase& lens, Conventions conventions) {
        return texgen::frustum({lens.left, lens.right, lens.bottom, lens.top, lens.z_near, lens.z_far}, conventions);
    };
    const auto orthographic = [](const LensCase& lens, Conventions conventions) {
        return texgen::orthographic({lens.left, lens.right, lens.bottom, lens.top, lens.z_near, lens.z_far},
                                    conventions);
    };
    // The same rectangle as 640 x 480 pixels.
    const auto pinhole = [](const LensCase& lens, Conventions conventions) {
        const double width = lens.right - lens.left, height = lens.top - lens.bottom;
        return texgen::pinhole({.fx = 640.0 * lens.z_near / width,
                                .fy = 480.0 * lens.z_near / height,
                                .cx = -640.0 * lens.left / width - 0.5,
                                .cy = 480.0 * lens.top / height - 0.5,
                                .width = 640.0,
                                .height = 480.0,
                                .z_near = lens.z_near,
                                .z_far = lens.z_far,
                                .centre = texgen::PixelCentre::integer},
                               conventions);
    };
    return {{"perspective", -0.3, 0.3, -0.2, 0.2, 0.5, 100.0, true, false, perspective},
            {"reversed", -0.3, 0.3, -0.2, 0.2, 0.5, 100.0, true, true, perspective},
            {"infinite", -0.3, 0.3, -0.2, 0.2, 0.5, infinity_double, true, false, perspective},
            {"infinite reversed", -0.3, 0.3, -0.2, 0.2, 0.5, infinity_double, true, true, perspective},
            {"frustum", -1.0, 1.0, -0.75, 0.75, 1.0, 10.0, true, false, frustum},
            {"off-axis frustum", -0.1, 0.7, -0.5, 0.2, 1.0, 10.0, true, false, frustum},
            {"wholly off-axis frustum", 0.25, 0.5, 1.0, 3.0, 0.5, 8.0, true, false, frustum},
            {"mirrored frustum", 0.4, -0.4, -0.2, 0.2, 0.5, 8.0, true, false, frustum},
            {"pinhole", -0.3, 0.3, -0.2, 0.2, 0.5, 100.0, true, false, pinhole},
            {"infinite off-axis pinhole", -0.1, 0.7, -0.5, 0.2, 1.0, infinity_double, true, false, pinhole},
            {"orthographic", -2.0, 2.0, -1.5, 1.5, 1.0, 20.0, false, false, orthographic},
            {"off-centre orthographic", 3.0, 5.0, -7.0, -6.5, -4.0, 20.0, false, false, orthographic},
            {"orthographic upside down", -1.0, 1.0, 1.0, -1.0, 0.0, 1.0, false, false, orthographic}};
}

// Position on the slide: x and y from -1 (left, bottom) to 1; depth z in front of the eye.
glm::dvec4 eye_point(const LensCase& lens, Conventions conventions, double x, double y, double z) {
    const double spread = lens.spreads ? z / lens.z_near : 1.0;
    const auto between = [](double low, double high, double at) { return low + (high - low) * (at + 1.0) / 2.0; };
    return {between(lens.left, lens.right, x) * spread, between(lens.bottom, lens.top, y) * spread,
            conventions.handedness == Handedness::left ? z : -z, 1.0};
}

// What the texture's depth is at the near plane (0) and at the far plane (1) by the definition of the conventions.
double expected_depth(const LensCase& lens, Conventions conventions, DepthMapping mapping, bool at_far) {
    const bool high_end = at_far != lens.reversed;
    if (mapping == DepthMapping::unit || conventions.depth == DepthRange::zero_to_one) return high_end ? 1.0 : 0.0;
    return high_end ? 1.0 : -1.0;
}

struct RegionCase {
    std::string name;
    TextureRegion region;
};

TEST_CASE("TEXGEN_VERSION is the project's version") { CHECK(TEXGEN_VERSION == TEXGEN_PROJECT_VERSION); }

}  // namespace

TEST_CASE("corners, centre, near and far land where they should, for every lens, region and convention") {
    const std::vector<RegionCase> regions{{"whole", texgen::whole_texture()},
                                          {"rectangle", texgen::rectangle_texture(640.0, 480.0)},
                                          {"atlas", texgen::atlas_tile({0.25, 0.5}, {0.5, 0.625})},
                                          {"atlas far off", texgen::atlas_tile({-3.0, 100.0}, {5.0, 101.0})}};
    int combinations = 0;
    for (const LensCase& lens : all_lenses()) {
        for (const Conventions conventions : all_conventions()) {
            const auto projection = lens.make(lens, conventions);
            REQUIRE_MESSAGE(projection, lens.name);
            for (const RegionCase& region : regions) {
                for (const DepthMapping mapping : {DepthMapping::unit, DepthMapping::ndc}) {
                    ++combinations;
                    const auto texture_from_eye = scale_bias(conventions, region.region, mapping) * *projection;
                    const glm::dvec2 low = region.region.min(), high = region.region.max();
                    const double of_near = expected_depth(lens, conventions, mapping, false);
                    const double of_far = expected_depth(lens, conventions, mapping, true);
                    const TextureRegion volume = region.region.with_depth(conventions, mapping);
                    REQUIRE(volume.depth() == glm::dvec2(std::min(of_near, of_far), std::max(of_near, of_far)));
                    REQUIRE((scale_bias(conventions, volume, mapping) * *projection).matrix() ==
                            texture_from_eye.matrix());
                    for (const bool at_far : {false, true}) {
                        // The infinitely far plane is met in the limit.
                        const bool limit = at_far && !(lens.z_far < infinity_double);
                        const double z = limit ? 1e15 : at_far ? lens.z_far : lens.z_near;
                        for (int y = -1; y <= 1; ++y) {
                            for (int x = -1; x <= 1; ++x) {
                                CAPTURE(lens.name);
                                CAPTURE(support::text(conventions));
                                CAPTURE(region.name);
                                CAPTURE(x);
                                CAPTURE(y);
                                const glm::dvec4 strq =
                                    texture_from_eye.matrix() * eye_point(lens, conventions, x, y, z);
                                // s runs from the left of the slide to its right. t runs up it, unless the origin is
                                // its top left corner. The y direction of NDC is the projector's own affair.
                                const double up = conventions.origin == TextureOrigin::bottom_left ? y : -y;
                                const double s = low.x + (high.x - low.x) * (x + 1.0) / 2.0;
                                const double t = low.y + (high.y - low.y) * (up + 1.0) / 2.0;
                                const double r = expected_depth(lens, conventions, mapping, at_far);
                                const double tolerance = 1e-13 * (1.0 + std::fabs(high.x) + std::fabs(high.y));
                                REQUIRE(strq.w > 0.0);
                                CHECK(std::fabs(strq.x / strq.w - s) <= tolerance);
                                CHECK(std::fabs(strq.y / strq.w - t) <= tolerance);
                                CHECK(std::fabs(strq.z / strq.w - r) <= 1e-13);
                                if (!lens.spreads) CHECK(strq.w == 1.0);
                            }
                        }
                    }
                }
            }
        }
    }
    CHECK(combinations == 13 * 16 * 4 * 2);
}

TEST_CASE("the NDC of a projector follows its depth range and its y direction") {
    for (const LensCase& lens : all_lenses()) {
        for (const Conventions conventions : all_conventions()) {
            CAPTURE(lens.name);
            CAPTURE(support::text(conventions));
            const auto projection = lens.make(lens, conventions);
            const glm::dvec4 top_right = projection->matrix() * eye_point(lens, conventions, 1.0, 1.0, lens.z_near);
            CHECK(top_right.x / top_right.w == doctest::Approx(1.0).epsilon(1e-14));
            CHECK(top_right.y / top_right.w ==
                  doctest::Approx(conventions.ndc_y == NdcY::up ? 1.0 : -1.0).epsilon(1e-14));
            const double near = conventions.depth == DepthRange::zero_to_one ? 0.0 : -1.0;
            CHECK(std::fabs(top_right.z / top_right.w - (lens.reversed ? 1.0 : near)) <= 1e-14);
        }
    }
}

TEST_CASE("the named conventions are those of their graphics APIs") {
    CHECK(texgen::opengl ==
          Conventions{DepthRange::negative_one_to_one, NdcY::up, TextureOrigin::bottom_left, Handedness::right});
    CHECK(texgen::direct3d ==
          Conventions{DepthRange::zero_to_one, NdcY::up, TextureOrigin::top_left, Handedness::right});
    CHECK(texgen::metal == Conventions{DepthRange::zero_to_one, NdcY::up, TextureOrigin::top_left, Handedness::right});
    CHECK(texgen::vulkan ==
          Conventions{DepthRange::zero_to_one, NdcY::down, TextureOrigin::top_left, Handedness::right});
    for (const Conventions& api : {texgen::opengl, texgen::direct3d, texgen::metal, texgen::vulkan})
        CHECK(texgen::left_handed(api) == Conventions{api.depth, api.ndc_y, api.origin, Handedness::left});
    static_assert(texgen::left_handed(texgen::direct3d) != texgen::direct3d);
    static_assert(!std::is_default_constructible_v<TextureRegion>);
    static_assert(!std::is_convertible_v<double, texgen::Angle>);
}

TEST_CASE("for OpenGL the matrices are Everitt's S and the lens of gluPerspective, glFrustum and glOrtho") {
    const glm::dmat4 bias{{0.5, 0, 0, 0}, {0, 0.5, 0, 0}, {0, 0, 0.5, 0}, {0.5, 0.5, 0.5, 1}};
    CHECK(texgen::scale_bias(texgen::opengl).matrix() == bias);
    // SGI's recipe leaves r in NDC.
    const glm::dmat4 sgi{{0.5, 0, 0, 0}, {0, 0.5, 0, 0}, {0, 0, 1, 0}, {0.5, 0.5, 0, 1}};
    CHECK(texgen::scale_bias(texgen::opengl, texgen::whole_texture(), DepthMapping::ndc).matrix() == sgi);
    // The y direction and the origin undo each other for Vulkan; Direct3D turns t over.
    CHECK(texgen::scale_bias(texgen::vulkan).matrix()[1][1] == 0.5);
    CHECK(texgen::scale_bias(texgen::direct3d).matrix()[1][1] == -0.5);

    const glm::dmat4 ninety =
        perspective(PerspectiveLens{.fovy = texgen::degrees(90.0), .aspect = 2.0, .z_near = 1.0, .z_far = 3.0},
                    texgen::opengl)
            ->matrix();
    CHECK(ninety[0][0] == doctest::Approx(0.5));
    CHECK(ninety[1][1] == doctest::Approx(1.0));
    CHECK(ninety[2] == glm::dvec4(0, 0, -2, -1));
    CHECK(ninety[3] == glm::dvec4(0, 0, -3, 0));

    const glm::dmat4 off_axis = frustum(FrustumLens{-1, 3, -2, 4, 1, 3}, texgen::opengl)->matrix();
    CHECK(off_axis == glm::dmat4{{0.5, 0, 0, 0}, {0, 1.0 / 3.0, 0, 0}, {0.5, 1.0 / 3.0, -2, -1}, {0, 0, -3, 0}});
    const glm::dmat4 parallel = orthographic(OrthographicLens{-1, 3, -2, 4, 1, 3}, texgen::opengl)->matrix();
    CHECK(parallel == glm::dmat4{{0.5, 0, 0, 0}, {0, 1.0 / 3.0, 0, 0}, {0, 0, -1, 0}, {-0.5, -1.0 / 3.0, -2, 1}});
}

TEST_CASE("a lens that is no lens gives nothing") {
    const Conventions conventions = texgen::opengl;
    const auto with = [](double fovy, double aspect, double z_near, double z_far) {
        return PerspectiveLens{.fovy = texgen::degrees(fovy), .aspect = aspect, .z_near = z_near, .z_far = z_far};
    };
    REQUIRE(perspective(with(30.0, 1.0, 0.2, 1000.0), conventions));
    for (const double fovy :
         {0.0, -30.0, 180.0, 180.00001, 360.0, 1e300, infinity_double, -infinity_double, nan_double})
        CHECK_MESSAGE(!perspective(with(fovy, 1.0, 0.2, 1000.0), conventions), fovy);
    for (const double aspect : {0.0, -1.0, infinity_double, nan_double})
        CHECK_MESSAGE(!perspective(with(30.0, aspect, 0.2, 1000.0), conventions), aspect);
    for (const double z_near : {0.0, -0.2, 1000.0, 2000.0, infinity_double, nan_double})
        CHECK_MESSAGE(!perspective(with(30.0, 1.0, z_near, 1000.0), conventions), z_near);
    for (const double z_far : {0.2, 0.1, 0.0, -1.0, -infinity_double, nan_double})
        CHECK_MESSAGE(!perspective(with(30.0, 1.0, 0.2, z_far), conventions), z_far);
    // Elements that no double holds.
    CHECK_FALSE(perspective(with(1e-3, 1e-307, 0.2, 1000.0), conventions));
    CHECK_FALSE(perspective(with(179.0, 1e308, 1e308, infinity_double), conventions));
    // The extremes that are lenses.
    CHECK(perspective(with(1e-3, 1.0, 0.2, 1000.0), conventions));
    CHECK(perspective(with(179.999, 1.0, 0.2, 1000.0), conventions));
    CHECK(perspective(with(30.0, 1.0, 1e-30, infinity_double), conventions));
    CHECK(perspective(with(30.0, 1.0, 1e-3, 1e308), conventions));

    const std::array good{-1.0, 1.0, -1.0, 1.0, 1.0, 10.0};
    const auto frustum_of = [&](const std::array<double, 6>& f) {
        return frustum(FrustumLens{f[0], f[1], f[2], f[3], f[4], f[5]}, conventions).has_value();
    };
    const auto orthographic_of = [&](const std::array<double, 6>& f) {
        return orthographic(OrthographicLens{f[0], f[1], f[2], f[3], f[4], f[5]}, conventions).has_value();
    };
    REQUIRE(frustum_of(good));
    REQUIRE(orthographic_of(good));
    for (std::size_t field = 0; field < 6; ++field) {
        for (const double bad : {infinity_double, -infinity_double, nan_double}) {
            std::array<double, 6> fields = good;
            fields[field] = bad;
            CHECK_FALSE(frustum_of(fields));
            CHECK_FALSE(orthographic_of(fields));
        }
    }
    for (const std::size_t field : {0u, 2u, 4u}) {
        std::array<double, 6> fields = good;
        fields[field] = fields[field + 1];
        CHECK_FALSE(frustum_of(fields));
        CHECK_FALSE(orthographic_of(fields));
    }
    CHECK_FALSE(frustum_of({-1, 1, -1, 1, 0, 10}));
    CHECK_FALSE(frustum_of({-1, 1, -1, 1, -1, 10}));
    CHECK_FALSE(frustum_of({-1, 1, -1, 1, 10, 1}));
    CHECK_FALSE(frustum_of({-1e308, 1e308, -1, 1, 1e-30, 1}));
    CHECK_FALSE(frustum_of({-1, 1, -1e308, 1e308, 1e-30, 1}));
    CHECK(orthographic_of({-1, 1, -1, 1, -1, 10}));
    CHECK_FALSE(orthographic_of({-1, 1, -1, 1, 10, 1}));
}

TEST_CASE("a projector is empty where its lens or its aim is, and P_p V_p otherwise") {
    const PerspectiveLens lens{.fovy = texgen::degrees(30.0), .aspect = 1.0, .z_near = 0.2, .z_far = 1000.0};
    const texgen::Aim aim{{2, 5, 5}, {-2, -4, 0}, {0, 1, 0}}, nowhere{{2, 5, 5}, {2, 5, 5}, {0, 1, 0}};
    const PerspectiveLens no_lens{.fovy = texgen::degrees(0.0), .aspect = 1.0, .z_near = 0.2, .z_far = 1000.0};
    const std::optional<texgen::Projector> projector = make_projector(lens, aim, texgen::vulkan);
    REQUIRE(projector);
    CHECK(projector->conventions == texgen::vulkan);
    CHECK(projector->matrix().matrix() == perspective(lens, texgen::vulkan)->matrix() * look_at(aim)->matrix());
    CHECK_FALSE(make_projector(lens, nowhere, texgen::vulkan));
    CHECK_FALSE(make_projector(no_lens, aim, texgen::vulkan));
    CHECK(make_projector(FrustumLens{-1, 1, -1, 1, 1, 10}, aim, texgen::vulkan));
    CHECK_FALSE(make_projector(FrustumLens{1, 1, -1, 1, 1, 10}, aim, texgen::vulkan));
    CHECK(make_projector(OrthographicLens{-1, 1, -1, 1, 1, 10}, aim, texgen::vulkan));
    CHECK_FALSE(make_projector(OrthographicLens{-1, 1, -1, -1, 1, 10}, aim, texgen::vulkan));
}

TEST_CASE("angles, tolerances and regions say what they were given") {
    CHECK(texgen::degrees(180.0).in_radians() == 3.14159265358979323846);
    CHECK(texgen::radians(0.5).in_radians() == 0.5);
    CHECK(texgen::degrees(30.0).in_degrees() == doctest::Approx(30.0).epsilon(1e-15));
    CHECK(texgen::texels(0.5, 4096.0).value == 0.5 / 4096.0);
    CHECK(texgen::texels(0.5, 0.0).value == 0.0);
    CHECK(texgen::texels(0.5, -1.0).value == 0.0);
    CHECK(texgen::texels(0.5, nan_double).value == 0.0);
    CHECK(texgen::exact.value == 0.0);
    CHECK(texgen::rectangle_texture(640, 480) == texgen::atlas_tile({0, 0}, {640, 480}));
    CHECK(texgen::whole_texture().max() == glm::dvec2(1.0, 1.0));
}

TEST_CASE("a region has the depth that it was given, and is another region with another") {
    const TextureRegion tile = texgen::atlas_tile({0.25, 0.5}, {0.5, 0.625});
    CHECK_FALSE(tile.depth());
    const TextureRegion volume = tile.with_depth();
    CHECK(volume.depth() == glm::dvec2(0.0, 1.0));
    CHECK(volume.min() == tile.min());
    CHECK(volume.max() == tile.max());
    CHECK(tile.with_depth(-infinity_double, 0.5).depth() == glm::dvec2(-infinity_double, 0.5));
    CHECK(volume.with_depth(-2.0, 3.0).depth() == glm::dvec2(-2.0, 3.0));

    const std::vector<TextureRegion> all_different{tile,
                                                   volume,
                                                   tile.with_depth(0.0, 0.5),
                                                   tile.with_depth(0.5, 1.0),
                                                   tile.with_depth(-infinity_double, infinity_double),
                                                   texgen::whole_texture().with_depth()};
    for (std::size_t i = 0; i < all_different.size(); ++i)
        for (std::size_t j = 0; j < all_different.size(); ++j)
            CHECK((all_different[i] == all_different[j]) == (i == j));
    CHECK(tile.with_depth(nan_double, 1.0) != tile.with_depth(nan_double, 1.0));
}

TEST_CASE("the planes of a slide are q, the sides of s and t, and those of r where there is a depth") {
    using texgen::detail::SlidePlane;
    const TextureRegion tile = texgen::atlas_tile({0.25, 0.5}, {0.75, 0.625});
    const std::vector<SlidePlane> expected{{3, 1.0, 0.0},    {0, 1.0, 0.25},   {0, -1.0, 0.75},           {1, 1.0, 0.5},
                                           {1, -1.0, 0.625}, {2, 1.0, -0.125}, {2, -1.0, infinity_double}};
    const auto check = [&](const TextureRegion& region, std::size_t count) {
        const auto planes = texgen::detail::SlidePlanes(region);
        REQUIRE(planes.size() == count);
        std::size_t k = 0;
        for (const SlidePlane& plane : planes) {
            CHECK(plane.coordinate == expected[k].coordinate);
            CHECK(plane.sign == expected[k].sign);
            CHECK(plane.bound == expected[k].bound);
            CHECK(&plane == &planes[k]);
            ++k;
        }
        CHECK(k == count);
    };
    check(tile, 5);
    check(tile.with_depth(-0.125, infinity_double), 7);
    CHECK(texgen::detail::SlidePlanes(tile.with_depth(-0.125, infinity_double))[6].none() == infinity_double);
}

TEST_CASE("a region is empty where its depth is, or one of its numbers is none") {
    using texgen::detail::is_empty;
    const TextureRegion tile = texgen::whole_texture();
    CHECK_FALSE(is_empty(tile));
    CHECK_FALSE(is_empty(tile.with_depth()));
    CHECK_FALSE(is_empty(tile.with_depth(0.5, 0.5)));
    CHECK_FALSE(is_empty(tile.with_depth(-infinity_double, infinity_double)));
    CHECK(is_empty(tile.with_depth(0.5, 0.25)));
    CHECK(is_empty(tile.with_depth(nan_double, 1.0)));
    CHECK(is_empty(tile.with_depth(0.0, nan_double)));
    CHECK(is_empty(texgen::atlas_tile({0.0, 1.0}, {1.0, 0.5}).with_depth()));
}

static_assert(texgen::whole_texture().with_depth() == texgen::whole_texture().with_depth(0.0, 1.0));
static_assert(texgen::whole_texture().with_depth(texgen::opengl, DepthMapping::ndc).depth()->x == -1.0);
static_assert(!texgen::whole_texture().depth());
