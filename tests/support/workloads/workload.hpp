#pragma once

// What a workload is: a function with an ordinary input, and with inputs that are meant to take long. An input is a
// list of numbers, floats first and doubles after them, so that a search can change their bits and print them.

#include <cstddef>
#include <string_view>
#include <vector>

#include "support/limits.hpp"
#include "support/random.hpp"
#include "support/stopwatch.hpp"

namespace support {

using Numbers = std::vector<double>;

// Inputs of one kind.
struct Inputs {
    std::size_t floats;            // as many of an input's numbers
    Numbers (*ordinary)(Random&);  // what a user's program gives
    Numbers (*draw)(Random&);      // what is meant to take long, where a search begins
    const char* words;             // of what is drawn
};

struct Workload {
    const char* function;
    Inputs inputs;
    Calls (*calls)(const Numbers&);  // empty where the numbers break a precondition, or there is nothing to do
    double (*limit)(const Numbers&) = [](const Numbers&) { return limit::any; };

    // Interpolates 64 x 4 fragments of a triangle.
    bool takes_near_cuts() const {
        const std::string_view name = function;
        return name.starts_with("interpolate a triangle") && name.ends_with("64 x 4");
    }
};

}  // namespace support
