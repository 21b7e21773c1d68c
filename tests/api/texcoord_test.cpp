// Texture coordinates of points: generate() within its stated accuracy, project() the nearest float or within the
// tolerance, from positions laid out in every way.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/verdict.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::Dyadic;
using support::everywhere;
using support::exactly_at;
using support::hex;
using support::Homogeneous;
using support::infinity_float;
using support::nan_float;
using support::Outputs;
using support::Random;
using support::same_bits;
using texgen::Object;
using texgen::ObjectTexgen;
using texgen::Positions;
using texgen::Tolerance;

using Points = std::vector<glm::vec3>;

struct Batch {
    glm::dmat4 matrix;
    Points points;

    ObjectTexgen texgen() const { return ObjectTexgen(matrix); }
    Positions<Object> positions() const { return texgen::object_space(points); }
};

glm::dvec4 row(const glm::dmat4& m, int k) { return {m[0][k], m[1][k], m[2][k], m[3][k]}; }
void set_row(glm::dmat4& m, int k, const glm::dvec4& values) {
    for (int column = 0; column < 4; ++column) m[column][k] = values[column];
}

double dot(const glm::dvec4& r, const glm::vec3& v) {
    return r.x * static_cast<double>(v.x) + r.y * static_cast<double>(v.y) + r.z * static_cast<double>(v.z) + r.w;
}

// A slide projector somewhere near the origin, and points about it.
Batch slide(Random& random, std::size_t count) {
    const glm::dvec3 position = 5.0 * random.direction(), target = random.direction();
    const auto projector = texgen::make_projector(
        texgen::PerspectiveLens{
            .fovy = texgen::degrees(random.uniform(10.0, 100.0)), .aspect = 1.0, .z_near = 0.1, .z_far = 100.0},
        {.position = position, .target = target, .up = random.direction()}, texgen::opengl);
    Batch batch{texture_from_world(projector.value()).matrix(), Points(count)};
    for (glm::vec3& point : batch.points)
        point = random.coin() ? random.vector3(8.0) : glm::vec3(target) + random.vector3(1.0);
    return batch;
}

struct PointFamily {
    const char* name;
    Batch (*make)(Random&, std::size_t count);
    bool (*is_hard)(const Homogeneous&, const Batch&);
    double least_share;  // of the points that are hard
};

