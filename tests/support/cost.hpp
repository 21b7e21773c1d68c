#pragma once

// What an input costs beside another one, as a ratio of times that were taken in turn: a busy machine slows both.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>

namespace support {

// The time of one call, over several.
template <class Function>
double seconds_of(Function& function, std::size_t calls) {
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < calls; ++i) function();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / static_cast<double>(calls);
}

// Calls that take about a millisecond together.
template <class Function>
std::size_t calls_of_a_millisecond(Function& function) {
    std::size_t calls = 1;
    for (; seconds_of(function, calls) * static_cast<double>(calls) < 0.5e-3; calls *= 2) continue;
    return calls;
}

// The time of worst() over that of ordinary(), which do equally many elements: the median over rounds in which both run
// in turn for about a millisecond.
template <class Ordinary, class Worst>
double worst_over_ordinary(Ordinary&& ordinary, Worst&& worst) {
    const std::size_t ordinary_calls = calls_of_a_millisecond(ordinary);
    const std::size_t worst_calls = calls_of_a_millisecond(worst);
    std::array<double, 15> ratios{};
    for (double& ratio : ratios) {
        const double of_ordinary = seconds_of(ordinary, ordinary_calls);
        ratio = seconds_of(worst, worst_calls) / of_ordinary;
    }
    std::nth_element(ratios.begin(), ratios.begin() + ratios.size() / 2, ratios.end());
    return ratios[ratios.size() / 2];
}

// The same, the least of up to five medians: taken again while it is above the limit, which noise may do to one.
template <class Ordinary, class Worst>
double worst_over_ordinary_within(double limit, Ordinary&& ordinary, Worst&& worst) {
    double least = worst_over_ordinary(ordinary, worst);
    for (int i = 1; i < 5 && least > limit; ++i) least = std::min(least, worst_over_ordinary(ordinary, worst));
    return least;
}

}  // namespace support
