// With subnormal numbers taken as 0 decisions stay as they are, and errors within what detail/arithmetic/rounding.hpp
// says. The judge works in the default state.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/oracle.hpp"
#include "judges/rational_matrix.hpp"
#include "judges/verdict.hpp"
#include "support/float_state.hpp"
#include "support/hard_triangles.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "texgen/clip.hpp"
#include "texgen/coverage.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/scene.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::exactly;
using support::FloatState;
using support::hex;
using support::Homogeneous;
using support::Outputs;
using support::Quotient;
using support::Random;
using support::Rational;
using support::Shot;
using support::under;
using texgen::Box;
using texgen::Coverage;
using texgen::ObjectTexgen;
using texgen::Segment;
using texgen::TextureRegion;
using texgen::Tolerance;
using texgen::TriangleSetup;
using texgen::Work;

// What the state makes of a float that is read.
float as_read(float value, const FloatState& state) {
    return state.flushes && std::fabs(value) < 0x1p-126f ? std::copysign(0.0f, value) : value;
}
glm::vec3 as_read(const glm::vec3& v, const FloatState& state) {
    return {as_read(v.x, state), as_read(v.y, state), as_read(v.z, state)};
}
glm::vec4 as_read(const glm::vec4& v, const FloatState& state) {
    return {as_read(glm::vec3(v), state), as_read(v.w, state)};
}
Segment as_read(const Segment& segment, const FloatState& state) {
    return {as_read(segment.a, state), as_read(segment.b, state)};
}
texgen::Triangle as_read(const texgen::Triangle& triangle, const FloatState& state) {
    const auto vertex = [&](const texgen::WindowVertex& v) {
        return texgen::WindowVertex{
            {as_read(v.window.x, state), as_read(v.window.y, state)}, as_read(v.clip_w, state), as_read(v.strq, state)};
    };
    return {vertex(triangle.a), vertex(triangle.b), vertex(triangle.c)};
}

// The distance of neighbouring floats where n/d is.
double ulp_of(const Quotient& u) {
    const double size = std::fabs(u.estimate());
    return size < 0x1p-126 ? 0x1p-149 : std::ldexp(1.0, std::ilogb(size) - 23);
}

// The error that the state allows: half an ulp or a tolerance, and what is flushed.
bool keeps(float value, const Quotient& u, Tolerance tolerance, const FloatState& state) {
    const double limit = std::max(tolerance.value, 0.5 * ulp_of(u)) * (1.0 + 0x1p-20);
    if (!(std::fabs(u.estimate()) < 0x1.fffffep127)) return !(std::fabs(value) < 0x1.fffffep127f);
    if (std::isinf(value)) return std::fabs(u.estimate()) + limit >= 0x1.fffffep127;
    return support::distance(value, u) <= limit + (state.flushes ? 0x1p-126 : 0.0);
}

// How often each case came up.
struct Seen {
    int in_front = 0, behind = 0, on_plane = 0, flushed = 0;
};

// Empty where value i keeps the promises; otherwise what is wrong with it.
std::string what_is_wrong(const Homogeneous& exact, const TextureRegion& region, Tolerance tolerance,
                          const FloatState& state, const Outputs& out, std::size_t i, Seen& seen) {
    const int side = exact.q.sign();
    ++(side > 0 ? seen.in_front : side < 0 ? seen.behind : seen.on_plane);
    const std::string text = hex(out.s()[i]) + " " + hex(out.t()[i]) + " " + hex(out.lit()[i]);
    if (side <= 0)
        return out.s()[i] == 0.0f && out.t()[i] == 0.0f && out.lit()[i] == 0.0f ? "" : "behind, and not 0: " + text;
    for (std::size_t k = 0; k < 2; ++k) {
        const Quotient u = exact.over_q(k);
        if (!keeps(out[k][i], u, tolerance, state)) return "should be " + hex(u.estimate()) + ": " + text;
        seen.flushed += out[k][i] == 0.0f && std::fabs(u.estimate()) > 0x1p-140;
    }
    const bool is_inside =
        support::contains(region, as_read(out.s()[i], state), as_read(out.t()[i], state), as_read(out.r()[i], state));
    return out.lit()[i] == (is_inside ? 1.0f : 0.0f) ? "" : "lit is not what s, t and r say: " + text;
}

Tolerance any_tolerance(Random& random) {
    return random.coin() ? texgen::exact : Tolerance{random.power_of_ten(-8.0, -1.0)};
}

// Sides that are normal floats, or none.
TextureRegion any_region(Random& random) {
    const TextureRegion region = random.coin() ? support::everywhere() : texgen::atlas_tile({0.0, 0.25}, {1.0, 0.75});
    return random.coin() ? region : region.with_depth(random.coin() ? 0.0 : -HUGE_VAL, 0.5);
}

