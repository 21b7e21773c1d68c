// The reference in double against the same definitions in exact rationals, and those against the papers' formulas.

#include "texgen/reference.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "api/reference_test/exact_coordinates.hpp"
#include "judges/oracle.hpp"
#include "judges/rational_traits.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/triangles.hpp"

namespace reference_cases {

using support::families;
using support::Family;
using support::hex;
using support::nan_float;
using support::Random;

namespace {

struct Outputs {
    explicit Outputs(std::size_t count) : s(count, -7.0f), t(count, -7.0f), r(count, -7.0f), lit(count, -7.0f) {}
    texgen::Texcoords spans() { return {.s = s, .t = t, .r = r, .lit = lit}; }

    std::vector<float> s, t, r, lit;
};

// What compiles.
template <class Number>
concept AreNumbers = requires(const Triangle& triangle, const texgen::Segment& segment, Number n) {
    reference::strq(triangle, n, n);
    reference::strq(segment, n);
    reference::wrong_divide_then_interpolate(triangle, n, n);
};
template <class Number>
concept IsAlpha = requires(const texgen::Segment& segment, Number n) {
    reference::strq(segment, n);
};
static_assert(AreNumbers<double> && AreNumbers<float> && AreNumbers<long double> && AreNumbers<Rational>);
static_assert(!IsAlpha<int> && !IsAlpha<long> && !IsAlpha<bool>, "which drop the fractions of floats");
template <class Number>
concept AreDivided = requires(const reference::Vector4<Number>& strq, Number alpha) {
    reference::quotient(strq);
    reference::interpolate_then_divide(strq, strq, alpha);
    reference::wrong_divide_then_interpolate(strq, strq, alpha);
};
template <class Number>
concept IsDivided = requires(const reference::Vector4<Number>& strq) {
    reference::quotient(strq);
};
static_assert(AreDivided<double> && AreDivided<Rational> && !IsDivided<int>, "whose quotients are integers");

Triangle simple_triangle() {
    return {.a = {{0.0f, 0.0f}, 1.0f, {0.0f, 0.0f, 0.0f, 1.0f}},
            .b = {{8.0f, 0.0f}, 1.0f, {1.0f, 0.0f, 0.5f, 1.0f}},
            .c = {{0.0f, 8.0f}, 1.0f, {0.0f, 1.0f, 1.0f, 1.0f}}};
}

}  // namespace

TEST_CASE("strq of a triangle is the definition: (sum lambda f/w) / (sum lambda/w), exactly in rationals") {
    Random random(11);
    for (const Family family : families) {
        for (int i = 0; i < 60; ++i) {
            const Triangle triangle = make_triangle(family, random);
            const Rational x = exactly(random.uniform(-10.0, 1034.0)), y = exactly(random.uniform(-10.0, 1034.0));
            const std::array<Rational, 3> weight = by_the_book(triangle, x, y);
            const Rational one_over_w = weight[0] + weight[1] + weight[2];
            if (one_over_w == 0) continue;
            const auto strq = reference::strq<Rational>(triangle, x, y);
            for (int k = 0; k < 4; ++k) {
                const Rational defined =
                    (weight[0] * exactly(triangle.a.strq[k]) + weight[1] * exactly(triangle.b.strq[k]) +
                     weight[2] * exactly(triangle.c.strq[k])) /
                    one_over_w;
                REQUIRE_MESSAGE(strq[k] == defined, hex(triangle));
            }
        }
    }
}

TEST_CASE("strq of a triangle has the vertices' values at the vertices, and does not see their order") {
    Random random(12);
    for (const Family family : families) {
        const Triangle t = make_triangle(family, random);
        for (const auto& vertex : {t.a, t.b, t.c}) {
            const auto strq = reference::strq<Rational>(t, exactly(vertex.window.x), exactly(vertex.window.y));
            for (int k = 0; k < 4; ++k) REQUIRE(strq[k] == exactly(vertex.strq[k]));
        }
        const Rational x(517, 2), y(81, 2);
        const auto strq = reference::strq<Rational>(t, x, y);
        for (const Triangle& other : {Triangle{t.b, t.c, t.a}, Triangle{t.b, t.a, t.c}, Triangle{t.c, t.b, t.a}})
            REQUIRE(reference::strq<Rational>(other, x, y) == strq);
    }
}

TEST_CASE("w = 1 at all vertices is the parallel case: plain barycentric interpolation") {
    const auto strq = reference::strq<double>(simple_triangle(), 2.0, 4.0);
    CHECK(strq[0] == 0.25);
    CHECK(strq[1] == 0.5);
    CHECK(strq[2] == 0.625);
    CHECK(strq[3] == 1.0);
}

TEST_CASE("the camera's w pulls the value to the near vertex, and divides out of s, t, r and q alike") {
    // On the edge from a (w = 1) to b (w = 3), halfway in the window is a quarter of the way in space.
    Triangle triangle = simple_triangle();
    triangle.b.clip_w = 3.0f;
    const auto strq = reference::strq<Rational>(triangle, Rational(4), Rational(0));
    CHECK(strq[0] == Rational(1, 4));
    CHECK(strq[3] == 1);
    // All w twice as large change nothing.
    for (auto* vertex : {&triangle.a, &triangle.b, &triangle.c}) vertex->clip_w *= 2.0f;
    CHECK(reference::strq<Rational>(triangle, Rational(4), Rational(0)) == strq);
}

TEST_CASE("in double the reference is within its stated error of the rationals, on every family") {
    Random random(13);
    for (std::size_t f = 0; f < families.size(); ++f) {
        int in_front = 0, behind = 0;
        support::Worst worst;
        for (int i = 0; i < 1500; ++i) {
            const Triangle triangle = make_triangle(families[f], random);
            const FragmentRect pixel = pixel_near(triangle, random);
            Outputs out(1);
            reference::interpolate(triangle, texgen::whole_texture(), pixel, out.spans());
            const std::string input = std::string(support::family_names[f]) + " " + hex(triangle) + " pixel " +
                                      std::to_string(pixel.x) + " " + std::to_string(pixel.y);
            const std::array<float, 3> computed{out.s[0], out.t[0], out.r[0]};
            for (int k = 0; k < 3; ++k) {
                const Exact exact = exact_coordinate(triangle, pixel, k);
                const bool sign_is_certain =
                    support::magnitude(exact.q_over_w) > exactly(reference::interpolation_error) * exact.q_magnitude;
                if (!sign_is_certain) continue;
                const float value = computed[static_cast<std::size_t>(k)];
                if (exact.q_over_w < 0) {
                    ++behind;
                    REQUIRE_MESSAGE((value == 0.0f && out.lit[0] == 0.0f), input);
                    continue;
                }
                ++in_front;
                REQUIRE_MESSAGE(within(value, exact), input);
                const bool cancels = exact.slack > support::magnitude(exact.value) * exactly(0x1p-40);
                const double error = cancels ? 0.0 : support::ulp_error(value, exact.value);
                worst.take(error, [&] { return input; });
            }
            const bool lit = out.s[0] >= 0.0f && out.s[0] <= 1.0f && out.t[0] >= 0.0f && out.t[0] <= 1.0f;
            if (exact_coordinate(triangle, pixel, 0).q_over_w > 0)
                REQUIRE_MESSAGE(out.lit[0] == (lit ? 1.0f : 0.0f), input);
        }
        CAPTURE(std::string(support::family_names[f]));
        CHECK(in_front > 1000);
        if (families[f] == Family::crossing) CHECK(behind > 1000);
        // Where nothing cancels by more than 2^10 it is the nearest float but for near-ties.
        CHECK_MESSAGE(worst.error <= 0.5 + 0x1p-16, worst.input);
        MESSAGE(std::string(support::family_names[f]), ": ", worst.error, " ulp at most");
    }
}

TEST_CASE("next to the projector's plane the sign of q is right wherever the stated error decides it") {
    Random random(18);
    int certain = 0, open = 0, behind = 0;
    for (int i = 0; i < 1000; ++i) {
        // q of the last vertex puts the root within a few float ulps of the pixel's centre.
        Triangle triangle = make_triangle(random.coin() ? Family::friendly : Family::horizon, random);
        const FragmentRect pixel = pixel_near(triangle, random);
        const std::array<Rational, 3> weight = by_the_book(triangle, centre(pixel.x), centre(pixel.y));
        if (weight[2] == 0) continue;
        const float root = support::nearest<float>(
            -(weight[0] * exactly(triangle.a.strq.w) + weight[1] * exactly(triangle.b.strq.w)) / weight[2]);
        if (!std::isfinite(root)) continue;
        triangle.c.strq.w = support::neighbour(root, random.integer(-3, 3));
        Outputs out(1);
        reference::interpolate(triangle, texgen::whole_texture(), pixel, out.spans());
        const Exact exact = exact_coordinate(triangle, pixel, 0);
        if (support::magnitude(exact.q_over_w) <= uncertainty(exact)) {
            ++open;
            continue;
        }
        ++certain;
        if (exact.q_over_w > 0) {
            REQUIRE_MESSAGE(within(out.s[0], exact), hex(triangle));
        } else {
            ++behind;
            REQUIRE_MESSAGE(out.s[0] == 0.0f, hex(triangle));
        }
    }
    CHECK(certain > 800);
    CHECK(behind > 300);
    MESSAGE(open, " left open");
}

TEST_CASE("the families have the hard members that their names promise") {
    Random random(14);
    int thin = 0, wide_w = 0, both_signs = 0, counter_clockwise = 0, clockwise = 0;
    for (int i = 0; i < 500; ++i) {
        const Triangle sliver = make_triangle(Family::sliver, random);
        const glm::vec2 edge = sliver.b.window - sliver.a.window;
        const double height = std::fabs(support::twice_area(sliver)) / std::hypot(edge.x, edge.y);
        thin += height < 1.0 / 256.0;
        const Triangle horizon = make_triangle(Family::horizon, random);
        const auto [low, high] = std::minmax({horizon.a.clip_w, horizon.b.clip_w, horizon.c.clip_w});
        wide_w += high > 1e5f * low;
        const Triangle crossing = make_triangle(Family::crossing, random);
        both_signs += crossing.a.strq.w * crossing.b.strq.w < 0.0f || crossing.a.strq.w * crossing.c.strq.w < 0.0f;
        (support::twice_area(crossing) > 0.0 ? counter_clockwise : clockwise) += 1;
    }
    CHECK(thin > 100);
    CHECK(wide_w > 100);
    CHECK(both_signs > 200);
    CHECK(counter_clockwise > 100);
    CHECK(clockwise > 100);
}

TEST_CASE("two triangles agree on the fragments of the edge that they share") {
    Random random(15);
    int on_edge = 0;
    for (int i = 0; i < 400; ++i) {
        // The edge goes through pixel centres: its ends are two centres, and the middle is one as well.
        Triangle left = make_triangle(random.coin() ? Family::horizon : Family::wide_q, random);
        const glm::vec2 from(static_cast<float>(random.integer(0, 500)) + 0.5f,
                             static_cast<float>(random.integer(0, 500)) + 0.5f);
        const int dx = random.integer(1, 200), dy = random.integer(-200, 200);
        left.a.window = from;
        left.b.window = from + glm::vec2(static_cast<float>(2 * dx), static_cast<float>(2 * dy));
        if (support::twice_area(left) == 0.0) continue;
        Triangle right{left.b, left.a, make_triangle(Family::friendly, random).c};
        if (support::twice_area(right) == 0.0) continue;
        const FragmentRect pixel{static_cast<int>(from.x) + dx, static_cast<int>(from.y) + dy, 1, 1};
        Outputs one(1), other(1);
        reference::interpolate(left, texgen::whole_texture(), pixel, one.spans());
        reference::interpolate(right, texgen::whole_texture(), pixel, other.spans());
        ++on_edge;
        REQUIRE_MESSAGE(one.s[0] == other.s[0], hex(left), hex(right));
        REQUIRE_MESSAGE(one.t[0] == other.t[0], hex(left), hex(right));
    }
    CHECK(on_edge > 300);
}

TEST_CASE("an output that is not asked for is not computed, and changes nothing in the others") {
    Random random(16);
    const Triangle triangle = make_triangle(Family::crossing, random);
    const FragmentRect rect{100, 200, 13, 7};
    Outputs all(91);
    reference::interpolate(triangle, texgen::whole_texture(), rect, all.spans());
    for (unsigned mask = 0; mask < 16; ++mask) {
        Outputs some(91);
        const auto pick = [mask](unsigned bit, std::vector<float>& v) {
            return (mask & bit) != 0 ? std::span<float>(v) : std::span<float>();
        };
        reference::interpolate(
            triangle, texgen::whole_texture(), rect,
            {.s = pick(1, some.s), .t = pick(2, some.t), .r = pick(4, some.r), .lit = pick(8, some.lit)});
        const std::vector<float> untouched(91, -7.0f);
        CHECK(some.s == ((mask & 1) != 0 ? all.s : untouched));
        CHECK(some.t == ((mask & 2) != 0 ? all.t : untouched));
        CHECK(some.r == ((mask & 4) != 0 ? all.r : untouched));
        CHECK(some.lit == ((mask & 8) != 0 ? all.lit : untouched));
    }
}

TEST_CASE("a rect is row-major, and each fragment is what it is alone") {
    Random random(17);
    const Triangle triangle = make_triangle(Family::friendly, random);
    const FragmentRect rect{-3, 40, 5, 4};
    Outputs all(20);
    reference::interpolate(triangle, texgen::whole_texture(), rect, all.spans());
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 5; ++column) {
            Outputs one(1);
            reference::interpolate(triangle, texgen::whole_texture(), {rect.x + column, rect.y + row, 1, 1},
                                   one.spans());
            CHECK(one.s[0] == all.s[static_cast<std::size_t>(5 * row + column)]);
            CHECK(one.t[0] == all.t[static_cast<std::size_t>(5 * row + column)]);
        }
    }
    Outputs none(0);
    reference::interpolate(triangle, texgen::whole_texture(), {0, 0, 0, 4}, none.spans());
}

