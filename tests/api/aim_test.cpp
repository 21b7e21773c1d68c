// look_at against 400-bit arithmetic: near the view direction, far from the origin, and where there is no answer.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "judges/oracle.hpp"
#include "judges/real.hpp"
#include "support/hex.hpp"
#include "support/mirrors.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/projector.hpp"

namespace {

using support::exactly;
using support::hex;
using support::Random;
using support::Rational;
using support::Real;
using support::Worst;
using texgen::Aim;
using texgen::look_at;

std::string describe(const Aim& aim) { return hex(aim.position) + " " + hex(aim.target) + " " + hex(aim.up); }

// The largest element of |computed - exact| over the rotation.
double rotation_error(const glm::dmat4& computed, const Aim& aim) {
    const support::RealMatrix exact = support::look_at(aim.position, aim.target, aim.up);
    double worst = 0.0;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            const Real error = abs(Real(computed[column][row]) -
                                   exact[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)]);
            worst = std::max(worst, static_cast<double>(error));
        }
    return worst;
}

// The largest deviation of R R^T from the identity.
double orthonormality_error(const glm::dmat4& m) {
    double worst = 0.0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            Rational sum = i == j ? -1 : 0;
            for (int k = 0; k < 3; ++k) sum += exactly(m[k][i]) * exactly(m[k][j]);
            worst = std::max(worst, support::nearest<double>(support::magnitude(sum)));
        }
    return worst;
}

// The error of the translation -R position for the rotation that stands there, in ulps.
double translation_error(const glm::dmat4& m, const glm::dvec3& position) {
    double worst = 0.0;
    for (int row = 0; row < 3; ++row) {
        Rational exact = 0;
        for (int k = 0; k < 3; ++k) exact -= exactly(m[k][row]) * exactly(position[k]);
        worst = std::max(worst, support::ulp_error(m[3][row], exact));
    }
    return worst;
}

constexpr double one_ulp = 0x1p-52;  // of a number just above 1: the elements of a rotation

}  // namespace

TEST_CASE("look_at is within 4 ulp of the definition, orthonormal, and its translation rounds once") {
    Random random(81);
    double orthonormality = 0.0, translation = 0.0;
    Worst rotation;
    for (int i = 0; i < 2000; ++i) {
        const double distance = random.power_of_ten(-3.0, 8.0);
        Aim aim{};
        aim.position = distance * random.direction();
        aim.target = aim.position + random.power_of_ten(-3.0, 6.0) * random.direction();
        aim.up = random.power_of_ten(-10.0, 10.0) * random.direction();
        const auto view = look_at(aim);
        REQUIRE_MESSAGE(view, describe(aim));
        const double error = rotation_error(view->matrix(), aim);
        rotation.take(error, [&] { return describe(aim); });
        orthonormality = std::max(orthonormality, orthonormality_error(view->matrix()));
        translation = std::max(translation, translation_error(view->matrix(), aim.position));
    }
    CHECK_MESSAGE(rotation.error <= 4.0 * one_ulp, rotation.input);
    CHECK(orthonormality <= 4.0 * one_ulp);
    CHECK(translation <= 1.0);
    MESSAGE((rotation.error / one_ulp), ", ", (orthonormality / one_ulp), ", ", translation, " ulp at most");
}

TEST_CASE("up may be nearly parallel to the view: 1e-1 to 1e-7 rad lose nothing, and 1e-20 rad neither") {
    Random random(82);
    for (const double angle : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-9, 1e-12, 1e-15, 1e-20, 1e-25}) {
        double orthonormality = 0.0;
        Worst rotation;
        for (int i = 0; i < 200; ++i) {
            Aim aim{};
            aim.position = random.coin() ? glm::dvec3(0.0) : random.power_of_ten(0.0, 6.0) * random.direction();
            if (angle >= 1e-9) {
                aim.target = aim.position + random.power_of_ten(-2.0, 2.0) * random.direction();
                const glm::dvec3 view = aim.target - aim.position;
                aim.up = view + angle * glm::length(view) * random.direction();
            } else {
                // So near that only numbers with few bits can say it: up along an axis, the view next to it.
                aim.position = glm::dvec3(0.0);
                aim.up = {0.0, 1.0, 0.0};
                aim.target = {angle * random.uniform(-1.0, 1.0), random.coin() ? 1.0 : -1.0,
                              angle * random.uniform(-1.0, 1.0)};
            }
            const auto view = look_at(aim);
            REQUIRE_MESSAGE(view, describe(aim));
            const double error = rotation_error(view->matrix(), aim);
            rotation.take(error, [&] { return describe(aim); });
            orthonormality = std::max(orthonormality, orthonormality_error(view->matrix()));
        }
        CAPTURE(angle);
        CHECK_MESSAGE(rotation.error <= 4.0 * one_ulp, rotation.input);
        CHECK(orthonormality <= 4.0 * one_ulp);
    }
}