// Every test goes through the states that the machine has.
template <class Test>
void in_every_state(const Test& test) {
    std::uint64_t seed = 8000;
    for (const FloatState& state : support::float_states) {
        if (!has(state)) continue;
        CAPTURE(std::string(state.name));
        Random random(++seed);
        test(state, random);
    }
}

void check_seen(const Seen& seen) {
    CHECK(seen.in_front > 2000);
    CHECK(seen.behind > 200);
}

}  // namespace

TEST_CASE("the states are what they are called") {
    volatile float one = 1.0f, subnormal = 0x1p-140f;
    for (const FloatState& state : support::float_states) {
        if (!has(state)) continue;
        CAPTURE(std::string(state.name));
        float product = 0.0f;
        under(state, [&] { product = subnormal * one; });
        CHECK((product == 0.0f) == state.flushes);
    }
    CHECK(subnormal * one != 0.0f);
}

TEST_CASE("sums that decide have the same bits, and bounds in double hold") {
    in_every_state([](const FloatState& state, Random& random) {
        int close = 0, far_apart = 0, cancelled = 0;
        double of_form = 0.0, of_mixture = 0.0;
        for (int i = 0; i < 20000; ++i) {
            const auto any = [&] {
                const double value =
                    random.coin() ? random.uniform(-2.0, 2.0) : random.integer(-4, 4) * (1.0 + 0x1p-52);
                return std::ldexp(value, random.integer(-60, 60));
            };
            const double a = any();
            const double b = random.integer(0, 3) == 0 ? -a * (1.0 + random.integer(-2, 2) * 0x1p-52)
                             : random.coin()           ? std::ldexp(a, random.integer(-56, -50)) * random.integer(-3, 3)
                                                       : any();
            const texgen::detail::DoubleDouble expected = texgen::detail::two_sum(a, b);
            texgen::detail::DoubleDouble sum{};
            under(state, [&] { sum = texgen::detail::two_sum(a, b); });
            REQUIRE_MESSAGE(sum.high == expected.high, hex(a), " ", hex(b));
            REQUIRE_MESSAGE(sum.low == expected.low, hex(a), " ", hex(b));
            ++(expected.low == 0.0 ? close : far_apart);
            cancelled += std::fabs(expected.high) < 0x1p-40 * std::fabs(a);

            // One large term, a little above a power of two, and small ones that are rounded away, or up to its next
            // double.
            const double small = random.coin() ? 0x1p-70 : -0x1p-70;
            glm::dmat4 matrix(0.0);
            matrix[0][0] = random.uniform(1.0, 1.0 + 0x1p-10);
            for (int j = 1; j < 4; ++j) matrix[j][0] = small;
            const glm::vec3 point(random.uniform_float(1.0, 1.0 + 0x1p-10), 1.0f, 1.0f);
            const float alpha = 0x1p-60f, s = point.x, end = random.coin() ? 0x1p-20f : -0x1p-20f;
            texgen::detail::Bounded form{}, mixture{};
            under(state, [&] {
                form = texgen::detail::value_at(texgen::detail::form(matrix, 0), glm::dvec3(point));
                mixture =
                    texgen::detail::mixed(static_cast<double>(s), static_cast<double>(s), static_cast<double>(alpha));
            });
            const auto share = [](const texgen::detail::Bounded& bounded, const support::Dyadic& exact) {
                return magnitude(support::Dyadic(bounded.value) - exact).estimate() / bounded.error;
            };
            of_form = std::max(of_form, share(form, support::exactly_at(matrix, point).s));
            const Segment segment{glm::vec4(s), glm::vec4(end)};
            of_mixture = std::max(of_mixture, share(mixture, support::exactly_at(segment, alpha).s));
        }
        CHECK(close > 1000);
        CHECK(far_apart > 5000);
        CHECK(cancelled > 1000);
        CHECK(of_form <= 1.0);
        CHECK(of_mixture <= 1.0);
    });
}

