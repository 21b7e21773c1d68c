// A fragment has one value, in whatever rectangle, row or column it is asked for, and a mask is that of s and t.

#include "texgen/interpolate.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "api/interpolate_test/rows.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "support/hard_triangles.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/triangles.hpp"

namespace row_cases {

using support::HardFamily;
using support::text;

namespace {

// Of a scene, with all of a window of 450 x 320 in front and in the slide: one certificate mostly serves a tile of it.
Triangle gentle_triangle(Random& random) {
    const auto vertex = [&](float x, float y) {
        const float q = random.uniform_float(1.0, 3.0);
        const auto coordinate = [&] { return q * random.uniform_float(0.1, 0.9); };
        return WindowVertex{{x + random.uniform_float(-9.0, 9.0), y + random.uniform_float(-9.0, 9.0)},
                            random.uniform_float(1.0, 4.0),
                            {coordinate(), coordinate(), coordinate(), q}};
    };
    return {vertex(-20.0f, -20.0f), vertex(1400.0f, 40.0f), vertex(60.0f, 1200.0f)};
}

}  // namespace

TEST_CASE("a value does not depend on the rectangle that it was asked with") {
    std::uint64_t seed = 300;
    int parts = 0, parts_with_nothing = 0;
    for (const HardFamily& family : support::hard_families) {
        Random random(++seed);
        for (int i = 0; i < 12; ++i) {
            Shot shot = family.make(random);
            if (std::abs(static_cast<std::int64_t>(shot.rect.x)) < 2000000000 &&
                std::abs(static_cast<std::int64_t>(shot.rect.y)) < 2000000000)
                shot.rect.width += random.integer(0, 200), shot.rect.height += random.integer(0, 12);
            const TriangleSetup setup = setup_of(shot.triangle);
            Outputs whole(count_of(shot.rect));
            if (interpolate(setup, shot.rect, whole.spans()) == Work::nothing) continue;
            for (int j = 0; j < 60; ++j) {
                FragmentRect part = shot.rect;
                part.width = random.integer(1, random.coin() ? shot.rect.width : std::min(9, shot.rect.width));
                part.height = random.integer(1, shot.rect.height);
                const int dx = random.integer(0, shot.rect.width - part.width);
                const int dy = random.integer(0, shot.rect.height - part.height);
                constexpr int last = std::numeric_limits<int>::max();
                if (shot.rect.x > last - dx || shot.rect.y > last - dy) continue;
                part.x += dx;
                part.y += dy;
                Outputs out(count_of(part), Outputs::all, static_cast<std::size_t>(j % 16));
                const bool nothing = interpolate(setup, part, out.spans()) == Work::nothing;
                ++parts;
                parts_with_nothing += nothing;
                for (std::size_t k = 0; k < 4; ++k) {
                    for (int row = 0; row < part.height; ++row) {
                        const auto first = static_cast<std::size_t>((dy + row) * shot.rect.width + dx);
                        const auto width = static_cast<std::size_t>(part.width);
                        const auto expected = whole[k].subspan(first, width);
                        const auto got = out[k].subspan(static_cast<std::size_t>(row) * width, width);
                        const bool same = nothing && k < 3 ? Outputs::is_poison(got) : same_bits(got, expected);
                        REQUIRE_MESSAGE(same, family.name, ": output ", k, " in ", text(part), " of ", hex(shot));
                    }
                }
                REQUIRE(out.pads_are_intact());
            }
        }
    }
    CHECK(parts > 8000);
    CHECK(parts_with_nothing > 10);
}

TEST_CASE("the fragments of a tile of any width are those that are asked for alone") {
    Random random(350);
    for (int width = 1; width <= 140; ++width) {
        for (const int height : {1, 2, 3, 8, 9, 24, 31, 300}) {
            if (width * height > 2100) continue;
            const FragmentRect rect = {random.integer(0, 300), random.integer(0, 300), width, height};
            const Triangle triangle = gentle_triangle(random);
            const TriangleSetup setup = setup_of(triangle, random.coin() ? everywhere() : texgen::whole_texture());
            Outputs whole(count_of(rect), Outputs::all, static_cast<std::size_t>(random.integer(0, 15)));
            if (interpolate(setup, rect, whole.spans()) == Work::nothing) continue;
            for (int i = 0; i < width * height; ++i) {
                Outputs alone(1);
                const FragmentRect fragment = {rect.x + i % width, rect.y + i / width, 1, 1};
                const bool nothing = interpolate(setup, fragment, alone.spans()) == Work::nothing;
                for (std::size_t k = nothing ? 3 : 0; k < 4; ++k)
                    REQUIRE_MESSAGE(same_bits(whole[k].subspan(static_cast<std::size_t>(i), 1), alone[k]), "output ", k,
                                    " of fragment ", i, " in ", text(rect), " of ", hex(Shot{triangle, rect}));
            }
            REQUIRE(whole.pads_are_intact());
        }
    }
}

TEST_CASE("a column is as right as a row, of any height, within any region and tolerance") {
    Random random(351);
    Seen seen;
    constexpr std::array asked{Outputs::all, 0b1011u, 0b1000u, 0b1001u, 0b0001u, 0b1110u};
    for (const HardFamily& family : support::hard_families) {
        CAPTURE(std::string(family.name));
        for (int i = 0; i < 60; ++i) {
            Shot shot = family.make(random);
            if (random.coin()) shot = mirrored(shot);  // what is hard of a row is of a column then
            const std::int64_t x = shot.x(random.integer(0, shot.rect.width - 1));
            shot.rect.x = static_cast<int>(std::min<std::int64_t>(x, (std::numeric_limits<int>::max)()));
            shot.rect.width = 1;
            if (shot.rect.height == 1 || random.coin()) shot.rect.height = random.integer(2, i % 3 == 0 ? 700 : 70);
            const ExactTriangle exact(shot.triangle);
            const texgen::TextureRegion region =
                random.coin() ? support::region_at(shot, exact, random) : texgen::whole_texture().with_depth();
            const texgen::Tolerance tolerance = random.coin() ? texgen::exact : texgen::texels(1.0 / 512.0, 4096.0);
            Outputs out(count_of(shot.rect), asked[static_cast<std::size_t>(random.integer(0, 5))]);
            const TriangleSetup setup = setup_of(shot.triangle, region, tolerance);
            const Work work = interpolate(setup, shot.rect, out.spans());
            REQUIRE_MESSAGE(work == setup.work(shot.rect), hex(shot));
            const std::string wrong = first_wrong(shot, exact, region, tolerance, work, out, seen);
            REQUIRE_MESSAGE(wrong.empty(), wrong, " in ", hex(shot));
            REQUIRE(out.pads_are_intact());
        }
    }
    CHECK(seen.in_front > 1000);
    CHECK(seen.lit > 1000);
    CHECK(seen.dark > 1000);
}

TEST_CASE("a value depends neither on what else is asked, nor on the alignment, nor on the length") {
    Random random(400);
    const std::array makers{
        +[](Random& r) { return support::detail::ordinary(support::Family::friendly, r); },
        +[](Random& r) { return support::detail::with_root(3, r); },
        +[](Random& r) { return support::detail::constant_q(r); },
        +[](Random& r) { return row_of_ties(1, 1, r); },
    };
    const texgen::TextureRegion sides = texgen::atlas_tile({0.1, 0.2}, {0.9, 0.7});
    for (const int width : awkward_widths()) {
        for (const auto make : makers) {
            Shot shot = make(random);
            shot.rect.width = width;
            shot.rect.height = random.integer(1, width < 70 ? 5 : 2);
            const TriangleSetup setup = setup_of(shot.triangle, random.coin() ? sides : sides.with_depth(0.25, 0.8));
            Outputs all(count_of(shot.rect));
            const Work work = interpolate(setup, shot.rect, all.spans());
            for (unsigned asked = 0; asked < Outputs::all; ++asked) {
                Outputs some(count_of(shot.rect), asked, static_cast<std::size_t>(random.integer(0, 16)));
                REQUIRE(interpolate(setup, shot.rect, some.spans()) == work);
                for (std::size_t k = 0; k < 4; ++k)
                    if (some.asked(k)) REQUIRE_MESSAGE(same_bits(some[k], all[k]), asked, " of ", hex(shot));
                REQUIRE_MESSAGE(some.pads_are_intact(), asked, " of ", hex(shot));
            }
        }
    }
}

TEST_CASE(
    "where a first cache does not hold a tile its values do not depend on the alignment, and keep the tolerance") {
    Random random(401);
    // Rows of one chunk and of several, with and without a rest that is shorter than a vector.
    const glm::ivec2 sizes[] = {{16, 600}, {37, 150}, {64, 70}, {100, 90}, {257, 40}, {513, 9}, {1537, 7}, {4097, 3}};
    constexpr double tolerance = 0x1p-20;
    std::size_t rests = 0;
    for (const glm::ivec2 size : sizes) {
        Triangle triangle = gentle_triangle(random);
        for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c}) vertex->window *= 16.0f;
        const Shot shot{triangle, {random.integer(0, 90), random.integer(0, 90), size.x, size.y}};
        Outputs nearest(count_of(shot.rect)), all(count_of(shot.rect));
        interpolate(setup_of(triangle), shot.rect, nearest.spans());
        const TriangleSetup setup = setup_of(triangle, texgen::whole_texture(), texgen::Tolerance{tolerance});
        const Work work = interpolate(setup, shot.rect, all.spans());
        REQUIRE((work == Work::quadratic || work == Work::divide || work == Work::affine));
        if (size.x % 16 == 1 && size.x > 256) ++rests;
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t i = 0; i < all.size(); ++i)
                REQUIRE_MESSAGE(std::abs(all[k][i] - nearest[k][i]) <= 1.25 * tolerance, i, " of ", hex(shot));
        for (std::size_t misalignment = 0; misalignment <= 16; ++misalignment) {
            Outputs some(count_of(shot.rect), misalignment % 3 == 0 ? 3u : 15u, misalignment);
            interpolate(setup, shot.rect, some.spans());
            for (std::size_t k = 0; k < 4; ++k)
                if (some.asked(k)) REQUIRE_MESSAGE(same_bits(some[k], all[k]), misalignment, " of ", hex(shot));
            REQUIRE_MESSAGE(some.pads_are_intact(), misalignment, " of ", hex(shot));
        }
    }
    CHECK(rests == 4);
}

