// What a slide covers of boxes and spheres: never a false outside, never a false inside, judged by exact sums.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "api/coverage_test/judge.hpp"
#include "api/coverage_test/slides.hpp"
#include "judges/oracle.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/coverage.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace coverage_cases {

using support::nan_double;
using support::nan_float;
using texgen::coverage;

namespace {

enum class Family { ordinary, at_side, at_edge, at_apex, integers, tiny, huge, unbounded, empty, nan, bits };
constexpr int family_count = 11;

Box hostile_box(const Slide& slide, Family family, Random& random) {
    const double reach = random.power_of_ten(-1.0, 2.0);
    glm::dvec3 about = random.uniform(0.0, 1.0) * reach * random.direction();
    // Where the projector is, if it is far away.
    if (random.integer(0, 3) != 0) {
        const glm::dvec3 apex = point_on(slide, 3, random, glm::dvec3(0.0));
        if (std::fabs(apex.x) + std::fabs(apex.y) + std::fabs(apex.z) < 1e7) about += apex;
    }
    const auto box_from = [&](const glm::vec3& corner, double size) {
        Box box{corner, corner};
        for (int j = 0; j < 3; ++j) {
            if (random.integer(0, 3) == 0) continue;  // flat
            const float other = support::to_float(static_cast<double>(corner[j]) + random.uniform(-1.0, 1.0) * size);
            box.min[j] = std::min(corner[j], other);
            box.max[j] = std::max(corner[j], other);
        }
        return box;
    };
    const auto near = [&](const glm::dvec3& p) {
        glm::vec3 result;
        for (int j = 0; j < 3; ++j) result[j] = support::neighbour(support::to_float(p[j]), random.integer(-2, 2));
        return result;
    };
    const double size = random.power_of_ten(-2.0, 2.0);
    if (slide.touched && (family == Family::at_side || family == Family::at_edge) && random.integer(0, 3) != 0)
        return box_from(*slide.touched, size);
    switch (family) {
        case Family::ordinary:
            return box_from(glm::vec3(about), size);
        case Family::at_side:
            return box_from(near(point_on(slide, 1, random, about)), size);
        case Family::at_edge:
            return box_from(near(point_on(slide, 2, random, about)), size);
        case Family::at_apex:
            return box_from(near(point_on(slide, 3, random, about)), size);
        case Family::integers: {
            Box box{};
            for (int j = 0; j < 3; ++j) {
                const int first = random.integer(-4, 4), second = random.integer(-4, 4);
                box.min[j] = static_cast<float>(std::min(first, second));
                box.max[j] = static_cast<float>(std::max(first, second));
            }
            return box;
        }
        case Family::tiny:
            return box_from(
                random.coin() ? near(point_on(slide, random.integer(1, 3), random, about)) : glm::vec3(0.0f),
                random.power_of_ten(-44.0, -4.0));
        case Family::huge:
            return box_from(glm::vec3(about), random.power_of_ten(4.0, 38.0));
        case Family::unbounded: {
            Box box = random.coin() ? hostile_box(slide, Family::integers, random)
                                    : box_from(near(point_on(slide, random.integer(1, 3), random, about)), size);
            for (int j = 0; j < 3; ++j) {
                if (random.integer(0, 2) == 0) box.min[j] = -infinity_float;
                if (random.integer(0, 2) == 0) box.max[j] = infinity_float;
            }
            if (random.integer(0, 19) == 0) box.min.x = infinity_float;
            return box;
        }
        case Family::empty: {
            Box box = box_from(glm::vec3(about), size);
            const int axis = random.integer(0, 2);
            std::swap(box.min[axis], box.max[axis]);
            if (box.min[axis] == box.max[axis]) box.max[axis] = support::neighbour(box.max[axis], -1);
            if (random.integer(0, 9) == 0) box = {glm::vec3(infinity_float), glm::vec3(-infinity_float)};
            return box;
        }
        case Family::nan: {
            Box box = box_from(glm::vec3(about), size);
            (random.coin() ? box.min : box.max)[random.integer(0, 2)] = nan_float;
            return box;
        }
        case Family::bits:
            return {{random.any_float(), random.any_float(), random.any_float()},
                    {random.any_float(), random.any_float(), random.any_float()}};
    }
    return {};
}

}  // namespace

