// Triangles in the exact tier: every fragment is the nearest float of the exact rational, wherever and however it is
// asked for.

#include "texgen/interpolate.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "judges/fragments.hpp"
#include "support/hard_triangles.hpp"
#include "support/near_cut.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "texgen/reference.hpp"

namespace {

using support::count_of;
using support::everywhere;
using support::ExactTriangle;
using support::HardFamily;
using support::hex;
using support::Outputs;
using support::Random;
using support::same_bits;
using support::Seen;
using support::setup_of;
using support::Shot;
using support::text;
using support::vertices;
using texgen::FragmentRect;
using texgen::Tolerance;
using texgen::Triangle;
using texgen::TriangleSetup;
using texgen::WindowVertex;
using texgen::Work;

// The widths at which something ends: vectors, units of 64 fragments, chunks of 128 and 256, strips of 512.
std::vector<int> awkward_widths() {
    std::vector<int> widths;
    for (int width = 1; width <= 71; ++width) widths.push_back(width);
    for (const int middle : {128, 131, 192, 257, 320, 512, 516}) {
        for (int width = middle - 3; width <= middle + 3; ++width) widths.push_back(width);
    }
    return widths;
}

// A row as a column.
Shot mirrored(Shot shot) {
    for (WindowVertex* const vertex : {&shot.triangle.a, &shot.triangle.b, &shot.triangle.c})
        std::swap(vertex->window.x, vertex->window.y);
    std::swap(shot.rect.x, shot.rect.y);
    std::swap(shot.rect.width, shot.rect.height);
    return shot;
}

// And a row as the column of the mirrored triangle, too.
void require_right(const Shot& shot, const texgen::TextureRegion& region, Outputs& out, Seen& seen) {
    const Work work = interpolate(setup_of(shot.triangle, region), shot.rect, out.spans());
    const std::string wrong = first_wrong(shot, ExactTriangle(shot.triangle), region, texgen::exact, work, out, seen);
    REQUIRE_MESSAGE(wrong.empty(), wrong, " in ", hex(shot));
    REQUIRE_MESSAGE(out.pads_are_intact(), hex(shot));
    if (shot.rect.height == 1 && shot.rect.width > 1) require_right(mirrored(shot), region, out, seen);
}

// s at fragment i of every row is (2 m + 1) 2^-25 for some integer m: the middle of two floats. q/w is constant.
Shot row_of_ties(int width, int height, Random& random) {
    const int x = random.integer(-100, 100), y = random.integer(-100, 100);
    const int step = 2 * random.integer(1, 1000) + 1;
    const int first = random.integer(1 << 23, (1 << 23) + (1 << 22));
    const auto vertex = [&](int column, int row) {
        const auto s = static_cast<float>(first + step * column) * 0x1p-24f;
        return WindowVertex{{static_cast<float>(x + column), static_cast<float>(y + row)}, 1.0f, {s, s, s, 1.0f}};
    };
    return {{vertex(0, 0), vertex(1024, 0), vertex(random.integer(0, 2), 1024)}, {x, y, width, height}};
}

// Such an s at every fragment, or at every third, but the corners' y have up to 50 bits more than their x: what the
// functions are made of is too long for two doubles.
Shot ties_of_long_numbers(int width, int height, Random& random) {
    const int x = random.integer(-100, 100), y = random.integer(-100, 100);
    const int step = 2 * random.integer(1, 1000) + 1;
    const int first = random.integer(1 << 23, (1 << 23) + (1 << 22));
    const int columns = random.coin() ? 1 : 3;
    const auto vertex = [&](int column, float row) {
        const auto s = static_cast<float>(first + step * column) * 0x1p-24f;
        return WindowVertex{
            {static_cast<float>(x + columns * column), row}, 1.0f, {s, random.uniform_float(0.0, 1.0), s, 1.0f}};
    };
    return {{vertex(0, random.uniform_float(0.0, 0x1p-12)), vertex(1000, random.uniform_float(0x1p28, 0x1p30)),
             vertex(random.integer(0, 2), random.uniform_float(0.0, 1e3))},
            {x, y, width, height}};
}

// s/q is the same everywhere while q varies, and is so near to the middle of two floats that no bound in double can
// tell: with an odd m of 25 bits and m q = 1 (mod 2^24), s = (m q - 1) / 2^24 is m q / 2^24 up to 2^-48 of itself.
Shot near_ties_with_varying_q(int width, int height, Random& random) {
    std::int64_t m = 0, q = 0, s = 0;
    do {
        m = 2 * static_cast<std::int64_t>(random.integer(1 << 23, (1 << 24) - 1)) + 1;
        std::uint64_t inverse = 1;  // of m, modulo 2^24: Newton's iteration doubles its right bits
        for (int j = 0; j < 6; ++j) inverse *= 2u - static_cast<std::uint64_t>(m) * inverse;
        q = static_cast<std::int64_t>((random.coin() ? inverse : 0u - inverse) & 0xffffffu);
        s = (m * q + (1 << 23)) >> 24;
    } while (q < (1 << 23) || s >= (1 << 24));
    const int x = random.integer(-100, 100), y = random.integer(-100, 100);
    const auto vertex = [&](int column, int row) {
        const float scale = std::ldexp(1.0f, random.integer(-26, -22));
        const glm::vec4 strq{static_cast<float>(s) * scale, static_cast<float>(s) * scale,
                             static_cast<float>(s) * scale, static_cast<float>(q) * scale};
        return WindowVertex{{static_cast<float>(x + column), static_cast<float>(y + row)}, 1.0f, strq};
    };
    return {{vertex(-7, -5), vertex(1031, 2), vertex(3, 1033)}, {x, y, width, height}};
}

// s/q grows along a row and is, at one column alone, the middle M of two floats. With q = 1 + t for t = (2 column + 1)
// / 2048, and k = 2 column + 1, in units of 2^-25: (M - j k) (1 - t) + (2 M + j (2048 - k)) t = M (1 + t).
Shot row_with_a_tie(int column, int width, int height, Random& random) {
    const int k = 2 * column + 1;
    std::int64_t first = 0, last = 0;
    do {
        const int middle = 2 * random.integer(1 << 23, (1 << 24) - 1) + 1;
        const int j = 4 * random.integer((middle - (1 << 24)) / (4 * k), (middle - (1 << 23)) / (4 * k) - 1) + 2;
        first = middle - std::int64_t{j} * k;
        last = 2 * middle + std::int64_t{j} * (2048 - k);
    } while (last >= 1 << 26 || last < 1 << 25 || first >= 1 << 24);  // they are floats then
    const int x = random.integer(-100, 100), y = random.integer(-100, 100);
    const auto vertex = [&](int at_x, int at_y, std::int64_t s, float q) {
        const float value = static_cast<float>(s) * 0x1p-25f;
        return WindowVertex{
            {static_cast<float>(x + at_x), static_cast<float>(y + at_y)}, 1.0f, {value, value, value, q}};
    };
    return {{vertex(0, 0, first, 1.0f), vertex(1024, 0, last, 2.0f), vertex(0, 1024, first, 1.0f)},
            {x, y, width, height}};
}

// Small tiles that one certificate serves are those of regions without negative coordinates, as the whole texture is.
const texgen::TextureRegion positive = texgen::atlas_tile({0.0, 0.0}, {4.0, 4.0});

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

FragmentRect small_rect(Random& random) {
    return {random.integer(100, 400), random.integer(100, 400), random.integer(1, 12), random.integer(1, 8)};
}

}  // namespace

