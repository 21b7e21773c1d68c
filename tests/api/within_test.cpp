// Positions::within(): the caller's word on a batch changes no promise; a word that is none changes nothing, and one
// that is broken is asserted.

#include "support/broken_preconditions.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/verdict.hpp"
#include "support/doubtful.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::broken_preconditions;
using support::Cloud;
using support::everywhere;
using support::infinity_float;
using support::nan_float;
using support::Outputs;
using support::Random;
using texgen::Box;
using texgen::Positions;
using texgen::Tolerance;
using texgen::World;

// The smallest box, of the points that are numbers.
Box box_of(const std::vector<glm::vec3>& points) {
    Box box{glm::vec3(infinity_float), glm::vec3(-infinity_float)};
    for (const glm::vec3& point : points)
        for (int k = 0; k < 3; ++k) {
            if (std::isnan(point[k])) continue;
            box.min[k] = std::min(box.min[k], point[k]);
            box.max[k] = std::max(box.max[k], point[k]);
        }
    return box;
}

// The points in each layout, their floats kept.
struct Layouts {
    std::vector<glm::vec3> triples;
    std::vector<float> x, y, z, strided;

    explicit Layouts(const std::vector<glm::vec3>& points) : triples(points) {
        for (const glm::vec3& point : points) {
            x.push_back(point.x);
            y.push_back(point.y);
            z.push_back(point.z);
            for (int k = 0; k < 4; ++k) strided.push_back(k < 3 ? point[k] : -7.0f);
        }
    }
    Positions<World> operator[](int i) const {
        if (i == 0) return texgen::world_space(triples);
        if (i == 1) return texgen::world_space(x, y, z);
        return texgen::world_space(strided.data(), triples.size(), 4 * sizeof(float));
    }
};

bool same(const Outputs& a, const Outputs& b) {
    bool all = true;
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t i = 0; i < a.size(); ++i)
            all = all && (support::same_bits(a[k][i], b[k][i]) || (std::isnan(a[k][i]) && std::isnan(b[k][i])));
    return all;
}

// A projector, and points in a box that it sees the more obliquely the nearer q = 0 comes to a corner; the corners are
// points.
Cloud seen(Random& random, std::size_t count) {
    const glm::dvec3 target = 2.0 * random.direction();
    const double distance = random.power_of_ten(-0.3, 1.5);
    const glm::dvec3 position = target + distance * random.direction();
    const auto aim = texgen::Aim{position, target, random.direction()};
    const double half = random.power_of_ten(-1.0, 1.0);
    const texgen::PerspectiveLens open{texgen::degrees(random.uniform(10.0, 120.0)), 1.0, 0.01, 100.0};
    const texgen::OrthographicLens lens{-half, half, -half, half, 0.1, 100.0};
    const auto projector = random.integer(0, 3) != 0 ? make_projector(open, aim, texgen::opengl)
                                                     : make_projector(lens, aim, texgen::opengl);
    Cloud cloud{"seen", texture_from_world(projector.value()).matrix(), {}};
    const glm::vec3 middle(target), size(support::to_float(random.power_of_ten(-2.0, 1.0)));
    for (std::size_t i = 0; i < count; ++i) {
        glm::vec3 corner;
        for (int k = 0; k < 3; ++k) corner[k] = (i >> k & 1u) != 0u ? 1.0f : -1.0f;
        cloud.points.push_back(middle + size * (i < 8 ? corner : random.vector3(1.0)));
    }
    return cloud;
}

