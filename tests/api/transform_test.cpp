// Transforms and their inverses: what is singular is refused, what is not is inverted, at any scale.

#include "texgen/transform.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

#include "judges/oracle.hpp"
#include "judges/rational_matrix.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"

namespace {

using support::exactly;
using support::Random;
using support::Rational;
using texgen::ModelMatrix;

}  // namespace

TEST_CASE("composition goes from right to left, and knows its spaces") {
    Random random(41);
    const texgen::ViewMatrix view(random.rigid(3.0));
    const ModelMatrix model(random.rigid(3.0));
    const auto modelview = view * model;
    static_assert(std::is_same_v<decltype(modelview), const texgen::ModelviewMatrix>);
    static_assert(!std::is_default_constructible_v<ModelMatrix>);
    static_assert(!std::is_convertible_v<glm::dmat4, ModelMatrix>);
    const glm::dvec4 point(1.0, 2.0, 3.0, 1.0);
    const glm::dvec4 once = modelview.matrix() * point, twice = view.matrix() * (model.matrix() * point);
    for (int i = 0; i < 4; ++i) CHECK(once[i] == doctest::Approx(twice[i]).epsilon(1e-14));
}

TEST_CASE("a transform holds doubles unchanged and rounds each element once") {
    Random random(42);
    const glm::dmat4 m = random.matrix(1e6);
    CHECK(ModelMatrix(m).matrix() == m);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            CHECK(ModelMatrix(m).rounded()[column][row] == support::nearest<float>(exactly(m[column][row])));
    const glm::mat4 floats = support::rounded(m);
    CHECK(ModelMatrix(floats).rounded() == floats);
}

// As DirectX has them: 16 floats, row after row, and mul(v, M) for a row vector v.
namespace direct3d_math {

struct Float4x4 {
    std::array<float, 16> m;

    Rational element(std::size_t row, std::size_t column) const { return exactly(m[4 * row + column]); }
};

std::array<Rational, 4> mul(const std::array<Rational, 4>& v, const Float4x4& m) {
    std::array<Rational, 4> result;
    for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t row = 0; row < 4; ++row) result[column] += v[row] * m.element(row, column);
    return result;
}

}  // namespace direct3d_math

TEST_CASE("M v of what is made from_row_vectors is Direct3D's mul(v, M), exactly; and there is a way back") {
    Random random(43);
    for (int i = 0; i < 200; ++i) {
        direct3d_math::Float4x4 rows{};
        for (float& element : rows.m) element = random.uniform_float(-1e3, 1e3);
        const texgen::ViewMatrix view = texgen::from_row_vectors<texgen::Eye, texgen::World>(rows.m);

        std::array<Rational, 4> v, product;
        for (Rational& component : v) component = exactly(random.uniform(-10.0, 10.0));
        const support::RationalMatrix matrix = exactly(view.matrix());
        for (std::size_t row = 0; row < 4; ++row)
            for (std::size_t column = 0; column < 4; ++column) product[row] += matrix[row][column] * v[column];
        REQUIRE(product == direct3d_math::mul(v, rows));

        // The same as a matrix of GLM, whose elements are [column][row]; in double nothing is rounded either.
        glm::mat4 as_glm;
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column)
                as_glm[column][row] = rows.m[static_cast<std::size_t>(4 * row + column)];
        REQUIRE(texgen::from_row_vectors<texgen::Eye, texgen::World>(as_glm).matrix() == view.matrix());
        const glm::dmat4 in_double = random.matrix(1e6);
        const auto from_double = texgen::from_row_vectors<texgen::Eye, texgen::World>(in_double);
        REQUIRE(from_double.matrix() == glm::transpose(in_double));

        // Back: the matrix for v M is the one that was given, and its memory row after row that of rounded().
        REQUIRE(view.rounded_for_row_vectors() == as_glm);
        const glm::mat4 rounded = view.rounded();
        for (std::size_t k = 0; k < 16; ++k) REQUIRE((&rounded[0][0])[k] == rows.m[k]);
        REQUIRE(from_double.rounded_for_row_vectors() == support::rounded(in_double));
    }
}

TEST_CASE("a translation of row vectors is a translation") {
    // XMMatrixTranslation(1, 2, 3), as XMStoreFloat4x4 leaves it.
    const std::array<float, 16> rows{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1};
    const ModelMatrix model = texgen::from_row_vectors<texgen::World, texgen::Object>(rows);
    CHECK(model.matrix()[3] == glm::dvec4(1.0, 2.0, 3.0, 1.0));
    CHECK(model.matrix() * glm::dvec4(0.0, 0.0, 0.0, 1.0) == glm::dvec4(1.0, 2.0, 3.0, 1.0));
}

TEST_CASE("the rigid inverse transposes the rotation exactly and rounds the translation once, at any distance") {
    Random random(51);
    double worst = 0.0;
    for (int i = 0; i < 1000; ++i) {
        const double distance = random.power_of_ten(0.0, 8.0);
        const glm::dmat4 m = random.rigid(distance);
        const glm::dmat4 answer = inverse_rigid(ModelMatrix(m)).matrix();
        for (int row = 0; row < 3; ++row) {
            Rational exact = 0;
            for (int k = 0; k < 3; ++k) {
                REQUIRE(answer[k][row] == m[row][k]);
                exact -= exactly(m[row][k]) * exactly(m[3][k]);
            }
            worst = std::max(worst, support::ulp_error(answer[3][row], exact));
        }
        for (int column = 0; column < 4; ++column) REQUIRE(answer[column][3] == (column == 3 ? 1.0 : 0.0));
    }
    CHECK(worst <= 1.0);
}

TEST_CASE("what is not rigid is some way from it: a shear, a scale, a mirror's last row, a NaN") {
    Random random(99);
    for (int i = 0; i < 50; ++i) CHECK(texgen::detail::distance_from_rigid(random.rigid(1e6)) < 1e-14);
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            glm::dmat4 m(1.0);
            m[column][row] += 0.5;  // on the diagonal a scale, beside it a shear
            CHECK(texgen::detail::distance_from_rigid(m) >= 0.5);
            m[column][row] = support::nan_double;
            CHECK(!(texgen::detail::distance_from_rigid(m) <= 1e-3));
        }
    }
    for (int column = 0; column < 4; ++column) {
        glm::dmat4 m(1.0);
        m[column][3] += 0.5;
        CHECK(texgen::detail::distance_from_rigid(m) >= 0.5);
    }
}
