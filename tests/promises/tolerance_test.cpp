// Tolerances of triangles: whatever error is accepted, no value has a larger one.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "judges/fragments.hpp"
#include "support/hard_triangles.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/interpolate.hpp"

namespace {

using support::count_of;
using support::everywhere;
using support::ExactTriangle;
using support::HardFamily;
using support::hex;
using support::Outputs;
using support::Random;
using support::same_bits;
using support::setup_of;
using support::Shot;
using texgen::FragmentRect;
using texgen::Tolerance;
using texgen::Work;

constexpr std::array tolerances{texgen::exact,
                                texgen::texels(1.0 / 512.0, 4096.0),
                                texgen::texels(1.0 / 16.0, 1024.0),
                                texgen::texels(1.0, 256.0),
                                Tolerance{0.1},
                                Tolerance{10.0}};

// Of every width: of short rows, at the ends of chunks and vectors, of many chunks; now and then of more rows than a
// band has.
FragmentRect resized(FragmentRect rect, Random& random) {
    if (std::abs(static_cast<std::int64_t>(rect.x)) > 2000000000) return rect;
    const int shape = random.integer(0, 5);
    rect.width = shape == 0   ? random.integer(1, 67)
                 : shape == 1 ? random.integer(125, 135)
                 : shape == 2 ? random.integer(253, 260)
                 : shape == 3 ? random.integer(256, 1100)
                              : random.integer(30, 90);
    // So many that polynomials pay, or a few; now and then more rows than a band has.
    rect.height = random.integer(1, 3);
    if (random.coin()) rect.height = 1 + 256 / rect.width;
    if (random.integer(0, 9) == 0) rect.height = random.integer(30, 70);
    rect.x -= random.integer(0, rect.width - 1);
    rect.y -= random.integer(0, rect.height - 1);
    return rect;
}

struct Tally {
    support::Seen seen;
    int affine = 0, quadratic = 0, divide = 0;
    double largest_share = 0.0;  // of the tolerance, by an error beyond the rounding
};

// Some fragments of the rectangle, among them the first and the last; each value, and the bound on its error.
void require_right(const Shot& shot, const texgen::TextureRegion& region, Tolerance tolerance, unsigned asked,
                   Random& random, Tally& tally) {
    const texgen::TriangleSetup setup = setup_of(shot.triangle, region, tolerance);
    const ExactTriangle exact(shot.triangle);
    Outputs out(count_of(shot.rect), asked, static_cast<std::size_t>(random.integer(0, 15)));
    const Work work = interpolate(setup, shot.rect, out.spans());
    const auto context = [&] { return hex(tolerance.value) + " for " + hex(shot); };
    REQUIRE_MESSAGE(work == setup.work(shot.rect), context());
    REQUIRE_MESSAGE(out.pads_are_intact(), context());
    tally.affine += work == Work::affine;
    tally.quadratic += work == Work::quadratic;
    tally.divide += work == Work::divide || work == Work::divide_and_test;
    for (std::size_t k = 0; k < 4 && work != Work::nothing; ++k)
        if (out.asked(k))
            REQUIRE_MESSAGE(
                std::none_of(out[k].begin(), out[k].end(), [](float value) { return Outputs::is_poison(value); }),
                context());

    const glm::dvec2 bound = setup.error_bound(shot.rect);
    const std::size_t step = 1 + out.size() / static_cast<std::size_t>(random.integer(60, 120));
    for (std::size_t i = 0; i < out.size(); i += std::min(step, std::max<std::size_t>(1, out.size() - 1 - i))) {
        const std::string wrong = what_is_wrong(shot, exact, region, tolerance, work, out, i, tally.seen);
        REQUIRE_MESSAGE(wrong.empty(), wrong, " with ", context());
        const auto [x, y] = shot.fragment(i);
        if (work == Work::nothing || !exact.has_positive_w(x, y)) continue;
        const support::Homogeneous at = exact.at(x, y);
        if (at.q.sign() <= 0) continue;
        for (std::size_t k = 0; k < 2; ++k) {
            if (!out.asked(k) || !std::isfinite(out[k][i])) continue;
            const double error = support::distance(static_cast<double>(out[k][i]), at.over_q(k));
            REQUIRE_MESSAGE(error <= bound[static_cast<int>(k)] * (1.0 + 1e-12), "error_bound with ", context());
            const double rounding = 0x1p-24 * std::fabs(static_cast<double>(out[k][i])) + 0x1p-150;
            if (tolerance.value > 4.0 * rounding)
                tally.largest_share = std::max(tally.largest_share, (error - rounding) / tolerance.value);
        }
    }
}

unsigned any_outputs(Random& random) {
    return random.coin() ? Outputs::all : static_cast<unsigned>(random.integer(1, 15));
}

// Of s, t and r at the corners and in the middle of the rectangle.
double largest_quotient(const Shot& shot) {
    const ExactTriangle exact(shot.triangle);
    double largest = 0.0;
    for (std::int64_t i = 0; i < 9; ++i) {
        const support::Homogeneous at =
            exact.at(shot.x((i % 3) * (shot.rect.width - 1) / 2), shot.y((i / 3) * (shot.rect.height - 1) / 2));
        for (std::size_t k = 0; k < 3; ++k)
            if (at.q.sign() > 0) largest = std::max(largest, std::fabs(at.over_q(k).estimate()));
    }
    return largest;
}

// Where the rectangle's work becomes as little as this; infinite where no tolerance makes it so.
double least_tolerance(const Shot& shot, Work work) {
    const auto suffices = [&](double tolerance) {
        const Work needed = setup_of(shot.triangle, everywhere(), {tolerance}).work(shot.rect);
        return needed <= work && needed != Work::nothing;
    };
    const double unit = largest_quotient(shot);
    double low = unit * 0x1p-30, high = unit * 0x1p10;
    if (!(low > 0.0) || suffices(low) || !suffices(high)) return HUGE_VAL;
    while (high > low * (1.0 + 0x1p-40)) {
        const double middle = std::sqrt(low) * std::sqrt(high);
        (suffices(middle) ? high : low) = middle;
    }
    return high;
}

}  // namespace