TEST_CASE("no box of a hostile family is outside or inside that is not, and the planes are decided exactly") {
    Random random(41);
    const long total = count_of("TEXGEN_COVERAGE_BOXES", 300000);
    std::array<Counts, family_count> counts{};
    long done = 0, have_depth = 0;
    while (done < total) {
        Slide slide = hostile_slide(random);
        if (random.coin()) touch(slide, random.vector3(random.power_of_ten(-1.0, 5.0)), random);
        const WorldTexgen transform(slide.matrix);
        const Judge judge(slide.matrix, slide.region);
        const bool is_exact = has_moderate_exponents(slide.matrix, slide.region);
        std::vector<Box> boxes;
        std::vector<Family> families;
        for (int i = random.integer(0, 150); i > 0; --i) {
            families.push_back(static_cast<Family>(random.integer(0, family_count - 1)));
            boxes.push_back(hostile_box(slide, families.back(), random));
        }
        std::vector<Coverage> answers(boxes.size(), Coverage::inside);
        const texgen::LitVolume volume(transform, slide.region);
        volume.coverage(boxes, answers);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            Counts& of_family = counts[static_cast<std::size_t>(families[i])];
            std::string wrong = what_is_wrong(answers[i], judge, is_exact, boxes[i], of_family);
            if (!is_a_region(slide.region) && !has_nan(boxes[i]))
                wrong = answers[i] == Coverage::outside ? "" : "the region is empty, and it is not outside";
            if (volume.coverage(boxes[i]) != answers[i]) wrong = "one box alone is something else";
            REQUIRE_MESSAGE(wrong.empty(), wrong << ": " << hex(slide) << ", " << hex(boxes[i]) << ": "
                                                 << static_cast<int>(answers[i]));
        }
        done += static_cast<long>(boxes.size());
        have_depth += slide.region.depth() ? static_cast<long>(boxes.size()) : 0;
    }
    CHECK(have_depth > total / 3);
    MESSAGE("of " << done << " boxes " << have_depth << " are of a region with a depth");
    const auto of = [&](Family family) -> const Counts& { return counts[static_cast<std::size_t>(family)]; };
    for (int family = 0; family < family_count; ++family) {
        const Counts& c = counts[static_cast<std::size_t>(family)];
        MESSAGE("family " << family << ": outside " << c.outside << ", by a separating plane alone " << c.separated
                          << ", partial " << c.partial << ", inside " << c.inside << ", touching " << c.touching);
        if (family >= static_cast<int>(Family::empty)) continue;
        CHECK(c.outside > total / 1000);
        CHECK(c.partial > total / 1000);
    }
    CHECK(of(Family::integers).touching > total / 300);
    CHECK(of(Family::unbounded).separated > 0);
    for (const Family family : {Family::at_side, Family::at_edge, Family::at_apex, Family::integers})
        CHECK(of(family).separated > total / 10000);
    for (const Family family :
         {Family::ordinary, Family::at_side, Family::at_edge, Family::integers, Family::unbounded})
        CHECK(of(family).inside > total / 5000);
}

