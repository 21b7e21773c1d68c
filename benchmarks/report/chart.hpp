#pragma once

// The charts of the page, drawn by gnuplot. A series has one colour in all of them.

#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "files.hpp"

namespace report {

struct Series {
    enum class Mark { dot, ring, line, dashes };

    std::string name;
    Mark mark;
    std::vector<glm::dvec2> points;  // positive
};

// Both axes are logarithmic, and as long as the points need. The legend names each series once.
std::string chart_of(const std::vector<Series>& series, const std::string& x, const std::string& y,
                     const std::string& caption);

// A bar as long as each time, from 0.
struct Bar {
    std::string name;
    double nanoseconds;
};
std::string bars_of(const std::vector<Bar>& bars, const std::string& caption);

// What those return is to be drawn yet. Here one run of gnuplot in the given folder puts SVG into the text of the page;
// where it is missing or fails, no_chart stands in the place of each chart.
std::string with_charts_drawn(const std::string& page, const Staging& folder);
inline constexpr const char* no_chart = "No chart: gnuplot is missing or failed.";

// By what the series is called: the library's tolerances, then what others write.
const char* colour_of(std::string_view series);

}  // namespace report
