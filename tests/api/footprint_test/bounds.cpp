// Bounds and tolerances of derivatives are kept, and are not far above the errors.

#include "texgen/footprint.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "api/footprint_test/derivatives.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "support/footprint_outputs.hpp"
#include "support/hard_triangles.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/triangles.hpp"
#include "texgen/interpolate.hpp"

namespace footprint_cases {

using support::everywhere;

namespace {

// Makes the third corner's q what has q at a pixel be this share of its term.
void make_q_small(Triangle& triangle, const FragmentRect& pixel, double share) {
    const double x = pixel.x + 0.5, y = pixel.y + 0.5;
    const auto corner = support::vertices(triangle);
    double part[3], rest = 0.0;
    for (std::size_t v = 0; v < 3; ++v) {
        const WindowVertex &j = *corner[(v + 1) % 3], &k = *corner[(v + 2) % 3];
        part[v] = ((static_cast<double>(j.window.x) - x) * (static_cast<double>(k.window.y) - y) -
                   (static_cast<double>(j.window.y) - y) * (static_cast<double>(k.window.x) - x)) /
                  static_cast<double>(corner[v]->clip_w);
        if (v < 2) rest += part[v] * static_cast<double>(corner[v]->strq.w);
    }
    triangle.c.strq.w = support::to_float(-rest / part[2] * (1.0 + share));
}

}  // namespace

TEST_CASE("a tolerance is kept in units a pixel, and some of it is used") {
    std::uint64_t seed = 6300;
    int checked = 0, differ = 0;
    for (const support::HardFamily& family : support::hard_families) {
        Random random(++seed);
        for (int i = 0; i < 40; ++i) {
            const Shot shot = family.make(random);
            const ExactTriangle exact(shot.triangle);
            const double tolerance = random.power_of_ten(-8.0, -2.0);
            const FootprintSetup setup(setup_of(shot.triangle, everywhere(), Tolerance{tolerance}), {1024.0, 1024.0});
            const FootprintSetup strict(setup_of(shot.triangle), {1024.0, 1024.0});
            FootprintOutputs out(shot.rect), of_exact(shot.rect);
            if (!footprint(setup, shot.rect, out.spans())) continue;
            footprint(strict, shot.rect, of_exact.spans());
            const glm::dvec2 bound = setup.error_bound(shot.rect);
            for (std::size_t k = 0; k < count_of(shot.rect); k += 1 + count_of(shot.rect) / 4) {
                const auto [x, y] = shot.fragment(k);
                if (!exact.has_positive_w(x, y) || exact.at(x, y).q.sign() <= 0) continue;
                const ExactFootprint truth(exact, x, y);
                for (std::size_t c = 0; c < 2; ++c) {
                    const double error = std::max(distance(out.at(dsdx + c, k), truth.dx[c]),
                                                  distance(out.at(dsdy + c, k), truth.dy[c]));
                    if (std::isnan(error) || std::isinf(error)) continue;
                    REQUIRE_MESSAGE(error <= bound[static_cast<int>(c)], family.name << " " << hex(shot));
                    ++checked;
                    differ += !same_bits(out[dsdx + c][k], of_exact[dsdx + c][k]);
                }
            }
        }
    }
    MESSAGE(checked, " derivatives, ", differ, " with other bits than those of exact");
    CHECK(checked > 2000);
    CHECK(differ > 300);
}

TEST_CASE("a tolerance of a few units of the derivatives is kept, where floats just serve or just do not") {
    Random random(6350);
    int in_float = 0, in_double = 0;
    for (int i = 0; i < 600; ++i) {
        const Triangle triangle = spread_triangle(random, random.uniform(1.0, 2.0));
        const FragmentRect pixel = support::pixel_near(triangle, random);
        const Shot shot{triangle, {pixel.x, pixel.y, 24, 2}};
        const ExactTriangle exact(triangle);
        const FootprintSetup strict(setup_of(triangle), {1.0, 1.0});
        const glm::dvec2 unit = strict.error_bound(shot.rect);
        if (!std::isfinite(unit.x) || !std::isfinite(unit.y)) continue;
        const Tolerance tolerance{std::max(unit.x, unit.y) * random.power_of_ten(0.0, 1.5)};
        const FootprintSetup setup(setup_of(triangle, everywhere(), tolerance), {1.0, 1.0});
        FootprintOutputs out(shot.rect), of_exact(shot.rect);
        if (!footprint(setup, shot.rect, out.spans())) continue;
        footprint(strict, shot.rect, of_exact.spans());
        bool differs = false;
        for (std::size_t o = 0; o < 4; ++o) differs = differs || !same_bits(out[o], of_exact[o]);
        ++(differs ? in_float : in_double);
        const glm::dvec2 bound = setup.error_bound(shot.rect);
        for (std::size_t k = 0; k < count_of(shot.rect); k += 5) {
            const auto [x, y] = shot.fragment(k);
            if (!exact.has_positive_w(x, y) || exact.at(x, y).q.sign() <= 0) continue;
            const ExactFootprint truth(exact, x, y);
            for (std::size_t c = 0; c < 2; ++c) {
                const double error =
                    std::max(distance(out.at(dsdx + c, k), truth.dx[c]), distance(out.at(dsdy + c, k), truth.dy[c]));
                REQUIRE_MESSAGE(error <= bound[static_cast<int>(c)], hex(tolerance.value) << " " << hex(shot));
            }
        }
    }
    CHECK(in_float > 100);
    CHECK(in_double > 100);
}

TEST_CASE("where q has few digits left the bound of a derivative has them in it") {
    Random random(6360);
    int close = 0;
    for (int i = 0; i < 20000; ++i) {
        Triangle triangle = spread_triangle(random, 3.0);
        const FragmentRect pixel = support::pixel_near(triangle, random);
        make_q_small(triangle, pixel, std::ldexp(random.integer(-4, 4), random.coin() ? -23 : -11));
        const FootprintSetup setup(setup_of(triangle), {1.0, 1.0});
        const glm::dvec2 bound = setup.error_bound(pixel);
        FootprintOutputs out(pixel);
        if (!std::isfinite(bound.x) || !footprint(setup, pixel, out.spans())) continue;
        const ExactTriangle exact(triangle);
        if (!exact.has_positive_w(pixel.x, pixel.y) || exact.at(pixel.x, pixel.y).q.sign() <= 0) continue;
        ++close;
        const ExactFootprint truth(exact, pixel.x, pixel.y);
        for (std::size_t c = 0; c < 2; ++c) {
            const double error =
                std::max(distance(out.at(dsdx + c, 0), truth.dx[c]), distance(out.at(dsdy + c, 0), truth.dy[c]));
            if (std::isfinite(error)) REQUIRE_MESSAGE(error <= bound[static_cast<int>(c)], hex(triangle));
        }
        // In double it holds without the rounding to float, of the larger derivative.
        const auto one = setup.at(pixel.x, pixel.y);
        REQUIRE(one.has_value());
        for (int c = 0; c < 2; ++c) {
            const auto k = static_cast<std::size_t>(c);
            const double rounding = 0x1p-24 * std::max(std::fabs(one->dx[c]), std::fabs(one->dy[c])) + 0x1p-150;
            const double error = std::max(distance(one->dx[c], truth.dx[k]), distance(one->dy[c], truth.dy[k]));
            REQUIRE_MESSAGE(error <= bound[c] - rounding, hex(triangle));
        }
    }
    CHECK(close > 1000);
}

TEST_CASE(
    "the bound of derivatives holds in double where the planes leave digits of q in a part of the rectangle alone") {
    // Of a large triangle q varies by little from one fragment to the next, and is about 2^-12 of its terms.
    Random random(6370);
    int checked = 0;
    double worst = 0.0;
    for (int i = 0; i < 3000; ++i) {
        Triangle triangle = spread_triangle(random, 3.0);
        for (WindowVertex* const vertex : support::vertices(triangle)) vertex->window *= 0x1p10f;
        const FragmentRect pixel = support::pixel_near(triangle, random);
        make_q_small(triangle, pixel, random.uniform(-1.0, 1.0) * std::exp2(random.uniform(-14.0, -9.0)));
        const FragmentRect row{pixel.x, pixel.y, 64, 1};
        const FootprintSetup setup(setup_of(triangle), {1.0, 1.0});
        const ExactTriangle exact(triangle);
        const auto q_at = [&](int x) { return exact.at(x, row.y).q.estimate(); };
        const int last = row.x + row.width - 1;
        const double least_q = std::min(q_at(row.x), q_at(last));
        const glm::dvec2 bound = setup.error_bound(row);
        if (!(least_q > 0.0) || !std::isfinite(bound.x)) continue;
        const ExactFootprint truth[2] = {ExactFootprint(exact, row.x, row.y), ExactFootprint(exact, last, row.y)};
        const int x[2] = {row.x, last};
        for (int c = 0; c < 2; ++c) {
            const auto k = static_cast<std::size_t>(c);
            // What is rounded to a float at most: the largest numerator over the square of the least q.
            double largest = 0.0;
            for (std::size_t end = 0; end < 2; ++end) {
                const double scale = q_at(x[end]) / least_q;
                const double size = std::max(distance(0.0, truth[end].dx[k]), distance(0.0, truth[end].dy[k]));
                largest = std::max(largest, size * scale * scale);
            }
            for (std::size_t end = 0; end < 2; ++end) {
                const auto one = setup.at(x[end], row.y);
                REQUIRE(one.has_value());
                const double error =
                    std::max(distance(one->dx[c], truth[end].dx[k]), distance(one->dy[c], truth[end].dy[k]));
                const double in_double = bound[c] - (0x1p-24 * largest + 0x1p-150);
                REQUIRE_MESSAGE(error <= in_double, hex(triangle));
                worst = std::max(worst, error / in_double);
                ++checked;
            }
        }
    }
    CHECK(checked > 1000);
    CHECK(worst > 0.01);
}

TEST_CASE("triangles that double cannot hold the differences of keep their bounds and their extremes") {
    // Corners that differ by 2^-142 of the third's distance; a Q that grows to 2^269 over one pixel; and weights of
    // 2^-410, of which products of two are below all doubles; and a Q of 2^-514, the square of which is below all
    // doubles.
    const auto corner = [](float x, float y, float w, const glm::vec4& strq) { return WindowVertex{{x, y}, w, strq}; };
    const float tiny = 0x1.fcp-143f;
    const Triangle close{corner(-1.0f, 1.0f, 256.0f, {-1.0f, 62.0f, 2.0f, -0.0f}),
                         corner(-0.0f, -tiny, 165.0f, {tiny, 2.0f * tiny, -2.0f * tiny, 2.0f * tiny}),
                         corner(-2.0f * tiny, 2.0f * tiny, 256.0f, {-2.0f * tiny, 2.0f * tiny, -tiny, 2.0f * tiny})};
    const Triangle steep{corner(0.0f, 0.0f, 238.0f, {0.0f, 0.0f, 0.0f, 0.0f}),
                         corner(0.0f, -tiny, 256.0f, {tiny, -tiny, tiny, -0x1.f5fffep+127f}),
                         corner(-0x1p+80f, 0x1p+80f, 1.0f, {-0x1p+80f, 0x1p+80f, -0x1p+80f, -1.0f})};
    const Triangle faint{corner(0.0f, 0x1.fffffep+127f, 0x1.2p-146f, {0.0f, 0.0f, 0.0f, 0.0f}),
                         corner(0x1.fffffep+127f, -0x1.fffffep+127f, 47.0f, {0.0f, 0.0f, 0.0f, 0x1.78p-144f}),
                         corner(tiny, 2.0f * tiny, 47.0f, {tiny, 2.0f * tiny, tiny, 2.0f * tiny})};
    const Triangle dim{corner(0x1.fffffep+127f, 0x1.ffff26p+127f, 0x1.fffe4ep+127f, {1.0f, 2.0f, 3.0f, 0x1p-126f}),
                       corner(0x1p-126f, 0x1.323232p-77f, 26.0f, {0.0f, 0.0f, 0.0f, 0.0f}),
                       corner(-0x1p-8f, 0x1p-8f, 26.0f, {0.0f, 0.0f, 0.0f, 0.0f})};
    for (const Triangle& triangle : {close, steep, faint, dim}) {
        int bounded = 0;
        const ExactTriangle exact(triangle);
        const FootprintSetup setup(setup_of(triangle), {4096.0, 128.0});
        for (int y = -300; y < 300; y += 13) {
            for (int x = -300; x < 300; x += 7) {
                const auto one = setup.at(x, y);
                if (!exact.has_positive_w(x, y) || !one) continue;
                const auto extremes = setup.extremes({x, y, 1, 1});
                REQUIRE(extremes.has_value());
                const std::string context = "fragment " + std::to_string(x) + " " + std::to_string(y);
                REQUIRE_MESSAGE(one->level >= extremes->least_level, context);
                REQUIRE_MESSAGE(one->level <= extremes->largest_level, context);
                const glm::dvec2 bound = setup.error_bound({x, y, 1, 1});
                const ExactFootprint truth(exact, x, y);
                FootprintOutputs out({x, y, 1, 1});
                REQUIRE(footprint(setup, {x, y, 1, 1}, out.spans()));
                for (std::size_t c = 0; c < 2; ++c) {
                    const double allowed = bound[static_cast<int>(c)];
                    if (std::isinf(allowed)) continue;
                    ++bounded;
                    REQUIRE_MESSAGE(distance(out.at(dsdx + c, 0), truth.dx[c]) <= allowed, context);
                    REQUIRE_MESSAGE(distance(out.at(dsdy + c, 0), truth.dy[c]) <= allowed, context);
                    REQUIRE_MESSAGE(distance(one->dx[static_cast<int>(c)], truth.dx[c]) <= allowed, context);
                    REQUIRE_MESSAGE(distance(one->dy[static_cast<int>(c)], truth.dy[c]) <= allowed, context);
                }
            }
        }
        CHECK(bounded > 500);
    }
}

}  // namespace footprint_cases
