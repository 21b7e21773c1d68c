// What is rounded onto the sides of a slide or off them, and sums that cancel to their last bits there.

#include <doctest/doctest.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "judges/oracle.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "texgen/coverage.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::hex;
using support::Random;
using texgen::atlas_tile;
using texgen::Box;
using texgen::coverage;
using texgen::Coverage;
using texgen::TextureRegion;
using texgen::whole_texture;
using texgen::WorldTexgen;

}  // namespace

TEST_CASE("what rounds onto a side of the region is not outside, and what rounds off it is not inside") {
    // s = x + offset, t = 0.5, q = 1.
    const auto of = [](double offset, const TextureRegion& region, float x) {
        glm::dmat4 matrix(0.0);
        matrix[0][0] = 1.0;
        matrix[3] = {offset, 0.5, 0.0, 1.0};
        const WorldTexgen transform(matrix);
        const glm::vec3 point(x, 0.0f, 0.0f);
        float lit = -1.0f;
        project(transform, texgen::world_space(std::span(&point, 1)), region,
                {.s = {}, .t = {}, .r = {}, .lit = {&lit, 1}});
        const Coverage answer = coverage(transform, region, Box{point, point});
        const Coverage of_sphere = coverage(transform, region, texgen::Sphere{point, 0.0f});
        CHECK((of_sphere == answer || of_sphere == Coverage::partial));
        if (answer != Coverage::partial) CHECK(lit == (answer == Coverage::inside ? 1.0f : 0.0f));
        return answer;
    };
    const TextureRegion whole = whole_texture();
    CHECK(of(0x0.40p-23, whole, 1.0f) == Coverage::partial);  // a quarter of an ulp outside is lit
    CHECK(of(0x0.80p-23, whole, 1.0f) == Coverage::partial);  // a tie that goes to the even 1
    CHECK(of(0x0.c0p-23, whole, 1.0f) == Coverage::partial);  // not beyond the next float
    CHECK(of(0x1.01p-23, whole, 1.0f) == Coverage::outside);
    CHECK(of(0.0, whole, 1.0f) == Coverage::inside);
    CHECK(of(0.0, whole, 0.0f) == Coverage::inside);
    CHECK(of(-0x0.81p-23, atlas_tile({1.0, 0.0}, {2.0, 1.0}), 1.0f) == Coverage::outside);
    CHECK(of(-0x0.40p-23, atlas_tile({1.0, 0.0}, {2.0, 1.0}), 1.0f) == Coverage::partial);
    CHECK(of(-0x1p-126, whole, 0.0f) == Coverage::partial);
    CHECK(of(-0x1.00001p-126, whole, 0.0f) == Coverage::outside);

    // The first float inside is half an ulp above 0.7, whose nearest is below.
    const TextureRegion tile = atlas_tile({0.7, 0.0}, {1.0, 1.0});
    const float below = 0.7f, above = std::nextafter(0.7f, 1.0f);
    REQUIRE(static_cast<double>(below) < 0.7);
    CHECK(of(0.0, tile, above) == Coverage::inside);
    CHECK(of(0.7 - static_cast<double>(below), tile, below) == Coverage::partial);  // inside, and rounds to below
    CHECK(of(0x0.78p-24, tile, below) == Coverage::partial);
    CHECK(of(-0x1p-30, tile, below) == Coverage::outside);

    // The same of points whose s is anywhere about a side.
    Random random(44);
    int outside = 0, inside = 0, lit_and_outside_in_reals = 0;
    for (int i = 0; i < 30000; ++i) {
        const double side = random.coin() ? random.uniform(-2.0, 2.0) : random.uniform_float(-2.0, 2.0);
        const TextureRegion region =
            random.coin() ? atlas_tile({side, 0.0}, {4.0, 1.0}) : atlas_tile({-4.0, 0.0}, {side, 1.0});
        const float x = support::neighbour(support::to_float(side), random.integer(-1, 1));
        const double offset = random.uniform(-1.5, 1.5) * 0x1p-23 * std::fabs(side);
        const Coverage answer = of(offset, region, x);
        outside += answer == Coverage::outside;
        inside += answer == Coverage::inside;
        const double s = static_cast<double>(x) + offset;
        lit_and_outside_in_reals += answer == Coverage::partial && !(s >= region.min().x && s <= region.max().x);
    }
    CHECK(outside > 3000);
    CHECK(inside > 3000);
    CHECK(lit_and_outside_in_reals > 1000);
}

