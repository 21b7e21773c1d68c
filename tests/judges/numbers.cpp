#include "judges/numbers.hpp"

#include <gmpxx.h>
#include <mpfr.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
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

std::size_t blocks(std::size_t size) { return (size + 63) / 64; }
void* allocate(std::size_t size) {
    const std::size_t count = blocks(size);
    if (count >= std::size(free_blocks) || free_blocks[count] == nullptr) return ::operator new(64 * count);
    return std::exchange(free_blocks[count], free_blocks[count]->next);
}
void deallocate(void* memory, std::size_t size) {
    const std::size_t count = blocks(size);
    if (count >= std::size(free_blocks))
        ::operator delete(memory);
    else
        free_blocks[count] = new (memory) FreeBlock{free_blocks[count]};
}
void* reallocate(void* memory, std::size_t from, std::size_t to) {
    if (blocks(from) == blocks(to)) return memory;
    void* const result = std::memcpy(allocate(to), memory, std::min(from, to));
    deallocate(memory, from);
    return result;
}

// GMP takes its memory from there, and MPFR with it: from before main() on, when there are no numbers yet.
[[maybe_unused]] const bool is_used_by_gmp = (mp_set_memory_functions(allocate, reallocate, deallocate), true);

template <class Type>
struct Pool {
    using value_type = Type;

    Pool() = default;
    template <class Other>
    Pool(const Pool<Other>&) {}

    Type* allocate(std::size_t count) { return static_cast<Type*>(support::allocate(count * sizeof(Type))); }
    void deallocate(Type* memory, std::size_t count) { support::deallocate(memory, count * sizeof(Type)); }
    friend bool operator==(const Pool&, const Pool&) { return true; }
};

template <class Value>
std::shared_ptr<const Value> shared(Value value) {
    return std::allocate_shared<const Value>(Pool<Value>(), std::move(value));
}

// A long may have 32 bits.
mpz_class integer(std::int64_t value) {
    if constexpr (sizeof(long) == sizeof value) return static_cast<long>(value);
    mpz_class result = static_cast<long>(value >> 32);
    result <<= 32;
    return result + static_cast<unsigned long>(value & 0xffffffff);
}

mpz_class shifted(const mpz_class& value, int count) { return value << static_cast<mp_bitcnt_t>(count); }

int last_bit_of(const mpz_class& value) { return static_cast<int>(mpz_sizeinbase(value.get_mpz_t(), 2)) - 1; }

}  // namespace

// Rationals

struct Rational::Value {
    mpq_class number;
};

Rational::Rational(Value value) : value_(shared(std::move(value))) {}
Rational::Rational(std::int64_t numerator, std::int64_t denominator) {
    mpq_class value(integer(numerator), integer(denominator));
    value.canonicalize();
    *this = Rational(Value{std::move(value)});
}
Rational::Rational(double value) : Rational(Value{mpq_class(value)}) {}
Rational::Rational(const std::string& text) {
    mpq_class value(text, 0);
    value.canonicalize();
    *this = Rational(Value{std::move(value)});
}

const Rational::Value& Rational::value() const {
    static const Value zero;
    return value_ ? *value_ : zero;
}

int Rational::sign() const { return sgn(value().number); }

Rational operator-(const Rational& a) { return Rational(Rational::Value{-a.value().number}); }
Rational operator+(const Rational& a, const Rational& b) {
    return Rational(Rational::Value{a.value().number + b.value().number});
}
Rational operator-(const Rational& a, const Rational& b) {
    return Rational(Rational::Value{a.value().number - b.value().number});
}
Rational operator*(const Rational& a, const Rational& b) {
    return Rational(Rational::Value{a.value().number * b.value().number});
}
Rational operator/(const Rational& a, const Rational& b) {
    return Rational(Rational::Value{a.value().number / b.value().number});
}
std::strong_ordering operator<=>(const Rational& a, const Rational& b) {
    return cmp(a.value().number, b.value().number) <=> 0;
}

Rational power_of_two(int exponent) {
    const mpz_class power = shifted(1, std::abs(exponent));
    return Rational(Rational::Value{exponent < 0 ? mpq_class(1, power) : mpq_class(power)});
}

int exponent_of(const Rational& value) {
    const mpz_class n = abs(value.value().number.get_num());
    const mpz_class& d = value.value().number.get_den();
    const int guess = last_bit_of(n) - last_bit_of(d);
    const bool reached = guess >= 0 ? n >= shifted(d, guess) : shifted(n, -guess) >= d;
    return reached ? guess : guess - 1;
}

template <class Float>
Float nearest(const Rational& value) {
    if (value == 0) return Float(0);
    const int ulp = ulp_exponent<Float>(value);
    const Rational scaled = magnitude(value) * power_of_two(-ulp);
    const mpz_class &n = scaled.value().number.get_num(), &d = scaled.value().number.get_den();
    mpz_class quotient, remainder;
    mpz_fdiv_qr(quotient.get_mpz_t(), remainder.get_mpz_t(), n.get_mpz_t(), d.get_mpz_t());
    const int past_middle = cmp(2 * remainder, d);
    if (past_middle > 0 || (past_middle == 0 && mpz_odd_p(quotient.get_mpz_t()))) ++quotient;
    const Float size = std::ldexp(static_cast<Float>(quotient.get_d()), ulp);  // of at most 53 digits
    return value < 0 ? -size : size;
}
template float nearest(const Rational& value);
template double nearest(const Rational& value);

