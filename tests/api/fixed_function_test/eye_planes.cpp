// Eye planes: stored through the inverse of the MODELVIEW that is current, or refused where there is none.

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
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/transform.hpp"

namespace fixed_function_cases {

using support::hex;
using support::infinity_float;

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
    for (const float bad : {support::nan_float, infinity_float, -infinity_float}) {
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
    const texgen::Projector projector = support::slide_projector();
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

}  // namespace fixed_function_cases