TEST_CASE("no error is larger than was accepted, in every family at every tolerance") {
    std::uint64_t seed = 2000;
    Tally tally;
    for (const Tolerance tolerance : tolerances) {
        for (const HardFamily& family : support::hard_families) {
            CAPTURE(std::string(family.name));
            Random random(++seed);
            for (int i = 0; i < 50; ++i) {
                Shot shot = family.make(random);
                shot.rect = resized(shot.rect, random);
                const texgen::TextureRegion region =
                    random.coin() ? support::region_at(shot, ExactTriangle(shot.triangle), random)
                                  : texgen::whole_texture();
                require_right(shot, random.integer(0, 2) == 0 ? region : everywhere(), tolerance, any_outputs(random),
                              random, tally);
            }
        }
    }
    CHECK(tally.affine > 300);
    CHECK(tally.quadratic > 80);
    CHECK(tally.divide > 2000);
    CHECK(tally.seen.in_front > 100000);
    CHECK(tally.seen.behind > 5000);
    CHECK(tally.seen.lit > 10000);
    CHECK(tally.seen.dark > 10000);
    CHECK(tally.largest_share > 0.8);
    CHECK(tally.largest_share < 1.0);
}

TEST_CASE("a tolerance of some units of the largest coordinate is kept, whatever the unit") {
    std::uint64_t seed = 2200;
    Tally tally;
    for (const HardFamily& family : support::hard_families) {
        CAPTURE(std::string(family.name));
        Random random(++seed);
        for (int i = 0; i < 200; ++i) {
            Shot shot = family.make(random);
            shot.rect = resized(shot.rect, random);
            const double units = std::ldexp(random.uniform(1.0, 2.0), random.integer(-27, -4));
            require_right(shot, everywhere(), {units * largest_quotient(shot)}, any_outputs(random), random, tally);
        }
    }
    CHECK(tally.affine > 300);
    CHECK(tally.quadratic > 100);
    CHECK(tally.divide > 1000);
}

TEST_CASE("a tolerance at which a certificate just holds, or just fails, is kept") {
    std::uint64_t seed = 2400;
    Tally affine, quadratic;
    for (const HardFamily& family : support::hard_families) {
        CAPTURE(std::string(family.name));
        Random random(++seed);
        for (int i = 0; i < 60; ++i) {
            Shot shot = family.make(random);
            shot.rect = resized(shot.rect, random);
            for (const Work work : {Work::affine, Work::quadratic}) {
                const double threshold = least_tolerance(shot, work);
                if (!std::isfinite(threshold)) continue;
                Tally& tally = work == Work::affine ? affine : quadratic;
                for (const double factor :
                     {1.0, 1.0 - 0x1p-30, 1.0 + 0x1p-30, random.uniform(0.5, 1.0), random.uniform(1.0, 2.0)})
                    require_right(shot, everywhere(), {threshold * factor}, any_outputs(random), random, tally);
            }
        }
    }
    CHECK(affine.affine > 500);
    CHECK(affine.largest_share > 0.1);  // what is affine is computed as a parabola
    CHECK(quadratic.quadratic > 300);
    CHECK(quadratic.largest_share > 0.5);
}

namespace {

// Of what is divided in float as a whole: eight columns, or 16 to 64 in enough rows.
texgen::FragmentRect draw_tile_for_float(Random& random) {
    const int x = random.integer(20, 150), y = random.integer(20, 150);
    if (random.coin()) return {x, y, 8, 2 * random.integer(1, 16)};
    const int width = random.integer(16, random.coin() ? 32 : 64);
    const int least = std::max(4, (width + 7) / 8);
    return {x, y, width, random.integer(least, random.coin() ? least : 512 / width)};
}

}  // namespace

