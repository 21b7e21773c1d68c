#include "judges/numbers.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <new>
#include <ostream>
#include <utility>

#include "judges/oracle.hpp"

namespace support {

namespace {

// Numbers come and go by the million: their memory is used again, in blocks of 64 bytes, and never given back.
struct FreeBlock {
    FreeBlock* next;
};
FreeBlock* free_blocks[16] = {};  // of so many times 64 bytes

template <class Type>
struct Pool {
    using value_type = Type;

    Pool() = default;
    template <class Other>
    Pool(const Pool<Other>&) {}

    static std::size_t blocks(std::size_t count) { return (count * sizeof(Type) + 63) / 64; }
    Type* allocate(std::size_t count) {
        const std::size_t size = blocks(count);
        if (size >= std::size(free_blocks) || free_blocks[size] == nullptr)
            return static_cast<Type*>(::operator new(64 * size));
        return static_cast<Type*>(static_cast<void*>(std::exchange(free_blocks[size], free_blocks[size]->next)));
    }
    void deallocate(Type* memory, std::size_t count) {
        const std::size_t size = blocks(count);
        if (size >= std::size(free_blocks))
            ::operator delete(memory);
        else
            free_blocks[size] = new (memory) FreeBlock{free_blocks[size]};
    }
    friend bool operator==(const Pool&, const Pool&) { return true; }
};

namespace multiprecision = boost::multiprecision;
using Backend = multiprecision::cpp_int_backend<0, 0, multiprecision::signed_magnitude, multiprecision::unchecked,
                                                Pool<multiprecision::limb_type>>;
using Integer = multiprecision::number<Backend, multiprecision::et_off>;

}  // namespace

// Rationals

// In lowest terms, the denominator positive. Of floats it is a power of two, whose common divisors Boost's own
// rationals look for bit by bit.
struct Rational::Value {
    Integer numerator, denominator;

