// The judge is judged: exact conversions, rounding to nearest even, and the distance in ulps.

#include "judges/oracle.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "judges/real.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"

using support::exactly;
using support::infinity_float;
using support::nearest;
using support::Rational;

TEST_CASE("floats and doubles survive the way through rationals, subnormals included") {
    support::Random random(1);
    int subnormal = 0;
    for (int i = 0; i < 20000; ++i) {
        const float value = random.any_float();
        if (!std::isfinite(value)) continue;
        subnormal += std::fpclassify(value) == FP_SUBNORMAL;
        REQUIRE_MESSAGE(nearest<float>(exactly(value)) == value, support::hex(value));
        REQUIRE_MESSAGE(nearest<double>(exactly(value)) == static_cast<double>(value), support::hex(value));
        const double wide = std::bit_cast<double>(random.bits());
        if (std::isfinite(wide)) REQUIRE_MESSAGE(nearest<double>(exactly(wide)) == wide, support::hex(wide));
    }
    CHECK(subnormal > 10);
    CHECK(exactly(0x1p-1074) == support::power_of_two(-1074));
    CHECK(exactly(-0.75) == Rational(-3, 4));
}

TEST_CASE("rounding to float is the hardware's rounding from double") {
    support::Random random(2);
    for (int i = 0; i < 20000; ++i) {
        const double value = std::ldexp(random.uniform(-1.0, 1.0), random.integer(-160, 135));
        REQUIRE_MESSAGE(nearest<float>(exactly(value)) == static_cast<float>(value), support::hex(value));
    }
}

TEST_CASE("ties go to even, and beyond the largest float and half an ulp lies infinity") {
    CHECK(nearest<float>(exactly(1.0 + 0x1p-24)) == 1.0f);
    CHECK(nearest<float>(exactly(1.0 + 0x3p-24)) == 1.0f + 0x1p-22f);
    CHECK(nearest<float>(exactly(1.0 + 0x1p-24) + support::power_of_two(-300)) == 1.0f + 0x1p-23f);
    CHECK(nearest<float>(exactly(0x1p-150)) == 0.0f);
    CHECK(nearest<float>(exactly(0x3p-150)) == 0x1p-148f);
    CHECK(nearest<float>(exactly(0x1.fffffefffffffp127)) == 0x1.fffffep127f);
    CHECK(nearest<float>(exactly(0x1.ffffffp127)) == infinity_float);
    CHECK(nearest<float>(exactly(-0x1p200)) == -infinity_float);
    CHECK(nearest<double>(Rational(1, 3)) == 1.0 / 3.0);
    CHECK(nearest<float>(Rational(-1, 3)) == -1.0f / 3.0f);
}

TEST_CASE("the distance in ulps is measured in the binade of the exact value") {
    CHECK(support::ulp_error(1.0f, exactly(1.0)) == 0.0);
    CHECK(support::ulp_error(1.0f + 0x1p-23f, exactly(1.0)) == 1.0);
    CHECK(support::ulp_error(1.0f, exactly(1.0 - 0x1p-25)) == 0.5);
    CHECK(support::ulp_error(0.0f, exactly(0x1p-150)) == 0.5);
    CHECK(support::ulp_error(3.0f, Rational(1, 3)) > 1e7);
    CHECK(support::ulp_error(infinity_float, exactly(0x1p128)) == 0.0);
    CHECK(std::isinf(support::ulp_error(infinity_float, exactly(1.0))));
    CHECK(std::isinf(support::ulp_error(std::numeric_limits<float>::quiet_NaN(), exactly(1.0))));
}

TEST_CASE("neighbours are counted through zero") {
    CHECK(support::neighbour(1.0f, 1) == 1.0f + 0x1p-23f);
    CHECK(support::neighbour(1.0f, -2) == 1.0f - 0x1p-23f);
    CHECK(support::neighbour(0.0f, -1) == -0x1p-149f);
    CHECK(support::neighbour(-0x1p-149f, 2) == 0x1p-149f);
}

TEST_CASE("the high-precision judge knows pi, and its view is a rotation") {
    const support::Real pi = 4 * atan(support::Real(1));
    CHECK(support::error_in_ulps(3.14159265358979323846, pi) < 0.5);
    const support::RealMatrix view = support::look_at({1.0, 2.0, 3.0}, {4.0, -1.0, 0.5}, {0.0, 1.0, 0.0});
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            const support::Real product =
                view[i][0] * view[j][0] + view[i][1] * view[j][1] + view[i][2] * view[j][2] - (i == j ? 1 : 0);
            CHECK(abs(product) < support::Real(1e-110));
        }
    }
}