TEST_CASE("far from the origin the direction is that of the exact difference of target and position") {
    Random random(83);
    for (int i = 0; i < 500; ++i) {
        // Up is nearly parallel, and the difference itself is rounded: both at once.
        Aim aim{};
        aim.position = random.power_of_ten(6.0, 12.0) * random.direction();
        aim.target = random.power_of_ten(-3.0, 3.0) * random.direction();
        const glm::dvec3 view = aim.target - aim.position;
        aim.up = view + random.power_of_ten(-7.0, -1.0) * glm::length(view) * random.direction();
        const auto answer = look_at(aim);
        REQUIRE_MESSAGE(answer, describe(aim));
        REQUIRE_MESSAGE(rotation_error(answer->matrix(), aim) <= 4.0 * one_ulp, describe(aim));
        REQUIRE_MESSAGE(translation_error(answer->matrix(), aim.position) <= 1.0, describe(aim));
    }
}

TEST_CASE("up next to a difference that no doubles hold turns nothing, down to 2^-95 rad") {
    Random random(84);
    double orthonormality = 0.0;
    Worst rotation;
    for (int i = 0; i < 1000; ++i) {
        // target - position is (a + b) direction and a little more; its components are rounded apart. Up is the
        // direction and a little more, so that the products of 2^-54 cancel but for what is next to 2^-96.
        const glm::dvec3 direction{random.integer(1 << 25, 1 << 26), random.integer(1 << 25, 1 << 26), 0.0};
        const double a = random.integer(1 << 9, 1 << 10);
        const double b = std::ldexp(random.integer(1 << 25, 1 << 26), -62);
        Aim aim{-b * direction, a * direction, direction};
        aim.position.y -= std::ldexp(random.integer(1, 8), -62);
        aim.up.z = std::ldexp(random.uniform(2.0, 8.0), -72);
        const auto view = look_at(aim);
        REQUIRE_MESSAGE(view, describe(aim));
        const double error = rotation_error(view->matrix(), aim);
        rotation.take(error, [&] { return describe(aim); });
        orthonormality = std::max(orthonormality, orthonormality_error(view->matrix()));
    }
    CHECK_MESSAGE(rotation.error <= 4.0 * one_ulp, rotation.input);
    CHECK(orthonormality <= 4.0 * one_ulp);
}

TEST_CASE("the translation rounds once where its terms cancel to the last of 106 bits") {
    Random random(85);
    int cancelled = 0;
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 difference{random.integer(-99, 99), random.integer(-99, 99), random.integer(1, 99)};
        const glm::dvec3 up{random.integer(-99, 99), random.integer(1, 99), random.integer(-99, 99)};
        const auto at_origin = look_at({glm::dvec3(0.0), difference, up});
        if (!at_origin) continue;
        const int row = random.integer(0, 2), x = random.integer(0, 2), y = (x + 1) % 3;
        // m / n as near to the ratio of two elements as numbers of that size are: its continued fraction.
        Rational ratio = support::magnitude(exactly(at_origin->matrix()[x][row]));
        const Rational other = support::magnitude(exactly(at_origin->matrix()[y][row]));
        if (ratio == 0 || other == 0) continue;
        ratio /= other;
        double m = 1.0, n = 0.0, m_before = 0.0, n_before = 1.0;
        for (Rational rest = ratio; m < 0x1p50 && n < 0x1p50;) {
            const double whole = std::floor(support::nearest<double>(rest));
            if (whole * m + m_before > 0x1p51 || whole * n + n_before > 0x1p51) break;
            m_before = std::exchange(m, whole * m + m_before);
            n_before = std::exchange(n, whole * n + n_before);
            rest -= exactly(whole);
            if (rest <= 0) break;
            rest = 1 / rest;
        }
        const bool alike = at_origin->matrix()[x][row] * at_origin->matrix()[y][row] > 0.0;
        Aim aim{glm::dvec3(0.0), glm::dvec3(0.0), up};
        aim.position[x] = n;
        aim.position[y] = alike ? -m : m;
        aim.target = aim.position + difference;
        const auto view = look_at(aim);
        REQUIRE_MESSAGE(view, describe(aim));
        REQUIRE_MESSAGE(translation_error(view->matrix(), aim.position) <= 1.0, describe(aim));
        const double size = std::fabs(aim.position[x] * view->matrix()[x][row]);
        cancelled += std::fabs(view->matrix()[3][row]) < 0x1p-80 * size;
    }
    CHECK(cancelled > 300);
}

