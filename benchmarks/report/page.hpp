#pragma once

#include <string>
#include <utility>
#include <vector>

#include "compare.hpp"

namespace report {

struct PictureOfScene {
    std::string file, caption, png;
};

struct SceneReport {
    std::string name, title;
    Comparison comparison;
    std::vector<PictureOfScene> pictures;
};

struct Report {
    std::vector<std::pair<std::string, std::string>> circumstances;  // compiler, flags, machine, ...
    std::vector<SceneReport> scenes;
};

// The table for a terminal, and where the library was at its worst.
std::string text_of(const Report& report);

// A gnuplot script, its data included, that draws time against error into `svg_file`.
std::string plot_of(const Report& report, const std::string& svg_file);

// The page, which needs no other file. `plot_svg` may be empty; `timings_html` goes between the table and the pictures.
std::string html_of(const Report& report, const std::string& plot_svg, const std::string& timings_html);

}  // namespace report