TEST_CASE("a 0 that was subnormal is on the side of the region, and neither work nor coverage leaves it out") {
    // s/q, or r/q, is -1e-39, of numbers that are none: where it is written as -0, it is lit.
    for (const int coordinate : {0, 2}) {
        CAPTURE(coordinate);
        glm::vec4 strq(5e8f, 5e8f, 5e8f, 1e9f);
        strq[coordinate] = -1e-30f;
        const auto vertex = [&](float x, float y) { return texgen::WindowVertex{{x, y}, 1.0f, strq}; };
        const texgen::Triangle triangle{vertex(0.0f, 0.0f), vertex(64.0f, 0.0f), vertex(0.0f, 64.0f)};
        const Segment segment{triangle.a.strq, triangle.b.strq};
        glm::dmat4 matrix(0.0);
        matrix[3] = glm::dvec4(strq);
        const TextureRegion region = texgen::whole_texture().with_depth();
        in_every_state([&](const FloatState& state, Random&) {
            Outputs out(16), of_segment(16), of_points(16);
            const std::vector<float> alpha(16, 0.5f);
            const std::vector<glm::vec3> points(16, glm::vec3(0.5f));
            Work work = Work::nothing, work_of_segment = Work::nothing;
            Coverage answer = Coverage::outside;
            under(state, [&] {
                const auto setup = TriangleSetup::of(triangle, region);
                work = interpolate(*setup, {1, 1, 16, 1}, out.spans());
                work_of_segment = texgen::work(segment, region);
                interpolate(segment, alpha, region, of_segment.spans());
                answer = coverage(ObjectTexgen(matrix), region, Box{glm::vec3(0.0f), glm::vec3(1.0f)});
                project(ObjectTexgen(matrix), texgen::object_space(points), region, of_points.spans());
            });
            const float lit = of_segment.lit()[0];
            if (state.flushes) CHECK(lit == 1.0f);
            CHECK(of_points.lit()[0] == lit);
            if (work != Work::nothing) CHECK(out.lit()[0] == lit);
            if (lit == 1.0f) {
                CHECK(work != Work::nothing);
                CHECK(work_of_segment != Work::nothing);
                CHECK(answer != Coverage::outside);
            }
            if (coordinate == 0) CHECK(answer != Coverage::inside);
        });
    }
}

TEST_CASE("fragments of triangles: the sign of q is exact, and errors are within half an ulp or the tolerance") {
    in_every_state([](const FloatState& state, Random& random) {
        Seen seen;
        for (const support::HardFamily& family : support::hard_families) {
            CAPTURE(std::string(family.name));
            for (int i = 0; i < 40; ++i) {
                Shot shot = family.make(random);
                const Tolerance tolerance = any_tolerance(random);
                const TextureRegion region = any_region(random);
                std::optional<TriangleSetup> setup;
                Outputs out(support::count_of(shot.rect));
                Work work = Work::nothing;
                under(state, [&] {
                    setup = TriangleSetup::of(shot.triangle, region, tolerance);
                    if (setup) work = interpolate(*setup, shot.rect, out.spans());
                });
                shot.triangle = as_read(shot.triangle, state);
                REQUIRE((setup.has_value() || state.flushes));
                if (!setup) continue;
                const support::ExactTriangle exact(shot.triangle);
                for (std::size_t k = 0; k < out.size(); ++k) {
                    const std::int64_t x = shot.x(static_cast<std::int64_t>(k) % shot.rect.width);
                    const std::int64_t y = shot.y(static_cast<std::int64_t>(k) / shot.rect.width);
                    if (!exact.has_positive_w(x, y)) continue;
                    const Homogeneous at = exact.at(x, y);
                    std::string wrong;
                    if (work == Work::nothing) {
                        bool is_lit = at.q.sign() > 0;
                        for (std::size_t c = 0; c < 3 && is_lit; ++c) {
                            const glm::dvec2 limits = support::limits_of(region, c);
                            is_lit = support::is_inside_for_sure(at.over_q(c), limits.x, limits.y, 0.0);
                        }
                        if (is_lit) wrong = "lit, and nothing was done";
                    } else {
                        wrong = what_is_wrong(at, region, tolerance, state, out, k, seen);
                        if (work == Work::divide && out.lit()[k] != 1.0f) wrong = "dark, and no test was needed";
                    }
                    REQUIRE_MESSAGE(wrong.empty(), wrong, " for ", hex(shot), ", tolerance ", hex(tolerance.value));
                }
            }
        }
        check_seen(seen);
    });
}

TEST_CASE("steps to the next row that are below the normal floats lose no more than the tolerance") {
    in_every_state([](const FloatState& state, Random&) {
        const auto vertex = [](float x, float y) {
            return texgen::WindowVertex{{x, y}, 1.0f, {0x1.fp-126f * (y - 256.5f), 0.0f, 0.0f, 0x1.1p-20f}};
        };
        const texgen::Triangle triangle{vertex(0.5f, 0.5f), vertex(8.5f, 0.5f), vertex(0.5f, 512.5f)};
        const support::ExactTriangle exact(triangle);
        for (const double tolerance : {0x1p-98, 0x1p-97, 0x1p-96, 0x1p-95}) {
            Outputs out(8 * 512);
            under(state, [&] {
                const auto setup = TriangleSetup::of(triangle, support::everywhere(), Tolerance{tolerance});
                interpolate(*setup, {0, 0, 8, 512}, out.spans());
            });
            for (std::size_t i = 0; i < out.size(); i += 29) {
                const Quotient u =
                    exact.at(static_cast<std::int64_t>(i % 8), static_cast<std::int64_t>(i / 8)).over_q(0);
                CHECK(support::distance(out.s()[i], u) <= tolerance);
            }
        }
    });
}

