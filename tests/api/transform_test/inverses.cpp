// Inverses: a matrix that is singular, or next to it, has none, and any other one is within 2 ulp of the largest term.

#include "texgen/transform.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "judges/rational_matrix.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"

namespace {

using support::exactly;
using support::hex;
using support::Random;
using support::scaled_condition;
using texgen::ModelMatrix;

glm::dmat4 scale(double x, double y, double z) {
    glm::dmat4 m(1.0);
    m[0][0] = x;
    m[1][1] = y;
    m[2][2] = z;
    return m;
}

// Rounded to float: what a user has.
glm::dmat4 as_floats(const glm::dmat4& m) { return glm::dmat4(support::rounded(m)); }

double worst_error(const glm::dmat4& m, const glm::dmat4& inverse) {
    return support::worst_error_of_inverse(exactly(m), exactly(inverse), exactly(texgen::detail::least_scaled));
}

// Elements far apart, of which many are 0, under permutations and scalings of rows and columns: what elimination leaves
// of the small ones is noise of the large ones.
glm::dmat4 graded_matrix(Random& random) {
    glm::dmat4 m(0.0);
    const int depth = random.integer(20, random.coin() ? 150 : 800);
    const int dense = random.integer(1, 4);
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (random.integer(0, 4) > dense) continue;
            const double digits = random.coin() ? random.uniform(-2.0, 2.0) : random.integer(-3, 3);
            m[column][row] = std::ldexp(digits, row == column ? 0 : -random.integer(0, depth));
        }
    }
    for (int i = 0; i < 3; ++i) std::swap(m[i], m[random.integer(i, 3)]);
    if (random.coin()) {
        for (int column = 0; column < 4; ++column) {
            const int of_column = random.integer(-90, 90);
            for (int row = 0; row < 4; ++row) m[column][row] = std::ldexp(m[column][row], of_column);
        }
    }
    if (random.coin()) {
        for (int row = 0; row < 4; ++row) {
            const int of_row = random.integer(-90, 90);
            for (int column = 0; column < 4; ++column) m[column][row] = std::ldexp(m[column][row], of_row);
        }
    }
    return random.coin() ? glm::transpose(m) : m;
}

}  // namespace

TEST_CASE("exactly singular matrices are refused, 2000 of 2000") {
    Random random(43);
    int refused = 0, determinant_is_zero = 0;
    for (int i = 0; i < 2000; ++i) {
        // A row (or column) that is a small integer combination of two others, exactly: of float elements on a grid.
        glm::dmat4 m(0.0);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) m[column][row] = random.integer(-(1 << 20), 1 << 20) * 0x1p-20;
        const int target = random.integer(0, 3);
        const int first = (target + random.integer(1, 3)) % 4, second = (target + random.integer(1, 3)) % 4;
        const double p = random.integer(-3, 3), q = random.integer(-3, 3);
        for (int k = 0; k < 4; ++k) {
            if ((i & 1) != 0)
                m[k][target] = p * m[k][first] + q * m[k][second];
            else
                m[target][k] = p * m[first][k] + q * m[second][k];
        }
        // Scaled by powers of two it is as singular as before.
        const double size = std::ldexp(1.0, random.integer(-60, 60));
        m = size * m;
        REQUIRE_MESSAGE(!support::inverse(exactly(m)), hex(m));
        determinant_is_zero += glm::determinant(m) == 0.0;
        const bool answer = inverse(ModelMatrix(m)).has_value();
        refused += !answer;
        REQUIRE_MESSAGE(!answer, hex(m));
    }
    CHECK(refused == 2000);
    CHECK(determinant_is_zero < 1900);
}

// A change of one element by 2 u of itself makes it singular: then the spectral radius of |A^-1| |A| is at least 1 / 2
// u, and 5 u norm(|X| |A|) above 1.
TEST_CASE("a matrix one unit of one element from an exactly singular one is singular to working precision") {
    Random random(71);
    for (int i = 0; i < 2000; ++i) {
        glm::dmat4 m = as_floats(random.matrix());
        const int to = random.integer(0, 3), from = (to + 1) % 4, other = (to + 2) % 4;
        for (int k = 0; k < 4; ++k) {
            // In double the sum of two floats of these sizes is exact.
            if (i % 2 == 0)
                m[to][k] = m[from][k] - m[other][k];
            else
                m[k][to] = m[k][from] - m[k][other];
        }
        REQUIRE_MESSAGE(!inverse(ModelMatrix(m)), hex(m));
        double& element = m[random.integer(0, 3)][random.integer(0, 3)];
        element = std::nextafter(element, random.coin() ? HUGE_VAL : -HUGE_VAL);
        REQUIRE_MESSAGE(!inverse(ModelMatrix(m)), hex(m));
    }
}

