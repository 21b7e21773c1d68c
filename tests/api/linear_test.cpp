// The texgen matrices: Everitt (3) and (4), the planes that glTexGen stores, and all of them far from the origin.

#include "texgen/linear.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "judges/oracle.hpp"
#include "judges/rational_matrix.hpp"
#include "judges/real.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"

namespace {

using support::exactly;
using support::hex;
using support::Random;
using support::Rational;
using support::RationalMatrix;
using support::Real;
using support::RealMatrix;
using support::Worst;
using texgen::Aim;
using texgen::CameraPose;
using texgen::EyeTexgen;
using texgen::ModelMatrix;
using texgen::PerspectiveLens;
using texgen::Projector;
using texgen::WorldTexgen;

PerspectiveLens lens(double degrees = 30.0) {
    return {.fovy = texgen::degrees(degrees), .aspect = 1.0, .z_near = 0.2, .z_far = 1000.0};
}

// A projector at `distance` from the origin, an object and a camera beside it.
struct Scene {
    PerspectiveLens projector_lens;
    Aim aim;
    Projector projector;
    glm::dmat4 model, camera_pose;
};

Scene random_scene(Random& random, double distance) {
    const glm::dvec3 base = distance * random.direction();
    const glm::dvec3 view = random.direction();
    Aim aim{base, base + random.uniform(1.0, 5.0) * view, random.direction()};
    PerspectiveLens projector_lens = lens(random.uniform(20.0, 90.0));
    const auto posed_at = [&](double along) {
        glm::dmat4 pose = random.rotation();
        pose[3] = glm::dvec4(base + along * view + random.uniform(0.0, 1.0) * random.direction(), 1.0);
        return pose;
    };
    const glm::dmat4 model = posed_at(random.uniform(3.0, 10.0)), camera_pose = posed_at(random.uniform(-5.0, 2.0));
    const std::optional<Projector> projector = make_projector(projector_lens, aim, texgen::opengl);
    REQUIRE(projector);
    return {projector_lens, aim, *projector, model, camera_pose};
}

// S P_p V_p from the numbers that the user gave, with nothing rounded.
RealMatrix exact_texture_from_world(const Scene& scene) {
    const RealMatrix projection =
        support::perspective(Real(scene.projector_lens.fovy.in_radians()), Real(scene.projector_lens.aspect),
                             Real(scene.projector_lens.z_near), scene.projector_lens.z_far);
    const RealMatrix view = support::look_at(scene.aim.position, scene.aim.target, scene.aim.up);
    return support::operator*(support::operator*(support::scale_bias(), projection), view);
}

std::array<Real, 4> transformed(const RealMatrix& m, const glm::vec3& point) {
    std::array<Real, 4> result;
    for (std::size_t row = 0; row < 4; ++row)
        result[row] = m[row][0] * Real(point.x) + m[row][1] * Real(point.y) + m[row][2] * Real(point.z) + m[row][3];
    return result;
}

// How far the float matrix is from the exact one, in texels of a 4096 texture; empty where the slide does not fall.
std::optional<double> texel_error(const glm::mat4& floats, const RealMatrix& exact_matrix, const glm::vec3& point) {
    const std::array<Real, 4> exact = transformed(exact_matrix, point);
    const std::array<Real, 4> computed = transformed(support::real(glm::dmat4(floats)), point);
    double worst = 0.0;
    for (std::size_t k = 0; k < 2; ++k) {
        const Real u = exact[k] / exact[3];
        if (exact[3] <= 0 || u < 0 || u > 1) return std::nullopt;
        worst = std::max(worst, static_cast<double>(abs(computed[k] / computed[3] - u)) * 4096.0);
    }
    return worst;
}

glm::dmat4 to_double(const RealMatrix& m) {
    glm::dmat4 result(0.0);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            result[column][row] =
                static_cast<double>(m[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)]);
    return result;
}

// Whether |computed - product| <= roundings u |a| |b| ... element by element.
bool is_product(const glm::dmat4& computed, const std::vector<glm::dmat4>& factors, int roundings) {
    RationalMatrix product = exactly(factors[0]), terms = support::magnitudes(product);
    for (std::size_t i = 1; i < factors.size(); ++i) {
        const RationalMatrix factor = exactly(factors[i]);
        product = support::operator*(product, factor);
        terms = support::operator*(terms, support::magnitudes(factor));
    }
    const RationalMatrix sum = exactly(computed);
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            if (support::magnitude(sum[i][j] - product[i][j]) > exactly(texgen::detail::gamma(roundings)) * terms[i][j])
                return false;
    return true;
}

}  // namespace

