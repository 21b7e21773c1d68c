// A batch gives every fragment what a TriangleSetup of its triangle does.

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/verdict.hpp"
#include "support/footprint_outputs.hpp"
#include "support/hard_triangles.hpp"
#include "support/hex.hpp"
#include "support/near_cut.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "texgen/batch.hpp"
#include "texgen/surface.hpp"

namespace {

using support::count_of;
using support::Outputs;
using support::Random;
using support::Shot;
using texgen::FragmentRect;
using texgen::no_triangle;
using texgen::Tolerance;
using texgen::Triangle;
using texgen::TriangleBatch;
using texgen::TriangleSetup;
using texgen::Work;

// Not to be accepted: a number that is none, a w that is not positive, no area.
Triangle refused(Random& random) {
    Triangle triangle = support::make_triangle(support::Family::friendly, random);
    texgen::WindowVertex& vertex = random.coin() ? triangle.b : triangle.c;
    switch (random.integer(0, 4)) {
        case 0:
            vertex.strq[random.integer(0, 3)] = std::numeric_limits<float>::quiet_NaN();
            break;
        case 1:
            vertex.window.x = std::numeric_limits<float>::infinity();
            break;
        case 2:
            vertex.clip_w = random.coin() ? 0.0f : -1.0f;
            break;
        case 3:
            vertex.clip_w = std::numeric_limits<float>::quiet_NaN();
            break;
        default:
            vertex.window = triangle.a.window;
            break;
    }
    return triangle;
}

// An area whose sign doubles leave open.
Shot almost_without_area(Random& random) {
    const float tiny = std::ldexp(random.coin() ? 1.0f : -1.0f, random.integer(-45, -38));
    Triangle triangle = support::make_triangle(support::Family::friendly, random);
    triangle.a.window = {tiny, 0.0f};
    triangle.b.window = {0x1p20f, 0x1p20f};
    triangle.c.window = {0x1p21f, 0x1p21f};
    return {triangle, {random.integer(0, 9), random.integer(0, 9), 4, 3}};
}

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

// q/w grows several times over a tile.
Shot steep(Random& random) {
    Triangle triangle = support::make_triangle(support::Family::friendly, random);
    const double size = random.uniform(16.0, 60.0);
    triangle.a.window = {0.0f, 0.0f};
    triangle.b.window = {support::to_float(size), 0.0f};
    triangle.c.window = {0.0f, support::to_float(size)};
    const double ratio = random.uniform(1.0, 12.0);
    for (glm::length_t k = 0; k < 4; ++k) triangle.b.strq[k] = support::to_float(triangle.b.strq[k] * ratio);
    return {triangle, {random.integer(0, 9), random.integer(0, 9), 8, 8}};
}

// Where pixels leave the ints u is half-way at every fragment, s = t = 2^-24 x - 127.5, but for a corner that is off
// its place.
Shot ties_at_the_last_int(Random& random) {
    const float off = std::ldexp(random.coin() ? 1.0f : -1.0f, random.integer(-80, -20));
    const auto corner = [](float x, float y, float u) {
        return texgen::WindowVertex{{x, y}, 1.0f, {u, u, 0.25f, 1.0f}};
    };
    return {{corner(off, 0.0f, -127.5f), corner(0x1p31f, 0.0f, 0.5f), corner(0.0f, 0x1p31f, -127.5f)},
            {0x7fffffff - random.integer(0, 7), random.integer(0, 9), random.integer(1, 16), random.integer(1, 4)}};
}

// u = 1/2 + 2^-24 (a x + b y) at w = q is half-way between two floats at every fragment of the tile, or next to it: a
// corner may be `off` the pixels' by less than a double sees in u.
Shot ties_everywhere(Random& random, float off = 1.0f) {
    const int dx = 2 * random.integer(0, 3) + 1, dy = 2 * random.integer(0, 3);
    const float w = std::ldexp(random.coin() ? 1.0f : 1.5f, random.integer(-3, 3));
    const float sign = random.coin() ? 1.0f : -1.0f;
    const int far = random.integer(20, 1000);
    const auto corner = [&](int x, int y) {
        const double s = 0.5 + std::ldexp(dx * x + dy * y, -24), t = 0.5 + std::ldexp(dy * x + dx * y, -24);
        return texgen::WindowVertex{
            glm::vec2(x, y), w, {sign * support::to_float(s), support::to_float(t), 0.25f, 1.0f}};
    };
    Triangle triangle{corner(0, 0), corner(far, 0), corner(0, far)};
    if (random.coin()) triangle.a.window.x = std::ldexp(random.coin() ? off : -off, random.integer(-60, -20));
    if (random.coin()) triangle.b.window.y = std::ldexp(random.coin() ? off : -off, random.integer(-60, -20));
    if (random.coin()) std::swap(triangle.b, triangle.c);
    return {triangle, {random.integer(0, 3), random.integer(0, 3), 8, 8}};
}

Shot draw(Random& random) {
    Shot shot{};
    const int kind = random.integer(0, 33);
    if (kind >= 32) {
        shot = support::detail::zeros_along_edges(random);
    } else if (kind < 18) {
        shot = support::hard_families[static_cast<std::size_t>(kind)].make(random);
    } else if (kind < 21) {
        const support::NearCut cut = support::near_cut(random, random.integer(1, 20), random.integer(1, 8));
        shot = {cut.triangle, cut.rect};
    } else if (kind < 23) {
        shot = {refused(random), {random.integer(-9, 9), random.integer(-9, 9), 3, 5}};
    } else if (kind == 23) {
        shot = almost_without_area(random);
    } else if (kind == 24) {
        return ties_at_the_last_int(random);
    } else if (kind >= 30) {
        shot = ties_everywhere(random);
    } else {
        shot = kind < 27 ? steep(random) : support::hard_families[0].make(random);
    }
    switch (random.integer(0, 11)) {
        case 0:
            shot.rect.width = shot.rect.height = 8;
            break;
        case 1:
            shot.rect.width = 64, shot.rect.height = 1;
            break;
        case 2:
            shot.rect.width = 1, shot.rect.height = random.integer(1, 40);
            break;
        case 3:
            shot.rect.width = random.coin() ? 0 : 3, shot.rect.height = 0;
            break;
        case 4:
            shot.rect.width = 16, shot.rect.height = random.integer(1, 8);
            break;
        default:
            break;
    }
    if (random.integer(0, 15) == 0) shot.rect.width = random.integer(1, 80), shot.rect.height = random.integer(1, 40);
    return shot;
}

texgen::TextureRegion draw_region(Random& random) {
    const texgen::TextureRegion region = [&] {
        switch (random.integer(0, 3)) {
            case 0:
                return support::everywhere();
            case 1:
                return texgen::atlas_tile({0.25, 0.125}, {0.5, 0.75});
            default:
                return texgen::whole_texture();
        }
    }();
    switch (random.integer(0, 5)) {
        case 0:
            return region.with_depth();
        case 1:
            return region.with_depth(random.uniform(-1.0, 1.0), random.uniform(0.0, 4.0));
        case 2: {
            constexpr double infinity = std::numeric_limits<double>::infinity();
            const double limit = random.uniform(-1.0, 2.0);
            return random.coin() ? region.with_depth(limit, infinity) : region.with_depth(-infinity, limit);
        }
        default:
            return region;
    }
}

// What a TriangleSetup writes for a rectangle, and whether it writes s, t and r; 0 where there is none.
struct Expected {
    Outputs out;
    Work work = Work::nothing;

