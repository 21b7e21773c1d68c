// What callers are told of errors: never below the error, at most a hundred times above it in the median, and infinite
// or no number where no bound exists.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/oracle.hpp"
#include "judges/rational_matrix.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/fixed_function.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/linear.hpp"
#include "texgen/texcoord.hpp"
#include "texgen/transform.hpp"

namespace {

using support::Dyadic;
using support::exactly;
using support::hex;
using support::Homogeneous;
using support::infinity_double;
using support::nan_double;
using support::Outputs;
using support::Random;
using support::Rational;
using support::RationalMatrix;
using texgen::error_bound;
using texgen::EyeTexgen;
using texgen::ModelMatrix;
using texgen::ModelviewMatrix;
using texgen::ObjectTexgen;
using texgen::Segment;
using texgen::Tolerance;

bool is_no_bound(double bound) { return !(bound < infinity_double); }

// How many times a bound is the error that was seen; errors of 0 say nothing of it.
class Tightness {
public:
    void add(double bound, double error) {
        if (error > 0.0 && bound < infinity_double) ratios_.push_back(bound / error);
    }
    std::size_t size() const { return ratios_.size(); }
    double median() {
        REQUIRE(!ratios_.empty());
        const auto middle = ratios_.begin() + static_cast<std::ptrdiff_t>(ratios_.size() / 2);
        std::nth_element(ratios_.begin(), middle, ratios_.end());
        return *middle;
    }

private:
    std::vector<double> ratios_;
};

// exact, or of the size that float arithmetic reaches, or any.
Tolerance any_tolerance(Random& random) {
    switch (random.integer(0, 3)) {
        case 0:
            return texgen::exact;
        case 1:
            return {random.power_of_ten(-8.0, -5.0)};
        case 2:
            return {random.power_of_ten(-5.0, 0.0)};
        default:
            return {random.power_of_ten(-30.0, 30.0)};
    }
}

// Segments and points

float signed_power(Random& random, double low, double high) {
    return support::to_float((random.coin() ? 1.0 : -1.0) * random.power_of_ten(low, high));
}

struct SegmentFamily {
    const char* name;
    Segment (*make)(Random&);
    bool is_finite;  // whether a bound exists
};

const std::array segment_families{
    SegmentFamily{"friendly",
                  [](Random& random) -> Segment {
                      const auto end = [&] {
                          const double q = random.uniform(0.5, 4.0);
                          return glm::vec4(random.uniform_float(-0.5 * q, 1.5 * q), random.uniform_float(0.0, q),
                                           random.uniform_float(0.0, q), support::to_float(q));
                      };
                      const glm::vec4 a = end();
                      return {a, end()};
                  },
                  true},
    SegmentFamily{"every number from 1e-12 to 1e12",
                  [](Random& random) -> Segment {
                      const auto end = [&] {
                          const float s = signed_power(random, -12.0, 12.0), t = signed_power(random, -12.0, 12.0);
                          return glm::vec4(s, t, 0.0f, support::to_float(random.power_of_ten(-12.0, 12.0)));
                      };
                      const glm::vec4 a = end();
                      return {a, end()};
                  },
                  true},
    SegmentFamily{"any floats in front",
                  [](Random& random) -> Segment {
                      const auto any = [&] { return random.any_finite(); };
                      const auto end = [&] {
                          const float s = any(), t = any(), q = any();
                          return glm::vec4(s, t, 0.0f, q == 0.0f ? 1.0f : std::fabs(q));
                      };
                      const glm::vec4 a = end();
                      return {a, end()};
                  },
                  true},
    SegmentFamily{"s/q almost the same at both ends, far from 0",
                  [](Random& random) -> Segment {
                      const float u = random.uniform_float(1e3, 1e6), q = random.uniform_float(0.5, 4.0);
                      return {{u, -u, 0.0f, 1.0f}, {u * q, -u * q, 0.0f, q}};
                  },
                  true},
    SegmentFamily{"q of both signs, or 0 at an end",
                  [](Random& random) -> Segment {
                      Segment segment{random.vector4(2.0), random.vector4(2.0)};
                      segment.a.w = random.coin() ? 0.0f : -std::fabs(segment.a.w);
                      segment.b.w = std::fabs(segment.b.w) + 0x1p-20f;
                      if (random.coin()) std::swap(segment.a, segment.b);
                      return segment;
                  },
                  false},
};

struct PointFamily {
    const char* name;
    glm::dmat4 (*matrix)(Random&);
    double size;  // of the points
};

const std::array point_families{
    PointFamily{"friendly",
                [](Random& random) {
                    glm::dmat4 m(0.0);
                    for (int column = 0; column < 4; ++column)
                        for (int row = 0; row < 4; ++row) m[column][row] = random.uniform(-1.0, 1.0);
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

// Matrices

glm::dmat4 any_matrix(Random& random) {
    glm::dmat4 m(0.0);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) m[column][row] = random.uniform(-1.0, 1.0);
    return m;
}

struct MatrixFamily {
    const char* name;
    glm::dmat4 (*make)(Random&);
};

const std::array matrix_families{
    MatrixFamily{"friendly", [](Random& random) { return any_matrix(random); }},
    MatrixFamily{"affine, far from the origin",
                 [](Random& random) { return random.rigid(random.power_of_ten(0.0, 9.0)); }},
    MatrixFamily{"rows and columns from 1e-20 to 1e20",
                 [](Random& random) {
                     glm::dmat4 m = any_matrix(random);
                     for (int i = 0; i < 4; ++i) {
                         m[i] *= random.power_of_ten(-20.0, 20.0);
                         const double factor = random.power_of_ten(-20.0, 20.0);
                         for (int k = 0; k < 4; ++k) m[k][i] *= factor;
                     }
                     return m;
                 }},
    MatrixFamily{"of a condition to 1e7",
                 [](Random& random) {
                     glm::dmat4 m = any_matrix(random);
                     m[1] = m[0] + random.power_of_ten(-7.0, -3.0) * m[1];
                     return m;
                 }},
    MatrixFamily{"next to singular", [](Random& random) {
                     glm::dmat4 m = any_matrix(random);
                     m[1] = m[0] + random.power_of_ten(-16.0, -9.0) * m[1];
                     return m;
                 }}};

// The bounds of |computed - exact|, element by element; how tight they are.
void check(const glm::dmat4& bound, const glm::dmat4& computed, const RationalMatrix& exact, Tightness& tightness,
           const std::string& context) {
    for (int row = 0; row < 4; ++row) {
        bool is_finite = true;
        for (int column = 0; column < 4; ++column) is_finite = is_finite && std::isfinite(computed[column][row]);
        for (int column = 0; column < 4; ++column) {
            if (!is_finite) {
                REQUIRE_MESSAGE(is_no_bound(bound[column][row]), context);
                continue;
            }
            const Rational error =
                support::magnitude(exactly(computed[column][row]) -
                                   exact[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)]);
            const double b = bound[column][row];
            REQUIRE_MESSAGE(b >= 0.0, context);
            if (b < infinity_double) REQUIRE_MESSAGE(error <= exactly(b), hex(b), " for ", context);
            tightness.add(b, support::nearest<double>(error));
        }
    }
}

bool all_are_no_bounds(const glm::dmat4& m) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!is_no_bound(m[column][row])) return false;
    return true;
}

