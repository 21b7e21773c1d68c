#pragma once

// The page's part of the benchmarks: what the files of Google Benchmark say, as tables and plots.

#include <string>
#include <string_view>
#include <vector>

namespace report {

struct Timing {
    double number;  // rows in the order of the benchmark
    std::string scene, variant;
    double nanoseconds;  // an element, in processor time
    bool has_errors;
    double texels, ulp;
};

// One build of the benchmarks.
struct Timings {
    std::string compiler, flags;
    std::vector<Timing> rows;

    const Timing* find(std::string_view scene, std::string_view variant) const;
};

// From Google Benchmark's JSON. Throws Failure where it has no medians of rows that are named as the benchmarks' are.
Timings read_timings(const std::string& file);

struct TimingsPlot {
    std::string title;
    std::string name;    // of the files
    std::string script;  // of gnuplot; it draws into name.svg
    std::string svg;     // the picture, once it is drawn
};

// Run time against error with the Pareto front: the scenes of 1024 elements, each build.
std::vector<TimingsPlot> plots_of(const std::vector<Timings>& builds);

// Promised against measured for a terminal.
std::string text_of(const std::vector<Timings>& builds);

// A part of the page; nothing without builds.
std::string html_of(const std::vector<Timings>& builds, const std::vector<TimingsPlot>& plots);

}  // namespace report
