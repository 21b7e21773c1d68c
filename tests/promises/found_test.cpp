// What the fuzzers and the adversary found, kept as it was.

#include <doctest/doctest.h>

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "judges/exact.hpp"
#include "judges/verdict.hpp"
#include "support/outputs.hpp"
#include "support/special_values.hpp"
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
    matrix[0][0] = std::numeric_limits<double>::quiet_NaN();
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
