// The three options of the C_u note, as properties over random segments in exact rationals. The projector looks down
// -z: u = k x / -z from where it stands, so that s = k x and q = -z.

#include <doctest/doctest.h>

#include <cmath>

#include "judges/oracle.hpp"
#include "judges/rational_traits.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "texgen/reference.hpp"

namespace {

namespace reference = texgen::reference;
using support::exactly;
using support::Random;
using support::Rational;
using Point = reference::Vector3<Rational>;
using Coordinates = reference::Vector4<Rational>;
using Matrix = Eigen::Matrix<Rational, 4, 4>;

Matrix projector(const Rational& k, const Point& position) {
    Matrix matrix = Matrix::Constant(Rational(0));
    matrix(0, 0) = k;
    matrix(1, 1) = k;
    matrix(2, 2) = 1;
    matrix(3, 2) = -1;
    matrix(0, 3) = -k * position[0];
    matrix(1, 3) = -k * position[1];
    matrix(2, 3) = -position[2];
    matrix(3, 3) = position[2];
    return matrix;
}

Coordinates project(const Rational& k, const Point& p) { return {k * p[0], k * p[1], p[2], Rational(-p[2])}; }

struct Case {
    Rational k;
    Point position, a, b;
    Coordinates a_strq, b_strq;
    Rational alpha;
};

Point random_point(Random& random, int side) {
    const double depth = random.power_of_ten(-3.0, 3.0);
    return {exactly(random.uniform(-2.0, 2.0) * depth), exactly(random.uniform(-2.0, 2.0) * depth),
            exactly(side * depth)};
}

// Both ends in front of the projector, both behind, or one on either side; a fifth with equal depths.
Case random_case(Random& random) {
    Case result;
    result.k = exactly(random.power_of_ten(-1.0, 1.0));
    result.position = random_point(random, 1);
    result.a = result.position + random_point(random, random.coin() ? 1 : -1);
    result.b = result.position + random_point(random, random.coin() ? 1 : -1);
    if (random.integer(0, 4) == 0) result.b[2] = result.a[2];
    result.a_strq = project(result.k, result.a - result.position);
    result.b_strq = project(result.k, result.b - result.position);
    result.alpha = exactly(random.uniform(0.0, 1.0));
    if (random.integer(0, 9) == 0) result.alpha = random.integer(0, 1);
    return result;
}

}  // namespace

TEST_CASE("A = (1, 1, 1), B = (2, 2, 10), alpha = 1/2: -3/11 k by (1) and (2), -3/5 k by the wrong (3)") {
    for (const Rational& k : {Rational(1), Rational(7, 3), Rational(250)}) {
        const Point a(1, 1, 1), b(2, 2, 10);
        const Rational half(1, 2);
        const Coordinates a_strq = project(k, a), b_strq = project(k, b);
        for (int i = 0; i < 2; ++i) {
            CHECK(reference::direct_projection(projector(k, Point(0, 0, 0)), a, b, half)[i] == Rational(-3, 11) * k);
            CHECK(reference::interpolate_then_divide(a_strq, b_strq, half)[i] == Rational(-3, 11) * k);
            CHECK(reference::wrong_divide_then_interpolate(a_strq, b_strq, half)[i] == Rational(-3, 5) * k);
        }
    }
}

TEST_CASE("interpolate then divide (2) equals direct projection (1), on both sides of the projector") {
    Random random(21);
    int in_front = 0, behind = 0, through = 0;
    for (int i = 0; i < 2000; ++i) {
        const Case c = random_case(random);
        const Coordinates middle = reference::detail::mix(c.a_strq, c.b_strq, c.alpha);
        if (middle[3] == 0) continue;
        const int sides = (c.a_strq[3] > 0) + (c.b_strq[3] > 0);
        (sides == 2 ? in_front : sides == 0 ? behind : through) += 1;
        REQUIRE(reference::interpolate_then_divide(c.a_strq, c.b_strq, c.alpha) ==
                reference::direct_projection(projector(c.k, c.position), c.a, c.b, c.alpha));
    }
    CHECK(in_front > 300);
    CHECK(behind > 300);
    CHECK(through > 600);
}

TEST_CASE("dividing first is right after all at the parameter beta = alpha B_q / ((1 - alpha) A_q + alpha B_q)") {
    Random random(22);
    for (int i = 0; i < 1000; ++i) {
        const Case c = random_case(random);
        const Rational q = (1 - c.alpha) * c.a_strq[3] + c.alpha * c.b_strq[3];
        if (q == 0) continue;
        const Rational beta = c.alpha * c.b_strq[3] / q;
        REQUIRE(reference::wrong_divide_then_interpolate(c.a_strq, c.b_strq, beta) ==
                reference::interpolate_then_divide(c.a_strq, c.b_strq, c.alpha));
    }
}

