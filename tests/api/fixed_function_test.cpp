#include "texgen/fixed_function.hpp"

#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "judges/rational_matrix.hpp"
#include "support/fixed_function.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/linear.hpp"

namespace {

using support::Coordinate;
using support::coordinates;
using support::hex;
using support::infinity_float;
using support::modes;
using support::nan_float;
using support::NormalScaling;
using support::Random;
using support::Rational;
using support::rounded;
using support::scalings;
using support::slide_projector;
using support::TexGenMode;
using support::TexGenUnit;
using texgen::FixedFunctionVertex;

const glm::mat4 identity(1.0f);

glm::mat4 translation(float x, float y, float z) {
    glm::mat4 result(1.0f);
    result[3] = {x, y, z, 1.0f};
    return result;
}

glm::mat4 scale(float x, float y, float z, float w = 1.0f) {
    glm::mat4 result(1.0f);
    result[0][0] = x;
    result[1][1] = y;
    result[2][2] = z;
    result[3][3] = w;
    return result;
}

// A unit with the same mode on every coordinate that takes it.
TexGenUnit unit_with(TexGenMode mode, NormalScaling scaling = NormalScaling::none) {
    TexGenUnit unit;
    for (const Coordinate coordinate : coordinates)
        if (unit.set_mode(coordinate, mode)) unit.enable(coordinate);
    unit.set_normal_scaling(scaling);
    return unit;
}

bool same_bits(const glm::vec4& a, const glm::vec4& b) {
    for (int i = 0; i < 4; ++i)
        if (std::bit_cast<std::uint32_t>(a[i]) != std::bit_cast<std::uint32_t>(b[i])) return false;
    return true;
}

// The same mathematics in other numbers: an exact inverse in rationals, the modes in long double.

using support::RationalMatrix;

// Empty exactly where M is singular.
std::optional<RationalMatrix> exact_inverse(const glm::mat4& m) {
    return support::inverse(support::exactly(glm::dmat4(m)));
}

using LongVector = std::array<long double, 4>;
using LongMatrix = std::array<LongVector, 4>;  // [row][column]

// Nearer than a rounding of long double: high part and rest.
long double to_long(const Rational& value) {
    const double high = nearest<double>(value);
    if (!std::isfinite(high)) return static_cast<long double>(high);
    const Rational rest = value - Rational(high);
    return static_cast<long double>(high) + static_cast<long double>(nearest<double>(rest));
}

LongMatrix to_long(const RationalMatrix& m) {
    LongMatrix result{};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) result[i][j] = to_long(m[i][j]);
    return result;
}

LongVector row_times(const glm::vec4& row, const RationalMatrix& m) {
    LongVector result{};
    for (std::size_t j = 0; j < 4; ++j) {
        Rational sum = 0;
        for (std::size_t i = 0; i < 4; ++i) sum += Rational(static_cast<double>(row[static_cast<int>(i)])) * m[i][j];
        result[j] = to_long(sum);
    }
    return result;
}

// |value - exact| in units of the last place of exact as a float.
long double ulps(float value, long double exact) {
    int exponent = 0;
    (void)std::frexp(exact, &exponent);
    const long double ulp = std::ldexp(1.0L, (exact == 0.0L || exponent < -125 ? -125 : exponent) - 24);
    return std::fabs(static_cast<long double>(value) - exact) / ulp;
}

// As ulps(), less what `slack` and the rounding in double explain.
long double excess_ulps(float value, long double exact, long double slack) {
    const long double error = std::fabs(static_cast<long double>(value) - exact);
    const long double explained = slack + 0x1p-50L * std::fabs(exact);
    return error <= explained ? 0.0L : ulps(value, exact) * (error - explained) / error;
}

struct EyeVectors {
    LongVector eye{}, reflection{}, normal{};
    long double m = 0.0L;
    long double k = 0.0L;  // the length of the normal if nothing cancelled
};

long double length3(const LongVector& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

LongVector times(const glm::mat4& m, const glm::vec4& v) {
    LongVector result{};
    for (std::size_t i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k)
            result[i] += static_cast<long double>(m[k][static_cast<int>(i)]) * static_cast<long double>(v[k]);
    return result;
}

EyeVectors eye_vectors(const FixedFunctionVertex& vertex, const glm::mat4& modelview, NormalScaling scaling) {
    EyeVectors result;
    result.eye = times(modelview, vertex.position);
    const LongMatrix inverse = to_long(exact_inverse(modelview).value());
    LongVector absolute{};
    for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i) {
            const long double term = static_cast<long double>(vertex.normal[static_cast<int>(i)]) * inverse[i][j];
            result.normal[j] += term;
            absolute[j] += std::fabs(term);
        }
    long double factor = 1.0L;
    if (scaling == NormalScaling::rescale) factor = 1.0L / length3(inverse[2]);
    if (scaling == NormalScaling::normalize) factor = 1.0L / length3(result.normal);
    for (std::size_t j = 0; j < 3; ++j) result.normal[j] *= factor;
    result.k = length3(absolute) * factor;
    const long double distance = length3(result.eye);
    long double n_dot_u = 0.0L;
    for (std::size_t j = 0; j < 3; ++j) n_dot_u += result.normal[j] * result.eye[j] / distance;
    for (std::size_t j = 0; j < 3; ++j)
        result.reflection[j] = result.eye[j] / distance - 2.0L * result.normal[j] * n_dot_u;
    const LongVector half{result.reflection[0], result.reflection[1], result.reflection[2] + 1.0L, 0.0L};
    result.m = 2.0L * length3(half);
    return result;
}

// State

