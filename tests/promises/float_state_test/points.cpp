// Points and segments, with subnormal numbers taken as 0.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/oracle.hpp"
#include "promises/float_state_test/inputs.hpp"
#include "support/float_state.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "texgen/segment.hpp"
#include "texgen/texcoord.hpp"

namespace float_state {

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
            glm::dmat4 matrix = random.matrix();
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
            const texgen::ObjectTexgen texgen(matrix);
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

}  // namespace float_state