TEST_CASE("the translation rounds once where coordinates of the position are any distance apart") {
    Random random(87);
    int answered = 0, tiny = 0;
    for (int i = 0; i < 20000; ++i) {
        // Rows with zeros and without; and of two short coordinates that a row cancels, beside any third.
        const auto direction = [&] {
            return i % 2 == 0 ? random.direction()
                              : glm::dvec3(random.integer(-4, 4), random.integer(-4, 4), random.integer(-4, 4));
        };
        Aim aim{glm::dvec3(0.0), direction(), direction()};
        const auto at_origin = look_at(aim);
        if (!at_origin) continue;
        const int row = random.integer(0, 2), x = random.integer(0, 2), y = (x + 1) % 3, z = (x + 2) % 3;
        const int exponent = random.integer(-1021, 960);
        aim.position[x] = std::ldexp(at_origin->matrix()[y][row], exponent);
        aim.position[y] = -std::ldexp(at_origin->matrix()[x][row], exponent);
        if (random.coin()) aim.position[y] = std::ldexp(random.uniform(-1.0, 1.0), random.integer(-1074, 1000));
        aim.position[z] = std::ldexp(random.uniform(-1.0, 1.0), random.integer(-1074, 1000));
        aim.target = aim.position;
        for (int k = 0; k < 3; ++k) {
            const int of_position = aim.position[k] == 0.0 ? -1074 : std::ilogb(aim.position[k]);
            aim.target[k] += std::ldexp(direction()[k], std::max(of_position, -900));
        }
        const auto view = look_at(aim);
        if (!view) continue;
        ++answered;
        tiny += std::fabs(view->matrix()[3][row]) < 0x1p-400 * std::fabs(aim.position[z]);
        REQUIRE_MESSAGE(translation_error(view->matrix(), aim.position) <= 1.0, describe(aim));
    }
    CHECK(answered > 10000);
    CHECK(tiny > 100);
}

TEST_CASE("positions and targets of any finite numbers are an aim, unless its translation is none of doubles") {
    Random random(86);
    int at_end = 0;
    for (int i = 0; i < 12000; ++i) {
        const auto any_point = [&] {
            const int kind = random.integer(0, 2);
            const int exponent = kind == 0   ? random.integer(-1074, 1022)
                                 : kind == 1 ? random.integer(-1074, -1060)
                                             : random.integer(1021, 1023);
            return glm::dvec3(std::ldexp(random.uniform(-2.0, 2.0), exponent),
                              std::ldexp(random.uniform(-2.0, 2.0), exponent),
                              std::ldexp(random.uniform(-2.0, 2.0), exponent - random.integer(0, 3)));
        };
        Aim aim{any_point(), any_point(), any_point()};
        if (i % 4 == 0) {
            // Sums of two terms of the translation leave the range, and that of all three does not.
            for (int k = 0; k < 3; ++k) aim.position[k] = random.coin() ? 0x1.cp1023 : -0x1.cp1023;
            aim.target = aim.position + 0x1p1000 * random.direction();
        }
        const auto view = look_at(aim);
        if (aim.position == aim.target || aim.up == glm::dvec3(0.0)) continue;
        const support::RealMatrix exact = support::look_at(aim.position, aim.target, aim.up);
        bool is_double = true;
        for (std::size_t row = 0; row < 3; ++row)
            is_double = is_double && abs(exact[row][3]) < 0.999 * Real(std::numeric_limits<double>::max());
        if (is_double) REQUIRE_MESSAGE(view, describe(aim));
        at_end += is_double && std::fabs(aim.position.x) > 0x1p1022;
        if (!view) continue;
        REQUIRE_MESSAGE(rotation_error(view->matrix(), aim) <= 4.0 * one_ulp, describe(aim));
        REQUIRE_MESSAGE(translation_error(view->matrix(), aim.position) <= 1.0, describe(aim));
    }
    CHECK(at_end > 300);
}

