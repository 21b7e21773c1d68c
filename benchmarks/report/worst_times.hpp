#pragma once

// The page's part of texgen_worst: what the worst input found for a function costs over an ordinary one.

#include <string>
#include <vector>

namespace report {

struct WorstTime {
    std::string function, input;  // the input in words
    double ordinary, worst;       // nanoseconds a call
    double limit;                 // of worst over ordinary

    double ratio() const { return worst / ordinary; }
    bool is_met() const { return ratio() <= limit; }
};

// Lines of function|input|ordinary ns|worst ns|limit. Throws Failure for a line that is not of this kind.
std::vector<WorstTime> read_worst_times(const std::string& file);

// The table for a terminal, and a part of the page; nothing without times.
std::string text_of(const std::vector<WorstTime>& times);
std::string html_of(const std::vector<WorstTime>& times);

}  // namespace report
