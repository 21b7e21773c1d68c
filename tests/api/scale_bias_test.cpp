// The scale-bias matrix S against the remap without a matrix, and both against exact rationals.

#include "texgen/scale_bias.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "judges/oracle.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/windows.hpp"

namespace {

using support::any_conventions;
using support::exactly;
using support::hex;
using support::Random;
using support::Rational;
using texgen::Conventions;
using texgen::DepthMapping;
using texgen::DepthRange;
using texgen::NdcY;
using texgen::TextureOrigin;
using texgen::TextureRegion;

TextureRegion random_region(Random& random) {
    switch (random.integer(0, 2)) {
        case 0:
            return texgen::whole_texture();
        case 1:
            return texgen::rectangle_texture(random.integer(1, 4096), random.integer(1, 4096));
        default: {
            const glm::dvec2 corner(random.uniform(-1.0, 1.0) * random.power_of_ten(-3.0, 6.0),
                                    random.uniform(0.0, 1.0));
            return texgen::atlas_tile(
                corner, corner + glm::dvec2(random.power_of_ten(-3.0, 3.0), random.power_of_ten(-3.0, 0.0)));
        }
    }
}

glm::vec4 random_clip(Random& random) {
    const double w = random.power_of_ten(-6.0, 6.0) * (random.integer(0, 3) == 0 ? -1.0 : 1.0);
    glm::vec4 clip(0.0f, 0.0f, 0.0f, support::to_float(w));
    for (int k = 0; k < 3; ++k) {
        // On an edge, next to one, inside, or far outside.
        const int place = random.integer(0, 3);
        const float edge = random.coin() ? clip.w : -clip.w;
        clip[k] = place == 0   ? edge
                  : place == 1 ? support::neighbour(edge, random.integer(-2, 2))
                  : place == 2 ? support::to_float(w * random.uniform(-1.0, 1.0))
                               : support::to_float(w * random.uniform(-1e6, 1e6));
    }
    return clip;
}

// One coordinate of the region by its definition: linear from `at_minus` at clip = -w to `at_plus` at clip = w.
Rational remapped(double at_minus, double at_plus, float clip, float w) {
    return (exactly(at_minus) * (exactly(w) - exactly(clip)) + exactly(at_plus) * (exactly(w) + exactly(clip))) / 2;
}

}  // namespace

TEST_CASE("the remap without a matrix is within its stated error of the definition, and exact at the edges") {
    Random random(61);
    int edges = 0, cancelling = 0;
    for (int i = 0; i < 10000; ++i) {
        const Conventions conventions = any_conventions(random);
        const TextureRegion region = random_region(random);
        const DepthMapping mapping = random.coin() ? DepthMapping::unit : DepthMapping::ndc;
        glm::vec4 clip = random_clip(random);
        const bool upright = (conventions.ndc_y == NdcY::up) == (conventions.origin == TextureOrigin::bottom_left);
        const bool halved = mapping == DepthMapping::unit && conventions.depth == DepthRange::negative_one_to_one;
        const std::array<std::array<double, 2>, 3> ends{
            {{region.min().x, region.max().x},
             {upright ? region.min().y : region.max().y, upright ? region.max().y : region.min().y},
             {halved ? 0.0 : -1.0, 1.0}}};
        // Some next to the texture's 0, where the ulp is small beside what is added.
        for (int k = 0; k < 3 && i % 4 == 0; ++k) {
            const auto [at_minus, at_plus] = ends[static_cast<std::size_t>(k)];
            clip[k] = support::to_float(static_cast<double>(clip.w) * (at_minus + at_plus) / (at_minus - at_plus));
        }
        const glm::vec4 strq = to_texture(clip, conventions, region, mapping);
        REQUIRE(strq.w == clip.w);
        for (int k = 0; k < 3; ++k) {
            const auto [at_minus, at_plus] = ends[static_cast<std::size_t>(k)];
            const Rational exact = remapped(at_minus, at_plus, clip[k], clip.w);
            const Rational slack = exactly(texgen::to_texture_error) *
                                   exactly(std::max(std::fabs(at_minus), std::fabs(at_plus))) *
                                   exactly(std::max(std::fabs(clip[k]), std::fabs(clip.w)));
            cancelling += exact != 0 && support::magnitude(exact) < slack * support::power_of_two(29);
            const Rational half_ulp = support::power_of_two(support::ulp_exponent<float>(exact) - 1);
            REQUIRE_MESSAGE(support::magnitude(exactly(strq[k]) - exact) <= half_ulp + slack, hex(clip), " ", k);
            if (clip[k] == clip.w || clip[k] == -clip.w) {
                ++edges;
                const double end = clip[k] == clip.w ? at_plus : at_minus;
                REQUIRE_MESSAGE(strq[k] == static_cast<float>(end * static_cast<double>(clip.w)), hex(clip), " ", k);
            }
        }
    }
    CHECK(edges > 5000);
    CHECK(cancelling > 500);
}

TEST_CASE("the remap without a matrix equals S times the clip coordinate") {
    Random random(62);
    for (int i = 0; i < 5000; ++i) {
        const Conventions conventions = any_conventions(random);
        const TextureRegion region = random_region(random);
        const DepthMapping mapping = random.coin() ? DepthMapping::unit : DepthMapping::ndc;
        const glm::vec4 clip = random_clip(random);
        const glm::vec4 strq = to_texture(clip, conventions, region, mapping);
        const glm::dvec4 product = scale_bias(conventions, region, mapping).matrix() * glm::dvec4(clip);
        const double largest = std::max({std::fabs(region.min().x), std::fabs(region.max().x),
                                         std::fabs(region.min().y), std::fabs(region.max().y), 1.0});
        for (int k = 0; k < 4; ++k) {
            const double size = largest * std::max(std::fabs(static_cast<double>(clip.w)),
                                                   std::fabs(static_cast<double>(k < 3 ? clip[k] : 0.0f)));
            REQUIRE_MESSAGE(std::fabs(static_cast<double>(strq[k]) - product[k]) <=
                                0x1p-24 * std::fabs(product[k]) + 0x1p-50 * size,
                            hex(clip), " ", k);
        }
    }
}

TEST_CASE("x and y in [-w, w] become [0, w] for the whole texture") {
    const glm::vec4 low = texgen::to_texture({-3, -3, -3, 3}, texgen::opengl);
    const glm::vec4 high = texgen::to_texture({3, 3, 3, 3}, texgen::opengl);
    CHECK(low == glm::vec4(0, 0, 0, 3));
    CHECK(high == glm::vec4(3, 3, 3, 3));
    CHECK(texgen::to_texture({1, 1, 1, 1}, texgen::direct3d) == glm::vec4(1, 0, 1, 1));
    CHECK(texgen::to_texture({1, 1, 0, 1}, texgen::vulkan) == glm::vec4(1, 1, 0, 1));
    CHECK(texgen::to_texture({0, 0, 0, 2}, texgen::opengl, texgen::rectangle_texture(640, 480)) ==
          glm::vec4(640, 480, 1, 2));
}

TEST_CASE("a bad value spoils its own component, and w all of them") {
    const glm::vec4 spoiled = texgen::to_texture({support::nan_float, 1, 1, 2}, texgen::opengl);
    CHECK_FALSE(spoiled.x == spoiled.x);
    CHECK(spoiled.y == 1.5f);
    CHECK(spoiled.z == 1.5f);
    CHECK(spoiled.w == 2.0f);
    const glm::vec4 all = texgen::to_texture({1, 1, 1, support::nan_float}, texgen::opengl);
    for (int k = 0; k < 4; ++k) CHECK_FALSE(all[k] == all[k]);
}
