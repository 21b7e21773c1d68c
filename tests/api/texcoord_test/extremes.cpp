// What is below all floats, no number, or any bits: each point is spoilt alone, and nothing else is written.

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "api/texcoord_test/point_families.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/verdict.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/texcoord.hpp"

namespace texcoord_cases {

using support::infinity_float;
using support::nan_float;
using support::Outputs;

TEST_CASE("a quotient that is below all floats is a zero of its sign, in company as alone") {
    Random random(8);
    int negative = 0;
    for (int round = 0; round < 2000; ++round) {
        // Some are at the middle of two subnormal floats, or next to it.
        const double down = std::ldexp(1.0, random.integer(-240, -140));
        const glm::dmat4 matrix = glm::transpose(
            glm::dmat4(down, 0.0, 0.0, 0.0, 0.0, down, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0));
        std::vector<glm::vec3> points(static_cast<std::size_t>(random.integer(1, 40)));
        for (glm::vec3& point : points)
            for (glm::length_t k = 0; k < 3; ++k) {
                const double middle = (2 * random.integer(-9, 9) + 1) * 0x1p-150 / down;
                const bool is_middle = std::fabs(middle) < 0x1p100 && random.coin();
                point[k] = is_middle ? support::to_float(middle) : random.uniform_float(-2.0, 2.0);
            }
        Outputs out(points.size(), 3u);
        project(ObjectTexgen(matrix), texgen::object_space(points), support::everywhere(), out.spans());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto alone = project(ObjectTexgen(matrix), texgen::object_space(points[i]));
            REQUIRE(alone);
            for (std::size_t k = 0; k < 2; ++k) {
                const float of_alone = (*alone)[static_cast<glm::length_t>(k)];
                negative += out[k][i] == 0.0f && std::signbit(out[k][i]) ? 1 : 0;
                CHECK_MESSAGE(support::same_bits(out[k][i], of_alone), hex(points[i]), " by ", hex(matrix), ": ",
                              hex(out[k][i]), ", alone ", hex(of_alone));
            }
        }
    }
    CHECK(negative > 1000);
}

TEST_CASE("a NaN or an infinity in a position spoils its own point only") {
    Random random(6700);
    int spoilt = 0;
    for (const Tolerance tolerance : {texgen::exact, Tolerance{1e-4}, Tolerance{1.0}}) {
        for (const PointFamily& family : families) {
            for (int i = 0; i < 20; ++i) {
                const std::size_t count = any_count(random);
                Batch batch = family.make(random, count);
                std::vector<bool> bad(count);
                for (std::size_t j = 0; j < count; ++j) {
                    bad[j] = random.integer(0, 5) == 0;
                    const float values[] = {nan_float, -nan_float, infinity_float, -infinity_float};
                    if (bad[j]) batch.points[j][random.integer(0, 2)] = values[random.integer(0, 3)];
                    spoilt += bad[j];
                }
                Outputs out(count);
                project(batch.texgen(), batch.positions(), texgen::whole_texture(), out.spans(), tolerance);
                std::vector<glm::vec4> strq(count);
                generate(batch.texgen(), batch.positions(), strq);
                for (std::size_t j = 0; j < count; ++j) {
                    if (bad[j]) {
                        REQUIRE_MESSAGE(out.lit()[j] == 0.0f, describe(batch, j));
                        for (std::size_t k = 0; k < 3; ++k)
                            if (std::isnan(batch.points[j].x + batch.points[j].y + batch.points[j].z))
                                REQUIRE_MESSAGE(out[k][j] == 0.0f, describe(batch, j));
                        continue;
                    }
                    const Homogeneous at = support::exactly_at(batch.matrix, batch.points[j]);
                    const std::string wrong = what_is_wrong(at, texgen::whole_texture(), tolerance, out, j);
                    REQUIRE_MESSAGE(wrong.empty(), wrong, " for ", describe(batch, j), ", tolerance ",
                                    hex(tolerance.value));
                    if (std::fabs(at.q.estimate()) < 1e38)
                        REQUIRE_MESSAGE(std::isfinite(strq[j].w), describe(batch, j));
                }
            }
        }
    }
    CHECK(spoilt > 5000);
}

TEST_CASE("matrices and points of random bits write nothing but their outputs") {
    Random random(6800);
    for (int i = 0; i < 4000; ++i) {
        Batch batch{glm::dmat4(0.0), Points(static_cast<std::size_t>(random.integer(0, 40)))};
        for (int column = 0; column < 4; ++column)
            for (int k = 0; k < 4; ++k) batch.matrix[column][k] = std::bit_cast<double>(random.bits());
        for (glm::vec3& point : batch.points)
            for (int k = 0; k < 3; ++k) point[k] = random.any_float();
        const texgen::TextureRegion region =
            texgen::atlas_tile({random.any_float(), random.any_float()}, {random.any_float(), random.any_float()});
        Outputs out(batch.points.size());
        const Tolerance tolerance{random.coin() ? 0.0 : static_cast<double>(random.any_float())};
        project(batch.texgen(), batch.positions(), region, out.spans(), tolerance);
        REQUIRE(out.pads_are_intact());
        for (const float lit : out.lit()) REQUIRE_MESSAGE((lit == 0.0f || lit == 1.0f), hex(batch.matrix));
        std::vector<glm::vec2> pairs(batch.points.size());
        project(batch.texgen(), batch.positions(), std::span(pairs), tolerance);
        std::vector<glm::vec4> strq(batch.points.size());
        generate(batch.texgen(), batch.positions(), strq);
    }
}

TEST_CASE("divide is the nearest float in front, and empty behind") {
    Random random(6900);
    int in_front = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::vec4 strq{random.any_float(), random.any_float(), random.any_float(), random.any_float()};
        const std::optional<glm::vec2> st = texgen::divide(strq);
        REQUIRE_MESSAGE(st.has_value() == (strq.w > 0.0f), hex(strq));
        if (!st || !std::isfinite(strq.w)) continue;
        for (int k = 0; k < 2; ++k) {
            if (!std::isfinite(strq[k])) continue;
            ++in_front;
            REQUIRE_MESSAGE(support::is_nearest((*st)[k], {Dyadic(strq[k]), Dyadic(strq.w)}), hex(strq));
        }
    }
    CHECK(in_front > 10000);
}

}  // namespace texcoord_cases
