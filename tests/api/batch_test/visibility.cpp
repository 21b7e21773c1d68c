// Visibility buffers: each fragment has what its id says, values and footprints.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "api/batch_test/drawn.hpp"
#include "judges/fragments.hpp"
#include "support/footprint_outputs.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/special_values.hpp"
#include "support/triangles.hpp"
#include "texgen/batch.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"

namespace batch_cases {

using texgen::TriangleBatch;

namespace {

// The long runs of one id in the rows: where each begins, and how many fragments it has.
std::vector<std::pair<std::size_t, std::size_t>> long_runs(const std::vector<std::uint32_t>& ids, std::size_t width) {
    std::vector<std::pair<std::size_t, std::size_t>> runs;
    for (std::size_t begin = 0, end = 0; begin < ids.size(); begin = end) {
        while (end < (begin / width + 1) * width && ids[end] == ids[begin]) ++end;
        const bool is_long = end - begin >= texgen::detail::long_run;
        const auto is_next_row_the_same = [&] {
            return end + width <= ids.size() &&
                   std::count(&ids[end], &ids[end] + width, ids[begin]) == static_cast<std::ptrdiff_t>(width);
        };
        while (is_long && (end - begin) % width == 0 && is_next_row_the_same()) end += width;
        if (is_long) runs.emplace_back(begin, end - begin);
    }
    return runs;
}

}  // namespace

TEST_CASE("with exact, a visibility buffer has the bits that each fragment has alone") {
    Random random(2);
    int beyond = 0, long_count = 0;
    for (int round = 0; round < 1000; ++round) {
        const texgen::TextureRegion region = draw_region(random);
        const Drawn drawn(random, random.integer(0, 6));
        TriangleBatch batch(region);
        batch.assign(drawn.triangles);
        FragmentRect rect{random.integer(-20, 600), random.integer(-20, 600), random.integer(1, 40),
                          random.integer(1, 6)};
        // Where one of them is hard, as often as not.
        if (!drawn.rects.empty() && count_of(drawn.rects[0]) > 0 && random.integer(0, 3) != 0) rect = drawn.rects[0];
        if (random.integer(0, 9) == 0) rect.width = random.integer(60, 300), rect.height = random.integer(1, 3);
        std::vector<std::uint32_t> ids(count_of(rect));
        const int longest = rect.width < 60 ? random.integer(1, 30) : random.integer(40, 300);
        for (std::size_t i = 0; i < ids.size();) {
            const int any = random.integer(-1, static_cast<int>(batch.size()) - 1);
            auto id = static_cast<std::uint32_t>(any > 0 && random.coin() ? 0 : any);
            if (any < 0 && random.coin()) id = static_cast<std::uint32_t>(batch.size()) + 1000000u;  // none, either
            for (int run = random.integer(1, longest); run > 0 && i < ids.size(); --run) ids[i++] = id;
        }
        std::vector<bool> is_in_long_run(ids.size());
        for (const auto& [first, count] : long_runs(ids, static_cast<std::size_t>(rect.width))) {
            ++long_count;
            for (std::size_t i = first; i < first + count; ++i) is_in_long_run[i] = true;
        }
        const auto asked = static_cast<unsigned>(random.coin() ? 15 : random.integer(0, 15));
        Outputs out(ids.size(), asked, static_cast<std::size_t>(random.integer(0, 7)));
        interpolate(batch, ids, rect, out.spans());
        CHECK(out.pads_are_intact());
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const auto [x, y] = Shot{{}, rect}.fragment(i);
            // A pixel that no rectangle begins at is the last of one that ends there.
            const auto before = [](std::int64_t at) {
                return static_cast<int>(std::max<std::int64_t>(at - 0x7fffffff, 0));
            };
            const int left = before(x), above = before(y);
            beyond += left > 0 || above > 0;
            const FragmentRect pixels{static_cast<int>(x - left), static_cast<int>(y - above), left + 1, above + 1};
            if (ids[i] >= batch.size()) {
                for (std::size_t k = 0; k < 4; ++k) CHECK((!out.asked(k) || support::same_bits(out[k][i], 0.0f)));
                continue;
            }
            const Expected expected(drawn.triangles[ids[i]], region, pixels, asked | 8u, texgen::exact);
            const std::size_t last = count_of(pixels) - 1;
            // What is not lit may be 0 where something else of the rectangle is lit, or nothing of a long run.
            const bool is_dark =
                (last > 0 || is_in_long_run[i]) && expected.work != Work::nothing && expected.out.lit()[last] == 0.0f;
            bool is_zero = last == 0;
            for (std::size_t k = 0; k < 4; ++k) is_zero = is_zero && (!out.asked(k) || out[k][i] == 0.0f);
            const bool is_right = is_dark && last > 0 ? !out.asked(3) || out.lit()[i] == 0.0f
                                                      : agree(expected, last, out, i, 1) || (is_dark && is_zero);
            if (!is_right) FAIL_CHECK(support::hex(drawn.triangles[ids[i]]), " at ", x, " ", y, " asked ", asked);
        }
    }
    CHECK(beyond > 100);
    CHECK(long_count > 100);
}