TEST_CASE("a new unit has OpenGL's defaults: all off, eye linear, planes S and T of the identity, R and Q zero") {
    const TexGenUnit unit;
    for (const Coordinate coordinate : coordinates) {
        CHECK_FALSE(unit.enabled(coordinate));
        CHECK(unit.mode(coordinate) == TexGenMode::eye_linear);
    }
    CHECK(unit.object_plane(Coordinate::s) == glm::vec4(1, 0, 0, 0));
    CHECK(unit.object_plane(Coordinate::t) == glm::vec4(0, 1, 0, 0));
    CHECK(unit.object_plane(Coordinate::r) == glm::vec4(0, 0, 0, 0));
    CHECK(unit.object_plane(Coordinate::q) == glm::vec4(0, 0, 0, 0));
    CHECK(unit.eye_plane(Coordinate::s) == glm::vec4(1, 0, 0, 0));
    CHECK(unit.eye_plane(Coordinate::t) == glm::vec4(0, 1, 0, 0));
    CHECK(unit.eye_plane(Coordinate::r) == glm::vec4(0, 0, 0, 0));
    CHECK(unit.eye_plane(Coordinate::q) == glm::vec4(0, 0, 0, 0));
    CHECK(unit.texture_matrix() == identity);
    CHECK(unit.normal_scaling() == NormalScaling::none);
}

TEST_CASE("a vertex has normal (0,0,1) and texture coordinate (0,0,0,1) until it says otherwise") {
    const FixedFunctionVertex vertex{.position = {1, 2, 3, 1}};
    CHECK(vertex.normal == glm::vec3(0, 0, 1));
    CHECK(vertex.texcoord == glm::vec4(0, 0, 0, 1));
    CHECK(TexGenUnit().generate(vertex, translation(1, 2, 3)) == glm::vec4(0, 0, 0, 1));
}

TEST_CASE("q without a plane of its own is zero") {
    for (const TexGenMode mode : {TexGenMode::object_linear, TexGenMode::eye_linear}) {
        const glm::vec4 strq = unit_with(mode).generate({.position = {1, 2, 3, 4}}, identity);
        CHECK(strq == glm::vec4(1, 2, 0, 0));
    }
}

TEST_CASE("the modes that a coordinate does not take are refused and change nothing") {
    for (const Coordinate coordinate : coordinates) {
        for (const TexGenMode mode : modes) {
            bool legal = true;
            if (mode == TexGenMode::sphere_map) legal = coordinate == Coordinate::s || coordinate == Coordinate::t;
            if (mode == TexGenMode::reflection_map || mode == TexGenMode::normal_map)
                legal = coordinate != Coordinate::q;
            TexGenUnit unit;
            REQUIRE(unit.set_mode(coordinate, TexGenMode::object_linear));
            CHECK(unit.set_mode(coordinate, mode) == legal);
            CHECK(unit.mode(coordinate) == (legal ? mode : TexGenMode::object_linear));
        }
    }
}

