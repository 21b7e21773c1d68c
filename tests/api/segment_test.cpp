// Segments: C_u = ((1-a) A_u + a B_u) / ((1-a) A_q + a B_q), the nearest float or within the tolerance.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "api/segment_test/families.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/interpolate.hpp"

namespace segment_cases {

using support::same_bits;

TEST_CASE("every value of a segment is the nearest float of the exact rational, in every family") {
    std::uint64_t seed = 4000;
    Classes classes;
    for (const SegmentFamily& family : families) {
        CAPTURE(std::string(family.name));
        Random random(++seed);
        constexpr int members = 150;
        int hard = 0;
        for (int i = 0; i < members; ++i) {
            const Case c = family.make(random, static_cast<std::size_t>(random.integer(1, 90)));
            hard += family.is_hard(c);
            Outputs out(c.alphas.size(), Outputs::all, static_cast<std::size_t>(i % 16));
            require_right(c, any_region(c, random), texgen::exact, out, classes);
        }
        CHECK(hard >= family.least_share * members);
    }
    CHECK(classes.in_front > 20000);
    CHECK(classes.behind > 5000);
    CHECK(classes.on_plane > 500);
    CHECK(classes.lit > 5000);
    CHECK(classes.subnormal > 1000);
    CHECK(classes.infinite > 100);
}

TEST_CASE("the ends of a segment are the quotients of its ends") {
    Random random(4100);
    const std::array<float, 2> ends{0.0f, 1.0f};
    int checked = 0;
    for (int i = 0; i < 20000; ++i) {
        Segment segment{};
        for (int k = 0; k < 4; ++k) {
            segment.a[k] = random.any_finite();
            segment.b[k] = random.any_finite();
        }
        segment.a.w = std::fabs(segment.a.w);
        segment.b.w = std::fabs(segment.b.w);
        if (segment.a.w == 0.0f || segment.b.w == 0.0f) continue;
        Outputs out(2);
        interpolate(segment, ends, everywhere(), out.spans());
        for (int k = 0; k < 3; ++k) {
            const auto array = static_cast<std::size_t>(k);
            REQUIRE_MESSAGE(out[array][0] == segment.a[k] / segment.a.w, hex(segment));
            REQUIRE_MESSAGE(out[array][1] == segment.b[k] / segment.b.w, hex(segment));
        }
        ++checked;
    }
    CHECK(checked > 19000);
}

TEST_CASE("no error on a segment is larger than was accepted, in every family at every tolerance") {
    std::uint64_t seed = 4200;
    Classes classes;
    for (const Tolerance tolerance :
         {texgen::texels(1.0 / 512.0, 4096.0), texgen::texels(1.0 / 16.0, 1024.0), texgen::texels(1.0, 256.0),
          Tolerance{0.1}, Tolerance{10.0}, Tolerance{1e300}, Tolerance{support::infinity_double}}) {
        for (const SegmentFamily& family : families) {
            CAPTURE(std::string(family.name));
            Random random(++seed);
            for (int i = 0; i < 40; ++i) {
                const Case c = family.make(random, static_cast<std::size_t>(random.integer(1, 70)));
                const unsigned asked = random.coin() ? Outputs::all : static_cast<unsigned>(random.integer(0, 15));
                Outputs out(c.alphas.size(), asked, static_cast<std::size_t>(i % 16));
                require_right(c, any_region(c, random), tolerance, out, classes);
            }
        }
    }
    CHECK(classes.in_front > 20000);
    CHECK(classes.behind > 5000);
}

TEST_CASE("a tolerance of some units of the largest coordinate is kept, whatever the unit") {
    std::uint64_t seed = 4300;
    Classes classes;
    for (const SegmentFamily& family : families) {
        CAPTURE(std::string(family.name));
        Random random(++seed);
        for (int i = 0; i < 150; ++i) {
            const Case c = family.make(random, static_cast<std::size_t>(random.integer(1, 70)));
            double largest = 0.0;
            for (const float alpha : {0.0f, 1.0f, c.alphas[0]}) {
                const Homogeneous at = exactly_at(c.segment, alpha);
                for (std::size_t k = 0; k < 3; ++k)
                    if (at.q.sign() > 0) largest = std::max(largest, std::fabs(at.over_q(k).estimate()));
            }
            const double units = std::ldexp(random.uniform(1.0, 2.0), random.integer(-26, -10));
            Outputs out(c.alphas.size(), random.coin() ? Outputs::all : static_cast<unsigned>(random.integer(0, 15)));
            require_right(c, any_region(c, random), {largest * units}, out, classes);
        }
    }
    CHECK(classes.in_front > 20000);
}

TEST_CASE("a tolerance that is not positive means exact") {
    Random random(4400);
    for (int i = 0; i < 100; ++i) {
        const Case c = families[0].make(random, 40);
        Outputs expected(40);
        interpolate(c.segment, c.alphas, texgen::whole_texture(), expected.spans());
        for (const double value : {-1.0, -0.0, support::nan_double, -HUGE_VAL}) {
            Outputs out(40);
            interpolate(c.segment, c.alphas, texgen::whole_texture(), out.spans(), Tolerance{value});
            for (std::size_t k = 0; k < 4; ++k) REQUIRE_MESSAGE(same_bits(out[k], expected[k]), hex(c.segment));
        }
    }
}

TEST_CASE("a value on a segment depends neither on its place, nor on what else is asked, at any length") {
    Random random(4500);
    for (const std::size_t middle : {0u, 8u, 16u, 24u, 32u, 40u, 48u, 56u, 64u, 128u, 256u, 512u, 1000u}) {
        for (std::size_t count = middle < 3 ? 0 : middle - 3; count <= middle + 5; ++count) {
            const SegmentFamily& family = families[static_cast<std::size_t>(random.integer(0, 12))];
            const Case c = family.make(random, count);
            const texgen::TextureRegion region =
                random.coin() ? texgen::whole_texture() : texgen::whole_texture().with_depth(-0.5, 0.5);
            Outputs one_by_one(count);
            for (std::size_t i = 0; i < count; ++i) {
                const texgen::Texcoords all = one_by_one.spans();
                interpolate(c.segment, std::span(c.alphas).subspan(i, 1), region,
                            {.s = all.s.subspan(i, 1),
                             .t = all.t.subspan(i, 1),
                             .r = all.r.subspan(i, 1),
                             .lit = all.lit.subspan(i, 1)});
            }
            for (unsigned asked = 0; asked <= Outputs::all; ++asked) {
                // The alphas at a misaligned address, too.
                const auto shift = static_cast<std::size_t>(random.integer(0, 15));
                std::vector<float> shifted(shift);
                shifted.insert(shifted.end(), c.alphas.begin(), c.alphas.end());
                Outputs out(count, asked, static_cast<std::size_t>(random.integer(0, 15)));
                interpolate(c.segment, std::span<const float>(shifted).subspan(shift), region, out.spans());
                REQUIRE_MESSAGE(out.pads_are_intact(), hex(c.segment));
                for (std::size_t k = 0; k < 4; ++k)
                    if (out.asked(k)) REQUIRE_MESSAGE(same_bits(out[k], one_by_one[k]), family.name, hex(c.segment));
            }
        }
    }
}

TEST_CASE("a segment needs nothing only where nothing is lit, and no test only where all is lit, in every family") {
    std::uint64_t seed = 4700;
    int counts[5] = {};
    for (const SegmentFamily& family : families) {
        CAPTURE(std::string(family.name));
        Random random(++seed);
        for (int i = 0; i < 400; ++i) {
            Case c = family.make(random, 48);
            if (random.integer(0, 3) == 0) c.segment.b.w = c.segment.a.w;
            const texgen::TextureRegion region =
                random.coin() ? any_region(c, random) : texgen::atlas_tile({-4.0, -4.0}, {4.0, 4.0});
            const texgen::Tolerance tolerance = random.coin() ? texgen::exact : texgen::texels(1.0 / 16.0, 1024.0);
            const texgen::Work work = texgen::work(c.segment, region, tolerance);
            ++counts[static_cast<int>(work)];
            CAPTURE(hex(c.segment));
            std::vector<float> lit(c.alphas.size());
            texgen::interpolate(c.segment, c.alphas, region, {.s = {}, .t = {}, .r = {}, .lit = lit}, tolerance);
            for (const float value : lit) {
                if (work == texgen::Work::nothing) REQUIRE(value == 0.0f);
                if (work == texgen::Work::divide) REQUIRE(value == 1.0f);
            }
            const bool is_constant = c.segment.a.w == c.segment.b.w;
            if (work == texgen::Work::affine) REQUIRE(is_constant);
            REQUIRE(work != texgen::Work::quadratic);
        }
    }
    for (const texgen::Work work :
         {texgen::Work::nothing, texgen::Work::affine, texgen::Work::divide, texgen::Work::divide_and_test})
        CHECK(counts[static_cast<int>(work)] > 50);
    CHECK(texgen::work({{0.5f, 0.5f, 0.0f, support::nan_float}, {0.5f, 0.5f, 0.0f, 1.0f}}, texgen::whole_texture()) ==
          texgen::Work::divide_and_test);
    CHECK(texgen::work({{0.5f, 0.5f, 0.0f, -1.0f}, {0.5f, 0.5f, 0.0f, 0.0f}}, texgen::whole_texture()) ==
          texgen::Work::nothing);
    for (int k = 0; k < 3; ++k) {
        for (const float beyond : {-1.0f, 2.0f}) {
            Segment beside{{0.5f, 0.5f, 0.5f, 1.0f}, {0.5f, 0.5f, 0.5f, 2.0f}};
            beside.a[k] = beyond;
            beside.b[k] = 2.0f * beyond;
            CHECK(texgen::work(beside, texgen::whole_texture().with_depth()) == texgen::Work::nothing);
        }
    }
}

TEST_CASE("half-way between two subnormal floats, along a segment, is rounded to even") {
    std::vector<float> alpha, expected;
    for (int k = 0; k < 64; ++k) {
        alpha.push_back(static_cast<float>(std::ldexp(2 * k + 1, -30)));
        expected.push_back(static_cast<float>(std::ldexp(k % 2 == 0 ? k : k + 1, -149)));
    }
    std::vector<float> s(alpha.size()), t(alpha.size());
    const float b = static_cast<float>(std::ldexp(49.0, -120));
    interpolate({{0.0f, 0.0f, 0.0f, 49.0f}, {b, b, 0.0f, 49.0f}}, alpha, texgen::whole_texture(),
                {.s = s, .t = t, .r = {}, .lit = {}});
    CHECK(s == expected);
    CHECK(t == expected);
}

TEST_CASE("half-way between two floats, where quotients in double cancel about an infinite q, is rounded to even") {
    Random random(61);
    int ties = 0;
    for (int i = 0; i < 2000; ++i) {
        // At 1/2 q is a power of two, and the values are (A + B) / 2^n, of 25 bits in a half of all cases.
        const int n = random.integer(2, 12);
        const float half = static_cast<float>(std::ldexp(1.0, n - 1));
        const float a = random.uniform_float(1.0, 2.0), b = random.uniform_float(2.0, 4.0);
        const Segment segment{{a, b, 0.0f, half - 1.0f}, {b, a, 0.0f, half + 1.0f}};
        const double exact_value = std::ldexp(static_cast<double>(a) + static_cast<double>(b), -n);
        const auto expected = static_cast<float>(exact_value);
        const double other = 2.0 * exact_value - static_cast<double>(expected);
        ties += static_cast<double>(expected) != exact_value && static_cast<double>(static_cast<float>(other)) == other
                    ? 1
                    : 0;
        std::vector<float> alpha(64);
        for (float& x : alpha) x = random.uniform_float(0.0, 1.0);
        const auto k = static_cast<std::size_t>(random.integer(0, 63));
        alpha[k] = 0.5f;
        std::vector<float> s(alpha.size()), t(alpha.size());
        interpolate(segment, alpha, texgen::whole_texture(), {.s = s, .t = t, .r = {}, .lit = {}});
        REQUIRE_MESSAGE(s[k] == expected, hex(segment));
        REQUIRE_MESSAGE(t[k] == expected, hex(segment));
    }
    CHECK(ties > 500);
}

TEST_CASE("next to ties of other values subnormal ones are rounded once, however near the middle of two they are") {
    Random random(58);
    int next_to_middles = 0;
    for (int round = 0; round < 2000; ++round) {
        const float end = std::ldexp(random.uniform_float(1.0, 2.0), -40);
        const texgen::Segment segment{{0.0f, 1.0f, 0.0f, 1.0f}, {end, 2.0f, 0.0f, 1.0f}};
        std::vector<float> alpha(64);
        for (std::size_t i = 0; i < alpha.size(); ++i) {
            // 1 + alpha is a tie where alpha is an odd multiple of 2^-24.
            const double middle = (random.integer(1, 4000) + 0.5) * 0x1p-149;
            alpha[i] = random.coin() ? static_cast<float>(2 * random.integer(0, 1 << 22) + 1) * 0x1p-24f
                                     : static_cast<float>(middle / static_cast<double>(end));
        }
        std::vector<float> s(alpha.size()), t(alpha.size());
        interpolate(segment, alpha, everywhere(), {s, t, {}, {}});
        for (std::size_t i = 0; i < alpha.size(); ++i) {
            const double exact_s = static_cast<double>(alpha[i]) * static_cast<double>(end);
            const double exact_t = static_cast<double>(alpha[i]) + 1.0;
            next_to_middles += alpha[i] < 0x1p-80f;
            REQUIRE_MESSAGE(s[i] == static_cast<float>(exact_s), hex(alpha[i]), " of ", hex(end), ": ", hex(s[i]));
            REQUIRE_MESSAGE(t[i] == static_cast<float>(exact_t), hex(alpha[i]), ": ", hex(t[i]));
        }
    }
    CHECK(next_to_middles > 50000);
}

}  // namespace segment_cases
