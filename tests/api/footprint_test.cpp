// Footprints: derivatives judged exactly and by 400-bit differences, what filters make of them, and their extremes.

#include "texgen/footprint.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "api/footprint_test/derivatives.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/real.hpp"
#include "support/footprint_outputs.hpp"
#include "support/hard_triangles.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/special_values.hpp"
#include "support/triangles.hpp"
#include "texgen/batch.hpp"
#include "texgen/interpolate.hpp"

namespace footprint_cases {

TEST_CASE("derivatives are the exact ones within the stated bound, for every hard family") {
    bool is_in_buffer = false;
    SUBCASE("by a set-up") {}
    SUBCASE("in a visibility buffer") { is_in_buffer = true; }
    std::uint64_t seed = 6000;
    int checked = 0, behind = 0, unbounded = 0, next_to_zero = 0;
    double worst = 0.0;
    for (const support::HardFamily& family : support::hard_families) {
        Random random(++seed);
        int hard = 0, away = 0;
        double worst_away = 0.0;
        constexpr int shots = 60;
        for (int i = 0; i < shots; ++i) {
            const Shot shot = family.make(random);
            const ExactTriangle exact(shot.triangle);
            hard += family.is_hard(shot, exact);
            const TexelsPerUnit texels = some_texels(random);
            const FootprintSetup setup(setup_of(shot.triangle), texels);
            const glm::dvec2 bound = setup.error_bound(shot.rect);
            FootprintOutputs out(shot.rect, FootprintOutputs::all, static_cast<std::size_t>(random.integer(0, 15)));
            std::vector<std::uint32_t> ids;
            bool written = true;
            if (is_in_buffer)
                ids = fill_among_others(shot, texels, random, out);
            else
                written = footprint(setup, shot.rect, out.spans());
            REQUIRE(out.pads_are_intact());
            if (!written) REQUIRE(out.is_untouched());
            const std::size_t step = count_of(shot.rect) / 6 + 1;
            for (std::size_t k = static_cast<std::size_t>(random.integer(0, 2)); k < count_of(shot.rect); k += step) {
                const auto [x, y] = shot.fragment(k);
                if (!exact.has_positive_w(x, y) || (is_in_buffer && ids[k] != 0)) continue;
                const std::string context = std::string(family.name) + " " + text(texels) + ", fragment " +
                                            std::to_string(x) + " " + std::to_string(y) + " of " + hex(shot);
                if (exact.at(x, y).q.sign() <= 0) {
                    ++behind;
                    for (std::size_t o = 0; o < 8 && written; ++o) REQUIRE_MESSAGE(same_bits(out[o][k], 0.0f), context);
                    continue;
                }
                REQUIRE_MESSAGE(written, context);
                ++checked;
                const ExactFootprint truth(exact, x, y);
                const double zero =
                    distance_from_zero(shot.triangle, static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
                for (std::size_t c = 0; c < 2; ++c) {
                    const double error = std::max(distance(out.at(dsdx + c, k), truth.dx[c]),
                                                  distance(out.at(dsdy + c, k), truth.dy[c]));
                    if (std::isnan(error) || std::isinf(error)) continue;  // beyond the range of float
                    const auto norm = static_cast<double>(truth.norm(c));
                    const double allowed =
                        bound[static_cast<int>(c)] + (is_in_buffer ? texgen::batch_footprint_error * norm : 0.0);
                    REQUIRE_MESSAGE(error <= allowed, context << " error " << error << " allowed " << allowed);
                    unbounded += std::isinf(allowed);
                    if (!std::isinf(allowed)) worst = std::max(worst, error / allowed);
                    // Next to q = 0 there is no bound from doubles, but exact sums.
                    if (std::isinf(allowed) && family.name[0] == 'q' && norm < 1e30) {
                        ++next_to_zero;
                        REQUIRE_MESSAGE(error <= 1e-5 * norm, context);
                    }
                    if (zero > 1e-4 && norm > 1e-30) {
                        ++away;
                        worst_away = std::max(worst_away, error / norm);
                    }
                }
            }
        }
        INFO(family.name);
        CHECK(hard >= family.least_share * shots * 0.6);
        if (family.least_share == 1.0) CHECK(away > (is_in_buffer ? 60 : 100));
        CHECK(worst_away <= 1e-5);
        MESSAGE(std::string(family.name), ": away from q = 0 the largest relative error is ", worst_away, " in ", away);
    }
    MESSAGE(checked, " fragments, ", behind, " behind, ", unbounded, " without a bound; worst error ", worst,
            " of its bound");
    CHECK(checked > (is_in_buffer ? 2000 : 3000));
    CHECK(behind > (is_in_buffer ? 150 : 200));
    CHECK(worst > 0.5);
    CHECK(unbounded < checked / 3);
    CHECK(next_to_zero > (is_in_buffer ? 150 : 200));
}

TEST_CASE("derivatives agree with 400-bit differences of the definition to 1e-5") {
    Random random(6100);
    double worst = 0.0;
    int checked = 0, mirrored = 0, orthographic = 0, steep = 0, tiny = 0, far = 0;
    for (int i = 0; i < 1500; ++i) {
        const auto family = support::families[static_cast<std::size_t>(i) % support::families.size()];
        Triangle triangle = support::make_triangle(family, random);
        if (i % 5 == 1)  // far from the origin of the window
            for (WindowVertex* vertex : support::vertices(triangle)) vertex->window += glm::vec2(16384.0f, -30000.0f);
        if (i % 5 == 2)  // some pixels large
            for (WindowVertex* vertex : support::vertices(triangle)) vertex->window *= 1.0f / 256.0f;
        const FragmentRect pixel = support::pixel_near(triangle, random);
        const double x = pixel.x + 0.5, y = pixel.y + 0.5;
        if (distance_from_zero(triangle, x, y) < 1e-4) continue;
        const FootprintSetup setup(setup_of(triangle), {256.0, 256.0});
        const auto footprint = setup.at(pixel.x, pixel.y);
        const auto corner = support::vertices(triangle);
        // s/q and t/q from the definition: barycentric coordinates over w.
        const auto quotient = [&](const Real& px, const Real& py, int coordinate) {
            Real numerator = 0, denominator = 0;
            for (std::size_t v = 0; v < 3; ++v) {
                const WindowVertex &j = *corner[(v + 1) % 3], &k = *corner[(v + 2) % 3];
                const Real weight = ((Real(j.window.x) - px) * (Real(k.window.y) - py) -
                                     (Real(j.window.y) - py) * (Real(k.window.x) - px)) /
                                    Real(corner[v]->clip_w);
                numerator += weight * Real(corner[v]->strq[coordinate]);
                denominator += weight * Real(corner[v]->strq.w);
            }
            return Real(numerator / denominator);
        };
        if (!footprint) continue;
        const bool well_away = distance_from_zero(triangle, x, y) > 0.1 && family != support::Family::sliver;
        const Real h = ldexp(Real(1), -90);
        for (int c = 0; c < 2; ++c) {
            const Real dx = (quotient(Real(x) + h, y, c) - quotient(Real(x) - h, y, c)) / (2 * h);
            const Real dy = (quotient(x, Real(y) + h, c) - quotient(x, Real(y) - h, c)) / (2 * h);
            const auto norm = static_cast<double>(sqrt(Real(dx * dx + dy * dy)));
            const double error = std::max(distance(footprint->dx[c], dx), distance(footprint->dy[c], dy)) / norm;
            worst = std::max(worst, error);
            REQUIRE_MESSAGE(error <= (well_away ? 1e-11 : 1e-5), hex(triangle)
                                                                     << " fragment " << pixel.x << " " << pixel.y);
        }
        ++checked;
        mirrored += support::twice_area(triangle) < 0.0;
        orthographic += family == support::Family::parallel;
        steep += support::detail::spread(triangle, [](const WindowVertex& v) { return v.strq.w; }) > 100.0;
        tiny += std::fabs(support::twice_area(triangle)) < 16.0;
        far += triangle.a.window.x > 10000.0f;
    }
    MESSAGE(checked, " fragments, worst relative error ", worst);
    CHECK(checked > 900);
    for (const int count : {mirrored, orthographic, steep, tiny, far}) CHECK(count > 80);
}

TEST_CASE("where the derivatives of a row nearly vanish at one fragment, it is as right as the others") {
    // S = x - 200.5 and Q = y - (100.5 - 2^-20): along the row Q does not vary, and both columns vanish with the
    // distance from a point 2^-20 of a pixel from the centre of fragment (200, 100).
    Triangle triangle{};
    const std::array window{glm::vec2(0, 100), glm::vec2(400, 100), glm::vec2(200, 101)};
    const auto corner = support::vertices(triangle);
    for (std::size_t i = 0; i < 3; ++i) {
        const float s = window[i].x - 200.5f;
        *corner[i] = {window[i], 1.0f, {s, 0.75f * s, 0.0f, (window[i].y - 100.5f) + 0x1p-20f}};
    }
    const Shot shot{triangle, {150, 100, 100, 1}};
    const TexelsPerUnit texels{256.0, 128.0};
    const ExactTriangle exact(triangle);
    for (const Tolerance tolerance : {texgen::exact, Tolerance{1e-3}}) {
        const FootprintSetup setup(setup_of(triangle, support::everywhere(), tolerance), texels);
        FootprintOutputs out(shot.rect);
        REQUIRE(footprint(setup, shot.rect, out.spans()));
        for (std::size_t k = 0; k < 100; ++k) {
            const ExactFootprint truth(exact, 150 + static_cast<std::int64_t>(k), 100);
            const ExactFootprint::Shape shape = truth.shape(texels);
            INFO("fragment ", k);
            REQUIRE(std::fabs(out.at(level, k) - std::log2(static_cast<double>(shape.rho))) <= 0x1p-16 * 2.0);
            const double length = std::hypot(out.at(major_s, k) * texels.s, out.at(major_t, k) * texels.t);
            REQUIRE(std::fabs(length / static_cast<double>(shape.largest) - 1.0) <= 0x1p-16);
            REQUIRE(out.at(anisotropy, k) == support::infinity_double);
        }
    }
}

TEST_CASE("a fragment where q is 0, of terms with more bits than two doubles and residues have, has no footprint") {
    Random random(5350);
    for (int i = 0; i < 300; ++i) {
        // It is a fourth of the way between two corners, where 3 c and -c cancel for q = c w; the third has bits for
        // nothing.
        const int x = random.integer(-100, 100), y = random.integer(-100, 100);
        const auto of_20_bits = [&](double size) {
            return std::ldexp(static_cast<float>(random.integer(1 << 19, 1 << 20)), std::ilogb(size) - 19);
        };
        const float dx = of_20_bits(60.0), dy = random.coin() ? of_20_bits(60.0) : -of_20_bits(60.0);
        const auto corner = [&](float at_x, float at_y, float over_w) {
            const float clip_w = of_20_bits(1.0);
            const glm::vec4 strq(random.uniform_float(0.0, 1.0), random.uniform_float(0.0, 1.0), 0.5f, over_w * clip_w);
            return WindowVertex{{at_x, at_y}, clip_w, strq};
        };
        const float middle_x = static_cast<float>(x) + 0.5f, middle_y = static_cast<float>(y) + 0.5f;
        const float tiny = std::ldexp(random.uniform_float(-1.0, 1.0), random.integer(-100, -60));
        const Shot shot{
            {corner(middle_x + 3.0f * dx, middle_y + 3.0f * dy, 3.0f), corner(middle_x - dx, middle_y - dy, -1.0f),
             corner(tiny, random.uniform_float(500.0, 900.0), 1.0f)},
            {x, y, 1, 1}};
        REQUIRE(ExactTriangle(shot.triangle).at(x, y).q.sign() == 0);
        CHECK_MESSAGE(!FootprintSetup(setup_of(shot.triangle), {1024.0, 1024.0}).at(x, y).has_value(), hex(shot));
    }
}

TEST_CASE("only what is asked for is written, the same whatever else is asked for, in any rectangle and alignment") {
    Random random(6400);
    for (int i = 0; i < 300; ++i) {
        const Shot shot = support::detail::ordinary(
            support::families[static_cast<std::size_t>(i) % support::families.size()], random);
        const FootprintSetup setup(setup_of(shot.triangle), some_texels(random));
        FootprintOutputs all(shot.rect);
        const bool written = footprint(setup, shot.rect, all.spans());
        const auto asked = static_cast<unsigned>(random.integer(0, 255));
        FootprintOutputs some(shot.rect, asked, static_cast<std::size_t>(random.integer(0, 15)));
        REQUIRE(footprint(setup, shot.rect, some.spans()) == written);
        REQUIRE(some.pads_are_intact());
        for (std::size_t k = 0; k < 8; ++k)
            if (((asked >> k) & 1u) != 0u)
                for (std::size_t f = 0; f < count_of(shot.rect); ++f)
                    REQUIRE_MESSAGE(
                        (same_bits(some[k][f], all[k][f]) ||
                         (k >= 4 && std::fabs(some.at(k, f) - all.at(k, f)) <= 1e-5 * std::fabs(all.at(k, f)))),
                        hex(shot));
    }
}

TEST_CASE("where a first cache does not hold a rectangle its derivatives do not depend on the alignment") {
    Random random(6403);
    for (int i = 0; i < 40; ++i) {
        Shot shot = support::detail::ordinary(support::Family::friendly, random);
        shot.rect.width = random.integer(48, 300);
        shot.rect.height = 2048 / shot.rect.width + random.integer(1, 4);
        const FootprintSetup setup(setup_of(shot.triangle, texgen::whole_texture(), Tolerance{1e-4}),
                                   some_texels(random));
        FootprintOutputs all(shot.rect, 15u);
        if (!footprint(setup, shot.rect, all.spans())) continue;
        for (std::size_t misalignment = 0; misalignment < 16; ++misalignment) {
            const unsigned asked = misalignment % 4 == 0 ? 15u : static_cast<unsigned>(random.integer(1, 15));
            FootprintOutputs some(shot.rect, asked, misalignment);
            footprint(setup, shot.rect, some.spans());
            REQUIRE_MESSAGE(some.pads_are_intact(), misalignment, " of ", hex(shot));
            for (std::size_t k = 0; k < 4; ++k)
                for (std::size_t f = 0; (asked >> k & 1u) != 0 && f < count_of(shot.rect); ++f)
                    REQUIRE_MESSAGE(same_bits(some[k][f], all[k][f]), misalignment, " of ", hex(shot));
        }
    }
}

TEST_CASE("of a rectangle of any size nothing is done where nothing is asked, but to say whether it may be lit") {
    constexpr int most = std::numeric_limits<int>::max();
    Random random(96);
    for (int i = 0; i < 300; ++i) {
        const Shot shot =
            support::hard_families[static_cast<std::size_t>(i) % support::hard_families.size()].make(random);
        const texgen::TriangleSetup triangle = setup_of(shot.triangle);
        const texgen::FootprintSetup setup(triangle, {256.0, 256.0});
        for (const FragmentRect& rect : {shot.rect, FragmentRect{0, 0, most, most}, {-most, -most, most, most}})
            REQUIRE_MESSAGE(footprint(setup, rect, {}) == (triangle.work(rect) != texgen::Work::nothing), hex(shot));
    }
}

TEST_CASE("the footprints of a column are those that it has in a wider rectangle") {
    Random random(6401);
    for (int i = 0; i < 200; ++i) {
        Shot shot = support::detail::ordinary(support::families[static_cast<std::size_t>(i) % support::families.size()],
                                              random);
        shot.rect.width = 3;
        shot.rect.height = random.integer(2, 90);
        const FootprintSetup setup(setup_of(shot.triangle), some_texels(random));
        FootprintOutputs wide(shot.rect);
        if (!footprint(setup, shot.rect, wide.spans())) continue;
        for (int x = 0; x < 3; ++x) {
            const FragmentRect column{shot.rect.x + x, shot.rect.y, 1, shot.rect.height};
            FootprintOutputs of_column(column);
            if (!footprint(setup, column, of_column.spans())) continue;
            REQUIRE(of_column.pads_are_intact());
            for (std::size_t y = 0; y < count_of(column); ++y) {
                const std::size_t f = 3 * y + static_cast<std::size_t>(x);
                const double length = std::hypot(wide.at(6, f), wide.at(7, f));
                for (std::size_t k = 0; k < 8; ++k) {
                    if (k >= 6 && !(wide.at(5, f) > 2.0)) continue;  // the axis of a circle may be any
                    const double value = wide.at(k, f), difference = std::fabs(of_column.at(k, y) - value);
                    const double size = k == 4 ? std::fmax(1.0, std::fabs(value)) : k == 5 ? value : length;
                    REQUIRE_MESSAGE(
                        (same_bits(of_column[k][y], wide[k][f]) || (k >= 4 && difference <= 0x1p-15 * size)), k, " at ",
                        y, " of ", hex(Shot{shot.triangle, column}));
                }
            }
        }
    }
}

}  // namespace footprint_cases