TEST_CASE("values outside the enumerations are refused or ignored") {
    TexGenUnit unit = unit_with(TexGenMode::object_linear);
    const FixedFunctionVertex vertex{.position = {1, 2, 3, 4}};
    const glm::vec4 before = unit.generate(vertex, identity);
    for (const int number : {-1, 4, 5, 1000, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
        const auto nobody = static_cast<Coordinate>(number);
        CHECK_FALSE(unit.set_mode(nobody, TexGenMode::eye_linear));
        CHECK_FALSE(unit.set_eye_plane(nobody, {1, 1, 1, 1}, identity));
        unit.enable(nobody);
        unit.set_object_plane(nobody, {7, 7, 7, 7});
        CHECK_FALSE(unit.enabled(nobody));
        CHECK(unit.object_plane(nobody) == glm::vec4(0, 0, 0, 0));
        CHECK(unit.eye_plane(nobody) == glm::vec4(0, 0, 0, 0));
        if (number != 4) CHECK_FALSE(unit.set_mode(Coordinate::s, static_cast<TexGenMode>(number)));
        unit.set_normal_scaling(static_cast<NormalScaling>(number));
        CHECK(unit.normal_scaling() == NormalScaling::none);
    }
    CHECK(unit.mode(Coordinate::s) == TexGenMode::object_linear);
    CHECK(unit.generate(vertex, identity) == before);
}

TEST_CASE("every normal scaling can be set after every other") {
    constexpr NormalScaling all[] = {NormalScaling::none, NormalScaling::rescale, NormalScaling::normalize};
    for (const NormalScaling first : all) {
        for (const NormalScaling second : all) {
            TexGenUnit unit;
            unit.set_normal_scaling(first);
            unit.set_normal_scaling(second);
            CHECK(unit.normal_scaling() == second);
        }
    }
}

// Eye planes

TEST_CASE("an eye plane is multiplied by the inverse of the MODELVIEW that is current when it is specified") {
    TexGenUnit unit;
    REQUIRE(unit.set_eye_plane(Coordinate::s, {1, 2, 3, 4}, translation(10, 20, 30)));
    CHECK(unit.eye_plane(Coordinate::s) == glm::vec4(1, 2, 3, -136));
    CHECK(unit.eye_plane(Coordinate::t) == glm::vec4(0, 1, 0, 0));
    CHECK(unit.object_plane(Coordinate::s) == glm::vec4(1, 0, 0, 0));
}

TEST_CASE("later MODELVIEWs do not touch a stored plane, and the vertex meets it in eye space") {
    TexGenUnit unit = unit_with(TexGenMode::eye_linear);
    REQUIRE(unit.set_eye_plane(Coordinate::s, {1, 2, 3, 4}, translation(10, 20, 30)));
    const FixedFunctionVertex vertex{.position = {1, 1, 1, 1}};
    CHECK(unit.generate(vertex, identity).x == 1 + 2 + 3 - 136);
    CHECK(unit.generate(vertex, translation(10, 20, 30)).x == 1 + 2 + 3 + 4);
    CHECK(unit.generate(vertex, scale(2, 4, 8)).x == 2 + 8 + 24 - 136);
    REQUIRE(unit.set_eye_plane(Coordinate::t, {0, 0, 1, 0}, scale(1, 1, 4)));
    CHECK(unit.eye_plane(Coordinate::s) == glm::vec4(1, 2, 3, -136));
    CHECK(unit.eye_plane(Coordinate::t) == glm::vec4(0, 0, 0.25f, 0));
}

TEST_CASE("eye linear, specified and drawn under one MODELVIEW, is object linear with the same plane") {
    Random random(1);
    for (int i = 0; i < 2000; ++i) {
        const float width = random.uniform_float(0.2, 5.0);
        const glm::mat4 modelview = rounded(random.rigid(100.0) * glm::dmat4(scale(width, 1.0f, 2.0f)));
        const glm::vec4 plane = random.vector4(2.0);
        const FixedFunctionVertex vertex{.position = {random.vector3(10.0), 1.0f}};
        TexGenUnit unit = unit_with(TexGenMode::eye_linear);
        REQUIRE(unit.set_eye_plane(Coordinate::s, plane, modelview));
        REQUIRE(unit.set_mode(Coordinate::t, TexGenMode::object_linear));
        unit.set_object_plane(Coordinate::t, plane);
        const glm::vec4 strq = unit.generate(vertex, modelview);
        // The stored plane is rounded once: half an ulp of each of its terms.
        const LongVector eye = times(modelview, vertex.position);
        long double terms = 0.0L;
        for (std::size_t k = 0; k < 4; ++k)
            terms += std::fabs(eye[k] * static_cast<long double>(unit.eye_plane(Coordinate::s)[static_cast<int>(k)]));
        INFO("modelview ", hex(modelview), " plane ", hex(plane), " position ", hex(vertex.position));
        CHECK(std::fabs(strq.x - strq.y) <= static_cast<float>(terms) * 1.3e-7f);
    }
}

TEST_CASE("a stored plane is within 0.54 ulp of the exact p M^-1, for rigid, scaled, sheared and projective M") {
    Random random(2);
    long double worst = 0.0L;
    for (int i = 0; i < 2000; ++i) {
        glm::mat4 modelview;
        switch (i % 4) {
            case 0:
                modelview = rounded(random.rigid(random.power_of_ten(0.0, 7.0)));
                break;
            case 1:
                modelview = rounded(random.rigid(10.0));
                for (int column = 0; column < 3; ++column)
                    modelview[column] *= static_cast<float>(random.power_of_ten(-6.0, 6.0));
                break;
            case 2:
                modelview = rounded(random.rigid(10.0));
                modelview[1] += random.uniform_float(-100.0, 100.0) * modelview[0];
                modelview[2] += random.uniform_float(-100.0, 100.0) * modelview[1];
                break;
            default:
                for (int column = 0; column < 4; ++column) modelview[column] = random.vector4(1.0);
        }
        const glm::vec4 plane = random.vector4(10.0);
        const auto inverse = exact_inverse(modelview);
        if (!inverse) continue;
        TexGenUnit unit;
        INFO("modelview ", hex(modelview), " plane ", hex(plane));
        REQUIRE(unit.set_eye_plane(Coordinate::s, plane, modelview));
        const LongVector exact = row_times(plane, *inverse);
        long double largest = 0.0L;
        for (const long double component : exact) largest = std::fmax(largest, std::fabs(component));
        for (std::size_t k = 0; k < 4; ++k)
            worst = std::fmax(
                worst, excess_ulps(unit.eye_plane(Coordinate::s)[static_cast<int>(k)], exact[k], largest * 0x1p-60L));
        REQUIRE(worst <= 0.54L);
    }
    MESSAGE("worst error of a stored plane: ", static_cast<double>(worst), " ulp");
    CHECK(worst > 0.4L);
}

TEST_CASE("uniform scales from 1e-30 to 1e30 are regular") {
    Random random(3);
    for (int exponent = -30; exponent <= 30; ++exponent) {
        const float factor = static_cast<float>(std::pow(10.0, exponent));
        CAPTURE(exponent);
        TexGenUnit unit;
        REQUIRE(unit.set_eye_plane(Coordinate::s, {1, 0, 0, 0}, scale(factor, factor, factor)));
        CHECK(unit.eye_plane(Coordinate::s) ==
              glm::vec4(static_cast<float>(1.0 / static_cast<double>(factor)), 0, 0, 0));
        REQUIRE(unit.set_eye_plane(Coordinate::t, {1, 2, 4, 8}, scale(factor, factor, factor, factor)));
        for (int k = 0; k < 4; ++k)
            CHECK(unit.eye_plane(Coordinate::t)[k] ==
                  static_cast<float>(std::ldexp(1.0, k) / static_cast<double>(factor)));
        glm::mat4 rotated = rounded(random.rotation());
        for (int column = 0; column < 3; ++column) rotated[column] *= factor;
        REQUIRE(unit.set_eye_plane(Coordinate::r, {1, 0, 0, 0}, rotated));
        const LongVector exact = row_times({1, 0, 0, 0}, exact_inverse(rotated).value());
        for (std::size_t k = 0; k < 4; ++k)
            CHECK(ulps(unit.eye_plane(Coordinate::r)[static_cast<int>(k)], exact[k]) <= 0.54L);
        const glm::vec4 n =
            unit_with(TexGenMode::normal_map, NormalScaling::normalize).generate({.position = {}}, rotated);
        CHECK(std::hypot(n.x, n.y, n.z) == doctest::Approx(1.0f).epsilon(1e-6));
    }
}

// Every way in which a small matrix of integers can fail to have an inverse; all are exact as floats.
glm::mat4 random_singular(Random& random, int kind) {
    const auto small = [&random] { return static_cast<float>(random.integer(-9, 9)); };
    glm::mat4 m;
    for (int column = 0; column < 4; ++column) m[column] = {small(), small(), small(), small()};
    const int a = random.integer(0, 3);
    const int b = (a + random.integer(1, 3)) % 4;
    switch (kind) {
        case 0:  // two equal columns
            m[a] = m[b];
            break;
        case 1:  // two equal rows
            for (int column = 0; column < 4; ++column) m[column][a] = m[column][b];
            break;
        case 2:  // a zero column
            m[a] = glm::vec4(0.0f);
            break;
        case 3:  // a zero row
            for (int column = 0; column < 4; ++column) m[column][a] = 0.0f;
            break;
        case 4:  // a row is a combination of the others
            for (int column = 0; column < 4; ++column) {
                m[column][a] = 0.0f;
                for (int row = 0; row < 4; ++row)
                    if (row != a) m[column][a] += static_cast<float>(row + 2) * m[column][row];
            }
            break;
        default: {  // the product of two factors of rank 3, 2 or 1
            const int rank = random.integer(1, 3);
            const glm::mat4 left = m;
            m = glm::mat4(0.0f);
            for (int k = 0; k < rank; ++k)
                for (int column = 0; column < 4; ++column) m[column] += left[k] * small();
        }
    }
    return m;
}

TEST_CASE("exactly singular MODELVIEWs are refused, whatever their scale, and the plane stays as it was") {
    Random random(4);
    for (int i = 0; i < 3000; ++i) {
        glm::mat4 m = random_singular(random, i % 6);
        REQUIRE_FALSE(exact_inverse(m).has_value());
        const float factor = std::ldexp(1.0f, random.integer(-90, 90));  // a power of two keeps it exactly singular
        m = m * factor;
        INFO("modelview ", hex(m));
        TexGenUnit unit;
        REQUIRE(unit.set_eye_plane(Coordinate::r, {1, 2, 3, 4}, identity));
        CHECK_FALSE(unit.set_eye_plane(Coordinate::r, {1, 0, 0, 0}, m));
        CHECK(unit.eye_plane(Coordinate::r) == glm::vec4(1, 2, 3, 4));
    }
}

TEST_CASE("regular matrices of small integers are all accepted") {
    Random random(5);
    int regular = 0;
    for (int i = 0; i < 3000; ++i) {
        glm::mat4 m;
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) m[column][row] = static_cast<float>(random.integer(-3, 3));
        const bool has_inverse = exact_inverse(m).has_value();
        regular += has_inverse ? 1 : 0;
        INFO("modelview ", hex(m));
        TexGenUnit unit;
        CHECK(unit.set_eye_plane(Coordinate::s, {1, 2, 3, 4}, m) == has_inverse);
    }
    CHECK(regular > 2500);
    CHECK(regular < 3000);
}