TEST_CASE("what is cut next to the eye or q = 0 is in front") {
    const std::array<texgen::ClipVertex, 3> by_eye{{{{0.0f, 0.0f, 1.0f, 0x1p-110f}, {0.0f, 0.0f, 0.0f, 1.0f}},
                                                    {{1.0f, 0.0f, 1.0f, -1.0f}, {1.0f, 0.0f, 0.0f, 1.0f}},
                                                    {{0.0f, 1.0f, 1.0f, -1.0f}, {0.0f, 1.0f, 0.0f, 1.0f}}}};
    const std::array<texgen::ClipVertex, 3> by_q{{{{0.0f, 0.0f, 1.0f, 1.0f}, {0.0f, 0.0f, 0.0f, 0.0f}},
                                                  {{1.0f, 0.0f, 1.0f, 1.0f}, {0.0f, 0.0f, 0.0f, 0x1p-110f}},
                                                  {{0.0f, 1.0f, 1.0f, 1.0f}, {0x1p-111f, 0x1p-111f, 0.0f, 0x1p-110f}}}};
    in_every_state([&](const FloatState& state, Random&) {
        std::array<texgen::ClipVertex, 10> out{};
        std::size_t count = 0;
        under(state, [&] { count = clip_to_near(by_eye, out, texgen::DepthRange::zero_to_one); });
        CHECK(count >= 3);
        for (std::size_t i = 0; i < count; ++i) CHECK(as_read(out[i].position.w, state) > 0.0f);
        under(state, [&] { count = clip_to_slide(by_q, texgen::whole_texture(), out); });
        CHECK(count >= 3);
        for (std::size_t i = 0; i < count; ++i) CHECK(as_read(out[i].strq.w, state) > 0.0f);
    });
}

TEST_CASE("segments: the sign of q is exact, and errors are within half an ulp or the tolerance") {
    in_every_state([](const FloatState& state, Random& random) {
        Seen seen;
        for (int i = 0; i < 1500; ++i) {
            const float size = support::to_float(random.power_of_ten(-6.0, 6.0));
            Segment segment{random.vector4(2.0), size * random.vector4(2.0)};
            if (random.coin()) segment.a.w = std::fabs(segment.a.w);
            if (random.coin()) segment.b.w = std::fabs(segment.b.w);
            if (random.integer(0, 9) == 0) segment.a *= 0x1p-130f;
            if (random.integer(0, 9) == 0) segment.b = segment.a;
            std::vector<float> alpha(static_cast<std::size_t>(random.integer(1, 40)));
            const double root = static_cast<double>(segment.a.w) /
                                (static_cast<double>(segment.a.w) - static_cast<double>(segment.b.w));
            for (float& a : alpha) {
                a = random.uniform_float(0.0, 1.0);
                if (root > 0.0 && root < 1.0 && random.coin())
                    a = std::clamp(support::neighbour(support::to_float(root), random.integer(-2, 2)), 0.0f, 1.0f);
            }
            const Tolerance tolerance = any_tolerance(random);
            const TextureRegion region = any_region(random);
            Outputs out(alpha.size());
            under(state, [&] { interpolate(segment, alpha, region, out.spans(), tolerance); });
            for (std::size_t k = 0; k < alpha.size(); ++k) {
                const Homogeneous at = support::exactly_at(as_read(segment, state), as_read(alpha[k], state));
                const std::string wrong = what_is_wrong(at, region, tolerance, state, out, k, seen);
                REQUIRE_MESSAGE(wrong.empty(), wrong, " at ", hex(alpha[k]), " of ", hex(segment.a), hex(segment.b),
                                ", tolerance ", hex(tolerance.value));
            }
        }
        check_seen(seen);
    });
}

