// A batch gives every fragment what a TriangleSetup of its triangle does.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/batch_test/drawn.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/verdict.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/triangles.hpp"
#include "texgen/batch.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/surface.hpp"

namespace batch_cases {

using texgen::TriangleBatch;

TEST_CASE("with exact, rectangles of a batch have the bits that each has alone, whatever is asked for") {
    Random random(1);
    int apart = 0, large = 0, overlapping = 0;  // tiles for a setup; beyond scratch; with vectors that overlap
    int zeros = 0;                              // along an edge
    for (int round = 0; round < 400; ++round) {
        const texgen::TextureRegion region = draw_region(random);
        TriangleBatch batch(region);
        for (int again = 0; again < 2; ++again) {
            const Drawn drawn(random, random.integer(0, 30));
            const auto asked = static_cast<unsigned>(random.coin() ? 15 : random.integer(0, 15));
            Outputs out(drawn.fragments, asked, static_cast<std::size_t>(random.integer(0, 7)));
            batch.assign(drawn.triangles);
            CHECK(batch.size() == drawn.triangles.size());
            interpolate(batch, drawn.rects, out.spans());
            CHECK(out.pads_are_intact());
            std::size_t first = 0;
            for (std::size_t i = 0; i < drawn.rects.size(); ++i) {
                const std::size_t count = count_of(drawn.rects[i]);
                apart += count > texgen::detail::largest_batch_tile;
                large += count > texgen::detail::largest_in_scratch && count <= texgen::detail::largest_batch_tile;
                overlapping += count <= texgen::detail::largest_in_scratch && drawn.rects[i].width > 8 &&
                               drawn.rects[i].width % 8 != 0;
                const Expected expected(drawn.triangles[i], region, drawn.rects[i], asked, texgen::exact);
                for (std::size_t k = 0; k < 2 && expected.work != Work::nothing; ++k)
                    zeros +=
                        expected.out.asked(k) && std::count(expected.out[k].begin(), expected.out[k].end(), 0.0f) > 1;
                if (!agree(expected, 0, out, first, count))
                    FAIL_CHECK(support::hex(drawn.triangles[i]), " at ", drawn.rects[i].x, " ", drawn.rects[i].y, " ",
                               drawn.rects[i].width, " x ", drawn.rects[i].height, " asked ", asked);
                first += count;
            }
        }
    }
    CHECK(apart > 100);
    CHECK(large > 100);
    CHECK(overlapping > 300);
    CHECK(zeros > 300);
}

TEST_CASE("with a tolerance, rectangles and visibility buffers are within it, and lit is what s and t say") {
    Random random(3);
    int judged = 0;
    for (int round = 0; round < 400; ++round) {
        const texgen::TextureRegion region = draw_region(random);
        const Tolerance tolerance{random.power_of_ten(-8.0, -1.0)};
        const Drawn drawn(random, random.integer(1, 12));
        TriangleBatch batch(region, tolerance);
        batch.assign(drawn.triangles);
        Outputs out(drawn.fragments);
        interpolate(batch, drawn.rects, out.spans());
        CHECK(out.pads_are_intact());
        std::size_t first = 0;
        for (std::size_t i = 0; i < drawn.rects.size(); first += count_of(drawn.rects[i]), ++i) {
            const FragmentRect& rect = drawn.rects[i];
            const auto setup = TriangleSetup::of(drawn.triangles[i], region, tolerance);
            const std::size_t count = count_of(rect);
            if (count == 0) continue;
            const bool is_nothing = !setup || setup->work(rect) == Work::nothing;
            const Shot shot{drawn.triangles[i], rect};
            const std::optional<support::ExactTriangle> exact =
                setup ? std::optional<support::ExactTriangle>(shot.triangle) : std::nullopt;
            std::vector<std::uint32_t> ids(count, static_cast<std::uint32_t>(i));
            Outputs by_id(count);
            interpolate(batch, ids, rect, by_id.spans());
            CHECK(by_id.pads_are_intact());
            for (std::size_t n = 0; n < count; n += 1 + count / 16) {
                if (!setup) {
                    for (std::size_t k = 0; k < 4; ++k) {
                        CHECK(support::same_bits(out[k][first + n], 0.0f));
                        CHECK(support::same_bits(by_id[k][n], 0.0f));
                    }
                    continue;
                }
                const auto [x, y] = shot.fragment(n);
                if (!exact->has_positive_w(x, y)) continue;
                ++judged;
                const auto at = exact->at(x, y);
                const std::string wrong = what_is_wrong(at, region, tolerance, out, first + n);
                if (!wrong.empty() && !(is_nothing && out[3][first + n] == 0.0f))
                    FAIL_CHECK(wrong, " ", support::hex(shot.triangle), " tolerance ", tolerance.value, " fragment ", n,
                               " of ", rect.x, " ", rect.y, " ", rect.width, " x ", rect.height);
                const std::string wrong_by_id = what_is_wrong(at, region, tolerance, by_id, n);
                // Alone it may be known to be dark.
                const bool is_dark =
                    by_id[3][n] == 0.0f &&
                    texgen::detail::survey(texgen::detail::Inside::functions(*setup), {x, y, 1, 1}).plan.work ==
                        Work::nothing;
                if (!wrong_by_id.empty() && !is_dark)
                    FAIL_CHECK(wrong_by_id, " ", support::hex(shot.triangle), " tolerance ", tolerance.value, " at ", x,
                               " ", y);
            }
        }
    }
    CHECK(judged > 2000);
}

TEST_CASE(
    "whatever tolerance a tile is divided in float for, it is within it: from far below what floats can to above") {
    Random random(7);
    for (int round = 0; round < 60; ++round) {
        // s and t run from about -1 to 1 and 0 stands in the tile, so that the steps from the middle are all there is
        // to round.
        const auto strq = [&](double q, double s, double t) {
            return glm::vec4(support::to_float(s * q), support::to_float(t * q), 0.0f, support::to_float(q));
        };
        const auto near_one = [&] { return random.uniform(0.9, 1.1); };
        const Triangle triangle{{{0.0f, 0.0f}, 1.0f, strq(near_one(), -near_one(), -near_one())},
                                {{8.0f, 0.0f}, 1.0f, strq(near_one() * 1.3, near_one(), -near_one())},
                                {{0.0f, 8.0f}, 1.0f, strq(near_one() * 1.2, -near_one(), near_one())}};
        const FragmentRect rect{0, 0, 8, 8};
        const support::ExactTriangle exact(triangle);
        for (double tolerance = 0x1p-25; tolerance < 0x1p-18; tolerance *= 1.15) {
            TriangleBatch batch(support::everywhere(), {tolerance});
            batch.assign({&triangle, 1});
            Outputs out(count_of(rect));
            interpolate(batch, {&rect, 1}, out.spans());
            for (std::size_t n = 0; n < count_of(rect); ++n) {
                const auto at = exact.at(static_cast<std::int64_t>(n % 8), static_cast<std::int64_t>(n / 8));
                const std::string wrong = what_is_wrong(at, support::everywhere(), {tolerance}, out, n);
                REQUIRE_MESSAGE(wrong.empty(), wrong, " ", support::hex(triangle), " tolerance ", tolerance, " at ", n);
            }
        }
    }
}

TEST_CASE("where a first cache does not hold the tiles of a batch their values do not depend on the alignment") {
    Random random(34);
    int in_whole_rows = 0;
    for (int round = 0; round < 40; ++round) {
        TriangleBatch batch(texgen::whole_texture(), Tolerance{random.power_of_ten(-6.0, -3.0)});
        std::vector<Triangle> triangles;
        std::vector<FragmentRect> rects;
        std::size_t count = 0;
        const int shift = random.integer(0, 4);
        while (count < 5000) {
            triangles.push_back(support::make_triangle(support::Family::friendly, random));
            const int width = random.integer(0, 3) != 0 ? 1 << shift : random.integer(1, 40);
            rects.push_back({random.integer(0, 600), random.integer(0, 600), width, random.integer(1, 400 / width)});
            in_whole_rows += 16 % width == 0;
            count += count_of(rects.back());
        }
        batch.assign(triangles);
        Outputs all(count);
        interpolate(batch, rects, all.spans());
        for (std::size_t misalignment = 1; misalignment <= 16; ++misalignment) {
            Outputs some(count, misalignment % 4 == 0 ? 15u : static_cast<unsigned>(random.integer(1, 15)),
                         misalignment);
            interpolate(batch, rects, some.spans());
            REQUIRE(some.pads_are_intact());
            for (std::size_t k = 0; k < 4; ++k)
                if (some.asked(k))
                    REQUIRE_MESSAGE(support::same_bits(some[k], all[k]), misalignment, " in round ", round);
        }
    }
    CHECK(in_whole_rows > 500);
}

TEST_CASE("what faces away is dark where that is asked for, and nothing else is changed") {
    Random random(8);
    const auto mirrored = [](Triangle triangle) {
        std::swap(triangle.b.strq, triangle.c.strq);
        return triangle;
    };
    int away = 0;
    for (int round = 0; round < 200; ++round) {
        Drawn drawn(random, random.integer(1, 20));
        for (Triangle& triangle : drawn.triangles)
            if (random.coin()) triangle = mirrored(triangle);
        const texgen::TextureOrigin origin =
            random.coin() ? texgen::TextureOrigin::bottom_left : texgen::TextureOrigin::top_left;
        TriangleBatch all(texgen::whole_texture()), facing(texgen::whole_texture());
        all.assign(drawn.triangles);
        facing.assign_facing(drawn.triangles, origin);
        Outputs of_all(drawn.fragments), out(drawn.fragments);
        interpolate(all, drawn.rects, of_all.spans());
        interpolate(facing, drawn.rects, out.spans());
        std::size_t n = 0;
        for (std::size_t i = 0; i < drawn.rects.size(); ++i) {
            const auto& [a, b, c] = drawn.triangles[i];
            const bool is_dark = texgen::facing(a.strq, b.strq, c.strq, origin) == texgen::Facing::away;
            away += is_dark ? 1 : 0;
            for (const std::size_t end = n + count_of(drawn.rects[i]); n < end; ++n)
                for (std::size_t k = 0; k < 4; ++k) CHECK(support::same_bits(out[k][n], is_dark ? 0.0f : of_all[k][n]));
            const std::uint32_t id = static_cast<std::uint32_t>(i);
            const FragmentRect one{drawn.rects[i].x, drawn.rects[i].y, 1, 1};
            Outputs of_id(1);
            interpolate(facing, {&id, 1}, one, of_id.spans());
            for (std::size_t k = 0; k < 4 && is_dark; ++k) CHECK(support::same_bits(of_id[k][0], 0.0f));
        }
    }
    CHECK(away > 300);
}

TEST_CASE("a rectangle of negative size among tiles in doubt is empty") {
    Random random(11);
    for (int round = 0; round < 100; ++round) {
        const Shot shot = ties_everywhere(random, 0.0f);
        const std::vector<Triangle> triangles(3, shot.triangle);
        TriangleBatch batch(support::everywhere());
        batch.assign(triangles);
        FragmentRect empty = shot.rect;
        (random.coin() ? empty.width : empty.height) *= -1;
        const std::size_t count = count_of(shot.rect);
        Outputs three(2 * count), alone(count);
        interpolate(batch, std::array{empty, shot.rect, shot.rect}, three.spans());
        interpolate(TriangleSetup::of(shot.triangle, support::everywhere()).value(), shot.rect, alone.spans());
        for (std::size_t i = 0; i < 2 * count; ++i) REQUIRE(support::same_bits(three.s()[i], alone.s()[i % count]));
    }
}

TEST_CASE("a batch that was moved from has no triangles, and takes new ones; a copy is one of its own") {
    Random random(1412);
    std::vector<Triangle> triangles(20);
    for (Triangle& triangle : triangles) triangle = support::make_triangle(support::Family::friendly, random);
    const auto values_of = [](const TriangleBatch& batch) {
        const std::vector<std::uint32_t> ids{0, 3, 3, 7, texgen::no_triangle, 19};
        std::vector<float> s(ids.size(), -7.0f);
        texgen::interpolate(batch, ids, {100, 100, 6, 1}, {.s = s});
        return s;
    };
    TriangleBatch batch(texgen::whole_texture());
    batch.assign(triangles);
    const std::vector<float> given = values_of(batch);
    const TriangleBatch copy = batch;
    TriangleBatch moved = std::move(batch);
    for (const bool by_assignment : {false, true}) {
        CAPTURE(by_assignment);
        CHECK(moved.size() == triangles.size());
        CHECK(values_of(moved) == given);
        CHECK(batch.size() == 0);
        CHECK(values_of(batch) == std::vector<float>(6, 0.0f));
        batch.assign(std::span(triangles).first(4));
        CHECK(batch.size() == 4);
        CHECK(values_of(batch)[1] == given[1]);
        batch = copy;
        CHECK(values_of(batch) == given);
        moved = std::move(batch);
    }
    CHECK(values_of(copy) == given);
}

TEST_CASE("memory is allocated only when there are more triangles than ever") {
    Random random(6);
    const Drawn drawn(random, 100);
    TriangleBatch batch(texgen::whole_texture());
    batch.assign(drawn.triangles);
    const auto* const planes = texgen::detail::Inside::planes(batch);
    const Triangle* const triangles = &texgen::detail::Inside::triangle(batch, 0);
    for (const std::size_t count : {std::size_t{3}, std::size_t{0}, std::size_t{97}, std::size_t{100}}) {
        batch.assign(std::span(drawn.triangles).first(count));
        CHECK(batch.size() == count);
        CHECK(texgen::detail::Inside::planes(batch) == planes);
        CHECK((count == 0 || &texgen::detail::Inside::triangle(batch, 0) == triangles));
    }
}

}  // namespace batch_cases