// As a user would keep it, or another library compute it.
glm::dmat4 spoiled(const glm::dmat4& m, Random& random) {
    glm::dmat4 result = m;
    switch (random.integer(0, 2)) {
        case 0:
            return result;
        case 1:
            return glm::dmat4(support::rounded(m));
        default:
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 4; ++row) result[column][row] *= 1.0 + random.uniform(-1e-3, 1e-3);
            return result;
    }
}

}  // namespace

TEST_CASE("a segment's error_bound is never below the error, and is tight in every tier") {
    std::uint64_t seed = 7100;
    for (const SegmentFamily& family : segment_families) {
        CAPTURE(std::string(family.name));
        Random random(++seed);
        Tightness tightness, of_float;
        for (int i = 0; i < 1500; ++i) {
            const Segment segment = family.make(random);
            const Tolerance tolerance = any_tolerance(random);
            const glm::dvec2 bound = error_bound(segment, tolerance);
            std::vector<float> alpha(33);
            for (float& a : alpha) a = random.uniform_float(0.0, 1.0);
            alpha.front() = 0.0f;
            alpha.back() = 1.0f;
            Outputs out(alpha.size());
            interpolate(segment, alpha, support::everywhere(), out.spans(), tolerance);
            for (std::size_t k = 0; k < 2; ++k) {
                const double b = bound[static_cast<int>(k)];
                double largest = 0.0;
                for (std::size_t n = 0; n < alpha.size(); ++n) {
                    const Homogeneous at = support::exactly_at(segment, alpha[n]);
                    if (at.q.sign() > 0) largest = std::max(largest, support::distance(out[k][n], at.over_q(k)));
                }
                REQUIRE_MESSAGE(largest <= b * (1.0 + 1e-12), hex(segment.a), hex(segment.b), hex(tolerance.value));
                if (!family.is_finite) REQUIRE_MESSAGE(b == infinity_double, hex(segment.a), hex(segment.b));
                tightness.add(b, largest);
                if (tolerance.value > 1e-6) of_float.add(b, largest);
            }
        }
        if (!family.is_finite) continue;
        CHECK(tightness.size() > 1000);
        CHECK(tightness.median() < 5.0);
        CHECK(of_float.median() < 20.0);
    }
}

