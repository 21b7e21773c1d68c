// The fast judge against the rational one and against the reference in rationals.

#include "judges/exact.hpp"
#include "judges/rational_traits.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "support/random.hpp"
#include "support/triangles.hpp"
#include "texgen/reference.hpp"

using support::Dyadic;
using support::Random;
using support::Rational;

TEST_CASE("sums and products of dyadic numbers are those of rationals") {
    Random random(31);
    for (int i = 0; i < 3000; ++i) {
        const float a = random.any_float(), b = random.any_float(), c = random.any_float();
        if (!std::isfinite(a) || !std::isfinite(b) || !std::isfinite(c)) continue;
        const Dyadic value = Dyadic(a) * Dyadic(b) - Dyadic(c);
        const Rational rational = support::exactly(a) * support::exactly(b) - support::exactly(c);
        REQUIRE(value.rational() == rational);
        REQUIRE(value.sign() == rational.sign());
        REQUIRE(std::fabs(value.estimate() - support::nearest<double>(rational)) <=
                1e-15 * std::fabs(value.estimate()));
    }
}

TEST_CASE("the nearest float is the rational judge's, and its neighbours are not nearest") {
    Random random(32);
    int ties = 0, subnormal = 0, infinite = 0;
    for (int i = 0; i < 6000; ++i) {
        double n = std::ldexp(random.uniform(-1.0, 1.0), random.integer(-160, 130));
        double d = 1.0;
        const int kind = random.integer(0, 2);
        if (kind == 0) d = random.uniform(1.0, 2.0);
        if (kind == 1) n = support::detail::middle(random.any_float(), true);  // a tie
        if (!std::isfinite(n)) continue;
        const support::Quotient u{n, d};
        const float nearest = support::nearest<float>(u.rational());
        ties += std::fabs(n) < 0x1p128 && support::is_tie(u);
        subnormal += std::fpclassify(nearest) == FP_SUBNORMAL;
        infinite += std::isinf(nearest);
        REQUIRE(support::is_nearest(nearest, u));
        REQUIRE(support::is_within(nearest, u, 0.0));
        for (const float other : {std::nextafter(nearest, HUGE_VALF), std::nextafter(nearest, -HUGE_VALF)}) {
            if (other == nearest) continue;
            REQUIRE_FALSE(support::is_nearest(other, u));
            if (std::isfinite(other))
                REQUIRE(support::is_within(other, u, std::nextafter(support::distance(other, u), HUGE_VAL) * 1.000001));
        }
    }
    CHECK(ties > 1000);
    CHECK(subnormal > 100);
    CHECK(infinite > 10);
    CHECK_FALSE(support::is_nearest(std::numeric_limits<float>::quiet_NaN(), {1.0, 1.0}));
}

TEST_CASE("the planes of a triangle are the definition's, up to a positive factor") {
    Random random(33);
    for (const support::Family family : support::families) {
        for (int i = 0; i < 40; ++i) {
            const texgen::Triangle triangle = make_triangle(family, random);
            const texgen::FragmentRect pixel = pixel_near(triangle, random);
            const support::ExactTriangle exact(triangle);
            if (!exact.has_positive_w(pixel.x, pixel.y)) continue;
            const auto strq =
                texgen::reference::strq<Rational>(triangle, Rational(2 * pixel.x + 1, 2), Rational(2 * pixel.y + 1, 2));
            const support::Homogeneous at = exact.at(pixel.x, pixel.y);
            REQUIRE(at.q.sign() == strq[3].sign());
            if (at.q.sign() == 0) continue;
            for (std::size_t k = 0; k < 3; ++k) REQUIRE(at.over_q(k).rational() == strq[static_cast<int>(k)] / strq[3]);
        }
    }
}
