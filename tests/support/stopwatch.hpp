#pragma once

// Times of calls, as the least of several: what else runs on the machine can only add to them.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "support/float_state.hpp"

namespace support {

// So many calls of a function with one input; empty for an input that the function may not be given.
using Calls = std::function<void(std::size_t)>;

// The compiler has to make the value, and to forget what memory holds.
template <class T>
void keep(const T& value) {
    asm volatile("" : : "r"(&value) : "memory");
}

// `body` as a loop of its own.
template <class Body>
Calls calls_of(Body body) {
    return [body](std::size_t count) mutable {
        for (std::size_t i = 0; i < count; ++i) {
            keep(body);
            body();
        }
    };
}

namespace detail {

inline double nanoseconds_of(const Calls& calls, std::size_t count) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    calls(count);
    return std::chrono::duration<double, std::nano>(Clock::now() - begin).count() / static_cast<double>(count);
}

inline double nanoseconds_of_products(double first, double second) {
    double least = std::numeric_limits<double>::infinity();
    for (int turn = 0; turn < 5; ++turn) {
        const Calls products = calls_of([factor = first, other = second] { keep(factor * other); });
        least = std::min(least, nanoseconds_of(products, 1000));
    }
    return least;
}

}  // namespace detail

// Some machines interrupt themselves for whatever has a subnormal number, for a hundred cycles and more: there they
// count as 0, so that the library is timed, and not the machine.
inline const FloatState& timed_state() {
    static const bool are_slow =
        detail::nanoseconds_of_products(0x1p-600, 0x1p-430) > 8.0 * detail::nanoseconds_of_products(1.5, 0x1p-430);
    return float_states[are_slow ? 1 : 0];
}

// The time of a call whose stack begins so many bytes deeper.
inline double nanoseconds_of(const Calls& calls, std::size_t count, std::size_t depth = 0) {
    double result = 0.0;
    keep(*static_cast<char*>(__builtin_alloca(depth + 1)));
    under(timed_state(), [&] { result = detail::nanoseconds_of(calls, count); });
    return result;
}

// As many calls as take about `nanoseconds`, were they interrupted once.
inline std::size_t calls_in(double nanoseconds, const Calls& calls) {
    std::size_t count = 1;
    while (count < (std::size_t{1} << 20)) {
        const double least = std::min(nanoseconds_of(calls, count), nanoseconds_of(calls, count));
        if (least * static_cast<double>(count) >= 0.5 * nanoseconds) break;
        count *= 2;
    }
    return count;
}

// The least time of a call of each, in turns from other depths of the stack: where a call writes there what lies a
// multiple of 4096 bytes from what it reads, some processors let the reads wait for the writes.
inline std::vector<double> least_times(const std::vector<Calls>& all, int turns, double nanoseconds = 2e4) {
    std::vector<std::size_t> count;
    for (const Calls& calls : all) count.push_back(calls_in(nanoseconds, calls));
    std::vector<double> least(all.size(), std::numeric_limits<double>::infinity());
    for (std::size_t turn = 0; turn < static_cast<std::size_t>(turns); ++turn)
        for (std::size_t i = 0; i < all.size(); ++i)
            least[i] = std::min(least[i], nanoseconds_of(all[i], count[i], turn * 272 % 4096));
    return least;
}

// The time of worst() over that of ordinary(), which do equally many elements, run in turns of about a millisecond;
// taken again while it is above the limit, which noise may do to one. Far below it, a look is enough.
template <class Ordinary, class Worst>
double worst_over_ordinary_within(double limit, Ordinary&& ordinary, Worst&& worst) {
    const std::vector<Calls> both{calls_of([&] { ordinary(); }), calls_of([&] { worst(); })};
    const std::vector<double> look = least_times(both, 5, 2e5);
    if (look[1] / look[0] <= 0.6 * limit) return look[1] / look[0];
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 5 && least > limit; ++i) {
        const std::vector<double> times = least_times(both, 15, 1e6);
        least = std::min(least, times[1] / times[0]);
    }
    return least;
}

}  // namespace support
