#pragma once

// Rounding: the unit roundoffs, gamma(n), and the error-free transformations. Every bound of the library is computed
// from these, where the rounding happens.
//
// Promises are for rounding to nearest, the direction that a program starts in; the library changes no state. Where
// subnormal numbers are taken as 0 (FTZ and DAZ on x86, FZ on Arm), a float below 2^-126 counts as 0, and is written as
// 0; everything else has the same bits.

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/vec2.hpp>

#include "../language.hpp"

// A compiler that may reorder sums takes two_sum()'s error for 0, or a reciprocal for a division: no bound would hold.
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || defined(_M_FP_FAST)
#error \
    "texgen computes with proved error bounds, which need arithmetic as written: compile the files that include it with -fno-fast-math after -ffast-math or -Ofast, with /fp:precise in place of /fp:fast (they link with files that have it)."
#endif

// A sum that is kept in an 80-bit register and rounded twice is not the sum that the bounds are about.
#if (defined(__FLT_EVAL_METHOD__) && (__FLT_EVAL_METHOD__ < 0 || __FLT_EVAL_METHOD__ == 2)) || \
    (defined(_M_IX86_FP) && _M_IX86_FP < 2)
#error \
    "texgen computes with proved error bounds, which need float and double arithmetic in their own precision, not in that of the x87: compile with -msse2 -mfpmath=sse, or /arch:SSE2."
#endif