TEST_CASE("a MODELVIEW, a plane or a result that is not finite is refused and the plane stays as it was") {
    TexGenUnit unit;
    REQUIRE(unit.set_eye_plane(Coordinate::q, {1, 2, 3, 4}, identity));
    for (const float bad : {nan_float, infinity_float, -infinity_float}) {
        for (int element = 0; element < 16; ++element) {
            glm::mat4 m = identity;
            m[element / 4][element % 4] = bad;
            CHECK_FALSE(unit.set_eye_plane(Coordinate::q, {1, 0, 0, 0}, m));
        }
        for (int component = 0; component < 4; ++component) {
            glm::vec4 plane(1, 2, 3, 4);
            plane[component] = bad;
            CHECK_FALSE(unit.set_eye_plane(Coordinate::q, plane, identity));
        }
    }
    CHECK_FALSE(unit.set_eye_plane(Coordinate::q, {1e20f, 0, 0, 0}, scale(1e-20f, 1, 1)));
    CHECK(unit.eye_plane(Coordinate::q) == glm::vec4(1, 2, 3, 4));
}

TEST_CASE("the rows of S P_p V_p under MODELVIEW = V_e, and of S P_p under V_e V_p^-1, are stored as Everitt's (4)") {
    Random random(6);
    const texgen::Projector projector = slide_projector();
    for (int i = 0; i < 200; ++i) {
        const texgen::CameraPose pose(random.rigid(20.0));
        const glm::mat4 view = texgen::inverse_rigid(pose).rounded();
        const texgen::CameraPose world_from_eye = texgen::inverse(texgen::ViewMatrix(view)).value();
        const auto expected = texgen::planes(texgen::eye_linear(projector, world_from_eye));
        const auto world_planes = texgen::planes(texgen::texture_from_world(projector));
        const auto lens_planes = texgen::planes(texgen::scale_bias(texgen::opengl) * projector.projection);
        const texgen::Transform<texgen::Eye, texgen::ProjectorEye> eye_from_projector =
            texgen::ViewMatrix(view) * texgen::inverse_rigid(projector.view);
        TexGenUnit by_world, by_lens;
        for (const Coordinate coordinate : coordinates) {
            const auto row = static_cast<std::size_t>(coordinate);
            REQUIRE(by_world.set_eye_plane(coordinate, world_planes[row], view));
            REQUIRE(by_lens.set_eye_plane(coordinate, lens_planes[row], eye_from_projector.rounded()));
            float size = 0.0f;
            for (int k = 0; k < 4; ++k) size = std::fmax(size, std::fabs(expected[row][k]));
            INFO("view ", hex(view));
            for (int k = 0; k < 4; ++k) {
                CHECK(std::fabs(by_world.eye_plane(coordinate)[k] - expected[row][k]) <= 3e-6f * size);
                CHECK(std::fabs(by_lens.eye_plane(coordinate)[k] - expected[row][k]) <= 3e-6f * size);
            }
        }
    }
}

// Values

TEST_CASE("each coordinate has its own enable and its own mode; one that is off keeps the vertex's own") {
    TexGenUnit unit;
    REQUIRE(unit.set_mode(Coordinate::s, TexGenMode::object_linear));
    REQUIRE(unit.set_mode(Coordinate::t, TexGenMode::normal_map));
    REQUIRE(unit.set_mode(Coordinate::r, TexGenMode::reflection_map));
    unit.set_object_plane(Coordinate::s, {1, 10, 100, 1000});
    const FixedFunctionVertex vertex{
        .position = {1, 2, 3, 1}, .normal = {0, 1, 0}, .texcoord = {0.1f, 0.2f, 0.3f, 0.4f}};
    const glm::mat4 modelview = translation(-1, -2, -7);  // the vertex is at (0, 0, -4), straight ahead
    const glm::vec4 all(1321, 1, -1, -4);
    REQUIRE(unit.set_eye_plane(Coordinate::q, {0, 0, 1, 0}, identity));
    for (unsigned on = 0; on < 16; ++on) {
        for (const Coordinate coordinate : coordinates)
            unit.enable(coordinate, ((on >> static_cast<unsigned>(coordinate)) & 1u) != 0u);
        const glm::vec4 strq = unit.generate(vertex, modelview);
        for (int i = 0; i < 4; ++i)
            CHECK(strq[i] == (((on >> static_cast<unsigned>(i)) & 1u) != 0u ? all[i] : vertex.texcoord[i]));
    }
}

