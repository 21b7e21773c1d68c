// Texture coordinates of points: generate() within its stated accuracy, project() the nearest float or within the
// tolerance, from positions laid out in every way.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "api/texcoord_test/point_families.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/verdict.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "texgen/texcoord.hpp"

namespace texcoord_cases {

using support::everywhere;
using support::exactly_at;
using support::Outputs;
using support::same_bits;

namespace {

texgen::TextureRegion any_region(const Batch& batch, Random& random) {
    const Homogeneous at = exactly_at(batch.matrix, batch.points[batch.points.size() / 2]);
    if (at.q.sign() <= 0 || random.integer(0, 3) == 0)
        return random.coin() ? everywhere() : texgen::atlas_tile({0.1, 0.2}, {0.7, 0.9});
    return support::region_about(at, random);
}

struct Tally {
    int in_front = 0, behind = 0, on_plane = 0, lit = 0, dark = 0, subnormal = 0, infinite = 0;
};

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

}  // namespace texcoord_cases