TEST_CASE("object linear is Everitt (3), T_o = S P_p V_p M") {
    Random random(91);
    for (int i = 0; i < 200; ++i) {
        const Scene scene = random_scene(random, random.power_of_ten(-2.0, 4.0));
        const auto region = texgen::atlas_tile({0.25, 0.5}, {0.75, 2.0});
        const glm::dmat4 s = scale_bias(scene.projector.conventions, region, texgen::DepthMapping::ndc).matrix();
        const glm::dmat4 p = scene.projector.projection.matrix(), v = scene.projector.view.matrix();
        REQUIRE(
            is_product(texture_from_world(scene.projector, region, texgen::DepthMapping::ndc).matrix(), {s, p, v}, 8));
        REQUIRE(is_product(
            object_linear(scene.projector, ModelMatrix(scene.model), region, texgen::DepthMapping::ndc).matrix(),
            {s, p, v, scene.model}, 12));
    }
}

TEST_CASE("eye linear is Everitt (4), T_e = S P_p V_p V_e^-1, and under MODELVIEW = V_e M equals T_o") {
    Random random(92);
    for (int i = 0; i < 200; ++i) {
        const Scene scene = random_scene(random, random.power_of_ten(-2.0, 3.0));
        const glm::dmat4 s = scale_bias(scene.projector.conventions).matrix();
        const glm::dmat4 p = scene.projector.projection.matrix(), v = scene.projector.view.matrix();
        const EyeTexgen t_e = eye_linear(scene.projector, CameraPose(scene.camera_pose));
        REQUIRE(is_product(t_e.matrix(), {s, p, v, scene.camera_pose}, 12));
        const texgen::ViewMatrix v_e = inverse_rigid(CameraPose(scene.camera_pose));
        const auto t_o = object_linear(scene.projector, ModelMatrix(scene.model));
        const glm::dmat4 by_eye = (t_e * (v_e * ModelMatrix(scene.model))).matrix();
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                REQUIRE(std::fabs(by_eye[column][row] - t_o.matrix()[column][row]) <= 1e-10);
    }
}

TEST_CASE("the texgen of a light that the camera carries is S P_p V, one matrix for all poses of the camera") {
    Random random(99);
    for (int i = 0; i < 200; ++i) {
        const Scene scene = random_scene(random, random.power_of_ten(-2.0, 2.0));
        const auto region = texgen::atlas_tile({0.25, 0.5}, {0.75, 2.0});
        // On the camera's side, and turned a little.
        glm::dmat4 mounting = random.rotation();
        mounting[3] = glm::dvec4(random.direction(), 1.0);
        const texgen::Transform<texgen::ProjectorEye, texgen::Eye> view(mounting);
        const EyeTexgen carried =
            eye_linear(scene.projector.projection, view, texgen::vulkan, region, texgen::DepthMapping::ndc);
        const glm::dmat4 s = scale_bias(texgen::vulkan, region, texgen::DepthMapping::ndc).matrix();
        REQUIRE(is_product(carried.matrix(), {s, scene.projector.projection.matrix(), mounting}, 8));

        // The same as a projector in the world, posed anew with the camera.
        const CameraPose pose(scene.camera_pose);
        const Projector posed{scene.projector.projection, view * inverse_rigid(pose), texgen::vulkan};
        const EyeTexgen by_world = eye_linear(posed, pose, region, texgen::DepthMapping::ndc);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                REQUIRE(std::fabs(by_world.matrix()[column][row] - carried.matrix()[column][row]) <= 1e-10);
        // glTexGen keeps its rows as they are when MODELVIEW is the identity.
        REQUIRE(eye_planes_as_stored(carried, texgen::Transform<texgen::Eye, texgen::Eye>(glm::dmat4(1.0)))->matrix() ==
                carried.matrix());
    }
    // A light at the eye: the middle of what the camera sees has the middle of the slide.
    const auto light = perspective(lens(), texgen::opengl);
    const EyeTexgen headlight =
        eye_linear(*light, texgen::Transform<texgen::ProjectorEye, texgen::Eye>(glm::dmat4(1.0)), texgen::opengl);
    const glm::dvec4 strq = headlight.matrix() * glm::dvec4(0.0, 0.0, -7.0, 1.0);
    CHECK(strq.x / strq.w == 0.5);
    CHECK(strq.y / strq.w == 0.5);
    CHECK(strq.w == 7.0);
}

