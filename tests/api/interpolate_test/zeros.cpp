// Where a coordinate is 0, or next to it, what is left of terms that cancel is the nearest float.

#include "texgen/interpolate.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <string>

#include "api/interpolate_test/rows.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "support/hard_triangles.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"

namespace row_cases {

namespace {

FragmentRect small_rect(Random& random) {
    return {random.integer(100, 400), random.integer(100, 400), random.integer(1, 12), random.integer(1, 8)};
}

}  // namespace

TEST_CASE("next to where s is 0, of terms that cancel, every fragment of a small tile is the nearest float") {
    Random random(205);
    Seen seen;
    for (int i = 0; i < 400; ++i) {
        const FragmentRect rect = small_rect(random);
        // Before the tile, or in it, where s changes its sign.
        const int column = random.coin() ? 0 : random.integer(0, rect.width - 1);
        const double zero = rect.x + column + 0.5 - random.power_of_ten(column == 0 ? -5.0 : -9.0, -1.0);
        const auto vertex = [&](double around_x, double around_y) {
            const float x = random.uniform_float(around_x - 9.0, around_x + 9.0), y = support::to_float(around_y);
            const double s = (static_cast<double>(x) - zero) / 1024.0;
            return WindowVertex{{x, y}, 1.0f, {support::to_float(s), 0.5f, 0.5f, random.uniform_float(1.0, 1.5)}};
        };
        const Shot shot{{vertex(-20.0, -20.0), vertex(1400.0, 40.0), vertex(60.0, 1200.0)}, rect};
        Outputs out(count_of(rect), random.coin() ? 15u : 1u);
        require_right(shot, texgen::atlas_tile({column == 0 ? 0.0 : -0.03, 0.0}, {0.03, 1.0}), out, seen);
    }
    CHECK(seen.lit > 5000);
}

TEST_CASE("where s is 0 at one fragment of a small tile, of terms that are no dyadic numbers, it is 0") {
    Random random(206);
    Seen seen;
    for (int i = 0; i < 2000; ++i) {
        const FragmentRect rect = small_rect(random);
        const int column = random.integer(0, rect.width - 1), row = random.integer(0, rect.height - 1);
        // The middle of the corners, where s/w are integers whose sum is 0.
        int x[3] = {}, y[3] = {}, s_over_w[3] = {};
        for (std::size_t k = 0; k < 2; ++k) {
            x[2] -= x[k] = random.integer(-700, 700);
            y[2] -= y[k] = random.integer(-700, 700);
            s_over_w[2] -= s_over_w[k] = random.integer(-2000, 2000);
        }
        const auto vertex = [&](std::size_t k) {
            const int w = random.integer(1, 2000);
            const auto single = [](int value) { return static_cast<float>(value); };
            return WindowVertex{{single(rect.x + column + x[k]) + 0.5f, single(rect.y + row + y[k]) + 0.5f},
                                single(w),
                                {single(s_over_w[k] * w), 0.5f, 0.5f, single(w * random.integer(2000, 4000))}};
        };
        const Shot shot{{vertex(0), vertex(1), vertex(2)}, rect};
        if (!TriangleSetup::of(shot.triangle, everywhere())) continue;
        Outputs out(count_of(rect), 1u);
        require_right(shot, texgen::atlas_tile({-9.0, -9.0}, {9.0, 9.0}), out, seen);
        REQUIRE_MESSAGE(same_bits(out.s()[static_cast<std::size_t>(row * rect.width + column)], 0.0f), hex(shot));
    }
    CHECK(seen.in_front > 50000);
}

TEST_CASE("what has more bits than a residue is not what the residue says: neither 0, nor of its sign") {
    Random random(204);
    Seen seen;
    const auto bits = [&] { return random.coin() ? random.uniform_float(1.0, 2.0) : random.uniform_float(-2.0, -1.0); };
    for (int i = 0; i < 300; ++i) {
        // s and q are multiples of a far corner's last bit, by so many times 2^64 on the side ab; s/q is half-way
        // between two subnormal floats.
        const float s = static_cast<float>(2 * random.integer(1, 1000) + 1) * 0x1p-149f;
        const float off = std::ldexp(1.0f, random.integer(-110, -40));
        const Triangle flat{{{0.0f, 0.5f}, 1.0f, {s, s, s, 2.0f}},
                            {{1024.0f, 0.5f}, 1.0f, {2.0f * s, 2.0f * s, 2.0f * s, 4.0f}},
                            {{off, 1024.5f}, 1.0f, {s, s, s, 2.0f}}};
        const Shot ties{flat, {0, 0, random.integer(4, 64), 1}};
        REQUIRE(support::is_tie(ExactTriangle(flat).at(3, 0).over_q(0)));
        Outputs out(count_of(ties.rect), 3u);
        require_right(ties, everywhere(), out, seen);
        // q is almost 0 in one column: c is off its place, and a has more bits for nothing.
        const int width = random.integer(4, 64);
        const float root = static_cast<float>(random.integer(0, width - 1)) + 0.5f;
        const auto vertex = [](float x, float y, float q) { return WindowVertex{{x, y}, 1.0f, {1.0f, 1.0f, 1.0f, q}}; };
        const Triangle turning{vertex(0.0f, std::ldexp(bits(), random.integer(-30, -5)), -root),
                               vertex(1024.0f, 0.0f, 1024.0f - root),
                               vertex(std::ldexp(bits(), random.integer(-95, -70)), 1024.0f, -root)};
        const Shot at_root{turning, {0, 0, width, random.integer(1, 8)}};
        Outputs of_root(count_of(at_root.rect), 3u);
        require_right(at_root, everywhere(), of_root, seen);
    }
}

TEST_CASE("where a coordinate is 0 along an edge in a row or a column of fragments it is 0, and all else is right") {
    Random random(453);
    Seen seen;
    int zeros = 0, both = 0;
    for (int i = 0; i < 1000; ++i) {
        const Shot shot = support::detail::zeros_along_edges(random);
        const auto side = [&](double other) { return random.coin() ? 0.0 : other; };
        texgen::TextureRegion region = texgen::atlas_tile({side(-HUGE_VAL), side(-1.0)}, {side(HUGE_VAL), side(1.0)});
        if (random.integer(0, 2) == 0) region = region.with_depth(side(-HUGE_VAL), side(1.0));
        const texgen::Tolerance tolerance{random.integer(0, 2) != 0 ? 0.0 : random.power_of_ten(-9.0, -1.0)};
        const auto setup = TriangleSetup::of(shot.triangle, region, tolerance);
        if (!setup) continue;
        const ExactTriangle exact(shot.triangle);
        for (const unsigned asked : {Outputs::all, static_cast<unsigned>(random.integer(1, 15)), 3u, 8u}) {
            Outputs out(count_of(shot.rect), asked, static_cast<std::size_t>(random.integer(0, 16)));
            const Work work = interpolate(*setup, shot.rect, out.spans());
            const std::string wrong = first_wrong(shot, exact, region, tolerance, work, out, seen);
            REQUIRE_MESSAGE(wrong.empty(), wrong, " of ", asked, ", ", hex(region), ", ", hex(tolerance.value), " in ",
                            hex(shot));
            REQUIRE_MESSAGE(out.pads_are_intact(), hex(shot));
            for (std::size_t n = 0; work != Work::nothing && asked == 3u && n < out.size(); ++n) {
                zeros += out.s()[n] == 0.0f || out.t()[n] == 0.0f;
                both += out.s()[n] == 0.0f && out.t()[n] == 0.0f;
            }
        }
    }
    CHECK(zeros > 1500);
    CHECK(both > 40);
    CHECK(seen.lit > 5000);
    CHECK(seen.dark > 5000);
}

}  // namespace row_cases
