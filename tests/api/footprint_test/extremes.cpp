// The extremes of rectangles and of triangles hold for every fragment, and are reached.

#include "texgen/footprint.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "api/footprint_test/derivatives.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "support/footprint_outputs.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/special_values.hpp"
#include "support/triangles.hpp"
#include "texgen/interpolate.hpp"

namespace footprint_cases {

using support::infinity_double;
using texgen::Footprints;
using texgen::TriangleSetup;

namespace {

bool contains_centre(const Triangle& triangle, int x, int y) {
    const double side = support::twice_area(triangle);
    for (std::size_t i = 0; i < 3; ++i) {
        Triangle part = triangle;
        support::vertices(part)[i]->window = glm::vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        if (support::twice_area(part) * side < 0.0) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("no fragment of ten million is outside the extremes, and they are reached") {
    Random random(6500);
    std::size_t fragments = 0;
    int rects = 0, wide = 0, inner = 0;
    double worst_gap = 0.0;
    constexpr int side = 128;
    FootprintOutputs out({0, 0, side, side}, (1u << level) | (1u << anisotropy));
    FootprintOutputs derivatives({0, 0, side, side}, 15u);
    while (fragments < 10'000'000u) {
        const double ratio = random.power_of_ten(0.0, 2.5);
        Triangle triangle = spread_triangle(random, ratio);
        const int shape = random.integer(0, 9);
        if (shape == 0)  // q/w constant
            for (WindowVertex* vertex : support::vertices(triangle)) vertex->strq.w = vertex->clip_w;
        if (shape == 1)  // one column of the Jacobian passes through 0
            for (WindowVertex* vertex : support::vertices(triangle)) vertex->strq.y *= 0.01f;
        const FragmentRect rect{random.integer(-100, 500), random.integer(-100, 500), random.integer(2, side),
                                random.integer(2, side)};
        const TexelsPerUnit texels = some_texels(random);
        const FootprintSetup setup(setup_of(triangle), texels);
        const auto extremes = setup.extremes(rect);
        const std::size_t count = count_of(rect);
        Footprints spans = out.spans();
        Footprints of_derivatives = derivatives.spans();
        const bool written = footprint(setup, rect,
                                       {.dsdx = of_derivatives.dsdx.first(count),
                                        .dtdx = of_derivatives.dtdx.first(count),
                                        .dsdy = of_derivatives.dsdy.first(count),
                                        .dtdy = of_derivatives.dtdy.first(count),
                                        .level = spans.level.first(count),
                                        .anisotropy = spans.anisotropy.first(count),
                                        .major_s = {},
                                        .major_t = {}});
        if (!extremes || !written) {
            REQUIRE(!written);
            continue;
        }
        const ExactTriangle exact(triangle);
        bool promised = true;
        for (const int x : {rect.x, rect.x + rect.width - 1})
            for (const int y : {rect.y, rect.y + rect.height - 1})
                promised = promised && exact.has_positive_w(x, y) && exact.at(x, y).q.sign() > 0;
        if (!promised) continue;
        double least = infinity_double, largest = -infinity_double, neighbours = 0.0, thinnest = 0.0,
               area_least = infinity_double, area_largest = 0.0;
        for (std::size_t k = 0; k < count; ++k) {
            const double here = out.at(level, k);
            least = std::min(least, here);
            largest = std::max(largest, here);
            thinnest = std::max(thinnest, out.at(anisotropy, k));
            const double area = std::fabs(derivatives.at(dsdx, k) * derivatives.at(dtdy, k) -
                                          derivatives.at(dsdy, k) * derivatives.at(dtdx, k)) *
                                texels.s * texels.t;
            // What the subtraction of floats loses.
            const double lost = 4e-7 *
                                (std::fabs(derivatives.at(dsdx, k) * derivatives.at(dtdy, k)) +
                                 std::fabs(derivatives.at(dsdy, k) * derivatives.at(dtdx, k))) *
                                texels.s * texels.t;
            area_least = std::min(area_least, area + lost);
            area_largest = std::max(area_largest, area - lost);
            if (k % static_cast<std::size_t>(rect.width) != 0)
                neighbours = std::max(neighbours, std::fabs(here - out.at(level, k - 1)));
            if (k >= static_cast<std::size_t>(rect.width))
                neighbours =
                    std::max(neighbours, std::fabs(here - out.at(level, k - static_cast<std::size_t>(rect.width))));
        }
        const std::string context = text(texels) + " " + hex(Shot{triangle, rect}) + " levels " + hex(least) + " " +
                                    hex(largest) + " bounds " + hex(extremes->least_level) + " " +
                                    hex(extremes->largest_level);
        REQUIRE_MESSAGE(least >= extremes->least_level, context);
        REQUIRE_MESSAGE(largest <= extremes->largest_level, context);
        REQUIRE_MESSAGE(thinnest <= extremes->largest_anisotropy, context);
        REQUIRE_MESSAGE(area_least >= extremes->least_area, context);
        REQUIRE_MESSAGE(area_largest <= extremes->largest_area, context);
        fragments += count;
        ++rects;
        // 1 % of rho, and what may lie between two fragments.
        const double gap = std::max(least - extremes->least_level, extremes->largest_level - largest);
        if (neighbours < 0.02) {
            worst_gap = std::max(worst_gap, gap - neighbours);
            REQUIRE_MESSAGE(gap <= 0.0144 + neighbours, context);
            double corner_least = infinity_double, corner_largest = 0.0, corner_level = infinity_double;
            for (const int x : {rect.x, rect.x + rect.width - 1}) {
                for (const int y : {rect.y, rect.y + rect.height - 1}) {
                    const texgen::Footprint at = setup.at(x, y).value();
                    const double area = at.singular_values.x * at.singular_values.y;
                    corner_level = std::min(corner_level, at.level);
                    corner_least = std::min(corner_least, area);
                    corner_largest = std::max(corner_largest, area);
                }
            }
            REQUIRE_MESSAGE(extremes->largest_area <= 1.01 * corner_largest, context);
            REQUIRE_MESSAGE(extremes->least_area >= 0.99 * corner_least, context);
            REQUIRE_MESSAGE(extremes->largest_anisotropy <= thinnest * 1.01, context);
            wide += largest - least > 1.0;
            inner += least < corner_level - 0.01;
        }
    }
    MESSAGE(fragments, " fragments in ", rects, " rectangles; largest gap of a level ", worst_gap);
    CHECK(wide > 20);
    CHECK(inner > 12);  // the least level is at no corner
}

TEST_CASE("the extremes of a triangle hold for all fragments inside it, and are reached") {
    Random random(6600);
    int triangles = 0;
    for (int i = 0; i < 60; ++i) {
        const Triangle triangle = spread_triangle(random, random.power_of_ten(0.0, 2.0));
        const FragmentRect rect{-100, -100, 701, 701};
        const TexelsPerUnit texels = some_texels(random);
        const FootprintSetup setup(setup_of(triangle), texels);
        const auto extremes = setup.extremes();
        REQUIRE(extremes.has_value());
        double least = infinity_double, largest = -infinity_double, thinnest = 0.0;
        FootprintOutputs row({0, 0, rect.width, 1}, (1u << level) | (1u << anisotropy));
        for (int y = rect.y; y < rect.y + rect.height; ++y) {
            if (!footprint(setup, {rect.x, y, rect.width, 1}, row.spans())) continue;
            for (int x = rect.x; x < rect.x + rect.width; ++x) {
                if (!contains_centre(triangle, x, y)) continue;
                const auto k = static_cast<std::size_t>(x - rect.x);
                least = std::min(least, row.at(level, k));
                largest = std::max(largest, row.at(level, k));
                thinnest = std::max(thinnest, row.at(anisotropy, k));
            }
        }
        INFO(hex(triangle), " levels ", least, " ", largest, " bounds ", extremes->least_level, " ",
             extremes->largest_level);
        CHECK(least >= extremes->least_level);
        CHECK(largest <= extremes->largest_level);
        CHECK(thinnest <= extremes->largest_anisotropy);
        // The vertices may be most of a pixel from a centre inside: here the level may change by more than 1 %.
        const auto corner = support::vertices(triangle);
        for (const WindowVertex* vertex : corner) {
            const auto at = setup.at(static_cast<int>(std::floor(vertex->window.x)),
                                     static_cast<int>(std::floor(vertex->window.y)));
            if (at) least = std::min(least, at->level), largest = std::max(largest, at->level);
        }
        ++triangles;
        CHECK(least - extremes->least_level < 0.15);
        CHECK(extremes->largest_level - largest < 0.15);
    }
    CHECK(triangles == 60);
}

TEST_CASE("a level is inside the extremes where texels are beyond 2^500 pixels") {
    const texgen::Triangle triangle{
        {{0.0f, 0.0f}, 0x1p+8f, {0.0f, -0x1p+127f, 0x1p+127f, -0x1p+127f}},
        {{0x1p+127f, 0x1p-149f}, 0x1p+8f, {-0x1p-149f, 0x1p-149f, -0x1p-149f, 0x1p-149f}},
        {{-0x1p-149f, 0.0f}, 0x1.919p+6f, {0x1.9084p+6f, 0x1.919p+6f, 0x1.91ccp+6f, 0x1.919p+6f}}};
    const auto prepared = texgen::TriangleSetup::of(triangle, texgen::whole_texture());
    REQUIRE(prepared.has_value());
    const texgen::FootprintSetup setup(*prepared, {32.0, 4000.0});
    const auto one = setup.at(0, 0);
    const auto extremes = setup.extremes({0, 0, 1, 1});
    REQUIRE(one.has_value());
    REQUIRE(extremes.has_value());
    CHECK(one->level >= extremes->least_level);
    CHECK(one->level <= extremes->largest_level);
    CHECK(extremes->largest_level - extremes->least_level < 0.05);
}

TEST_CASE("next to q = 0 and behind it the extremes say so") {
    // q/w = (x - 100) / 100.
    const Triangle triangle = flat({glm::vec2(0, 0), glm::vec2(200, 0), glm::vec2(0, 200)},
                                   {glm::vec3(0.5f, 0, -1), glm::vec3(0.5f, 1, 1), glm::vec3(1, 0.5f, -1)});
    const FootprintSetup setup(setup_of(triangle), {256.0, 256.0});
    CHECK(!setup.extremes({0, 0, 90, 50}).has_value());
    CHECK(!setup.at(50, 10).has_value());
    const auto across = setup.extremes({50, 0, 100, 50});
    REQUIRE(across.has_value());
    CHECK(std::isinf(across->largest_level));
    CHECK(std::isinf(across->largest_area));
    const auto nearest = setup.at(100, 10);
    REQUIRE(nearest.has_value());
    const auto farthest = setup.at(149, 0);
    REQUIRE(farthest.has_value());
    CHECK(across->least_level <= farthest->level);
    CHECK(nearest->level > farthest->level + 8.0);
    CHECK(!setup.extremes({0, 0, 0, 5}).has_value());

    // Where q is 0 in the middle of a fragment, and only rounding could say that it is not, that one is behind.
    const Triangle root = flat({glm::vec2(0.5f, 0), glm::vec2(200.5f, 0), glm::vec2(0.5f, 200)},
                               {glm::vec3(0.5f, 0, -1), glm::vec3(0.25f, 0, 1), glm::vec3(0.5f, 0, -1)});
    const FootprintSetup at_root(setup_of(root), {256.0, 256.0});
    CHECK(!at_root.at(100, 2).has_value());
    CHECK(!at_root.extremes({100, 0, 1, 5}).has_value());
    const auto from_root = at_root.extremes({100, 0, 2, 5});
    REQUIRE(from_root.has_value());
    CHECK(from_root->least_level <= at_root.at(101, 2)->level);
    CHECK(std::isinf(from_root->largest_level));

    // q = 0 everywhere is behind.
    const Triangle dark = flat({glm::vec2(0, 0), glm::vec2(200, 0), glm::vec2(0, 200)}, {});
    CHECK(!FootprintSetup(setup_of(dark), {256.0, 256.0}).extremes({0, 0, 9, 5}).has_value());
    CHECK(!FootprintSetup(setup_of(dark), {256.0, 256.0}).extremes().has_value());
}

TEST_CASE("there are extremes exactly where a fragment is in front, and of a triangle where a corner is") {
    Random random(4711);
    int on_the_plane = 0, behind = 0, in_front = 0;
    for (int i = 0; i < 20000; ++i) {
        Triangle triangle{};
        const auto whole = [&](int least, int largest) { return static_cast<float>(random.integer(least, largest)); };
        for (WindowVertex* vertex : support::vertices(triangle)) {
            const float w = std::ldexp(1.0f, random.integer(-1, 2));
            *vertex = {
                {whole(-16, 16) * 0.5f, whole(-16, 16) * 0.5f}, w, {whole(-4, 4), whole(-4, 4), 0, whole(-2, 1)}};
        }
        const auto of = TriangleSetup::of(triangle, support::everywhere());
        if (!of) continue;
        const FootprintSetup setup(*of, some_texels(random));
        const ExactTriangle exact(triangle);
        const FragmentRect rect{random.integer(-9, 9), random.integer(-9, 9), random.integer(1, 4),
                                random.integer(1, 4)};
        bool is_any_in_front = false, is_any_on_the_plane = false;
        for (int y = rect.y; y < rect.y + rect.height; ++y) {
            for (int x = rect.x; x < rect.x + rect.width; ++x) {
                const int side = exact.at(x, y).q.sign();
                is_any_in_front = is_any_in_front || side > 0;
                is_any_on_the_plane = is_any_on_the_plane || side == 0;
            }
        }
        INFO(hex(triangle), " rect ", rect.x, " ", rect.y, " ", rect.width, " x ", rect.height);
        REQUIRE(setup.extremes(rect).has_value() == is_any_in_front);
        const auto& [a, b, c] = triangle;
        REQUIRE(setup.extremes().has_value() == (a.strq.w > 0 || b.strq.w > 0 || c.strq.w > 0));
        on_the_plane += is_any_on_the_plane && !is_any_in_front;
        behind += !is_any_on_the_plane && !is_any_in_front;
        in_front += is_any_in_front;
    }
    CHECK(std::min({on_the_plane, behind, in_front}) > 200);
}

}  // namespace footprint_cases