TEST_CASE("what is no body, no slide or no number gets a safe answer") {
    const auto projector = texgen::make_projector(
        texgen::PerspectiveLens{.fovy = degrees(30), .aspect = 1, .z_near = 0.2, .z_far = 1000},
        texgen::Aim{.position = {0, 0, 0}, .target = {0, 0, -1}, .up = {0, 1, 0}}, texgen::opengl);
    REQUIRE(projector);
    const WorldTexgen transform = texgen::texture_from_world(*projector);
    const Box inside{{-0.1f, -0.1f, -11.0f}, {0.1f, 0.1f, -10.0f}};
    const Sphere ball{{0.0f, 0.0f, -10.0f}, 0.5f};
    const Box behind{{-0.1f, -0.1f, 10.0f}, {0.1f, 0.1f, 11.0f}};
    const Box everything{glm::vec3(-infinity_float), glm::vec3(infinity_float)};
    CHECK(coverage(transform, whole_texture(), inside) == Coverage::inside);
    CHECK(coverage(transform, whole_texture(), ball) == Coverage::inside);
    CHECK(coverage(transform, whole_texture(), behind) == Coverage::outside);
    CHECK(coverage(transform, whole_texture(), everything) == Coverage::partial);

    // The apex itself has q = 0, and the half-space behind it, too.
    CHECK(coverage(transform, whole_texture(), Box{glm::vec3(0.0f), glm::vec3(0.0f)}) == Coverage::outside);
    CHECK(coverage(transform, whole_texture(),
                   Box{{-infinity_float, -infinity_float, 0.0f}, glm::vec3(infinity_float)}) == Coverage::outside);
    CHECK(coverage(transform, whole_texture(),
                   Box{{-infinity_float, -infinity_float, -1e-30f}, glm::vec3(infinity_float)}) == Coverage::partial);
    // A beam to infinity along the projector's axis.
    CHECK(coverage(transform, whole_texture(), Box{{-0.1f, -0.1f, -infinity_float}, {0.1f, 0.1f, -10.0f}}) ==
          Coverage::inside);

    SUBCASE("spheres") {
        const auto of = [&](const Sphere& sphere) {
            Coverage of_batch{};
            coverage(transform, whole_texture(), std::span(&sphere, 1), std::span(&of_batch, 1));
            CHECK(of_batch == coverage(transform, whole_texture(), sphere));
            return of_batch;
        };
        CHECK(of({{0, 0, -10}, -1.0f}) == Coverage::outside);
        CHECK(of({{0, 0, -10}, -infinity_float}) == Coverage::outside);
        CHECK(of({{0, 0, -10}, nan_float}) == Coverage::partial);
        CHECK(of({{nan_float, 0, -10}, -1.0f}) == Coverage::partial);
        CHECK(of({{0, 0, 10}, infinity_float}) == Coverage::partial);
        CHECK(of({{0, 0, infinity_float}, 1.0f}) == Coverage::partial);
        CHECK(of({{0, 0, 10}, 0.0f}) == Coverage::outside);
        CHECK(of({{0, 0, -10}, 0.0f}) == Coverage::inside);
    }
    SUBCASE("regions without a point are outside, and none is made of a NaN in the box") {
        for (const TextureRegion& region :
             {atlas_tile({0.6, 0.0}, {0.4, 1.0}), atlas_tile({0.0, nan_double}, {1.0, 1.0}),
              atlas_tile({0.0, 0.0}, {1.0, nan_double}), atlas_tile({infinite, 0.0}, {-infinite, 1.0})}) {
            CHECK(coverage(transform, region, inside) == Coverage::outside);
            CHECK(coverage(transform, region, ball) == Coverage::outside);
            CHECK(coverage(transform, region, Box{inside.min, glm::vec3(nan_float)}) == Coverage::partial);
        }
        CHECK(coverage(transform, atlas_tile({-infinite, -infinite}, {infinite, infinite}), inside) ==
              Coverage::inside);
        CHECK(coverage(transform, atlas_tile({-infinite, -infinite}, {infinite, infinite}), behind) ==
              Coverage::outside);
    }
    SUBCASE("a matrix with a NaN or an infinity anywhere makes everything partial, but what is empty") {
        for (int element = 0; element < 16; ++element) {
            for (const double bad : {nan_double, infinite, -infinite}) {
                glm::dmat4 matrix = transform.matrix();
                matrix[element / 4][element % 4] = bad;
                CHECK(coverage(WorldTexgen(matrix), whole_texture(), inside) == Coverage::partial);
                CHECK(coverage(WorldTexgen(matrix), whole_texture(), behind) == Coverage::partial);
                CHECK(coverage(WorldTexgen(matrix), whole_texture(), ball) == Coverage::partial);
                CHECK(coverage(WorldTexgen(matrix), whole_texture(), Box{inside.max, inside.min}) == Coverage::outside);
            }
        }
    }
    SUBCASE("numbers beyond the stated exponents make all that is not empty partial, wherever it is") {
        for (const double beyond : {0x1p201, 0x1p-201}) {
            for (int side = 0; side < 4; ++side) {
                glm::dvec2 min(-0x1p202), max(0x1p199);
                (side < 2 ? min : max)[side % 2] = side < 2 ? -beyond : beyond;
                if (side < 2) (side == 0 ? min.y : min.x) = -1.0;
                if (side >= 2) min = glm::dvec2(-1.0);
                CHECK(coverage(transform, atlas_tile(min, max), behind) == Coverage::partial);
                CHECK(coverage(transform, atlas_tile(min, max), ball) == Coverage::partial);
            }
        }
        for (const double beyond : {0x1p1001, 0x1p-1003}) {
            const WorldTexgen scaled(transform.matrix() * beyond);
            CHECK(coverage(scaled, whole_texture(), behind) == Coverage::partial);
            CHECK(coverage(scaled, whole_texture(), ball) == Coverage::partial);
            CHECK(coverage(scaled, whole_texture(), Box{inside.max, inside.min}) == Coverage::outside);
        }
    }
    SUBCASE("a sphere with a NaN in any number is partial, whatever else is wrong") {
        const TextureRegion empty = atlas_tile({1.0, 1.0}, {0.0, 0.0});
        for (int number = 0; number < 4; ++number) {
            Sphere sphere{{0, 0, 0}, number == 3 ? 1.0f : -1.0f};
            (number == 3 ? sphere.radius : sphere.centre[number]) = nan_float;
            for (const TextureRegion& region : {whole_texture(), empty}) {
                CHECK(coverage(transform, region, sphere) == Coverage::partial);
                Coverage of_batch = Coverage::outside;
                coverage(transform, region, std::span(&sphere, 1), std::span(&of_batch, 1));
                CHECK(of_batch == Coverage::partial);
            }
        }
    }
    SUBCASE("where q is 0 everywhere nothing is lit") {
        glm::dmat4 matrix = transform.matrix();
        for (int j = 0; j < 4; ++j) matrix[j][3] = 0.0;
        CHECK(coverage(WorldTexgen(matrix), whole_texture(), everything) == Coverage::outside);
        CHECK(coverage(WorldTexgen(matrix), whole_texture(), ball) == Coverage::outside);
        CHECK(coverage(WorldTexgen(glm::dmat4(0.0)), whole_texture(), everything) == Coverage::outside);
    }
    SUBCASE("an empty batch is answered") {
        coverage(transform, whole_texture(), std::span<const Box>(), std::span<Coverage>());
        coverage(transform, whole_texture(), std::span<const Sphere>(), std::span<Coverage>());
    }
}

}  // namespace coverage_cases
