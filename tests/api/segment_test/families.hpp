#pragma once

// Families of segments with their alphas, each with the property that makes it hard, and what is asked of every value.

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

#include <glm/vec4.hpp>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/oracle.hpp"
#include "judges/verdict.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "texgen/interpolate.hpp"

namespace segment_cases {

using support::everywhere;
using support::exactly_at;
using support::hex;
using support::Homogeneous;
using support::Outputs;
using support::Random;
using texgen::Segment;
using texgen::Tolerance;

inline constexpr float least_float = std::numeric_limits<float>::denorm_min();
inline constexpr float largest_float = std::numeric_limits<float>::max();

inline std::string hex(const Segment& segment) { return "{" + hex(segment.a) + ", " + hex(segment.b) + "}"; }

// In [0, 1]: the ends and next to them, tiny ones, and any.
inline float any_alpha(Random& random) {
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

inline std::vector<float> any_alphas(Random& random, std::size_t count) {
    std::vector<float> alphas(count);
    for (float& alpha : alphas) alpha = any_alpha(random);
    return alphas;
}

inline glm::vec4 friendly(Random& random) {
    const double q = random.uniform(0.5, 4.0);
    const double s = random.uniform(-0.5, 1.5), t = random.uniform(-0.5, 1.5), r = random.uniform(0.0, 1.0);
    return {static_cast<float>(s * q), static_cast<float>(t * q), static_cast<float>(r * q), static_cast<float>(q)};
}

// The root of q, where it is in (0, 1), and its neighbours.
inline std::vector<float> alphas_at_root(const Segment& segment, Random& random, std::size_t count) {
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

inline bool any_of(const Case& c, bool (*predicate)(const Homogeneous&)) {
    return std::any_of(c.alphas.begin(), c.alphas.end(),
                       [&](float alpha) { return predicate(exactly_at(c.segment, alpha)); });
}

inline const std::array families{
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
                  [](const Case& c) { return support::is_tie(exactly_at(c.segment, 0.5f).over_q(0)); }, 0.9},
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

inline texgen::TextureRegion any_region(const Case& c, Random& random) {
    const Homogeneous at = exactly_at(c.segment, c.alphas[c.alphas.size() / 2]);
    if (at.q.sign() <= 0 || random.integer(0, 3) == 0)
        return random.coin() ? everywhere() : texgen::atlas_tile({0.1, 0.2}, {0.7, 0.9});
    return support::region_about(at, random);
}

struct Classes {
    int in_front = 0, behind = 0, on_plane = 0, lit = 0, subnormal = 0, infinite = 0;
};

inline void require_right(const Case& c, const texgen::TextureRegion& region, Tolerance tolerance, Outputs& out,
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

}  // namespace segment_cases
