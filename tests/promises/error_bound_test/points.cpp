// The bounds of what generate() and project() make of points.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "promises/error_bound_test/tightness.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/texcoord.hpp"

namespace error_bound_cases {

using support::Dyadic;
using support::hex;
using support::Homogeneous;
using support::Outputs;
using texgen::ObjectTexgen;

namespace {

struct PointFamily {
    const char* name;
    glm::dmat4 (*matrix)(Random&);
    double size;  // of the points
};

const std::array point_families{
    PointFamily{"friendly",
                [](Random& random) {
                    glm::dmat4 m = random.matrix();
                    m[3][3] = random.uniform(4.0, 8.0);
                    return m;
                },
                1.0},
    PointFamily{"quotients that are subnormal floats",
                [](Random& random) {
                    glm::dmat4 m(0.0);
                    for (int column = 0; column < 4; ++column)
                        for (int row = 0; row < 4; ++row)
                            m[column][row] = random.uniform(-1.0, 1.0) * (row == 3 ? 0x1p30 : 0x1p-98);
                    m[3][3] = (random.integer(0, 9) == 0 ? -0x1p30 : 0x1p30) * random.uniform(4.0, 8.0);
                    return m;
                },
                1.0},
    PointFamily{"every element from 1e-9 to 1e9",
                [](Random& random) {
                    glm::dmat4 m(0.0);
                    for (int column = 0; column < 4; ++column)
                        for (int row = 0; row < 4; ++row)
                            m[column][row] = (random.coin() ? 1.0 : -1.0) * random.power_of_ten(-9.0, 9.0);
                    return m;
                },
                100.0},
    PointFamily{"terms that cancel: the matrix takes the points to where s, t and q are next to 0",
                [](Random& random) {
                    glm::dmat4 m(0.0);
                    const double size = random.power_of_ten(0.0, 12.0);
                    for (int row = 0; row < 4; ++row) {
                        m[0][row] = size * random.uniform(0.5, 1.0);
                        m[1][row] = -m[0][row];
                        m[2][row] = random.uniform(-1e-3, 1e-3);
                        m[3][row] = random.uniform(-1e-3, 1e-3);
                    }
                    return m;
                },
                1.0},
    PointFamily{"q cancels to its last bits",
                [](Random& random) {
                    glm::dmat4 m(0.0);
                    for (int column = 0; column < 4; ++column)
                        for (int row = 0; row < 3; ++row) m[column][row] = random.uniform(-1.0, 1.0);
                    m[0][3] = random.uniform(0.5, 1.0);
                    m[1][3] = -m[0][3] * (1.0 + random.integer(-4, 4) * 0x1p-52);
                    return m;
                },
                1.0},
};

// Where x and y are the same, what has opposite coefficients of them cancels.
std::vector<glm::vec3> points_of(const PointFamily& family, Random& random) {
    std::vector<glm::vec3> points(static_cast<std::size_t>(random.integer(1, 40)));
    const bool cancel = family.size == 1.0;
    for (glm::vec3& point : points) {
        point = random.vector3(family.size);
        if (cancel) point.y = point.x;
    }
    return points;
}

}  // namespace

TEST_CASE("generate_error_bound is never below the error of any coordinate, and is tight where terms cancel, too") {
    std::uint64_t seed = 7200;
    for (const PointFamily& family : point_families) {
        CAPTURE(std::string(family.name));
        Random random(++seed);
        Tightness tightness;
        for (int i = 0; i < 600; ++i) {
            const ObjectTexgen texgen(family.matrix(random));
            const std::vector<glm::vec3> points = points_of(family, random);
            const auto positions = texgen::object_space(points);
            const glm::dvec4 bound = generate_error_bound(texgen, positions);
            std::vector<glm::vec4> strq(points.size());
            generate(texgen, positions, strq);
            for (int k = 0; k < 4; ++k) {
                double largest = 0.0;
                for (std::size_t n = 0; n < points.size(); ++n) {
                    const Homogeneous at = support::exactly_at(texgen.matrix(), points[n]);
                    const Dyadic& exact = k == 0 ? at.s : k == 1 ? at.t : k == 2 ? at.r : at.q;
                    largest = std::max(largest, support::distance(strq[n][k], {exact, Dyadic(1.0)}));
                }
                REQUIRE_MESSAGE(largest <= bound[k] * (1.0 + 1e-12), hex(texgen.matrix()));
                tightness.add(bound[k], largest);
            }
        }
        CHECK(tightness.size() > 1000);
        CHECK(tightness.median() < 40.0);
    }
}

TEST_CASE("project_error_bound is never below the error, and is tight in every tier") {
    std::uint64_t seed = 7300;
    for (const PointFamily& family : point_families) {
        CAPTURE(std::string(family.name));
        Random random(++seed);
        Tightness tightness, of_exact;
        int in_front = 0, behind = 0;
        for (int i = 0; i < 1000; ++i) {
            const ObjectTexgen texgen(family.matrix(random));
            const std::vector<glm::vec3> points = points_of(family, random);
            const auto positions = texgen::object_space(points);
            const Tolerance tolerance = any_tolerance(random);
            const glm::dvec2 bound = project_error_bound(texgen, positions, tolerance);
            Outputs out(points.size());
            project(texgen, positions, support::everywhere(), out.spans(), tolerance);
            for (std::size_t k = 0; k < 2; ++k) {
                const double b = bound[static_cast<int>(k)];
                double largest = 0.0;
                bool any_in_front = false;
                for (std::size_t n = 0; n < points.size(); ++n) {
                    const Homogeneous at = support::exactly_at(texgen.matrix(), points[n]);
                    any_in_front = any_in_front || at.q.sign() > 0;
                    if (at.q.sign() > 0) largest = std::max(largest, support::distance(out[k][n], at.over_q(k)));
                }
                ++(any_in_front ? in_front : behind);
                REQUIRE_MESSAGE(largest <= b * (1.0 + 1e-12), hex(texgen.matrix()), hex(tolerance.value));
                if (!any_in_front) REQUIRE(b == 0.0);
                tightness.add(b, largest);
                if (!(tolerance.value > 0.0)) of_exact.add(b, largest);
            }
        }
        CHECK(in_front > 500);
        if (family.size != 1.0 || std::string(family.name) != "friendly") CHECK(behind > 20);
        CHECK(tightness.median() < 50.0);
        CHECK(of_exact.median() < 5.0);
    }
}

TEST_CASE(
    "where all are in front but q is too large or too small for floats, project_error_bound is of what is done then") {
    Random random(77);
    double largest_share = 0.0;
    for (int i = 0; i < 2000; ++i) {
        // q is scale (1 + x): every fourth point is far away, and one is next to q = 0.
        const double scale =
            std::ldexp(random.uniform(0.5, 1.0), i % 2 == 0 ? random.integer(98, 113) : random.integer(-60, -53));
        glm::dmat4 matrix(0.0);
        matrix[0] = {0.7 * scale, -0.2 * scale, 0.0, scale};
        matrix[3] = {0.3 * scale, 0.6 * scale, 0.0, scale};
        const float far = support::to_float(random.power_of_ten(0.0, 4.0));
        std::vector<glm::vec3> points(64);
        for (std::size_t j = 0; j < points.size(); ++j)
            points[j].x = j == 6 ? -0.9f : random.uniform_float(0.0, 1.0) + (j % 4 == 1 ? far : 0.0f);
        const ObjectTexgen texgen(matrix);
        const auto positions = texgen::object_space(points);
        const Tolerance tolerance{random.power_of_ten(-6.0, -1.0)};
        Outputs out(points.size(), 3u);
        project(texgen, positions, texgen::whole_texture(), out.spans(), tolerance);
        const glm::dvec2 bound = project_error_bound(texgen, positions, tolerance);
        for (std::size_t j = 0; j < points.size(); ++j) {
            const Homogeneous at = support::exactly_at(matrix, points[j]);
            for (std::size_t k = 0; k < 2; ++k) {
                const double share = support::distance(out[k][j], at.over_q(k)) / bound[static_cast<glm::length_t>(k)];
                largest_share = std::max(largest_share, share);
                REQUIRE_MESSAGE(share <= 1.0 + 1e-12, hex(points[j]), " by ", hex(matrix), ", tolerance ",
                                hex(tolerance.value));
            }
        }
    }
    CHECK(largest_share > 0.1);
}

TEST_CASE("points without an error have no bound above 0, and a NaN or an infinity leaves none below infinity") {
    const ObjectTexgen texgen(glm::dmat4(1.0));
    CHECK(project_error_bound(texgen, texgen::object_space(std::span<const glm::vec3>())) == glm::dvec2(0.0));
    CHECK(generate_error_bound(texgen, texgen::object_space(std::span<const glm::vec3>())) == glm::dvec4(0.0));
    for (const double bad : {support::nan_double, infinity_double, -infinity_double}) {
        for (int k = 0; k < 3; ++k) {
            std::array<glm::vec3, 3> points{{{0.1f, 0.2f, 0.3f}, {0.4f, 0.5f, 0.6f}, {0.7f, 0.8f, 0.9f}}};
            points[1][k] = static_cast<float>(bad);
            glm::dmat4 full(0.25);
            for (int column = 0; column < 4; ++column) full[column] = {0.5, 0.25, 0.125, 1.0};
            const auto positions = texgen::object_space(std::span<const glm::vec3>(points));
            const glm::dvec4 of_generate = generate_error_bound(ObjectTexgen(full), positions);
            for (int row = 0; row < 4; ++row) CHECK(is_no_bound(of_generate[row]));
            const glm::dvec2 of_project = project_error_bound(ObjectTexgen(full), positions, {1e-3});
            CHECK(is_no_bound(of_project.x));
            CHECK(is_no_bound(of_project.y));
        }
        for (const int row : {0, 1, 3}) {
            for (int column = 0; column < 4; ++column) {
                glm::dmat4 full(0.25);
                for (int j = 0; j < 4; ++j) full[j] = {0.5, 0.25, 0.125, 1.0};
                full[column][row] = bad;
                const std::array<glm::vec3, 1> point{{{0.1f, 0.2f, 0.3f}}};
                const auto positions = texgen::object_space(std::span<const glm::vec3>(point));
                CHECK(is_no_bound(generate_error_bound(ObjectTexgen(full), positions)[row]));
                const glm::dvec2 of_project = project_error_bound(ObjectTexgen(full), positions, {1e-3});
                if (row != 1) CHECK(is_no_bound(of_project.x));
                if (row != 0) CHECK(is_no_bound(of_project.y));
            }
        }
    }
}

TEST_CASE("a product below 2^-900 leaves project_error_bound infinite, and one that is 0 does not") {
    for (const int row : {0, 1, 3}) {
        for (int column = 0; column < 3; ++column) {
            glm::dmat4 matrix(0.0);
            matrix[3] = {0.25, 0.5, 0.0, 1.0};
            matrix[column][row] = 0x1.8p-840;
            glm::vec3 point(0.5f);
            const auto bound = [&] {
                return project_error_bound(ObjectTexgen(matrix), texgen::object_space(std::span(&point, 1)));
            };
            CHECK(bound().x < 0x1p-25);
            CHECK(bound().y < 0x1p-24);
            point[column] = 0x1.8p-70f;
            CHECK((bound().x == infinity_double) == (row != 1));
            CHECK((bound().y == infinity_double) == (row != 0));
            point[column] = 0.0f;
            CHECK(bound().x < 0x1p-25);
        }
    }
}

}  // namespace error_bound_cases
