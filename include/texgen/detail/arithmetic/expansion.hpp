#pragma once

// Exact sums of doubles, for what double arithmetic cannot decide: the sign of q where its terms cancel, and a quotient
// that lies next to the middle of two floats.

#include <array>
#include <cstddef>

#include "../language.hpp"
#include "rounding.hpp"

namespace TEXGEN_DETAIL {

// The two functions below serve expansions of every capacity. An expansion is an exact value as an array of doubles
// that do not overlap, smallest first; each function returns its new count. Source: Shewchuk, Adaptive Precision
// Floating-Point Arithmetic and Fast Robust Geometric Predicates.

// Adds a number to the terms from `first` on (Grow-Expansion). The new first of these is no larger than the number, so
// that another number that is larger and does not overlap it leaves that term: `first` steps over it (Expansion-Sum).
inline std::size_t grow(double* terms, std::size_t count, double term, std::size_t& first) noexcept {
    if (term == 0.0) return count;
    const std::size_t begin = first;
    std::size_t kept = begin;
    double carry = term;
    for (std::size_t i = begin; i < count; ++i) {
        const DoubleDouble sum = two_sum(carry, terms[i]);
        carry = sum.high;
        if (sum.low == 0.0) continue;
        if (i == begin) ++first;
        terms[kept++] = sum.low;
    }
    if (carry != 0.0) terms[kept++] = carry;
    return kept;
}

// Adds `factor` times another expansion (Scale-Expansion).
TEXGEN_APART inline std::size_t grow_by_multiple(double* terms, std::size_t count, const double* other,
                                                 std::size_t other_count, double factor) noexcept {
    std::size_t first = 0;
    double carry = 0.0;
    for (std::size_t i = 0; i < other_count; ++i) {
        const DoubleDouble product = two_product(other[i], factor);
        const DoubleDouble low = two_sum(carry, product.low);
        const DoubleDouble high = quick_two_sum(product.high, low.high);
        for (const double term : {low.low, high.low}) count = grow(terms, count, term, first);
        carry = high.high;
    }
    return grow(terms, count, carry, first);
}

// The exact value of a sum, kept as at most Capacity doubles that do not overlap, smallest first.
// Exact while no product leaves 2^-960 .. 2^1000; no product of five floats does.
template <std::size_t Capacity>
class Expansion {
public:
    Expansion() = default;
    template <std::size_t OtherCapacity>
    explicit Expansion(const Expansion<OtherCapacity>& other) noexcept : count_(other.count()) {
        for (std::size_t i = 0; i < count_; ++i) terms_[i] = other.terms()[i];
    }

    void add(double term) noexcept {
        std::size_t first = 0;
        count_ = grow(terms_.data(), count_, term, first);
    }

    void add_product(double a, double b) noexcept {
        if (a == 0.0 || b == 0.0) return;
        const DoubleDouble product = two_product(a, b);
        for (const double term : {product.low, product.high}) add(term);
    }

    void add_product(const DoubleDouble& a, const DoubleDouble& b) noexcept {
        for (const double part : {a.low, a.high}) {
            if (part == 0.0) continue;
            add_product(part, b.low);
            add_product(part, b.high);
        }
    }

    template <std::size_t OtherCapacity>
    void add_scaled(const Expansion<OtherCapacity>& other, double factor) noexcept {
        count_ = grow_by_multiple(terms_.data(), count_, other.terms(), other.count(), factor);
    }

    std::size_t count() const noexcept { return count_; }
    const double* terms() const noexcept { return terms_.data(); }

    // Within a few ulp of the value: the terms do not overlap.
    double estimate() const noexcept {
        double sum = 0.0;
        for (std::size_t i = 0; i < count_; ++i) sum += terms_[i];
        return sum;
    }

    // The value in two doubles, to a relative error of 2^-104.
    DoubleDouble leading() const noexcept {
        DoubleDouble result{};
        for (std::size_t i = count_; i-- > 0;) {
            const DoubleDouble sum = two_sum(result.high, terms_[i]);
            result = {sum.high, result.low + sum.low};
        }
        return quick_two_sum(result.high, result.low);
    }

    // -1, 0 or 1, exactly.
    int sign() const noexcept { return count_ == 0 ? 0 : terms_[count_ - 1] > 0.0 ? 1 : -1; }

private:
    std::array<double, Capacity> terms_;  // not initialized: to clear them takes as long as a sum
    std::size_t count_ = 0;
};

}  // namespace TEXGEN_DETAIL
