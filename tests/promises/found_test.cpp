// What the fuzzers and the adversary found, kept as it was.

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "judges/exact.hpp"
#include "judges/verdict.hpp"
#include "support/outputs.hpp"
#include "support/special_values.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::nan_float;
using support::Outputs;
using texgen::Tolerance;

}  // namespace

TEST_CASE("a tolerance is kept where q is beyond the largest float") {
    const glm::dmat4 matrix{{0.0, 0.0, 0.0, 0.0},
                            {0.0, 0.0, 0.0, -0x1.0004p+6},
                            {-0x1.04p-2, 0x1.04p-2, -0x1.04p-2, 0x1.04p-2},
                            {-0x1.04p-2, 0x1.04p-2, -0x1.04p-2, 0x1.04p-2}};
    const std::vector<glm::vec3> points(300, glm::vec3(0x1.fe6626p+126f, -0x1.fe6626p+126f, 0x1.fe6626p+126f));
    Outputs out(points.size());
    const Tolerance tolerance{0x1p-15};
    project(texgen::ObjectTexgen(matrix), texgen::object_space(points), texgen::whole_texture(), out.spans(),
            tolerance);
    const std::string wrong =
        what_is_wrong(support::exactly_at(matrix, points[0]), texgen::whole_texture(), tolerance, out, 7);
    CHECK_MESSAGE(wrong.empty(), wrong);
}

TEST_CASE("behind the projector a coordinate whose numbers are NaN is 0, whatever its neighbours are") {
    const texgen::Segment segment{{0.5f, 0.5f, 0.5f, 1.0f}, {nan_float, 0.5f, nan_float, -1.0f}};
    for (const std::size_t count : {1u, 6u, 64u, 67u}) {
        for (const bool with_bad_neighbour : {false, true}) {
            std::vector<float> alpha(count, 1.0f);
            if (with_bad_neighbour) alpha.back() = nan_float;
            Outputs out(count);
            interpolate(segment, alpha, texgen::whole_texture(), out.spans());
            const std::size_t good = with_bad_neighbour ? count - 1 : count;
            for (std::size_t i = 0; i < good; ++i)
                for (std::size_t k = 0; k < 4; ++k) CHECK(support::same_bits(out[k][i], 0.0f));
        }
    }
    glm::dmat4 matrix(1.0);
    matrix[3] = {0.0, 0.0, 0.0, -1.0};
    matrix[0][0] = support::nan_double;
    const std::vector<glm::vec3> points(20, glm::vec3(1.0f));
    Outputs out(points.size());
    project(texgen::ObjectTexgen(matrix), texgen::object_space(points), texgen::whole_texture(), out.spans());
    for (std::size_t k = 0; k < 4; ++k)
        for (const float value : out[k]) CHECK(support::same_bits(value, 0.0f));
}

TEST_CASE("no points at no address are no layout that needs a look at them") {
    const texgen::Positions<texgen::Object> none = texgen::object_space(std::span<const glm::vec3>());
    CHECK(none.size() == 0);
    CHECK_FALSE(none.is_interleaved());
}

TEST_CASE("from a chunk of one fragment there are no steps, though they might be infinite") {
    // 3841 is 16 chunks of 240 fragments and one more.
    const auto vertex = [](float x, float y) {
        return texgen::WindowVertex{{x, y}, 1.0f, {0x1p110f * (x - 3840.5f), 0.0f, 0.0f, 0x1p-20f}};
    };
    const texgen::Triangle triangle{vertex(0.5f, 0.5f), vertex(3840.5f, 0.5f), vertex(0.5f, 64.5f)};
    const auto setup = texgen::TriangleSetup::of(triangle, texgen::whole_texture(), Tolerance{0x1p99});
    REQUIRE(setup);
    Outputs out(2 * 3841);
    interpolate(*setup, {0, 0, 3841, 2}, out.spans());
    for (const std::size_t last : {3840u, 7681u}) {
        CHECK(std::fabs(out.s()[last]) <= 0x1p99f);
        CHECK(out.lit()[last] == 1.0f);
    }
}

TEST_CASE("footprints whose lengths have a factor that is no normal float keep their bound") {
    constexpr int width = 4096, height = 8;
    const auto vertex = [](float x, float y) {
        const float q = 1.0f + (x - 0.5f) / 4095.0f * (0x1p-11f - 1.0f);
        return texgen::WindowVertex{{x, y}, 1.0f, {0x1.5p-126f, 0x1.1p-124f * ((y + 3.5f) / 16.0f), 0.0f, q}};
    };
    const texgen::Triangle triangle{vertex(0.5f, 0.5f), vertex(4095.5f, 0.5f), vertex(0.5f, 16.5f)};
    const auto setup = texgen::TriangleSetup::of(triangle, texgen::whole_texture());
    REQUIRE(setup);
    const glm::dvec2 texels(1.7 * 0x1p100, 1.3 * 0x1p60);
    const texgen::FootprintSetup footprints(*setup, {texels.x, texels.y});
    std::vector<float> major_s(width * height), major_t(width * height);
    texgen::Footprints out;
    out.major_s = major_s;
    out.major_t = major_t;
    footprint(footprints, {0, 0, width, height}, out);
    double worst = 0.0;
    int compared = 0;
    for (int i = 0; i < width * height; ++i) {
        const auto expected = footprints.at(i % width, i / width);
        REQUIRE(expected);
        const auto place = static_cast<std::size_t>(i);
        const glm::dvec2 right = glm::dvec2(expected->major) * texels;
        const glm::dvec2 error =
            glm::dvec2(static_cast<double>(major_s[place]), static_cast<double>(major_t[place])) * texels - right;
        if (std::fabs(expected->major.x) < 0x1p-120f) continue;  // what subnormal floats lose
        ++compared;
        worst = std::fmax(worst, std::hypot(error.x, error.y) / std::hypot(right.x, right.y));
    }
    CHECK(compared > 50);
    CHECK(worst <= 0x1p-16);
}