TEST_CASE("a mask without coordinates is right in rows wider than the scratch of a strip") {
    Random random(450);
    Seen seen;
    for (const int width : {511, 512, 513, 1023, 1024, 1025, 1600}) {
        for (const unsigned asked : {8u, 9u, 10u, 11u, 15u}) {
            Shot shot = support::detail::ordinary(support::Family::friendly, random);
            shot.rect = {-100, random.integer(0, 800), width, 3};
            Outputs out(count_of(shot.rect), asked, 1);
            require_right(shot, texgen::whole_texture(), out, seen);
            Outputs of_volume(count_of(shot.rect), asked, 1);
            require_right(shot, texgen::whole_texture().with_depth(random.uniform(0.0, 1.0), HUGE_VAL), of_volume,
                          seen);
        }
    }
    CHECK(seen.lit > 2000);
    CHECK(seen.dark > 2000);
}

TEST_CASE("a mask alone is that of s and t where sides cross the tile, follow its pixels or are its plane") {
    Random random(451);
    // Corners on fragments and coordinates of few bits, so that sides run through fragments along rows, columns and
    // diagonals; and others.
    const auto on_a_grid = [](Random& r) {
        Shot shot{};
        for (WindowVertex* vertex : vertices(shot.triangle)) {
            vertex->window = glm::vec2(r.integer(-64, 300), r.integer(-64, 300)) + 0.5f;
            vertex->clip_w = std::ldexp(1.0f, r.integer(0, 2));
            vertex->strq = glm::vec4(r.integer(-4, 8), r.integer(-4, 8), 2.0f, 4 * r.integer(1, 2)) * 0.25f;
        }
        return shot;
    };
    // s is 1 at fragments but for less than its floats are apart, which move the side by 2^-18 of a fragment and more.
    const auto beside_one = [](Random& r) {
        const glm::vec2 crossing = glm::vec2(r.integer(0, 140), r.integer(0, 100)) + 0.5f;
        const glm::vec2 from[] = {{-816.0f, 0.0f}, {208.0f, 40.0f}, {-16.0f, 500.0f}};
        const auto down = static_cast<float>(r.integer(-1, 1));
        Shot shot{};
        std::size_t i = 0;
        for (WindowVertex* vertex : vertices(shot.triangle)) {
            const glm::vec2 by = from[i++];
            const float s = 1.0f + (by.x + down * by.y) / 1024.0f;
            vertex->window = crossing + by;
            vertex->clip_w = 1.0f;
            vertex->strq = {r.coin() ? s : std::nextafter(s, r.coin() ? 2.0f : -1.0f), 0.5f, 0.5f, 1.0f};
        }
        return shot;
    };
    const std::array makers{
        +on_a_grid,
        +beside_one,
        +[](Random& r) { return support::detail::ordinary(support::Family::friendly, r); },
        +[](Random& r) { return support::detail::with_root(3, r); },
        +[](Random& r) { return support::detail::constant_q(r); },
    };
    int crossed = 0, planes = 0, open = 0, beside = 0;
    for (int i = 0; i < 6000; ++i) {
        Shot shot = makers[static_cast<std::size_t>(i) % makers.size()](random);
        shot.rect = {random.integer(-10, 100), random.integer(-10, 100), random.integer(1, 150), random.integer(1, 12)};
        const bool is_plane = random.integer(0, 7) == 0;
        if (is_plane) {
            const auto coordinate = static_cast<glm::length_t>(random.integer(0, 1));
            const float bound = random.coin() ? 1.0f : 0.0f;
            for (WindowVertex* vertex : vertices(shot.triangle)) vertex->strq[coordinate] = bound * vertex->strq.w;
        }
        const auto side = [&](double of_whole, double none) {
            const int kind = random.integer(0, 9);
            open += kind == 0;
            return kind == 0 ? none : kind == 1 ? random.integer(-8, 16) / 8.0 : of_whole;
        };
        const texgen::TextureRegion region = texgen::atlas_tile({side(0.0, -HUGE_VAL), side(0.0, -HUGE_VAL)},
                                                                {side(1.0, HUGE_VAL), side(1.0, HUGE_VAL)});
        const auto setup = TriangleSetup::of(shot.triangle, region);
        if (!setup) continue;
        Outputs all(count_of(shot.rect));
        const Work work = interpolate(*setup, shot.rect, all.spans());
        for (const unsigned asked : {8u, 9u, 10u}) {
            Outputs some(count_of(shot.rect), asked, static_cast<std::size_t>(random.integer(0, 16)));
            REQUIRE_MESSAGE(interpolate(*setup, shot.rect, some.spans()) == work, hex(region), " in ", hex(shot));
            for (std::size_t k = 0; k < 4; ++k)
                if (some.asked(k) && (k == 3 || work != Work::nothing))
                    REQUIRE_MESSAGE(same_bits(some[k], all[k]), asked, " of ", hex(region), " in ", hex(shot));
            REQUIRE(some.pads_are_intact());
        }
        // Within next to nothing there is no slack beside a side.
        Outputs mask(count_of(shot.rect), 8u);
        interpolate(setup_of(shot.triangle, region, texgen::Tolerance{0x1p-100}), shot.rect, mask.spans());
        REQUIRE_MESSAGE(same_bits(mask.lit(), all.lit()), "within 2^-100, ", hex(region), " in ", hex(shot));
        const auto lit = std::count(all.lit().begin(), all.lit().end(), 1.0f);
        crossed += lit > 0 && lit < static_cast<std::ptrdiff_t>(all.size());
        planes += is_plane && lit > 0;
        for (std::size_t k = 0; k < all.size() && work != Work::nothing; ++k)
            beside += all.s()[k] == 0.0f || all.s()[k] == 1.0f;
    }
    CHECK(crossed > 400);
    CHECK(planes > 100);
    CHECK(open > 1000);
    CHECK(beside > 2000);
}