TEST_CASE("points: the sign of q is exact where its terms cancel, and errors are within half an ulp or the tolerance") {
    in_every_state([](const FloatState& state, Random& random) {
        Seen seen;
        double of_generate = 0.0;
        for (int i = 0; i < 1500; ++i) {
            glm::dmat4 matrix(0.0);
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 4; ++row) matrix[column][row] = random.uniform(-1.0, 1.0);
            const int kind = random.integer(0, 6);
            if (kind == 0 || kind == 6) matrix[3][3] = 4.0;
            if (kind == 1)  // q cancels, to its last bits or to 0: next to points with x = y and z = 0
                matrix[1][3] = -matrix[0][3] * (1.0 + random.integer(-1, 1) * 0x1p-52), matrix[3][3] = 0.0;
            const double far_below = random.power_of_ten(-30.0, -14.0);
            if (kind == 4) {  // so do terms that are far apart
                for (int column : {2, 3}) matrix[column] *= far_below;
                matrix[1][3] = -matrix[0][3];
                matrix[3][3] = -0.5 * matrix[2][3];
            }
            if (kind == 3)  // s is subnormal
                for (int column = 0; column < 4; ++column) matrix[column][0] *= 0x1p-128;
            if (kind == 2)
                for (int column = 0; column < 4; ++column) matrix[column] *= random.power_of_ten(-12.0, 12.0);
            if (kind == 6)  // 1 / q is next to the least normal number
                matrix *= std::ldexp(random.uniform(1.0, 2.0), random.integer(122, 124));
            if (kind == 5)  // the least normal numbers, whose differences are subnormal, on either side
                for (int column = 0; column < 3; ++column) matrix[column] *= 0x1p126;
            std::vector<glm::vec3> points(static_cast<std::size_t>(random.integer(1, 40)));
            for (glm::vec3& point : points) {
                point = random.vector3(1.0);
                if (kind == 1) point.y = point.x, point.z = random.coin() ? 0.0f : random.uniform_float(-1e-30, 1e-30);
                if (kind == 4) point.y = point.x, point.z = support::neighbour(0.5f, random.integer(-1, 1));
                if (kind == 5)
                    for (int k = 0; k < 3; ++k) point[k] = 0x1p-126f * random.uniform_float(1.0, 1.9);
                if (random.integer(0, 19) == 0) point[random.integer(0, 2)] = 0x1p-140f;
            }
            const ObjectTexgen texgen(matrix);
            auto positions = texgen::object_space(points);
            if (random.coin()) positions = positions.within({glm::vec3(-1.0f), glm::vec3(1.0f)});
            const Tolerance tolerance = any_tolerance(random);
            const TextureRegion region = any_region(random);
            Outputs out(points.size());
            std::vector<glm::vec4> strq(points.size());
            under(state, [&] {
                project(texgen, positions, region, out.spans(), tolerance);
                generate(texgen, positions, strq);
            });
            for (std::size_t k = 0; k < points.size(); ++k) {
                const glm::vec3 read = as_read(points[k], state);
                const Homogeneous at = support::exactly_at(matrix, read);
                const std::string wrong = what_is_wrong(at, region, tolerance, state, out, k, seen);
                REQUIRE_MESSAGE(wrong.empty(), wrong, " at ", hex(points[k]), " by ", hex(matrix), ", tolerance ",
                                hex(tolerance.value));
                for (int row = 0; row < 4; ++row) {
                    const support::Dyadic& exact = row == 0 ? at.s : row == 1 ? at.t : row == 2 ? at.r : at.q;
                    double terms = std::fabs(matrix[3][row]);
                    for (int j = 0; j < 3; ++j) terms += std::fabs(matrix[j][row] * static_cast<double>(read[j]));
                    const Quotient u{exact, support::Dyadic(1.0)};
                    const double room = 0.5 * ulp_of(u) * (1.0 + 0x1p-20) + texgen::generate_error * terms +
                                        (state.flushes ? 0x1p-126 : 0.0);
                    of_generate = std::max(of_generate, support::distance(strq[k][row], u) / room);
                }
            }
        }
        check_seen(seen);
        CHECK(seen.on_plane > 100);
        CHECK((seen.flushed > 0) == state.flushes);
        CHECK(of_generate <= 1.0);
    });
}

TEST_CASE("coverage and scenes answer as in the default state, or leave it open") {
    in_every_state([](const FloatState& state, Random& random) {
        int decided = 0, open = 0, touching = 0;
        for (int i = 0; i < 400; ++i) {
            // Small integers, so that planes are touched exactly; or any numbers.
            glm::dmat4 matrix(0.0);
            const bool is_small = random.coin();
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 4; ++row)
                    matrix[column][row] =
                        is_small ? random.integer(-2, 2) * (1.0 + 0x1p-50) : random.uniform(-1.0, 1.0);
            const TextureRegion region =
                is_small ? texgen::atlas_tile({0.0, -1.0}, {1.0, 2.0}) : texgen::atlas_tile({0.1, 0.2}, {0.9, 0.7});
            std::vector<Box> boxes(40);
            for (Box& box : boxes) {
                for (int j = 0; j < 3; ++j) {
                    const float a =
                        is_small ? static_cast<float>(random.integer(-3, 3)) : random.uniform_float(-3.0, 3.0);
                    const float b =
                        is_small ? static_cast<float>(random.integer(-3, 3)) : random.uniform_float(-3.0, 3.0);
                    box.min[j] = std::min(a, b);
                    box.max[j] = std::max(a, b);
                    if (random.integer(0, 9) == 0) box.max[j] = box.min[j];
                    if (random.integer(0, 29) == 0) box.min[j] = box.max[j] = 0x1p-140f;
                }
            }
            std::vector<Box> read = boxes;
            for (Box& box : read) box = {as_read(box.min, state), as_read(box.max, state)};
            const ObjectTexgen texgen(matrix);
            std::vector<Coverage> expected(boxes.size()), answers(boxes.size()), alone(boxes.size());
            coverage(texgen, region, read, expected);
            under(state, [&] {
                coverage(texgen, region, boxes, answers);
                for (std::size_t k = 0; k < boxes.size(); ++k) alone[k] = coverage(texgen, region, boxes[k]);
            });
            for (std::size_t k = 0; k < boxes.size(); ++k) {
                CHECK(alone[k] == answers[k]);
                ++(answers[k] == Coverage::partial ? open : decided);
                touching += is_small;
                const bool is_same = answers[k] == expected[k] || answers[k] == Coverage::partial;
                REQUIRE_MESSAGE(is_same, static_cast<int>(answers[k]), " for ", static_cast<int>(expected[k]), ": box ",
                                hex(boxes[k].min), hex(boxes[k].max), " by ", hex(matrix));
            }
        }
        CHECK(decided > 5000);
        CHECK(open > 1000);
        CHECK(touching > 1000);
    });
}

