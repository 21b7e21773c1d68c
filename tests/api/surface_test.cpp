// What the projection makes of a surface, against exact values: the side that the projector sees, areas and slopes on
// the slide, and the homography of a quadrilateral.

#include "texgen/surface.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "judges/numbers.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/surfaces.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace {

using support::corner_families;
using support::CornerFamily;
using support::Corners;
using support::corners_of;
using support::exact_determinant;
using support::facing_of_sign;
using support::hex;
using support::infinity_float;
using support::Random;
using support::relative_error;
using support::Worst;
using texgen::facing;
using texgen::Facing;
using texgen::receiver_plane;
using texgen::slide_area;
using texgen::TextureOrigin;

// How many triangles the test of facing takes of a family: TEXGEN_FACING_TRIANGLES says otherwise.
int facing_triangles() {
    const char* number = std::getenv("TEXGEN_FACING_TRIANGLES");
    return number != nullptr ? std::atoi(number) : 100000;
}

std::string hex(const Corners& corners) { return hex(corners[0]) + " " + hex(corners[1]) + " " + hex(corners[2]); }

}  // namespace

TEST_CASE("facing is the exact sign of det [s t q], to the last bit of triangles that are edge on or next to it") {
    Random random(401);
    const int triangles = facing_triangles();
    for (const CornerFamily family : corner_families) {
        int count[3] = {};
        for (int i = 0; i < triangles; ++i) {
            const Corners corners = corners_of(family, random);
            const TextureOrigin origin = random.coin() ? TextureOrigin::bottom_left : TextureOrigin::top_left;
            const int sign = exact_determinant(corners).sign();
            REQUIRE_MESSAGE(facing(corners[0], corners[1], corners[2], origin) == facing_of_sign(sign, origin),
                            hex(corners));
            REQUIRE(facing(corners[1], corners[2], corners[0], origin) == facing_of_sign(sign, origin));
            REQUIRE(facing(corners[1], corners[0], corners[2], origin) == facing_of_sign(-sign, origin));
            ++count[1 + sign];
        }
        CAPTURE(static_cast<int>(family));
        CHECK(std::min(count[0], count[2]) > triangles / 20);
        if (family == CornerFamily::edge_on) CHECK(count[1] > triangles / 5);
    }
}

TEST_CASE(
    "a triangle faces a projector that stands in front of it, under all conventions and wherever its corners are") {
    Random random(402);
    int behind = 0;
    for (int i = 0; i < 3000; ++i) {
        const texgen::Conventions conventions =
            std::array{texgen::opengl, texgen::direct3d, texgen::vulkan}[random.bits() % 3];
        const glm::dvec3 position = 5.0 * random.direction();
        const auto projector = make_projector(texgen::PerspectiveLens{texgen::degrees(50), 1.3, 0.1, 100},
                                              {position, random.direction(), random.direction()}, conventions);
        REQUIRE(projector);
        std::array<glm::dvec3, 3> world;
        for (glm::dvec3& corner : world) corner = 8.0 * random.direction();
        const glm::dmat4 texgen = texture_from_world(*projector).matrix();
        Corners strq;
        for (std::size_t k = 0; k < 3; ++k) strq[k] = glm::vec4(texgen * glm::dvec4(world[k], 1.0));
        const glm::dvec3 u = world[1] - world[0], v = world[2] - world[0], to = position - world[0];
        const double volume =
            to.x * (u.y * v.z - u.z * v.y) + to.y * (u.z * v.x - u.x * v.z) + to.z * (u.x * v.y - u.y * v.x);
        if (std::fabs(volume) < 1e-3) continue;
        REQUIRE(facing(strq[0], strq[1], strq[2], conventions.origin) ==
                (volume > 0.0 ? Facing::towards : Facing::away));
        behind += strq[0].w < 0.0f || strq[1].w < 0.0f || strq[2].w < 0.0f;
    }
    CHECK(behind > 500);
}

TEST_CASE("a number that is not finite is seen edge on, has no area and no plane; r is looked at by the plane alone") {
    Random random(403);
    for (const float bad : {support::nan_float, infinity_float, -infinity_float}) {
        for (int k = 0; k < 12; ++k) {
            Corners corners = corners_of(CornerFamily::ordinary, random);
            corners[static_cast<std::size_t>(k / 4)][k % 4] = bad;
            const auto& [a, b, c] = corners;
            const bool of_r = k % 4 == 2;
            CHECK((facing(a, b, c, TextureOrigin::bottom_left) == Facing::edge_on) == !of_r);
            CHECK(slide_area(a, b, c).has_value() == of_r);
            CHECK_FALSE(receiver_plane(a, b, c));
        }
        const glm::vec4 of_q_0(0, 1, 0, 0);  // whose q are in no product with it
        CHECK_FALSE(receiver_plane({bad, 0, 1, 1}, {1, 0, 0, 0}, of_q_0));
    }
    for (int i = 0; i < 50000; ++i) {
        Corners corners{};
        for (glm::vec4& corner : corners)
            for (int k = 0; k < 4; ++k) corner[k] = random.any_float();
        const auto area = slide_area(corners[0], corners[1], corners[2]);
        REQUIRE((!area || std::isfinite(*area)));
        const auto plane = receiver_plane(corners[0], corners[1], corners[2]);
        REQUIRE((!plane || (std::isfinite(plane->x) && std::isfinite(plane->y) && std::isfinite(plane->z))));
    }
}