TEST_CASE("a matrix of rank 0, 1 or 2 is refused") {
    Random random(44);
    CHECK_FALSE(inverse(ModelMatrix(glm::dmat4(0.0))));
    for (int i = 0; i < 500; ++i) {
        glm::dmat4 m(0.0);
        const int rank = random.integer(1, 2);
        for (int term = 0; term < rank; ++term) {
            glm::dvec4 u, v;
            for (int k = 0; k < 4; ++k) {
                u[k] = random.integer(-1000, 1000);
                v[k] = random.integer(-1000, 1000);
            }
            for (int column = 0; column < 4; ++column) m[column] += v[column] * u;
        }
        REQUIRE_MESSAGE(!inverse(ModelMatrix(m)), hex(m));
    }
}

TEST_CASE("a singular matrix is refused where its scaling would round what makes it so") {
    // Its first two columns are parallel; the large ones would push them out of the range of normal doubles.
    constexpr double large = 0x1.d5d5d5d5d5d5dp+470;
    constexpr double small = -0x1.b9b9b9b9b9b9bp-582;
    const glm::dvec4 thin(-0x1.b9b9bff03bbffp-582, small, small, -0x1.b9b9b9b9b9b12p-582);
    const glm::dmat4 m(thin, 0x1p-20 * thin, glm::dvec4(small, 0x1.d5d5d9b9b9b9bp+470, large, large),
                       glm::dvec4(large, large, large, small));
    CHECK_FALSE(inverse(ModelMatrix(m)));
    CHECK_FALSE(inverse(ModelMatrix(glm::transpose(m))));

    // As far apart as is allowed, and beyond.
    for (const double ratio : {0.5 * texgen::detail::least_scaled, 2.0 * texgen::detail::least_scaled}) {
        glm::dmat4 wide(1.0);
        wide[1][0] = ratio;
        CHECK(inverse(ModelMatrix(wide)).has_value() == (ratio > texgen::detail::least_scaled));
    }
}

TEST_CASE("uniform scales from 1e-30 to 1e30 are regular, and inverted within 2 ulp of the largest term") {
    for (int exponent = -30; exponent <= 30; ++exponent) {
        const double size = std::pow(10.0, exponent);
        const glm::dmat4 affine = scale(size, size, size);
        const auto answer = inverse(ModelMatrix(affine));
        REQUIRE_MESSAGE(answer, hex(affine));
        CHECK(worst_error(affine, answer->matrix()) <= 2.0);
        const glm::dmat4 everything = size * glm::dmat4(1.0);
        REQUIRE_MESSAGE(inverse(ModelMatrix(everything)), hex(everything));
        Random random(45);
        const glm::dmat4 posed = random.rigid(100.0 * size) * affine;
        const auto posed_answer = inverse(ModelMatrix(posed));
        REQUIRE_MESSAGE(posed_answer, hex(posed));
        CHECK_MESSAGE(worst_error(posed, posed_answer->matrix()) <= 2.0, hex(posed));
    }
}

TEST_CASE(
    "elements of four times their largest term are inverted within 2 ulp of it, and may err by next to all of that") {
    Random random(48);
    double worst = 0.0;
    for (int i = 0; i < 150; ++i) {
        // Next to a Hadamard matrix, whose terms are all of one size.
        glm::dmat4 m(1.0, 1.0, 1.0, 1.0, 1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0, -1.0, 1.0, -1.0, -1.0, 1.0);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) m[column][row] *= 0.5 * (1.0 + random.uniform(-0x1p-6, 0x1p-6));
        const auto answer = inverse(ModelMatrix(m));
        REQUIRE_MESSAGE(answer, hex(m));
        const double error = worst_error(m, answer->matrix());
        REQUIRE_MESSAGE(error <= 2.0, hex(m));
        worst = std::max(worst, error);
    }
    CHECK(worst > 1.9);
}

TEST_CASE("each axis may have its own scale, and columns may stand in any order") {
    Random random(46);
    for (int i = 0; i < 300; ++i) {
        glm::dmat4 m = random.rigid(10.0) * scale(random.power_of_ten(-12.0, 12.0), random.power_of_ten(-12.0, 12.0),
                                                  random.power_of_ten(-12.0, 12.0));
        const auto answer = inverse(ModelMatrix(m));
        REQUIRE_MESSAGE(answer, hex(m));
        REQUIRE_MESSAGE(worst_error(m, answer->matrix()) <= 2.0, hex(m));
        // Permutations change no decision.
        std::swap(m[0], m[3]);
        std::swap(m[1], m[2]);
        REQUIRE_MESSAGE(inverse(ModelMatrix(m)), hex(m));
    }
}

