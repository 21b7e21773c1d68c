// What is known without a judge: ranks below 2, a texel a pixel, OpenGL's level, and the score of a projector.

#include "texgen/footprint.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "api/footprint_test/derivatives.hpp"
#include "judges/fragments.hpp"
#include "support/footprint_outputs.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/special_values.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/texcoord.hpp"

namespace footprint_cases {

using support::infinity_double;
using support::nan_double;

TEST_CASE("a Jacobian of rank 1 or 0, and texels that are none, get what the header says") {
    const std::array window{glm::vec2(0, 0), glm::vec2(64, 0), glm::vec2(0, 64)};
    const texgen::FragmentRect rect{3, 4, 21, 5};
    const Triangle constant =
        flat(window, {glm::vec3(0.25f, 0.5f, 2), glm::vec3(0.25f, 0.5f, 1), glm::vec3(0.25f, 0.5f, 4)});
    const Triangle line = flat(window, {glm::vec3(0, 0, 2), glm::vec3(1, 1, 1), glm::vec3(0.25f, 0.25f, 4)});
    {
        const FootprintSetup setup(setup_of(constant), {64.0, 64.0});
        FootprintOutputs out(rect);
        REQUIRE(footprint(setup, rect, out.spans()));
        for (std::size_t k = 0; k < count_of(rect); ++k) {
            for (const std::size_t o : {dsdx, dtdx, dsdy, dtdy, major_s, major_t}) REQUIRE(out[o][k] == 0.0f);
            REQUIRE(out.at(level, k) == -infinity_double);
            REQUIRE(out[anisotropy][k] == 1.0f);
        }
        const auto extremes = setup.extremes(rect);
        REQUIRE(extremes.has_value());
        CHECK(extremes->least_level == -infinity_double);
        CHECK(extremes->largest_level == -infinity_double);
        CHECK(extremes->largest_area == 0.0);
    }
    {
        const FootprintSetup setup(setup_of(line), {64.0, 64.0});
        FootprintOutputs out(rect);
        REQUIRE(footprint(setup, rect, out.spans()));
        for (std::size_t k = 0; k < count_of(rect); ++k) {
            REQUIRE(out.at(anisotropy, k) == infinity_double);
            REQUIRE(std::isfinite(out.at(level, k)));
            REQUIRE(std::fabs(out.at(major_s, k) - out.at(major_t, k)) <= 1e-5 * std::fabs(out.at(major_s, k)));
        }
        const auto one = setup.at(5, 5);
        REQUIRE(one.has_value());
        CHECK(one->anisotropy == infinity_double);
        CHECK(one->singular_values.y == 0.0);
        CHECK(setup.extremes(rect)->largest_anisotropy == infinity_double);
    }
    // t = 3/4 s at every corner, with all the digits that floats have for it: the rank is exact, sums of doubles are
    // not.
    Random random(6700);
    for (int i = 0; i < 200; ++i) {
        Triangle thin = spread_triangle(random, 4.0);
        for (WindowVertex* vertex : support::vertices(thin)) {
            vertex->strq.x = static_cast<float>(random.integer(-(1 << 21), 1 << 21)) * 0x1p-20f;
            vertex->strq.y = 0.75f * vertex->strq.x;
        }
        const auto one = FootprintSetup(setup_of(thin), {64.0, 64.0}).at(200, 200);
        if (one && one->singular_values.x > 0.0) REQUIRE_MESSAGE(one->anisotropy == infinity_double, hex(thin));
    }
    const Triangle plain = flat(window, {glm::vec3(0, 0, 2), glm::vec3(1, 0, 1), glm::vec3(0.25f, 1, 4)});
    for (const double bad : {0.0, -1.0, nan_double, infinity_double, 0x1p200, 0x1p-202}) {
        const double other = bad > 0.0 && bad < infinity_double ? 0x1p2 * bad : 64.0;
        const TexelsPerUnit texels = bad > 0.0 ? TexelsPerUnit{bad, other} : TexelsPerUnit{64.0, bad};
        const FootprintSetup setup(setup_of(plain), texels), good(setup_of(plain), {64.0, 64.0});
        FootprintOutputs out(rect), right(rect);
        REQUIRE(footprint(setup, rect, out.spans()));
        footprint(good, rect, right.spans());
        for (std::size_t k = 0; k < count_of(rect); ++k) {
            for (const std::size_t o : {dsdx, dtdx, dsdy, dtdy})
                REQUIRE(std::fabs(out.at(o, k) - right.at(o, k)) <= 1e-6 * std::fabs(right.at(o, k)));
            for (const std::size_t o : {level, anisotropy, major_s, major_t}) REQUIRE(std::isnan(out[o][k]));
        }
        CHECK(std::isnan(setup.extremes(rect)->largest_level));
        CHECK(std::isnan(setup.at(5, 5)->level));
    }
    const Footprint none = texgen::footprint_of({nan_double, 0.0}, {0.0, 1.0}, TexelsPerUnit{64.0, 64.0});
    CHECK(std::isnan(none.level));
    CHECK(std::isnan(none.anisotropy));
}

TEST_CASE("one texel a pixel is level 0, whatever the region's units") {
    const std::array window{glm::vec2(0, 0), glm::vec2(256, 0), glm::vec2(0, 128)};
    const auto level_of = [&](const texgen::TextureRegion& region, double width, double height) {
        const glm::vec2 min(region.min()), max(region.max());
        const Triangle triangle =
            flat(window, {glm::vec3(min, 1), glm::vec3(max.x, min.y, 1), glm::vec3(min.x, max.y, 1)});
        const FootprintSetup setup(setup_of(triangle, region), texgen::texels_per_unit(region, width, height));
        return setup.at(10, 10).value();
    };
    for (const texgen::TextureRegion& region :
         {texgen::whole_texture(), texgen::rectangle_texture(256, 128), texgen::atlas_tile({0.25, 0.5}, {0.5, 0.75})}) {
        CHECK(level_of(region, 256, 128).level == doctest::Approx(0.0));
        CHECK(level_of(region, 256, 128).anisotropy == doctest::Approx(1.0));
        CHECK(level_of(region, 1024, 128).level == doctest::Approx(2.0));
        CHECK(level_of(region, 1024, 128).anisotropy == doctest::Approx(4.0));
        CHECK(level_of(region, 1024, 128).major.y == doctest::Approx(0.0));
    }
    CHECK(texgen::texels_per_unit(texgen::rectangle_texture(256, 128), 256, 128).s == 1.0);
}

TEST_CASE("OpenGL's level is that of the longer column, not of the larger singular value") {
    const Footprint sheared = texgen::footprint_of({1.0, 1.0}, {1.0, 1.0 + 1e-9}, TexelsPerUnit{1.0, 1.0});
    CHECK(sheared.level == doctest::Approx(0.5));
    CHECK(sheared.singular_values.x == doctest::Approx(2.0));
    CHECK(sheared.major.x == doctest::Approx(std::sqrt(2.0)));
    CHECK(sheared.major.y == doctest::Approx(std::sqrt(2.0)));
    const Footprint mirrored = texgen::footprint_of({-3.0, 0.0}, {0.0, 2.0}, TexelsPerUnit{2.0, 1.0});
    CHECK(mirrored.singular_values.x == doctest::Approx(6.0));
    CHECK(mirrored.singular_values.y == doctest::Approx(2.0));
    CHECK(mirrored.anisotropy == doctest::Approx(3.0));
    CHECK(std::fabs(mirrored.major.x) == doctest::Approx(3.0));
}

TEST_CASE(
    "a projector that faces the camera has a positive score, a parallel one 0, one beside the camera a negative one") {
    // A floor seen from (0, 2, 10) towards -z.
    const auto camera = texgen::make_projector(
        texgen::PerspectiveLens{.fovy = texgen::degrees(60), .aspect = 1, .z_near = 0.1, .z_far = 100},
        texgen::Aim{.position = {0, 2, 10}, .target = {0, 0, -10}, .up = {0, 1, 0}}, texgen::opengl);
    REQUIRE(camera.has_value());
    const std::array<glm::vec3, 3> floor{glm::vec3(-3, 0, 6), glm::vec3(3, 0, 6), glm::vec3(0, 0, -20)};
    const auto score = [&](const texgen::Projector& projector) {
        std::array<glm::vec4, 3> strq;
        texgen::generate(texgen::texture_from_world(projector), texgen::world_space(floor), std::span(strq));
        Triangle triangle{};
        const auto corner = support::vertices(triangle);
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec4 clip = camera->matrix().matrix() * glm::dvec4(floor[i], 1.0);
            *corner[i] = {glm::vec2(256.0 + 256.0 * clip.x / clip.w, 256.0 + 256.0 * clip.y / clip.w),
                          static_cast<float>(clip.w), strq[i]};
        }
        return texgen::headlights(triangle);
    };
    const texgen::PerspectiveLens lens{.fovy = texgen::degrees(40), .aspect = 1, .z_near = 0.1, .z_far = 100};
    const texgen::Aim facing{.position = {0, 3, -25}, .target = {0, 0, 6}, .up = {0, 1, 0}};
    const texgen::Aim beside{.position = {1, 2, 10}, .target = {0, 0, -10}, .up = {0, 1, 0}};
    const texgen::OrthographicLens parallel{
        .left = -9, .right = 9, .bottom = -9, .top = 9, .z_near = 0.1, .z_far = 100};
    CHECK(score(texgen::make_projector(lens, facing, texgen::opengl).value()) > 3.0);
    CHECK(score(texgen::make_projector(lens, beside, texgen::opengl).value()) < -3.0);
    CHECK(std::fabs(score(texgen::make_projector(parallel, facing, texgen::opengl).value())) < 1e-6);
    Triangle bad = flat({glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)},
                        {glm::vec3(0, 0, 1), glm::vec3(0, 1, 1), glm::vec3(1, 1, 1)});
    bad.a.clip_w = 0.5f;
    bad.c.clip_w = 2.0f;
    bad.c.strq.w = -1.0f;
    CHECK(texgen::headlights(bad) == infinity_double);
    std::swap(bad.b, bad.c);  // no corner is far from it alone
    bad.c.clip_w = 3.0f;
    CHECK(texgen::headlights(bad) == infinity_double);
    const Triangle good = bad;
    for (const float no_number : {support::nan_float, HUGE_VALF}) {
        for (std::size_t i = 0; i < 3; ++i) {
            bad = good;
            support::vertices(bad)[i]->strq.w = no_number;
            CHECK(std::isnan(texgen::headlights(bad)));
            bad = good;
            support::vertices(bad)[i]->clip_w = no_number;
            CHECK(std::isnan(texgen::headlights(bad)));
        }
    }
}