TEST_CASE("a tolerance at which small tiles are just divided in float is kept") {
    Random random(2600);
    Tally tally;
    int alone = 0, together = 0, wide = 0;
    for (int i = 0; i < 600; ++i) {
        texgen::Triangle triangle{};
        for (texgen::WindowVertex* const corner : support::vertices(triangle)) {
            const float x = random.uniform_float(0.0, 200.0), y = random.uniform_float(0.0, 200.0);
            const float clip_w = random.uniform_float(1.0, 3.0), q = random.uniform_float(0.5, 2.0);
            const float s = random.uniform_float(0.0, 1.0), t = random.uniform_float(0.0, 1.0);
            *corner = {{x, y}, clip_w, glm::vec4(s, t, random.uniform_float(-0.5, 1.0), 1.0f) * q};
        }
        const Shot shot{triangle, draw_tile_for_float(random)};
        wide += shot.rect.width > 8;
        const unsigned asked = any_outputs(random);
        const auto values = [&](Tolerance tolerance) {
            Outputs out(count_of(shot.rect), asked);
            interpolate(setup_of(triangle, texgen::whole_texture(), tolerance), shot.rect, out.spans());
            return out;
        };
        const Outputs exact = values(texgen::exact);
        const auto is_in_float = [&](double tolerance) {
            const Outputs out = values({tolerance});
            for (std::size_t k = 0; k < 3; ++k)
                if (out.asked(k) && !same_bits(out[k], exact[k])) return true;
            return false;
        };
        double low = largest_quotient(shot) * 0x1p-30, high = low * 0x1p10;
        if (is_in_float(low)) {
            // A polynomial, of a coordinate that is so much smaller than another.
            REQUIRE_MESSAGE(count_of(shot.rect) > 128, hex(low), " for ", hex(shot));
            continue;
        }
        if (!is_in_float(high)) continue;
        while (high > low * (1.0 + 0x1p-20)) {
            const double middle = 0.5 * (low + high);
            (is_in_float(middle) ? high : low) = middle;
        }
        (std::popcount(asked & 7u) == 1 ? alone : together) += 1;
        for (const double factor : {1.0, random.uniform(1.0, 2.0)})
            require_right(shot, texgen::whole_texture(), {high * factor}, asked, random, tally);
    }
    CHECK(alone > 30);
    CHECK(together > 50);
    CHECK(wide > 200);
    CHECK(tally.largest_share > 0.2);
}

TEST_CASE(
    "a tolerance that the rounding of a polynomial uses up is kept where coordinates are larger than in the middle") {
    // s and t grow from 0 in the middle to 1 at the ends, almost evenly, so that only the rounding of the coefficients
    // and of the last sum tells the chunks apart.
    Random random(2500);
    Tally tally;
    int tried = 0;
    for (int i = 0; i < 40; ++i) {
        const int width = 32 * random.integer(128, 256);
        const double bend = random.power_of_ten(-5.0, -3.0), turn = random.uniform(0.9, 1.1);
        texgen::Triangle triangle{};
        const auto corner = support::vertices(triangle);
        for (std::size_t v = 0; v < 3; ++v) {
            const float x = v == 1 ? static_cast<float>(width) : 0.0f, y = v == 2 ? 64.0f : 0.0f;
            const double across = 2.0 * static_cast<double>(x) / width - 1.0, q = 1.0 + bend * across;
            *corner[v] = {{x, y}, 1.0f, glm::vec4(q * across, -turn * q * across, 0.5 * q, q)};
        }
        const Shot shot{triangle, {0, random.integer(0, 20), width, random.integer(1, 3)}};
        // A unit below 1 is 2^-24: c0 and the sum may err by half of one each.
        const Tolerance tolerance{random.uniform(0.65, 0.95) * 0x1p-24};
        Outputs exact(count_of(shot.rect)), out(count_of(shot.rect));
        interpolate(setup_of(triangle), shot.rect, exact.spans());
        interpolate(setup_of(triangle, everywhere(), tolerance), shot.rect, out.spans());
        tried += !same_bits(out.s(), exact.s());
        require_right(shot, everywhere(), tolerance, Outputs::all, random, tally);
    }
    CHECK(tried > 20);
}

TEST_CASE("a tolerance that is not positive means exact; an infinite one is a tolerance") {
    Random random(2600);
    for (const HardFamily& family : support::hard_families) {
        for (int i = 0; i < 5; ++i) {
            Shot shot = family.make(random);
            shot.rect = resized(shot.rect, random);
            Outputs expected(count_of(shot.rect));
            interpolate(setup_of(shot.triangle), shot.rect, expected.spans());
            for (const double value : {-1.0, -0.0, support::nan_double, -HUGE_VAL}) {
                Outputs out(count_of(shot.rect));
                interpolate(setup_of(shot.triangle, everywhere(), {value}), shot.rect, out.spans());
                for (std::size_t k = 0; k < 4; ++k) REQUIRE_MESSAGE(same_bits(out[k], expected[k]), hex(shot));
            }
            Tally tally;
            for (const double value : {1e300, HUGE_VAL, 5e-324})
                require_right(shot, everywhere(), {value}, Outputs::all, random, tally);
        }
    }
}
