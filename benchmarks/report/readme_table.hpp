#pragma once

#include <string>

#include "page.hpp"

namespace report {

// The README's table of times and errors, its rows alone, as Markdown; nothing without the timings of two builds.
std::string readme_table_of(const Report& report);

}  // namespace report