const std::array families{
    PointFamily{"a slide projector", slide, [](const Homogeneous&, const Batch&) { return true; }, 1.0},
    PointFamily{"rounded to float",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    batch.matrix = glm::dmat4(glm::mat4(batch.matrix));
                    return batch;
                },
                [](const Homogeneous& at, const Batch&) { return at.q.sign() > 0; }, 0.3},
    PointFamily{"far from the origin, where rows cancel",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    const double distance = random.power_of_ten(3.0, 8.0);
                    const glm::dvec3 far = distance * random.direction();
                    for (int k = 0; k < 4; ++k) {
                        glm::dvec4 r = row(batch.matrix, k);
                        r.w -= r.x * far.x + r.y * far.y + r.z * far.z;
                        set_row(batch.matrix, k, r);
                    }
                    for (glm::vec3& point : batch.points) point = glm::vec3(glm::dvec3(point) + far);
                    return batch;
                },
                [](const Homogeneous& at, const Batch& batch) {
                    return std::fabs(at.q.estimate()) < 0.1 * std::fabs(batch.matrix[3][3]);
                },
                0.6},
    PointFamily{"next to q = 0",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    // The last point is on the plane up to a unit of the double's last place; the others are its
                    // neighbours.
                    glm::dvec4 q = row(batch.matrix, 3);
                    q.w = 0.0;
                    const glm::vec3 on_plane = batch.points.empty() ? glm::vec3(1.0f) : batch.points.back();
                    q.w = -dot(q, on_plane);
                    for (int i = random.integer(-2, 2); i != 0; i += i < 0 ? 1 : -1)
                        q.w = std::nextafter(q.w, i < 0 ? -HUGE_VAL : HUGE_VAL);
                    set_row(batch.matrix, 3, q);
                    for (glm::vec3& point : batch.points) {
                        point = on_plane;
                        for (int k = 0; k < 3; ++k)
                            if (random.integer(0, 2) == 0)
                                point[k] = support::neighbour(point[k], random.integer(-1, 1));
                    }
                    return batch;
                },
                [](const Homogeneous& at, const Batch& batch) {
                    return std::fabs(at.q.estimate()) < 0x1p-18 * std::fabs(batch.matrix[3][3]);
                },
                0.9},
    PointFamily{"on q = 0 exactly, and beside it",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    const double scale = std::ldexp(1.0, random.integer(-40, 40));
                    const glm::ivec3 n{random.integer(-9, 9), random.integer(1, 9), random.integer(-9, 9)};
                    const int m = random.integer(-9, 9);
                    set_row(batch.matrix, 3, scale * glm::dvec4(n.x, n.y, n.z, -m * n.y));
                    for (glm::vec3& point : batch.points) {
                        const int i = random.integer(-999, 999), j = random.integer(-999, 999);
                        // n.x (i n.y) + n.y (m - i n.x - j n.z) + n.z (j n.y) = m n.y
                        point = glm::vec3(i * n.y, m - i * n.x - j * n.z, j * n.y);
                        if (random.integer(0, 3) == 0) point.y = support::neighbour(point.y, random.coin() ? 1 : -1);
                    }
                    return batch;
                },
                [](const Homogeneous& at, const Batch&) { return at.q.sign() == 0; }, 0.6},
    PointFamily{"scaled by 1e-30 to 1e30",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    const double scale = random.power_of_ten(-30.0, 30.0);
                    for (int k = 0; k < 4; ++k) set_row(batch.matrix, k, scale * row(batch.matrix, k));
                    const float unit = static_cast<float>(random.coin() ? 1.0 : random.power_of_ten(-30.0, 30.0));
                    for (glm::vec3& point : batch.points) point *= unit;
                    return batch;
                },
                [](const Homogeneous&, const Batch& batch) {
                    const double size = std::fabs(batch.matrix[3][3]);
                    return size > 1e8 || size < 1e-8;
                },
                0.5},
    PointFamily{"each row in its own unit",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    for (int k = 0; k < 4; ++k)
                        set_row(batch.matrix, k, random.power_of_ten(-25.0, 25.0) * row(batch.matrix, k));
                    return batch;
                },
                [](const Homogeneous& at, const Batch&) {
                    return at.q.sign() > 0 &&
                           !(std::fabs(at.over_q(0).estimate()) < 1e6 && std::fabs(at.over_q(0).estimate()) > 1e-6);
                },
                0.3},
    PointFamily{"q constant: an orthographic projector",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    set_row(batch.matrix, 3, {0.0, 0.0, 0.0, random.coin() ? 1.0 : random.uniform(-1.0, 3.0)});
                    return batch;
                },
                [](const Homogeneous& at, const Batch&) { return at.q.sign() > 0; }, 0.5},
    PointFamily{"between two floats",
                [](Random& random, std::size_t count) {
                    Batch batch{glm::dmat4(0.0), Points(count)};
                    const double power = std::ldexp(1.0, random.integer(-10, 10));
                    for (int k = 0; k < 3; ++k) set_row(batch.matrix, k, {power, power * 0x1p-24, 0.0, 0.0});
                    set_row(batch.matrix, 3, {0.0, 0.0, 0.0, std::ldexp(1.0, random.integer(-10, 10))});
                    for (glm::vec3& point : batch.points) {
                        point.x = random.uniform_float(1.0, 2.0);
                        point.y = static_cast<float>(random.integer(-1, 3));  // 1: a tie; the others are next to one
                    }
                    return batch;
                },
                [](const Homogeneous& at, const Batch&) { return is_tie(at.over_q(0)); }, 0.3},
    PointFamily{"subnormal results",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    const double small = random.power_of_ten(-45.0, -38.0);
                    for (int k = 0; k < 3; ++k) set_row(batch.matrix, k, small * row(batch.matrix, k));
                    return batch;
                },
                [](const Homogeneous& at, const Batch&) {
                    return at.q.sign() > 0 && std::fabs(at.over_q(0).estimate()) < 0x1p-126;
                },
                0.3},
    PointFamily{"results about the largest float",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    for (int k = 0; k < 3; ++k) set_row(batch.matrix, k, 3e38 * row(batch.matrix, k));
                    return batch;
                },
                [](const Homogeneous& at, const Batch&) {
                    return at.q.sign() > 0 && std::fabs(at.over_q(0).estimate()) > 0x1p127;
                },
                0.1},
    PointFamily{"random floats in the matrix and in the points",
                [](Random& random, std::size_t count) {
                    Batch batch{glm::dmat4(0.0), Points(count)};
                    const bool all_bits = random.coin();
                    const auto any = [&] { return all_bits ? random.any_finite() : random.uniform_float(-2.0, 2.0); };
                    for (int column = 0; column < 4; ++column)
                        for (int k = 0; k < 4; ++k) batch.matrix[column][k] = static_cast<double>(any());
                    for (glm::vec3& point : batch.points)
                        for (int k = 0; k < 3; ++k) point[k] = any();
                    return batch;
                },
                [](const Homogeneous& at, const Batch&) { return at.q.sign() > 0; }, 0.3},
};