TEST_CASE("a rectangle without fragments does nothing") {
    Random random(550);
    const TriangleSetup setup = setup_of(make_triangle(support::Family::friendly, random));
    for (const FragmentRect& rect : {FragmentRect{5, 5, 0, 3}, FragmentRect{5, 5, 3, 0}, FragmentRect{5, 5, 0, 0}}) {
        Outputs out(0);
        CHECK(interpolate(setup, rect, out.spans()) == Work::nothing);
        CHECK(out.pads_are_intact());
    }
}

TEST_CASE("rectangles at the ends of int, with a triangle anywhere, are the nearest floats") {
    Random random(600);
    constexpr int low = std::numeric_limits<int>::min(), high = std::numeric_limits<int>::max();
    Seen seen;
    for (int i = 0; i < 300; ++i) {
        Shot shot = support::detail::ordinary(support::Family::friendly, random);
        if (random.coin()) {  // w = 1: every fragment counts, however far from the triangle
            for (WindowVertex* vertex : vertices(shot.triangle)) vertex->clip_w = 1.0f;
        }
        shot.rect.x = random.coin() ? high - random.integer(0, 2) * (shot.rect.width - 1) : low + random.integer(0, 2);
        shot.rect.y = random.coin() ? high - random.integer(0, 2) * (shot.rect.height - 1) : low + random.integer(0, 2);
        Outputs out(count_of(shot.rect));
        require_right(shot, everywhere(), out, seen);
    }
    CHECK(seen.in_front > 5000);
}

}  // namespace row_cases
