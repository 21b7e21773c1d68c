#pragma once

// Exact numbers. GMP and MPFR compute them, in numbers.cpp alone.

#include <compare>
#include <concepts>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>

namespace support {

class Rational {
public:
    Rational() = default;
    template <std::integral Whole>
    Rational(Whole value) : Rational(static_cast<std::int64_t>(value), std::int64_t{1}) {}
    // Precondition: finite.
    explicit Rational(double value);
    // Precondition: the denominator is not 0.
    Rational(std::int64_t numerator, std::int64_t denominator);
    // "-0x3e/0xb", or decimal, or whole.
    explicit Rational(const std::string& text);

    int sign() const;

    friend Rational operator-(const Rational& a);
    friend Rational operator+(const Rational& a, const Rational& b);
    friend Rational operator-(const Rational& a, const Rational& b);
    friend Rational operator*(const Rational& a, const Rational& b);
    friend Rational operator/(const Rational& a, const Rational& b);
    friend std::strong_ordering operator<=>(const Rational& a, const Rational& b);
    friend bool operator==(const Rational& a, const Rational& b) { return (a <=> b) == 0; }

    Rational& operator+=(const Rational& b) { return *this = *this + b; }
    Rational& operator-=(const Rational& b) { return *this = *this - b; }
    Rational& operator*=(const Rational& b) { return *this = *this * b; }
    Rational& operator/=(const Rational& b) { return *this = *this / b; }

    // GMP's number, for numbers.cpp.
    struct Value;
    explicit Rational(Value value);
    const Value& value() const;

private:
    std::shared_ptr<const Value> value_;  // none is 0
};

// 2^exponent.
Rational power_of_two(int exponent);

// The same number. Precondition: finite.
inline Rational exactly(double value) { return Rational(value); }

// The largest e with 2^e <= |value|. Precondition: value is not 0.
int exponent_of(const Rational& value);

// The nearest float or double, ties to even; infinity from the largest one and half an ulp on.
template <class Float>
Float nearest(const Rational& value);

// In decimal digits.
std::ostream& operator<<(std::ostream& stream, const Rational& value);

// mantissa * 2^exponent: sums and products of floats, which are not reduced at every step as rationals are.
class Dyadic {
public:
    Dyadic() = default;
    // Precondition: finite.
    Dyadic(double value);
    Dyadic(std::int64_t mantissa, int exponent);

    int sign() const;
    Rational rational() const;
    // Within a few double ulp; infinity and zero beyond the range.
    double estimate() const;

    friend Dyadic operator-(const Dyadic& a);
    friend Dyadic operator+(const Dyadic& a, const Dyadic& b);
    friend Dyadic operator-(const Dyadic& a, const Dyadic& b);
    friend Dyadic operator*(const Dyadic& a, const Dyadic& b);
    friend bool operator<(const Dyadic& a, const Dyadic& b) { return (a - b).sign() < 0; }
    friend bool operator<=(const Dyadic& a, const Dyadic& b) { return (a - b).sign() <= 0; }
    friend bool operator==(const Dyadic& a, const Dyadic& b) { return (a - b).sign() == 0; }

private:
    struct Mantissa;
    Dyadic(std::shared_ptr<const Mantissa> mantissa, int exponent);

    std::shared_ptr<const Mantissa> mantissa_;  // none is 0
    int exponent_ = 0;
};

// Of 400 bits, where a root or a tangent enters: its own error never shows in a double.
class Real {
public:
    Real() = default;
    Real(double value);
    explicit Real(const Rational& value);
    explicit operator double() const;

    friend Real operator-(const Real& a);
    friend Real operator+(const Real& a, const Real& b);
    friend Real operator-(const Real& a, const Real& b);
    friend Real operator*(const Real& a, const Real& b);
    friend Real operator/(const Real& a, const Real& b);
    friend std::partial_ordering operator<=>(const Real& a, const Real& b);
    friend bool operator==(const Real& a, const Real& b) { return (a <=> b) == 0; }

    Real& operator+=(const Real& b) { return *this = *this + b; }

    friend Real abs(const Real& a);
    friend Real sqrt(const Real& a);
    friend Real tan(const Real& a);
    friend Real atan(const Real& a);
    friend Real log(const Real& a);
    friend Real ldexp(const Real& a, int exponent);

private:
    struct Value;
    explicit Real(std::shared_ptr<const Value> value);
    const Value& value() const;

    std::shared_ptr<const Value> value_;  // none is 0
};

}  // namespace support
