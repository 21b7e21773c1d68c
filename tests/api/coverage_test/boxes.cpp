// Boxes beside edges and slides without some of their sides: which are outside, and few of them partial.

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "api/coverage_test/judge.hpp"
#include "api/coverage_test/slides.hpp"
#include "judges/exact.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/coverage.hpp"

namespace coverage_cases {

using texgen::coverage;
using texgen::LitVolume;

namespace {

// What is left where some sides are none, or lie so far away that they might be.
TextureRegion without_some_sides(const TextureRegion& region, Random& random) {
    glm::dvec2 min = region.min(), max = region.max();
    for (glm::length_t k = 0; k < 2; ++k) {
        const double far = random.coin() ? HUGE_VAL : random.power_of_ten(10.0, 60.0);
        if (random.coin()) min[k] = -far;
        if (random.coin()) max[k] = far;
    }
    const TextureRegion result = texgen::atlas_tile(min, max);
    return region.depth() ? result.with_depth(region.depth()->x, region.depth()->y) : result;
}

}  // namespace

TEST_CASE("an element far below the others bounds the slide where its region has no side") {
    // Of boxes without an end: there the sign of a product of two such elements decides.
    Random random(642);
    Counts counts;
    for (int n = 0; n < 6000; ++n) {
        const double tiny = std::ldexp(random.uniform(1.0, 2.0), -random.integer(400, 597));
        Slide slide{glm::dmat4(0.0), whole_texture()};
        for (int j = 0; j < 4; ++j) {
            for (const int k : {0, 1, 3}) {
                const double sign = random.coin() ? 1.0 : -1.0;
                const int kind = random.integer(0, 3);
                slide.matrix[j][k] = kind == 0 ? 0.0 : kind == 1 ? sign * tiny : sign * random.integer(1, 4) / 4.0;
            }
        }
        slide.matrix[3][3] = 1.0;  // the largest, so that nothing is below 2^-600 of it
        glm::dvec2 min(0.0), max(1.0);
        for (int k = 0; k < 2; ++k) {
            if (random.coin()) min[k] = -infinite;
            if (random.integer(0, 2) != 0) max[k] = infinite;
        }
        slide.region = atlas_tile(min, max);
        const Judge judge(slide.matrix, slide.region);
        const LitVolume<texgen::World> volume(WorldTexgen(slide.matrix), slide.region);
        std::vector<Box> boxes(10);
        for (Box& box : boxes) {
            for (int j = 0; j < 3; ++j) {
                box.min[j] = support::to_float(random.uniform(-4.0, 4.0));
                box.max[j] = box.min[j] + 0.25f;
            }
            for (int ends = random.integer(1, 2); ends > 0; --ends)
                random.coin() ? box.min[random.integer(0, 2)] = -infinity_float
                              : box.max[random.integer(0, 2)] = infinity_float;
        }
        std::vector<Coverage> answers(boxes.size());
        volume.coverage(boxes, answers);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            std::string wrong = what_is_wrong(answers[i], judge, true, boxes[i], counts);
            if (volume.coverage(boxes[i]) != answers[i]) wrong = "one box alone is something else";
            REQUIRE_MESSAGE(wrong.empty(), wrong << ": " << hex(slide) << ", " << hex(boxes[i]) << ": "
                                                 << static_cast<int>(answers[i]));
        }
    }
    MESSAGE("outside " << counts.outside << ", by a separating plane alone " << counts.separated << ", partial "
                       << counts.partial << ", inside " << counts.inside);
    CHECK(counts.separated > 100);
    CHECK(counts.partial > 1000);
}

TEST_CASE("a box that touches an edge of the pyramid at one point is not outside") {
    // The apex in the origin, s = t = 0 exactly along the edge through P: rows P x A of integers have no rounding, but
    // the plane through that edge parallel to an axis has. Each box has P on an edge parallel to the axis, and nothing
    // beyond the plane.
    Random random(320);
    const auto integers = [&](int most) {
        return glm::dvec3(random.integer(-most, most), random.integer(-most, most), random.integer(-most, most));
    };
    const auto cross = [](const glm::dvec3& a, const glm::dvec3& b) {
        return glm::dvec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    };
    int touching = 0;
    for (int i = 0; i < 3000; ++i) {
        const glm::dvec3 p = integers(1 << 20), of_s = cross(p, integers(1 << 30)), of_t = cross(p, integers(1 << 30));
        glm::dvec3 of_q = integers(1 << 30);
        if (of_q.x * p.x + of_q.y * p.y + of_q.z * p.z < 0.0) of_q = -of_q;
        glm::dmat4 matrix(0.0);
        for (int j = 0; j < 3; ++j) matrix[j] = {of_s[j], of_t[j], 0.0, of_q[j]};
        REQUIRE(support::exactly_at(matrix, glm::vec3(p)).s.sign() == 0);
        REQUIRE(support::exactly_at(matrix, glm::vec3(p)).t.sign() == 0);
        for (int axis = 0; axis < 3; ++axis) {
            if (!(of_s[axis] * of_t[axis] < 0.0)) continue;
            Box box{glm::vec3(p), glm::vec3(p)};
            for (int j = 0; j < 3; ++j) {
                const float length = random.uniform_float(1.0, 1e6);
                const double form = std::fabs(of_t[axis]) * of_s[j] + std::fabs(of_s[axis]) * of_t[j];
                if (j == axis || form > 0.0) box.min[j] -= length;
                if (j == axis || form < 0.0) box.max[j] += length;
            }
            ++touching;
            REQUIRE_MESSAGE(coverage(WorldTexgen(matrix), whole_texture(), box) != Coverage::outside,
                            hex(matrix) << " " << hex(box));
        }
    }
    CHECK(touching > 2000);
}

