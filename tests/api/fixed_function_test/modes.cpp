// The values of the modes, linear and of normals, and what becomes of them in singular places.

#include "texgen/fixed_function.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>

#include "api/fixed_function_test/exact_values.hpp"
#include "api/fixed_function_test/units.hpp"
#include "support/fixed_function.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"

namespace fixed_function_cases {

using support::hex;
using support::infinity_float;
using support::scalings;

namespace {

struct EyeVectors {
    LongVector eye{}, reflection{}, normal{};
    long double m = 0.0L;
    long double k = 0.0L;  // the length of the normal if nothing cancelled
};

long double length3(const LongVector& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

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

}  // namespace

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

}  // namespace fixed_function_cases
