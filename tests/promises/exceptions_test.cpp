// Programs that trap invalid operations, divisions by zero and overflow, as debug builds of games do, may call every
// function: with what a scene gives it none of these is raised, not even by lanes that hold nothing.

#include <doctest/doctest.h>

#include <array>
#include <cfenv>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "support/random.hpp"
#include "support/stopwatch.hpp"
#include "support/workloads.hpp"
#include "texgen/batch.hpp"
#include "texgen/interpolate.hpp"

namespace {

constexpr int trapped = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;

}  // namespace

TEST_CASE("no function raises an exception of floating point but underflow and inexact for an ordinary input") {
    std::size_t asked = 0;
    for (const support::Workload& workload : support::workloads) {
        CAPTURE(std::string(workload.function));
        support::Random random(8100);
        for (int i = 0; i < 20; ++i) {
            const support::Calls calls = workload.calls(workload.ordinary(random));
            if (!calls) continue;
            ++asked;
            std::feclearexcept(FE_ALL_EXCEPT);
            calls(1);
            REQUIRE(std::fetestexcept(trapped) == 0);
        }
    }
    CHECK(asked > 2000);
}

TEST_CASE("nor does one for the holes of a visibility buffer, fragments behind, or a segment of one q") {
    // q is 0 between the second column and the third.
    const auto vertex = [](float x, float y) {
        return texgen::WindowVertex{{x, y}, 1.0f, {0.25f * x + 0.125f * y, 0.5f + 0.25f * y, 0.5f, x - 1.75f}};
    };
    const std::array<texgen::Triangle, 1> triangle{{{vertex(0.0f, 0.0f), vertex(16.0f, 0.0f), vertex(0.0f, 16.0f)}}};
    texgen::TriangleBatch batch(texgen::whole_texture());
    batch.assign(triangle);
    for (const int width : {1, 3, 5, 8, 13}) {
        std::vector<std::uint32_t> ids(static_cast<std::size_t>(width) * 3, 0u);
        ids[ids.size() / 2] = texgen::no_triangle;
        std::array<std::vector<float>, 8> out;
        for (std::vector<float>& array : out) array.resize(ids.size());
        std::feclearexcept(FE_ALL_EXCEPT);
        interpolate(batch, ids, {0, 0, width, 3}, {out[0], out[1], out[2], out[3]});
        CHECK(std::fetestexcept(trapped) == 0);
        footprint(batch, ids, {0, 0, width, 3}, {4096.0, 4096.0},
                  {out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7]});
        CHECK(std::fetestexcept(trapped) == 0);
    }
    for (const texgen::Segment& segment : {texgen::Segment{{0.1f, 0.2f, 0.3f, 1.0f}, {0.5f, 0.6f, 0.7f, 1.0f}},
                                           texgen::Segment{{0.1f, 0.2f, 0.3f, 1.0f}, {0.1f, 0.2f, 0.3f, 1.0f}}}) {
        const std::vector<float> alpha{0.0f, 0.25f, 0.3f, 0.75f, 1.0f};
        std::array<std::vector<float>, 4> out;
        for (std::vector<float>& array : out) array.resize(alpha.size());
        for (const texgen::Tolerance tolerance : {texgen::exact, texgen::texels(1.0 / 16.0, 1024.0)}) {
            std::feclearexcept(FE_ALL_EXCEPT);
            interpolate(segment, alpha, texgen::whole_texture(), {out[0], out[1], out[2], out[3]}, tolerance);
            CHECK(std::fetestexcept(trapped) == 0);
        }
    }
}
