// Triangles in the exact tier: every fragment is the nearest float of the exact rational, wherever and however it is
// asked for.

#include "texgen/interpolate.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "api/interpolate_test/rows.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/oracle.hpp"
#include "support/hard_triangles.hpp"
#include "support/hex.hpp"
#include "support/near_cut.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/special_values.hpp"
#include "support/triangles.hpp"
#include "texgen/reference.hpp"

namespace row_cases {

using support::HardFamily;

TEST_CASE("every fragment is the nearest float of the exact rational, in every family") {
    std::uint64_t seed = 100;
    Seen everything;
    for (const HardFamily& family : support::hard_families) {
        CAPTURE(std::string(family.name));
        Random random(++seed);
        constexpr int members = 200;
        int hard = 0;
        Seen seen;
        for (int i = 0; i < members; ++i) {
            const Shot shot = family.make(random);
            hard += family.is_hard(shot, ExactTriangle(shot.triangle));
            Outputs out(count_of(shot.rect), Outputs::all, static_cast<std::size_t>(random.integer(0, 15)));
            const texgen::TextureRegion region = random.coin()
                                                     ? support::region_at(shot, ExactTriangle(shot.triangle), random)
                                                     : texgen::whole_texture();
            require_right(shot, random.integer(0, 2) == 0 ? region : everywhere(), out, seen);
        }
        CHECK(hard >= family.least_share * members);
        CHECK(seen.in_front > 500);
        everything += seen;
    }
    CHECK(everything.behind > 1000);
    CHECK(everything.on_plane > 50);
    CHECK(everything.subnormal > 500);
    CHECK(everything.infinite > 500);
    CHECK(everything.lit > 10000);
    CHECK(everything.dark > 10000);
}

TEST_CASE(
    "what the near plane cuts is the nearest float in every order of the corners, and with a tolerance inside of it") {
    Random random(4711);
    Seen seen;
    int far_first = 0;
    for (int i = 0; i < 300; ++i) {
        const auto [triangle, rect] = support::near_cut(random, random.integer(1, 70), random.integer(1, 3));
        for (int order = 0; order < 3; ++order) {
            const Shot shot{support::rotated(triangle, order), rect};
            far_first += std::fabs(shot.triangle.a.window.x) > 1e4f;
            for (const texgen::Tolerance tolerance : {texgen::exact, texgen::texels(1.0 / 512.0, 4096.0)}) {
                Outputs out(count_of(rect));
                const Work work = interpolate(setup_of(shot.triangle, everywhere(), tolerance), rect, out.spans());
                const std::string wrong =
                    first_wrong(shot, ExactTriangle(shot.triangle), everywhere(), tolerance, work, out, seen);
                REQUIRE_MESSAGE(wrong.empty(), wrong, " in ", hex(shot));
                REQUIRE_MESSAGE(out.pads_are_intact(), hex(shot));
            }
        }
    }
    CHECK(far_first > 100);
    CHECK(seen.behind > 500);
    CHECK(seen.in_front > 10000);
}

TEST_CASE("the order of the vertices and the winding do not change a bit") {
    std::uint64_t seed = 500;
    for (const HardFamily& family : support::hard_families) {
        Random random(++seed);
        for (int i = 0; i < 20; ++i) {
            const Shot shot = family.make(random);
            const auto& [a, b, c] = shot.triangle;
            Outputs first(count_of(shot.rect));
            const Work work = interpolate(setup_of(shot.triangle), shot.rect, first.spans());
            for (const Triangle& other :
                 {Triangle{b, c, a}, Triangle{c, a, b}, Triangle{a, c, b}, Triangle{c, b, a}, Triangle{b, a, c}}) {
                Outputs out(count_of(shot.rect));
                const Work other_work = interpolate(setup_of(other), shot.rect, out.spans());
                if (work == Work::nothing || other_work == Work::nothing) continue;  // another rounding may not see it
                for (std::size_t k = 0; k < 4; ++k)
                    REQUIRE_MESSAGE(same_bits(out[k], first[k]), family.name, ": ", hex(shot));
            }
        }
    }
}

TEST_CASE("no setup comes of a number that is not finite, of a w that is not positive, or of no area") {
    Random random(700);
    const float bad_numbers[] = {support::infinity_float, -support::infinity_float, support::nan_float,
                                 std::bit_cast<float>(0xff812345u), std::bit_cast<float>(0x7f800001u)};
    for (int i = 0; i < 50; ++i) {
        const Triangle good = make_triangle(support::families[static_cast<std::size_t>(i) % 8], random);
        REQUIRE(TriangleSetup::of(good, everywhere()).has_value());
        for (std::size_t vertex = 0; vertex < 3; ++vertex) {
            for (std::size_t field = 0; field < 7; ++field) {
                for (const float number : bad_numbers) {
                    Triangle bad = good;
                    WindowVertex& v = *vertices(bad)[vertex];
                    (field < 2    ? v.window[static_cast<int>(field)]
                     : field == 2 ? v.clip_w
                                  : v.strq[static_cast<int>(field) - 3]) = number;
                    REQUIRE_MESSAGE(!TriangleSetup::of(bad, everywhere()), hex(bad));
                }
            }
            for (const float w :
                 {0.0f, -0.0f, -1.0f, -std::numeric_limits<float>::denorm_min(), -std::numeric_limits<float>::max()}) {
                Triangle bad = good;
                vertices(bad)[vertex]->clip_w = w;
                REQUIRE_MESSAGE(!TriangleSetup::of(bad, everywhere()), hex(bad));
            }
        }
    }
}

TEST_CASE("collinear vertices have no setup at any magnitude; one unit beside the line they have one") {
    Random random(800);
    int nudged_apart = 0, least_exponent = 0;
    for (int i = 0; i < 4000; ++i) {
        // Integers of 11 bits, so that p + k d is a float; scaled by powers of two.
        const int exponent_x = random.integer(-140, 100), exponent_y = random.integer(-140, 100);
        const auto point = [&](int k, const glm::ivec2& p, const glm::ivec2& d) {
            return glm::vec2(std::ldexp(static_cast<float>(p.x + k * d.x), exponent_x),
                             std::ldexp(static_cast<float>(p.y + k * d.y), exponent_y));
        };
        const glm::ivec2 p{random.integer(-2000, 2000), random.integer(-2000, 2000)};
        const glm::ivec2 d{random.integer(-2000, 2000), random.integer(-2000, 2000)};
        Triangle triangle = make_triangle(support::Family::friendly, random);
        triangle.a.window = point(random.integer(-99, 99), p, d);
        triangle.b.window = point(random.integer(-99, 99), p, d);
        triangle.c.window = point(random.integer(-99, 99), p, d);
        REQUIRE_MESSAGE(!TriangleSetup::of(triangle, everywhere()), hex(triangle));
        if (d.x == 0 || triangle.a.window == triangle.b.window) continue;
        triangle.c.window.y = support::neighbour(triangle.c.window.y, random.coin() ? 1 : -1);
        REQUIRE_MESSAGE(TriangleSetup::of(triangle, everywhere()).has_value(), hex(triangle));
        ++nudged_apart;
        least_exponent = std::min(least_exponent, std::ilogb(std::fabs(support::twice_area(triangle))));
    }
    CHECK(nudged_apart > 3000);
    CHECK(least_exponent < -250);
}

TEST_CASE("a sliver of area 2^-140 has a setup, and its fragments are the nearest floats") {
    Random random(900);
    Seen seen;
    for (int i = 0; i < 400; ++i) {
        Triangle triangle = make_triangle(support::Family::friendly, random);
        // (0, 0) lies on the long edge; the third vertex is 2^-k away from it.
        const int along = random.integer(0, 8);
        const float length = std::ldexp(1.0f, along);
        const float height = std::ldexp(1.0f, -140 - along) * (random.coin() ? 1.0f : -1.0f);
        const bool upright = random.coin();
        const auto at = [&](float x, float y) { return upright ? glm::vec2(x, y) : glm::vec2(y, x); };
        triangle.a.window = at(-length, 0.0f);
        triangle.b.window = at(length, 0.0f);
        triangle.c.window = at(random.uniform_float(-1.0, 1.0) * length, height);
        for (WindowVertex* vertex : vertices(triangle))
            if (i % 2 == 0) vertex->clip_w = 1.0f;
        const Shot shot{triangle, support::detail::rect_about(0, 0, random)};
        Outputs out(count_of(shot.rect));
        require_right(shot, everywhere(), out, seen);
    }
    CHECK(seen.in_front > 5000);
}

TEST_CASE("triangles of random bits are refused, or interpolated to the nearest floats") {
    Random random(1000);
    Seen seen;
    int accepted = 0;
    for (int i = 0; i < 40000; ++i) {
        Triangle triangle{};
        const bool mostly_usable = random.coin();
        for (WindowVertex* vertex : vertices(triangle)) {
            const auto any = [&] { return mostly_usable ? random.any_finite() : random.any_float(); };
            for (int k = 0; k < 2; ++k) vertex->window[k] = any();
            for (int k = 0; k < 4; ++k) vertex->strq[k] = any();
            vertex->clip_w = mostly_usable ? std::fabs(any()) : any();
        }
        const texgen::TextureRegion region =
            texgen::atlas_tile({random.any_float(), random.any_float()}, {random.any_float(), random.any_float()});
        const std::optional<TriangleSetup> setup = TriangleSetup::of(triangle, region);
        if (!setup) continue;
        ++accepted;
        const Shot shot{triangle, support::detail::rect_about(
                                      random.coin() ? 0 : static_cast<int>(random.uniform(-2147483000.0, 2147483000.0)),
                                      random.integer(-2000, 2000), random)};
        if (accepted % 8 == 0) {
            Outputs out(count_of(shot.rect));
            require_right(shot, random.coin() ? region : everywhere(), out, seen);
        } else {
            const glm::dvec2 bound = setup->error_bound({shot.rect.x, shot.rect.y, 1, 1});
            REQUIRE(bound.x >= 0.0);
            REQUIRE(bound.y >= 0.0);
        }
    }
    CHECK(accepted > 10000);
    CHECK(seen.in_front > 10000);
}

TEST_CASE("coordinates that are 0, of either sign, come out as +0") {
    Random random(1100);
    for (int i = 0; i < 100; ++i) {
        Shot shot =
            support::detail::ordinary(random.coin() ? support::Family::friendly : support::Family::crossing, random);
        for (WindowVertex* vertex : vertices(shot.triangle)) {
            vertex->strq.x = random.coin() ? 0.0f : -0.0f;
            vertex->strq.z = -0.0f;
        }
        Outputs out(count_of(shot.rect));
        if (interpolate(setup_of(shot.triangle), shot.rect, out.spans()) == Work::nothing) continue;
        for (const float s : out.s()) REQUIRE_MESSAGE(same_bits(s, 0.0f), hex(shot));
        for (const float r : out.r()) REQUIRE_MESSAGE(same_bits(r, 0.0f), hex(shot));
    }
}

TEST_CASE("the reference in double agrees within the accuracy that it states") {
    std::uint64_t seed = 1200;
    int compared = 0, different = 0;
    for (const support::Family family : support::families) {
        Random random(++seed);
        for (int i = 0; i < 60; ++i) {
            Shot shot = support::detail::ordinary(family, random);
            Outputs fast(count_of(shot.rect)), reference(count_of(shot.rect));
            if (interpolate(setup_of(shot.triangle), shot.rect, fast.spans()) == Work::nothing) continue;
            texgen::reference::interpolate(shot.triangle, everywhere(), shot.rect, reference.spans());
            // interpolation_error's formula, its terms exactly.
            Triangle absolute = shot.triangle;
            const ExactTriangle exact(shot.triangle);
            for (std::size_t j = 0; j < fast.size(); ++j) {
                const auto [x, y] = shot.fragment(j);
                if (!exact.has_positive_w(x, y)) continue;
                const std::array corners{absolute.a, absolute.b, absolute.c};
                double size[4] = {};
                for (std::size_t v = 0; v < 3; ++v) {
                    const glm::dvec2 p(corners[(v + 1) % 3].window), q(corners[(v + 2) % 3].window);
                    const glm::dvec2 centre(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
                    const double edge = (p.x - centre.x) * (q.y - centre.y) - (p.y - centre.y) * (q.x - centre.x);
                    const double weight = std::fabs(edge) * static_cast<double>(corners[(v + 1) % 3].clip_w) *
                                          static_cast<double>(corners[(v + 2) % 3].clip_w);
                    for (int k = 0; k < 4; ++k)
                        size[k] += 1.001 * weight * std::fabs(static_cast<double>(corners[v].strq[k]));
                }
                const support::Homogeneous at = exact.at(x, y);
                const double q = at.q.estimate();
                const double error = texgen::reference::interpolation_error;
                if (!(std::fabs(q) > error * size[3])) continue;
                ++compared;
                const bool in_front = q > 0.0;
                REQUIRE_MESSAGE((fast.lit()[j] == reference.lit()[j]), hex(shot));
                for (std::size_t k = 0; k < 3; ++k) {
                    const double a = static_cast<double>(fast[k][j]), b = static_cast<double>(reference[k][j]);
                    different += a != b;
                    const double allowed =
                        error * (size[k] + std::fabs(a) * size[3]) / (std::fabs(q) - error * size[3]);
                    const double ulp = std::nextafter(std::fabs(fast[k][j]), HUGE_VALF) - std::fabs(fast[k][j]);
                    REQUIRE_MESSAGE((in_front ? std::fabs(a - b) <= 1.001 * allowed + ulp : a == b), hex(shot));
                    if (allowed < 0.001 * ulp) REQUIRE(std::fabs(a - b) <= ulp);
                }
            }
        }
    }
    CHECK(compared > 20000);
    CHECK(different < compared / 100);
}

}  // namespace row_cases