TEST_CASE("slide_area is within 2^-50 of itself, and there where all q are positive") {
    Random random(404);
    Worst worst;
    for (const CornerFamily family : corner_families) {
        int count = 0;
        for (int i = 0; i < 5000; ++i) {
            Corners corners = corners_of(family, random);
            if (random.integer(0, 7) != 0)
                for (glm::vec4& corner : corners)
                    if (!(corner.w > 0.0f)) corner = -corner;
            const auto area = slide_area(corners[0], corners[1], corners[2]);
            const bool in_front = corners[0].w > 0.0f && corners[1].w > 0.0f && corners[2].w > 0.0f;
            REQUIRE(area.has_value() == in_front);
            if (!area) continue;
            ++count;
            const double error = relative_error(*area, support::exact_slide_area(corners));
            worst.take(error, [&] { return hex(corners); });
        }
        CHECK(count > 1000);
    }
    CHECK_MESSAGE(worst.error <= texgen::slide_area_error, worst.input);
    MESSAGE((worst.error * 0x1p52), " times 2^-52 at most: ", worst.input);
}

TEST_CASE("the texels of a rectangle texture under a square of the scene") {
    const auto projector = make_projector(texgen::PerspectiveLens{texgen::degrees(90), 1.0, 0.1, 100},
                                          {{0, 0, 4}, {0, 0, 0}, {0, 1, 0}}, texgen::opengl);
    REQUIRE(projector);
    // At a distance of 4 the slide is 8 units wide: 64 texels a unit.
    const glm::dmat4 texgen = texture_from_world(*projector, texgen::rectangle_texture(512, 512)).matrix();
    const auto strq = [&](double x, double y) { return glm::vec4(texgen * glm::dvec4(x, y, 0.0, 1.0)); };
    CHECK(*slide_area(strq(0, 0), strq(1, 0), strq(0, 1)) == doctest::Approx(2048.0).epsilon(1e-6));
    CHECK(*slide_area(strq(0, 0), strq(0, 1), strq(1, 0)) == doctest::Approx(-2048.0).epsilon(1e-6));
}

TEST_CASE("receiver_plane has the depth of all corners' plane, each number within 2^-49 of itself") {
    Random random(405);
    Worst worst;
    for (const CornerFamily family : corner_families) {
        int refused = 0;
        for (int i = 0; i < 5000; ++i) {
            const Corners corners = corners_of(family, random);
            const auto plane = receiver_plane(corners[0], corners[1], corners[2]);
            const support::Dyadic divisor = exact_determinant(corners);
            REQUIRE_MESSAGE(plane.has_value() == (divisor.sign() != 0), hex(corners));
            refused += !plane;
            if (!plane) continue;
            const auto exact = support::exact_receiver_plane(corners);
            for (int k = 0; k < 3; ++k) {
                const double error = relative_error((*plane)[k], exact[static_cast<std::size_t>(k)]);
                worst.take(error, [&] { return hex(corners); });
            }
        }
        CHECK((refused > 500) == (family == CornerFamily::edge_on || family == CornerFamily::graded));
    }
    CHECK_MESSAGE(worst.error <= texgen::receiver_plane_error, worst.input);
    MESSAGE((worst.error * 0x1p52), " times 2^-52 at most: ", worst.input);
}

TEST_CASE("within a texel the receiver's depth differs by no more than the plane's slopes allow") {
    Random random(406);
    for (int i = 0; i < 2000; ++i) {
        Corners corners = corners_of(CornerFamily::ordinary, random);
        const auto plane = receiver_plane(corners[0], corners[1], corners[2]);
        REQUIRE(plane);
        glm::dvec4 point[2] = {glm::dvec4(0.0), glm::dvec4(0.0)};
        for (glm::dvec4& p : point)
            for (const glm::vec4& corner : corners) p += random.uniform(0.0, 1.0) * glm::dvec4(corner);
        const glm::dvec3 one = glm::dvec3(point[0]) / point[0].w, other = glm::dvec3(point[1]) / point[1].w;
        const double bias = std::fabs(plane->x * (other.x - one.x)) + std::fabs(plane->y * (other.y - one.y));
        const double slack = 1e-13 * (std::fabs(plane->x) + std::fabs(plane->y) + std::fabs(plane->z) + 1.0) * 10.0;
        REQUIRE(std::fabs(other.z - one.z) <= bias + slack);
        REQUIRE(std::fabs(plane->x * one.x + plane->y * one.y + plane->z - one.z) <= slack);
    }
}