texgen::TextureRegion any_region(const Batch& batch, Random& random) {
    const Homogeneous at = exactly_at(batch.matrix, batch.points[batch.points.size() / 2]);
    if (at.q.sign() <= 0 || random.integer(0, 3) == 0)
        return random.coin() ? everywhere() : texgen::atlas_tile({0.1, 0.2}, {0.7, 0.9});
    return support::region_about(at, random);
}

struct Tally {
    int in_front = 0, behind = 0, on_plane = 0, lit = 0, dark = 0, subnormal = 0, infinite = 0;
};

std::string describe(const Batch& batch, std::size_t i) { return hex(batch.points[i]) + " by " + hex(batch.matrix); }

void require_right(const Batch& batch, const texgen::TextureRegion& region, Tolerance tolerance, Outputs& out,
                   Tally& tally) {
    project(batch.texgen(), batch.positions(), region, out.spans(), tolerance);
    REQUIRE_MESSAGE(out.pads_are_intact(), hex(batch.matrix));
    for (std::size_t i = 0; i < batch.points.size(); ++i) {
        const Homogeneous at = exactly_at(batch.matrix, batch.points[i]);
        const std::string wrong = what_is_wrong(at, region, tolerance, out, i);
        REQUIRE_MESSAGE(wrong.empty(), wrong, " for ", describe(batch, i), ", tolerance ", hex(tolerance.value));
        ++(at.q.sign() > 0 ? tally.in_front : at.q.sign() < 0 ? tally.behind : tally.on_plane);
        if (out.asked(3)) ++(out.lit()[i] == 1.0f ? tally.lit : tally.dark);
        if (out.asked(0)) {
            tally.subnormal += std::fpclassify(out.s()[i]) == FP_SUBNORMAL;
            tally.infinite += std::isinf(out.s()[i]);
        }
    }
}

std::size_t any_count(Random& random) {
    return static_cast<std::size_t>(random.integer(0, 4) == 0 ? random.integer(120, 270) : random.integer(1, 67));
}

// |value - exact| <= 1/2 ulp + slack: the numbers that round to `value` come as near to `exact` as the slack.
bool rounds_from_within(float value, const Dyadic& exact, const Dyadic& slack) {
    const Dyadic low = support::detail::middle(value, false), high = support::detail::middle(value, true);
    return low <= exact + slack && exact - slack <= high;
}

}  // namespace

TEST_CASE("every projected point is the nearest float of the exact rational, in every family") {
    std::uint64_t seed = 6000;
    Tally tally;
    for (const PointFamily& family : families) {
        CAPTURE(std::string(family.name));
        Random random(++seed);
        double hard = 0.0, points = 0.0;
        for (int i = 0; i < 80; ++i) {
            const Batch batch = family.make(random, any_count(random));
            for (const glm::vec3& point : batch.points) {
                hard += family.is_hard(exactly_at(batch.matrix, point), batch);
                points += 1.0;
            }
            Outputs out(batch.points.size(), Outputs::all, static_cast<std::size_t>(i % 16));
            require_right(batch, any_region(batch, random), texgen::exact, out, tally);
        }
        CHECK(hard >= family.least_share * points);
    }
    CHECK(tally.in_front > 20000);
    CHECK(tally.behind > 5000);
    CHECK(tally.on_plane > 1000);
    CHECK(tally.lit > 5000);
    CHECK(tally.dark > 5000);
    CHECK(tally.subnormal > 500);
    CHECK(tally.infinite > 100);
}