TEST_CASE("every fragment is the nearest float of the exact rational, in every family") {
    std::uint64_t seed = 100;
    Seen everything;
    for (const HardFamily& family : support::hard_families) {
        CAPTURE(std::string(family.name));
        Random random(++seed);
        constexpr int members = 200;
        int hard = 0;
        Seen seen;
        for (int i = 0; i < members; ++i) {
            const Shot shot = family.make(random);
            hard += family.is_hard(shot, ExactTriangle(shot.triangle));
            Outputs out(count_of(shot.rect), Outputs::all, static_cast<std::size_t>(random.integer(0, 15)));
            const texgen::TextureRegion region = random.coin()
                                                     ? support::region_at(shot, ExactTriangle(shot.triangle), random)
                                                     : texgen::whole_texture();
            require_right(shot, random.integer(0, 2) == 0 ? region : everywhere(), out, seen);
        }
        CHECK(hard >= family.least_share * members);
        CHECK(seen.in_front > 500);
        everything += seen;
    }
    CHECK(everything.behind > 1000);
    CHECK(everything.on_plane > 50);
    CHECK(everything.subnormal > 500);
    CHECK(everything.infinite > 500);
    CHECK(everything.lit > 10000);
    CHECK(everything.dark > 10000);
}

TEST_CASE(
    "what the near plane cuts is the nearest float in every order of the corners, and with a tolerance inside of it") {
    Random random(4711);
    Seen seen;
    int far_first = 0;
    for (int i = 0; i < 300; ++i) {
        const auto [triangle, rect] = support::near_cut(random, random.integer(1, 70), random.integer(1, 3));
        for (int order = 0; order < 3; ++order) {
            const Shot shot{support::rotated(triangle, order), rect};
            far_first += std::fabs(shot.triangle.a.window.x) > 1e4f;
            for (const texgen::Tolerance tolerance : {texgen::exact, texgen::texels(1.0 / 512.0, 4096.0)}) {
                Outputs out(count_of(rect));
                const Work work = interpolate(setup_of(shot.triangle, everywhere(), tolerance), rect, out.spans());
                const std::string wrong =
                    first_wrong(shot, ExactTriangle(shot.triangle), everywhere(), tolerance, work, out, seen);
                REQUIRE_MESSAGE(wrong.empty(), wrong, " in ", hex(shot));
                REQUIRE_MESSAGE(out.pads_are_intact(), hex(shot));
            }
        }
    }
    CHECK(far_first > 100);
    CHECK(seen.behind > 500);
    CHECK(seen.in_front > 10000);
}