    Value(Integer n, Integer d) : numerator(std::move(n)), denominator(std::move(d)) {
        if (numerator == 0) denominator = 1;
        if (denominator < 0) numerator = -numerator, denominator = -denominator;
        if (numerator == 0) return;
        const unsigned twos = std::min(lsb(abs(numerator)), lsb(denominator));
        numerator >>= twos;
        denominator >>= twos;
        if (lsb(denominator) == msb(denominator)) return;
        const Integer divisor = gcd(numerator, denominator);
        numerator /= divisor;
        denominator /= divisor;
    }
};

Rational::Rational(Value value) : value_(std::allocate_shared<const Value>(Pool<Value>(), std::move(value))) {}
Rational::Rational(std::int64_t numerator, std::int64_t denominator) : Rational(Value(numerator, denominator)) {}
Rational::Rational(double value) : Rational(Dyadic(value).rational()) {}
Rational::Rational(const std::string& text) {
    const std::size_t slash = text.find('/');
    *this =
        Rational(Value(Integer(text.substr(0, slash)), Integer(slash < text.size() ? text.substr(slash + 1) : "1")));
}

const Rational::Value& Rational::value() const {
    static const Value zero(0, 1);
    return value_ ? *value_ : zero;
}

int Rational::sign() const { return value().numerator.sign(); }

Rational operator-(const Rational& a) { return Rational(Rational::Value(-a.value().numerator, a.value().denominator)); }
Rational operator+(const Rational& a, const Rational& b) {
    const auto& [n, d] = a.value();
    const auto& [m, e] = b.value();
    return Rational(Rational::Value(n * e + m * d, d * e));
}
Rational operator-(const Rational& a, const Rational& b) { return a + -b; }
Rational operator*(const Rational& a, const Rational& b) {
    const auto& [n, d] = a.value();
    const auto& [m, e] = b.value();
    return Rational(Rational::Value(n * m, d * e));
}
Rational operator/(const Rational& a, const Rational& b) {
    const auto& [n, d] = a.value();
    const auto& [m, e] = b.value();
    return Rational(Rational::Value(n * e, d * m));
}
std::strong_ordering operator<=>(const Rational& a, const Rational& b) {
    const auto& [n, d] = a.value();
    const auto& [m, e] = b.value();
    return Integer(n * e).compare(m * d) <=> 0;
}

Rational power_of_two(int exponent) {
    const Integer power = Integer(1) << static_cast<unsigned>(std::abs(exponent));
    return Rational(exponent < 0 ? Rational::Value(1, power) : Rational::Value(power, 1));
}

int exponent_of(const Rational& value) {
    const Integer n = abs(value.value().numerator);
    const Integer& d = value.value().denominator;
    const int guess = static_cast<int>(msb(n)) - static_cast<int>(msb(d));
    const bool reached =
        guess >= 0 ? n >= (d << static_cast<unsigned>(guess)) : (n << static_cast<unsigned>(-guess)) >= d;
    return reached ? guess : guess - 1;
}

template <class Float>
Float nearest(const Rational& value) {
    if (value == 0) return Float(0);
    const int ulp = ulp_exponent<Float>(value);
    const Rational scaled = magnitude(value) * power_of_two(-ulp);
    const auto& [n, d] = scaled.value();
    Integer quotient, remainder;
    divide_qr(n, d, quotient, remainder);
    const Integer twice = remainder * 2;
    if (twice > d || (twice == d && bit_test(quotient, 0))) ++quotient;
    const Float size = std::ldexp(static_cast<Float>(static_cast<std::uint64_t>(quotient)), ulp);
    return value < 0 ? -size : size;
}
template float nearest(const Rational& value);
template double nearest(const Rational& value);

std::ostream& operator<<(std::ostream& stream, const Rational& value) {
    return stream << value.value().numerator << '/' << value.value().denominator;
}

// Dyadic numbers

struct Dyadic::Mantissa {
    Integer number;
};

Dyadic::Dyadic(Mantissa mantissa, int exponent)
    : mantissa_(std::allocate_shared<const Mantissa>(Pool<Mantissa>(), std::move(mantissa))), exponent_(exponent) {}
Dyadic::Dyadic(std::int64_t mantissa, int exponent) : Dyadic(Mantissa{mantissa}, exponent) {}
Dyadic::Dyadic(double value) {
    if (value == 0.0) return;
    const double mantissa = std::ldexp(std::frexp(value, &exponent_), 53);
    *this = Dyadic(static_cast<std::int64_t>(mantissa), exponent_ - 53);
}

int Dyadic::sign() const { return mantissa_ ? mantissa_->number.sign() : 0; }

Rational Dyadic::rational() const {
    if (!mantissa_) return {};
    const Integer power = Integer(1) << static_cast<unsigned>(std::abs(exponent_));
    return Rational(exponent_ < 0 ? Rational::Value(mantissa_->number, power)
                                  : Rational::Value(mantissa_->number * power, 1));
}

double Dyadic::estimate() const {
    if (sign() == 0) return 0.0;
    const Integer size = abs(mantissa_->number);
    const int surplus = std::max(0, static_cast<int>(msb(size)) - 62);
    const auto top = static_cast<double>(static_cast<std::int64_t>(size >> static_cast<unsigned>(surplus)));
    return std::ldexp(sign() < 0 ? -top : top, exponent_ + surplus);
}

Dyadic operator-(const Dyadic& a) { return a.mantissa_ ? Dyadic({Integer(-a.mantissa_->number)}, a.exponent_) : a; }
Dyadic operator*(const Dyadic& a, const Dyadic& b) {
    if (!a.mantissa_ || !b.mantissa_) return {};
    return Dyadic({Integer(a.mantissa_->number * b.mantissa_->number)}, a.exponent_ + b.exponent_);
}
Dyadic operator+(const Dyadic& a, const Dyadic& b) {
    if (a.sign() == 0) return b;
    if (b.sign() == 0) return a;
    if (a.exponent_ < b.exponent_) return b + a;
    Integer sum = a.mantissa_->number << static_cast<unsigned>(a.exponent_ - b.exponent_);
    sum += b.mantissa_->number;
    return Dyadic({std::move(sum)}, b.exponent_);
}
Dyadic operator-(const Dyadic& a, const Dyadic& b) {
    if (a.sign() == 0) return -b;
    if (b.sign() == 0) return a;
    const int exponent = std::min(a.exponent_, b.exponent_);
    Integer difference = a.mantissa_->number << static_cast<unsigned>(a.exponent_ - exponent);
    difference -= b.exponent_ == exponent
                      ? b.mantissa_->number
                      : Integer(b.mantissa_->number << static_cast<unsigned>(b.exponent_ - exponent));
    return Dyadic({std::move(difference)}, exponent);
}

// Reals

struct Real::Value {
    multiprecision::number<multiprecision::cpp_bin_float<400, multiprecision::digit_base_2>, multiprecision::et_off>
        number;
};

Real::Real(Value value) : value_(std::allocate_shared<const Value>(Pool<Value>(), std::move(value))) {}
Real::Real(double value) : Real(Value{value}) {}
Real::Real(const Rational& value)
    : Real(Value{decltype(Value::number)(value.value().numerator.str()) /
                 decltype(Value::number)(value.value().denominator.str())}) {}
Real::operator double() const { return static_cast<double>(value().number); }

const Real::Value& Real::value() const {
    static const Value zero;
    return value_ ? *value_ : zero;
}

Real operator-(const Real& a) { return Real(Real::Value{-a.value().number}); }
Real operator+(const Real& a, const Real& b) { return Real(Real::Value{a.value().number + b.value().number}); }
Real operator-(const Real& a, const Real& b) { return Real(Real::Value{a.value().number - b.value().number}); }
Real operator*(const Real& a, const Real& b) { return Real(Real::Value{a.value().number * b.value().number}); }
Real operator/(const Real& a, const Real& b) { return Real(Real::Value{a.value().number / b.value().number}); }
std::partial_ordering operator<=>(const Real& a, const Real& b) {
    const auto &x = a.value().number, &y = b.value().number;
    return x < y    ? std::partial_ordering::less
           : x > y  ? std::partial_ordering::greater
           : x == y ? std::partial_ordering::equivalent
                    : std::partial_ordering::unordered;
}

Real abs(const Real& a) { return Real(Real::Value{abs(a.value().number)}); }
Real sqrt(const Real& a) { return Real(Real::Value{sqrt(a.value().number)}); }
Real tan(const Real& a) { return Real(Real::Value{tan(a.value().number)}); }
Real atan(const Real& a) { return Real(Real::Value{atan(a.value().number)}); }
Real log(const Real& a) { return Real(Real::Value{log(a.value().number)}); }
Real ldexp(const Real& a, int exponent) { return Real(Real::Value{ldexp(a.value().number, exponent)}); }

}  // namespace support
