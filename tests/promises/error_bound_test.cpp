// What callers are told of errors: never below the error, at most a hundred times above it in the median, and infinite
// or no number where no bound exists.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "promises/error_bound_test/tightness.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/segment.hpp"
#include "texgen/texcoord.hpp"

namespace error_bound_cases {

using support::hex;
using texgen::error_bound;
using texgen::ObjectTexgen;
using texgen::Segment;

namespace {

float signed_power(Random& random, double low, double high) {
    return support::to_float((random.coin() ? 1.0 : -1.0) * random.power_of_ten(low, high));
}

struct SegmentFamily {
    const char* name;
    Segment (*make)(Random&);
    bool is_finite;  // whether a bound exists
};

const std::array segment_families{
    SegmentFamily{"friendly",
                  [](Random& random) -> Segment {
                      const auto end = [&] {
                          const double q = random.uniform(0.5, 4.0);
                          return glm::vec4(random.uniform_float(-0.5 * q, 1.5 * q), random.uniform_float(0.0, q),
                                           random.uniform_float(0.0, q), support::to_float(q));
                      };
                      const glm::vec4 a = end();
                      return {a, end()};
                  },
                  true},
    SegmentFamily{"every number from 1e-12 to 1e12",
                  [](Random& random) -> Segment {
                      const auto end = [&] {
                          const float s = signed_power(random, -12.0, 12.0), t = signed_power(random, -12.0, 12.0);
                          return glm::vec4(s, t, 0.0f, support::to_float(random.power_of_ten(-12.0, 12.0)));
                      };
                      const glm::vec4 a = end();
                      return {a, end()};
                  },
                  true},
    SegmentFamily{"any floats in front",
                  [](Random& random) -> Segment {
                      const auto any = [&] { return random.any_finite(); };
                      const auto end = [&] {
                          const float s = any(), t = any(), q = any();
                          return glm::vec4(s, t, 0.0f, q == 0.0f ? 1.0f : std::fabs(q));
                      };
                      const glm::vec4 a = end();
                      return {a, end()};
                  },
                  true},
    SegmentFamily{"s/q almost the same at both ends, far from 0",
                  [](Random& random) -> Segment {
                      const float u = random.uniform_float(1e3, 1e6), q = random.uniform_float(0.5, 4.0);
                      return {{u, -u, 0.0f, 1.0f}, {u * q, -u * q, 0.0f, q}};
                  },
                  true},
    SegmentFamily{"q of both signs, or 0 at an end",
                  [](Random& random) -> Segment {
                      Segment segment{random.vector4(2.0), random.vector4(2.0)};
                      segment.a.w = random.coin() ? 0.0f : -std::fabs(segment.a.w);
                      segment.b.w = std::fabs(segment.b.w) + 0x1p-20f;
                      if (random.coin()) std::swap(segment.a, segment.b);
                      return segment;
                  },
                  false},
};

}  // namespace

TEST_CASE("a segment's error_bound is never below the error, and is tight in every tier") {
    std::uint64_t seed = 7100;
    for (const SegmentFamily& family : segment_families) {
        CAPTURE(std::string(family.name));
        Random random(++seed);
        Tightness tightness, of_float;
        for (int i = 0; i < 1500; ++i) {
            const Segment segment = family.make(random);
            const Tolerance tolerance = any_tolerance(random);
            const glm::dvec2 bound = error_bound(segment, tolerance);
            std::vector<float> alpha(33);
            for (float& a : alpha) a = random.uniform_float(0.0, 1.0);
            alpha.front() = 0.0f;
            alpha.back() = 1.0f;
            support::Outputs out(alpha.size());
            interpolate(segment, alpha, support::everywhere(), out.spans(), tolerance);
            for (std::size_t k = 0; k < 2; ++k) {
                const double b = bound[static_cast<int>(k)];
                double largest = 0.0;
                for (std::size_t n = 0; n < alpha.size(); ++n) {
                    const support::Homogeneous at = support::exactly_at(segment, alpha[n]);
                    if (at.q.sign() > 0) largest = std::max(largest, support::distance(out[k][n], at.over_q(k)));
                }
                REQUIRE_MESSAGE(largest <= b * (1.0 + 1e-12), hex(segment.a), hex(segment.b), hex(tolerance.value));
                if (!family.is_finite) REQUIRE_MESSAGE(b == infinity_double, hex(segment.a), hex(segment.b));
                tightness.add(b, largest);
                if (tolerance.value > 1e-6) of_float.add(b, largest);
            }
        }
        if (!family.is_finite) continue;
        CHECK(tightness.size() > 1000);
        CHECK(tightness.median() < 5.0);
        CHECK(of_float.median() < 20.0);
    }
}

TEST_CASE("a segment that is behind has no error, and one with a NaN or an infinity has no bound") {
    const Segment good{{0.2f, 0.3f, 0.0f, 1.0f}, {0.7f, 0.9f, 0.0f, 2.0f}};
    CHECK(error_bound({{1, 2, 3, -1}, {4, 5, 6, 0}}) == glm::dvec2(0.0));
    CHECK(error_bound(good).x < 0x1p-24);
    for (const float bad : {support::nan_float, HUGE_VALF, -HUGE_VALF}) {
        for (const bool at_a : {false, true}) {
            for (const int k : {0, 1, 3}) {
                Segment segment = good;
                (at_a ? segment.a : segment.b)[k] = bad;
                const glm::dvec2 bound = error_bound(segment, {1e-3});
                CHECK(is_no_bound(bound.x));
                CHECK(is_no_bound(bound.y));
            }
        }
    }
    CHECK(error_bound(good, {support::nan_double}) == error_bound(good));
}

TEST_CASE("from 2^128 - 2^103 on the nearest float is infinity, and the bound with it") {
    const auto bound_at = [](float s) { return error_bound({{s, 0, 0, 1}, {s, 0, 0, 1}}).x; };
    constexpr float largest = std::numeric_limits<float>::max();
    CHECK(bound_at(0x1p127f) < infinity_double);
    CHECK(bound_at(largest) == infinity_double);  // 1.001 times it, to be safe
    const ObjectTexgen texgen(glm::dmat4(0x1.fffffefp127, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1));
    const ObjectTexgen beyond(glm::dmat4(0x1.ffffff1p127, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1));
    const glm::vec3 point(1.0f, 0.0f, 0.0f);
    const auto points = texgen::object_space(std::span(&point, 1));
    glm::vec4 strq(0.0f);
    generate(texgen, points, std::span(&strq, 1));
    CHECK(strq.x == largest);
    CHECK(generate_error_bound(texgen, points).x < infinity_double);
    generate(beyond, points, std::span(&strq, 1));
    CHECK(strq.x == HUGE_VALF);
    CHECK(generate_error_bound(beyond, points).x == infinity_double);
}

}  // namespace error_bound_cases
