#pragma once

// What the derivatives of a fragment are.

#include <cstddef>

#include <texgen/primitives.hpp>
#include <texgen/reference.hpp>

#include "bench.hpp"

namespace bench {

// d(s/q)/dx and so on by central differences of the definition in long double, within 1e-11 here.
struct Derivatives {
    double dx[2], dy[2];

    Derivatives(const texgen::Triangle& triangle, int x, int y) {
        constexpr long double step = 0x1p-16L;
        const auto quotient = [&](long double right, long double up) {
            return texgen::reference::quotient<long double>(
                texgen::reference::strq<long double>(triangle, x + 0.5L + right, y + 0.5L + up));
        };
        const auto right = quotient(step, 0), left = quotient(-step, 0), up = quotient(0, step),
                   down = quotient(0, -step);
        for (int k = 0; k < 2; ++k) {
            dx[k] = static_cast<double>((right[k] - left[k]) / (2 * step));
            dy[k] = static_cast<double>((up[k] - down[k]) / (2 * step));
        }
    }
};

// The first four outputs at fragment k of `count`.
inline void judge(const Derivatives& exact, std::size_t count, std::size_t k, Errors& errors) {
    for (std::size_t c = 0; c < 2; ++c) {
        errors.add(output(count, c)[k], exact.dx[c], 1e-10);
        errors.add(output(count, 2 + c)[k], exact.dy[c], 1e-10);
    }
}

}  // namespace bench