TEST_CASE("no projected point has a larger error than was accepted, in every family at every tolerance") {
    std::uint64_t seed = 6100;
    Tally tally;
    for (const Tolerance tolerance :
         {texgen::texels(1.0 / 512.0, 4096.0), texgen::texels(1.0 / 16.0, 1024.0), texgen::texels(1.0, 256.0),
          Tolerance{0.1}, Tolerance{10.0}, Tolerance{1e300}, Tolerance{HUGE_VAL}}) {
        for (const PointFamily& family : families) {
            CAPTURE(std::string(family.name));
            Random random(++seed);
            for (int i = 0; i < 30; ++i) {
                const Batch batch = family.make(random, any_count(random));
                const unsigned asked = random.coin() ? Outputs::all : static_cast<unsigned>(random.integer(0, 15));
                Outputs out(batch.points.size(), asked, static_cast<std::size_t>(i % 16));
                require_right(batch, any_region(batch, random), tolerance, out, tally);
            }
        }
    }
    CHECK(tally.in_front > 40000);
    CHECK(tally.behind > 20000);
}

TEST_CASE("a tolerance of some units of the largest coordinate of the batch is kept, whatever the unit") {
    std::uint64_t seed = 6200;
    Tally tally;
    for (const PointFamily& family : families) {
        CAPTURE(std::string(family.name));
        Random random(++seed);
        for (int i = 0; i < 100; ++i) {
            const Batch batch = family.make(random, any_count(random));
            double largest = 0.0;
            for (const glm::vec3& point : batch.points) {
                const Homogeneous at = exactly_at(batch.matrix, point);
                if (at.q.sign() <= 0) continue;
                const double u = std::fabs(at.over_q(static_cast<std::size_t>(random.integer(0, 2))).estimate());
                largest = random.coin() ? std::max(largest, u) : u;
            }
            const double units = std::ldexp(random.uniform(1.0, 2.0), random.integer(-26, -10));
            Outputs out(batch.points.size(),
                        random.coin() ? Outputs::all : static_cast<unsigned>(random.integer(0, 15)));
            require_right(batch, any_region(batch, random), {largest * units}, out, tally);
        }
    }
    CHECK(tally.in_front > 20000);
}

TEST_CASE(
    "blocks of points on either side of the projector, or far from the origin, keep the tolerance and the sign of q") {
    Random random(6250);
    Tally tally;
    int in_float = 0, of_company = 0;
    for (int i = 0; i < 60; ++i) {
        // Neighbours, as a mesh has them, about a path that may cross q = 0; some far from all others.
        const auto count = static_cast<std::size_t>(random.integer(200, 2600));
        Batch batch = families[static_cast<std::size_t>(i % 4 == 0 ? 2 : 0)].make(random, count);
        const auto is_behind = [&](const glm::vec3& point) { return exactly_at(batch.matrix, point).q.sign() < 0; };
        const auto behind = std::find_if(batch.points.begin(), batch.points.end() - 1, is_behind);
        const glm::dvec3 begin(*behind), end(random.coin() ? batch.points[1] : *behind);
        const double width = random.power_of_ten(-3.0, 0.0);
        const int outliers = random.coin() ? random.integer(20, 400) : 0;
        for (std::size_t j = 0; j < count; ++j) {
            const double along = static_cast<double>(j) / static_cast<double>(count);
            batch.points[j] = glm::vec3(glm::mix(begin, end, along)) + random.vector3(width);
            if (outliers != 0 && random.integer(0, outliers) == 0) {
                batch.points[j] = random.vector3(random.power_of_ten(2.0, 30.0));
                ++of_company;
            }
        }
        const Tolerance tolerance{random.power_of_ten(-6.0, -2.0)};
        const unsigned asked = random.coin() ? Outputs::all : static_cast<unsigned>(random.integer(1, 15));
        Outputs out(count, asked, static_cast<std::size_t>(i % 16)), exact(count, asked);
        require_right(batch, any_region(batch, random), tolerance, out, tally);
        project(batch.texgen(), batch.positions(), everywhere(), exact.spans());
        for (std::size_t j = 0; j < count && out.asked(0); ++j) in_float += !same_bits(out.s()[j], exact.s()[j]);
    }
    CHECK(tally.in_front > 20000);
    CHECK(tally.behind > 20000);
    CHECK(in_float > 1000);
    CHECK(of_company > 100);
}

