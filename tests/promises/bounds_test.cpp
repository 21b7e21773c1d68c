// Inputs whose roundings all go the same way, so that an error comes as near to its bound as it can: a bound that is
// less than the roundings add up to, does not hold here.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/verdict.hpp"
#include "support/hex.hpp"
#include "support/near_cut.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/triangles.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::everywhere;
using support::hex;
using support::Outputs;
using support::Random;
using texgen::Tolerance;

constexpr double unit_roundoff = 0x1p-24;

// The number of points that are not what exact gives: they came from a cheaper tier.
int count_of_cheap(const glm::dmat4& matrix, const std::vector<glm::vec3>& points, Tolerance tolerance) {
    Outputs out(points.size()), exact(points.size());
    project(texgen::ObjectTexgen(matrix), texgen::object_space(points), everywhere(), out.spans(), tolerance);
    project(texgen::ObjectTexgen(matrix), texgen::object_space(points), everywhere(), exact.spans());
    int cheap = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::string wrong =
            what_is_wrong(support::exactly_at(matrix, points[i]), everywhere(), tolerance, out, i);
        REQUIRE_MESSAGE(wrong.empty(), wrong, " for ", hex(points[i]), " by ", hex(matrix), ", tolerance ",
                        hex(tolerance.value));
        cheap += !support::same_bits(out.s()[i], exact.s()[i]);
    }
    return cheap;
}

}  // namespace

TEST_CASE("forms in float whose coefficients and sums are all rounded the same way stay inside the tolerance") {
    // s: 1 + 2^-24 and three times 2^-24 are rounded down to 1, one by one; q: 1 + 3 * 2^-24 is rounded up, and three
    // times -2^-24 leave it there. The quotient is 8 unit roundoffs too small; and all that eight times.
    constexpr double last = 8.0 * unit_roundoff;
    glm::dmat4 matrix(0.0);
    for (int j = 0; j < 3; ++j) matrix[j] = {last, last, last, -unit_roundoff};
    matrix[3] = {8.0 + last, 8.0 + last, 8.0 + last, 1.0 + 3.0 * unit_roundoff};
    // About the origin; and, in blocks that follow those of one which is not in front, about points of which some are there.
    std::vector<glm::vec3> in_front(2048, glm::vec3(1.0f)), about_points = in_front;
    for (std::size_t i = 1; i < 2048; i += 2) about_points[i] = glm::vec3(0.0f);
    about_points[0] = glm::vec3(1e7f);
    for (const std::vector<glm::vec3>* points : {&in_front, &about_points}) {
        int cheap = 0;
        for (double units = 1.0; units < 40.0; units += 0.25) cheap += count_of_cheap(matrix, *points, {units * last});
        CHECK(cheap > 1000);
    }
}

TEST_CASE("forms about a point lose what is rounded there, and what their constants lose in double") {
    Random random(6100);
    int cheap = 0;
    for (int i = 0; i < 400; ++i) {
        // On a plane far away, whose forms are small numbers there: constants of 2^36 cancel.
        const glm::vec3 place(random.uniform_float(0x1p25, 0x1p26), random.uniform_float(0x1p25, 0x1p26), 0.0f);
        glm::dmat4 matrix(0.0);
        for (int k = 0; k < 2; ++k) {
            const double x = random.uniform(512.0, 1024.0), y = random.uniform(512.0, 1024.0);
            matrix[0][k] = x;
            matrix[1][k] = y;
            matrix[2][k] = random.uniform(-1.0, 1.0);
            matrix[3][k] = -std::fma(x, static_cast<double>(place.x), y * static_cast<double>(place.y)) +
                           random.uniform(-1.0, 1.0);
        }
        matrix[2].w = 1.0;
        matrix[3].w = 0.5;
        std::vector<glm::vec3> points(64, place);
        for (glm::vec3& point : points) point.z = random.uniform_float(1.0, 2.0);
        points.back().z = -1.0f;  // behind, so that the block is not all in front
        cheap += count_of_cheap(matrix, points, {random.power_of_ten(-5.0, -3.0)});
    }
    CHECK(cheap > 1000);
}