// In front, no coordinate changing its sign, each at one point as close to a middle of two floats as doubles let it be,
// by sums whose terms cancel.
Cloud next_to_ties(Random& random, std::size_t count) {
    Cloud cloud{"next to ties", glm::dmat4(0.0), {}};
    for (std::size_t i = 0; i < count; ++i) cloud.points.push_back(1.5f + 0x1p-8f * random.vector3(1.0));
    for (int row = 0; row < 4; ++row)
        for (int j = 0; j < 3; ++j) cloud.matrix[j][row] = random.uniform(-100.0, 100.0);
    cloud.matrix[3][3] = 5.0 - (cloud.matrix * glm::dvec4(1.5))[3];
    for (int row = 0; row < 2; ++row) {
        const auto one = static_cast<std::size_t>(random.integer(0, static_cast<int>(count) - 1));
        const glm::dvec4 point(cloud.points[one], 1.0);
        const double middle = static_cast<double>(support::to_float(random.uniform(4.0, 7.0))) + 0x1p-22;
        cloud.matrix[3][row] += middle * (cloud.matrix * point)[3] - (cloud.matrix * point)[row];
    }
    return cloud;
}

Box grown(const Box& box, double by) {
    const glm::vec3 margin = support::to_float(by) * (box.max - box.min);
    return {box.min - margin, box.max + margin};
}

}  // namespace

TEST_CASE("within a box every point is what it must be, at every tolerance, in every layout, whatever is asked for") {
    Random random(8100);
    int lit = 0, dark = 0, behind = 0;
    for (int round = 0; round < 900; ++round) {
        const std::size_t count =
            static_cast<std::size_t>(random.coin() ? random.integer(1, 40) : random.integer(200, 700));
        const Cloud cloud = seen(random, count);
        const texgen::WorldTexgen texgen(cloud.matrix);
        const Box box = grown(box_of(cloud.points), round % 3 == 0 ? 0.0 : random.power_of_ten(-2.0, 1.0));
        const Tolerance tolerance{round % 4 == 0 ? 0.0 : std::ldexp(1.0, random.integer(-26, -3))};
        const support::Homogeneous middle = support::exactly_at(cloud.matrix, cloud.points[count / 2]);
        const texgen::TextureRegion region =
            middle.q.sign() > 0 ? support::region_about(middle, random) : texgen::whole_texture();
        Outputs out(count, random.coin() ? Outputs::all : static_cast<unsigned>(random.integer(1, 15)));
        const Layouts layouts(cloud.points);
        project(texgen, layouts[round % 3].within(box), region, out.spans(), tolerance);
        REQUIRE(out.pads_are_intact());
        for (std::size_t i = 0; i < count; ++i) {
            const support::Homogeneous at = support::exactly_at(cloud.matrix, cloud.points[i]);
            const std::string wrong = what_is_wrong(at, region, tolerance, out, i);
            REQUIRE_MESSAGE(wrong.empty(), wrong, " at ", support::hex(cloud.points[i]), " by ",
                            support::hex(cloud.matrix), ", tolerance ", tolerance.value);
            behind += at.q.sign() <= 0;
            if (out.asked(3)) ++(out.lit()[i] == 1.0f ? lit : dark);
        }
    }
    CHECK(broken_preconditions == 0);
    CHECK(lit > 20000);
    CHECK(dark > 20000);
    CHECK(behind > 5000);
}

TEST_CASE("a tolerance below what is lost of subnormal coefficients is kept within a box") {
    Random random(8150);
    for (int round = 0; round < 200; ++round) {
        glm::dmat4 matrix(0.0);
        for (int row = 0; row < 2; ++row)
            for (int j = 0; j < 3; ++j)
                matrix[j][row] = std::ldexp(random.uniform(1.0, 2.0), random.integer(-140, -128));
        matrix[3][3] = 1.0;
        std::vector<glm::vec3> points;
        for (int i = 0; i < 64; ++i) points.push_back(glm::vec3(768.0f) + random.vector3(256.0));
        const Tolerance tolerance{std::ldexp(1.0, random.integer(-150, -130))};
        Outputs out(points.size(), 3u);
        project(texgen::WorldTexgen(matrix), texgen::world_space(points).within(box_of(points)), everywhere(),
                out.spans(), tolerance);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const std::string wrong =
                what_is_wrong(support::exactly_at(matrix, points[i]), everywhere(), tolerance, out, i);
            REQUIRE_MESSAGE(wrong.empty(), wrong, " at ", support::hex(points[i]), " by ", support::hex(matrix),
                            ", tolerance ", support::hex(tolerance.value));
        }
    }
}

