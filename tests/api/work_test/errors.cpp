// What is said of the error of a rectangle: never less than it is, and not much more.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "api/work_test/truth.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "support/hard_triangles.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/triangles.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"

namespace work_cases {

using support::count_of;
using support::everywhere;
using support::setup_of;
using texgen::TriangleSetup;

namespace {

// The largest distance of s (0) or t (1) from the truth over the fragments in front.
double largest_error(const Shot& shot, const ExactTriangle& exact, const Outputs& out, std::size_t coordinate) {
    double largest = 0.0;
    for (std::size_t i = 0; i < out.size(); ++i) {
        const auto [x, y] = shot.fragment(i);
        if (!exact.has_positive_w(x, y)) continue;
        const Homogeneous at = exact.at(x, y);
        if (at.q.sign() > 0)
            largest =
                std::max(largest, support::distance(static_cast<double>(out[coordinate][i]), at.over_q(coordinate)));
    }
    return largest;
}

double median(std::vector<double> values) {
    REQUIRE(values.size() > 50);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

TEST_CASE("error_bound in the exact tier is never below the error, is infinite where q reaches 0, and is tight") {
    std::uint64_t seed = 3300;
    int infinite = 0, finite = 0;
    std::vector<double> ratios;
    for (const support::HardFamily& family : support::hard_families) {
        CAPTURE(std::string(family.name));
        Random random(++seed);
        std::vector<double> ratios_here;
        for (int i = 0; i < 120; ++i) {
            const Shot shot = family.make(random);
            const ExactTriangle exact(shot.triangle);
            const TextureRegion region = random.coin() ? everywhere() : support::region_at(shot, exact, random);
            const TriangleSetup setup = setup_of(shot.triangle, region);
            const glm::dvec2 bound = setup.error_bound(shot.rect);
            REQUIRE(bound.x >= 0.0);
            REQUIRE(bound.y >= 0.0);
            const Truth truth = truth_of(shot, exact, region);
            if (truth.any_in_front && !truth.all_in_front) {
                ++infinite;
                REQUIRE_MESSAGE(std::isinf(bound.x), hex(shot));
                REQUIRE_MESSAGE(std::isinf(bound.y), hex(shot));
            }
            Outputs out(count_of(shot.rect));
            if (interpolate(setup, shot.rect, out.spans()) == Work::nothing) continue;
            for (std::size_t k = 0; k < 2; ++k) {
                const double b = bound[static_cast<int>(k)];
                if (!std::isfinite(b)) continue;
                ++finite;
                const double error = largest_error(shot, exact, out, k);
                REQUIRE_MESSAGE(error <= b * (1.0 + 1e-12), hex(shot));
                if (error > 0.0) ratios_here.push_back(b / error);
            }
        }
        if (ratios_here.size() > 50) CHECK(median(ratios_here) < 100.0);
        ratios.insert(ratios.end(), ratios_here.begin(), ratios_here.end());
    }
    CHECK(infinite > 100);
    CHECK(finite > 1000);
    CHECK(median(ratios) < 5.0);
}

TEST_CASE("error_bound under a tolerance is never below the error, and is at most a hundred times too large") {
    std::uint64_t seed = 3400;
    for (const double tolerance : {0x1p-21, 0x1p-14, 0x1p-8, 0.1}) {
        CAPTURE(tolerance);
        Random random(++seed);
        std::vector<double> ratios, ratios_of_polynomials;
        for (int i = 0; i < 400; ++i) {
            Shot shot = support::detail::ordinary(random.coin() ? support::Family::friendly : support::Family::parallel,
                                                  random);
            shot.rect = {shot.rect.x - 20, shot.rect.y, random.integer(33, 150), random.integer(1, 12)};
            const ExactTriangle exact(shot.triangle);
            const TriangleSetup setup = setup_of(shot.triangle, everywhere(), {tolerance});
            const glm::dvec2 bound = setup.error_bound(shot.rect);
            Outputs out(count_of(shot.rect));
            const Work work = interpolate(setup, shot.rect, out.spans());
            if (work == Work::nothing) continue;
            for (std::size_t k = 0; k < 2; ++k) {
                const double b = bound[static_cast<int>(k)];
                const double error = largest_error(shot, exact, out, k);
                REQUIRE_MESSAGE(error <= b * (1.0 + 1e-12), hex(shot));
                if (!std::isfinite(b) || !(error > 0.0)) continue;
                ratios.push_back(b / error);
                if (work == Work::affine || work == Work::quadratic) ratios_of_polynomials.push_back(b / error);
            }
        }
        CHECK(median(ratios) < 100.0);
        CHECK(median(ratios_of_polynomials) < 100.0);
    }
}

TEST_CASE("a rectangle without fragments, or behind the projector, needs nothing and has no error") {
    Random random(3500);
    const TriangleSetup setup = setup_of(make_triangle(support::Family::friendly, random));
    const texgen::FootprintSetup footprints(setup, {256.0, 256.0});
    for (const FragmentRect& rect : {FragmentRect{0, 0, 0, 5}, FragmentRect{0, 0, 5, 0}, FragmentRect{0, 0, -5, 5}}) {
        CHECK(setup.work(rect) == Work::nothing);
        CHECK(setup.error_bound(rect) == glm::dvec2(0.0, 0.0));
        CHECK(footprints.error_bound(rect) == glm::dvec2(0.0, 0.0));
    }
    texgen::Triangle behind = make_triangle(support::Family::friendly, random);
    for (texgen::WindowVertex* vertex : support::vertices(behind)) vertex->strq *= -1.0f;
    const FragmentRect rect{0, 0, 2, 2};
    const TriangleSetup from_behind = setup_of(behind);
    REQUIRE(from_behind.work(rect) == Work::nothing);
    CHECK(from_behind.error_bound(rect) == glm::dvec2(0.0, 0.0));
    CHECK(texgen::FootprintSetup(from_behind, {256.0, 256.0}).error_bound(rect) == glm::dvec2(0.0, 0.0));
}

}  // namespace work_cases