namespace TEXGEN_DETAIL {

inline constexpr double unit_roundoff_float = 0x1p-24;
inline constexpr double unit_roundoff_double = 0x1p-53;
inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// The smaller and the larger of two, b where one is a NaN. Unlike std::fmin and std::fmax these are one instruction.
constexpr double smaller(double a, double b) noexcept { return a < b ? a : b; }
constexpr double larger(double a, double b) noexcept { return a > b ? a : b; }
inline double magnitude(double a) noexcept { return std::fabs(a); }

// a / b; infinity where b is 0, without a division, as programs may trap that.
constexpr double ratio(double a, double b) noexcept { return b != 0.0 ? a / b : infinity; }

// The larger of two, and a NaN if either is one: for what must never be taken for small.
constexpr double larger_or_nan(double a, double b) noexcept { return a > b || !(a == a) ? a : b; }

inline bool is_finite(float value) noexcept { return std::fabs(value) <= 0x1.fffffep127f; }
inline bool is_finite(double value) noexcept { return std::fabs(value) <= 1.7976931348623157e308; }
template <glm::length_t N, class Scalar, glm::qualifier Q>
bool is_finite(const glm::vec<N, Scalar, Q>& v) noexcept {
    for (glm::length_t i = 0; i < N; ++i)
        if (!is_finite(v[i])) return false;
    return true;
}

constexpr int sign_of(double a) noexcept { return a > 0.0 ? 1 : a < 0.0 ? -1 : 0; }

// A power of two within a factor 2 of 1 / value, for a value that is normal and below 2^1022.
inline double reciprocal_power_of_two(double value) noexcept {
    return bit_cast<double>(0x7fe0000000000000 - (bit_cast<std::uint64_t>(value) & 0x7ff0000000000000));
}

// Exponents by their bits, as std::ilogb() and std::scalbn() are calls; only the ends of the range need those.
inline int exponent_of(double value) noexcept {
    const auto biased = static_cast<int>(bit_cast<std::uint64_t>(value) >> 52 & 0x7ff);
    return biased != 0 && biased != 0x7ff ? biased - 1023 : std::ilogb(value);
}
inline double times_power_of_two(double value, int exponent) noexcept {
    if (exponent < -1022 || exponent > 1023) return std::scalbn(value, exponent);
    return value * bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

// The value of the lowest bit of a number that is set; infinity for 0.
inline double last_bit(double value) noexcept {
    const auto bits = bit_cast<std::uint64_t>(value);
    if (bits << 1 == 0) return infinity;
    const int zeros = std::countr_zero(bits | std::uint64_t{1} << 52);
    const auto from_last = static_cast<double>(std::uint64_t{1} << zeros);  // integers
    return bit_cast<double>(bits & 0x7ff0000000000000) * (0x1p-52 * from_last);
}

// The first `Bits` bits. Times a float, 26 of them are exact, and so are the 27 behind those; 29 bits are as well.
template <int Bits>
double leading_bits(double value) noexcept {
    return bit_cast<double>(bit_cast<std::uint64_t>(value) & ~std::uint64_t{0} << (53 - Bits));
}

// The relative error of n roundings in sequence is at most gamma(n) = n u / (1 - n u). Here u is twice the unit
// roundoff, which leaves a factor of 2 to spare. Source: Higham, Accuracy and Stability of Numerical Algorithms, lemma
// 3.1.
constexpr double gamma(int n) noexcept {
    constexpr double u = 2.0 * unit_roundoff_double;
    return n * u / (1.0 - n * u);
}

// The most ulps by which numbers in double may err to be worth rounding to float: with more, too many are in doubt.
inline constexpr double quick_ulps = 0x1p13;
// A number of ulps that is larger than the given one, and 1 less than a power of two.
inline std::int32_t mask_of_ulps(double ulps) noexcept {
    return (1 << std::bit_width(static_cast<unsigned>(ulps) + 1)) - 1;
}

// A double and a bound on its distance from the number that it stands for.
struct Bounded {
    double value, error;
};

// The error of a nearest float up to `largest`: half an ulp of that; infinite, as the float is, from 2^128 - 2^103 on.
inline double half_ulp(double largest) noexcept {
    return largest < 0x1.ffffffp127 ? unit_roundoff_float * largest + 0x1p-150 : infinity;
}

// An unevaluated sum, or several in the lanes of vectors; high is the sum rounded to double.
template <class Number>
struct DoubleDoubleOf {
    Number high, low;
};
using DoubleDouble = DoubleDoubleOf<double>;

// Exactly a + b, for any order of magnitudes. Source: Knuth, TAOCP 2, 4.2.2 theorem B.
template <class Number>
DoubleDoubleOf<Number> two_sum(Number a, Number b) noexcept {
    const Number sum = a + b;
    const Number b_part = sum - a;
    return {sum, (a - (sum - b_part)) + (b - b_part)};
}

// The same where |b| <= |a|.
template <class Number>
DoubleDoubleOf<Number> quick_two_sum(Number a, Number b) noexcept {
    const Number sum = a + b;
    return {sum, b - (sum - a)};
}

// Exactly a * b where neither the product nor its last bit leaves the range of double. The product is a fused
// instruction where there is one, because GCC at -O3 may copy a plain product, and fuse one copy with a sum: that sum
// would have the exact product, and its error would be taken from the rounded one.
inline DoubleDouble two_product(double a, double b) noexcept {
#ifdef __FP_FAST_FMA
    const double product = std::fma(a, b, -0.0);
#else
    const double product = a * b;
#endif
    return {product, std::fma(a, b, -product)};
}

template <class Number>
DoubleDoubleOf<Number> operator-(const DoubleDoubleOf<Number>& a) noexcept {
    return {-a.high, -a.low};
}

// a + b within 2^-103 (|a| + |b|), and a b within 2^-103 |a b|. Source: Joldes, Muller, Popescu, Tight and Rigorous
// Error Bounds for Basic Building Blocks of Double-Word Arithmetic, ACM TOMS 44 (2017).
template <class Number>
DoubleDoubleOf<Number> sum(const DoubleDoubleOf<Number>& a, const DoubleDoubleOf<Number>& b) noexcept {
    const DoubleDoubleOf<Number> exact = two_sum(a.high, b.high);
    return quick_two_sum<Number>(exact.high, exact.low + (a.low + b.low));
}
inline DoubleDouble product(const DoubleDouble& a, const DoubleDouble& b) noexcept {
    const DoubleDouble exact = two_product(a.high, b.high);
    return quick_two_sum(exact.high, exact.low + (a.high * b.low + a.low * b.high));
}

// a + b c within 2^-104 (|a| + |b c|).
inline DoubleDouble add_product(DoubleDouble a, double b, double c) noexcept {
    const DoubleDouble product = two_product(b, c);
    const DoubleDouble sum = two_sum(a.high, product.high);
    return quick_two_sum(sum.high, sum.low + (a.low + product.low));
}

// a b - c d within 1.5 double ulp. Source: Kahan; Jeannerod, Louvet, Muller, Math. Comp. 82 (2013).
inline double difference_of_products(double a, double b, double c, double d) noexcept {
    const double cd = c * d;
    return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

}  // namespace TEXGEN_DETAIL