TEST_CASE("the score is that of the triangle, in whatever order its corners are") {
    Random random(4713);
    int finite = 0, infinite = 0;
    for (int i = 0; i < 2000; ++i) {
        Triangle triangle{};
        for (WindowVertex* vertex : support::vertices(triangle)) {
            const auto whole = [&](int least, int largest) {
                return static_cast<float>(random.integer(least, largest));
            };
            *vertex = {{0, 0}, whole(1, 3), {0, 0, 0, whole(-1, 4)}};
        }
        const auto& [a, b, c] = triangle;
        const double score = texgen::headlights(triangle);
        for (const Triangle& turned :
             {Triangle{a, c, b}, Triangle{b, a, c}, Triangle{b, c, a}, Triangle{c, a, b}, Triangle{c, b, a}}) {
            const double turned_score = texgen::headlights(turned);
            INFO(hex(triangle), " ", turned_score, " ", score);
            REQUIRE((turned_score == score || (std::isnan(turned_score) && std::isnan(score))));
        }
        float least_w = 4.0f, q_there = 0.0f;
        for (const WindowVertex* vertex : support::vertices(triangle)) {
            if (vertex->clip_w > least_w) continue;
            q_there = vertex->clip_w < least_w ? vertex->strq.w : std::max(q_there, vertex->strq.w);
            least_w = vertex->clip_w;
        }
        REQUIRE(std::isnan(score) == (q_there <= 0.0f));
        finite += std::isfinite(score);
        infinite += std::isinf(score);
        REQUIRE((std::isinf(score) || std::isnan(score)) == (a.strq.w <= 0 || b.strq.w <= 0 || c.strq.w <= 0));
    }
    CHECK(std::min(finite, infinite) > 300);
}

}  // namespace footprint_cases
