// Ties of a batch, some of more bits than doubles, and the slowest tiles that were found.

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "support/hard_triangles.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "texgen/batch.hpp"
#include "texgen/interpolate.hpp"

namespace {

using support::count_of;
using support::Outputs;
using support::Random;
using support::Shot;
using texgen::FragmentRect;
using texgen::Triangle;
using texgen::TriangleBatch;

}  // namespace

TEST_CASE("a tie that has more bits than two doubles is decided as for each triangle alone") {
    Random random(9);
    for (int round = 0; round < 2000; ++round) {
        // The fragment is half-way between a and b, where (w_b s_a + w_a s_b) / (w_a + w_b) is the middle of two
        // floats.
        const FragmentRect rect{random.integer(600, 1000), random.integer(600, 1000), 1, 1};
        const auto odd = [&] { return 2 * random.integer(1 << 16, 1 << 18) + 1; };
        const int w[2] = {odd(), odd()};
        const double off[2] = {random.integer(1, 1 << 20) * 0x1p-12, random.integer(1, 1 << 20) * 0x1p-12};
        const int middle[2] = {2 * random.integer(3 << 22, 7 << 21) + 1, 2 * random.integer(3 << 22, 7 << 21) + 1};
        const auto vertex = [&](int side) {
            const double sign = side == 0 ? -1.0 : 1.0;
            const auto texture = [&](int k) { return (middle[k] + sign * w[side]) * 0x1p-25; };
            return texgen::WindowVertex{
                {support::to_float(rect.x + 0.5 + sign * off[0]), support::to_float(rect.y + 0.5 + sign * off[1])},
                support::to_float(w[side]),
                {support::to_float(texture(0)), support::to_float(texture(1)), 0.0f, 1.0f}};
        };
        const auto any = [&] { return support::to_float(random.uniform(0x1p-12, 0x1p-11)); };
        const Triangle triangle{vertex(0),
                                vertex(1),
                                {{any(), any()},
                                 support::to_float(random.uniform(1.0, 2.0)),
                                 {any(), any(), any(), support::to_float(random.uniform(1.0, 2.0))}}};
        TriangleBatch batch(support::everywhere());
        batch.assign({&triangle, 1});
        const std::uint32_t id = 0;
        Outputs out(1, 3u);
        interpolate(batch, {&id, 1}, rect, out.spans());
        const auto at = support::ExactTriangle(triangle).at(rect.x, rect.y);
        for (std::size_t k = 0; k < 2; ++k) {
            const support::Quotient u = at.over_q(k);
            REQUIRE(compare(u, middle[k] * 0x1p-25) == 0);
            CHECK_MESSAGE(is_nearest(out[k][0], u), support::hex(triangle), " at ", support::text(rect));
        }
    }
}

// Of 384 000 such ties those that were decided wrongly where the rounded integer was taken for the exact one, and nothing
// else bounded what residues decide.
TEST_CASE("a tie of an integer that is rounded as it becomes a double is a tie") {
    struct Found {
        float w[3];
        int x, y;
    };
    for (const Found& found : {Found{{0x1.a94e0ep+0f, 0x1.fa1e5ap+0f, 0x1.e2678ap+0f}, 281, 752},
                               Found{{0x1.cd34e6p+0f, 0x1.f4035ep+0f, 0x1.551fd6p+0f}, 337, 968},
                               Found{{0x1.abf152p+0f, 0x1.ed0762p+0f, 0x1.faf93ep+0f}, 231, 962}}) {
        const auto vertex = [&](float x, float y, std::size_t i, float s) {
            const float w = found.w[i];
            return texgen::WindowVertex{{x, y}, w, {w * s, w * s, 0.0f, w}};
        };
        const Triangle triangle{vertex(0.0f, 0.0f, 0, 0x1p24f), vertex(0x1p23f, 0.0f, 1, 0x1p25f),
                                vertex(0.0f, 1.0f, 2, 0x1p24f)};
        TriangleBatch batch(support::everywhere());
        batch.assign({&triangle, 1});
        Outputs out(16, 3u);
        interpolate(batch, std::vector<std::uint32_t>(16, 0), {found.x, found.y, 16, 1}, out.spans());
        for (std::size_t i = 0; i < 16; ++i) {
            const int odd = (1 << 24) + 2 * (found.x + static_cast<int>(i)) + 1;
            CHECK_MESSAGE(out[0][i] == static_cast<float>(odd), support::hex(triangle), " number ", i);
        }
    }
}

