// Inputs whose exact value is so near to the middle of two floats that no double can tell the side: near_ties.txt,
// found by adversary.cpp. A bound on a rounding error that is too small decides some of them wrongly.

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "texgen/batch.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::everywhere;
using support::Outputs;

struct Answer {
    support::Homogeneous exact;
    Outputs out;
};

glm::vec4 four(const std::vector<double>& n, std::size_t i) {
    return {support::to_float(n[i]), support::to_float(n[i + 1]), support::to_float(n[i + 2]),
            support::to_float(n[i + 3])};
}

// The rows s, t and q of a matrix, column by column; and a point. `count` of it, so that it is met in vectors too.
Answer of_point(const std::vector<double>& n, std::size_t count) {
    glm::dmat4 matrix(0.0);
    for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t row = 0; row < 3; ++row)
            matrix[static_cast<int>(column)][row == 2 ? 3 : static_cast<int>(row)] = n[3 * column + row];
    const std::vector<glm::vec3> points(count, glm::vec3(four(n, 12)));
    Answer answer{support::exactly_at(matrix, points[0]), Outputs(count, 3u)};
    project(texgen::ObjectTexgen(matrix), texgen::object_space(points), everywhere(), answer.out.spans());
    return answer;
}

// The ends, and alpha.
Answer of_segment(const std::vector<double>& n, std::size_t count) {
    const texgen::Segment segment{four(n, 0), four(n, 4)};
    const std::vector<float> alpha(count, support::to_float(n[8]));
    Answer answer{support::exactly_at(segment, alpha[0]), Outputs(count, 3u)};
    interpolate(segment, alpha, everywhere(), answer.out.spans());
    return answer;
}

// Three times the window, w, and s, t, r, q; at the fragment (20, 20), the first of the rectangle.
texgen::Triangle triangle_of(const std::vector<double>& n) {
    const auto vertex = [&](std::size_t i) {
        return texgen::WindowVertex{
            {support::to_float(n[i]), support::to_float(n[i + 1])}, support::to_float(n[i + 2]), four(n, i + 3)};
    };
    return {vertex(0), vertex(7), vertex(14)};
}
Answer of_triangle(const std::vector<double>& n, const texgen::FragmentRect& rect,
                   const texgen::TextureRegion& region = everywhere(), unsigned asked = 3u) {
    const texgen::Triangle triangle = triangle_of(n);
    Answer answer{support::ExactTriangle(triangle).at(20, 20), Outputs(support::count_of(rect), asked)};
    interpolate(support::setup_of(triangle, region), rect, answer.out.spans());
    return answer;
}
Answer of_triangle(const std::vector<double>& n, std::size_t count) {
    return of_triangle(n, {20, 20, static_cast<int>(count), 1});
}

// The same in a region that has all that is near, so that one certificate may serve the tile; each coordinate alone, as
// well. Returns how many tiles that were.
int check_in_region(const std::vector<double>& n, const Answer& nearest, const std::string& line) {
    const glm::dvec2 value(nearest.out[0][0], nearest.out[1][0]);
    if (!(value.x > 0.0 && value.y > 0.0)) return 0;
    int tiles = 0;
    for (const glm::ivec2 size : {glm::ivec2{1, 1}, {5, 3}, {8, 8}, {16, 4}, {64, 1}, {64, 4}})
        for (const unsigned asked : {1u, 2u, 3u, 11u}) {
            const texgen::TextureRegion region = texgen::atlas_tile({0.0, 0.0}, 1e3 * value);
            const Answer answer = of_triangle(n, {20, 20, size.x, size.y}, region, asked);
            ++tiles;
            for (std::size_t k = 0; k < 2; ++k)
                if (answer.out.asked(k))
                    CHECK_MESSAGE(is_nearest(answer.out[k][0], answer.exact.over_q(k)), line, " ", size.x, " ", asked);
        }
    return tiles;
}