    Expected(const Triangle& triangle, const texgen::TextureRegion& region, const FragmentRect& rect, unsigned asked,
             Tolerance tolerance)
        : out(count_of(rect), asked) {
        if (const auto setup = TriangleSetup::of(triangle, region, tolerance))
            work = interpolate(*setup, rect, out.spans());
    }
};

// Whether `count` values of a batch from `first` on are what a setup says with `exact` of those from `alone` on.
bool agree(const Expected& expected, std::size_t alone, const Outputs& out, std::size_t first, std::size_t count) {
    bool all = true;
    for (std::size_t k = 0; k < 4; ++k) {
        if (!out.asked(k)) continue;
        for (std::size_t i = 0; i < count; ++i) {
            const float value = out[k][first + i];
            if (expected.work != Work::nothing)
                all = all && support::same_bits(value, expected.out[k][alone + i]);
            else
                all = all && (k == 3 ? support::same_bits(value, 0.0f) : !Outputs::is_poison(value));
        }
    }
    return all;
}

struct Drawn {
    std::vector<Triangle> triangles;
    std::vector<FragmentRect> rects;
    std::size_t fragments = 0;

    Drawn(Random& random, int count) {
        for (int i = 0; i < count; ++i) {
            const Shot shot = draw(random);
            triangles.push_back(shot.triangle);
            rects.push_back(shot.rect);
            fragments += count_of(shot.rect);
        }
    }
};

// The long runs of one id in the rows: where each begins, and how many fragments it has.
std::vector<std::pair<std::size_t, std::size_t>> long_runs(const std::vector<std::uint32_t>& ids, std::size_t width) {
    std::vector<std::pair<std::size_t, std::size_t>> runs;
    for (std::size_t begin = 0, end = 0; begin < ids.size(); begin = end) {
        while (end < (begin / width + 1) * width && ids[end] == ids[begin]) ++end;
        const bool is_long = end - begin >= texgen::detail::long_run;
        const auto is_next_row_the_same = [&] {
            return end + width <= ids.size() &&
                   std::count(&ids[end], &ids[end] + width, ids[begin]) == static_cast<std::ptrdiff_t>(width);
        };
        while (is_long && (end - begin) % width == 0 && is_next_row_the_same()) end += width;
        if (is_long) runs.emplace_back(begin, end - begin);
    }
    return runs;
}

}  // namespace

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

