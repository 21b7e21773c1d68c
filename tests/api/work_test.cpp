// What is skipped, what is lit, and what is said of the error: never a lit fragment lost, never a bound below the
// truth.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "api/work_test/truth.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/verdict.hpp"
#include "support/hard_triangles.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/special_values.hpp"
#include "support/triangles.hpp"
#include "texgen/interpolate.hpp"

namespace work_cases {

using support::count_of;
using support::everywhere;
using support::nan_double;
using support::setup_of;
using texgen::atlas_tile;
using texgen::Tolerance;
using texgen::TriangleSetup;

namespace {

// w = 1 and q = 1, and s = r = first + i step at fragment i of every row, t likewise at every row: without an error
// where first + 1024 step is a float.
Shot ramp(glm::vec2 first, glm::vec2 step, int width, int height) {
    const auto vertex = [&](float column, float row) {
        const float s = first.x + column * step.x;
        return texgen::WindowVertex{{column + 0.5f, row + 0.5f}, 1.0f, {s, first.y + row * step.y, s, 1.0f}};
    };
    return {{vertex(0.0f, 0.0f), vertex(1024.0f, 0.0f), vertex(0.0f, 1024.0f)}, {0, 0, width, height}};
}

// Whose sides are the extremes of s and t over the rectangle (they are at its corners), or next to them.
TextureRegion region_around(const Shot& shot, const ExactTriangle& exact, Random& random) {
    glm::dvec2 least(HUGE_VAL), largest(-HUGE_VAL);
    for (const int x : {0, shot.rect.width - 1}) {
        for (const int y : {0, shot.rect.height - 1}) {
            const Homogeneous at = exact.at(shot.x(x), shot.y(y));
            if (at.q.sign() <= 0) return texgen::whole_texture();
            for (int k = 0; k < 2; ++k) {
                const double u = at.over_q(static_cast<std::size_t>(k)).estimate();
                least[k] = std::min(least[k], u);
                largest[k] = std::max(largest[k], u);
            }
        }
    }
    const double unit = std::ldexp(1.0, random.integer(-53, -10));
    const auto moved = [&](double side, double outward) {
        return side + outward * unit * std::fabs(side) * (random.integer(0, 9) == 0 ? -1.0 : random.integer(0, 2));
    };
    return atlas_tile({moved(least.x, -1.0), moved(least.y, -1.0)}, {moved(largest.x, 1.0), moved(largest.y, 1.0)});
}

}  // namespace

TEST_CASE("nothing is done only where nothing is lit, and no test is left out where it is needed") {
    std::uint64_t seed = 3000;
    int nothing = 0, dark = 0, divide = 0, affine = 0, border = 0;
    for (const support::HardFamily& family : support::hard_families) {
        Random random(++seed);
        for (int i = 0; i < 250; ++i) {
            const Shot shot = family.make(random);
            const ExactTriangle exact(shot.triangle);
            const TextureRegion region =
                random.coin() ? support::region_at(shot, exact, random) : region_around(shot, exact, random);
            const Tolerance tolerance{random.integer(0, 2) != 0 ? 0.0 : random.power_of_ten(-8.0, 0.0)};
            const TriangleSetup setup = setup_of(shot.triangle, region, tolerance);
            const Work work = setup.work(shot.rect);
            const Truth truth = truth_of(shot, exact, region);
            const std::string context = family.name + (": " + hex(region)) + " in " + hex(shot);
            if (work == Work::nothing) REQUIRE_MESSAGE(!truth.any_lit, context);
            if (work == Work::divide) {
                REQUIRE_MESSAGE(truth.all_in_front, context);
                REQUIRE_MESSAGE(truth.all_lit, context);
            }
            if (!(tolerance.value > 0.0)) {
                REQUIRE_MESSAGE(work != Work::quadratic, context);
                if (work == Work::affine) REQUIRE_MESSAGE(exact.has_constant_q(), context);
            }
            Outputs out(count_of(shot.rect), i % 2 == 0 ? 8u : 15u);
            REQUIRE_MESSAGE(interpolate(setup, shot.rect, out.spans()) == work, context);
            if (!truth.all_promised) continue;
            nothing += work == Work::nothing;
            dark += !truth.any_lit;
            divide += work == Work::divide;
            affine += work == Work::affine;
            border += truth.any_lit && !truth.all_lit;
        }
    }
    CHECK(nothing > 600);
    CHECK(nothing > 0.3 * dark);
    CHECK(divide > 25);
    CHECK(affine > 50);
    CHECK(border > 100);
}

TEST_CASE("a side that is none asks no fragment, and what a rectangle needs does not depend on what is asked") {
    Random random(3100);
    int divide = 0, whole = 0, nothing = 0;
    for (int i = 0; i < 4000; ++i) {
        Shot shot = i % 2 == 0 ? support::detail::ordinary(support::Family::friendly, random)
                               : support::detail::constant_q(random);
        shot.rect.width = random.integer(1, 70);
        shot.rect.height = random.integer(1, 8);
        // Of regions that are none, too.
        const auto side = [&](double bound, double none) {
            const int kind = random.integer(0, 20);
            return kind == 0 ? nan_double : kind == 1 ? -none : kind == 2 ? bound * 0x1p127 : kind < 9 ? bound : none;
        };
        const TextureRegion region =
            atlas_tile({side(random.uniform(-0.5, 1.0), -HUGE_VAL), side(random.uniform(-0.5, 1.0), -HUGE_VAL)},
                       {side(random.uniform(0.0, 1.5), HUGE_VAL), side(random.uniform(0.0, 1.5), HUGE_VAL)});
        const Tolerance tolerance{random.coin() ? 0.0 : 1e-6};
        const TriangleSetup setup = setup_of(shot.triangle, region, tolerance);
        const Work work = setup.work(shot.rect);
        for (const unsigned asked : {1u, 3u, 8u, 11u, 15u}) {
            Outputs out(count_of(shot.rect), asked);
            REQUIRE_MESSAGE(interpolate(setup, shot.rect, out.spans()) == work, asked, " of ", hex(region), " in ",
                            hex(shot));
        }
        nothing += work == Work::nothing;
        const Truth truth = truth_of(shot, ExactTriangle(shot.triangle), support::everywhere());
        const Work of_all = setup_of(shot.triangle, support::everywhere(), tolerance).work(shot.rect);
        if (truth.all_in_front && truth.all_promised) {
            ++whole;
            divide += of_all != Work::divide_and_test;
        }
    }
    CHECK(nothing > 300);
    CHECK(whole > 1000);
    CHECK(divide == whole);
    // A constant q of corners so far out that two doubles see a slope of it.
    const texgen::Triangle far_out{
        {{0x1p+99f, 0x1p+126f}, 0x1.6p+14f, {-0x1.3e45fp+28f, 0x1p-1f, 0.0f, 0x1.6p+14f}},
        {{-0x1p+35f, 0x1p+103f}, 0x1.b3ebd2p+9f, {0x1.d61788p-20f, 1.0f, 0.0f, 0x1.b3ebd2p+9f}},
        {{0x1p+116f, -0x1p+121f}, 0x1.3c933cp-13f, {1.0f, 0x1.b3a83ap+20f, 0.0f, 0x1.3c933cp-13f}}};
    const FragmentRect rect{1073741824, 1073741823, 8, 3};
    const TriangleSetup setup = setup_of(far_out, texgen::whole_texture(), texgen::exact);
    for (unsigned asked = 0; asked < 16; ++asked) {
        Outputs out(count_of(rect), asked);
        CHECK(interpolate(setup, rect, out.spans()) == setup.work(rect));
    }
}

TEST_CASE("where nothing is lit by a margin nothing is done; where all is lit by a margin nothing is tested") {
    std::uint64_t seed = 3100;
    int behind = 0, outside = 0, inside = 0, cut = 0;
    for (const support::Family family :
         {support::Family::friendly, support::Family::parallel, support::Family::crossing}) {
        Random random(++seed);
        for (int i = 0; i < 1500; ++i) {
            const Shot shot = support::detail::ordinary(family, random);
            const ExactTriangle exact(shot.triangle);
            bool all_in_front = true, all_behind = true;
            double least[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, largest[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
            const double scale = 1e-6 * support::magnitude(exact.at(shot.rect.x, shot.rect.y).q).estimate();
            for (const int x : {0, shot.rect.width - 1}) {
                for (const int y : {0, shot.rect.height - 1}) {
                    const Homogeneous at = exact.at(shot.x(x), shot.y(y));
                    all_in_front = all_in_front && at.q.estimate() > scale;
                    all_behind = all_behind && at.q.estimate() < -scale;
                    for (std::size_t k = 0; k < 3 && all_in_front; ++k) {
                        least[k] = std::min(least[k], at.over_q(k).estimate());
                        largest[k] = std::max(largest[k], at.over_q(k).estimate());
                    }
                }
            }
            if (all_behind) {
                ++behind;
                REQUIRE_MESSAGE(setup_of(shot.triangle).work(shot.rect) == Work::nothing, hex(shot));
            }
            if (!all_in_front) continue;
            double margin = 0.0;
            for (std::size_t k = 0; k < 3; ++k)
                margin = std::max(
                    {margin, 1e-5 * std::fabs(least[k]), 1e-5 * std::fabs(largest[k]), 1e-3 * (largest[k] - least[k])});
            const TextureRegion around =
                atlas_tile({least[0] - margin, least[1] - margin}, {largest[0] + margin, largest[1] + margin});
            const double r_min = least[2] - margin, r_max = largest[2] + margin;
            for (const TextureRegion& volume :
                 {around, around.with_depth(r_min, r_max), around.with_depth(r_min, HUGE_VAL),
                  around.with_depth(-HUGE_VAL, r_max), around.with_depth(-HUGE_VAL, HUGE_VAL)})
                REQUIRE_MESSAGE(setup_of(shot.triangle, volume).work(shot.rect) <= Work::divide, hex(shot));
            ++inside;
            // What cuts the depth cannot go untested.
            const double middle = 0.5 * least[2] + 0.5 * largest[2];
            if (largest[2] - least[2] > 4.0 * margin) {
                for (const TextureRegion& volume :
                     {around.with_depth(middle, HUGE_VAL), around.with_depth(r_min, middle)}) {
                    const TriangleSetup setup = setup_of(shot.triangle, volume);
                    const Work work = setup.work(shot.rect);
                    REQUIRE_MESSAGE((work == Work::divide_and_test || work == Work::affine), hex(shot));
                    Outputs out(count_of(shot.rect));
                    REQUIRE_MESSAGE(interpolate(setup, shot.rect, out.spans()) == work, hex(shot));
                    cut += work == Work::divide_and_test;
                }
            }
            const double far = 1e3 * margin + 1.0;
            for (const TextureRegion& beside :
                 {atlas_tile({least[0] - far, -far}, {least[0] - margin, far}),
                  atlas_tile({largest[0] + margin, -far}, {largest[0] + far, far}),
                  atlas_tile({-far, least[1] - far}, {far, least[1] - margin}),
                  atlas_tile({-far, largest[1] + margin}, {far, largest[1] + far}),
                  around.with_depth(r_min - far, r_min), around.with_depth(r_max, r_max + far),
                  around.with_depth(r_max, HUGE_VAL)}) {
                const TriangleSetup setup = setup_of(shot.triangle, beside);
                Outputs out(count_of(shot.rect), Outputs::all, 3);
                REQUIRE_MESSAGE(interpolate(setup, shot.rect, out.spans()) == Work::nothing, hex(shot));
                REQUIRE(out.pads_are_intact());
                for (std::size_t k = 0; k < 3; ++k) REQUIRE(Outputs::is_poison(out[k]));
                for (const float lit : out.lit()) REQUIRE(support::same_bits(lit, 0.0f));
                ++outside;
            }
        }
    }
    CHECK(behind > 200);
    CHECK(inside > 2000);
    CHECK(outside > 14000);
    CHECK(cut > 100);
}

TEST_CASE(
    "lit is 1 exactly where the written floats are inside the closed region, bounds that are no floats included") {
    struct Border {
        TextureRegion region;
        float s, t;  // fragments run through these, a unit at a time
    };
    const double denorm_min = std::numeric_limits<double>::denorm_min();
    std::vector<Border> borders{
        Border{texgen::whole_texture(), 0.0f, 0.0f},
        Border{texgen::whole_texture(), 1.0f, 1.0f},
        Border{atlas_tile({0.1, 0.1}, {0.7, 0.7}), 0.1f, 0.7f},
        Border{atlas_tile({0.1, 0.1}, {0.7, 0.7}), 0.7f, 0.1f},
        Border{atlas_tile({1.0 / 3.0, -5.0}, {5.0, 2.0 / 3.0}), 0.333333333f, 0.666666667f},
        Border{atlas_tile({-0.3, -0.7}, {-0.1, -0.2}), -0.1f, -0.7f},
        Border{texgen::rectangle_texture(640.0, 480.0), 640.0f, 480.0f},
        Border{texgen::rectangle_texture(1920.7, 1080.3), 1920.7f, 1080.3f},
        Border{atlas_tile({0.25, 0.5}, {0.5, 0.75}), 0.5f, 0.5f},
        Border{atlas_tile({denorm_min, -1.0}, {1.0, denorm_min}), 0.0f, 0.0f},
        Border{atlas_tile({0.5, 0.5}, {0.5, 0.5}), 0.5f, 0.5f},
        Border{atlas_tile({0.1, 0.1}, {0.1, 0.1}), 0.1f, 0.1f},
        Border{atlas_tile({0.7, 0.1}, {0.1, 0.7}), 0.3f, 0.3f},
        Border{atlas_tile({0.5, 1.0}, {0.49999, 0.0}), 0.5f, 0.5f},
        Border{atlas_tile({nan_double, 0.0}, {1.0, 1.0}), 0.5f, 0.5f},
        Border{atlas_tile({0.0, nan_double}, {1.0, 1.0}), 0.5f, 0.5f},
        Border{atlas_tile({0.0, 0.0}, {nan_double, 1.0}), 0.5f, 0.5f},
        Border{atlas_tile({0.0, 0.0}, {1.0, nan_double}), 0.5f, 0.5f},
        Border{atlas_tile({-HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL}), 0.5f, 0.5f},
        Border{atlas_tile({0.1, -HUGE_VAL}, {HUGE_VAL, 0.1}), 0.1f, 0.1f},
    };
    // The same limits of r, which is s here.
    for (std::size_t i = 0, count = borders.size(); i < count; ++i) {
        const auto& [region, s, t] = borders[i];
        const TextureRegion of_t = atlas_tile({-HUGE_VAL, region.min().y}, {HUGE_VAL, region.max().y});
        borders.push_back({of_t.with_depth(region.min().x, region.max().x), s, t});
    }
    int both = 0;
    for (const Border& border : borders) {
        for (const Tolerance tolerance : {texgen::exact, Tolerance{1e-7}, Tolerance{0.01}}) {
            for (const int width : {9, 33, 257}) {
                // One unit in the last place a fragment; the size of 1024 of them keeps the vertices floats.
                const auto unit = [](float value) {
                    return std::max(std::nextafter(std::fabs(value), HUGE_VALF) - std::fabs(value), 0x1p-149f) * 2.0f;
                };
                const glm::vec2 step(unit(border.s), unit(border.t));
                Shot shot = ramp(glm::vec2(border.s, border.t) - 4.0f * step, step, width, 9);
                const TriangleSetup setup = setup_of(shot.triangle, border.region, tolerance);
                Outputs out(count_of(shot.rect), Outputs::all, 1);
                const Work work = interpolate(setup, shot.rect, out.spans());
                bool any_lit = false, any_dark = false;
                for (std::size_t i = 0; i < out.size(); ++i) {
                    const float lit = out.lit()[i];
                    any_lit = any_lit || lit == 1.0f;
                    any_dark = any_dark || lit == 0.0f;
                    if (work == Work::nothing)
                        REQUIRE(lit == 0.0f);
                    else
                        REQUIRE_MESSAGE(
                            lit == (support::contains(border.region, out.s()[i], out.t()[i], out.r()[i]) ? 1.0f : 0.0f),
                            hex(border.region), " at ", hex(out.s()[i]), " ", hex(out.t()[i]));
                }
                both += any_lit && any_dark;
                const Truth truth = truth_of(shot, ExactTriangle(shot.triangle), border.region);
                if (!(tolerance.value > 0.0)) REQUIRE_MESSAGE(any_lit == truth.any_lit, hex(border.region));
                const bool is_empty = !(
                    border.region.min().x <= border.region.max().x && border.region.min().y <= border.region.max().y &&
                    (!border.region.depth() || border.region.depth()->x <= border.region.depth()->y));
                if (is_empty) REQUIRE_MESSAGE(!any_lit, hex(border.region));
            }
        }
    }
    CHECK(both > 120);
}

TEST_CASE(
    "where q/w varies short rows and few fragments are divided, and others need none where the tolerance is large") {
    Random random(3600);
    int few = 0, many = 0, larger = 0;
    while (many < 300) {
        const Shot shot = support::detail::ordinary(support::Family::friendly, random);
        const TriangleSetup setup = setup_of(shot.triangle, everywhere(), Tolerance{1e6});
        const auto rect_of = [&](int width, int height) {
            return FragmentRect{shot.rect.x, shot.rect.y, width, height};
        };
        const Work of_more = setup.work(rect_of(129, 1));  // or q is next to 0, or varies too much for a chunk
        if (of_more != Work::affine && of_more != Work::quadratic) continue;
        ++many;
        for (const FragmentRect& rect :
             {rect_of(128, 1), rect_of(16, 8), rect_of(15, 40), rect_of(1, 1), rect_of(16, 32), rect_of(32, 4),
              rect_of(64, 8), rect_of(16, 1024), rect_of(63, 260)}) {
            const Work work = setup.work(rect);
            if (work == Work::nothing) continue;
            ++few;
            REQUIRE_MESSAGE(work >= Work::divide, hex(Shot{shot.triangle, rect}));
        }
        // One more than those fragments, and than those rows have.
        for (const FragmentRect& rect : {rect_of(16, 1025), rect_of(64, 9), rect_of(65, 8), rect_of(43, 3)}) {
            const Work work = setup.work(rect);
            larger += work == Work::affine || work == Work::quadratic;
        }
    }
    CHECK(few > 2600);
    CHECK(larger > 1000);
}

}  // namespace work_cases