TEST_CASE("the linear modes meet their bounds, far from the origin as well") {
    Random random(7);
    long double worst_object = 0.0L, worst_eye = 0.0L;
    for (int i = 0; i < 4000; ++i) {
        const double distance = random.power_of_ten(0.0, 7.0);
        const glm::mat4 modelview = rounded(random.rigid(distance));
        TexGenUnit unit;
        REQUIRE(unit.set_mode(Coordinate::s, TexGenMode::object_linear));
        unit.enable(Coordinate::s);
        unit.enable(Coordinate::t);
        const glm::vec4 plane = random.vector4(3.0);
        unit.set_object_plane(Coordinate::s, plane);
        REQUIRE(unit.set_eye_plane(Coordinate::t, plane, modelview));
        const FixedFunctionVertex vertex{.position = {random.vector3(distance), random.uniform_float(0.5, 2.0)}};
        const glm::vec4 strq = unit.generate(vertex, modelview);
        long double object = 0.0L, object_terms = 0.0L, eye = 0.0L, terms = 0.0L;
        const LongVector e = times(modelview, vertex.position);
        const glm::vec4 stored = unit.eye_plane(Coordinate::t);
        for (int k = 0; k < 4; ++k) {
            const long double product =
                static_cast<long double>(plane[k]) * static_cast<long double>(vertex.position[k]);
            object += product;
            object_terms += std::fabs(product);
            const long double term = static_cast<long double>(stored[k]) * e[static_cast<std::size_t>(k)];
            eye += term;
            terms += std::fabs(term);
        }
        INFO("modelview ", hex(modelview), " plane ", hex(plane), " position ", hex(vertex.position));
        worst_object = std::fmax(worst_object, excess_ulps(strq.x, object, object_terms * 0x1p-100L));
        worst_eye = std::fmax(worst_eye, excess_ulps(strq.y, eye, terms * 0x1p-50L));
        REQUIRE(worst_object <= 0.5L);
        REQUIRE(worst_eye <= 0.5L);
        CHECK(strq.z == 0.0f);
        CHECK(strq.w == 1.0f);
    }
}

TEST_CASE("sphere, reflection and normal map meet their bounds under every normal scaling") {
    Random random(8);
    long double worst_normal = 0.0L, worst_reflection = 0.0L, worst_sphere = 0.0L;
    for (int i = 0; i < 1500; ++i) {
        glm::dmat4 m = random.rigid(random.power_of_ten(-1.0, 5.0));
        if (i % 3 == 1)
            for (int column = 0; column < 3; ++column) m[column] *= random.power_of_ten(-3.0, 3.0);
        if (i % 3 == 2) m[1] += random.uniform(-5.0, 5.0) * m[0];
        const glm::mat4 modelview = rounded(m);
        FixedFunctionVertex vertex{.position = {random.vector3(10.0), 1.0f}, .normal = random.vector3(1.0)};
        if (i % 5 == 0) vertex.normal = glm::vec3(random.direction());
        for (const NormalScaling scaling : scalings) {
            const EyeVectors exact = eye_vectors(vertex, modelview, scaling);
            const glm::vec4 n = unit_with(TexGenMode::normal_map, scaling).generate(vertex, modelview);
            const glm::vec4 r = unit_with(TexGenMode::reflection_map, scaling).generate(vertex, modelview);
            const glm::vec4 sphere = unit_with(TexGenMode::sphere_map, scaling).generate(vertex, modelview);
            const long double slack = 0x1p-48L * (1.0L + exact.k) * (1.0L + exact.k);
            for (int k = 0; k < 3; ++k) {
                const auto j = static_cast<std::size_t>(k);
                worst_normal = std::fmax(worst_normal, excess_ulps(n[k], exact.normal[j], 0x1p-48L * exact.k));
                worst_reflection = std::fmax(worst_reflection, excess_ulps(r[k], exact.reflection[j], slack));
                if (k < 2)
                    worst_sphere = std::fmax(
                        worst_sphere, excess_ulps(sphere[k], exact.reflection[j] / exact.m + 0.5L, slack / exact.m));
            }
            INFO("modelview ", hex(modelview), " position ", hex(vertex.position), " normal ", hex(vertex.normal),
                 " scaling ", static_cast<int>(scaling));
            REQUIRE(worst_normal <= 0.5L);
            REQUIRE(worst_reflection <= 0.5L);
            REQUIRE(worst_sphere <= 0.5L);
            CHECK(n.w == 1.0f);
            CHECK(r.w == 1.0f);
            CHECK(sphere.z == 0.0f);
            CHECK(sphere.w == 1.0f);
        }
    }
}

TEST_CASE("the sphere map of a vertex straight ahead, facing the eye, is the middle of the picture") {
    const FixedFunctionVertex vertex{.position = {0, 0, -5, 1}};
    const glm::vec4 sphere = unit_with(TexGenMode::sphere_map).generate(vertex, identity);
    CHECK(sphere == glm::vec4(0.5f, 0.5f, 0, 1));
    const glm::vec4 reflection = unit_with(TexGenMode::reflection_map).generate(vertex, identity);
    CHECK(reflection == glm::vec4(0, 0, 1, 1));
}

TEST_CASE("the eye vector is not divided by w") {
    const FixedFunctionVertex vertex{.position = {0, 3, -4, -7}, .normal = {1, 0, 0}};
    const glm::vec4 reflection = unit_with(TexGenMode::reflection_map).generate(vertex, identity);
    CHECK(reflection == glm::vec4(0.0f, 0.6f, -0.8f, 1.0f));
}

TEST_CASE("m = 0, the singularity of the sphere map, gives one half") {
    const TexGenUnit unit = unit_with(TexGenMode::sphere_map);
    // Behind the eye and facing away: r = (0, 0, -1).
    CHECK(unit.generate({.position = {0, 0, 5, 1}, .normal = {0, 0, 1}}, identity) == glm::vec4(0.5f, 0.5f, 0, 1));
    // Ahead and edge on.
    CHECK(unit.generate({.position = {0, 0, -3, 1}, .normal = {1, 0, 0}}, identity) == glm::vec4(0.5f, 0.5f, 0, 1));
}