TEST_CASE("of the boxes of random scenes less than 3 % are partial that could be outside, whatever sides there are") {
    Random random(42);
    Counts counts;
    long tested = 0;
    for (int scene = 0; scene < 320; ++scene) {
        const double distance = scene % 4 == 0 ? 1e5 : 0.0;
        Slide slide = ordinary_slide(random, distance);
        if (scene % 2 == 1) slide.region = without_some_sides(slide.region, random);
        const Judge judge(slide.matrix, slide.region);
        const LitVolume<texgen::World> volume(WorldTexgen(slide.matrix), slide.region);
        const glm::dvec3 apex = point_on(slide, 3, random, glm::dvec3(0.0));
        const glm::dvec3 centre = distance > 0.0 ? apex : glm::dvec3(0.0);
        std::vector<Box> boxes;
        for (int i = 0; i < 300; ++i) {
            const double size = random.power_of_ten(-1.0, 1.5);
            const glm::dvec3 middle = centre + random.uniform(0.0, 40.0) * random.direction();
            const glm::dvec3 half(size * random.uniform(0.1, 1.0), size * random.uniform(0.1, 1.0),
                                  size * random.uniform(0.1, 1.0));
            boxes.push_back({glm::vec3(middle - half), glm::vec3(middle + half)});
        }
        std::vector<Coverage> answers(boxes.size());
        volume.coverage(boxes, answers);
        tested += static_cast<long>(boxes.size());
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const std::string wrong = what_is_wrong(answers[i], judge, true, boxes[i], counts, true);
            REQUIRE_MESSAGE(wrong.empty(), wrong << ": " << hex(slide) << ", " << hex(boxes[i]));
        }
    }
    MESSAGE("of " << tested << ": outside " << counts.outside << " (by a separating plane alone " << counts.separated
                  << "), partial " << counts.partial << " (falsely " << counts.false_partial << "), inside "
                  << counts.inside);
    CHECK(counts.partial > tested / 20);
    CHECK(counts.inside > tested / 50);
    CHECK(counts.separated > tested / 200);
    CHECK(counts.false_partial * 100 < tested * 3);
    // The theorem of separating axes leaves none but what rounding does.
    CHECK(counts.false_partial * 1000 < tested);
}

TEST_CASE("where sides are none a box is partial only if no plane leaves it out") {
    Random random(4714);
    Counts counts;
    const auto integer = [&](int most) { return static_cast<double>(random.integer(-most, most)); };
    for (int i = 0; i < 40000; ++i) {
        Slide slide{glm::dmat4(0.0), whole_texture()};
        for (glm::length_t j = 0; j < 4; ++j) slide.matrix[j] = {integer(3), integer(3), 0.0, integer(3)};
        const auto row = [&](glm::length_t k) {
            return glm::dvec3(slide.matrix[0][k], slide.matrix[1][k], slide.matrix[2][k]);
        };
        if (glm::determinant(glm::dmat3(row(0), row(1), row(3))) == 0.0) continue;  // there need be no pyramid
        slide.region = without_some_sides(slide.region, random);
        const glm::vec3 middle(integer(3), integer(3), integer(3));
        const Box box{middle - glm::vec3(1.0f), middle + glm::vec3(1.0f)};
        const Coverage answer = coverage(WorldTexgen(slide.matrix), slide.region, box);
        const Judge judge(slide.matrix, slide.region);
        const std::string wrong = what_is_wrong(answer, judge, true, box, counts);
        REQUIRE_MESSAGE(wrong.empty(), wrong << ": " << hex(slide) << ", " << hex(box));
        // Most that touch a plane, of these integers, touch it exactly.
        const Box around{box.min - glm::vec3(0x1p-10f), box.max + glm::vec3(0x1p-10f)};
        if (answer == Coverage::partial) REQUIRE_MESSAGE(!judge.is_outside(around), hex(slide) << ", " << hex(box));
    }
    MESSAGE("outside " << counts.outside << " (by a separating plane alone " << counts.separated << "), partial "
                       << counts.partial << ", inside " << counts.inside);
    CHECK(counts.separated > 500);
}

}  // namespace coverage_cases