TEST_CASE("generated coordinates are within half a unit and 2^-50 of the sum of their terms") {
    std::uint64_t seed = 6300;
    int compared = 0, cancelling = 0;
    for (const PointFamily& family : families) {
        CAPTURE(std::string(family.name));
        Random random(++seed);
        for (int i = 0; i < 60; ++i) {
            const Batch batch = family.make(random, any_count(random));
            const std::size_t count = batch.points.size();
            const auto asked = static_cast<unsigned>(random.integer(0, 15));
            Outputs planar(count, asked, static_cast<std::size_t>(i % 16));
            std::vector<glm::vec4> interleaved(count + 2, glm::vec4(-7.0f));
            generate(batch.texgen(), batch.positions(), std::span(interleaved).subspan(1, count));
            const texgen::Texcoords spans = planar.spans();
            generate(batch.texgen(), batch.positions(),
                     texgen::HomogeneousTexcoords{.s = spans.s, .t = spans.t, .r = spans.r, .q = spans.lit});
            REQUIRE(planar.pads_are_intact());
            REQUIRE(interleaved.front() == glm::vec4(-7.0f));
            REQUIRE(interleaved.back() == glm::vec4(-7.0f));
            for (std::size_t j = 0; j < count; ++j) {
                const glm::vec3& v = batch.points[j];
                const Homogeneous at = exactly_at(batch.matrix, v);
                const std::array exact{at.s, at.t, at.r, at.q};
                for (int k = 0; k < 4; ++k) {
                    const glm::dvec4 r = row(batch.matrix, k);
                    const Dyadic terms = magnitude(Dyadic(r.x) * Dyadic(v.x)) + magnitude(Dyadic(r.y) * Dyadic(v.y)) +
                                         magnitude(Dyadic(r.z) * Dyadic(v.z)) + magnitude(Dyadic(r.w));
                    const Dyadic slack = terms * Dyadic(texgen::generate_error);
                    const Dyadic& x = exact[static_cast<std::size_t>(k)];
                    if (!(magnitude(x) + slack < Dyadic(0x1.ffffffp127))) continue;
                    ++compared;
                    cancelling += magnitude(x) < slack * Dyadic(0x1p20);
                    REQUIRE_MESSAGE(rounds_from_within(interleaved[j + 1][k], x, slack), describe(batch, j));
                    if (planar.asked(static_cast<std::size_t>(k)))
                        REQUIRE_MESSAGE(rounds_from_within(planar[static_cast<std::size_t>(k)][j], x, slack),
                                        describe(batch, j));
                }
            }
        }
    }
    CHECK(compared > 50000);
    CHECK(cancelling > 1000);
}

TEST_CASE("pairs are the planar s and t, and 0 behind") {
    Random random(6400);
    for (const PointFamily& family : families) {
        for (std::size_t count = 0; count < 70; ++count) {
            const Batch batch = family.make(random, count);
            Outputs planar(count);
            project(batch.texgen(), batch.positions(), texgen::whole_texture(), planar.spans());
            std::vector<glm::vec2> pairs(count + 2, glm::vec2(-7.0f));
            project(batch.texgen(), batch.positions(), std::span(pairs).subspan(1, count));
            REQUIRE(pairs.front() == glm::vec2(-7.0f));
            REQUIRE(pairs.back() == glm::vec2(-7.0f));
            for (std::size_t i = 0; i < count; ++i) {
                REQUIRE_MESSAGE(same_bits(pairs[i + 1].x, planar.s()[i]), describe(batch, i));
                REQUIRE_MESSAGE(same_bits(pairs[i + 1].y, planar.t()[i]), describe(batch, i));
            }
            const Tolerance tolerance{random.power_of_ten(-7.0, 1.0)};
            project(batch.texgen(), batch.positions(), std::span(pairs).subspan(1, count), tolerance);
            REQUIRE(pairs.front() == glm::vec2(-7.0f));
            REQUIRE(pairs.back() == glm::vec2(-7.0f));
            for (std::size_t i = 0; i < count; ++i) {
                const Homogeneous at = exactly_at(batch.matrix, batch.points[i]);
                for (int k = 0; k < 2; ++k) {
                    const float value = pairs[i + 1][k];
                    const auto coordinate = static_cast<std::size_t>(k);
                    REQUIRE_MESSAGE(
                        (at.q.sign() > 0 ? keeps(value, at.over_q(coordinate), coordinate, tolerance) : value == 0.0f),
                        describe(batch, i), ", tolerance ", hex(tolerance.value));
                }
            }
        }
    }
}