TEST_CASE("float functions of a segment stay inside the tolerance at every multiple of the unit roundoff") {
    Random random(6200);
    int cheap = 0;
    for (int i = 0; i < 3000; ++i) {
        // Ends that are almost one another, or not at all.
        const double spread = random.coin() ? 40.0 * 0x1p-23 : 1.0;
        const auto about_one = [&] { return random.uniform_float(1.0, 1.0 + spread); };
        const float s = about_one(), t = about_one();
        const texgen::Segment segment{{s, t, 0.0f, about_one()},
                                      {random.coin() ? s : about_one(), t, 0.0f, about_one()}};
        std::vector<float> alpha(64);
        for (float& a : alpha) a = random.uniform_float(0.0, 1.0);
        const Tolerance tolerance{random.uniform(1.0, 14.0) * unit_roundoff};
        Outputs out(alpha.size()), exact(alpha.size());
        interpolate(segment, alpha, everywhere(), out.spans(), tolerance);
        interpolate(segment, alpha, everywhere(), exact.spans());
        for (std::size_t k = 0; k < alpha.size(); ++k) {
            const std::string wrong =
                what_is_wrong(support::exactly_at(segment, alpha[k]), everywhere(), tolerance, out, k);
            REQUIRE_MESSAGE(wrong.empty(), wrong, " at ", hex(alpha[k]), " of ", hex(segment.a), " ", hex(segment.b));
            cheap += !support::same_bits(out.s()[k], exact.s()[k]);
        }
    }
    CHECK(cheap > 100);
}

TEST_CASE("functions over a triangle in float, or in double and rounded, stay inside the tolerance") {
    Random random(6300);
    int cheap = 0;
    for (int i = 0; i < 4000; ++i) {
        const auto vertex = [&](float x, float y) {
            const auto about = [&](double size) { return random.uniform_float(size, size * (1.0 + 0x1p-6)); };
            return texgen::WindowVertex{{x, y}, 1.0f, {about(1.0), about(1.0), 0.0f, about(1.0)}};
        };
        const texgen::Triangle triangle{vertex(0.0f, 0.0f), vertex(64.0f, 0.0f), vertex(0.0f, 64.0f)};
        const support::ExactTriangle exact(triangle);
        // Rows of 15 are too short for float functions, and a row of 30 is too little for polynomials.
        const bool is_float = random.coin();
        const texgen::FragmentRect rect{random.integer(0, 20), random.integer(0, 20), is_float ? 30 : 15,
                                        is_float ? 1 : 2};
        const Tolerance tolerance{random.uniform(1.0, is_float ? 7.0 : 4.5) * unit_roundoff};
        Outputs out(30), nearest(30);
        interpolate(support::setup_of(triangle), rect, nearest.spans());
        // A tile that is about the tolerance away from a side may be all lit, which small ones do not decide.
        const double least = *std::min_element(nearest.s().begin(), nearest.s().end());
        const texgen::TextureRegion region =
            texgen::atlas_tile({least - 2.0 * tolerance.value - 4.0 * unit_roundoff, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL});
        const texgen::TriangleSetup setup = support::setup_of(triangle, region, tolerance);
        const texgen::Work work = interpolate(setup, rect, out.spans());
        support::Seen seen;
        const std::string wrong = first_wrong({triangle, rect}, exact, region, tolerance, work, out, seen);
        REQUIRE_MESSAGE(wrong.empty(), wrong, " of ", support::hex(triangle), ", tolerance ", hex(tolerance.value));
        for (std::size_t k = 0; k < out.size(); ++k) cheap += !support::same_bits(out.s()[k], nearest.s()[k]);
    }
    CHECK(cheap > 1000);
}

