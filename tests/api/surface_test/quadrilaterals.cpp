// The homography of a quadrilateral: its corners, what is between them, and what is refused.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "judges/oracle.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/surfaces.hpp"
#include "texgen/surface.hpp"

namespace {

using support::corners_of;
using support::exact_q;
using support::exactly;
using support::hex;
using support::Quadrilateral;
using support::Random;
using support::Rational;
using support::Shape;
using support::shapes;
using support::Worst;
using texgen::keystone;
using texgen::quadrilateral;

std::string hex(const Quadrilateral& corners) {
    return hex(corners[0]) + " " + hex(corners[1]) + " " + hex(corners[2]) + " " + hex(corners[3]);
}

glm::dvec2 corner_of(const texgen::TextureRegion& region, std::size_t i) {
    return {i == 1 || i == 2 ? region.max().x : region.min().x, i >= 2 ? region.max().y : region.min().y};
}

}  // namespace

TEST_CASE("a quadrilateral is refused exactly where it is not strictly convex, and its q are the homography's") {
    Random random(407);
    Worst worst;
    for (const Shape shape : shapes) {
        int count[2] = {};
        for (int i = 0; i < 3000; ++i) {
            const Quadrilateral corners = corners_of(shape, random);
            const auto exact = exact_q(corners);
            const auto strq = quadrilateral(corners);
            bool is_in_range = true;
            if (exact)
                for (const Rational& q : *exact) is_in_range = is_in_range && q >= support::power_of_two(-126);
            REQUIRE_MESSAGE(strq.has_value() == (exact.has_value() && is_in_range), hex(corners));
            REQUIRE_MESSAGE(keystone(corners).has_value() == exact.has_value(), hex(corners));
            ++count[strq.has_value()];
            if (!strq) continue;
            for (std::size_t k = 0; k < 4; ++k) {
                const glm::vec4& corner = (*strq)[k];
                const double error = support::ulp_error(corner.w, (*exact)[k]);
                worst.take(error, [&] { return hex(corners); });
                REQUIRE(corner.x == (k == 1 || k == 2 ? corner.w : 0.0f));
                REQUIRE(corner.y == (k >= 2 ? corner.w : 0.0f));
                REQUIRE(corner.z == 0.0f);
            }
        }
        CAPTURE(static_cast<int>(shape));
        CHECK(std::min(count[0], count[1]) > 200);
    }
    CHECK_MESSAGE(worst.error < 0.51, worst.input);
}

TEST_CASE(
    "the corners of a quadrilateral get the corners of its region to the bit, where the floats about q allow it") {
    Random random(408);
    int exact = 0, all = 0;
    for (int i = 0; i < 20000; ++i) {
        const Quadrilateral corners = corners_of(Shape::ordinary, random);
        const auto region = i % 2 == 0 ? texgen::atlas_tile({random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)},
                                                            {random.uniform(1.0, 3.0), random.uniform(1.0, 3.0)})
                                       : texgen::rectangle_texture(random.integer(1, 8192), random.integer(1, 8192));
        const auto strq = quadrilateral(corners, region);
        const auto of_whole = quadrilateral(corners);
        REQUIRE(strq.has_value() == of_whole.has_value());
        if (!strq) continue;
        for (std::size_t k = 0; k < 4; ++k) {
            const glm::vec4& corner = (*strq)[k];
            const float q = (*of_whole)[k].w;
            const glm::vec2 wanted(corner_of(region, k));
            REQUIRE(corner.w >= support::neighbour(q, -2));
            REQUIRE(corner.w <= support::neighbour(q, 2));
            bool is_exact = true;
            for (int c = 0; c < 2; ++c) {
                const float got = corner[c] / corner.w;
                REQUIRE(std::fabs(got - wanted[c]) <= std::fabs(support::neighbour(wanted[c], 1) - wanted[c]));
                is_exact = is_exact && got == wanted[c];
            }
            exact += is_exact;
            ++all;
        }
    }
    CHECK(exact > all / 100 * 95);
    MESSAGE(exact, " of ", all, " corners are exact");
}

TEST_CASE("a quadrilateral whose s or t would lose digits, being below the normal floats, is refused") {
    const auto trapezoid = [](double half_width) {
        return Quadrilateral{glm::dvec2(-1, 0), glm::dvec2(1, 0), glm::dvec2(half_width, 1),
                             glm::dvec2(-half_width, 1)};
    };
    Random random(4712);
    int refused = 0, made = 0;
    for (int i = 0; i < 20000; ++i) {
        const Quadrilateral corners = trapezoid(std::ldexp(random.uniform(1.0, 2.0), -random.integer(0, 120)));
        const auto coordinate = [&] {
            return random.coin() ? static_cast<double>(random.integer(0, 1))
                                 : std::ldexp(random.uniform(1.0, 2.0), -random.integer(1, 60));
        };
        const glm::dvec2 least(coordinate(), coordinate());
        const auto region = texgen::atlas_tile(least, least + glm::dvec2(1));
        const auto of_whole = quadrilateral(corners), strq = quadrilateral(corners, region);
        REQUIRE(of_whole.has_value());
        bool is_any_lost = false;
        for (std::size_t k = 0; k < 4; ++k) {
            const glm::vec2 wanted(corner_of(region, k));
            for (int c = 0; c < 2; ++c) {
                const double product = static_cast<double>(wanted[c]) * static_cast<double>((*of_whole)[k].w);
                is_any_lost = is_any_lost || (product != 0.0 && product < 0x1p-126 * (1.0 - 0x1p-21));
                if (strq) {
                    const float got = (*strq)[k][c] / (*strq)[k].w;
                    INFO(hex(corners), " region ", hex(region.min()));
                    REQUIRE(std::fabs(got - wanted[c]) <= std::fabs(support::neighbour(wanted[c], 1) - wanted[c]));
                }
            }
        }
        if (is_any_lost) REQUIRE(!strq);
        ++(strq ? made : refused);
    }
    CHECK(std::min(made, refused) > 1000);
    // Of t alone, and where the region has no height for it to be lost in.
    const auto right_angled = [](double height) {
        return Quadrilateral{glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(1, 1), glm::dvec2(0, height)};
    };
    CHECK_FALSE(quadrilateral(right_angled(0x1p-120), texgen::atlas_tile({0.0, 0.0}, {1.0, 0x1p-20})));
    CHECK_FALSE(quadrilateral(right_angled(0x1p-140), texgen::atlas_tile({0.0, 0.0}, {1.0, 0.0})));
}