TEST_CASE("with exact, a visibility buffer has the bits that each fragment has alone") {
    Random random(2);
    int beyond = 0, long_count = 0;
    for (int round = 0; round < 1000; ++round) {
        const texgen::TextureRegion region = draw_region(random);
        const Drawn drawn(random, random.integer(0, 6));
        TriangleBatch batch(region);
        batch.assign(drawn.triangles);
        FragmentRect rect{random.integer(-20, 600), random.integer(-20, 600), random.integer(1, 40),
                          random.integer(1, 6)};
        // Where one of them is hard, as often as not.
        if (!drawn.rects.empty() && count_of(drawn.rects[0]) > 0 && random.integer(0, 3) != 0) rect = drawn.rects[0];
        if (random.integer(0, 9) == 0) rect.width = random.integer(60, 300), rect.height = random.integer(1, 3);
        std::vector<std::uint32_t> ids(count_of(rect));
        const int longest = rect.width < 60 ? random.integer(1, 30) : random.integer(40, 300);
        for (std::size_t i = 0; i < ids.size();) {
            const int any = random.integer(-1, static_cast<int>(batch.size()) - 1);
            auto id = static_cast<std::uint32_t>(any > 0 && random.coin() ? 0 : any);
            if (any < 0 && random.coin()) id = static_cast<std::uint32_t>(batch.size()) + 1000000u;  // none, either
            for (int run = random.integer(1, longest); run > 0 && i < ids.size(); --run) ids[i++] = id;
        }
        std::vector<bool> is_in_long_run(ids.size());
        for (const auto& [first, count] : long_runs(ids, static_cast<std::size_t>(rect.width))) {
            ++long_count;
            for (std::size_t i = first; i < first + count; ++i) is_in_long_run[i] = true;
        }
        const auto asked = static_cast<unsigned>(random.coin() ? 15 : random.integer(0, 15));
        Outputs out(ids.size(), asked, static_cast<std::size_t>(random.integer(0, 7)));
        interpolate(batch, ids, rect, out.spans());
        CHECK(out.pads_are_intact());
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const Shot shot{{}, rect};
            const std::int64_t x = shot.x(static_cast<std::int64_t>(i) % rect.width);
            const std::int64_t y = shot.y(static_cast<std::int64_t>(i) / rect.width);
            // A pixel that no rectangle begins at is the last of one that ends there.
            const auto before = [](std::int64_t at) {
                return static_cast<int>(std::max<std::int64_t>(at - 0x7fffffff, 0));
            };
            const int left = before(x), above = before(y);
            beyond += left > 0 || above > 0;
            const FragmentRect pixels{static_cast<int>(x - left), static_cast<int>(y - above), left + 1, above + 1};
            if (ids[i] >= batch.size()) {
                for (std::size_t k = 0; k < 4; ++k) CHECK((!out.asked(k) || support::same_bits(out[k][i], 0.0f)));
                continue;
            }
            const Expected expected(drawn.triangles[ids[i]], region, pixels, asked | 8u, texgen::exact);
            const std::size_t last = count_of(pixels) - 1;
            // What is not lit may be 0 where something else of the rectangle is lit, or nothing of a long run.
            const bool is_dark =
                (last > 0 || is_in_long_run[i]) && expected.work != Work::nothing && expected.out.lit()[last] == 0.0f;
            bool is_zero = last == 0;
            for (std::size_t k = 0; k < 4; ++k) is_zero = is_zero && (!out.asked(k) || out[k][i] == 0.0f);
            const bool is_right = is_dark && last > 0 ? !out.asked(3) || out.lit()[i] == 0.0f
                                                      : agree(expected, last, out, i, 1) || (is_dark && is_zero);
            if (!is_right) FAIL_CHECK(support::hex(drawn.triangles[ids[i]]), " at ", x, " ", y, " asked ", asked);
        }
    }
    CHECK(beyond > 100);
    CHECK(long_count > 100);
}

