// The slide's planes: exact within their bound, and not finite where the matrix or a side is not.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "api/clip_slide_test/slide_polygons.hpp"
#include "judges/oracle.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/clip.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace clip_slide_cases {

using support::infinity_double;
using support::infinity_float;

TEST_CASE("the clip planes are the exact ones within their bound, and of their sign") {
    Random random(1101);
    int zero = 0, cancelling = 0;
    for (int i = 0; i < 3000; ++i) {
        glm::dmat4 matrix(0.0);
        const TextureRegion region = some_region(random);
        for (int column = 0; column < 4; ++column) {
            for (int row = 0; row < 4; ++row) matrix[column][row] = random.uniform(-1.0, 1.0);
            // A row that lies on a side, or next to it.
            if (region.depth() && random.integer(0, 3) == 0) matrix[column].z = region.depth()->x * matrix[column].w;
            if (random.integer(0, 3) == 0) {
                matrix[column].x = region.min().x * matrix[column].w;
                matrix[column].y = std::nextafter(region.max().y * matrix[column].w, 0.0);
                ++cancelling;
            }
        }
        const auto planes = clip_planes(texgen::WorldTexgen(matrix), region);
        for (int column = 0; column < 4; ++column) {
            const Point of_column{exactly(matrix[column].x), exactly(matrix[column].y), exactly(matrix[column].z),
                                  exactly(matrix[column].w)};
            REQUIRE(planes.size() == distance_count(region));
            for (std::size_t side = 0; side < planes.size(); ++side) {
                const Rational exact = distance(side, of_column, region);
                const Rational off = support::magnitude(exactly(planes[side][column]) - exact);
                const Rational bound = (Rational(1, 2) + support::power_of_two(-29)) *
                                       support::power_of_two(support::ulp_exponent<float>(exact));
                REQUIRE_MESSAGE(off <= bound, hex(matrix[column]), " ", hex(region.min()), " ", hex(region.max()));
                REQUIRE((exact < 0) == (planes[side][column] < 0.0f));
                zero += exact == 0;
            }
        }
    }
    CHECK(cancelling > 1000);
    CHECK(zero > 100);
}

TEST_CASE("a point is inside all clip planes where the projector lights it") {
    const texgen::PerspectiveLens lens{.fovy = texgen::degrees(30), .aspect = 1.5, .z_near = 0.2, .z_far = 1000};
    const texgen::Aim aim{.position = {2, 5, 5}, .target = {-2, -4, 0}, .up = {0, 1, 0}};
    Random random(1102);
    int inside = 0;
    for (const texgen::Conventions conventions : {texgen::opengl, texgen::vulkan}) {
        const auto projector = texgen::make_projector(lens, aim, conventions);
        REQUIRE(projector);
        const TextureRegion region = texgen::rectangle_texture(640.0, 480.0);
        const texgen::WorldTexgen matrix = texture_from_world(*projector, region);
        const auto planes = clip_planes(matrix, region);
        for (int i = 0; i < 2000; ++i) {
            const glm::dvec4 point(random.vector3(12.0), 1.0);
            const glm::dvec4 strq = matrix.matrix() * point;
            double least = HUGE_VAL, margin = HUGE_VAL;
            for (const glm::vec4& plane : planes) {
                double value = 0.0;
                for (int k = 0; k < 4; ++k) value += static_cast<double>(plane[k]) * point[k];
                least = std::min(least, value);
                margin = std::min(margin, std::fabs(value));
            }
            if (margin < 0.1) continue;
            const bool lit =
                strq.w > 0.0 && strq.x >= 0.0 && strq.x <= 640.0 * strq.w && strq.y >= 0.0 && strq.y <= 480.0 * strq.w;
            REQUIRE(lit == (least >= 0.0));
            inside += lit;
        }
    }
    CHECK(inside > 100);
}

TEST_CASE("what is not finite in the matrix is not finite in the planes that it reaches") {
    for (const float bad : {support::nan_float, infinity_float}) {
        glm::dmat4 matrix(1.0);
        matrix[2].x = static_cast<double>(bad);
        const auto planes = clip_planes(texgen::WorldTexgen(matrix), whole_texture());
        for (const std::size_t side : {0u, 3u, 4u}) CHECK(std::isfinite(planes[side].z));
        for (const std::size_t side : {1u, 2u}) CHECK_FALSE(std::isfinite(planes[side].z));
    }
}

TEST_CASE("an infinite side has no plane of its numbers, and an infinite w stays in what it reaches") {
    const auto without_side =
        clip_planes(texgen::WorldTexgen(glm::dmat4(1.0)), texgen::atlas_tile({-infinity_double, 0.0}, {1.0, 1.0}));
    const auto finite = [](const glm::vec4& plane) { return std::isfinite(plane.x + plane.y + plane.z + plane.w); };
    CHECK_FALSE(finite(without_side[1]));
    for (const std::size_t side : {0u, 2u, 3u, 4u}) CHECK(finite(without_side[side]));
    glm::dmat4 matrix(1.0);
    matrix[2].w = infinity_double;
    CHECK(clip_planes(texgen::WorldTexgen(matrix), whole_texture())[0] == glm::vec4(0, 0, infinity_float, 1));
}

}  // namespace clip_slide_cases