TEST_CASE("a box changes no bit of the nearest floats, pairs and points in doubt neither") {
    Random random(8200);
    for (const std::size_t count : {std::size_t{1}, std::size_t{16}, std::size_t{100}, std::size_t{333}}) {
        std::vector<Cloud> clouds = support::doubtful_clouds(count, random);
        for (int i = 0; i < 20; ++i) clouds.push_back(seen(random, count));
        for (int i = 0; i < 200; ++i) clouds.push_back(next_to_ties(random, count));
        for (const Cloud& cloud : clouds) {
            const texgen::WorldTexgen texgen(cloud.matrix);
            const Box box = box_of(cloud.points);
            const Layouts layouts(cloud.points);
            for (int layout = 0; layout < 3; ++layout) {
                Outputs with(count), without(count);
                project(texgen, layouts[layout].within(box), everywhere(), with.spans());
                project(texgen, layouts[layout], everywhere(), without.spans());
                REQUIRE_MESSAGE(same(with, without), cloud.name);
                std::vector<glm::vec2> pairs(count);
                project(texgen, layouts[layout].within(box), pairs);
                for (std::size_t i = 0; i < count; ++i) {
                    const bool is_same = pairs[i] == glm::vec2(without.s()[i], without.t()[i]);
                    REQUIRE_MESSAGE((is_same || std::isnan(pairs[i].x) || std::isnan(pairs[i].y)), cloud.name);
                }
            }
        }
    }
    broken_preconditions = 0;  // some of the points are NaN
}

TEST_CASE("an invalid box is no word: all is as if it had not been given") {
    Random random(8300);
    const Cloud cloud = seen(random, 300);
    const texgen::WorldTexgen texgen(cloud.matrix);
    const Positions<World> positions = texgen::world_space(cloud.points);
    for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < 4; ++i) {
            Box box{glm::vec3(-100.0f), glm::vec3(100.0f)};
            (i < 2 ? box.min : box.max)[k] = i % 2 == 0 ? nan_float : (i < 2 ? 101.0f : -101.0f);
            for (const double tolerance : {0.0, 0x1p-20, 0x1p-10}) {
                Outputs with(300), without(300);
                project(texgen, positions.within(box), everywhere(), with.spans(), Tolerance{tolerance});
                project(texgen, positions, everywhere(), without.spans(), Tolerance{tolerance});
                REQUIRE(same(with, without));
            }
        }
    }
    CHECK(broken_preconditions == 0);
}

TEST_CASE("a box of which nothing is certain leaves the certificates to the blocks") {
    Random random(8400);
    const Cloud cloud = seen(random, 300);
    const float largest = std::numeric_limits<float>::max();
    for (const Box& box : {Box{glm::vec3(-infinity_float), glm::vec3(infinity_float)},
                           Box{glm::vec3(-largest), glm::vec3(largest)}, Box{glm::vec3(-1e6f), glm::vec3(1e6f)}}) {
        for (const double tolerance : {0.0, 0x1p-20, 0x1p-10}) {
            Outputs out(300);
            project(texgen::WorldTexgen(cloud.matrix), texgen::world_space(cloud.points).within(box), everywhere(),
                    out.spans(), Tolerance{tolerance});
            for (std::size_t i = 0; i < 300; ++i) {
                const support::Homogeneous at = support::exactly_at(cloud.matrix, cloud.points[i]);
                REQUIRE(what_is_wrong(at, everywhere(), Tolerance{tolerance}, out, i).empty());
            }
        }
    }
    // A coefficient that no float holds, of a coordinate that is 0 everywhere.
    glm::dmat4 matrix(1.0);
    matrix[2][0] = 1e60;
    Outputs out(1);
    const glm::vec3 point(0.25f, 0.5f, 0.0f);
    project(texgen::WorldTexgen(matrix), texgen::world_space(std::span(&point, 1)).within({point, point}), everywhere(),
            out.spans(), Tolerance{0x1p-10});
    CHECK(out.s()[0] == 0.25f);
    CHECK(broken_preconditions == 0);
}

