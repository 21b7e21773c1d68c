// With subnormal numbers taken as 0 decisions stay as they are, and errors within what detail/arithmetic/rounding.hpp
// says. The judge works in the default state.

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "judges/exact.hpp"
#include "promises/float_state_test/inputs.hpp"
#include "support/float_state.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "texgen/coverage.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/texcoord.hpp"

namespace float_state {

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
                answer = coverage(ObjectTexgen(matrix), region, texgen::Box{glm::vec3(0.0f), glm::vec3(1.0f)});
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

}  // namespace float_state
