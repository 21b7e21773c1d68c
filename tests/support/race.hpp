#pragma once

// A workload's inputs against its ordinary ones, in turns in one process.

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <istream>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/random.hpp"
#include "support/stopwatch.hpp"
#include "support/workloads.hpp"

namespace support {

// What a call takes, in nanoseconds, with the ordinary inputs on the average and with one of another kind.
struct Slowness {
    double ordinary = 1.0, hostile = 0.0;

    double ratio() const { return hostile / ordinary; }
};

class Race {
public:
    explicit Race(const Workload& workload) : workload_(workload) {
        Random random(2024);
        for (int i = 0; i < 6; ++i) ordinary_.push_back(workload.calls(workload.inputs.ordinary(random)));
        const std::vector<double> times = least_times(ordinary_, 9);
        for (const double time : times) ordinary_time_ += time / static_cast<double>(times.size());
    }

    // A look that may be wrong on a busy machine; 0 where there is nothing to call.
    double glance(const Numbers& numbers) const {
        const Calls calls = workload_.calls(numbers);
        if (!calls) return 0.0;
        const std::size_t count = ordinary_time_ < 200.0 ? 32 : 2;
        double least = nanoseconds_of(calls, 1);
        for (int turn = 0; turn < 3; ++turn)
            least = std::min(least, nanoseconds_of(calls, least < 40.0 * ordinary_time_ ? count : 1));
        return least / ordinary_time_;
    }

    Slowness measure(const Numbers& numbers, int turns = 15) const {
        std::vector<Calls> all = ordinary_;
        all.push_back(workload_.calls(numbers));
        const std::vector<double> times = least_times(all, turns, 1e4);
        Slowness slowness{0.0, times.back()};
        for (std::size_t i = 0; i + 1 < times.size(); ++i)
            slowness.ordinary += times[i] / static_cast<double>(times.size() - 1);
        return slowness;
    }

private:
    const Workload& workload_;
    std::vector<Calls> ordinary_;
    double ordinary_time_ = 0.0;
};

// An input with the limit that holds for it, and what it is in words.
struct SlowInput {
    double limit;
    Slowness slowness;
    Numbers numbers;
    std::string words;
};

// The slowest inputs of a workload, one for each of its limits.
class Slowest {
public:
    Slowest(const Workload& workload, const Race& race) : workload_(workload), race_(race) {}

    // Measures an input that looks as slow as the slowest.
    void offer(const Numbers& numbers, double glance, const std::string& words) {
        if (!(glance > 0.0)) return;
        const double limit = workload_.limit(numbers) * limit::times_by_vectors();
        const auto found =
            std::find_if(inputs_.begin(), inputs_.end(), [&](const SlowInput& i) { return i.limit == limit; });
        if (found != inputs_.end() && glance <= 1.05 * found->slowness.ratio()) return;
        const SlowInput input{limit, race_.measure(numbers), numbers, words};
        if (found == inputs_.end())
            inputs_.push_back(input);
        else if (input.slowness.ratio() > found->slowness.ratio())
            *found = input;
    }

    const std::vector<SlowInput>& inputs() const { return inputs_; }

private:
    const Workload& workload_;
    const Race& race_;
    std::vector<SlowInput> inputs_;
};

// Triangles that the near plane has cut, each in all orders of its corners: the slowest of them, the one that 99 of 100
// do not exceed, and the slowest order of a triangle's corners over its fastest. One of 60 tiles of theirs is crossed
// by q = 0, which has a limit of its own: the slowest of those stands apart.
struct NearCutTimes {
    Slowness slowest, of_99_in_100, rotation, crossed;
};

inline NearCutTimes race_near_cuts(const Workload& workload, std::size_t triangles) {
    Random random(3);
    constexpr std::size_t ordinary_count = 3;
    std::vector<Calls> ordinary;
    for (std::size_t i = 0; i < ordinary_count; ++i)
        ordinary.push_back(workload.calls(detail::ordinary_triangle(random)));
    const auto is_less = [](const Slowness& a, const Slowness& b) { return a.ratio() < b.ratio(); };
    std::vector<Slowness> times, rotations;
    Slowness crossed;
    while (rotations.size() < triangles || crossed.hostile == 0.0) {
        const NearCut cut = near_cut(random);
        std::vector<Calls> all = ordinary;
        bool is_crossed = false;
        for (int by = 0; by < 3; ++by) {
            const Numbers numbers = detail::numbers(rotated(cut.triangle, by), static_cast<float>(cut.rect.x),
                                                    static_cast<float>(cut.rect.y));
            is_crossed = is_crossed || workload.limit(numbers) == limit::q_is_zero;
            all.push_back(workload.calls(numbers));
        }
        const std::vector<double> least = least_times(all, 7, 5e3);
        const auto first = least.begin() + ordinary_count;
        if (is_crossed) {
            const double of_ordinary = (least[0] + least[1] + least[2]) / 3.0;
            crossed = std::max(crossed, {of_ordinary, *std::max_element(first, least.end())}, is_less);
            continue;
        }
        for (auto time = first; time != least.end(); ++time)
            times.push_back({(least[0] + least[1] + least[2]) / 3.0, *time});
        const auto [fastest, slowest] = std::minmax_element(first, least.end());
        rotations.push_back({*fastest, *slowest});
    }
    std::sort(times.begin(), times.end(), is_less);
    return {times.back(), times[times.size() * 99 / 100],
            *std::max_element(rotations.begin(), rotations.end(), is_less), crossed};
}

// An input that a search found: a line of function | words | numbers in hexadecimal.
struct RecordedInput {
    std::string function, words;
    Numbers numbers;
};

// Throws where there are none, or a line names no workload, has not as many numbers as it takes or measures nothing.
inline std::vector<RecordedInput> read_inputs(std::istream& lines) {
    std::vector<RecordedInput> inputs;
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = line.find(" | ");
        const std::size_t second = line.find(" | ", first == std::string::npos ? first : first + 3);
        if (second == std::string::npos) throw std::runtime_error("no recorded input: " + line);
        RecordedInput input{line.substr(0, first), line.substr(first + 3, second - first - 3), {}};
        const char* next = line.c_str() + second + 3;
        for (char* end = nullptr;; next = end) {
            const double number = std::strtod(next, &end);
            if (end == next) break;
            input.numbers.push_back(number);
        }
        const auto workload = std::find_if(workloads.begin(), workloads.end(),
                                           [&](const Workload& w) { return input.function == w.function; });
        Random random(1);
        if (workload == workloads.end() || workload->inputs.draw(random).size() != input.numbers.size() ||
            !workload->calls(input.numbers))
            throw std::runtime_error("no recorded input: " + line);
        inputs.push_back(input);
    }
    if (inputs.empty()) throw std::runtime_error("no recorded inputs");
    return inputs;
}

}  // namespace support
