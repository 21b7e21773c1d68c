// Sums in two doubles against exact ones: what they decide is right, and they decide what no single double can.

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <optional>

#include "support/exact.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "texgen/detail/nearest.hpp"

namespace {

using support::Dyadic;
using support::Quotient;
using support::Random;
using texgen::detail::TwofoldSum;

struct Sum {
    TwofoldSum twofold;
    Dyadic exact;

    void add_product(double a, double b) {
        twofold.add_product(a, b);
        exact = exact + Dyadic(a) * Dyadic(b);
    }
};

}  // namespace

TEST_CASE("what a sum in two doubles lacks is at most what it says, and a sign that it knows is the exact one") {
    Random random(41);
    int zeros = 0, open = 0, known = 0;
    for (int i = 0; i < 20000; ++i) {
        Sum sum;
        const int terms = random.integer(1, 5);
        const int spread = random.integer(0, 120);
        for (int k = 0; k < terms; ++k) {
            const double a = std::ldexp(random.uniform(-1.0, 1.0), random.integer(-spread, spread));
            const double b = std::ldexp(random.uniform(-1.0, 1.0), random.integer(-spread, spread));
            sum.add_product(a, b);
            if (random.integer(0, 1) == 0) sum.add_product(-b, random.integer(0, 1) == 0 ? a : std::nextafter(a, 9.0));
        }
        const texgen::detail::DoubleDouble value = sum.twofold.value();
        const Dyadic lacking = sum.exact - (Dyadic(value.high) + Dyadic(value.low));
        REQUIRE(magnitude(lacking) <= Dyadic(sum.twofold.lost()));
        const std::optional<int> sign = sum.twofold.sign();
        if (sign) REQUIRE(*sign == sum.exact.sign());
        open += !sign;
        known += sign.has_value();
        zeros += sign == 0;
    }
    CHECK(zeros > 100);
    CHECK(open > 10);
    CHECK(known > 15000);
}

TEST_CASE(
    "a quotient of sums in two doubles is the nearest float, or open; ties of numbers with few bits are decided") {
    Random random(42);
    int ties = 0, open = 0, near_ties = 0;
    for (int i = 0; i < 40000; ++i) {
        const bool is_nice = i % 2 == 0;
        const auto number = [&](int exponent) {
            const double value = std::ldexp(random.uniform(0.5, 1.0), exponent);
            return is_nice ? std::round(std::ldexp(value, 20 - exponent)) * std::ldexp(1.0, exponent - 20) : value;
        };
        const double middle = support::detail::middle(
            static_cast<float>(std::ldexp(random.uniform(-1.0, 1.0), random.integer(-160, 128))), true);
        if (!(std::fabs(middle) <= 0x1p128)) continue;
        Sum s, q;
        for (int k = 0; k < 3; ++k) {
            const int spread = is_nice ? 3 : 20;
            const double a = number(random.integer(-spread, spread)), b = number(random.integer(-spread, spread));
            q.add_product(a, b);
            // middle a is exact where a has few bits; else next to it.
            s.add_product(middle * a, b);
        }
        if (i % 4 == 1) s.add_product(std::ldexp(s.twofold.value().high, -random.integer(60, 100)), 1.0);
        const Quotient u{s.exact, q.exact};
        const std::optional<float> nearest = nearest_quotient(s.twofold, q.twofold);
        ties += is_nice;
        if (is_nice) REQUIRE(nearest.has_value());
        if (nearest) REQUIRE_MESSAGE(is_nearest(*nearest, u), support::hex(middle));
        open += !nearest;
        near_ties += !is_nice && nearest.has_value();
    }
    CHECK(ties > 10000);
    CHECK(near_ties > 1000);
    CHECK(open > 100);
}