std::ostream& operator<<(std::ostream& stream, const Rational& value) {
    return stream << value.value().number.get_num().get_str() << '/' << value.value().number.get_den().get_str();
}

// Dyadic numbers

struct Dyadic::Mantissa {
    mpz_class number;

    // What `set` makes of it.
    static Dyadic of(int exponent, const auto& set) {
        const auto mantissa = std::allocate_shared<Mantissa>(Pool<Mantissa>());
        set(mantissa->number.get_mpz_t());
        return Dyadic(mantissa, exponent);
    }
};

Dyadic::Dyadic(std::shared_ptr<const Mantissa> mantissa, int exponent)
    : mantissa_(std::move(mantissa)), exponent_(exponent) {}
Dyadic::Dyadic(std::int64_t mantissa, int exponent)
    : mantissa_(shared(Mantissa{integer(mantissa)})), exponent_(exponent) {}
Dyadic::Dyadic(double value) {
    if (value == 0.0) return;
    const double mantissa = std::ldexp(std::frexp(value, &exponent_), 53);
    exponent_ -= 53;
    mantissa_ = shared(Mantissa{mpz_class(mantissa)});
}

int Dyadic::sign() const { return mantissa_ ? sgn(mantissa_->number) : 0; }

Rational Dyadic::rational() const {
    if (!mantissa_) return {};
    return Rational(Rational::Value{mpq_class(mantissa_->number)}) * power_of_two(exponent_);
}

double Dyadic::estimate() const {
    if (sign() == 0) return 0.0;
    long exponent;
    const double leading = mpz_get_d_2exp(&exponent, mantissa_->number.get_mpz_t());
    return std::ldexp(leading, exponent_ + static_cast<int>(exponent));
}

Dyadic operator-(const Dyadic& a) {
    if (!a.mantissa_) return a;
    return Dyadic::Mantissa::of(a.exponent_, [&](mpz_ptr to) { mpz_neg(to, a.mantissa_->number.get_mpz_t()); });
}
Dyadic operator*(const Dyadic& a, const Dyadic& b) {
    if (!a.mantissa_ || !b.mantissa_) return {};
    return Dyadic::Mantissa::of(a.exponent_ + b.exponent_, [&](mpz_ptr to) {
        mpz_mul(to, a.mantissa_->number.get_mpz_t(), b.mantissa_->number.get_mpz_t());
    });
}
Dyadic operator+(const Dyadic& a, const Dyadic& b) {
    if (a.sign() == 0) return b;
    if (b.sign() == 0) return a;
    if (a.exponent_ < b.exponent_) return b + a;
    return Dyadic::Mantissa::of(b.exponent_, [&](mpz_ptr to) {
        mpz_mul_2exp(to, a.mantissa_->number.get_mpz_t(), static_cast<mp_bitcnt_t>(a.exponent_ - b.exponent_));
        mpz_add(to, to, b.mantissa_->number.get_mpz_t());
    });
}
Dyadic operator-(const Dyadic& a, const Dyadic& b) { return a + -b; }

// Reals

struct Real::Value {
    mpfr_t number;

    Value() { mpfr_init2(number, 400), mpfr_set_zero(number, 1); }
    Value(const Value&) = delete;
    Value& operator=(const Value&) = delete;
    ~Value() { mpfr_clear(number); }

    // What a function of MPFR makes of others.
    static Real of(const auto& function, const auto&... others) {
        const auto value = std::allocate_shared<Value>(Pool<Value>());
        function(value->number, others..., MPFR_RNDN);
        return Real(value);
    }
};

Real::Real(std::shared_ptr<const Value> value) : value_(std::move(value)) {}
Real::Real(double value) : Real(Value::of(mpfr_set_d, value)) {}
Real::Real(const Rational& value) : Real(Value::of(mpfr_set_q, value.value().number.get_mpq_t())) {}
Real::operator double() const { return mpfr_get_d(value().number, MPFR_RNDN); }

const Real::Value& Real::value() const {
    static const Value zero;
    return value_ ? *value_ : zero;
}

Real operator-(const Real& a) { return Real::Value::of(mpfr_neg, a.value().number); }
Real operator+(const Real& a, const Real& b) { return Real::Value::of(mpfr_add, a.value().number, b.value().number); }
Real operator-(const Real& a, const Real& b) { return Real::Value::of(mpfr_sub, a.value().number, b.value().number); }
Real operator*(const Real& a, const Real& b) { return Real::Value::of(mpfr_mul, a.value().number, b.value().number); }
Real operator/(const Real& a, const Real& b) { return Real::Value::of(mpfr_div, a.value().number, b.value().number); }
std::partial_ordering operator<=>(const Real& a, const Real& b) {
    const auto &x = a.value().number, &y = b.value().number;
    if (mpfr_unordered_p(x, y)) return std::partial_ordering::unordered;
    return mpfr_cmp(x, y) <=> 0;
}

Real abs(const Real& a) { return Real::Value::of(mpfr_abs, a.value().number); }
Real sqrt(const Real& a) { return Real::Value::of(mpfr_sqrt, a.value().number); }
Real tan(const Real& a) { return Real::Value::of(mpfr_tan, a.value().number); }
Real atan(const Real& a) { return Real::Value::of(mpfr_atan, a.value().number); }
Real log(const Real& a) { return Real::Value::of(mpfr_log, a.value().number); }
Real ldexp(const Real& a, int exponent) { return Real::Value::of(mpfr_mul_2si, a.value().number, exponent); }

}  // namespace support
