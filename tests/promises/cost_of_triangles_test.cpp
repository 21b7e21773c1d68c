// What triangles cost: no input of a function takes many times the ordinary one's time. Ratios of times that were taken
// in turn, as users compile them.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "promises/cost_of_triangles_test/ordinary.hpp"
#include "support/float_state.hpp"
#include "support/hard_triangles.hpp"
#include "support/hex.hpp"
#include "support/limits.hpp"
#include "support/near_cut.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/stopwatch.hpp"
#include "support/triangles.hpp"
#include "texgen/batch.hpp"
#include "texgen/interpolate.hpp"

namespace triangle_costs {

namespace limit = support::limit;
using support::Random;

TEST_CASE("ties whose terms are 110 powers of two apart take at most three times what those of 60 take") {
    // Two corners on ties, and small; the third makes others of what is left of it.
    const auto ties = [](int exponent) {
        const float k = std::ldexp(1.0f, exponent);
        return Shot{{{{0.5f, 40.5f}, 1.0f, {0x1.80005ap0f * k, 0x1.000032p0f * k, 0x1.00000cp0f * k, 3.0f}},
                     {{24.5f, 16.5f}, 1.0f, {0x1.80002ap0f * k, 0x1.000052p0f * k, 0x1.000014p0f * k, 3.0f}},
                     {{40.5f, 8.5f}, 1.0f, {0x1.800012p+1f, 0x1.000002p+1f, 0x1.00003ap+1f, 3.0f}}},
                    {16, 2, 64, 4}};
    };
    for (const int exponent : {-85, -95, -100, -110}) {
        const double ratio = support::worst_over_ordinary_within(3.0, Workload(ties(-60), texgen::exact),
                                                                 Workload(ties(exponent), texgen::exact));
        REQUIRE_MESSAGE(ratio <= 3.0, exponent, ": ", ratio, " times");
    }
}

TEST_CASE("a triangle that the near plane cuts costs at most 16 times the ordinary one, and 4 times in 99 of 100") {
    // Three or four in a thousand are dearer than 4 times: so many that chance does not make ten of them.
    constexpr int count = 1000;
    for (const glm::ivec2 size : {glm::ivec2{8, 8}, {64, 4}}) {
        for (const Tolerance tolerance : tolerances) {
            Random random(71);
            int far_corners = 0;
            int dear = 0;
            const double of_ordinary = least_time(ordinary(size.x, size.y), tolerance);
            for (int i = 0; i < count; ++i) {
                const auto [triangle, rect] = support::near_cut(random, size.x, size.y);
                std::array<double, 3> seconds{};
                for (int order = 0; order < 3; ++order) {
                    const Shot shot{support::rotated(triangle, order), rect};
                    far_corners += std::fabs(shot.triangle.a.window.x) > 1e4f;
                    auto& of_order = seconds[static_cast<std::size_t>(order)];
                    of_order = least_time(shot, tolerance);
                    if (of_order > limit::near_plane * of_ordinary)
                        of_order = cost(shot, tolerance, limit::near_plane) * of_ordinary;
                    INFO(size.x, " x ", size.y, ", tolerance ", tolerance.value, " in ", hex(shot));
                    REQUIRE(of_order <= limit::near_plane * of_ordinary);
                }
                const auto extremes = std::minmax_element(seconds.begin(), seconds.end());
                const auto shot_of = [&, t = triangle, r = rect](const double* order) {
                    return Shot{support::rotated(t, static_cast<int>(order - seconds.data())), r};
                };
                constexpr double most = limit::near_plane_99_of_100;
                dear += *extremes.second > most * of_ordinary && cost(shot_of(extremes.second), tolerance, most) > most;
                if (*extremes.second <= limit::rotation * *extremes.first) continue;
                const double ratio =
                    support::worst_over_ordinary_within(limit::rotation, Workload(shot_of(extremes.first), tolerance),
                                                        Workload(shot_of(extremes.second), tolerance));
                REQUIRE_MESSAGE(ratio <= limit::rotation, hex(shot_of(extremes.second)));
            }
            CHECK_MESSAGE(dear <= count / 100, size.x, " x ", size.y, ", tolerance ", tolerance.value);
            CHECK(far_corners > count / 5);
        }
    }
}

TEST_CASE(
    "a tolerance finer than the floats of a tile costs at most 1.6 times what exact does, of few chunks three times") {
    Random random(73);
    const Tolerance fine = tolerances[1];
    for (const auto& [width, height, limit] :
         {std::tuple{64, 4, 3.0}, std::tuple{65, 16, 1.6}, std::tuple{200, 16, 1.6}}) {
        for (int i = 0; i < 60; ++i) {
            Shot shot{support::make_triangle(support::Family::friendly, random), {300, 300, width, height}};
            // A repeated slide, far from where it begins.
            for (WindowVertex* corner : support::vertices(shot.triangle)) {
                corner->strq.x += corner->strq.w * random.uniform_float(1e2, 1e5);
                corner->strq.y += corner->strq.w * random.uniform_float(-1e4, 1e4);
            }
            const double ratio =
                support::worst_over_ordinary_within(limit, Workload(shot, texgen::exact), Workload(shot, fine));
            REQUIRE_MESSAGE(ratio <= limit, ratio, " times in ", hex(shot));
        }
    }
}

TEST_CASE("a triangle whose cut corner comes first costs what it costs with the other corners first") {
    const Triangle cut{{{-544164.188f, 27988.3828f}, 0.1f, {-68.9127731f, -22.6434841f, -10.0570049f, -24.988451f}},
                       {{810.03656f, 428.25708f}, 97.3841324f, {82.398613f, 24.5005531f, 16.0539932f, 30.6767712f}},
                       {{525.804382f, 361.901428f}, 68.5282516f, {38.480442f, 12.9906549f, 11.8506365f, 8.97344875f}}};
    Shot shots[3];
    for (int order = 0; order < 3; ++order) {
        shots[order] = {support::rotated(cut, order), {169, 428, 256, 16}};
        require_cost("cut", shots[order], limit::any);
    }
    for (const Tolerance tolerance : tolerances) {
        for (int i = 0; i < 9; ++i) {
            const double ratio = support::worst_over_ordinary_within(limit::rotation, Workload(shots[i / 3], tolerance),
                                                                     Workload(shots[i % 3], tolerance));
            REQUIRE_MESSAGE(ratio <= limit::rotation, "tolerance ", tolerance.value, ": ", ratio, " times in order ",
                            i % 3);
        }
    }
}

TEST_CASE("fragments that all lie between two floats cost at most 8 times the ordinary ones") {
    // s = 1/2 + (2 i + 1) 2^-25 at fragment i of every row, with parallel views; then with the row's own 1 / (q/w), and
    // with a corner a hair beside its place.
    constexpr float unit = 0x1p-25f;
    for (const auto& [width, height] : {std::array{8, 8}, std::array{64, 4}, std::array{64, 64}}) {
        const FragmentRect rect{0, 0, width, height};
        const Triangle ties{vertex(0, 0, 1, 0.5f, 0.5f, 1), vertex(1024, 0, 1, 0.5f + 2048 * unit, 0.5f, 1),
                            vertex(0, 1024, 1, 0.5f, 0.5f + 4096 * unit, 1)};
        require_cost("ties", {ties, rect}, limit::any);
        Triangle rows = ties;
        rows.c.strq *= 2.0f;
        require_cost("ties of the first rows, q by rows", {rows, rect}, limit::any);
        Triangle beside = ties;
        beside.b.window.y = 1e-5f;
        require_cost("next to ties", {beside, rect}, limit::any);
    }
}

TEST_CASE("a tile that q = 0 crosses costs at most 24 times the ordinary one") {
    Random random(72);
    int crossed = 0;
    for (const auto& [width, height] : {std::array{8, 8}, std::array{64, 4}, std::array{256, 16}}) {
        for (int i = 0; i < 40; ++i) {
            // Through the middle of the tile, at any slope; the first times along a row of fragments.
            const double angle = i < 3 ? 0.0 : random.uniform(0.0, 6.3);
            const glm::dvec2 across(std::sin(angle), std::cos(angle));
            const glm::dvec2 middle(400.0 + 0.5 * width, 300.5 + height / 2);
            Triangle triangle = support::make_triangle(support::Family::friendly, random);
            for (WindowVertex* corner : support::vertices(triangle)) {
                const glm::dvec2 from = glm::dvec2(corner->window) - middle;
                corner->strq.w = static_cast<float>((from.x * across.x + from.y * across.y) *
                                                    static_cast<double>(corner->clip_w) / 500.0);
            }
            const Shot shot{triangle, {400, 300, width, height}};
            crossed += support::detail::changes_sign(shot, support::ExactTriangle(triangle), 3);
            for (const Tolerance tolerance : tolerances) {
                const double ratio = least_time(shot, tolerance) / least_time(ordinary(width, height), tolerance);
                if (ratio > limit::q_is_zero) require_cost("crossed", shot, limit::q_is_zero);
            }
        }
    }
    CHECK(crossed > 80);
}

TEST_CASE("a row on which q is 0 everywhere, and a rectangle far outside of the window, cost at most 24 and 8 times") {
    const Triangle zero_row{vertex(0, -7.5f, 1, 0.3f, 0.2f, -1), vertex(0, 24.5f, 1, 0.5f, 0.8f, 1),
                            vertex(1000, 8.5f, 1, 0.2f, 0.9f, 0)};
    require_cost("q = 0 along a row", {zero_row, {30, 8, 64, 4}}, limit::q_is_zero);
    for (const int x : {1000000000, -1000000000})
        require_cost("far away", {ordinary(64, 4).triangle, {x, 100, 64, 4}}, limit::any);
}

// As users have it: the other times are of a state in which subnormal numbers cost nothing.
TEST_CASE("where no coordinate is subnormal, subnormal numbers do not double the time") {
    const auto require_same_cost = [](const char* name, const support::Calls& calls) {
        double ratio = HUGE_VAL;
        for (int attempt = 0; attempt < 5 && ratio > 2.0; ++attempt) {
            std::array<double, 2> least{HUGE_VAL, HUGE_VAL};
            for (int turn = 0; turn < 30; ++turn)
                for (std::size_t i = 0; i < least.size(); ++i)
                    support::under(support::float_states[i],
                                   [&] { least[i] = std::min(least[i], support::detail::nanoseconds_of(calls, 8)); });
            ratio = least[0] / least[1];
        }
        CHECK_MESSAGE(ratio <= 2.0, name, ": ", ratio, " times");
    };
    const auto cut = [](float s, float t) {
        return Triangle{vertex(-544164.188f, 27988.3828f, 0.1f, -69.1f * s, -22.6f * t, -25.1f),
                        vertex(810.03656f, 428.25708f, 97.3841324f, 82.3f * s, 24.5f * t, 30.7f),
                        vertex(525.804382f, 361.901428f, 68.5282516f, 38.5f * s, 12.9f * t, 8.97f)};
    };
    for (const Tolerance tolerance : tolerances) {
        for (const auto& [s, t] : {std::array{0.0f, 0.0f}, std::array{0.0f, 1.0f}, std::array{1.0f, 0.0f}}) {
            const Shot shot{cut(s, t), {169, 428, 64, 4}};
            require_same_cost("zeros", support::calls_of(Workload(shot, tolerance)));
        }
        // Weights that differ by a rounding.
        const float next = 1.0f + 0x1p-23f;
        const Triangle flat{vertex(0.0f, 0.0f, 1.0f, 0.1f, 0.2f, 1.0f), vertex(1000.0f, 0.0f, next, 0.9f, 0.3f, 1.0f),
                            vertex(0.0f, 1000.0f, 1.0f, 0.2f, 0.8f, 1.0f)};
        texgen::TriangleBatch batch(everywhere(), tolerance);
        batch.assign(std::vector<Triangle>(8, flat));
        const std::vector<FragmentRect> rects(8, {300, 300, 8, 8});
        std::vector<float> s(512), t(512);
        require_same_cost("weights", support::calls_of([&] { interpolate(batch, rects, {s, t, {}, {}}); }));
    }
}

}  // namespace triangle_costs