TEST_CASE("the planes of S P_p V_p stored under MODELVIEW = V_e are T_e, as are those of S P_p under V_e V_p^-1") {
    Random random(93);
    for (int i = 0; i < 200; ++i) {
        const double distance = random.power_of_ten(-2.0, 7.0);
        const Scene scene = random_scene(random, distance);
        const EyeTexgen t_e = eye_linear(scene.projector, CameraPose(scene.camera_pose));
        const texgen::ViewMatrix v_e = inverse_rigid(CameraPose(scene.camera_pose));
        const auto stored = eye_planes_as_stored(texture_from_world(scene.projector), v_e);
        REQUIRE(stored);
        const auto texture_from_projector = scale_bias(scene.projector.conventions) * scene.projector.projection;
        const auto eye_from_projector = v_e * inverse_rigid(scene.projector.view);
        const auto cancelled = eye_planes_as_stored(texture_from_projector, eye_from_projector);
        REQUIRE(cancelled);
        // A double's rounding of a world coordinate is all that may be left between them.
        const double slack = 2e-15 * (10.0 + distance);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) {
                REQUIRE(std::fabs(stored->matrix()[column][row] - t_e.matrix()[column][row]) <= slack);
                REQUIRE(std::fabs(cancelled->matrix()[column][row] - t_e.matrix()[column][row]) <= slack);
            }
    }
}

TEST_CASE("far poses: T_o, T_e and the stored planes, rounded to float, stay under 0.002 texel of 4096 up to 1e7") {
    Random random(94);
    for (int exponent = 0; exponent <= 7; ++exponent) {
        const double distance = std::pow(10.0, exponent);
        double eye = 0.0, stored = 0.0;
        int lit = 0;
        Worst object;
        for (int i = 0; i < 40; ++i) {
            const Scene scene = random_scene(random, distance);
            const RealMatrix world = exact_texture_from_world(scene);
            const RealMatrix exact_object = support::operator*(world, support::real(scene.model));
            const RealMatrix exact_eye = support::operator*(world, support::real(scene.camera_pose));
            const CameraPose pose(scene.camera_pose);
            const glm::mat4 t_o = object_linear(scene.projector, ModelMatrix(scene.model)).rounded();
            const glm::mat4 t_e = eye_linear(scene.projector, pose).rounded();
            const glm::mat4 planes =
                eye_planes_as_stored(texture_from_world(scene.projector), inverse_rigid(pose))->rounded();
            // Points about the object, and the same in the camera's eye space.
            const glm::dmat4 eye_from_object = (inverse_rigid(pose) * ModelMatrix(scene.model)).matrix();
            for (int k = 0; k < 8; ++k) {
                const glm::vec3 point = random.vector3(1.0);
                const glm::dvec4 eye_point = eye_from_object * glm::dvec4(glm::dvec3(point), 1.0);
                const glm::vec3 seen(support::to_float(eye_point.x), support::to_float(eye_point.y),
                                     support::to_float(eye_point.z));
                const auto object_error = texel_error(t_o, exact_object, point);
                const auto eye_error = texel_error(t_e, exact_eye, seen);
                const auto stored_error = texel_error(planes, exact_eye, seen);
                if (!object_error || !eye_error || !stored_error) continue;
                ++lit;
                object.take(*object_error, [&] { return hex(scene.model) + " point " + hex(point); });
                eye = std::max(eye, *eye_error);
                stored = std::max(stored, *stored_error);
            }
        }
        CAPTURE(distance);
        CHECK(lit > 50);
        CHECK_MESSAGE(object.error < 0.002, object.input);
        CHECK(eye < 0.002);
        CHECK(stored < 0.002);
        MESSAGE("at ", distance, ": T_o ", object.error, ", T_e ", eye, ", stored ", stored, " texel at most, ", lit,
                " points");
    }
}

TEST_CASE("composed at 1e7 from the origin, the matrices in double are those of exact poses to 4e-8") {
    Random random(95);
    for (int i = 0; i < 50; ++i) {
        const Scene scene = random_scene(random, 1e7);
        const glm::dmat4 exact =
            to_double(support::operator*(exact_texture_from_world(scene), support::real(scene.model)));
        const glm::dmat4 computed = object_linear(scene.projector, ModelMatrix(scene.model)).matrix();
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) REQUIRE(std::fabs(computed[column][row] - exact[column][row]) <= 4e-8);
    }
}

