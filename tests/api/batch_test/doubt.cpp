// What doubles leave in doubt is decided in a batch as for each triangle alone, and seldom by a set-up of its own.

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "api/batch_test/drawn.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/triangles.hpp"
#include "texgen/batch.hpp"
#include "texgen/interpolate.hpp"

namespace batch_cases {

using texgen::TriangleBatch;

namespace {

// A sliver 2^20 long and more at the window's edge, of a q/w that is all but constant, and a rectangle at the ends of
// int; or s/q is half-way between two floats at every fragment there, being 0 2^24 pixels nearer, of functions of more
// bits than a double.
Shot far_sliver(Random& random) {
    Triangle triangle = support::make_triangle(support::Family::parallel, random);
    const int axis = random.integer(0, 1), first = random.integer(0, 2);
    const float across = random.uniform_float(0x1p-11, 0x1p-9);
    const bool has_ties = random.coin();
    const double end = random.coin() ? 0x1p31 : -0x1p31;
    for (int i = 0; i < 3; ++i) {
        texgen::WindowVertex& vertex = *support::vertices(triangle)[static_cast<std::size_t>((first + i) % 3)];
        double along = (i == 0 ? random.power_of_ten(6.0, 6.6) : random.power_of_ten(-6.0, 0.0)) + i * 0x1p-20;
        if (has_ties) along = i == 0 ? 0x1p20 * random.integer(1, 5) : i == 1 ? 0.0 : 0x1p14;
        if (random.coin()) along = -along;
        vertex.window[axis] = static_cast<float>(along);
        vertex.window[1 - axis] = across * (1.0f + static_cast<float>(i == 0 ? random.integer(1, 255) : 0) * 0x1p-23f);
        const int bits_of_w = !has_ties ? 22 : i == 0 ? 12 : i == 1 ? 16 : 6;
        vertex.clip_w = 1.0f + std::ldexp(static_cast<float>(random.integer(0, has_ties ? 63 : 3)), -bits_of_w);
        vertex.strq.w = vertex.clip_w;
        if (has_ties)
            vertex.strq.x = static_cast<float>((along - end * (1.0 - 0x1p-7)) * 0x1p-24) * vertex.clip_w;  // exactly
    }
    const auto pixel = [&](double at) {
        const int low = std::numeric_limits<int>::min() + random.integer(0, 99);
        return at < 0.0 ? low : std::numeric_limits<int>::max() - 8 - random.integer(0, 99);
    };
    FragmentRect rect{pixel(random.coin() ? 1.0 : -1.0), pixel(end), 8, 8};
    if (axis == 0) std::swap(rect.x, rect.y);
    return {triangle, rect};
}

// How many tiles of a batch the vectors leave to a set-up of their own.
int left_by_vectors(const Drawn& drawn, Tolerance tolerance) {
    TriangleBatch batch(support::everywhere(), tolerance);
    batch.assign(drawn.triangles);
    Outputs out(drawn.fragments);
    texgen::detail::TilesJob job{};
    texgen::detail::describe(job, batch, out.spans(), drawn.fragments);
    job.tiles = reinterpret_cast<const int(*)[4]>(drawn.rects.data());
    job.tile_count = drawn.rects.size();
    return std::popcount(texgen::detail::chosen<texgen::detail::BatchKernels>().divide_tiles(job, 0, 0).values);
}

}  // namespace

TEST_CASE("what doubles leave in doubt of a visibility buffer is decided as for each triangle alone") {
    Random random(7);
    for (int round = 0; round < 500; ++round) {
        std::vector<Shot> shots;
        std::vector<Triangle> triangles;
        const int count = random.coin() ? 8 : 40;
        for (int i = 0; i < count; ++i) {
            shots.push_back(random.integer(0, 2) != 0 ? ties_everywhere(random) : draw(random));
            triangles.push_back(shots.back().triangle);
        }
        TriangleBatch batch(support::everywhere());
        batch.assign(triangles);
        const int longest = random.coin() ? 1 : 12;
        std::vector<std::uint32_t> ids(64);
        for (std::size_t i = 0; i < ids.size();) {
            const auto id = static_cast<std::uint32_t>(random.integer(0, count - 1));
            for (int run = random.integer(1, longest); run > 0 && i < ids.size(); --run) ids[i++] = id;
        }
        const Shot& shot = shots[static_cast<std::size_t>(random.integer(0, count - 1))];
        const FragmentRect rect{shot.rect.x, shot.rect.y, 8, 8};
        Outputs out(64);
        interpolate(batch, ids, rect, out.spans());
        for (std::uint32_t id = 0; id < triangles.size(); ++id) {
            const Expected expected(triangles[id], support::everywhere(), rect, 15, texgen::exact);
            if (rect.x > 0x7ffffff0 || rect.y > 0x7ffffff0) continue;
            for (std::size_t i = 0; i < ids.size(); ++i)
                for (std::size_t k = 0; k < 4 && ids[i] == id; ++k)
                    if (!support::same_bits(out[k][i], expected.work == Work::nothing ? 0.0f : expected.out[k][i]))
                        FAIL_CHECK(support::hex(triangles[id]), " at ", support::text(rect), " number ", i);
        }
    }
}

TEST_CASE(
    "what is kept of triangles in doubt for the rows that follow is theirs, wherever and whenever they come again") {
    constexpr glm::ivec2 sizes[] = {{5, 40}, {8, 1500}, {64, 70}, {128, 90}, {200, 70}, {1024, 3}, {20000, 2}};
    Random random(17);
    int ties = 0, apart = 0;
    for (int round = 0; round < 70; ++round) {
        std::vector<Triangle> triangles;
        FragmentRect rect{0, 0, sizes[round % 7].x, sizes[round % 7].y};
        const bool is_far = random.coin();
        for (int i = 0; i < 64; ++i) {
            const bool is_in_doubt = i % 16 < 12;
            const Shot shot = !is_in_doubt ? steep(random) : is_far ? far_sliver(random) : ties_everywhere(random);
            triangles.push_back(shot.triangle);
            if (i != 0 || !is_far) continue;
            rect.x = shot.rect.x > 0 ? shot.rect.x - rect.width : shot.rect.x;
            rect.y = shot.rect.y > 0 ? shot.rect.y - rect.height : shot.rect.y;
        }
        TriangleBatch batch(support::everywhere());
        batch.assign(triangles);
        // Of a few triangles, some of which another takes the place of: with an id that is the same modulo 16.
        std::uint32_t few[16];
        for (std::uint32_t i = 0; i < 16; ++i) few[i] = i;
        const int used = random.integer(1, 15),
                  longest = round % 3 == 0   ? 1
                            : round % 3 == 1 ? 20
                                             : 400,
                  change_each = random.integer(20, 600);
        std::vector<std::uint32_t> ids(count_of(rect));
        for (std::size_t i = 0; i < ids.size();) {
            if (random.integer(0, change_each) == 0) {
                std::uint32_t& changed = few[random.integer(0, used)];
                changed = (changed + 16u) % 64u;
                ++apart;
            }
            const std::uint32_t id = few[random.integer(0, used)];
            for (int run = random.integer(1, longest); run > 0 && i < ids.size(); --run) ids[i++] = id;
        }
        Outputs out(ids.size(), 11u);
        interpolate(batch, ids, rect, out.spans());
        for (int draw = 0; draw < 300; ++draw) {
            const std::size_t i = random.bits() % ids.size();
            const auto at = static_cast<std::int64_t>(i);
            const std::int64_t x = rect.x + at % rect.width, y = rect.y + at / rect.width;
            const support::Homogeneous exact = support::ExactTriangle(triangles[ids[i]]).at(x, y);
            const bool in_front = exact.q.sign() > 0;
            ties += in_front && support::is_tie(exact.over_q(0)) ? 1 : 0;
            for (std::size_t k = 0; k < 2; ++k) {
                const bool is_right =
                    in_front ? is_nearest(out[k][i], exact.over_q(k)) : support::same_bits(out[k][i], 0.0f);
                CHECK_MESSAGE(is_right, support::hex(triangles[ids[i]]), " at ", x, " ", y, " of ",
                              support::text(rect));
            }
        }
    }
    CHECK(ties > 2000);
    CHECK(apart > 100);
}

TEST_CASE("no tile of ties needs a set-up of its own") {
    Random random(10);
    for (int round = 0; round < 100; ++round) {
        const Drawn drawn(8, [&] { return ties_everywhere(random, 0.0f); });
        CHECK(left_by_vectors(drawn, texgen::exact) == 0);
    }
}

TEST_CASE(
    "what cancels 2^60 of its terms is the nearest float all the same, in a tile, a batch and a visibility buffer") {
    Random random(15);
    int hard = 0, lit = 0, ties = 0;
    for (int round = 0; round < 150; ++round) {
        const Drawn drawn(8, [&] { return far_sliver(random); });
        const std::vector<Triangle>& triangles = drawn.triangles;
        const std::vector<FragmentRect>& rects = drawn.rects;
        for (const Triangle& t : triangles) hard += std::fabs(support::twice_area(t)) < 0x1p-60 * 0x1p31 * 1e6;
        CHECK(left_by_vectors(drawn, texgen::exact) == 0);
        TriangleBatch batch(support::everywhere());
        batch.assign(triangles);
        Outputs of_tiles(drawn.fragments), of_ids(64);
        interpolate(batch, rects, of_tiles.spans());
        std::uint32_t ids[64];
        const int run = random.integer(1, 9);
        for (int i = 0; i < 64; ++i) ids[i] = static_cast<std::uint32_t>(i / run % 8);
        interpolate(batch, ids, rects[0], of_ids.spans());
        const auto check = [&](std::size_t id, const FragmentRect& rect, std::size_t i, const Outputs& out,
                               std::size_t n) {
            const auto at = static_cast<std::int64_t>(i);
            const support::Homogeneous exact =
                support::ExactTriangle(triangles[id]).at(rect.x + at % 8, rect.y + at / 8);
            const bool in_front = exact.q.sign() > 0;
            lit += in_front ? 1 : 0;
            ties += in_front && support::is_tie(exact.over_q(0)) ? 1 : 0;
            for (std::size_t k = 0; k < 3; ++k) {
                const bool is_right =
                    in_front ? is_nearest(out[k][n], exact.over_q(k)) : support::same_bits(out[k][n], 0.0f);
                CHECK_MESSAGE(is_right, support::hex(triangles[id]), " at ", support::text(rect), " fragment ", i);
            }
        };
        for (std::size_t id = 0; id < 8; ++id) {
            Outputs of_tile(64);
            const auto setup = TriangleSetup::of(triangles[id], support::everywhere(), texgen::exact);
            REQUIRE(setup);
            const bool has_fragments = interpolate(*setup, rects[id], of_tile.spans()) != Work::nothing;
            for (int draw = 0; draw < 4; ++draw) {
                const auto i = static_cast<std::size_t>(random.integer(0, 63));
                check(id, rects[id], i, of_tiles, 64 * id + i);
                if (has_fragments) check(id, rects[id], i, of_tile, i);
                check(ids[i], rects[0], i, of_ids, i);
            }
        }
    }
    CHECK(hard > 600);
    CHECK(lit > 7000);
    CHECK(ties > 3000);
}

TEST_CASE("few friendly tiles need a set-up of their own") {
    for (const Tolerance tolerance : {texgen::exact, texgen::texels(1.0 / 512, 4096)}) {
        Random random(4);
        int doubtful = 0;
        for (int round = 0; round < 100; ++round) {
            const Drawn drawn(8, [&]() -> Shot {
                const Triangle triangle = support::make_triangle(support::Family::friendly, random);
                const FragmentRect pixel = support::pixel_near(triangle, random);
                return {triangle, {pixel.x, pixel.y, 8, 8}};
            });
            doubtful += left_by_vectors(drawn, tolerance);
        }
        CHECK(doubtful < 40);  // of 800; s or t is 0 in some
    }
}

}  // namespace batch_cases