TEST_CASE("long runs of one id in a row are found whole, as are rows that are one, and no others") {
    Random random(27);
    int runs = 0, of_rows = 0;
    for (int round = 0; round < 2000; ++round) {
        const auto width = static_cast<std::size_t>(random.integer(1, round % 2 == 0 ? 100 : 400));
        const auto height = static_cast<std::size_t>(random.integer(1, 4));
        const int longest = random.integer(1, 300);
        std::vector<std::uint32_t> ids(width * height);
        for (std::size_t i = 0; i < ids.size();) {
            const auto id = static_cast<std::uint32_t>(random.integer(0, 2));
            for (int run = random.integer(1, longest); run > 0 && i < ids.size(); --run) ids[i++] = id;
        }
        std::vector<std::pair<std::size_t, std::size_t>> found;
        texgen::detail::for_each_long_run(
            ids, width, [&](std::size_t first, std::size_t count) { found.emplace_back(first, count); });
        REQUIRE_MESSAGE(found == long_runs(ids, width), "width ", width, ", round ", round);
        runs += static_cast<int>(found.size());
        for (const auto& [first, count] : found) of_rows += count > width;
    }
    CHECK(runs > 1000);
    CHECK(of_rows > 100);
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
                const std::int64_t x = shot.x(static_cast<std::int64_t>(n) % rect.width);
                const std::int64_t y = shot.y(static_cast<std::int64_t>(n) / rect.width);
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

TEST_CASE("a tie that has more bits than two doubles is decided as for each triangle alone") {
    Random random(9);
    for (int round = 0; round < 2000; ++round) {
        // The fragment is half-way between a and b, where (w_b s_a + w_a s_b) / (w_a + w_b) is the middle of two
        // floats.
        const FragmentRect rect{random.integer(600, 1000), random.integer(600, 1000), 1, 1};
        const auto odd = [&] { return 2 * random.integer(1 << 16, 1 << 18) + 1; };
        const int w[2] = {odd(), odd()};
        const double off[2] = {random.integer(1, 1 << 20) * 0x1p-12, random.integer(1, 1 << 20) * 0x1p-12};
        const int middle[2] = {2 * random.integer(3 << 22, 7 << 21) + 1, 2 * random.integer(3 << 22, 7 << 21) + 1};
        const auto vertex = [&](int side) {
            const double sign = side == 0 ? -1.0 : 1.0;
            const auto texture = [&](int k) { return (middle[k] + sign * w[side]) * 0x1p-25; };
            return texgen::WindowVertex{
                {support::to_float(rect.x + 0.5 + sign * off[0]), support::to_float(rect.y + 0.5 + sign * off[1])},
                support::to_float(w[side]),
                {support::to_float(texture(0)), support::to_float(texture(1)), 0.0f, 1.0f}};
        };
        const auto any = [&] { return support::to_float(random.uniform(0x1p-12, 0x1p-11)); };
        const Triangle triangle{vertex(0),
                                vertex(1),
                                {{any(), any()},
                                 support::to_float(random.uniform(1.0, 2.0)),
                                 {any(), any(), any(), support::to_float(random.uniform(1.0, 2.0))}}};
        TriangleBatch batch(support::everywhere());
        batch.assign({&triangle, 1});
        const std::uint32_t id = 0;
        Outputs out(1, 3u);
        interpolate(batch, {&id, 1}, rect, out.spans());
        const auto at = support::ExactTriangle(triangle).at(rect.x, rect.y);
        for (std::size_t k = 0; k < 2; ++k) {
            const support::Quotient u = at.over_q(k);
            REQUIRE(compare(u, middle[k] * 0x1p-25) == 0);
            CHECK_MESSAGE(is_nearest(out[k][0], u), support::hex(triangle), " at ", support::text(rect));
        }
    }
}

// Of 384 000 such ties those that were decided wrongly where the rounded integer was taken for the exact one, and nothing
// else bounded what residues decide.
TEST_CASE("a tie of an integer that is rounded as it becomes a double is a tie") {
    struct Found {
        float w[3];
        int x, y;
    };
    for (const Found& found : {Found{{0x1.a94e0ep+0f, 0x1.fa1e5ap+0f, 0x1.e2678ap+0f}, 281, 752},
                               Found{{0x1.cd34e6p+0f, 0x1.f4035ep+0f, 0x1.551fd6p+0f}, 337, 968},
                               Found{{0x1.abf152p+0f, 0x1.ed0762p+0f, 0x1.faf93ep+0f}, 231, 962}}) {
        const auto vertex = [&](float x, float y, std::size_t i, float s) {
            const float w = found.w[i];
            return texgen::WindowVertex{{x, y}, w, {w * s, w * s, 0.0f, w}};
        };
        const Triangle triangle{vertex(0.0f, 0.0f, 0, 0x1p24f), vertex(0x1p23f, 0.0f, 1, 0x1p25f),
                                vertex(0.0f, 1.0f, 2, 0x1p24f)};
        TriangleBatch batch(support::everywhere());
        batch.assign({&triangle, 1});
        Outputs out(16, 3u);
        interpolate(batch, std::vector<std::uint32_t>(16, 0), {found.x, found.y, 16, 1}, out.spans());
        for (std::size_t i = 0; i < 16; ++i) {
            const int odd = (1 << 24) + 2 * (found.x + static_cast<int>(i)) + 1;
            CHECK_MESSAGE(out[0][i] == static_cast<float>(odd), support::hex(triangle), " number ", i);
        }
    }
}

TEST_CASE("tiles next to the slowest that were found have the bits of a setup") {
    std::ifstream file(TEXGEN_TEST_DATA "/promises/worst_inputs.txt");
    std::vector<std::vector<float>> found;
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("interpolate a batch")) continue;
        std::istringstream words(line.substr(line.rfind('|') + 1));
        std::vector<float>& numbers = found.emplace_back();
        for (std::string word; words >> word;) numbers.push_back(std::strtof(word.c_str(), nullptr));
        REQUIRE(numbers.size() == 23);
    }
    REQUIRE(!found.empty());
    Random random(13);
    for (int round = 0; round < 20000; ++round) {
        std::vector<float> n = found[random.bits() % found.size()];
        for (int change = random.integer(0, 2); change > 0; --change) {
            float& number = n[random.bits() % n.size()];
            const auto flipped =
                std::bit_cast<float>(std::bit_cast<std::uint32_t>(number) ^ std::uint32_t{1} << random.integer(0, 31));
            number = random.coin() ? flipped : std::round(number);
        }
        if (std::isnan(n[21]) || std::isnan(n[22])) continue;
        const auto pixel = [](float at) { return static_cast<int>(std::clamp(at, -0x1p30f, 0x1p30f)); };
        const auto vertex = [&](const float* v) {
            return texgen::WindowVertex{{v[0], v[1]}, v[2], {v[3], v[4], v[5], v[6]}};
        };
        const Triangle triangle{vertex(&n[0]), vertex(&n[7]), vertex(&n[14])};
        const FragmentRect rect{pixel(n[21]), pixel(n[22]), random.coin() ? 8 : 5, 8};
        const auto setup = TriangleSetup::of(triangle, support::everywhere(), texgen::exact);
        if (!setup) continue;
        Outputs expected(count_of(rect), 11u);
        if (interpolate(*setup, rect, expected.spans()) == Work::nothing) continue;
        TriangleBatch batch(support::everywhere());
        batch.assign({&triangle, 1});
        Outputs out(count_of(rect), 11u);
        interpolate(batch, {&rect, 1}, out.spans());
        for (std::size_t i = 0; i < count_of(rect); ++i) {
            const bool is_same = out[3][i] == expected[3][i] &&
                                 (out[3][i] == 0.0f || (out[0][i] == expected[0][i] && out[1][i] == expected[1][i]));
            CHECK_MESSAGE(is_same, support::hex(triangle), " at ", support::text(rect), " fragment ", i);
            if (!is_same) return;
        }
    }
}