TEST_CASE("a point's bits do not depend on how the positions are laid out, nor on its place, nor on the outputs") {
    Random random(6500);
    std::vector<std::size_t> counts;
    for (std::size_t count = 0; count <= 67; ++count) counts.push_back(count);
    for (std::size_t count = 125; count <= 131; ++count) counts.push_back(count);
    for (std::size_t count = 253; count <= 260; ++count) counts.push_back(count);
    for (const std::size_t count : counts) {
        const PointFamily& family = families[static_cast<std::size_t>(random.integer(0, 11))];
        Batch batch = family.make(random, count);
        const bool sliding = random.coin();  // planar arrays that share memory, as a stride of one float has them
        std::vector<float> line(count + 2);
        if (sliding) {
            for (float& value : line) value = random.uniform_float(-3.0, 3.0);
            for (std::size_t i = 0; i < count; ++i) batch.points[i] = {line[i], line[i + 1], line[i + 2]};
        }
        const texgen::TextureRegion sides = texgen::atlas_tile({0.1, 0.1}, {0.7, 0.9});
        const texgen::TextureRegion region = random.coin() ? sides : sides.with_depth(0.1, 0.95);

        // One by one.
        Outputs expected(count);
        std::vector<glm::vec4> expected_strq(count);
        for (std::size_t i = 0; i < count; ++i) {
            const Positions<Object> one = texgen::object_space(std::span<const glm::vec3>(batch.points).subspan(i, 1));
            const texgen::Texcoords all = expected.spans();
            project(batch.texgen(), one, region,
                    {.s = all.s.subspan(i, 1),
                     .t = all.t.subspan(i, 1),
                     .r = all.r.subspan(i, 1),
                     .lit = all.lit.subspan(i, 1)});
            generate(batch.texgen(), one, std::span(expected_strq).subspan(i, 1));
        }

        const auto require_same = [&](const Positions<Object>& positions) {
            REQUIRE(positions.size() == count);
            const auto asked = static_cast<unsigned>(random.integer(0, 15));
            Outputs out(count, asked, static_cast<std::size_t>(random.integer(0, 16)));
            project(batch.texgen(), positions, region, out.spans());
            REQUIRE(out.pads_are_intact());
            for (std::size_t k = 0; k < 4; ++k)
                if (out.asked(k)) REQUIRE_MESSAGE(same_bits(out[k], expected[k]), family.name, hex(batch.matrix));
            std::vector<glm::vec4> strq(count);
            generate(batch.texgen(), positions, strq);
            for (std::size_t i = 0; i < count; ++i) {
                REQUIRE(positions[i] == batch.points[i]);
                for (int k = 0; k < 4; ++k)
                    REQUIRE_MESSAGE(same_bits(strq[i][k], expected_strq[i][k]), describe(batch, i));
            }
        };

        require_same(batch.positions());
        for (const std::size_t shift : {0u, 1u, 7u}) {
            std::array<std::vector<float>, 3> planar;
            for (std::size_t k = 0; k < 3; ++k) {
                planar[k].assign(count + shift + k, nan_float);
                for (std::size_t i = 0; i < count; ++i) planar[k][shift + k + i] = batch.points[i][static_cast<int>(k)];
            }
            const auto part = [&](std::size_t k) { return std::span<const float>(planar[k]).subspan(shift + k); };
            require_same(texgen::object_space(part(0), part(1), part(2)));
        }
        if (sliding) {
            const std::span<const float> x(line);
            require_same(texgen::object_space(x.subspan(0, count), x.subspan(1, count), x.subspan(2, count)));
            require_same(texgen::object_space(line.data(), count, sizeof(float)));
        }
        for (const std::size_t stride : {12u, 13u, 15u, 16u, 17u, 20u, 24u, 31u, 32u, 36u, 64u, 100u}) {
            const auto misalignment = static_cast<std::size_t>(random.integer(0, 7));
            // Nothing beyond the last point may be read: the allocation ends there.
            std::vector<std::byte> bytes(count == 0 ? 0 : misalignment + (count - 1) * stride + sizeof(glm::vec3),
                                         std::byte{0xff});
            for (std::size_t i = 0; i < count; ++i)
                std::memcpy(bytes.data() + misalignment + i * stride, &batch.points[i], sizeof(glm::vec3));
            const auto* first = count == 0 ? nullptr : reinterpret_cast<const float*>(bytes.data() + misalignment);
            require_same(texgen::object_space(first, count, stride));
        }
        if (count == 0) continue;
        const glm::vec3 point = batch.points[0];
        batch.points.assign(count, point);
        for (std::size_t i = 0; i < count; ++i) {
            const texgen::Texcoords all = expected.spans();
            for (const std::span<float> output : {all.s, all.t, all.r, all.lit}) output[i] = output[0];
            expected_strq[i] = expected_strq[0];
        }
        require_same(texgen::object_space(&point.x, count, 0));  // one point, as often as asked
    }
}