TEST_CASE("beside the singularity the sphere map still knows its direction") {
    const TexGenUnit unit = unit_with(TexGenMode::sphere_map);
    for (const float tiny : {1e-3f, 1e-6f, 1e-12f, 1e-20f, 1e-30f, 1e-44f}) {
        CAPTURE(hex(tiny));
        // r = (tiny, 0, -1) nearly: s goes to 1, whatever the distance. Straight from the definition s - 1/2 is
        // sqrt((1 - rz) / 8) in the plane t = 1/2.
        const glm::vec4 right = unit.generate({.position = {tiny, 0, 1, 1}, .normal = {0, 0, 1}}, identity);
        const double rz = -1.0 / std::sqrt(1.0 + static_cast<double>(tiny) * static_cast<double>(tiny));
        CHECK(ulps(right.x, 0.5L + std::sqrt((1.0L - static_cast<long double>(rz)) / 8.0L)) <= 0.5L);
        CHECK(right.y == 0.5f);
        const glm::vec4 diagonal =
            unit.generate({.position = {-3 * tiny, 4 * tiny, 1, 1}, .normal = {0, 0, 1}}, identity);
        CHECK(diagonal.x == doctest::Approx(0.2f).epsilon(tiny < 1e-40f ? 0.3 : 1e-3));
        CHECK(diagonal.y == doctest::Approx(0.9f).epsilon(tiny < 1e-40f ? 0.3 : 1e-3));
    }
}

TEST_CASE("a vertex at the eye has no direction and a zero normal reflects nothing: no NaN comes of either") {
    for (const NormalScaling scaling : scalings) {
        CAPTURE(static_cast<int>(scaling));
        const FixedFunctionVertex at_eye{.position = {1, 2, 3, 1}};
        CHECK(unit_with(TexGenMode::reflection_map, scaling).generate(at_eye, translation(-1, -2, -3)) ==
              glm::vec4(0, 0, 0, 1));
        CHECK(unit_with(TexGenMode::sphere_map, scaling).generate(at_eye, translation(-1, -2, -3)) ==
              glm::vec4(0.5f, 0.5f, 0, 1));
        const FixedFunctionVertex no_normal{.position = {3, 0, -4, 1}, .normal = {0, 0, 0}};
        CHECK(unit_with(TexGenMode::reflection_map, scaling).generate(no_normal, identity) ==
              glm::vec4(0.6f, 0, -0.8f, 1));
        CHECK(unit_with(TexGenMode::normal_map, scaling).generate(no_normal, identity) == glm::vec4(0, 0, 0, 1));
    }
}

TEST_CASE("coordinates at either end of the range of float neither overflow nor vanish on their way to a direction") {
    for (const float size : {3e38f, 1e30f, 1.0f, 1e-30f, 1e-42f}) {
        CAPTURE(hex(size));
        const FixedFunctionVertex vertex{.position = {0.0f, size, -size, 1.0f}, .normal = {0, 0, 1}};
        const glm::vec4 r = unit_with(TexGenMode::reflection_map).generate(vertex, identity);
        CHECK(r == glm::vec4(0.0f, std::sqrt(0.5f), std::sqrt(0.5f), 1.0f));
        const FixedFunctionVertex long_normal{.position = {0, 1, -1, 1}, .normal = {0.0f, 0.0f, size}};
        CHECK(unit_with(TexGenMode::reflection_map, NormalScaling::normalize).generate(long_normal, identity) == r);
        const glm::vec4 n = unit_with(TexGenMode::normal_map, NormalScaling::rescale)
                                .generate({.position = {}}, scale(size, size, size));
        CHECK(n == glm::vec4(0, 0, 1, 1));
    }
    // The inverse holds 1e38 1e44 1e44, so this normal is too long to square; its direction is not, and a reflection in
    // it points along it.
    glm::mat4 steep = scale(1e-44f, 1e-44f, 1e-44f);
    steep[1][0] = 1e38f;
    steep[2][0] = 1e38f;
    steep[3][2] = -1e-44f;
    const FixedFunctionVertex vertex{.position = {0, 0, 0, 1}, .normal = {-1e38f, 0, 0}};
    const float diagonal = std::sqrt(0.5f);
    const glm::vec4 n = unit_with(TexGenMode::normal_map, NormalScaling::normalize).generate(vertex, steep);
    CHECK(n == glm::vec4(0, diagonal, diagonal, 1));
    const glm::vec4 raw = unit_with(TexGenMode::normal_map).generate(vertex, steep);
    CHECK(raw == glm::vec4(-infinity_float, infinity_float, infinity_float, 1));
    const glm::vec4 sphere = unit_with(TexGenMode::sphere_map).generate(vertex, steep);
    CHECK(sphere == glm::vec4(0.5f, static_cast<float>(0.5 + 0.5 * std::sqrt(0.5)), 0, 1));
    const glm::vec4 r = unit_with(TexGenMode::reflection_map).generate(vertex, steep);
    CHECK(r == glm::vec4(-infinity_float, infinity_float, infinity_float, 1));
}

TEST_CASE("what is left when large terms cancel is still exact") {
    const glm::vec4 plane(1.0f, 1e-5f, -1.0f, 0.0f);
    const FixedFunctionVertex vertex{.position = {1e12f, 1.0f, 1e12f, 1.0f}, .normal = {0, 0, 1}};
    TexGenUnit unit = unit_with(TexGenMode::object_linear);
    unit.set_object_plane(Coordinate::s, plane);
    CHECK(unit.generate(vertex, identity).x == 1e-5f);
    glm::mat4 modelview(1.0f);
    for (int column = 0; column < 4; ++column) modelview[column][0] = plane[column];
    const glm::vec4 strq = unit_with(TexGenMode::eye_linear).generate(vertex, modelview);
    CHECK(strq.x == 1e-5f);
}