TEST_CASE("a segment that is behind has no error, and one with a NaN or an infinity has no bound") {
    const Segment good{{0.2f, 0.3f, 0.0f, 1.0f}, {0.7f, 0.9f, 0.0f, 2.0f}};
    CHECK(error_bound({{1, 2, 3, -1}, {4, 5, 6, 0}}) == glm::dvec2(0.0));
    CHECK(error_bound(good).x < 0x1p-24);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), HUGE_VALF, -HUGE_VALF}) {
        for (const bool at_a : {false, true}) {
            for (const int k : {0, 1, 3}) {
                Segment segment = good;
                (at_a ? segment.a : segment.b)[k] = bad;
                const glm::dvec2 bound = error_bound(segment, {1e-3});
                CHECK(is_no_bound(bound.x));
                CHECK(is_no_bound(bound.y));
            }
        }
    }
    CHECK(error_bound(good, {nan_double}) == error_bound(good));
}

TEST_CASE("from 2^128 - 2^103 on the nearest float is infinity, and the bound with it") {
    const auto bound_at = [](float s) { return error_bound({{s, 0, 0, 1}, {s, 0, 0, 1}}).x; };
    constexpr float largest = std::numeric_limits<float>::max();
    CHECK(bound_at(0x1p127f) < infinity_double);
    CHECK(bound_at(largest) == infinity_double);  // 1.001 times it, to be safe
    const ObjectTexgen texgen(glm::dmat4(0x1.fffffefp127, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1));
    const ObjectTexgen beyond(glm::dmat4(0x1.ffffff1p127, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1));
    const glm::vec3 point(1.0f, 0.0f, 0.0f);
    const auto points = texgen::object_space(std::span(&point, 1));
    glm::vec4 strq(0.0f);
    generate(texgen, points, std::span(&strq, 1));
    CHECK(strq.x == largest);
    CHECK(generate_error_bound(texgen, points).x < infinity_double);
    generate(beyond, points, std::span(&strq, 1));
    CHECK(strq.x == HUGE_VALF);
    CHECK(generate_error_bound(beyond, points).x == infinity_double);
}

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
    for (const double bad : {nan_double, infinity_double, -infinity_double}) {
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

TEST_CASE("inverse_error_bound is never below the error of an inverse, whoever computed it, and next to it") {
    std::uint64_t seed = 7400;
    for (const MatrixFamily& family : matrix_families) {
        CAPTURE(std::string(family.name));
        const bool is_next_to_singular = std::string(family.name) == "next to singular";
        Random random(++seed);
        Tightness tightness;
        int refused = 0;
        for (int i = 0; i < 300; ++i) {
            const ModelMatrix matrix(family.make(random));
            const std::optional<RationalMatrix> exact = support::inverse(exactly(matrix.matrix()));
            const auto computed = inverse(matrix);
            refused += !computed;
            if (!exact) continue;
            const glm::dmat4 given =
                computed ? spoiled(computed->matrix(), random) : glm::inverse(glm::dmat4(matrix.matrix()));
            const glm::dmat4 bound =
                inverse_error_bound(matrix, texgen::Transform<texgen::Object, texgen::World>(given));
            if (!computed) REQUIRE_MESSAGE(all_are_no_bounds(bound), hex(matrix.matrix()));
            check(bound, given, *exact, tightness, hex(matrix.matrix()));
        }
        CHECK(tightness.size() > 1000);
        CHECK(tightness.median() < (is_next_to_singular ? 100.0 : 1.1));
        CHECK((refused > 5) == is_next_to_singular);
    }
}

TEST_CASE("an inverse of what is singular, or of what is not finite, has no error bound") {
    const texgen::Transform<texgen::Object, texgen::World> given(glm::dmat4(1.0));
    for (const glm::dmat4& m : {glm::dmat4(0.0), glm::dmat4(nan_double), glm::dmat4(infinity_double)})
        CHECK(all_are_no_bounds(inverse_error_bound(ModelMatrix(m), given)));
    for (const double bad : {nan_double, infinity_double, -infinity_double}) {
        for (int row = 0; row < 4; ++row) {
            glm::dmat4 m(1.0);
            m[1][row] = bad;
            const glm::dmat4 bound =
                inverse_error_bound(ModelMatrix(glm::dmat4(1.0)), texgen::Transform<texgen::Object, texgen::World>(m));
            for (int column = 0; column < 4; ++column) CHECK(is_no_bound(bound[column][row]));
            for (int column = 0; column < 4; ++column) CHECK(bound[column][(row + 1) % 4] < 0x1p-40);
        }
    }
}

TEST_CASE("the error bounds of stored eye planes are never below the error, in double and in float, and next to it") {
    std::uint64_t seed = 7500;
    for (const MatrixFamily& family : matrix_families) {
        CAPTURE(std::string(family.name));
        const bool is_next_to_singular = std::string(family.name) == "next to singular";
        Random random(++seed);
        Tightness tightness, of_unit;
        for (int i = 0; i < 300; ++i) {
            const ModelviewMatrix modelview(glm::dmat4(support::rounded(family.make(random))));
            const ObjectTexgen planes(glm::dmat4(support::rounded(any_matrix(random))));
            const auto stored = eye_planes_as_stored(planes, modelview);
            if (!stored) continue;
            const std::optional<RationalMatrix> inverse = support::inverse(exactly(modelview.matrix()));
            if (!inverse) continue;
            const RationalMatrix exact = support::operator*(exactly(planes.matrix()), *inverse);
            const EyeTexgen given(spoiled(stored->matrix(), random));
            const std::string context = hex(modelview.matrix()) + hex(planes.matrix());
            check(eye_planes_error_bound(planes, modelview, given), given.matrix(), exact, tightness, context);

            texgen::TexGenUnit unit;
            glm::dmat4 in_unit(0.0), bound(0.0);
            bool all_are_stored = true;
            for (int row = 0; row < 4; ++row) {
                const auto coordinate = static_cast<texgen::Coordinate>(row);
                const glm::vec4 plane = texgen::planes(planes)[static_cast<std::size_t>(row)];
                all_are_stored = all_are_stored && unit.set_eye_plane(coordinate, plane, modelview.rounded());
                const glm::dvec4 of_row = unit.eye_plane_error_bound(coordinate, plane, modelview.rounded());
                for (int column = 0; column < 4; ++column) {
                    in_unit[column][row] = static_cast<double>(unit.eye_plane(coordinate)[column]);
                    bound[column][row] = of_row[column];
                }
            }
            if (all_are_stored) check(bound, in_unit, exact, of_unit, context);
        }
        // As floats the last family is mostly singular, exactly.
        CHECK(tightness.size() > (is_next_to_singular ? 0 : 500));
        CHECK(tightness.median() < (is_next_to_singular ? 100.0 : 1.1));
        CHECK(of_unit.size() > (is_next_to_singular ? 0 : 500));
        CHECK(of_unit.median() < (is_next_to_singular ? 100.0 : 1.1));
    }
}

TEST_CASE("planes under what is singular, and planes that are not finite, have no error bound") {
    const ModelviewMatrix identity(glm::dmat4(1.0));
    const EyeTexgen given(glm::dmat4(1.0));
    CHECK(all_are_no_bounds(
        eye_planes_error_bound(ObjectTexgen(glm::dmat4(1.0)), ModelviewMatrix(glm::dmat4(0.0)), given)));
    for (const double bad : {nan_double, infinity_double}) {
        glm::dmat4 m(1.0);
        m[2][1] = bad;
        const glm::dmat4 of_plane = eye_planes_error_bound(ObjectTexgen(m), identity, given);
        const glm::dmat4 of_stored = eye_planes_error_bound(ObjectTexgen(glm::dmat4(1.0)), identity, EyeTexgen(m));
        for (int column = 0; column < 4; ++column) {
            CHECK(is_no_bound(of_plane[column][1]));
            CHECK(is_no_bound(of_stored[column][1]));
            CHECK(of_plane[column][2] < 0x1p-40);
        }
        texgen::TexGenUnit unit;
        const glm::vec4 plane(1.0f, static_cast<float>(bad), 0.0f, 0.0f);
        const glm::dvec4 bound = unit.eye_plane_error_bound(texgen::Coordinate::s, plane, glm::mat4(1.0f));
        for (int k = 0; k < 4; ++k) CHECK(is_no_bound(bound[k]));
        const glm::dvec4 under = unit.eye_plane_error_bound(texgen::Coordinate::s, {1, 0, 0, 0}, glm::mat4(0.0f));
        for (int k = 0; k < 4; ++k) CHECK(is_no_bound(under[k]));
    }
}
