#pragma once

// The judge: exact rationals. Every float and double is one, so the exact value of a formula of floats is known, and so
// is its nearest float.

#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <Eigen/Core>

namespace support {

using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>, boost::multiprecision::et_off>;
using Rational =
    boost::multiprecision::number<boost::multiprecision::cpp_rational_backend, boost::multiprecision::et_off>;

// 2^exponent.
inline Rational power_of_two(int exponent) {
    const Integer power = Integer(1) << static_cast<unsigned>(std::abs(exponent));
    return exponent < 0 ? Rational(Integer(1), power) : Rational(power);
}

// The same number. Precondition: finite.
inline Rational exactly(double value) {
    int exponent = 0;
    const double mantissa = std::frexp(value, &exponent);
    return Rational(Integer(static_cast<std::int64_t>(std::ldexp(mantissa, 53)))) * power_of_two(exponent - 53);
}

inline Rational magnitude(const Rational& value) { return value < 0 ? Rational(-value) : value; }

// The largest e with 2^e <= |value|. Precondition: value is not 0.
inline int exponent_of(const Rational& value) {
    const Integer n = boost::multiprecision::abs(numerator(value));
    const Integer d = denominator(value);
    const int guess = static_cast<int>(msb(n)) - static_cast<int>(msb(d));
    const bool reached =
        guess >= 0 ? n >= (d << static_cast<unsigned>(guess)) : (n << static_cast<unsigned>(-guess)) >= d;
    return reached ? guess : guess - 1;
}

// The distance between neighbouring Floats where `value` is; that of the subnormals below them.
template <class Float>
int ulp_exponent(const Rational& value) {
    constexpr int lowest = std::numeric_limits<Float>::min_exponent - std::numeric_limits<Float>::digits;
    if (value == 0) return lowest;
    const int exponent = exponent_of(value) - (std::numeric_limits<Float>::digits - 1);
    return exponent < lowest ? lowest : exponent;
}

// The nearest Float, ties to even; infinity from the largest Float and half an ulp on.
template <class Float>
Float nearest(const Rational& value) {
    if (value == 0) return Float(0);
    const int ulp = ulp_exponent<Float>(value);
    const Rational scaled = magnitude(value) * power_of_two(-ulp);
    Integer quotient, remainder;
    divide_qr(numerator(scaled), denominator(scaled), quotient, remainder);
    const Integer twice = remainder * 2;
    if (twice > denominator(scaled) || (twice == denominator(scaled) && bit_test(quotient, 0))) ++quotient;
    const Float size = std::ldexp(static_cast<Float>(static_cast<std::uint64_t>(quotient)), ulp);
    return value < 0 ? -size : size;
}

// |computed - exact| in ulps of `exact`; infinite for NaN, and for an infinity that is not the nearest Float.
template <class Float>
double ulp_error(Float computed, const Rational& exact) {
    if (!(std::fabs(computed) <= std::numeric_limits<Float>::max()))
        return computed == nearest<Float>(exact) ? 0.0 : std::numeric_limits<double>::infinity();
    return nearest<double>(magnitude(exactly(computed) - exact) * power_of_two(-ulp_exponent<Float>(exact)));
}

// |computed - exact|; infinite for NaN and infinity.
inline double absolute_error(double computed, const Rational& exact) {
    if (!(std::fabs(computed) <= std::numeric_limits<double>::max())) return std::numeric_limits<double>::infinity();
    return nearest<double>(magnitude(exactly(computed) - exact));
}

// `steps` floats further up (or down): the neighbours where decisions turn.
inline float neighbour(float value, int steps) {
    const auto ordered = [](std::int32_t bits) {
        return bits < 0 ? std::numeric_limits<std::int32_t>::min() - bits : bits;
    };
    return std::bit_cast<float>(ordered(ordered(std::bit_cast<std::int32_t>(value)) + steps));
}

}  // namespace support

template <>
struct Eigen::NumTraits<support::Rational> : Eigen::GenericNumTraits<support::Rational> {
    using Real = support::Rational;
    using NonInteger = support::Rational;
    using Literal = support::Rational;
    using Nested = support::Rational;
    enum {
        IsComplex = 0,
        IsInteger = 0,
        IsSigned = 1,
        RequireInitialization = 1,
        ReadCost = 1,
        AddCost = 8,
        MulCost = 8
    };
    static Real epsilon() { return 0; }
    static Real dummy_precision() { return 0; }
    static int digits10() { return 0; }
};
