#pragma once

// The nearest float to a quotient. A value and a bound on its error decide it almost always; where the bound straddles
// the middle of two floats, the exact sums do. So the exact tier means the nearest float, and its bits depend on
// neither compiler, flags, instruction set nor place in the batch.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "../language.hpp"
#include "expansion.hpp"
#include "rounding.hpp"
#include "widen.hpp"

namespace TEXGEN_DETAIL {

// Whether all real numbers within `error` of `value` round to the same float, which is then the nearest float to each.
// Source: Ziv, Fast evaluation of elementary mathematical functions with correctly rounded last bit, ACM TOMS 17
// (1991).
inline bool rounds_alone(double value, double error) noexcept {
    const auto low = bit_cast<std::uint32_t>(static_cast<float>(value - error));
    const auto high = bit_cast<std::uint32_t>(static_cast<float>(value + error));
    return low == high;
}

// The middle of two neighbouring floats. An infinity stands for 2^128, which would follow the largest float.
inline double middle_of(float low, float high) noexcept {
    const auto unbounded = [](float value) {
        return std::fabs(value) < std::numeric_limits<float>::infinity() ? widened(value)
                                                                         : std::copysign(0x1p128, value);
    };
    return 0.5 * unbounded(low) + 0.5 * unbounded(high);
}

// The float nearest to a number x, ties to even; infinity beyond the range. `value` is within error <= 2^-26 |value| of
// x, and sign_beyond(m) is the sign of x - m for m, the middle of two floats.
float nearest_to(double value, double error, const auto& sign_beyond) noexcept {
    if (!(std::fabs(value) < 0x1p129)) return static_cast<float>(value);
    const auto low = static_cast<float>(value - error);
    const auto high = static_cast<float>(value + error);
    if (low == high) return low;
    const double middle = middle_of(low, high);
    const int sign = sign_beyond(middle);
    return sign < 0 ? low : sign > 0 ? high : static_cast<float>(middle);
}

// The float nearest to numerator / denominator. Precondition: denominator > 0.
template <std::size_t N, std::size_t D>
float nearest_quotient(const Expansion<N>& numerator, const Expansion<D>& denominator) noexcept {
    if (numerator.sign() == 0) return 0.0f;
    const double quotient = numerator.estimate() / denominator.estimate();
    return nearest_to(quotient, 0x1p-48 * std::fabs(quotient), [&](double middle) {
        Expansion<N + 2 * D> remainder(numerator);
        remainder.add_scaled(denominator, -middle);
        return remainder.sign();
    });
}

// The sign (-1, 0 or 1) of the number that `bounded` stands for, from exact() where the bound leaves it open. It is -1
// where the number is not finite, which counts as behind.
int certain_sign(const Bounded& bounded, const auto& exact) noexcept {
    if (bounded.value > bounded.error) return 1;
    if (!(std::fabs(bounded.value) <= bounded.error && bounded.error < 0x1p1000)) return -1;
    return exact().sign();
}

// The float nearest to s / q, q > 0. With s = s^ + a, q = q^ + b, |a| <= ds, |b| <= dq < q^:
// |s/q - s^/q^| = |a - b s^/q^| / q <= (ds + dq |s^/q^|) / (q^ - dq), and 4 u more cover the arithmetic here.
float certain_quotient(const Bounded& s, const Bounded& q, const auto& exact_s, const auto& exact_q) noexcept {
    const double quotient = s.value / q.value;
    if (!(s.error < 0x1p1000 && q.error < 0x1p1000)) return static_cast<float>(quotient);  // not finite
    const double error = 1.0001 * (s.error + q.error * std::fabs(quotient)) / (q.value - q.error) +
                         4.0 * unit_roundoff_double * std::fabs(quotient);
    if (q.value > q.error && rounds_alone(quotient, error)) return static_cast<float>(quotient);
    return nearest_quotient(exact_s(), exact_q());
}

// The next float below `value`, which is not -infinity: in a few instructions and without arithmetic.
inline float float_before(float value) noexcept {
    const auto bits = bit_cast<std::uint32_t>(value);
    constexpr std::uint32_t sign = 0x80000000u;
    if ((bits & ~sign) == 0) return bit_cast<float>(sign | 1u);
    return bit_cast<float>((bits & sign) != 0 ? bits + 1 : bits - 1);
}

// The least float that is not below a bound.
inline float float_at_least(double bound) noexcept {
    const auto nearest = static_cast<float>(bound);
    return widened(nearest) < bound ? -float_before(-nearest) : nearest;
}

}  // namespace TEXGEN_DETAIL