TEST_CASE("stored planes are p M^-1 within 0.54 float ulp of their largest component, to a condition of 1e8") {
    Random random(96);
    int conditioned = 0;
    Worst worst;
    for (int i = 0; i < 600; ++i) {
        glm::dmat4 m = random.matrix();
        const int kind = i % 3;
        if (kind == 0) {  // near to singular
            const double distance = random.power_of_ten(-7.0, -2.0);
            for (int k = 0; k < 4; ++k) m[k][2] = m[k][0] + distance * m[k][2];
        } else if (kind == 1) {  // any scale
            m = random.power_of_ten(-30.0, 30.0) * m;
        } else {  // a modelview with a scale of each axis
            m = random.rigid(1000.0);
            for (int axis = 0; axis < 3; ++axis) m[axis] *= random.power_of_ten(-4.0, 4.0);
        }
        m = glm::dmat4(support::rounded(m));
        const std::optional<RationalMatrix> inverse = support::inverse(exactly(m));
        if (!inverse) continue;
        WorldTexgen planes{glm::dmat4(support::rounded(random.rigid(2.0)))};
        const auto stored = eye_planes_as_stored(planes, texgen::ViewMatrix(m));
        REQUIRE_MESSAGE(stored, hex(m));
        const RationalMatrix exact = support::operator*(exactly(planes.matrix()), *inverse);
        const glm::mat4 rounded = stored->rounded();
        for (std::size_t row = 0; row < 4; ++row) {
            Rational largest = 0;
            for (const Rational& element : exact[row]) largest = std::max(largest, support::magnitude(element));
            for (std::size_t column = 0; column < 4; ++column) {
                const float element = rounded[static_cast<int>(column)][static_cast<int>(row)];
                if (!std::isfinite(element)) continue;
                const double error =
                    support::nearest<double>(support::magnitude(exactly(element) - exact[row][column]) *
                                             support::power_of_two(-support::ulp_exponent<float>(largest)));
                worst.take(error, [&] { return hex(m) + " plane " + std::to_string(row); });
            }
        }
        conditioned += kind == 0;
    }
    CHECK(conditioned > 150);
    CHECK_MESSAGE(worst.error <= 0.54, worst.input);
    MESSAGE(worst.error, " ulp at most");
}

TEST_CASE("an example of the specification: T(10, 20, 30) with p = (1, 2, 3, 4) stores (1, 2, 3, -136)") {
    glm::dmat4 planes(0.0);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) planes[column][row] = column + 1;
    glm::dmat4 translation(1.0);
    translation[3] = {10, 20, 30, 1};
    const auto stored = eye_planes_as_stored(WorldTexgen(planes), texgen::ViewMatrix(translation));
    REQUIRE(stored);
    for (const glm::vec4& plane : texgen::planes(*stored)) CHECK(plane == glm::vec4(1, 2, 3, -136));
}

TEST_CASE("a singular MODELVIEW, and anything that is not finite, stores nothing") {
    Random random(97);
    const WorldTexgen planes(random.rigid(1.0));
    glm::dmat4 flat(1.0);
    flat[1][1] = 0.0;
    CHECK_FALSE(eye_planes_as_stored(planes, texgen::ViewMatrix(flat)));
    CHECK_FALSE(eye_planes_as_stored(planes, texgen::ViewMatrix(glm::dmat4(0.0))));
    for (const double bad : {support::nan_double, support::infinity_double}) {
        glm::dmat4 m(1.0);
        m[2][1] = bad;
        CHECK_FALSE(eye_planes_as_stored(planes, texgen::ViewMatrix(m)));
        CHECK_FALSE(eye_planes_as_stored(WorldTexgen(m), texgen::ViewMatrix(glm::dmat4(1.0))));
    }
    glm::dmat4 tiny(1.0);
    tiny[0][0] = 1e-310;
    CHECK_FALSE(eye_planes_as_stored(planes, texgen::ViewMatrix(tiny)));
}

TEST_CASE("planes are the rows S, T, R, Q, rounded once") {
    Random random(98);
    const glm::dmat4 m = random.rigid(10.0);
    const std::array<glm::vec4, 4> rows = texgen::planes(WorldTexgen(m));
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            CHECK(rows[static_cast<std::size_t>(row)][column] == support::nearest<float>(exactly(m[column][row])));
}

TEST_CASE("with the walk-through's projector, the target of the aim gets the middle of the slide") {
    const auto projector = make_projector(lens(), {{2, 5, 5}, {-2, -4, 0}, {0, 1, 0}}, texgen::opengl);
    REQUIRE(projector);
    const glm::dvec4 strq = texture_from_world(*projector).matrix() * glm::dvec4(-2, -4, 0, 1);
    CHECK(strq.x / strq.w == doctest::Approx(0.5).epsilon(1e-14));
    CHECK(strq.y / strq.w == doctest::Approx(0.5).epsilon(1e-14));
    CHECK(strq.w == doctest::Approx(std::sqrt(122.0)).epsilon(1e-14));
    const glm::dvec4 behind = texture_from_world(*projector).matrix() * glm::dvec4(6, 14, 10, 1);
    CHECK(behind.w < 0.0);
}