TEST_CASE("quotients at the middle of two floats are the nearest where s changes its sign or is no normal float") {
    Random random(10);
    const auto check = [](const Shot& shot) {
        TriangleBatch batch(support::everywhere());
        batch.assign({&shot.triangle, 1});
        Outputs out(count_of(shot.rect), 3u);
        interpolate(batch, {&shot.rect, 1}, out.spans());
        const support::ExactTriangle exact(shot.triangle);
        for (int i = 0; i < shot.rect.width; ++i)
            for (std::size_t k = 0; k < 2; ++k)
                REQUIRE_MESSAGE(is_nearest(out[k][static_cast<std::size_t>(i)], exact.at(shot.x(i), 0).over_q(k)),
                                support::hex(shot), " fragment ", i);
    };
    for (int round = 0; round < 100; ++round) {
        Shot steep = support::steep_row_with_a_tie(random.integer(1020, 1023), random);
        REQUIRE(is_tie(support::ExactTriangle(steep.triangle).at(steep.rect.x, 0).over_q(0)));
        steep.rect = {steep.rect.x - random.integer(0, 9), 0, 64, 1};
        check(steep);
        // s is 2 m + 1 of the least floats, and q is 2 and not half an ulp of a double more.
        const float s = static_cast<float>(2 * random.integer(1, 1000) + 1) * 0x1p-149f;
        const auto vertex = [s](float x, float y, float q) {
            return texgen::WindowVertex{{x, y}, 1.0f, {s, 0.5f, 0.5f, q}};
        };
        constexpr float below_centre = 0.5f - 0x1p-25f;
        check({{vertex(0.0f, below_centre, 2.0f), vertex(1024.0f, below_centre, 2.0f),
                vertex(0.0f, 1024.0f, 2.0f + 0x1p-22f)},
               {random.integer(0, 900), 0, 64, 1}});
    }
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

namespace {

// How many tiles of a batch the vectors leave to a set-up of their own.
int left_by_vectors(const std::vector<Triangle>& triangles, const std::vector<FragmentRect>& rects,
                    Tolerance tolerance) {
    TriangleBatch batch(support::everywhere(), tolerance);
    batch.assign(triangles);
    std::size_t fragments = 0;
    for (const FragmentRect& rect : rects) fragments += count_of(rect);
    Outputs out(fragments);
    texgen::detail::TilesJob job{};
    texgen::detail::describe(job, batch, out.spans(), fragments);
    job.tiles = reinterpret_cast<const int(*)[4]>(rects.data());
    job.tile_count = rects.size();
    return std::popcount(texgen::detail::chosen<texgen::detail::BatchKernels>().divide_tiles(job, 0, 0).values);
}

}  // namespace

TEST_CASE("no tile of ties needs a set-up of its own") {
    Random random(10);
    for (int round = 0; round < 100; ++round) {
        std::vector<Triangle> triangles;
        std::vector<FragmentRect> rects;
        for (int i = 0; i < 8; ++i) {
            const Shot shot = ties_everywhere(random, 0.0f);
            triangles.push_back(shot.triangle);
            rects.push_back(shot.rect);
        }
        CHECK(left_by_vectors(triangles, rects, texgen::exact) == 0);
    }
}

TEST_CASE(
    "what cancels 2^60 of its terms is the nearest float all the same, in a tile, a batch and a visibility buffer") {
    Random random(15);
    int hard = 0, lit = 0, ties = 0;
    for (int round = 0; round < 150; ++round) {
        std::vector<Triangle> triangles;
        std::vector<FragmentRect> rects;
        for (int i = 0; i < 8; ++i) {
            const Shot shot = far_sliver(random);
            triangles.push_back(shot.triangle);
            rects.push_back(shot.rect);
            hard += std::fabs(support::twice_area(shot.triangle)) < 0x1p-60 * 0x1p31 * 1e6 ? 1 : 0;
        }
        CHECK(left_by_vectors(triangles, rects, texgen::exact) == 0);
        TriangleBatch batch(support::everywhere());
        batch.assign(triangles);
        Outputs of_tiles(8 * 64), of_ids(64);
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

TEST_CASE("ids beyond the batch are no triangle, in runs and one by one, and refused ones are dark") {
    Random random(12);
    const std::vector<Triangle> friendly(3, support::make_triangle(support::Family::friendly, random));
    const FragmentRect rect{100, 100, 64, 3};
    for (int k = 0; k < 4; ++k) {
        for (const float bad : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
            std::vector<Triangle> triangles = friendly;
            triangles[1].c.strq[k] = bad;
            TriangleBatch batch(texgen::whole_texture());
            batch.assign(triangles);
            for (const std::uint32_t id : {1u, 3u, 1000000u, 0xfffffffeu, 0xffffffffu}) {
                for (const std::uint32_t others : {id, 0u}) {  // rows of it, and every other fragment
                    std::vector<std::uint32_t> ids(count_of(rect), id);
                    for (std::size_t i = 0; i < ids.size(); i += 2) ids[i] = others;
                    Outputs values(ids.size());
                    interpolate(batch, ids, rect, values.spans());
                    support::FootprintOutputs footprints(rect);
                    footprint(batch, ids, rect, {1024.0, 512.0}, footprints.spans());
                    for (std::size_t i = 1; i < ids.size(); i += 2) {
                        for (std::size_t j = 0; j < 4; ++j) REQUIRE(support::same_bits(values[j][i], 0.0f));
                        for (std::size_t j = 0; j < 8; ++j) REQUIRE(support::same_bits(footprints[j][i], 0.0f));
                    }
                }
            }
        }
    }
}

TEST_CASE("few friendly tiles need a set-up of their own") {
    for (const Tolerance tolerance : {texgen::exact, texgen::texels(1.0 / 512, 4096)}) {
        Random random(4);
        int doubtful = 0;
        for (int round = 0; round < 100; ++round) {
            std::vector<Triangle> triangles;
            std::vector<FragmentRect> rects;
            for (int i = 0; i < 8; ++i) {
                triangles.push_back(support::make_triangle(support::Family::friendly, random));
                const FragmentRect pixel = support::pixel_near(triangles.back(), random);
                rects.push_back({pixel.x, pixel.y, 8, 8});
            }
            doubtful += left_by_vectors(triangles, rects, tolerance);
        }
        CHECK(doubtful < 40);  // of 800; s or t is 0 in some
    }
}

TEST_CASE("footprints of a visibility buffer are those of its triangles") {
    Random random(5);
    int checked = 0, long_runs = 0, whole_rows = 0, dark = 0;
    for (int round = 0; round < 120; ++round) {
        Drawn drawn(random, random.integer(1, 9));
        if (random.coin()) drawn.triangles.back() = refused(random);
        TriangleBatch batch(texgen::whole_texture());
        batch.assign(drawn.triangles);
        const bool may_be_long = round % 3 == 0;
        const FragmentRect rect{random.integer(-20, 600), random.integer(-20, 600),
                                random.integer(1, may_be_long ? 200 : 20), 3};
        std::vector<std::uint32_t> ids(count_of(rect));
        for (std::size_t i = 0; i < ids.size();) {
            const auto id = static_cast<std::uint32_t>(random.integer(-1, static_cast<int>(batch.size()) - 1));
            const int longest = may_be_long && random.coin() ? 3 * rect.width : 9;
            const std::size_t before = i;
            for (int run = random.integer(1, longest); run > 0 && i < ids.size(); --run) ids[i++] = id;
            long_runs += i - before >= 128;
            whole_rows += i - before >= 2 * static_cast<std::size_t>(rect.width) && rect.width >= 64;
        }
        const texgen::TexelsPerUnit texels{1024.0, 512.0};
        const auto asked = static_cast<unsigned>(random.coin() ? 255 : random.integer(0, 255));
        support::FootprintOutputs out(rect, asked, static_cast<std::size_t>(random.integer(0, 15)));
        footprint(batch, ids, rect, texels, out.spans());
        CHECK(out.pads_are_intact());
        for (std::size_t i = 0; i < ids.size(); ++i) {
            bool is_dark = true;
            for (std::size_t k = 0; k < 8; ++k)
                is_dark = is_dark && (!out.asked(k) || support::same_bits(out[k][i], 0.0f));
            const int x = rect.x + static_cast<int>(i) % rect.width, y = rect.y + static_cast<int>(i) / rect.width;
            const auto triangle = ids[i] != no_triangle
                                      ? TriangleSetup::of(drawn.triangles[ids[i]], texgen::whole_texture())
                                      : std::nullopt;
            std::optional<texgen::Footprint> exact;
            if (triangle) exact = texgen::FootprintSetup(*triangle, texels).at(x, y);
            if (!exact) {
                CHECK_MESSAGE(is_dark, "id ", ids[i], " at ", x, " ", y);
                ++dark;
                continue;
            }
            if (is_dark) continue;  // of a long run that is not lit
            const glm::dvec2 bound = texgen::FootprintSetup(*triangle, texels).error_bound({x, y, 1, 1});
            for (std::size_t k = 0; k < 4; ++k) {
                if (!out.asked(k)) continue;
                const auto coordinate = static_cast<glm::length_t>(k % 2);
                const double expected = k < 2 ? exact->dx[coordinate] : exact->dy[coordinate];
                const double length = std::hypot(exact->dx[coordinate], exact->dy[coordinate]);
                const double allowed = 2.0 * bound[coordinate] + texgen::batch_footprint_error * length;
                if (!(length < 0x1p100) || !(allowed < length)) continue;
                ++checked;
                CHECK_MESSAGE(std::fabs(out.at(k, i) - expected) <= allowed, support::hex(drawn.triangles[ids[i]]));
            }
        }
    }
    CHECK(checked > 5000);
    CHECK(long_runs > 10);
    CHECK(whole_rows > 5);
    CHECK(dark > 1000);
}

TEST_CASE("a batch that was moved from has no triangles, and takes new ones; a copy is one of its own") {
    Random random(1412);
    std::vector<Triangle> triangles(20);
    for (Triangle& triangle : triangles) triangle = support::make_triangle(support::Family::friendly, random);
    const auto values_of = [](const TriangleBatch& batch) {
        const std::vector<std::uint32_t> ids{0, 3, 3, 7, no_triangle, 19};
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