TEST_CASE("a quotient that is below all floats is a zero of its sign, in company as alone") {
    Random random(8);
    int negative = 0;
    for (int round = 0; round < 2000; ++round) {
        // Some are at the middle of two subnormal floats, or next to it.
        const double down = std::ldexp(1.0, random.integer(-240, -140));
        const glm::dmat4 matrix = glm::transpose(
            glm::dmat4(down, 0.0, 0.0, 0.0, 0.0, down, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0));
        std::vector<glm::vec3> points(static_cast<std::size_t>(random.integer(1, 40)));
        for (glm::vec3& point : points)
            for (glm::length_t k = 0; k < 3; ++k) {
                const double middle = (2 * random.integer(-9, 9) + 1) * 0x1p-150 / down;
                const bool is_middle = std::fabs(middle) < 0x1p100 && random.coin();
                point[k] = is_middle ? support::to_float(middle) : random.uniform_float(-2.0, 2.0);
            }
        Outputs out(points.size(), 3u);
        project(ObjectTexgen(matrix), texgen::object_space(points), everywhere(), out.spans());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto alone = project(ObjectTexgen(matrix), texgen::object_space(points[i]));
            REQUIRE(alone);
            for (std::size_t k = 0; k < 2; ++k) {
                const float of_alone = (*alone)[static_cast<glm::length_t>(k)];
                negative += out[k][i] == 0.0f && std::signbit(out[k][i]) ? 1 : 0;
                CHECK_MESSAGE(same_bits(out[k][i], of_alone), hex(points[i]), " by ", hex(matrix), ": ", hex(out[k][i]),
                              ", alone ", hex(of_alone));
            }
        }
    }
    CHECK(negative > 1000);
}

TEST_CASE("the four spaces give the same numbers") {
    Random random(6600);
    const Batch batch = slide(random, 50);
    std::array<Outputs, 4> out{Outputs(50), Outputs(50), Outputs(50), Outputs(50)};
    project(ObjectTexgen(batch.matrix), texgen::object_space(batch.points), texgen::whole_texture(), out[0].spans());
    project(texgen::WorldTexgen(batch.matrix), texgen::world_space(batch.points), texgen::whole_texture(),
            out[1].spans());
    project(texgen::EyeTexgen(batch.matrix), texgen::eye_space(batch.points), texgen::whole_texture(), out[2].spans());
    project(texgen::WindowTexgen(batch.matrix), texgen::window_space(batch.points), texgen::whole_texture(),
            out[3].spans());
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t space = 1; space < 4; ++space) CHECK(same_bits(out[0][k], out[space][k]));
}