TEST_CASE("the position goes to the origin, the target onto the negative z axis, up upwards") {
    const auto view = look_at({{2, 5, 5}, {-2, -4, 0}, {0, 1, 0}});
    REQUIRE(view);
    const glm::dvec4 position = view->matrix() * glm::dvec4(2, 5, 5, 1),
                     target = view->matrix() * glm::dvec4(-2, -4, 0, 1);
    const glm::dvec4 up = view->matrix() * glm::dvec4(0, 1, 0, 0);
    for (int k = 0; k < 3; ++k) CHECK(std::fabs(position[k]) < 1e-14);
    CHECK(std::fabs(target.x) < 1e-14);
    CHECK(std::fabs(target.y) < 1e-14);
    CHECK(target.z == doctest::Approx(-std::sqrt(122.0)).epsilon(1e-15));
    CHECK(std::fabs(up.x) < 1e-15);
    CHECK(up.y > 0.0);
    // gluLookAt's own example: from +z toward the origin it is a translation.
    const glm::dmat4 straight = look_at({{0, 0, 7}, {0, 0, 0}, {0, 3, 0}})->matrix();
    CHECK(straight == glm::dmat4{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, -7, 1}});
}

TEST_CASE("a mirrored view is V R, within 1 ulp or 2^-96 of its terms: at any distance, for planes of any length") {
    Random random(88);
    Worst worst;
    for (int i = 0; i < 3000; ++i) {
        const glm::dvec3 position = random.power_of_ten(-3.0, 8.0) * random.direction();
        const auto view = look_at({position, position + random.direction(), random.direction()});
        REQUIRE(view);
        // Some planes stand near the camera, where the translation cancels; some have an axis for a normal.
        glm::dvec3 normal = random.power_of_ten(-100.0, 100.0) * random.direction();
        if (i % 4 == 0) normal = {0.0, normal.y, 0.0};
        const double along = normal.x * position.x + normal.y * position.y + normal.z * position.z;
        const glm::dvec4 plane(
            normal, i % 3 == 0 ? -0.5 * along * random.uniform(0.999, 1.001) : along * random.uniform(-2.0, 2.0));
        const auto mirrored = texgen::mirrored(*view, plane);
        REQUIRE(mirrored);
        const double error = support::mirror_error(*view, plane, mirrored->matrix());
        worst.take(error, [&] { return hex(position) + " " + hex(normal) + " " + hex(plane.w); });
    }
    CHECK_MESSAGE(worst.error <= 1.0, worst.input);
    MESSAGE(worst.error, " ulp at most");
}

TEST_CASE("a mirrored view sees points as the view sees their mirror images, and points of the mirror where they are") {
    // A floor at y = 1: what is at y = 3 is seen at y = -1.
    const auto view = look_at({{4, 5, 6}, {0, 1, 0}, {0, 1, 0}});
    const auto mirrored = texgen::mirrored(*view, {0.0, 2.0, 0.0, -2.0});
    REQUIRE(mirrored);
    const auto near_zero = [](const glm::dvec4& v) { return glm::length(v) < 1e-14; };
    CHECK(near_zero(mirrored->matrix() * glm::dvec4(0.5, 3.0, -2.0, 1.0) -
                    view->matrix() * glm::dvec4(0.5, -1.0, -2.0, 1.0)));
    CHECK(near_zero(mirrored->matrix() * glm::dvec4(7.0, 1.0, 2.0, 1.0) -
                    view->matrix() * glm::dvec4(7.0, 1.0, 2.0, 1.0)));
    CHECK(glm::determinant(mirrored->matrix()) == doctest::Approx(-1.0));
    const auto twice = texgen::mirrored(*mirrored, {0.0, -0.5, 0.0, 0.5});
    REQUIRE(twice);
    for (int column = 0; column < 4; ++column) CHECK(near_zero(twice->matrix()[column] - view->matrix()[column]));
}

