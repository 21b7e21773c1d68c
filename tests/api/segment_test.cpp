// Segments: C_u = ((1-a) A_u + a B_u) / ((1-a) A_q + a B_q), the nearest float or within the tolerance.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/verdict.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/interpolate.hpp"

namespace {

using support::everywhere;
using support::exactly_at;
using support::hex;
using support::Homogeneous;
using support::infinity_float;
using support::is_tie;
using support::nan_float;
using support::Outputs;
using support::Random;
using support::same_bits;
using texgen::Segment;
using texgen::Tolerance;

constexpr float least_float = std::numeric_limits<float>::denorm_min();
constexpr float largest_float = std::numeric_limits<float>::max();

std::string hex(const Segment& segment) { return "{" + hex(segment.a) + ", " + hex(segment.b) + "}"; }

// In [0, 1]: the ends and next to them, tiny ones, and any.
float any_alpha(Random& random) {
    switch (random.integer(0, 7)) {
        case 0:
            return 0.0f;
        case 1:
            return 1.0f;
        case 2:
            return 1.0f - static_cast<float>(random.integer(1, 5)) * 0x1p-24f;
        case 3:
            return std::bit_cast<float>(static_cast<std::uint32_t>(random.integer(1, 0x3f800000)));
        case 4:
            return static_cast<float>(random.integer(0, 64)) / 64.0f;
        default:
            return random.uniform_float(0.0, 1.0);
    }
}

std::vector<float> any_alphas(Random& random, std::size_t count) {
    std::vector<float> alphas(count);
    for (float& alpha : alphas) alpha = any_alpha(random);
    return alphas;
}

glm::vec4 friendly(Random& random) {
    const double q = random.uniform(0.5, 4.0);
    const double s = random.uniform(-0.5, 1.5), t = random.uniform(-0.5, 1.5), r = random.uniform(0.0, 1.0);
    return {static_cast<float>(s * q), static_cast<float>(t * q), static_cast<float>(r * q), static_cast<float>(q)};
}

// The root of q, where it is in (0, 1), and its neighbours.
std::vector<float> alphas_at_root(const Segment& segment, Random& random, std::size_t count) {
    std::vector<float> alphas = any_alphas(random, count);
    const double a = segment.a.w, b = segment.b.w;
    const auto root = static_cast<float>(a / (a - b));
    if (!(root > 0.0f && root < 1.0f)) return alphas;
    for (float& alpha : alphas)
        if (random.integer(0, 3) != 0) alpha = std::clamp(support::neighbour(root, random.integer(-4, 4)), 0.0f, 1.0f);
    return alphas;
}

struct Case {
    Segment segment;
    std::vector<float> alphas;
};

struct SegmentFamily {
    const char* name;
    Case (*make)(Random&, std::size_t count);
    bool (*is_hard)(const Case&);
    double least_share;
};

bool any_of(const Case& c, bool (*predicate)(const Homogeneous&)) {
    return std::any_of(c.alphas.begin(), c.alphas.end(),
                       [&](float alpha) { return predicate(exactly_at(c.segment, alpha)); });
}

const std::array families{
    SegmentFamily{"friendly",
                  [](Random& random, std::size_t count) -> Case {
                      const glm::vec4 a = friendly(random);
                      return {{a, friendly(random)}, any_alphas(random, count)};
                  },
                  [](const Case&) { return true; }, 1.0},
    SegmentFamily{"A >> B and alpha next to 1",
                  [](Random& random, std::size_t count) -> Case {
                      const glm::vec4 a = friendly(random) * static_cast<float>(random.power_of_ten(5.0, 12.0));
                      Case c{{a, friendly(random)}, std::vector<float>(count)};
                      for (float& alpha : c.alphas)
                          alpha = 1.0f - static_cast<float>(random.integer(0, 5)) * 0x1p-24f -
                                  static_cast<float>(random.coin() ? 0.0 : random.power_of_ten(-7.0, -4.0));
                      return c;
                  },
                  [](const Case& c) { return std::fabs(c.segment.a.w) > 1e4f * std::fabs(c.segment.b.w); }, 0.9},
    SegmentFamily{"A << B and tiny alpha",
                  [](Random& random, std::size_t count) -> Case {
                      const glm::vec4 a = friendly(random);
                      Case c{{a, friendly(random) * static_cast<float>(random.power_of_ten(5.0, 30.0))},
                             std::vector<float>(count)};
                      for (float& alpha : c.alphas) alpha = static_cast<float>(random.power_of_ten(-45.0, -4.0));
                      return c;
                  },
                  [](const Case& c) { return *std::min_element(c.alphas.begin(), c.alphas.end()) < 1e-20f; }, 0.9},
    SegmentFamily{"q changes sign, alpha next to its root",
                  [](Random& random, std::size_t count) -> Case {
                      Segment segment{random.vector4(2.0), random.vector4(2.0)};
                      segment.a.w = std::fabs(segment.a.w) * (random.coin() ? 1.0f : -1.0f);
                      segment.b.w = std::copysign(segment.b.w, -segment.a.w) *
                                    static_cast<float>(random.coin() ? 1.0 : random.power_of_ten(-8.0, 8.0));
                      return {segment, alphas_at_root(segment, random, count)};
                  },
                  [](const Case& c) {
                      return any_of(c, [](const Homogeneous& at) { return at.q.sign() > 0; }) &&
                             any_of(c, [](const Homogeneous& at) { return at.q.sign() < 0; });
                  },
                  0.6},
    SegmentFamily{"q is exactly 0 at an alpha",
                  [](Random& random, std::size_t count) -> Case {
                      const int n = random.integer(1, 63);  // the root is n / 64
                      const float scale = std::ldexp(1.0f, random.integer(-60, 60));
                      Segment segment{random.vector4(2.0), random.vector4(2.0)};
                      segment.a.w = static_cast<float>(n) * scale;
                      segment.b.w = static_cast<float>(n - 64) * scale;
                      return {segment, alphas_at_root(segment, random, count)};
                  },
                  [](const Case& c) { return any_of(c, [](const Homogeneous& at) { return at.q.sign() == 0; }); }, 0.6},
    SegmentFamily{"behind all the way",
                  [](Random& random, std::size_t count) -> Case {
                      Segment segment{friendly(random), friendly(random)};
                      segment.a.w = random.integer(0, 3) == 0 ? 0.0f : -segment.a.w;
                      segment.b.w = -segment.b.w;
                      return {segment, any_alphas(random, count)};
                  },
                  [](const Case& c) { return c.segment.b.w < 0.0f; }, 1.0},
    SegmentFamily{"s, t and r cancel",
                  [](Random& random, std::size_t count) -> Case {
                      const glm::vec4 a = friendly(random);
                      Case c{{a, friendly(random)}, std::vector<float>(count)};
                      const float alpha = any_alpha(random);
                      for (int k = 0; k < 3; ++k)
                          if (alpha > 0x1p-100f) c.segment.b[k] = -(1.0f - alpha) / alpha * c.segment.a[k];
                      for (float& other : c.alphas)
                          other = std::clamp(support::neighbour(alpha, random.integer(-3, 3)), 0.0f, 1.0f);
                      return c;
                  },
                  [](const Case& c) {
                      return any_of(c, [](const Homogeneous& at) { return std::fabs(at.over_q(0).estimate()) < 1e-6; });
                  },
                  0.5},
    SegmentFamily{"coordinates 1e6 away",
                  [](Random& random, std::size_t count) -> Case {
                      Segment segment{friendly(random), friendly(random)};
                      for (glm::vec4* end : {&segment.a, &segment.b}) {
                          end->x += 1e6f * end->w;
                          end->y -= 1e6f * end->w;
                      }
                      return {segment, any_alphas(random, count)};
                  },
                  [](const Case& c) { return std::fabs(c.segment.a.x) > 1e5f; }, 0.9},
    SegmentFamily{"halfway between two floats",
                  [](Random& random, std::size_t count) -> Case {
                      // q is constant, s at alpha = 1/2 is the mean of two floats that differ by an odd count of units.
                      Segment segment{friendly(random), {}};
                      segment.a.w = std::ldexp(1.0f, random.integer(-3, 3));
                      for (int k = 0; k < 3; ++k) segment.a[k] = random.uniform_float(1.0, 1.99);
                      segment.b = segment.a;
                      for (int k = 0; k < 3; ++k)
                          segment.b[k] = support::neighbour(segment.a[k], 2 * random.integer(-50, 50) + 1);
                      return {segment, std::vector<float>(count, 0.5f)};
                  },
                  [](const Case& c) { return is_tie(exactly_at(c.segment, 0.5f).over_q(0)); }, 0.9},
    SegmentFamily{"units from 1e-30 to 1e30",
                  [](Random& random, std::size_t count) -> Case {
                      const auto unit = [&] { return static_cast<float>(random.power_of_ten(-30.0, 30.0)); };
                      const glm::vec4 scale{unit(), unit(), unit(), unit()};
                      const glm::vec4 a = friendly(random) * scale;
                      return {{a, friendly(random) * scale}, any_alphas(random, count)};
                  },
                  [](const Case& c) { return !(std::fabs(c.segment.a.w) < 1e10f && c.segment.a.w > 1e-10f); }, 0.4},
    SegmentFamily{"subnormal numbers",
                  [](Random& random, std::size_t count) -> Case {
                      Segment segment{friendly(random), friendly(random)};
                      const bool small_q = random.coin();
                      for (glm::vec4* end : {&segment.a, &segment.b}) {
                          for (int k = 0; k < 3; ++k)
                              (*end)[k] = static_cast<float>(random.integer(-3000, 3000)) * least_float;
                          if (small_q) end->w = static_cast<float>(random.integer(1, 3000)) * least_float;
                      }
                      return {segment, any_alphas(random, count)};
                  },
                  [](const Case& c) { return std::fpclassify(c.segment.a.x) == FP_SUBNORMAL; }, 0.9},
    SegmentFamily{"quotients about the largest float",
                  [](Random& random, std::size_t count) -> Case {
                      Segment segment{friendly(random), friendly(random)};
                      for (glm::vec4* end : {&segment.a, &segment.b}) {
                          for (int k = 0; k < 3; ++k)
                              (*end)[k] = largest_float * (random.coin() ? 1.0f : random.uniform_float(-1.0, 1.0));
                          end->w = random.coin() ? 1.0f : random.uniform_float(0.9, 1.1);
                      }
                      return {segment, any_alphas(random, count)};
                  },
                  [](const Case& c) {
                      return any_of(
                          c, [](const Homogeneous& at) { return std::fabs(at.over_q(0).estimate()) > 0x1.8p127; });
                  },
                  0.5},
    SegmentFamily{"random bits",
                  [](Random& random, std::size_t count) -> Case {
                      Segment segment{};
                      for (int k = 0; k < 4; ++k) {
                          segment.a[k] = random.any_finite();
                          segment.b[k] = random.any_finite();
                      }
                      return {segment, alphas_at_root(segment, random, count)};
                  },
                  [](const Case&) { return true; }, 1.0},
};

texgen::TextureRegion any_region(const Case& c, Random& random) {
    const Homogeneous at = exactly_at(c.segment, c.alphas[c.alphas.size() / 2]);
    if (at.q.sign() <= 0 || random.integer(0, 3) == 0)
        return random.coin() ? everywhere() : texgen::atlas_tile({0.1, 0.2}, {0.7, 0.9});
    return support::region_about(at, random);
}

struct Classes {
    int in_front = 0, behind = 0, on_plane = 0, lit = 0, subnormal = 0, infinite = 0;
};

void require_right(const Case& c, const texgen::TextureRegion& region, Tolerance tolerance, Outputs& out,
                   Classes& classes) {
    interpolate(c.segment, c.alphas, region, out.spans(), tolerance);
    REQUIRE_MESSAGE(out.pads_are_intact(), hex(c.segment));
    for (std::size_t i = 0; i < c.alphas.size(); ++i) {
        const Homogeneous at = exactly_at(c.segment, c.alphas[i]);
        const std::string wrong = what_is_wrong(at, region, tolerance, out, i);
        REQUIRE_MESSAGE(wrong.empty(), wrong, " at alpha ", hex(c.alphas[i]), " of ", hex(c.segment), ", tolerance ",
                        hex(tolerance.value));
        ++(at.q.sign() > 0 ? classes.in_front : at.q.sign() < 0 ? classes.behind : classes.on_plane);
        if (out.asked(3)) classes.lit += out.lit()[i] == 1.0f;
        if (out.asked(0)) {
            classes.subnormal += std::fpclassify(out.s()[i]) == FP_SUBNORMAL;
            classes.infinite += std::isinf(out.s()[i]);
        }
    }
}

}  // namespace

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
          Tolerance{0.1}, Tolerance{10.0}, Tolerance{1e300}, Tolerance{std::numeric_limits<double>::infinity()}}) {
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
        for (const double value : {-1.0, -0.0, std::numeric_limits<double>::quiet_NaN(), -HUGE_VAL}) {
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
            alpha[bad] = std::numeric_limits<float>::quiet_NaN();
            Outputs out(count);
            interpolate(segment, alpha, everywhere(), out.spans());
            for (std::size_t k = 0; k < 4; ++k) REQUIRE(same_bits(out[k][bad], 0.0f));
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
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(texgen::work({{0.5f, 0.5f, 0.0f, nan}, {0.5f, 0.5f, 0.0f, 1.0f}}, texgen::whole_texture()) ==
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
