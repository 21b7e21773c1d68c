// The bounds of inverses and of stored eye planes, element by element.

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "judges/oracle.hpp"
#include "judges/rational_matrix.hpp"
#include "promises/error_bound_test/tightness.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/fixed_function.hpp"
#include "texgen/linear.hpp"
#include "texgen/transform.hpp"

namespace error_bound_cases {

using support::exactly;
using support::hex;
using support::nan_double;
using support::RationalMatrix;
using texgen::EyeTexgen;
using texgen::ModelMatrix;
using texgen::ModelviewMatrix;
using texgen::ObjectTexgen;

namespace {

struct MatrixFamily {
    const char* name;
    glm::dmat4 (*make)(Random&);
};

const std::array matrix_families{
    MatrixFamily{"friendly", [](Random& random) { return random.matrix(); }},
    MatrixFamily{"affine, far from the origin",
                 [](Random& random) { return random.rigid(random.power_of_ten(0.0, 9.0)); }},
    MatrixFamily{"rows and columns from 1e-20 to 1e20",
                 [](Random& random) {
                     glm::dmat4 m = random.matrix();
                     for (int i = 0; i < 4; ++i) {
                         m[i] *= random.power_of_ten(-20.0, 20.0);
                         const double factor = random.power_of_ten(-20.0, 20.0);
                         for (int k = 0; k < 4; ++k) m[k][i] *= factor;
                     }
                     return m;
                 }},
    MatrixFamily{"of a condition to 1e7",
                 [](Random& random) {
                     glm::dmat4 m = random.matrix();
                     m[1] = m[0] + random.power_of_ten(-7.0, -3.0) * m[1];
                     return m;
                 }},
    MatrixFamily{"next to singular", [](Random& random) {
                     glm::dmat4 m = random.matrix();
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
            const support::Rational error =
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
            const ObjectTexgen planes(glm::dmat4(support::rounded(random.matrix())));
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

}  // namespace error_bound_cases
