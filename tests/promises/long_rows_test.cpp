// Rectangles as wide and as high as an int says. Where the machine cannot map arrays that are longer than memory there
// is nothing to test.

#include <doctest/doctest.h>

#if defined(__linux__) && defined(__LP64__)

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "support/long_array.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"

namespace {

using support::LongArray;
using texgen::FragmentRect;
using texgen::Triangle;
using texgen::TriangleSetup;
using texgen::detail::StepRule;
using texgen::detail::TileJob;

constexpr int longest = std::numeric_limits<int>::max();
constexpr std::size_t tail = 700;  // more than two chunks
constexpr float poison = -7.0f;

// A row, or column, that ends as an int does, from the middle of two others on; its last floats have values of no
// others.
TileJob job_of(int width, int height, std::span<float> out) {
    TileJob job{};
    job.width = width;
    job.height = height;
    const double step = -0x1p-31;
    job.numerator = {{1.0, 1.5}, {step, 0.5 * step}, {step, 0.5 * step}};
    job.q = {1.0, 0x1p-32, 0x1p-32};
    job.out[0] = job.out[1] = out.data();
    job.pitch = width;
    job.is_contiguous = true;
    return job;
}

// Of s, in the last fragments of such a job.
bool is_right(std::span<const float> last, float tolerance) {
    for (std::size_t i = 0; i < last.size(); ++i) {
        const double x = static_cast<double>(longest) - static_cast<double>(last.size() - i);
        const double t = (1.5 - 0x1p-32 * x) / (1.0 + 0x1p-32 * x);
        if (!(std::abs(static_cast<double>(last[i]) - t) <= tolerance + 0x1p-24 * t)) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("units and chunks at the end of the longest rows and columns are done, and nothing beyond them") {
    const LongArray array(longest);
    if (!array.is_usable()) return;
    const texgen::detail::TileKernels& kernels = texgen::detail::chosen<texgen::detail::TileKernels>();
    for (const bool is_row : {true, false}) {
        CAPTURE(is_row);
        TileJob job = is_row ? job_of(longest, 1, array.floats()) : job_of(1, longest, array.floats());
        const auto at = [&](int i) { return is_row ? TileJob::Unit{i, 0, 0, 0} : TileJob::Unit{0, 0, i, 0}; };

        std::ranges::fill(array.last(tail), poison);
        TileJob::Unit unit = is_row ? job.unit_at(longest - 300, 0) : job.unit_at(0, longest - 300);
        std::uint64_t doubtful = 0;
        for (int units = 0; !job.is_done(unit = fill_units(kernels, job, unit, TileJob::unit_size, doubtful));
             unit = job.unit_after(unit))
            REQUIRE(++units < 300);
        CHECK(is_right(array.last(300), 0.0f));
        CHECK(array.last(tail)[tail - 301] == poison);

        if (!is_row) continue;  // chunks are parts of rows
        std::ranges::fill(array.last(tail), poison);
        job.tolerance = 0x1p-10;
        job.chunk = 256;
        for (const StepRule rule : {StepRule::degree4, StepRule::undecided}) {
            job.steps = rule;
            const int first = (longest - 300) / job.chunk * job.chunk;
            fill_chunk_groups(kernels, job, at(first), [](const TileJob::Unit&) { FAIL_CHECK("refused"); });
            CHECK(is_right(array.last(300), 0x1p-10f));
        }

        // Where no rule serves, what is refused is the rest of the row.
        job.tolerance = 0.0;
        job.steps = StepRule::undecided;
        const int first = (longest - 1) / job.chunk * job.chunk;
        TileJob::Unit refused{};
        fill_chunk_groups(kernels, job, at(first), [&](const TileJob::Unit& rest) { refused = rest; });
        CHECK(refused.x_begin == first);
        CHECK(refused.x_end == longest);
    }
}

#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__)  // else it takes minutes
TEST_CASE("the longest row ends as a short one in its place") {
    const LongArray array(longest);
    if (!array.is_usable()) return;
    // s and t fall to 0 at the far corner, so that neighbours there differ.
    constexpr float size = 0x1p31f;
    const Triangle triangle{.a = {{0.0f, 0.0f}, 1.0f, {1.0f, 1.0f, 0.5f, 1.0f}},
                            .b = {{size, 0.0f}, 1.0f, {0.0f, 0.5f, 0.5f, 2.0f}},
                            .c = {{0.0f, size}, 1.0f, {0.5f, 0.0f, 0.5f, 2.0f}}};
    for (const double tolerance : {0.0, 0x1p-20}) {
        CAPTURE(tolerance);
        const auto setup = TriangleSetup::of(triangle, texgen::whole_texture(), texgen::Tolerance{tolerance}).value();
        std::ranges::fill(array.last(tail), poison);
        const FragmentRect all{0, 0, longest, 1};
        const FragmentRect end{longest - static_cast<int>(tail), 0, static_cast<int>(tail), 1};
        texgen::interpolate(setup, all, {.s = array.floats(), .t = {}, .r = {}, .lit = {}});
        std::vector<float> expected(tail);
        texgen::interpolate(setup, end, {.s = expected, .t = {}, .r = {}, .lit = {}});
        for (std::size_t i = 0; i < tail; ++i) REQUIRE(std::abs(array.last(tail)[i] - expected[i]) <= 2.0 * tolerance);
    }
}
#endif

TEST_CASE("footprints of rows that are longer than floats count are those of their fragments") {
    constexpr int width = (1 << 25) + 77;
    const LongArray array(width);
    if (!array.is_usable()) return;
    // So near to the projector's plane at the end of the row that the level differs from fragment to fragment.
    const Triangle near_plane{.a = {{0.0f, 0.0f}, 1.0f, {0.5f, 0.5f, 0.5f, 1.0f}},
                              .b = {{0x1p25f, 0.0f}, 1.0f, {0x1p-13f, 0x1p-13f, 0.5f, 0x1p-11f}},
                              .c = {{0.0f, 0x1p25f}, 1.0f, {0.5f, 0.25f, 0.5f, 1.0f}}};
    const TriangleSetup triangle_setup = TriangleSetup::of(near_plane, texgen::whole_texture()).value();
    const texgen::FootprintSetup setup(triangle_setup, {4096.0, 4096.0});
    for (const int first : {0, width - 300}) {
        const FragmentRect rect{first, 0, width - first, 1};
        const std::span<float> levels = array.last(static_cast<std::size_t>(rect.width));
        REQUIRE(texgen::footprint(setup, rect, {{}, {}, {}, {}, levels, {}, {}, {}}));
        for (int x = width - 300; x < width; ++x) {
            const float level = levels[static_cast<std::size_t>(x - first)];
            REQUIRE(std::abs(level - setup.at(x, 0).value().level) <= 0x1p-15);
        }
    }
}

#endif
