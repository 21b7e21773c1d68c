#pragma once

// The inputs of promises: numbers that are floats, and after them doubles; begun anywhere, and moved by their bits.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "support/random.hpp"
#include "support/workloads/workload.hpp"

namespace adversary {

using support::Numbers;
using support::Random;

inline glm::vec4 floats4(const Numbers& n, std::size_t i) {
    return {static_cast<float>(n[i]), static_cast<float>(n[i + 1]), static_cast<float>(n[i + 2]),
            static_cast<float>(n[i + 3])};
}

inline double any_float(Random& random) {
    const double sign = random.coin() ? 1.0 : -1.0;
    switch (random.integer(0, 3)) {
        case 0:
            return sign * static_cast<double>(support::to_float(random.power_of_ten(-6.0, 6.0)));
        case 1:
            return static_cast<double>(random.integer(-8, 8));
        default:
            return random.uniform_float(-2.0, 2.0);
    }
}

inline Numbers any_floats(Random& random, std::size_t count) {
    Numbers numbers(count);
    for (double& number : numbers) number = any_float(random);
    return numbers;
}

inline double tolerance_of(double number) { return std::fabs(number); }
inline Numbers with_tolerance(Numbers numbers, Random& random) {
    numbers.push_back(random.power_of_ten(-8.0, -1.0));
    return numbers;
}

inline bool all_finite(const Numbers& n) {
    return std::all_of(n.begin(), n.end(), [](double x) { return std::isfinite(x); });
}

inline double moved(double number, bool is_float, Random& random) {
    const int width = is_float ? 32 : 64;
    const auto bits =
        is_float ? std::bit_cast<std::uint32_t>(static_cast<float>(number)) : std::bit_cast<std::uint64_t>(number);
    std::uint64_t next = bits;
    switch (random.integer(0, 3)) {
        case 0:
            next ^= std::uint64_t{1} << random.integer(0, width - 1);
            break;
        case 1:
            next += static_cast<std::uint64_t>(static_cast<std::int64_t>(random.integer(-3, 3)));
            break;
        case 2:
            next ^= std::uint64_t{1} << random.integer(0, width - 10);
            break;
        default:
            next += static_cast<std::uint64_t>(std::int64_t{random.integer(-2, 2)}) << random.integer(0, width - 10);
            break;
    }
    const double value = is_float ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(next)))
                                  : std::bit_cast<double>(next);
    return std::isfinite(value) ? value : number;
}

// One number changed, now and then two; or one taken from another place. The first of them are floats.
inline Numbers moved(std::size_t floats, Numbers numbers, Random& random) {
    const int last = static_cast<int>(numbers.size()) - 1;
    const int changes = random.integer(0, 3) == 0 ? 2 : 1;
    for (int change = 0; change < changes; ++change) {
        const auto i = static_cast<std::size_t>(random.integer(0, last));
        if (random.integer(0, 15) == 0 && i < floats)
            numbers[i] = numbers[static_cast<std::size_t>(random.integer(0, static_cast<int>(floats) - 1))];
        else
            numbers[i] = moved(numbers[i], i < floats, random);
    }
    return numbers;
}

inline glm::dmat4 float_matrix(const Numbers& n, std::size_t i) {
    return glm::dmat4(glm::mat4(floats4(n, i), floats4(n, i + 4), floats4(n, i + 8), floats4(n, i + 12)));
}
inline glm::dmat4 double_matrix(const Numbers& n, std::size_t i) {
    glm::dmat4 m(0.0);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) m[column][row] = n[i + static_cast<std::size_t>(4 * column + row)];
    return m;
}

inline bool is_in_range(const Numbers& n, double least, double largest) {
    return std::all_of(n.begin(), n.end(),
                       [&](double x) { return x == 0.0 || (std::fabs(x) >= least && std::fabs(x) <= largest); });
}

}  // namespace adversary
