#pragma once

// A workload's inputs against its ordinary ones, in turns in one process.

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <istream>
#include <string>
#include <vector>

#include "random.hpp"
#include "stopwatch.hpp"
#include "workloads.hpp"

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
        for (int i = 0; i < 6; ++i) ordinary_.push_back(workload.calls(workload.ordinary(random)));
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
        const double limit = workload_.limit(numbers);
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

// An input that a search found: a line of function | words | numbers in hexadecimal.
struct RecordedInput {
    std::string function, words;
    Numbers numbers;
};

inline std::vector<RecordedInput> read_inputs(std::istream& lines) {
    std::vector<RecordedInput> inputs;
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = line.find(" | ");
        const std::size_t second = first == std::string::npos ? first : line.find(" | ", first + 3);
        if (second == std::string::npos) continue;
        RecordedInput input{line.substr(0, first), line.substr(first + 3, second - first - 3), {}};
        const char* next = line.c_str() + second + 3;
        for (char* end = nullptr;; next = end) {
            const double number = std::strtod(next, &end);
            if (end == next) break;
            input.numbers.push_back(number);
        }
        inputs.push_back(input);
    }
    return inputs;
}

}  // namespace support