// What stands beside the float of that fragment: within the tolerance, as a part of the quotient, or on a side of the
// region; in tiles of one unit and of more. A mask alone is that of its coordinates.
void check_beside(const texgen::Triangle& triangle, const Answer& nearest, const std::string& line) {
    constexpr double beyond = 1e30;
    const glm::dvec2 value(nearest.out[0][0], nearest.out[1][0]);
    const auto beside = [&](double to) {
        return glm::dvec2(std::nextafter(nearest.out[0][0], support::to_float(to)),
                          std::nextafter(nearest.out[1][0], support::to_float(to)));
    };
    for (const texgen::FragmentRect rect : {texgen::FragmentRect{20, 20, 64, 1}, texgen::FragmentRect{20, 20, 64, 4}}) {
        for (const double share : {0.75 * 0x1p-25, 0x1p-25})
            for (std::size_t k = 0; k < 2; ++k) {
                const texgen::Tolerance tolerance{share * std::fabs(value[static_cast<int>(k)])};
                Outputs out(support::count_of(rect), 3u);
                interpolate(support::setup_of(triangle, everywhere(), tolerance), rect, out.spans());
                CHECK_MESSAGE(is_within(out[k][0], nearest.exact.over_q(k), tolerance.value), line, " ",
                              support::hex(tolerance.value));
            }
        for (const auto& [min, max] :
             {std::pair{glm::dvec2(-beyond), value}, std::pair{glm::dvec2(-beyond), beside(-beyond)},
              std::pair{value, glm::dvec2(beyond)}, std::pair{beside(beyond), glm::dvec2(beyond)}}) {
            const texgen::TextureRegion region = texgen::atlas_tile(min, max);
            Outputs out(support::count_of(rect), 8u);
            interpolate(support::setup_of(triangle, region), rect, out.spans());
            const bool is_lit = support::contains(region, nearest.out[0][0], nearest.out[1][0], 0.0f);
            CHECK_MESSAGE(out.lit()[0] == (is_lit ? 1.0f : 0.0f), line, " ", rect.width);
        }
    }
}

// The same by a batch, as a tile and by its id.
Answer of_tile(const std::vector<double>& n, int width, int height, bool by_id) {
    const texgen::Triangle triangle = triangle_of(n);
    texgen::TriangleBatch batch(everywhere());
    batch.assign({&triangle, 1});
    const texgen::FragmentRect rect{20, 20, width, height};
    const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    Answer answer{support::ExactTriangle(triangle).at(20, 20), Outputs(count, 3u)};
    if (by_id)
        interpolate(batch, std::vector<std::uint32_t>(count, 0), rect, answer.out.spans());
    else
        interpolate(batch, {&rect, 1}, answer.out.spans());
    return answer;
}

double distance_in_half_ulps(float value, const support::Quotient& u) {
    const double middle = support::detail::middle(value, compare(u, static_cast<double>(value)) > 0);
    return distance(middle, u) / std::fabs(middle - static_cast<double>(value));
}

}  // namespace

TEST_CASE("next to the middle of two floats the nearest is found, alone and in company") {
    std::ifstream file(TEXGEN_TEST_DATA "/promises/near_ties.txt");
    int next_to_the_middle = 0, lines = 0, in_region = 0;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line.front() == '#') continue;
        ++lines;
        std::istringstream fields(line);
        std::string kind, bits, number;
        fields >> kind >> bits;
        std::vector<double> numbers;
        while (fields >> number) numbers.push_back(std::strtod(number.c_str(), nullptr));
        for (const std::size_t count : {1u, 2u, 16u, 64u}) {
            const auto answer = kind == "project"   ? of_point(numbers, count)
                                : kind == "segment" ? of_segment(numbers, count)
                                                    : of_triangle(numbers, count);
            REQUIRE(answer.exact.q.sign() > 0);
            for (std::size_t k = 0; k < 2; ++k) {
                const support::Quotient u = answer.exact.over_q(k);
                CHECK_MESSAGE(is_nearest(answer.out[k][0], u), line);
                next_to_the_middle += distance_in_half_ulps(answer.out[k][0], u) < 0x1p-29;
            }
        }
        if (kind != "triangle") continue;
        const Answer nearest = of_triangle(numbers, 1);
        check_beside(triangle_of(numbers), nearest, line);
        in_region += check_in_region(numbers, nearest, line);
        for (const auto& size : {std::pair{8, 8}, std::pair{16, 4}, std::pair{64, 1}, std::pair{5, 3}})
            for (const bool by_id : {false, true}) {
                const Answer answer = of_tile(numbers, size.first, size.second, by_id);
                for (std::size_t k = 0; k < 2; ++k)
                    CHECK_MESSAGE(is_nearest(answer.out[k][0], answer.exact.over_q(k)), line, " ", size.first, " ",
                                  by_id);
            }
    }
    CHECK(lines >= 100);
    CHECK(next_to_the_middle >= 4 * lines);
    CHECK(in_region > 100);
}
