// A NaN, an infinity and random bits in a segment or its alphas spoil what is made of them, and nothing else.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "api/segment_test/families.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/verdict.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/interpolate.hpp"

namespace segment_cases {

using support::infinity_float;
using support::nan_float;

TEST_CASE("a NaN in alpha spoils its own value only") {
    Random random(4600);
    for (const Tolerance tolerance : {texgen::exact, Tolerance{1e-4}}) {
        for (int i = 0; i < 200; ++i) {
            Case c = families[static_cast<std::size_t>(random.integer(0, 12))].make(random, 50);
            std::vector<bool> bad(50);
            for (std::size_t j = 0; j < 50; ++j) {
                if (random.integer(0, 4) != 0) continue;
                bad[j] = true;
                c.alphas[j] = random.coin() ? nan_float : -nan_float;
            }
            Outputs out(50);
            interpolate(c.segment, c.alphas, texgen::whole_texture(), out.spans(), tolerance);
            for (std::size_t j = 0; j < 50; ++j) {
                if (bad[j]) {
                    REQUIRE_MESSAGE(out.lit()[j] == 0.0f, hex(c.segment));
                    continue;
                }
                const std::string wrong =
                    what_is_wrong(exactly_at(c.segment, c.alphas[j]), texgen::whole_texture(), tolerance, out, j);
                REQUIRE_MESSAGE(wrong.empty(), wrong, " at alpha ", hex(c.alphas[j]), " of ", hex(c.segment));
            }
        }
    }
}

TEST_CASE("an alpha that is NaN is behind, alone and in any company") {
    const texgen::Segment segment{{0.5f, 0.5f, 0.5f, 1.0f}, {1.0f, 0.5f, 0.25f, 2.0f}};
    for (const std::size_t count : {1u, 3u, 16u, 64u, 100u}) {
        for (std::size_t bad = 0; bad < count; bad += 7) {
            std::vector<float> alpha(count, 0.5f);
            alpha[bad] = nan_float;
            Outputs out(count);
            interpolate(segment, alpha, everywhere(), out.spans());
            for (std::size_t k = 0; k < 4; ++k) REQUIRE(support::same_bits(out[k][bad], 0.0f));
        }
    }
}

TEST_CASE("a bad coordinate of an end spoils that coordinate only; a bad q, and everything is dark") {
    Random random(4700);
    for (const Tolerance tolerance : {texgen::exact, Tolerance{1e-4}}) {
        for (const float bad : {nan_float, infinity_float, -infinity_float}) {
            for (int coordinate = 0; coordinate < 4; ++coordinate) {
                for (const bool at_a : {false, true}) {
                    Case c = families[0].make(random, 40);
                    for (float& alpha : c.alphas) alpha = std::clamp(alpha, 0x1p-20f, 1.0f - 0x1p-20f);
                    const Segment good = c.segment;
                    (at_a ? c.segment.a : c.segment.b)[coordinate] = bad;
                    Outputs out(40), expected(40);
                    interpolate(c.segment, c.alphas, texgen::whole_texture(), out.spans(), tolerance);
                    interpolate(good, c.alphas, texgen::whole_texture(), expected.spans(), tolerance);
                    for (std::size_t j = 0; j < 40; ++j) {
                        const Homogeneous at = exactly_at(good, c.alphas[j]);
                        for (std::size_t k = 0; k < 3 && coordinate < 3; ++k)
                            if (static_cast<int>(k) != coordinate)
                                REQUIRE_MESSAGE(support::keeps(out[k][j], at.over_q(k), k, tolerance), hex(c.segment));
                        if (coordinate != 2) REQUIRE_MESSAGE(out.lit()[j] == 0.0f, hex(c.segment));
                    }
                }
            }
        }
    }
}

TEST_CASE("segments of random bits, not finite ones too, write nothing but their outputs") {
    Random random(4800);
    for (int i = 0; i < 20000; ++i) {
        Segment segment{};
        for (int k = 0; k < 4; ++k) {
            segment.a[k] = random.any_float();
            segment.b[k] = random.any_float();
        }
        const Case c{segment, any_alphas(random, static_cast<std::size_t>(random.integer(0, 40)))};
        const texgen::TextureRegion region =
            texgen::atlas_tile({random.any_float(), random.any_float()}, {random.any_float(), random.any_float()});
        Outputs out(c.alphas.size());
        interpolate(segment, c.alphas, region, out.spans(), Tolerance{static_cast<double>(random.any_float())});
        REQUIRE(out.pads_are_intact());
        for (const float lit : out.lit()) REQUIRE((lit == 0.0f || lit == 1.0f));
    }
}

}  // namespace segment_cases