TEST_CASE("a NaN or an infinity in a position spoils its own point only") {
    Random random(6700);
    int spoilt = 0;
    for (const Tolerance tolerance : {texgen::exact, Tolerance{1e-4}, Tolerance{1.0}}) {
        for (const PointFamily& family : families) {
            for (int i = 0; i < 20; ++i) {
                const std::size_t count = any_count(random);
                Batch batch = family.make(random, count);
                std::vector<bool> bad(count);
                for (std::size_t j = 0; j < count; ++j) {
                    bad[j] = random.integer(0, 5) == 0;
                    const float values[] = {nan_float, -nan_float, infinity_float, -infinity_float};
                    if (bad[j]) batch.points[j][random.integer(0, 2)] = values[random.integer(0, 3)];
                    spoilt += bad[j];
                }
                Outputs out(count);
                project(batch.texgen(), batch.positions(), texgen::whole_texture(), out.spans(), tolerance);
                std::vector<glm::vec4> strq(count);
                generate(batch.texgen(), batch.positions(), strq);
                for (std::size_t j = 0; j < count; ++j) {
                    if (bad[j]) {
                        REQUIRE_MESSAGE(out.lit()[j] == 0.0f, describe(batch, j));
                        for (std::size_t k = 0; k < 3; ++k)
                            if (std::isnan(batch.points[j].x + batch.points[j].y + batch.points[j].z))
                                REQUIRE_MESSAGE(out[k][j] == 0.0f, describe(batch, j));
                        continue;
                    }
                    const Homogeneous at = exactly_at(batch.matrix, batch.points[j]);
                    const std::string wrong = what_is_wrong(at, texgen::whole_texture(), tolerance, out, j);
                    REQUIRE_MESSAGE(wrong.empty(), wrong, " for ", describe(batch, j), ", tolerance ",
                                    hex(tolerance.value));
                    if (std::fabs(at.q.estimate()) < 1e38)
                        REQUIRE_MESSAGE(std::isfinite(strq[j].w), describe(batch, j));
                }
            }
        }
    }
    CHECK(spoilt > 5000);
}

TEST_CASE("matrices and points of random bits write nothing but their outputs") {
    Random random(6800);
    for (int i = 0; i < 4000; ++i) {
        Batch batch{glm::dmat4(0.0), Points(static_cast<std::size_t>(random.integer(0, 40)))};
        for (int column = 0; column < 4; ++column)
            for (int k = 0; k < 4; ++k) batch.matrix[column][k] = std::bit_cast<double>(random.bits());
        for (glm::vec3& point : batch.points)
            for (int k = 0; k < 3; ++k) point[k] = random.any_float();
        const texgen::TextureRegion region =
            texgen::atlas_tile({random.any_float(), random.any_float()}, {random.any_float(), random.any_float()});
        Outputs out(batch.points.size());
        const Tolerance tolerance{random.coin() ? 0.0 : static_cast<double>(random.any_float())};
        project(batch.texgen(), batch.positions(), region, out.spans(), tolerance);
        REQUIRE(out.pads_are_intact());
        for (const float lit : out.lit()) REQUIRE_MESSAGE((lit == 0.0f || lit == 1.0f), hex(batch.matrix));
        std::vector<glm::vec2> pairs(batch.points.size());
        project(batch.texgen(), batch.positions(), std::span(pairs), tolerance);
        std::vector<glm::vec4> strq(batch.points.size());
        generate(batch.texgen(), batch.positions(), strq);
    }
}

TEST_CASE("divide is the nearest float in front, and empty behind") {
    Random random(6900);
    int in_front = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::vec4 strq{random.any_float(), random.any_float(), random.any_float(), random.any_float()};
        const std::optional<glm::vec2> st = texgen::divide(strq);
        REQUIRE_MESSAGE(st.has_value() == (strq.w > 0.0f), hex(strq));
        if (!st || !std::isfinite(strq.w)) continue;
        for (int k = 0; k < 2; ++k) {
            if (!std::isfinite(strq[k])) continue;
            ++in_front;
            REQUIRE_MESSAGE(support::is_nearest((*st)[k], {Dyadic(strq[k]), Dyadic(strq.w)}), hex(strq));
        }
    }
    CHECK(in_front > 10000);
}
