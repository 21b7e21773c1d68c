#pragma once

// Exact sums of doubles, for what double arithmetic cannot decide: the sign of q where its terms cancel, and a quotient
// that lies next to the middle of two floats.

#include <array>
#include <cstddef>

#include "rounding.hpp"

namespace TEXGEN_DETAIL {

// Adds a number to the exact value of `count` doubles that do not overlap, smallest first; returns how many they are then.
// One function for all capacities. Source: Shewchuk, Adaptive Precision Floating-Point Arithmetic, Grow-Expansion.
inline std::size_t grow(double* terms, std::size_t count, double term) noexcept {
    double carry = term;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const DoubleDouble sum = two_sum(carry, terms[i]);
        carry = sum.high;
        if (sum.low != 0.0) terms[kept++] = sum.low;
    }
    if (carry != 0.0) terms[kept++] = carry;
    return kept;
}

// The exact value of a sum, kept as at most Capacity doubles that do not overlap, smallest first.
// Exact while no product leaves 2^-960 .. 2^1000, which products of five floats cannot.
// Source: Shewchuk, Scale-Expansion.
template <std::size_t Capacity>
class Expansion {
public:
    Expansion() = default;
    template <std::size_t OtherCapacity>
    explicit Expansion(const Expansion<OtherCapacity>& other) noexcept : count_(other.count()) {
        for (std::size_t i = 0; i < count_; ++i) terms_[i] = other.term(i);
    }

    void add(double term) noexcept {
        if (term != 0.0) count_ = grow(terms_.data(), count_, term);
    }

    void add_product(double a, double b) noexcept {
        if (a == 0.0 || b == 0.0) return;
        const DoubleDouble product = two_product(a, b);
        for (const double term : {product.low, product.high}) add(term);
    }

    template <std::size_t OtherCapacity>
    void add_scaled(const Expansion<OtherCapacity>& other, double factor) noexcept {
        for (std::size_t i = 0; i < other.count(); ++i) add_product(other.term(i), factor);
    }

    std::size_t count() const noexcept { return count_; }
    double term(std::size_t i) const noexcept { return terms_[i]; }

    // Within a few ulp of the value: the terms do not overlap.
    double estimate() const noexcept {
        double sum = 0.0;
        for (std::size_t i = 0; i < count_; ++i) sum += terms_[i];
        return sum;
    }

    // Within 2^-104 of it.
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
    std::array<double, Capacity> terms_;  // not initialized: that would cost what a sum does
    std::size_t count_ = 0;
};

}  // namespace TEXGEN_DETAIL