TEST_CASE("between its corners a quadrilateral has the exact homography's coordinates to 2^-20 of the largest") {
    Random random(409);
    for (int i = 0; i < 2000; ++i) {
        const Quadrilateral corners = corners_of(Shape::ordinary, random);
        const auto region = texgen::atlas_tile({random.uniform(-1.0, 0.9), random.uniform(-1.0, 0.9)},
                                               {random.uniform(1.0, 3.0), random.uniform(1.0, 3.0)});
        const auto exact = exact_q(corners);
        const auto strq = quadrilateral(corners, region);
        if (!strq) continue;
        // A point of either triangle of the diagonal, as a rasteriser mixes them.
        const std::size_t third = random.coin() ? 1 : 3;
        glm::dvec4 mixed(0.0);
        Rational s = 0, t = 0, q = 0;
        for (const std::size_t k : {std::size_t{0}, third, std::size_t{2}}) {
            const double weight = random.uniform(0.0, 1.0);
            mixed += weight * glm::dvec4((*strq)[k]);
            const Rational of_corner = exactly(weight) * (*exact)[k];
            const glm::dvec2 corner = corner_of(region, k);
            s += of_corner * exactly(corner.x);
            t += of_corner * exactly(corner.y);
            q += of_corner;
        }
        REQUIRE(support::absolute_error(mixed.x / mixed.w, Rational(s / q)) < 0x1p-20 * 3.0);
        REQUIRE(support::absolute_error(mixed.y / mixed.w, Rational(t / q)) < 0x1p-20 * 3.0);
    }
}

TEST_CASE("keystone is the exact homography, element by element within 2^-48 of its terms") {
    Random random(410);
    Worst worst;
    for (const Shape shape : shapes) {
        for (int i = 0; i < 500; ++i) {
            const Quadrilateral corners = corners_of(shape, random);
            const auto region = support::region_of(i % 2 == 0, random);
            const auto matrix = keystone(corners, region);
            if (!matrix) continue;
            const double error = support::measured_keystone_error(*matrix, corners, region);
            worst.take(error, [&] { return hex(corners); });
        }
    }
    CHECK_MESSAGE(worst.error <= texgen::keystone_error, worst.input);
    MESSAGE((worst.error * 0x1p52), " times 2^-52 at most: ", worst.input);
    // One area is 2^1100 times another.
    const Quadrilateral graded{{{-0x1p400, 0.0}, {0.0, 0.0}, {0.0, 0x1p-400}, {-0x1p100, 0x1p400}}};
    CHECK(support::measured_keystone_error(keystone(graded).value(), graded, texgen::whole_texture()) <=
          texgen::keystone_error);
}

TEST_CASE(
    "corners that are not finite, or of no size that products hold, are refused; a region's NaN stays where it is") {
    const Quadrilateral square{{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}};
    for (const double bad : {support::nan_double, HUGE_VAL, -HUGE_VAL, 0x1p401, 0x1p-401}) {
        for (int k = 0; k < 8; ++k) {
            Quadrilateral corners = square;
            corners[static_cast<std::size_t>(k / 2)][k % 2] = bad;
            CHECK_FALSE(quadrilateral(corners));
            CHECK_FALSE(keystone(corners));
        }
    }
    const auto region = texgen::atlas_tile({0.0, support::nan_double}, {1.0, 1.0});
    CHECK_FALSE(keystone(square, region));
    const auto strq = quadrilateral(square, region);
    REQUIRE(strq);
    CHECK(std::isnan((*strq)[0].y));
    CHECK((*strq)[2] == glm::vec4(1.0f, 1.0f, 0.0f, 1.0f));
}

TEST_CASE("Everitt's figure 2: a trapezoid's q are as the lengths of its parallel sides") {
    const auto strq = quadrilateral({{{-2.0, 0.0}, {2.0, 0.0}, {1.0, 1.0}, {-1.0, 1.0}}});
    REQUIRE(strq);
    CHECK((*strq)[0] == glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    CHECK((*strq)[1] == glm::vec4(1.0f, 0.0f, 0.0f, 1.0f));
    CHECK((*strq)[2] == glm::vec4(0.5f, 0.5f, 0.0f, 0.5f));
    CHECK((*strq)[3] == glm::vec4(0.0f, 0.5f, 0.0f, 0.5f));
}