TEST_CASE(
    "beyond the largest float nothing is inside, and what rounds to infinity is not outside of what begins there") {
    const auto of = [](double s, const TextureRegion& region) {
        glm::dmat4 matrix(0.0);
        matrix[3] = {s, 0.5, 0.0, 1.0};
        return coverage(WorldTexgen(matrix), region, Box{glm::vec3(0.0f), glm::vec3(1.0f)});
    };
    const TextureRegion far_away = atlas_tile({0x1p129, 0.0}, {0x1p131, 1.0});
    CHECK(of(0x1p130, far_away) == Coverage::partial);
    CHECK(of(0x1.ffffffp127, far_away) == Coverage::partial);
    CHECK(of(0x1.fffffdp127, far_away) == Coverage::outside);
    const TextureRegion to_there = atlas_tile({0.0, 0.0}, {0x1p130, 1.0});
    CHECK(of(0x1.fffffep127, to_there) == Coverage::inside);
    CHECK(of(0x1p129, to_there) == Coverage::partial);
    CHECK(of(0x1p131, to_there) == Coverage::partial);  // no float is beyond the side
}

TEST_CASE("a batch has room for what rounds off the slide where s hardly changes") {
    // s = 1 + 2^-20 x / z is rounded to 1 next to x = 0, and t = 1/2: only x >= 0 is inside [1, 2].
    glm::dmat4 matrix(0.0);
    matrix[0][0] = 0x1p-20;
    matrix[2] = {1.0, 0.5, 0.0, 1.0};
    const WorldTexgen transform(matrix);
    const TextureRegion region = atlas_tile({1.0, 0.0}, {2.0, 1.0});
    std::vector<Box> boxes;
    for (const float x : {-0.2f, -0.01f, 0.0f, 0.01f}) boxes.push_back({{x, 0.0f, 1.0f}, {x, 1.0f, 1.5f}});
    std::vector<Coverage> answers(boxes.size());
    coverage(transform, region, boxes, answers);
    CHECK(answers == std::vector{Coverage::outside, Coverage::partial, Coverage::inside, Coverage::inside});
}

TEST_CASE("what cancels to less than two doubles hold is not taken for 0") {
    // At (1, 1, 1) is s - q = 1 + 2^-53 - 2^-130 - 1 - 2^-53, so that s/q is rounded to 1 and is less.
    const auto of = [](double of_z) {
        glm::dmat4 matrix(0.0);
        matrix[0][0] = 1.0;
        matrix[1][0] = 0x1p-53;
        matrix[2][0] = of_z;
        matrix[3] = {-1.0, 0x1p-54, 0.0, 0x1p-53};
        const Box boxes[] = {{glm::vec3(1.0f), glm::vec3(1.0f)}};
        Coverage answers[] = {Coverage::outside};
        coverage(WorldTexgen(matrix), atlas_tile({1.0, 0.0}, {2.0, 1.0}), boxes, answers);
        CHECK(coverage(WorldTexgen(matrix), atlas_tile({1.0, 0.0}, {2.0, 1.0}), boxes[0]) == answers[0]);
        return answers[0];
    };
    CHECK(of(-0x1p-130) == Coverage::partial);
    CHECK(of(0.0) == Coverage::inside);
    CHECK(of(0x1p-130) == Coverage::inside);
}

TEST_CASE("what cancels only after a double has lost digits of it is 0") {
    Random random(1109);
    for (int i = 0; i < 20; ++i) {
        const double slope = 1.0 + 0x1p-52;
        const float tiny = 0x1p-100f * random.uniform_float(1.0, 2.0);
        glm::dmat4 matrix(0.0);
        matrix[0][0] = slope;
        matrix[1][0] = -slope;
        matrix[2][0] = 1.0;
        matrix[3] = {-1.0, 0.5, 0.0, 1.0};
        const std::vector<Box> boxes(2, Box{glm::vec3(tiny, tiny, 1.0f), glm::vec3(tiny, tiny, 1.0f)});
        std::vector<Coverage> together(2);
        coverage(WorldTexgen(matrix), whole_texture(), boxes, together);
        CHECK(together[0] == Coverage::inside);
        CHECK(coverage(WorldTexgen(matrix), whole_texture(), boxes[0]) == Coverage::inside);
    }
}

TEST_CASE("a side is decided exactly where its terms have too many digits for two doubles") {
    // At the point (1 + 2^-23, 2^-40, 0) s is (1 + 2^-23) q but for the tiny term of y.
    const double side = 0x1.000002p0, q = 0x1.0000000000001p0;
    for (const double tiny : {0x1p-100, -0x1p-100}) {
        glm::dmat4 matrix(0.0);
        matrix[0] = {q, 0.0, 0.0, 0.0};
        matrix[1] = {tiny, 0.0, 0.0, 0.0};
        matrix[3] = {0.0, 1.0, 0.0, q};
        const glm::vec3 point(0x1.000002p0f, 0x1p-40f, 0.0f);
        const texgen::LitVolume<texgen::World> volume(texgen::WorldTexgen(matrix),
                                                      texgen::atlas_tile({side, 0.0}, {2.0, 2.0}));
        CHECK(volume.coverage(texgen::Box{point, point}) ==
              (tiny > 0.0 ? texgen::Coverage::inside : texgen::Coverage::partial));
    }
}