TEST_CASE("what is outside is not lit, and what is inside is, in every state") {
    in_every_state([](const FloatState& state, Random& random) {
        int outside = 0, inside = 0, lit_beside = 0;
        for (int i = 0; i < 5000; ++i) {
            const double side = random.coin() ? random.uniform(-2.0, 2.0) : random.integer(-1, 1);
            const bool is_min = random.coin();
            const TextureRegion region =
                is_min ? texgen::atlas_tile({side, 0.0}, {4.0, 1.0}) : texgen::atlas_tile({-4.0, 0.0}, {side, 1.0});
            // s = x + offset, about a float of the side.
            const glm::vec3 point(support::neighbour(support::to_float(side), random.integer(-1, 1)), 0.0f, 0.0f);
            glm::dmat4 matrix(0.0);
            matrix[0][0] = 1.0;
            matrix[3] = {random.uniform(-1.5, 1.5) * 0x1p-23 * std::fabs(side), 0.5, 0.0, 1.0};
            const ObjectTexgen texgen(matrix);
            Outputs out(1);
            Coverage answer = Coverage::partial;
            under(state, [&] {
                project(texgen, texgen::object_space(std::span(&point, 1)), region, out.spans());
                answer = coverage(texgen, region, Box{point, point});
            });
            const double s = static_cast<double>(point.x) + matrix[3][0];
            const bool is_lit = out.lit()[0] == 1.0f;
            lit_beside += is_lit && (is_min ? s < side : s > side);
            outside += answer == Coverage::outside;
            inside += answer == Coverage::inside;
            if (answer != Coverage::partial)
                REQUIRE_MESSAGE(is_lit == (answer == Coverage::inside), hex(point), hex(matrix), hex(side));
        }
        CHECK(outside > 300);
        CHECK(inside > 300);
        CHECK(lit_beside > 100);
    });
}

TEST_CASE("a scene has the pairs that it has in the default state") {
    in_every_state([](const FloatState& state, Random& random) {
        std::size_t pairs = 0;
        for (int i = 0; i < 20; ++i) {
            std::vector<texgen::ModelMatrix> models;
            std::vector<Box> bounds;
            for (int k = 0; k < 60; ++k) {
                models.emplace_back(random.rigid(8.0));
                const glm::vec3 a = random.vector3(1.0), b = random.vector3(1.0);
                bounds.push_back({glm::min(a, b), glm::max(a, b)});
            }
            std::vector<texgen::Projector> projectors;
            while (projectors.size() < 4) {
                const auto projector = texgen::make_projector(
                    texgen::PerspectiveLens{.fovy = texgen::degrees(40), .aspect = 1, .z_near = 0.1, .z_far = 100},
                    {.position = 8.0 * random.direction(), .target = {0, 0, 0}, .up = random.direction()},
                    texgen::opengl);
                if (projector) projectors.push_back(*projector);
            }
            const texgen::SceneView view{models, bounds, projectors};
            texgen::Scene scene, expected;
            expected.update(view, {});
            under(state, [&] { scene.update(view, {}); });
            const auto is_same = [](const texgen::LitPair& a, const texgen::LitPair& b) {
                return a.object == b.object && a.projector == b.projector && a.coverage == b.coverage;
            };
            CHECK(std::ranges::equal(scene.pairs(), expected.pairs(), is_same));
            pairs += expected.pairs().size();
        }
        CHECK(pairs > 500);
    });
}

