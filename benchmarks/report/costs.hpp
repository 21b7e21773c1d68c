#pragma once

// What the library costs to compile: headers alone and calls, as costs.cmake measured them.

#include <string>
#include <vector>

namespace report {

struct Cost {
    std::string name;
    std::string header;   // of a call, the one that has it; empty for a header alone
    double milliseconds;  // of the compiler's processor time
    double object_bytes;
    double code_bytes;  // 0 where it is not known
};

// Lines of name|header|milliseconds|object bytes|code bytes, GLM's headers first; none where nothing could be measured.
// Throws Failure for a line that is not of this kind.
std::vector<Cost> read_costs(const std::string& file);

// The table for a terminal, and a part of the page; nothing without costs.
std::string text_of(const std::vector<Cost>& costs);
std::string html_of(const std::vector<Cost>& costs);

}  // namespace report