TEST_CASE("every fragment of a row whose values all lie between two floats is decided, at every width") {
    Random random(200);
    int ties = 0;
    for (const auto make : {row_of_ties, near_ties_with_varying_q, ties_of_long_numbers}) {
        for (const int width : awkward_widths()) {
            if (make == ties_of_long_numbers && width > 71) break;
            for (const int height : {1, 3}) {
                const Shot shot = make(width, height, random);
                const ExactTriangle exact(shot.triangle);
                for (const int column : {0, width - 1}) {
                    const support::Quotient u = exact.at(shot.x(column), shot.y(0)).over_q(0);
                    ties += make == ties_of_long_numbers && support::is_tie(u);
                    REQUIRE((make == row_of_ties                ? support::is_tie(u)
                             : make == near_ties_with_varying_q ? support::distance_to_tie(u) < 0x1p-46
                                                                : true));
                }
                Seen seen;
                for (const unsigned asked : {15u, 1u, 4u, 8u}) {
                    for (const texgen::TextureRegion& region : {everywhere(), positive}) {
                        Outputs out(count_of(shot.rect), asked, static_cast<std::size_t>(random.integer(0, 15)));
                        require_right(shot, region, out, seen);
                    }
                }
            }
        }
    }
    CHECK(ties > 50);
}

TEST_CASE("one tie anywhere in rows of values that are far from ties is rounded to the even float") {
    Random random(201);
    Seen seen;
    int long_ones = 0;  // so long that no one certificate is asked for
    for (int i = 0; i < 120; ++i) {
        const bool is_long = i % 2 == 0;
        const int width = random.integer(is_long ? 70 : 16, is_long ? 1500 : 300), height = random.integer(1, 3),
                  column = random.integer(is_long ? 64 : 0, std::min(width, 900) - 1);
        long_ones += width * height > 512;
        const Shot shot = row_with_a_tie(column, width, height, random);
        REQUIRE(support::is_tie(ExactTriangle(shot.triangle).at(shot.x(column), shot.y(0)).over_q(0)));
        for (const texgen::TextureRegion& region : {everywhere(), positive}) {
            Outputs out(count_of(shot.rect), random.coin() ? 15u : 3u, static_cast<std::size_t>(random.integer(0, 15)));
            require_right(shot, region, out, seen);
        }
    }
    CHECK(long_ones > 20);
    CHECK(long_ones < 100);
}

