// Quotients half-way between two floats, and next to it, are rounded to the right side, in every row.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "api/interpolate_test/rows.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "support/hard_triangles.hpp"
#include "support/near_cut.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"

namespace row_cases {

namespace {

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

}  // namespace

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

}  // namespace row_cases