TEST_CASE("tiles next to the slowest that were found have the bits of a setup") {
    std::ifstream file(TEXGEN_TEST_DATA "/promises/worst_inputs.txt");
    std::vector<std::vector<float>> found;
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("interpolate a batch")) continue;
        std::istringstream words(line.substr(line.rfind('|') + 1));
        std::vector<float>& numbers = found.emplace_back();
        for (std::string word; words >> word;) numbers.push_back(std::strtof(word.c_str(), nullptr));
        REQUIRE(numbers.size() == 23);
    }
    REQUIRE(!found.empty());
    Random random(13);
    for (int round = 0; round < 20000; ++round) {
        std::vector<float> n = found[random.bits() % found.size()];
        for (int change = random.integer(0, 2); change > 0; --change) {
            float& number = n[random.bits() % n.size()];
            const auto flipped =
                std::bit_cast<float>(std::bit_cast<std::uint32_t>(number) ^ std::uint32_t{1} << random.integer(0, 31));
            number = random.coin() ? flipped : std::round(number);
        }
        if (std::isnan(n[21]) || std::isnan(n[22])) continue;
        const auto pixel = [](float at) { return static_cast<int>(std::clamp(at, -0x1p30f, 0x1p30f)); };
        const auto vertex = [&](const float* v) {
            return texgen::WindowVertex{{v[0], v[1]}, v[2], {v[3], v[4], v[5], v[6]}};
        };
        const Triangle triangle{vertex(&n[0]), vertex(&n[7]), vertex(&n[14])};
        const FragmentRect rect{pixel(n[21]), pixel(n[22]), random.coin() ? 8 : 5, 8};
        const auto setup = texgen::TriangleSetup::of(triangle, support::everywhere(), texgen::exact);
        if (!setup) continue;
        Outputs expected(count_of(rect), 11u);
        if (interpolate(*setup, rect, expected.spans()) == texgen::Work::nothing) continue;
        TriangleBatch batch(support::everywhere());
        batch.assign({&triangle, 1});
        Outputs out(count_of(rect), 11u);
        interpolate(batch, {&rect, 1}, out.spans());
        for (std::size_t i = 0; i < count_of(rect); ++i) {
            const bool is_same = out[3][i] == expected[3][i] &&
                                 (out[3][i] == 0.0f || (out[0][i] == expected[0][i] && out[1][i] == expected[1][i]));
            CHECK_MESSAGE(is_same, support::hex(triangle), " at ", support::text(rect), " fragment ", i);
            if (!is_same) return;
        }
    }
}

TEST_CASE("quotients at the middle of two floats are the nearest where s changes its sign or is no normal float") {
    Random random(10);
    const auto check = [](const Shot& shot) {
        TriangleBatch batch(support::everywhere());
        batch.assign({&shot.triangle, 1});
        Outputs out(count_of(shot.rect), 3u);
        interpolate(batch, {&shot.rect, 1}, out.spans());
        const support::ExactTriangle exact(shot.triangle);
        for (int i = 0; i < shot.rect.width; ++i)
            for (std::size_t k = 0; k < 2; ++k)
                REQUIRE_MESSAGE(is_nearest(out[k][static_cast<std::size_t>(i)], exact.at(shot.x(i), 0).over_q(k)),
                                support::hex(shot), " fragment ", i);
    };
    for (int round = 0; round < 100; ++round) {
        Shot steep = support::steep_row_with_a_tie(random.integer(1020, 1023), random);
        REQUIRE(is_tie(support::ExactTriangle(steep.triangle).at(steep.rect.x, 0).over_q(0)));
        steep.rect = {steep.rect.x - random.integer(0, 9), 0, 64, 1};
        check(steep);
        // s is 2 m + 1 of the least floats, and q is 2 and not half an ulp of a double more.
        const float s = static_cast<float>(2 * random.integer(1, 1000) + 1) * 0x1p-149f;
        const auto vertex = [s](float x, float y, float q) {
            return texgen::WindowVertex{{x, y}, 1.0f, {s, 0.5f, 0.5f, q}};
        };
        constexpr float below_centre = 0.5f - 0x1p-25f;
        check({{vertex(0.0f, below_centre, 2.0f), vertex(1024.0f, below_centre, 2.0f),
                vertex(0.0f, 1024.0f, 2.0f + 0x1p-22f)},
               {random.integer(0, 900), 0, 64, 1}});
    }
}