TEST_CASE("conditioned matrices are inverted within 2 ulp of the largest term, from 1e2 to 1e8") {
    Random random(47);
    double hardest = 0.0;
    support::Worst worst;
    for (int i = 0; i < 300; ++i) {
        // Two rows that differ by 10^-k.
        glm::dmat4 m = as_floats(random.matrix());
        const double distance = random.power_of_ten(-8.0, -2.0);
        for (int k = 0; k < 4; ++k) m[k][2] = m[k][0] + distance * m[k][2];
        if (i % 2 == 0) m = as_floats(m);
        if (!support::inverse(exactly(m))) continue;
        const double condition = scaled_condition(exactly(m));
        const auto answer = inverse(ModelMatrix(m));
        REQUIRE_MESSAGE(answer, hex(m));
        hardest = std::max(hardest, condition);
        if (condition > 1e8) continue;
        const double error = worst_error(m, answer->matrix());
        worst.take(error, [&] { return hex(m); });
    }
    CHECK(hardest > 1e8);
    CHECK_MESSAGE(worst.error <= 2.0, worst.input);
    MESSAGE(worst.error, " ulp of the largest term at most");
}

TEST_CASE("graded matrices are inverted within 2 ulp of the largest term, whatever lies between their elements") {
    const glm::dmat4 found = glm::transpose(glm::dmat4(0.0, 0.0, -0x1p-107, -0x1p-49, -0x1p-49, 0.0, 0.0, 0x1p-107, 0.0,
                                                       0x1p-81, 0.0, 0.0, -0x1.7p-68, 0.0, -0x1.dp-68, 0.0));
    CHECK(worst_error(found, inverse(ModelMatrix(found)).value().matrix()) <= 2.0);
    Random random(471);
    double worst = 0.0;
    int inverted = 0;
    for (int i = 0; i < 400; ++i) {
        const glm::dmat4 m = graded_matrix(random);
        const auto exact = support::inverse(exactly(m));
        const auto answer = inverse(ModelMatrix(m));
        if (!exact || !answer || scaled_condition(exactly(m)) > 1e8) continue;
        ++inverted;
        const double error = worst_error(m, answer->matrix());
        worst = std::max(worst, error);
        CHECK_MESSAGE(error <= 2.0, hex(m));
    }
    CHECK(inverted > 150);
    MESSAGE(worst, " ulp of the largest term at most, of ", inverted);
}

TEST_CASE("an affine matrix has an affine inverse: the last row is exactly (0, 0, 0, 1)") {
    Random random(48);
    for (int i = 0; i < 500; ++i) {
        glm::dmat4 m = random.matrix(random.power_of_ten(-10.0, 10.0));
        for (int column = 0; column < 4; ++column) m[column][3] = column == 3 ? 1.0 : 0.0;
        const auto answer = inverse(ModelMatrix(m));
        REQUIRE_MESSAGE(answer, hex(m));
        for (int column = 0; column < 4; ++column) REQUIRE(answer->matrix()[column][3] == (column == 3 ? 1.0 : 0.0));
    }
}

TEST_CASE("NaN, infinity and an inverse beyond the range are refused") {
    Random random(49);
    for (const double bad : {support::nan_double, support::infinity_double, -support::infinity_double})
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) {
                glm::dmat4 m = random.rigid(10.0);
                m[column][row] = bad;
                CHECK_FALSE(inverse(ModelMatrix(m)));
            }
    CHECK_FALSE(inverse(ModelMatrix(scale(1e-310, 1.0, 1.0))));
    CHECK(inverse(ModelMatrix(scale(1e-300, 1e300, 1.0))));
}

TEST_CASE("where an inverse is refused its error bound is infinite, and nowhere else") {
    Random random(4716);
    const texgen::Transform<texgen::Object, texgen::World> given(glm::dmat4(1.0));
    int refused = 0, answered = 0;
    for (int i = 0; i < 2000; ++i) {
        glm::dmat4 m = random.matrix();
        for (int column = 0; column < 4; ++column) m[column] *= std::ldexp(1.0, random.integer(-1025, -960));
        if (random.integer(0, 3) == 0) m[3] = m[0];
        const ModelMatrix transform(m);
        const glm::dmat4 bound = inverse_error_bound(transform, given);
        const bool is_answered = inverse(transform).has_value();
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) REQUIRE_MESSAGE(std::isfinite(bound[column][row]) == is_answered, hex(m));
        ++(is_answered ? answered : refused);
    }
    CHECK(std::min(refused, answered) > 100);
}

TEST_CASE("the inverse of the inverse is the transform again, to the rounding of its condition") {
    Random random(50);
    for (int i = 0; i < 200; ++i) {
        const glm::dmat4 m = random.rigid(1000.0);
        const auto back = inverse(*inverse(ModelMatrix(m)));
        REQUIRE(back);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) REQUIRE(std::fabs(back->matrix()[column][row] - m[column][row]) <= 1e-12);
    }
}
