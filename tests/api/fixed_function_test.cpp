// The fixed function: its state, its texture matrix, and bad values.

#include "texgen/fixed_function.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "api/fixed_function_test/exact_values.hpp"
#include "api/fixed_function_test/units.hpp"
#include "support/fixed_function.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/transform.hpp"

namespace fixed_function_cases {

using support::hex;
using support::infinity_float;
using support::modes;
using support::nan_float;

namespace {

bool same_bits(const glm::vec4& a, const glm::vec4& b) {
    for (int i = 0; i < 4; ++i)
        if (std::bit_cast<std::uint32_t>(a[i]) != std::bit_cast<std::uint32_t>(b[i])) return false;
    return true;
}

}  // namespace

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
    const texgen::Projector projector = support::slide_projector();
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
        for (const NormalScaling scaling : support::scalings) {
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

}  // namespace fixed_function_cases