TEST_CASE("the bounds of forms, of mixtures and of planes in double cover their errors, and not by much") {
    Random random(6400);
    double of_form = 0.0, of_mixture = 0.0, of_plane = 0.0;
    const auto share = [](const texgen::detail::Bounded& bounded, const support::Dyadic& exact) {
        return magnitude(support::Dyadic(bounded.value) - exact).estimate() / bounded.error;
    };
    const auto any = [&] { return random.uniform(0.5, 1.0) * (random.coin() ? 1.0 : -1.0); };
    for (int i = 0; i < 20000; ++i) {
        glm::dmat4 matrix(0.0);
        for (int j = 0; j < 4; ++j) matrix[j][0] = any();
        const glm::vec3 point(support::to_float(any()), support::to_float(any()), support::to_float(any()));
        of_form = std::max(of_form, share(texgen::detail::value_at(texgen::detail::form(matrix, 0), glm::dvec3(point)),
                                          support::exactly_at(matrix, point).s));

        const texgen::Segment segment{glm::vec4(support::to_float(any())), glm::vec4(support::to_float(any()))};
        const float alpha = random.uniform_float(0.0, 1.0);
        of_mixture = std::max(
            of_mixture, share(texgen::detail::mixed(static_cast<double>(segment.a.x), static_cast<double>(segment.b.x),
                                                    static_cast<double>(alpha)),
                              support::exactly_at(segment, alpha).s));
    }
    for (int i = 0; i < 20000; ++i) {
        const auto vertex = [&] {
            return texgen::WindowVertex{{random.uniform_float(-100.0, 100.0), random.uniform_float(-100.0, 100.0)},
                                        random.uniform_float(0.5, 2.0),
                                        {support::to_float(any()), 0.0f, 0.0f, support::to_float(any())}};
        };
        const texgen::Triangle triangle{vertex(), vertex(), vertex()};
        const texgen::detail::TrianglePlanes planes(triangle);
        REQUIRE(planes.is_usable());
        const std::int64_t x = random.integer(-100, 100), y = random.integer(-100, 100);
        // Both are known up to the same positive factor: s / q of one is that of the other, and so is s q' - s' q = 0.
        const auto plane = [&](glm::length_t coordinate) -> texgen::detail::Plane {
            const auto [value, magnitude] = planes.plane_twice(coordinate);
            return {{value.base[0], value.dx[0], value.dy[0]}, {magnitude.base[0], magnitude.dx[0], magnitude.dy[0]}};
        };
        const texgen::detail::Bounded s = planes.at(plane(0), x, y), q = planes.at(plane(3), x, y);
        const support::Homogeneous exact = support::ExactTriangle(triangle).at(x, y);
        const support::Dyadic cross = support::Dyadic(s.value) * exact.q - support::Dyadic(q.value) * exact.s;
        const double room = s.error * std::fabs(exact.q.estimate()) + q.error * std::fabs(exact.s.estimate());
        of_plane = std::max(of_plane, std::fabs(cross.estimate()) / room);
    }
    for (const double worst : {of_form, of_mixture, of_plane}) CHECK(worst <= 1.0);
    // The bounds have room for twice the unit roundoff.
    CHECK(of_form > 0.15);
    CHECK(of_mixture > 0.15);
    CHECK(of_plane > 0.03);
    MESSAGE(of_form, " ", of_mixture, " ", of_plane);
}

TEST_CASE(
    "functions in two doubles, and those from exact growths, are within their errors at the corners of any tile") {
    using support::Dyadic;
    Random random(6500);
    double worst[2] = {};  // of the functions as they are made, and of those that exact growths replace
    int replaced = 0;
    for (int i = 0; i < 2000; ++i) {
        const support::NearCut cut = support::near_cut(random);
        texgen::Triangle triangle = cut.triangle;
        texgen::detail::Tile tile{cut.rect.x, cut.rect.y, random.integer(1, 200), random.integer(1, 20)};
        if (i % 2 == 0) {
            // Of any size, and far away: differences are no doubles, and functions cancel.
            const double size = random.power_of_ten(0.0, 9.3);
            for (texgen::WindowVertex* vertex : support::vertices(triangle)) {
                vertex->window = {random.uniform_float(-size, size), random.uniform_float(-size, size)};
                for (int k = 0; k < 4; ++k) vertex->strq[k] *= support::to_float(random.power_of_ten(-9.0, 9.0));
            }
            tile.x = static_cast<std::int64_t>(random.uniform(-2147480000.0, 2147480000.0));
        }
        const texgen::detail::TrianglePlanes planes(triangle);
        if (!planes.is_usable()) continue;
        texgen::detail::ClosePlanes close(planes, tile);
        const auto check = [&](glm::length_t coordinate, double& worst_share) {
            const auto& [term, error] = close.ramp(coordinate);
            for (int corner = 0; corner < 4; ++corner) {
                const double x = corner % 2 == 0 ? 0.0 : tile.width - 1.0,
                             y = corner / 2 == 0 ? 0.0 : tile.height - 1.0;
                const Dyadic at[] = {Dyadic(static_cast<double>(tile.x) + 0.5 + x),
                                     Dyadic(static_cast<double>(tile.y) + 0.5 + y)};
                const auto to = [&](std::size_t k, glm::length_t axis) {
                    return Dyadic(planes.corner(k)[axis]) - at[axis];
                };
                Dyadic left_out;
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::size_t j = (k + 1) % 3, l = (k + 2) % 3;
                    left_out = left_out + (to(j, 0) * to(l, 1) - to(j, 1) * to(l, 0)) *
                                              (Dyadic(planes.weight(k)) * Dyadic(planes.value(k, coordinate)));
                    const Dyadic steps(k == 0 ? 1.0 : k == 1 ? x : y);
                    left_out = left_out - (Dyadic(term[k].high) + Dyadic(term[k].low)) * steps;
                }
                worst_share = std::max(worst_share, std::fabs(left_out.estimate()) / error);
            }
        };
        for (const glm::length_t coordinate : {0, 1, 2, 3}) check(coordinate, worst[0]);
        const double error = close.ramp(2).error;
        take_exact_growths(planes, 2, 2, close);
        replaced += close.ramp(2).error < error;
        for (const glm::length_t coordinate : {2, 3}) check(coordinate, worst[1]);
    }
    // Most terms are far below the largest one, and 2^-97 has room for four times what could be lost.
    for (const double share : worst) {
        CHECK(share <= 1.0);
        CHECK(share > 0x1p-9);
    }
    CHECK(replaced > 500);
    MESSAGE(worst[0], " ", worst[1], ", ", replaced, " replaced");
}