TEST_CASE("under a non-uniform scale the three normal scalings give three normals") {
    const FixedFunctionVertex vertex{.position = {0, 0, -1, 1}, .normal = {0.6f, 0.0f, 0.8f}};
    const glm::mat4 modelview = scale(2, 1, 4);
    const double x = static_cast<double>(0.6f) / 2.0, z = static_cast<double>(0.8f) / 4.0;
    const glm::vec4 raw = unit_with(TexGenMode::normal_map, NormalScaling::none).generate(vertex, modelview);
    CHECK(raw == glm::vec4(static_cast<float>(x), 0.0f, static_cast<float>(z), 1.0f));
    const glm::vec4 rescaled = unit_with(TexGenMode::normal_map, NormalScaling::rescale).generate(vertex, modelview);
    CHECK(rescaled == glm::vec4(static_cast<float>(4.0 * x), 0.0f, static_cast<float>(4.0 * z), 1.0f));
    const glm::vec4 unit = unit_with(TexGenMode::normal_map, NormalScaling::normalize).generate(vertex, modelview);
    CHECK(unit ==
          glm::vec4(static_cast<float>(x / std::hypot(x, z)), 0.0f, static_cast<float>(z / std::hypot(x, z)), 1.0f));
}

TEST_CASE("a mirrored and a sheared surface keep their normals perpendicular") {
    Random random(9);
    for (int i = 0; i < 500; ++i) {
        glm::mat4 modelview = rounded(random.rigid(10.0));
        modelview[0] *= random.coin() ? -2.0f : 0.5f;
        modelview[1] += random.uniform_float(-3.0, 3.0) * modelview[2];
        const glm::dvec3 normal = random.direction();
        const glm::dvec3 other = random.direction();
        const glm::dvec3 tangent = other - normal * (other.x * normal.x + other.y * normal.y + other.z * normal.z);
        const glm::vec4 n = unit_with(TexGenMode::normal_map, NormalScaling::normalize)
                                .generate({.position = {}, .normal = glm::vec3(normal)}, modelview);
        const LongVector t = times(modelview, {glm::vec3(tangent), 0.0f});
        long double product = 0.0L;
        for (int k = 0; k < 3; ++k) product += static_cast<long double>(n[k]) * t[static_cast<std::size_t>(k)];
        CHECK(std::fabs(product) <= 1e-5L);
    }
}

TEST_CASE("a singular MODELVIEW gives NaN where a normal is needed, and the linear modes go on") {
    Random random(10);
    for (int i = 0; i < 300; ++i) {
        const glm::mat4 m = random_singular(random, i % 6);
        const FixedFunctionVertex vertex{.position = {1, 2, 3, 1}, .normal = {0, 1, 0}};
        for (const NormalScaling scaling : scalings) {
            TexGenUnit unit = unit_with(TexGenMode::normal_map, scaling);
            REQUIRE(unit.set_mode(Coordinate::s, TexGenMode::sphere_map));
            REQUIRE(unit.set_mode(Coordinate::t, TexGenMode::reflection_map));
            REQUIRE(unit.set_eye_plane(Coordinate::q, {1, 2, 3, 4}, identity));
            unit.enable(Coordinate::q);
            const glm::vec4 strq = unit.generate(vertex, m);
            INFO("modelview ", hex(m), " gave ", hex(strq));
            CHECK(std::isnan(strq.x));
            CHECK(std::isnan(strq.y));
            CHECK(std::isnan(strq.z));
            const LongVector eye = times(m, vertex.position);
            CHECK(static_cast<long double>(strq.w) == eye[0] + 2.0L * eye[1] + 3.0L * eye[2] + 4.0L * eye[3]);
        }
    }
}

TEST_CASE("the texture matrix multiplies generated and given coordinates alike") {
    Random random(11);
    for (int i = 0; i < 2000; ++i) {
        TexGenUnit unit;
        const glm::mat4 matrix{random.vector4(2.0), random.vector4(2.0), random.vector4(2.0), random.vector4(2.0)};
        unit.set_texture_matrix(matrix);
        CHECK(unit.texture_matrix() == matrix);
        unit.enable(Coordinate::s, random.coin());
        unit.enable(Coordinate::q, random.coin());
        REQUIRE(unit.set_mode(Coordinate::q, TexGenMode::object_linear));
        const glm::vec4 plane = random.vector4(2.0);
        unit.set_object_plane(Coordinate::q, plane);
        const FixedFunctionVertex vertex{
            .position = random.vector4(5.0), .normal = {0, 0, 1}, .texcoord = random.vector4(1.0)};
        LongVector before{};
        for (int k = 0; k < 4; ++k) before[static_cast<std::size_t>(k)] = static_cast<long double>(vertex.texcoord[k]);
        if (unit.enabled(Coordinate::s)) before[0] = static_cast<long double>(vertex.position.x);
        if (unit.enabled(Coordinate::q)) {
            before[3] = 0.0L;
            for (int k = 0; k < 4; ++k)
                before[3] += static_cast<long double>(plane[k]) * static_cast<long double>(vertex.position[k]);
        }
        const glm::vec4 strq = unit.generate(vertex, identity);
        for (int row = 0; row < 4; ++row) {
            long double exact = 0.0L, terms = 0.0L;
            for (int k = 0; k < 4; ++k) {
                const long double term = static_cast<long double>(matrix[k][row]) * before[static_cast<std::size_t>(k)];
                exact += term;
                terms += std::fabs(term);
            }
            INFO("matrix ", hex(matrix), " plane ", hex(plane), " position ", hex(vertex.position));
            CHECK(excess_ulps(strq[row], exact, terms * 0x1p-50L) <= 0.5L);
        }
    }
}