TEST_CASE("what a clip to the slide leaves is inside but for slide_clip_error, and what it drops is outside") {
    in_every_state([](const FloatState& state, Random& random) {
        int cut = 0, dropped = 0, whole = 0;
        for (int i = 0; i < 3000; ++i) {
            std::array<texgen::ClipVertex, 3> polygon{};
            const bool is_small = random.coin();
            for (texgen::ClipVertex& vertex : polygon) {
                vertex.position = random.vector4(1.0);
                vertex.strq = is_small ? glm::vec4(static_cast<float>(random.integer(-2, 2)),
                                                   static_cast<float>(random.integer(-2, 2)), 0.0f,
                                                   static_cast<float>(random.integer(-1, 2)))
                                       : random.vector4(2.0);
            }
            const TextureRegion region = texgen::atlas_tile({0.0, 0.25}, {1.0, 0.7});
            std::array<texgen::ClipVertex, 8> expected{}, out{};
            const std::size_t expected_count = clip_to_slide(polygon, region, expected);
            std::size_t count = 0;
            under(state, [&] { count = clip_to_slide(polygon, region, out); });
            ++(count == 0 ? dropped : count == 3 ? whole : cut);
            CHECK(count == expected_count);
            for (std::size_t k = 0; k < count; ++k) {
                const glm::dvec4 v(out[k].strq);
                REQUIRE_MESSAGE(v.w > 0.0, hex(polygon[0].strq), hex(polygon[1].strq), hex(polygon[2].strq));
                for (int c = 0; c < 2; ++c) {
                    const double slack = texgen::slide_clip_error * region.max()[c] * v.w;
                    REQUIRE(v[c] - region.min()[c] * v.w >= -slack);
                    REQUIRE(region.max()[c] * v.w - v[c] >= -slack);
                }
            }
            // A vertex strictly inside is never dropped.
            for (const texgen::ClipVertex& vertex : polygon) {
                const glm::dvec4 v(vertex.strq);
                const bool is_inside = v.w > 0.0 && v.x > 0.0 && v.x < v.w && v.y > 0.25 * v.w && v.y < 0.69 * v.w;
                if (is_inside && expected_count != 0) REQUIRE(count != 0);
            }
        }
        CHECK(cut > 100);
        CHECK(dropped > 100);
        CHECK(whole > 0);
    });
}

TEST_CASE("what is singular stays singular, and what is regular is inverted within its bound") {
    in_every_state([](const FloatState& state, Random& random) {
        double worst = 0.0;
        for (int i = 0; i < 300; ++i) {
            glm::dmat4 m(0.0);
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 4; ++row) m[column][row] = random.integer(-(1 << 20), 1 << 20) * 0x1p-20;
            const bool is_singular = i % 3 == 0;
            if (is_singular) m[1] = 3.0 * m[0] - 2.0 * m[2];
            std::optional<texgen::Transform<texgen::Object, texgen::World>> computed;
            glm::dmat4 bound(0.0);
            under(state, [&] {
                computed = inverse(texgen::ModelMatrix(m));
                if (computed) bound = inverse_error_bound(texgen::ModelMatrix(m), *computed);
            });
            REQUIRE_MESSAGE(computed.has_value() == !is_singular, hex(m));
            if (!computed) continue;
            const support::RationalMatrix exact = *support::inverse(exactly(m));
            Rational largest = 0;
            for (const auto& row : exact)
                for (const Rational& element : row) largest = std::max(largest, support::magnitude(element));
            for (std::size_t row = 0; row < 4; ++row) {
                for (std::size_t column = 0; column < 4; ++column) {
                    const double x = computed->matrix()[static_cast<int>(column)][static_cast<int>(row)];
                    const Rational error = support::magnitude(exactly(x) - exact[row][column]);
                    worst = std::max(worst, support::nearest<double>(error / largest));
                    REQUIRE_MESSAGE(error <= exactly(bound[static_cast<int>(column)][static_cast<int>(row)]), hex(m));
                }
            }
        }
        CHECK(worst <= 0x1p-50);
    });
}

TEST_CASE("lenses and aims are refused as in the default state, and have its bits") {
    in_every_state([](const FloatState& state, Random& random) {
        int refused = 0;
        for (int i = 0; i < 500; ++i) {
            const double fovy = random.integer(0, 9) == 0 ? random.uniform(-90.0, 0.0) : random.uniform(0.1, 179.9);
            const texgen::PerspectiveLens lens{.fovy = texgen::degrees(fovy),
                                               .aspect = random.integer(0, 19) == 0 ? 0.0 : random.uniform(0.5, 2.0),
                                               .z_near = random.uniform(0.1, 1.0),
                                               .z_far = random.uniform(1.0, 1e9)};
            texgen::Aim aim{10.0 * random.direction(), random.direction(), random.direction()};
            if (random.integer(0, 9) == 0) aim.target = aim.position;
            const auto projection = texgen::perspective(lens, texgen::opengl);
            const auto view = texgen::look_at(aim);
            std::optional<texgen::ProjectorProjection> projection_here;
            std::optional<texgen::ProjectorView> view_here;
            under(state, [&] {
                projection_here = texgen::perspective(lens, texgen::opengl);
                view_here = texgen::look_at(aim);
            });
            REQUIRE(projection_here.has_value() == projection.has_value());
            REQUIRE(view_here.has_value() == view.has_value());
            refused += !projection + !view;
            if (projection) CHECK(projection_here->matrix() == projection->matrix());
            if (view) CHECK(view_here->matrix() == view->matrix());
        }
        CHECK(refused > 50);
    });
}