TEST_CASE("long runs of one id in a row are found whole, as are rows that are one, and no others") {
    Random random(27);
    int runs = 0, of_rows = 0;
    for (int round = 0; round < 2000; ++round) {
        const auto width = static_cast<std::size_t>(random.integer(1, round % 2 == 0 ? 100 : 400));
        const auto height = static_cast<std::size_t>(random.integer(1, 4));
        const int longest = random.integer(1, 300);
        std::vector<std::uint32_t> ids(width * height);
        for (std::size_t i = 0; i < ids.size();) {
            const auto id = static_cast<std::uint32_t>(random.integer(0, 2));
            for (int run = random.integer(1, longest); run > 0 && i < ids.size(); --run) ids[i++] = id;
        }
        std::vector<std::pair<std::size_t, std::size_t>> found;
        std::size_t done = 0;
        const auto of_one = [&](std::size_t first, std::size_t count) {
            REQUIRE(std::exchange(done, first + count) == first);
            found.emplace_back(first, count);
        };
        const auto of_any = [&](std::size_t begin, std::size_t end) { REQUIRE(std::exchange(done, end) == begin); };
        texgen::detail::for_each_stretch(ids, width, of_one, of_any);
        REQUIRE(done == ids.size());
        REQUIRE_MESSAGE(found == long_runs(ids, width), "width ", width, ", round ", round);
        runs += static_cast<int>(found.size());
        for (const auto& [first, count] : found) of_rows += count > width;
    }
    CHECK(runs > 1000);
    CHECK(of_rows > 100);
}

TEST_CASE("ids beyond the batch are no triangle, in runs and one by one, and refused ones are dark") {
    Random random(12);
    const std::vector<Triangle> friendly(3, support::make_triangle(support::Family::friendly, random));
    const FragmentRect rect{100, 100, 64, 3};
    for (int k = 0; k < 4; ++k) {
        for (const float bad : {support::infinity_float, support::nan_float}) {
            std::vector<Triangle> triangles = friendly;
            triangles[1].c.strq[k] = bad;
            TriangleBatch batch(texgen::whole_texture());
            batch.assign(triangles);
            for (const std::uint32_t id : {1u, 3u, 1000000u, 0xfffffffeu, 0xffffffffu}) {
                for (const std::uint32_t others : {id, 0u}) {  // rows of it, and every other fragment
                    std::vector<std::uint32_t> ids(count_of(rect), id);
                    for (std::size_t i = 0; i < ids.size(); i += 2) ids[i] = others;
                    Outputs values(ids.size());
                    interpolate(batch, ids, rect, values.spans());
                    support::FootprintOutputs footprints(rect);
                    footprint(batch, ids, rect, {1024.0, 512.0}, footprints.spans());
                    for (std::size_t i = 1; i < ids.size(); i += 2) {
                        for (std::size_t j = 0; j < 4; ++j) REQUIRE(support::same_bits(values[j][i], 0.0f));
                        for (std::size_t j = 0; j < 8; ++j) REQUIRE(support::same_bits(footprints[j][i], 0.0f));
                    }
                }
            }
        }
    }
}