TEST_CASE("a point outside of its box is asserted, and without assertions spoils no other") {
    Random random(8500);
    constexpr std::size_t count = 333;
    for (int round = 0; round < 60; ++round) {
        const Cloud cloud = seen(random, count);
        const texgen::WorldTexgen texgen(cloud.matrix);
        const Box box = box_of(cloud.points);
        const Tolerance tolerance{round % 2 == 0 ? 0.0 : 0x1p-10};
        for (const float bad : {nan_float, infinity_float, 1e30f}) {
            std::vector<glm::vec3> points = cloud.points;
            const auto at = static_cast<std::size_t>(random.integer(0, count - 1));
            points[at][random.integer(0, 2)] = bad;
            const Layouts layouts(points), whole(cloud.points);
            Outputs spoilt(count), sound(count);
            broken_preconditions = 0;
            project(texgen, layouts[round % 3].within(box), everywhere(), spoilt.spans(), tolerance);
            CHECK(broken_preconditions == 1);
            project(texgen, whole[round % 3].within(box), everywhere(), sound.spans(), tolerance);
            CHECK(broken_preconditions == 1);
            REQUIRE(spoilt.pads_are_intact());
            for (std::size_t i = 0; i < count; ++i) {
                if (i == at) {
                    if (std::isnan(bad)) REQUIRE(spoilt.lit()[i] == 0.0f);
                    continue;
                }
                const support::Homogeneous exact = support::exactly_at(cloud.matrix, points[i]);
                REQUIRE(what_is_wrong(exact, everywhere(), tolerance, spoilt, i).empty());
                if (tolerance.value == 0.0)
                    for (std::size_t k = 0; k < 4; ++k) REQUIRE(support::same_bits(spoilt[k][i], sound[k][i]));
            }
        }
    }
    broken_preconditions = 0;
}

TEST_CASE("a point on a side of its box is inside, and the next float is not, wherever it stands") {
    const Box box{{-1.0f, 0.0f, 1.0f}, {1.0f, 2.0f, 1.5f}};
    for (std::size_t count = 1; count < 14; ++count) {
        for (std::size_t i = 0; i < count; ++i) {
            for (int axis = 0; axis < 3; ++axis) {
                std::vector<glm::vec3> points(count, {0.5f, 0.5f, 1.25f});
                const auto layouts_asserted = [&](float value) {
                    points[i][axis] = value;
                    const Layouts layouts(points);
                    broken_preconditions = 0;
                    for (int layout = 0; layout < 3; ++layout) static_cast<void>(layouts[layout].within(box));
                    return broken_preconditions;
                };
                INFO("point ", i, " of ", count, ", axis ", axis);
                REQUIRE(layouts_asserted(box.min[axis]) == 0);
                REQUIRE(layouts_asserted(box.max[axis]) == 0);
                REQUIRE(layouts_asserted(std::nextafter(box.min[axis], -9.0f)) == 3);
                REQUIRE(layouts_asserted(std::nextafter(box.max[axis], 9.0f)) == 3);
            }
        }
    }
    broken_preconditions = 0;
}

TEST_CASE("a view keeps its box, and has none before") {
    const glm::vec3 point(0.5f);
    const Positions<World> positions = texgen::world_space(std::span(&point, 1));
    CHECK(positions.bounds().min.x > positions.bounds().max.x);
    const Box box{glm::vec3(0.0f), glm::vec3(1.0f)};
    CHECK(positions.within(box).bounds().min == box.min);
    CHECK(positions.within(box).bounds().max == box.max);
    CHECK(positions.within(box).size() == 1);
    CHECK(positions.within(box)[0] == point);
}