TEST_CASE("footprints are those of the default state where they are not subnormal") {
    in_every_state([](const FloatState& state, Random& random) {
        int compared = 0;
        for (int i = 0; i < 200; ++i) {
            const texgen::Triangle triangle =
                make_triangle(random.coin() ? support::Family::friendly : support::Family::crossing, random);
            const texgen::FragmentRect pixel = pixel_near(triangle, random);
            const texgen::FragmentRect rect{pixel.x - 8, pixel.y, 17, 1};
            const Tolerance tolerance = random.coin() ? texgen::exact : Tolerance{1e-4};
            using Array = std::array<float, 17>;
            const auto run = [&](Array& dsdx, Array& dtdy, Array& level) {
                const auto setup = TriangleSetup::of(triangle, support::everywhere(), tolerance);
                const texgen::FootprintSetup footprints(
                    *setup, texgen::texels_per_unit(texgen::whole_texture(), 4096.0, 4096.0));
                footprint(footprints, rect,
                          {.dsdx = dsdx,
                           .dtdx = {},
                           .dsdy = {},
                           .dtdy = dtdy,
                           .level = level,
                           .anisotropy = {},
                           .major_s = {},
                           .major_t = {}});
            };
            Array expected[3]{}, here[3]{};
            run(expected[0], expected[1], expected[2]);
            under(state, [&] { run(here[0], here[1], here[2]); });
            for (std::size_t k = 0; k < 17; ++k) {
                for (std::size_t array = 0; array < 2; ++array) {
                    const double a = static_cast<double>(expected[array][k]), b = static_cast<double>(here[array][k]);
                    CHECK((a == b || std::max(std::fabs(a), std::fabs(b)) <= 0x1p-126));
                    ++compared;
                }
            }
        }
        CHECK(compared > 1000);
    });
}

TEST_CASE("bounds that are told to callers hold") {
    in_every_state([](const FloatState& state, Random& random) {
        for (int i = 0; i < 300; ++i) {
            const auto end = [&] {
                return glm::vec4(random.uniform_float(-1.0, 2.0), random.uniform_float(-1.0, 2.0), 0.0f,
                                 random.uniform_float(0.5, 4.0));
            };
            const glm::vec4 a = end();
            const Segment segment{a, end()};
            const Tolerance tolerance = any_tolerance(random);
            std::vector<float> alpha(16);
            for (float& one : alpha) one = random.uniform_float(0.0, 1.0);
            Outputs out(alpha.size());
            glm::dvec2 bound(0.0);
            under(state, [&] {
                bound = error_bound(segment, tolerance);
                interpolate(segment, alpha, support::everywhere(), out.spans(), tolerance);
            });
            for (std::size_t k = 0; k < alpha.size(); ++k)
                for (std::size_t c = 0; c < 2; ++c)
                    CHECK(support::distance(out[c][k], support::exactly_at(segment, alpha[k]).over_q(c)) <=
                          bound[static_cast<int>(c)] * (1.0 + 0x1p-20) + 0x1p-126);
        }
    });
}

TEST_CASE("random bits come to an end in every state, and lit is 0 or 1") {
    in_every_state([](const FloatState& state, Random& random) {
        for (int i = 0; i < 300; ++i) {
            const auto any4 = [&] {
                return glm::vec4(random.any_float(), random.any_float(), random.any_float(), random.any_float());
            };
            const auto vertex = [&] {
                return texgen::WindowVertex{{random.any_float(), random.any_float()}, random.any_float(), any4()};
            };
            const texgen::Triangle triangle{vertex(), vertex(), vertex()};
            const texgen::FragmentRect rect{random.integer(-100, 100), random.integer(-100, 100), 19, 3};
            glm::dmat4 matrix(0.0);
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 4; ++row) matrix[column][row] = std::bit_cast<double>(random.bits());
            std::vector<glm::vec3> points(20);
            for (glm::vec3& point : points) point = glm::vec3(any4());
            Outputs of_triangle(57), of_points(20);
            Work work = Work::nothing;
            under(state, [&] {
                const auto setup = TriangleSetup::of(triangle, texgen::whole_texture());
                if (setup)
                    work = interpolate(*setup, rect, of_triangle.spans());
                else
                    std::ranges::fill(of_triangle.spans().lit, 0.0f);
                project(ObjectTexgen(matrix), texgen::object_space(points), texgen::whole_texture(), of_points.spans());
            });
            for (const std::span<const float> lit : {of_triangle.lit(), of_points.lit()})
                for (const float one : lit) CHECK((one == 0.0f || one == 1.0f));
        }
    });
}