TEST_CASE("footprints of a visibility buffer are those of its triangles") {
    Random random(5);
    int checked = 0, long_runs = 0, whole_rows = 0, dark = 0;
    for (int round = 0; round < 120; ++round) {
        Drawn drawn(random, random.integer(1, 9));
        if (random.coin()) drawn.triangles.back() = refused(random);
        TriangleBatch batch(texgen::whole_texture());
        batch.assign(drawn.triangles);
        const bool may_be_long = round % 3 == 0;
        const FragmentRect rect{random.integer(-20, 600), random.integer(-20, 600),
                                random.integer(1, may_be_long ? 200 : 20), 3};
        std::vector<std::uint32_t> ids(count_of(rect));
        for (std::size_t i = 0; i < ids.size();) {
            const auto id = static_cast<std::uint32_t>(random.integer(-1, static_cast<int>(batch.size()) - 1));
            const int longest = may_be_long && random.coin() ? 3 * rect.width : 9;
            const std::size_t before = i;
            for (int run = random.integer(1, longest); run > 0 && i < ids.size(); --run) ids[i++] = id;
            long_runs += i - before >= 128;
            whole_rows += i - before >= 2 * static_cast<std::size_t>(rect.width) && rect.width >= 64;
        }
        const texgen::TexelsPerUnit texels{1024.0, 512.0};
        const auto asked = static_cast<unsigned>(random.coin() ? 255 : random.integer(0, 255));
        support::FootprintOutputs out(rect, asked, static_cast<std::size_t>(random.integer(0, 15)));
        footprint(batch, ids, rect, texels, out.spans());
        CHECK(out.pads_are_intact());
        for (std::size_t i = 0; i < ids.size(); ++i) {
            bool is_dark = true;
            for (std::size_t k = 0; k < 8; ++k)
                is_dark = is_dark && (!out.asked(k) || support::same_bits(out[k][i], 0.0f));
            const int x = rect.x + static_cast<int>(i) % rect.width, y = rect.y + static_cast<int>(i) / rect.width;
            const auto triangle = ids[i] != texgen::no_triangle
                                      ? TriangleSetup::of(drawn.triangles[ids[i]], texgen::whole_texture())
                                      : std::nullopt;
            std::optional<texgen::Footprint> exact;
            if (triangle) exact = texgen::FootprintSetup(*triangle, texels).at(x, y);
            if (!exact) {
                CHECK_MESSAGE(is_dark, "id ", ids[i], " at ", x, " ", y);
                ++dark;
                continue;
            }
            if (is_dark) continue;  // of a long run that is not lit
            const glm::dvec2 bound = texgen::FootprintSetup(*triangle, texels).error_bound({x, y, 1, 1});
            for (std::size_t k = 0; k < 4; ++k) {
                if (!out.asked(k)) continue;
                const auto coordinate = static_cast<glm::length_t>(k % 2);
                const double expected = k < 2 ? exact->dx[coordinate] : exact->dy[coordinate];
                const double length = std::hypot(exact->dx[coordinate], exact->dy[coordinate]);
                const double allowed = 2.0 * bound[coordinate] + texgen::batch_footprint_error * length;
                if (!(length < 0x1p100) || !(allowed < length)) continue;
                ++checked;
                CHECK_MESSAGE(std::fabs(out.at(k, i) - expected) <= allowed, support::hex(drawn.triangles[ids[i]]));
            }
        }
    }
    CHECK(checked > 5000);
    CHECK(long_runs > 10);
    CHECK(whole_rows > 5);
    CHECK(dark > 1000);
}

}  // namespace batch_cases