TEST_CASE("a tie that a corner 2^-20 to 2^-100 of a pixel off its place leaves is rounded to its side") {
    Random random(202);
    Seen seen;
    int ties = 0, constant = 0;
    for (int i = 0; i < 900; ++i) {
        const int width = random.integer(4, 64), height = random.integer(1, 8), column = random.integer(0, width - 1);
        // Of a q/w that is constant where the third corner stands below the first.
        Shot shot = row_of_ties(width, height, random);
        if (i % 3 != 0 || shot.triangle.c.window.x != static_cast<float>(shot.rect.x))
            shot = row_with_a_tie(column, width, height, random);
        constant += shot.triangle.a.strq.w == shot.triangle.b.strq.w;
        for (WindowVertex* vertex : {&shot.triangle.a, &shot.triangle.b, &shot.triangle.c})
            vertex->window.x -= static_cast<float>(shot.rect.x);
        shot.rect.x = 0;
        // Every other one of so many bits that no residue holds them.
        const float bits = i % 2 == 0 ? 1.0f : random.uniform_float(1.0, 2.0);
        shot.triangle.c.window.x = std::ldexp(random.coin() ? bits : -bits, random.integer(-100, -20));
        if (i % 2 != 0) shot.triangle.c.window.y = random.uniform_float(512.0, 1024.0);
        ties += support::is_tie(ExactTriangle(shot.triangle).at(shot.x(column), shot.y(0)).over_q(0));
        for (const texgen::TextureRegion& region : {everywhere(), positive}) {
            Outputs out(count_of(shot.rect), random.coin() ? 15u : 3u, static_cast<std::size_t>(random.integer(0, 15)));
            require_right(shot, region, out, seen);
        }
    }
    CHECK(ties == 0);
    CHECK(constant > 50);
}

TEST_CASE("a tie far down a row from where s is largest is rounded to the even float, and beside it to its side") {
    Random random(203);
    Seen seen;
    for (int i = 0; i < 100; ++i) {
        const int column = random.integer(993, 1015);
        Shot shot = support::steep_row_with_a_tie(column, random);
        shot.rect = {0, 0, column + random.integer(1, 4), random.integer(2, 3)};
        REQUIRE(support::is_tie(ExactTriangle(shot.triangle).at(column, 0).over_q(0)));
        if (i % 2 != 0) shot.triangle.c.window.x = std::ldexp(random.coin() ? 1.0f : -1.0f, random.integer(-60, -40));
        Outputs out(count_of(shot.rect), 3u);
        require_right(shot, everywhere(), out, seen);
    }
}

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