TEST_CASE("exact sums of products, and of multiples of such sums, are exact, and their terms do not overlap") {
    using Sum = texgen::detail::Expansion<192>;
    Random random(5);
    int cancelled = 0, longest = 0;
    for (int round = 0; round < 20000; ++round) {
        // Few bits and exponents that are near meet in carries, and cancel; many and far ones leave gaps.
        const int bits = random.coin() ? 3 : 24, reach = random.integer(0, 2) * 40;
        const auto draw = [&] {
            const int mantissa = random.integer(-(1 << bits) + 1, (1 << bits) - 1);
            return std::ldexp(static_cast<double>(mantissa), random.integer(-reach, reach));
        };
        Sum sum, parts[3];
        support::Dyadic exact, exact_parts[3];
        for (std::size_t i = 0; i < 3; ++i) {
            for (int k = random.integer(0, 8); k > 0; --k) {
                const double a = draw(), b = draw();
                parts[i].add_product(a, b);
                exact_parts[i] = exact_parts[i] + support::Dyadic(a) * support::Dyadic(b);
            }
            // Now and then what was there before, the other way.
            const double factor = i == 2 && random.coin() ? -1.0 : draw();
            const std::size_t of = i == 2 && random.coin() ? 1 : i;
            sum.add_scaled(parts[of], factor);
            exact = exact + exact_parts[of] * support::Dyadic(factor);
        }
        support::Dyadic value;
        for (std::size_t i = 0; i < sum.count(); ++i) {
            value = value + support::Dyadic(sum.terms()[i]);
            const bool is_above = i == 0 || std::fabs(sum.terms()[i - 1]) < texgen::detail::last_bit(sum.terms()[i]);
            CHECK_MESSAGE(is_above, "term ", i, " of round ", round, ": ", hex(sum.terms()[i - 1]), " below ",
                          hex(sum.terms()[i]));
        }
        CHECK_MESSAGE(value == exact, "round ", round);
        CHECK(sum.sign() == exact.sign());
        cancelled += exact.sign() == 0;
        longest = std::max(longest, static_cast<int>(sum.count()));
    }
    CHECK(cancelled > 100);
    CHECK(longest >= 8);
}

TEST_CASE("an area that the differences in double do not see is an area") {
    const auto vertex = [](float x, float y, float s) {
        return texgen::WindowVertex{{x, y}, 1.0f, {s, 0.25f, 0.0f, 1.0f}};
    };
    // c - a is a double only when it is rounded, to -a; c is above the line, on it, or below.
    const auto triangle = [&](float c) {
        return texgen::Triangle{vertex(0x1p60f, 0x1p60f, 1.0f), vertex(-0x1p60f, -0x1p60f, 2.0f),
                                vertex(1.0f, c, 3.0f)};
    };
    CHECK_FALSE(texgen::TriangleSetup::of(triangle(1.0f), everywhere()));
    for (const float c : {2.0f, 0.5f, -3.0f}) {
        const auto setup = texgen::TriangleSetup::of(triangle(c), everywhere());
        REQUIRE(setup);
        const texgen::FragmentRect rect{-1, -1, 4, 4};
        Outputs out(16);
        support::Seen seen;
        const texgen::Work work = interpolate(*setup, rect, out.spans());
        const std::string wrong = first_wrong({triangle(c), rect}, support::ExactTriangle(triangle(c)), everywhere(),
                                              texgen::exact, work, out, seen);
        CHECK_MESSAGE(wrong.empty(), wrong);
        CHECK(seen.in_front > 0);
    }
}