TEST_CASE("a point on sides of the slide is lit where q is positive at all, and is not outside") {
    Random random(1107);
    int lit_ones = 0;
    for (int i = 0; i < 1000; ++i) {
        // s and t are 0, and q is what its last bits leave.
        const glm::dvec2 of_q(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        const glm::vec3 point(0.0f, random.uniform_float(-1.0, 1.0), random.uniform_float(-1.0, 1.0));
        glm::dmat4 matrix(0.0);
        matrix[1] = {static_cast<double>(point.z), 0.0, 0.0, of_q.x};
        matrix[2] = {-static_cast<double>(point.y), 0.0, 0.0, of_q.y};
        matrix[3].w = -(of_q.x * static_cast<double>(point.y) + of_q.y * static_cast<double>(point.z));
        const WorldTexgen transform(matrix);
        const bool is_lit = texgen::project(transform, texgen::world_space(point)).has_value();
        lit_ones += is_lit;
        CHECK((coverage(transform, whole_texture(), Box{point, point}) == Coverage::outside) == !is_lit);
    }
    CHECK(lit_ones > 200);
}

TEST_CASE("a point whose side is what the last bits of cancelling coefficients leave is told alone as in company") {
    Random random(1108);
    const texgen::TextureRegion region = texgen::atlas_tile({0.0, -1.0}, {1.0, 2.0});
    int inside = 0;
    for (int i = 0; i < 4000; ++i) {
        glm::dmat4 matrix;
        for (glm::length_t column = 0; column < 4; ++column)
            for (glm::length_t row = 0; row < 4; ++row) matrix[column][row] = random.integer(-2, 2) * (1.0 + 0x1p-50);
        const WorldTexgen transform(matrix);
        glm::vec3 point;
        for (glm::length_t j = 0; j < 3; ++j)
            point[j] = random.coin() ? static_cast<float>(random.integer(-3, 3)) : random.coin() ? 0x1p-60f : 0x1p-120f;
        const std::vector<Box> boxes(2, Box{point, point});
        std::vector<Coverage> together(2);
        coverage(transform, region, boxes, together);
        INFO(i);
        CHECK(coverage(transform, region, boxes[0]) == together[0]);
        inside += together[0] == Coverage::inside;
    }
    CHECK(inside > 200);
}

TEST_CASE("a box beside a side by 2^-53 is beside it, and on it touches it, whatever has cancelled to leave that") {
    Random random(950);
    int outside = 0, inside = 0;
    for (int i = 0; i < 4000; ++i) {
        // At (x0, y0) both s = k (y0 x - x0 y) + c and q = g (y0 x - x0 y) + 1 have their last terms alone: the others
        // cancel, of which a side has sums of 150 bits.
        const float x = random.uniform_float(128.0, 256.0), y = random.uniform_float(128.0, 256.0);
        const auto of_29_bits = [&](int exponent) {
            return std::ldexp(random.integer(1 << 28, (1 << 29) - 1), exponent - 29);
        };
        const double k = of_29_bits(random.integer(0, 100)), g = of_29_bits(-12);
        const float side = random.uniform_float(0.5, 1.0), before = std::nextafter(side, 0.0f);
        const int sign = random.integer(-1, 1);
        const auto texgen_of = [&](float at) {
            glm::dmat4 matrix(0.0);
            matrix[0] = {static_cast<double>(y) * k, 0.0, 0.0, static_cast<double>(y) * g};
            matrix[1] = {-static_cast<double>(x) * k, 0.0, 0.0, -static_cast<double>(x) * g};
            matrix[3] = {static_cast<double>(at) + sign * 0x1p-53, 0.5, 0.0, 1.0};
            return WorldTexgen(matrix);
        };
        const TextureRegion region = atlas_tile({static_cast<double>(side), 0.0}, {0x1p120, 1.0});
        const Box below{{x - 1.0f, y, 0.0f}, {x, y + 1.0f, 1.0f}}, above{{x, y - 1.0f, 0.0f}, {x + 1.0f, y, 1.0f}};
        // No float is between the side and the one before, which is outside.
        const Coverage of_below = coverage(texgen_of(before), region, below);
        const Coverage of_above = coverage(texgen_of(side), region, above);
        const std::string context = hex(k) + " " + hex(g) + " " + hex(x) + " " + hex(y) + " " + hex(side);
        CHECK_MESSAGE(of_below == (sign < 0 ? Coverage::outside : Coverage::partial), context);
        CHECK_MESSAGE(of_above == (sign < 0 ? Coverage::partial : Coverage::inside), context);
        outside += of_below == Coverage::outside;
        inside += of_above == Coverage::inside;
    }
    CHECK(outside > 1000);
    CHECK(inside > 2000);
}