TEST_CASE("a tie on a side is a tie wherever the row begins, and whatever the numbers of the far corner are") {
    Random random(205);
    Seen seen;
    for (int i = 0; i < 400; ++i) {
        const int column = random.integer(0, 200);
        Shot shot = row_with_a_tie(column, 1, 1, random);
        const int x = shot.rect.x + column, y = shot.rect.y;
        shot.triangle.a.window.y = shot.triangle.b.window.y = static_cast<float>(y) + 0.5f;
        // Of few bits, and t is 0; or of more than a double has, and w is not 1.
        glm::vec2& far_corner = shot.triangle.c.window;
        if (i % 2 == 0) {
            far_corner = {0.5f * static_cast<float>(random.integer(-9, 9)),
                          static_cast<float>(y) + 0.5f * static_cast<float>(random.integer(2, 8))};
            for (WindowVertex* vertex : vertices(shot.triangle)) vertex->strq.y = 0.0f;
        } else {
            far_corner = {std::ldexp(1.0f, random.integer(-60, -30)),
                          static_cast<float>(y) + random.uniform_float(1.0, 64.0)};
            for (WindowVertex* vertex : vertices(shot.triangle)) {
                const float w = std::ldexp(1.0f, random.integer(-3, 3));
                vertex->clip_w *= w;
                vertex->strq *= w;
            }
            shot.triangle.c.clip_w = random.uniform_float(4.0, 16.0);
        }
        shot.triangle = support::rotated(shot.triangle, random.integer(0, 2));
        shot.rect = {x - random.integer(0, column), y, random.integer(1, 300), 1};
        REQUIRE(support::is_tie(ExactTriangle(shot.triangle).at(x, y).over_q(0)));
        Outputs out(count_of(shot.rect), 3u);
        require_right(shot, everywhere(), out, seen);
    }
}

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
        for (const int height : {1, 2, 3, 8, 31}) {
            if (width * height > 2000) continue;
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
            const Tolerance tolerance = random.coin() ? texgen::exact : texgen::texels(1.0 / 512.0, 4096.0);
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

TEST_CASE("where a coordinate is 0 along an edge in a row or a column of fragments it is 0, and all else is right") {
    Random random(453);
    Seen seen;
    int zeros = 0, both = 0;
    for (int i = 0; i < 1000; ++i) {
        const Shot shot = support::detail::zeros_along_edges(random);
        const auto side = [&](double other) { return random.coin() ? 0.0 : other; };
        texgen::TextureRegion region = texgen::atlas_tile({side(-HUGE_VAL), side(-1.0)}, {side(HUGE_VAL), side(1.0)});
        if (random.integer(0, 2) == 0) region = region.with_depth(side(-HUGE_VAL), side(1.0));
        const Tolerance tolerance{random.integer(0, 2) != 0 ? 0.0 : random.power_of_ten(-9.0, -1.0)};
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

TEST_CASE("the order of the vertices and the winding do not change a bit") {
    std::uint64_t seed = 500;
    for (const HardFamily& family : support::hard_families) {
        Random random(++seed);
        for (int i = 0; i < 20; ++i) {
            const Shot shot = family.make(random);
            const auto& [a, b, c] = shot.triangle;
            Outputs first(count_of(shot.rect));
            const Work work = interpolate(setup_of(shot.triangle), shot.rect, first.spans());
            for (const Triangle& other :
                 {Triangle{b, c, a}, Triangle{c, a, b}, Triangle{a, c, b}, Triangle{c, b, a}, Triangle{b, a, c}}) {
                Outputs out(count_of(shot.rect));
                const Work other_work = interpolate(setup_of(other), shot.rect, out.spans());
                if (work == Work::nothing || other_work == Work::nothing) continue;  // another rounding may not see it
                for (std::size_t k = 0; k < 4; ++k)
                    REQUIRE_MESSAGE(same_bits(out[k], first[k]), family.name, ": ", hex(shot));
            }
        }
    }
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

TEST_CASE("no setup comes of a number that is not finite, of a w that is not positive, or of no area") {
    Random random(700);
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const float bad_numbers[] = {infinity, -infinity, std::numeric_limits<float>::quiet_NaN(),
                                 std::bit_cast<float>(0xff812345u), std::bit_cast<float>(0x7f800001u)};
    for (int i = 0; i < 50; ++i) {
        const Triangle good = make_triangle(support::families[static_cast<std::size_t>(i) % 8], random);
        REQUIRE(TriangleSetup::of(good, everywhere()).has_value());
        for (std::size_t vertex = 0; vertex < 3; ++vertex) {
            for (std::size_t field = 0; field < 7; ++field) {
                for (const float number : bad_numbers) {
                    Triangle bad = good;
                    WindowVertex& v = *vertices(bad)[vertex];
                    (field < 2    ? v.window[static_cast<int>(field)]
                     : field == 2 ? v.clip_w
                                  : v.strq[static_cast<int>(field) - 3]) = number;
                    REQUIRE_MESSAGE(!TriangleSetup::of(bad, everywhere()), hex(bad));
                }
            }
            for (const float w :
                 {0.0f, -0.0f, -1.0f, -std::numeric_limits<float>::denorm_min(), -std::numeric_limits<float>::max()}) {
                Triangle bad = good;
                vertices(bad)[vertex]->clip_w = w;
                REQUIRE_MESSAGE(!TriangleSetup::of(bad, everywhere()), hex(bad));
            }
        }
    }
}

TEST_CASE("collinear vertices have no setup at any magnitude; one unit beside the line they have one") {
    Random random(800);
    int nudged_apart = 0, least_exponent = 0;
    for (int i = 0; i < 4000; ++i) {
        // Integers of 11 bits, so that p + k d is a float; scaled by powers of two.
        const int exponent_x = random.integer(-140, 100), exponent_y = random.integer(-140, 100);
        const auto point = [&](int k, const glm::ivec2& p, const glm::ivec2& d) {
            return glm::vec2(std::ldexp(static_cast<float>(p.x + k * d.x), exponent_x),
                             std::ldexp(static_cast<float>(p.y + k * d.y), exponent_y));
        };
        const glm::ivec2 p{random.integer(-2000, 2000), random.integer(-2000, 2000)};
        const glm::ivec2 d{random.integer(-2000, 2000), random.integer(-2000, 2000)};
        Triangle triangle = make_triangle(support::Family::friendly, random);
        triangle.a.window = point(random.integer(-99, 99), p, d);
        triangle.b.window = point(random.integer(-99, 99), p, d);
        triangle.c.window = point(random.integer(-99, 99), p, d);
        REQUIRE_MESSAGE(!TriangleSetup::of(triangle, everywhere()), hex(triangle));
        if (d.x == 0 || triangle.a.window == triangle.b.window) continue;
        triangle.c.window.y = support::neighbour(triangle.c.window.y, random.coin() ? 1 : -1);
        REQUIRE_MESSAGE(TriangleSetup::of(triangle, everywhere()).has_value(), hex(triangle));
        ++nudged_apart;
        least_exponent = std::min(least_exponent, std::ilogb(std::fabs(support::twice_area(triangle))));
    }
    CHECK(nudged_apart > 3000);
    CHECK(least_exponent < -250);
}

TEST_CASE("a sliver of area 2^-140 has a setup, and its fragments are the nearest floats") {
    Random random(900);
    Seen seen;
    for (int i = 0; i < 400; ++i) {
        Triangle triangle = make_triangle(support::Family::friendly, random);
        // (0, 0) lies on the long edge; the third vertex is 2^-k away from it.
        const int along = random.integer(0, 8);
        const float length = std::ldexp(1.0f, along);
        const float height = std::ldexp(1.0f, -140 - along) * (random.coin() ? 1.0f : -1.0f);
        const bool upright = random.coin();
        const auto at = [&](float x, float y) { return upright ? glm::vec2(x, y) : glm::vec2(y, x); };
        triangle.a.window = at(-length, 0.0f);
        triangle.b.window = at(length, 0.0f);
        triangle.c.window = at(random.uniform_float(-1.0, 1.0) * length, height);
        for (WindowVertex* vertex : vertices(triangle))
            if (i % 2 == 0) vertex->clip_w = 1.0f;
        const Shot shot{triangle, support::detail::rect_about(0, 0, random)};
        Outputs out(count_of(shot.rect));
        require_right(shot, everywhere(), out, seen);
    }
    CHECK(seen.in_front > 5000);
}

TEST_CASE("triangles of random bits are refused, or interpolated to the nearest floats") {
    Random random(1000);
    Seen seen;
    int accepted = 0;
    for (int i = 0; i < 40000; ++i) {
        Triangle triangle{};
        const bool mostly_usable = random.coin();
        for (WindowVertex* vertex : vertices(triangle)) {
            const auto any = [&] { return mostly_usable ? random.any_finite() : random.any_float(); };
            for (int k = 0; k < 2; ++k) vertex->window[k] = any();
            for (int k = 0; k < 4; ++k) vertex->strq[k] = any();
            vertex->clip_w = mostly_usable ? std::fabs(any()) : any();
        }
        const texgen::TextureRegion region =
            texgen::atlas_tile({random.any_float(), random.any_float()}, {random.any_float(), random.any_float()});
        const std::optional<TriangleSetup> setup = TriangleSetup::of(triangle, region);
        if (!setup) continue;
        ++accepted;
        const Shot shot{triangle, support::detail::rect_about(
                                      random.coin() ? 0 : static_cast<int>(random.uniform(-2147483000.0, 2147483000.0)),
                                      random.integer(-2000, 2000), random)};
        if (accepted % 8 == 0) {
            Outputs out(count_of(shot.rect));
            require_right(shot, random.coin() ? region : everywhere(), out, seen);
        } else {
            const glm::dvec2 bound = setup->error_bound({shot.rect.x, shot.rect.y, 1, 1});
            REQUIRE(bound.x >= 0.0);
            REQUIRE(bound.y >= 0.0);
        }
    }
    CHECK(accepted > 10000);
    CHECK(seen.in_front > 10000);
}

TEST_CASE("coordinates that are 0, of either sign, come out as +0") {
    Random random(1100);
    for (int i = 0; i < 100; ++i) {
        Shot shot =
            support::detail::ordinary(random.coin() ? support::Family::friendly : support::Family::crossing, random);
        for (WindowVertex* vertex : vertices(shot.triangle)) {
            vertex->strq.x = random.coin() ? 0.0f : -0.0f;
            vertex->strq.z = -0.0f;
        }
        Outputs out(count_of(shot.rect));
        if (interpolate(setup_of(shot.triangle), shot.rect, out.spans()) == Work::nothing) continue;
        for (const float s : out.s()) REQUIRE_MESSAGE(same_bits(s, 0.0f), hex(shot));
        for (const float r : out.r()) REQUIRE_MESSAGE(same_bits(r, 0.0f), hex(shot));
    }
}

TEST_CASE("the reference in double agrees within the accuracy that it states") {
    std::uint64_t seed = 1200;
    int compared = 0, different = 0;
    for (const support::Family family : support::families) {
        Random random(++seed);
        for (int i = 0; i < 60; ++i) {
            Shot shot = support::detail::ordinary(family, random);
            Outputs fast(count_of(shot.rect)), reference(count_of(shot.rect));
            if (interpolate(setup_of(shot.triangle), shot.rect, fast.spans()) == Work::nothing) continue;
            texgen::reference::interpolate(shot.triangle, everywhere(), shot.rect, reference.spans());
            // interpolation_error's formula, its terms exactly.
            Triangle absolute = shot.triangle;
            const ExactTriangle exact(shot.triangle);
            for (std::size_t j = 0; j < fast.size(); ++j) {
                const std::int64_t x = shot.rect.x + static_cast<std::int64_t>(j) % shot.rect.width;
                const std::int64_t y = shot.rect.y + static_cast<std::int64_t>(j) / shot.rect.width;
                if (!exact.has_positive_w(x, y)) continue;
                const std::array corners{absolute.a, absolute.b, absolute.c};
                double size[4] = {};
                for (std::size_t v = 0; v < 3; ++v) {
                    const glm::dvec2 p(corners[(v + 1) % 3].window), q(corners[(v + 2) % 3].window);
                    const glm::dvec2 centre(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
                    const double edge = (p.x - centre.x) * (q.y - centre.y) - (p.y - centre.y) * (q.x - centre.x);
                    const double weight = std::fabs(edge) * static_cast<double>(corners[(v + 1) % 3].clip_w) *
                                          static_cast<double>(corners[(v + 2) % 3].clip_w);
                    for (int k = 0; k < 4; ++k)
                        size[k] += 1.001 * weight * std::fabs(static_cast<double>(corners[v].strq[k]));
                }
                const support::Homogeneous at = exact.at(x, y);
                const double q = at.q.estimate();
                const double error = texgen::reference::interpolation_error;
                if (!(std::fabs(q) > error * size[3])) continue;
                ++compared;
                const bool in_front = q > 0.0;
                REQUIRE_MESSAGE((fast.lit()[j] == reference.lit()[j]), hex(shot));
                for (std::size_t k = 0; k < 3; ++k) {
                    const double a = static_cast<double>(fast[k][j]), b = static_cast<double>(reference[k][j]);
                    different += a != b;
                    const double allowed =
                        error * (size[k] + std::fabs(a) * size[3]) / (std::fabs(q) - error * size[3]);
                    const double ulp = std::nextafter(std::fabs(fast[k][j]), HUGE_VALF) - std::fabs(fast[k][j]);
                    REQUIRE_MESSAGE((in_front ? std::fabs(a - b) <= 1.001 * allowed + ulp : a == b), hex(shot));
                    if (allowed < 0.001 * ulp) REQUIRE(std::fabs(a - b) <= ulp);
                }
            }
        }
    }
    CHECK(compared > 20000);
    CHECK(different < compared / 100);
}