TEST_CASE("lit is the closed region, decided from the written s and t, and needs neither of them") {
    // s runs from 0 to 1 over 8 pixels, t likewise: centres at odd sixteenths.
    const Triangle triangle = simple_triangle();
    const auto region = texgen::atlas_tile({3.0 / 16.0, 1.0 / 16.0}, {5.0 / 16.0, 3.0 / 16.0});
    Outputs out(16);
    reference::interpolate(triangle, region, {0, 0, 4, 4}, {.s = {}, .t = {}, .r = {}, .lit = out.lit});
    const std::vector<float> expected{0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    CHECK(out.lit == expected);
    reference::interpolate(triangle, texgen::atlas_tile({1.0, 1.0}, {0.0, 0.0}), {0, 0, 4, 4}, out.spans());
    CHECK(out.lit == std::vector<float>(16, 0.0f));
}

TEST_CASE("behind the projector, and where q is 0, everything is 0") {
    Triangle triangle = simple_triangle();
    for (const float q : {-1.0f, 0.0f, -0.0f, -1e-30f}) {
        for (auto* vertex : {&triangle.a, &triangle.b, &triangle.c}) vertex->strq.w = q;
        Outputs out(4);
        reference::interpolate(triangle, texgen::whole_texture(), {1, 1, 2, 2}, out.spans());
        for (const auto& values : {out.s, out.t, out.r, out.lit}) CHECK(values == std::vector<float>(4, 0.0f));
    }
}

TEST_CASE("a NaN or an infinity in one coordinate stays there, and in q makes the triangle dark") {
    for (const float bad : {nan_float, support::infinity_float}) {
        Outputs clean(9), spoiled(9);
        Triangle triangle = simple_triangle();
        reference::interpolate(triangle, texgen::whole_texture(), {1, 1, 3, 3}, clean.spans());
        triangle.b.strq.x = bad;
        reference::interpolate(triangle, texgen::whole_texture(), {1, 1, 3, 3}, spoiled.spans());
        CHECK(spoiled.t == clean.t);
        CHECK(spoiled.r == clean.r);
        CHECK(spoiled.lit == std::vector<float>(9, 0.0f));
        for (const float s : spoiled.s) CHECK_FALSE(std::isfinite(s));
    }
    // All coordinates would be 0 of an infinite q.
    for (const float bad : {nan_float, support::infinity_float, -support::infinity_float}) {
        Outputs out(9);
        Triangle triangle = simple_triangle();
        triangle.c.strq.w = bad;
        reference::interpolate(triangle, texgen::whole_texture(), {1, 1, 3, 3}, out.spans());
        CHECK(out.lit == std::vector<float>(9, 0.0f));
        CHECK(out.s == std::vector<float>(9, 0.0f));
    }
}

TEST_CASE("the reference takes window coordinates and w of any size that a float has") {
    for (const float size : {1e-30f, 1e-10f, 1.0f, 1e10f, 1e30f}) {
        Triangle triangle = simple_triangle();
        for (auto* vertex : {&triangle.a, &triangle.b, &triangle.c}) {
            vertex->clip_w *= size;
            vertex->strq *= size;
        }
        triangle.b.clip_w *= 3.0f;
        Outputs out(1);
        reference::interpolate(triangle, texgen::whole_texture(), {1, 2, 1, 1}, out.spans());
        const Exact exact = exact_coordinate(triangle, {1, 2, 1, 1}, 0);
        CHECK_MESSAGE(support::ulp_error(out.s[0], exact.value) <= 0.5 + 0x1p-16, hex(triangle));
    }
}

}  // namespace reference_cases