TEST_CASE("a mirror that is no plane, or beyond the range, mirrors nothing") {
    const texgen::ProjectorView view(glm::dmat4(1.0));
    CHECK(texgen::mirrored(view, {0.0, 5e-324, 0.0, 0.0}));
    CHECK_FALSE(texgen::mirrored(view, {0.0, 0.0, 0.0, 1.0}));
    CHECK_FALSE(texgen::mirrored(view, {0.0, 1e-300, 0.0, 1e300}));
    for (const double bad : {support::nan_double, support::infinity_double, -support::infinity_double}) {
        for (int k = 0; k < 4; ++k) {
            glm::dvec4 plane(0.5, 1.0, 0.25, 2.0);
            plane[k] = bad;
            CHECK_FALSE(texgen::mirrored(view, plane));
            glm::dmat4 matrix(1.0);
            matrix[k][k == 0 ? 2 : 0] = bad;
            CHECK_FALSE(texgen::mirrored(texgen::ProjectorView(matrix), {0.5, 1.0, 0.25, 2.0}));
        }
    }
}

TEST_CASE("vectors of any length do, from the smallest to the largest") {
    for (const double size : {1e-320, 1e-300, 1e-150, 1e150, 1e300}) {
        const auto view = look_at({{0, 0, 0}, {0, 0, -size}, {0, size, 0}});
        REQUIRE_MESSAGE(view, size);
        CHECK(view->matrix() == glm::dmat4(1.0));
    }
}

TEST_CASE("up is parallel to the view to 2^-98 rad, and is not from 2^-97 on, however long both are") {
    for (const double length : {-0x1.ffp0, -1.0, 1.0, 1.5, 0x1.ffp0}) {
        const auto aim_at = [&](double angle) {
            return Aim{{0.0, 0.0, 0.0}, {length, 0.0, 2.0}, {length, angle * std::hypot(length, 2.0), 2.0}};
        };
        const auto view = look_at(aim_at(0x1p-97));
        REQUIRE(view);
        CHECK(rotation_error(view->matrix(), aim_at(0x1p-97)) <= 0x1p-50);
        CHECK(orthonormality_error(view->matrix()) <= 0x1p-50);
        CHECK_FALSE(look_at(aim_at(0.999 * 0x1p-98)));
    }
}

TEST_CASE("an aim without a direction gives nothing") {
    const glm::dvec3 position(2, 5, 5), target(-2, -4, 0), up(0, 1, 0);
    REQUIRE(look_at({position, target, up}));
    CHECK_FALSE(look_at({position, position, up}));
    CHECK_FALSE(look_at({position, target, {0, 0, 0}}));
    CHECK_FALSE(look_at({position, target, target - position}));
    CHECK_FALSE(look_at({position, target, 0x1p-30 * (position - target)}));
    CHECK_FALSE(look_at({{0, 0, 0}, {1, 1, 1}, {-3, -3, -3}}));
    // 2^-98 rad is the least angle that counts.
    CHECK_FALSE(look_at({{0, 0, 0}, {0, 0, -1}, {0x1p-99, 0, -1}}));
    CHECK(look_at({{0, 0, 0}, {0, 0, -1}, {0x1p-97, 0, -1}}));
    for (const double bad : {support::nan_double, support::infinity_double, -support::infinity_double}) {
        for (int k = 0; k < 3; ++k) {
            Aim aim{position, target, up};
            aim.position[k] = bad;
            CHECK_FALSE(look_at(aim));
            aim = {position, target, up};
            aim.target[k] = bad;
            CHECK_FALSE(look_at(aim));
            aim = {position, target, up};
            aim.up[k] = bad;
            CHECK_FALSE(look_at(aim));
        }
    }
}