TEST_CASE("divide then interpolate (3) differs from (2) unless A_z = B_z, alpha is an end, or A_u = B_u") {
    Random random(23);
    int equal_depth = 0, ends = 0, different = 0;
    for (int i = 0; i < 2000; ++i) {
        const Case c = random_case(random);
        if (reference::detail::mix(c.a_strq, c.b_strq, c.alpha)[3] == 0) continue;
        const Rational right = reference::interpolate_then_divide(c.a_strq, c.b_strq, c.alpha)[0];
        const Rational wrong = reference::wrong_divide_then_interpolate(c.a_strq, c.b_strq, c.alpha)[0];
        const bool same_depth = c.a[2] == c.b[2];
        const bool end = c.alpha == 0 || c.alpha == 1;
        equal_depth += same_depth;
        ends += end;
        different += right != wrong;
        const bool same_u = reference::quotient(c.a_strq)[0] == reference::quotient(c.b_strq)[0];
        REQUIRE((right == wrong) == (same_depth || end || same_u));
        // By how much: alpha (1 - alpha) (A_q - B_q) (A_u - B_u) / q.
        const Rational a_u = reference::quotient(c.a_strq)[0], b_u = reference::quotient(c.b_strq)[0];
        const Rational q = (1 - c.alpha) * c.a_strq[3] + c.alpha * c.b_strq[3];
        REQUIRE(right - wrong == c.alpha * (1 - c.alpha) * (c.a_strq[3] - c.b_strq[3]) * (a_u - b_u) / q);
    }
    CHECK(equal_depth > 300);
    CHECK(ends > 150);
    CHECK(different > 1000);
}

TEST_CASE("the wrong one over a triangle is right where q is the same at the vertices, and only there") {
    texgen::Triangle triangle{.a = {{0.0f, 0.0f}, 1.0f, {0.0f, 0.0f, 0.0f, 2.0f}},
                              .b = {{8.0f, 0.0f}, 2.0f, {2.0f, 0.0f, 1.0f, 2.0f}},
                              .c = {{0.0f, 8.0f}, 4.0f, {0.0f, 2.0f, 2.0f, 2.0f}}};
    const Rational x(5, 2), y(3, 2);
    CHECK(reference::wrong_divide_then_interpolate(triangle, x, y) ==
          reference::quotient(reference::strq(triangle, x, y)));
    triangle.b.strq *= 3.0f;
    CHECK(reference::wrong_divide_then_interpolate(triangle, x, y) !=
          reference::quotient(reference::strq(triangle, x, y)));
    // The trapezoid of the qcoord demonstration: an upright picture, its top edge half as wide as the bottom, drawn as
    // two triangles of a parallel view. The middle of the shared diagonal is the crossing of the diagonals only with q.
    const texgen::Triangle lower{.a = {{0.0f, 0.0f}, 1.0f, {0.0f, 0.0f, 0.0f, 1.0f}},
                                 .b = {{8.0f, 0.0f}, 1.0f, {1.0f, 0.0f, 0.0f, 1.0f}},
                                 .c = {{6.0f, 4.0f}, 1.0f, {0.5f, 0.5f, 0.0f, 0.5f}}};
    const auto crossing = reference::quotient(reference::strq(lower, Rational(4), Rational(8, 3)));
    CHECK(crossing[0] == Rational(1, 2));
    CHECK(crossing[1] == Rational(1, 2));
    CHECK(reference::wrong_divide_then_interpolate(lower, Rational(4), Rational(8, 3))[1] == Rational(2, 3));
}

TEST_CASE("a segment of floats is mixed exactly, and in double to a few ulp of its larger term") {
    Random random(24);
    for (int i = 0; i < 1000; ++i) {
        const texgen::Segment segment{random.vector4(random.power_of_ten(-3.0, 3.0)),
                                      random.vector4(random.power_of_ten(-3.0, 3.0))};
        const double alpha = random.uniform(0.0, 1.0);
        const auto exact = reference::strq(segment, exactly(alpha));
        const auto computed = reference::strq(segment, alpha);
        for (int k = 0; k < 4; ++k) {
            REQUIRE(exact[k] == (1 - exactly(alpha)) * exactly(segment.a[k]) + exactly(alpha) * exactly(segment.b[k]));
            const double size = std::fabs(segment.a[k]) + std::fabs(segment.b[k]);
            REQUIRE(support::absolute_error(computed[k], exact[k]) <= 0x1p-51 * size);
        }
        REQUIRE(reference::strq(segment, Rational(0))[0] == exactly(segment.a.x));
        REQUIRE(reference::strq(segment, Rational(1))[3] == exactly(segment.b.w));
    }
}