TEST_CASE("SGI's recipe, projector in the texture matrix and identity eye planes, equals ours with r left in NDC") {
    Random random(12);
    const texgen::Projector projector = slide_projector();
    glm::dmat4 half(1.0);
    half[0][0] = half[1][1] = half[3][0] = half[3][1] = 0.5;
    const glm::mat4 texture_matrix = rounded(half * projector.projection.matrix() * projector.view.matrix());
    for (int i = 0; i < 1000; ++i) {
        const glm::mat4 view = rounded(random.rigid(20.0));
        const glm::mat4 model = rounded(random.rigid(5.0));
        TexGenUnit unit;  // eye linear is the default
        unit.set_texture_matrix(texture_matrix);
        for (const Coordinate coordinate : coordinates) {
            glm::vec4 plane(0.0f);
            plane[static_cast<int>(coordinate)] = 1.0f;
            REQUIRE(unit.set_eye_plane(coordinate, plane, view));
            unit.enable(coordinate);
        }
        const FixedFunctionVertex vertex{.position = {random.vector3(5.0), 1.0f}};
        const glm::mat4 modelview = rounded(glm::dmat4(view) * glm::dmat4(model));
        const glm::vec4 strq = unit.generate(vertex, modelview);
        const glm::dmat4 ours = texgen::object_linear(projector, texgen::ModelMatrix(model), texgen::whole_texture(),
                                                      texgen::DepthMapping::ndc)
                                    .matrix();
        const glm::dvec4 expected = ours * glm::dvec4(vertex.position);
        // Where it is lost: view, modelview and planes are rounded to float, 60 units from the origin.
        INFO("view ", hex(view), " model ", hex(model), " position ", hex(vertex.position));
        for (int k = 0; k < 4; ++k) CHECK(std::fabs(static_cast<double>(strq[k]) - expected[k]) <= 1e-4);
    }
}

// Bad values

TEST_CASE("a NaN or an infinity spoils the coordinates that are made from it, and no other") {
    for (const float bad : {nan_float, infinity_float}) {
        TexGenUnit unit;
        REQUIRE(unit.set_mode(Coordinate::s, TexGenMode::object_linear));
        REQUIRE(unit.set_mode(Coordinate::t, TexGenMode::normal_map));
        REQUIRE(unit.set_mode(Coordinate::r, TexGenMode::reflection_map));
        REQUIRE(unit.set_eye_plane(Coordinate::q, {0, 0, 1, 0}, identity));
        for (const Coordinate coordinate : coordinates) unit.enable(coordinate);
        const FixedFunctionVertex good{.position = {1, 0, -1, 1}, .normal = {0, 1, 0}, .texcoord = {5, 6, 7, 8}};
        const glm::vec4 right = unit.generate(good, identity);

        FixedFunctionVertex vertex = good;
        vertex.position.x = bad;
        glm::vec4 strq = unit.generate(vertex, identity);
        CHECK_FALSE(std::isfinite(strq.x));
        CHECK(strq.y == right.y);
        CHECK_FALSE(std::isfinite(strq.z));

        vertex = good;
        vertex.normal.y = bad;
        strq = unit.generate(vertex, identity);
        CHECK(strq.x == right.x);
        CHECK_FALSE(std::isfinite(strq.y));
        CHECK_FALSE(std::isfinite(strq.z));
        CHECK(strq.w == right.w);

        vertex = good;
        vertex.texcoord = glm::vec4(bad);
        CHECK(unit.generate(vertex, identity) == right);
        unit.enable(Coordinate::r, false);
        strq = unit.generate(vertex, identity);
        CHECK_FALSE(std::isfinite(strq.z));
        CHECK(glm::vec3(strq.x, strq.y, strq.w) == glm::vec3(right.x, right.y, right.w));
    }
    // An infinite coordinate with a plane that does look at it is an infinite distance.
    CHECK(unit_with(TexGenMode::object_linear).generate({.position = {infinity_float, 1, 1, 1}}, identity).x ==
          infinity_float);
}

TEST_CASE("a batch has the bits of its vertices one by one, and a bad vertex spoils itself only") {
    Random random(13);
    for (const TexGenMode mode : modes) {
        for (const NormalScaling scaling : scalings) {
            const TexGenUnit unit = unit_with(mode, scaling);
            const glm::mat4 modelview = rounded(random.rigid(10.0));
            std::vector<FixedFunctionVertex> vertices;
            for (int i = 0; i < 37; ++i)
                vertices.push_back(
                    {.position = random.vector4(9.0), .normal = random.vector3(1.0), .texcoord = random.vector4(1.0)});
            vertices[17].position = glm::vec4(nan_float);
            vertices[17].normal = glm::vec3(nan_float);
            std::vector<glm::vec4> strq(vertices.size());
            unit.generate(vertices, modelview, strq);
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                if (i != 17) CHECK(same_bits(strq[i], unit.generate(vertices[i], modelview)));
                if (i != 17) CHECK(std::isfinite(strq[i].x + strq[i].y + strq[i].z + strq[i].w));
            }
        }
    }
}

TEST_CASE("random bits in every argument: no plane that is not finite is stored, the sphere map stays in its square") {
    Random random(14);
    const auto any4 = [&random] {
        return glm::vec4{random.any_float(), random.any_float(), random.any_float(), random.any_float()};
    };
    int stored = 0;
    for (int i = 0; i < 20000; ++i) {
        glm::mat4 modelview{any4(), any4(), any4(), any4()};
        if (i % 2 == 0) modelview[0][3] = modelview[1][3] = modelview[2][3] = 0.0f;
        TexGenUnit unit;
        for (const Coordinate coordinate : coordinates) {
            const auto mode = static_cast<TexGenMode>(random.integer(-1, 6));
            if (unit.set_mode(coordinate, mode)) unit.enable(coordinate, random.integer(0, 3) != 0);
            unit.set_object_plane(coordinate, any4());
            stored += unit.set_eye_plane(coordinate, any4(), modelview) ? 1 : 0;
            for (int k = 0; k < 4; ++k) CHECK(std::isfinite(unit.eye_plane(coordinate)[k]));
        }
        unit.set_normal_scaling(static_cast<NormalScaling>(random.integer(-1, 3)));
        const FixedFunctionVertex vertex{.position = any4(), .normal = glm::vec3(any4()), .texcoord = any4()};
        const glm::vec4 strq = unit.generate(vertex, modelview);
        for (const Coordinate coordinate : {Coordinate::s, Coordinate::t}) {
            const float value = strq[static_cast<int>(coordinate)];
            if (unit.enabled(coordinate) && unit.mode(coordinate) == TexGenMode::sphere_map && !std::isnan(value)) {
                CHECK(value >= 0.0f);
                CHECK(value <= 1.0f);
            }
        }
    }
    CHECK(stored > 1000);
}

}  // namespace
