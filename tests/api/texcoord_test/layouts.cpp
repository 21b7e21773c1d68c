// A point has the same coordinates however it is laid out, wherever it stands, and in each of the four spaces.

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "api/texcoord_test/point_families.hpp"
#include "judges/exact.hpp"
#include "judges/verdict.hpp"
#include "support/doubtful.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/texcoord.hpp"

namespace texcoord_cases {

using support::Outputs;
using support::same_bits;

TEST_CASE("pairs are the planar s and t, and 0 behind") {
    Random random(6400);
    for (const PointFamily& family : families) {
        for (std::size_t count = 0; count < 70; ++count) {
            const Batch batch = family.make(random, count);
            Outputs planar(count);
            project(batch.texgen(), batch.positions(), texgen::whole_texture(), planar.spans());
            std::vector<glm::vec2> pairs(count + 2, glm::vec2(-7.0f));
            project(batch.texgen(), batch.positions(), std::span(pairs).subspan(1, count));
            REQUIRE(pairs.front() == glm::vec2(-7.0f));
            REQUIRE(pairs.back() == glm::vec2(-7.0f));
            for (std::size_t i = 0; i < count; ++i) {
                REQUIRE_MESSAGE(same_bits(pairs[i + 1].x, planar.s()[i]), describe(batch, i));
                REQUIRE_MESSAGE(same_bits(pairs[i + 1].y, planar.t()[i]), describe(batch, i));
            }
            const texgen::Tolerance tolerance{random.power_of_ten(-7.0, 1.0)};
            project(batch.texgen(), batch.positions(), std::span(pairs).subspan(1, count), tolerance);
            REQUIRE(pairs.front() == glm::vec2(-7.0f));
            REQUIRE(pairs.back() == glm::vec2(-7.0f));
            for (std::size_t i = 0; i < count; ++i) {
                const Homogeneous at = support::exactly_at(batch.matrix, batch.points[i]);
                for (int k = 0; k < 2; ++k) {
                    const float value = pairs[i + 1][k];
                    const auto coordinate = static_cast<std::size_t>(k);
                    REQUIRE_MESSAGE(
                        (at.q.sign() > 0 ? keeps(value, at.over_q(coordinate), coordinate, tolerance) : value == 0.0f),
                        describe(batch, i), ", tolerance ", hex(tolerance.value));
                }
            }
        }
    }
}

TEST_CASE("a point's bits do not depend on how the positions are laid out, nor on its place, nor on the outputs") {
    Random random(6500);
    std::vector<std::size_t> counts;
    for (std::size_t count = 0; count <= 67; ++count) counts.push_back(count);
    for (std::size_t count = 125; count <= 131; ++count) counts.push_back(count);
    for (std::size_t count = 253; count <= 260; ++count) counts.push_back(count);
    for (const std::size_t count : counts) {
        const PointFamily& family = families[static_cast<std::size_t>(random.integer(0, 11))];
        Batch batch = family.make(random, count);
        const bool sliding = random.coin();  // planar arrays that share memory, as a stride of one float has them
        std::vector<float> line(count + 2);
        if (sliding) {
            for (float& value : line) value = random.uniform_float(-3.0, 3.0);
            for (std::size_t i = 0; i < count; ++i) batch.points[i] = {line[i], line[i + 1], line[i + 2]};
        }
        const texgen::TextureRegion sides = texgen::atlas_tile({0.1, 0.1}, {0.7, 0.9});
        const texgen::TextureRegion region = random.coin() ? sides : sides.with_depth(0.1, 0.95);

        // One by one.
        Outputs expected(count);
        std::vector<glm::vec4> expected_strq(count);
        for (std::size_t i = 0; i < count; ++i) {
            const Positions<Object> one = texgen::object_space(std::span<const glm::vec3>(batch.points).subspan(i, 1));
            const texgen::Texcoords all = expected.spans();
            project(batch.texgen(), one, region,
                    {.s = all.s.subspan(i, 1),
                     .t = all.t.subspan(i, 1),
                     .r = all.r.subspan(i, 1),
                     .lit = all.lit.subspan(i, 1)});
            generate(batch.texgen(), one, std::span(expected_strq).subspan(i, 1));
        }

        const auto require_same = [&](const Positions<Object>& positions) {
            REQUIRE(positions.size() == count);
            const auto asked = static_cast<unsigned>(random.integer(0, 15));
            Outputs out(count, asked, static_cast<std::size_t>(random.integer(0, 16)));
            project(batch.texgen(), positions, region, out.spans());
            REQUIRE(out.pads_are_intact());
            for (std::size_t k = 0; k < 4; ++k)
                if (out.asked(k)) REQUIRE_MESSAGE(same_bits(out[k], expected[k]), family.name, hex(batch.matrix));
            std::vector<glm::vec4> strq(count);
            generate(batch.texgen(), positions, strq);
            for (std::size_t i = 0; i < count; ++i) {
                REQUIRE(positions[i] == batch.points[i]);
                for (int k = 0; k < 4; ++k)
                    REQUIRE_MESSAGE(same_bits(strq[i][k], expected_strq[i][k]), describe(batch, i));
            }
        };

        require_same(batch.positions());
        for (const std::size_t shift : {0u, 1u, 7u}) {
            std::array<std::vector<float>, 3> planar;
            for (std::size_t k = 0; k < 3; ++k) {
                planar[k].assign(count + shift + k, support::nan_float);
                for (std::size_t i = 0; i < count; ++i) planar[k][shift + k + i] = batch.points[i][static_cast<int>(k)];
            }
            const auto part = [&](std::size_t k) { return std::span<const float>(planar[k]).subspan(shift + k); };
            require_same(texgen::object_space(part(0), part(1), part(2)));
        }
        if (sliding) {
            const std::span<const float> x(line);
            require_same(texgen::object_space(x.subspan(0, count), x.subspan(1, count), x.subspan(2, count)));
            require_same(texgen::object_space(line.data(), count, sizeof(float)));
        }
        for (const std::size_t stride : {12u, 13u, 15u, 16u, 17u, 20u, 24u, 31u, 32u, 36u, 64u, 100u}) {
            const auto misalignment = static_cast<std::size_t>(random.integer(0, 7));
            // Nothing beyond the last point may be read: the allocation ends there.
            std::vector<std::byte> bytes(count == 0 ? 0 : misalignment + (count - 1) * stride + sizeof(glm::vec3),
                                         std::byte{0xff});
            for (std::size_t i = 0; i < count; ++i)
                std::memcpy(bytes.data() + misalignment + i * stride, &batch.points[i], sizeof(glm::vec3));
            const auto* first = count == 0 ? nullptr : reinterpret_cast<const float*>(bytes.data() + misalignment);
            require_same(texgen::object_space(first, count, stride));
        }
        if (count == 0) continue;
        const glm::vec3 point = batch.points[0];
        batch.points.assign(count, point);
        for (std::size_t i = 0; i < count; ++i) {
            const texgen::Texcoords all = expected.spans();
            for (const std::span<float> output : {all.s, all.t, all.r, all.lit}) output[i] = output[0];
            expected_strq[i] = expected_strq[0];
        }
        require_same(texgen::object_space(&point.x, count, 0));  // one point, as often as asked
    }
}

TEST_CASE("within a tolerance coordinates in arrays have the same bits wherever these begin") {
    Random random(6501);
    const Tolerance tolerance = texgen::texels(1.0 / 16.0, 1024.0);
    for (const std::size_t count : {16u, 31u, 48u, 100u, 256u, 300u, 1100u, 5000u}) {
        const support::Cloud cloud = support::ordinary_cloud(count, random);
        const texgen::WorldTexgen texgen(cloud.matrix);
        std::vector<float> x, y, z;
        for (const glm::vec3& point : cloud.points) {
            x.push_back(point.x);
            y.push_back(point.y);
            z.push_back(point.z);
        }
        const Positions<texgen::World> alone = texgen::world_space(x, y, z);
        for (const auto& positions : {alone, alone.within({glm::vec3(-9.0f), glm::vec3(9.0f)})}) {
            Outputs nearest(count), first(count, 3u);
            project(texgen, positions, texgen::whole_texture(), nearest.spans());
            project(texgen, positions, texgen::whole_texture(), first.spans(), tolerance);
            for (std::size_t misalignment = 1; misalignment <= 16; ++misalignment) {
                Outputs out(count, misalignment % 4 == 0 ? 11u : 3u, misalignment);
                project(texgen, positions, texgen::whole_texture(), out.spans(), tolerance);
                REQUIRE(out.pads_are_intact());
                REQUIRE_MESSAGE(same_bits(out.s(), first.s()), count, " points, ", misalignment);
                REQUIRE_MESSAGE(same_bits(out.t(), first.t()), count, " points, ", misalignment);
            }
            for (std::size_t i = 0; i < count; ++i) {
                REQUIRE(std::abs(first.s()[i] - nearest.s()[i]) <= 1.01 * tolerance.value);
                REQUIRE(std::abs(first.t()[i] - nearest.t()[i]) <= 1.01 * tolerance.value);
            }
        }
    }
}

TEST_CASE("the four spaces give the same numbers") {
    Random random(6600);
    const Batch batch = slide(random, 50);
    std::array<Outputs, 4> out{Outputs(50), Outputs(50), Outputs(50), Outputs(50)};
    project(ObjectTexgen(batch.matrix), texgen::object_space(batch.points), texgen::whole_texture(), out[0].spans());
    project(texgen::WorldTexgen(batch.matrix), texgen::world_space(batch.points), texgen::whole_texture(),
            out[1].spans());
    project(texgen::EyeTexgen(batch.matrix), texgen::eye_space(batch.points), texgen::whole_texture(), out[2].spans());
    project(texgen::WindowTexgen(batch.matrix), texgen::window_space(batch.points), texgen::whole_texture(),
            out[3].spans());
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t space = 1; space < 4; ++space) CHECK(same_bits(out[0][k], out[space][k]));
}

}  // namespace texcoord_cases
