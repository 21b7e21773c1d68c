// Triangles and their footprints, with subnormal numbers taken as 0.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/verdict.hpp"
#include "promises/float_state_test/inputs.hpp"
#include "support/float_state.hpp"
#include "support/hard_triangles.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/triangles.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"

namespace float_state {

TEST_CASE("fragments of triangles: the sign of q is exact, and errors are within half an ulp or the tolerance") {
    in_every_state([](const FloatState& state, Random& random) {
        Seen seen;
        for (const support::HardFamily& family : support::hard_families) {
            CAPTURE(std::string(family.name));
            for (int i = 0; i < 40; ++i) {
                support::Shot shot = family.make(random);
                const Tolerance tolerance = any_tolerance(random);
                const TextureRegion region = any_region(random);
                std::optional<TriangleSetup> setup;
                Outputs out(support::count_of(shot.rect));
                Work work = Work::nothing;
                under(state, [&] {
                    setup = TriangleSetup::of(shot.triangle, region, tolerance);
                    if (setup) work = interpolate(*setup, shot.rect, out.spans());
                });
                shot.triangle = as_read(shot.triangle, state);
                REQUIRE((setup.has_value() || state.flushes));
                if (!setup) continue;
                const support::ExactTriangle exact(shot.triangle);
                for (std::size_t k = 0; k < out.size(); ++k) {
                    const auto [x, y] = shot.fragment(k);
                    if (!exact.has_positive_w(x, y)) continue;
                    const Homogeneous at = exact.at(x, y);
                    std::string wrong;
                    if (work == Work::nothing) {
                        bool is_lit = at.q.sign() > 0;
                        for (std::size_t c = 0; c < 3 && is_lit; ++c) {
                            const glm::dvec2 limits = support::limits_of(region, c);
                            is_lit = support::is_inside_for_sure(at.over_q(c), limits.x, limits.y, 0.0);
                        }
                        if (is_lit) wrong = "lit, and nothing was done";
                    } else {
                        wrong = what_is_wrong(at, region, tolerance, state, out, k, seen);
                        if (work == Work::divide && out.lit()[k] != 1.0f) wrong = "dark, and no test was needed";
                    }
                    REQUIRE_MESSAGE(wrong.empty(), wrong, " for ", hex(shot), ", tolerance ", hex(tolerance.value));
                }
            }
        }
        check_seen(seen);
    });
}

TEST_CASE("steps to the next row that are below the normal floats lose no more than the tolerance") {
    in_every_state([](const FloatState& state, Random&) {
        const auto vertex = [](float x, float y) {
            return texgen::WindowVertex{{x, y}, 1.0f, {0x1.fp-126f * (y - 256.5f), 0.0f, 0.0f, 0x1.1p-20f}};
        };
        const texgen::Triangle triangle{vertex(0.5f, 0.5f), vertex(8.5f, 0.5f), vertex(0.5f, 512.5f)};
        const support::ExactTriangle exact(triangle);
        for (const double tolerance : {0x1p-98, 0x1p-97, 0x1p-96, 0x1p-95}) {
            Outputs out(8 * 512);
            under(state, [&] {
                const auto setup = TriangleSetup::of(triangle, support::everywhere(), Tolerance{tolerance});
                interpolate(*setup, {0, 0, 8, 512}, out.spans());
            });
            for (std::size_t i = 0; i < out.size(); i += 29) {
                const Quotient u =
                    exact.at(static_cast<std::int64_t>(i % 8), static_cast<std::int64_t>(i / 8)).over_q(0);
                CHECK(support::distance(out.s()[i], u) <= tolerance);
            }
        }
    });
}

TEST_CASE("footprints are those of the default state where they are not subnormal") {
    in_every_state([](const FloatState& state, Random& random) {
        int compared = 0;
        for (int i = 0; i < 200; ++i) {
            const texgen::Triangle triangle =
                make_triangle(random.coin() ? support::Family::friendly : support::Family::crossing, random);
            const texgen::FragmentRect pixel = pixel_near(triangle, random);
            const texgen::FragmentRect rect{pixel.x - 8, pixel.y, 17, 1};
            const Tolerance tolerance = random.coin() ? texgen::exact : Tolerance{1e-4};
            using Array = std::array<float, 17>;
            const auto run = [&](Array& dsdx, Array& dtdy, Array& level) {
                const auto setup = TriangleSetup::of(triangle, support::everywhere(), tolerance);
                const texgen::FootprintSetup footprints(
                    *setup, texgen::texels_per_unit(texgen::whole_texture(), 4096.0, 4096.0));
                footprint(footprints, rect,
                          {.dsdx = dsdx,
                           .dtdx = {},
                           .dsdy = {},
                           .dtdy = dtdy,
                           .level = level,
                           .anisotropy = {},
                           .major_s = {},
                           .major_t = {}});
            };
            Array expected[3]{}, here[3]{};
            run(expected[0], expected[1], expected[2]);
            under(state, [&] { run(here[0], here[1], here[2]); });
            for (std::size_t k = 0; k < 17; ++k) {
                for (std::size_t array = 0; array < 2; ++array) {
                    const double a = static_cast<double>(expected[array][k]), b = static_cast<double>(here[array][k]);
                    CHECK((a == b || std::max(std::fabs(a), std::fabs(b)) <= 0x1p-126));
                    ++compared;
                }
            }
        }
        CHECK(compared > 1000);
    });
}

}  // namespace float_state
