#pragma once

// The page's part of the benchmarks: what the files of Google Benchmark say, as tables and plots.

#include <string>
#include <string_view>
#include <vector>

namespace report {

// Ways, as the benchmarks call them.
namespace way {
inline constexpr const char* exact = "texgen, exact";
inline constexpr const char* fine = "texgen, 1/512 texel of 4096";
inline constexpr const char* coarse = "texgen, 1/16 texel of 1024";
inline constexpr const char* exact_within = "texgen, exact, within a box";
inline constexpr const char* coarse_within = "texgen, 1/16 texel of 1024, within a box";
inline constexpr const char* exact_batch = "texgen, exact, in a batch";
inline constexpr const char* fine_batch = "texgen, 1/512 texel of 4096, in a batch";
inline constexpr const char* one_point = "texgen, exact, one by one";
inline constexpr const char* batch = "texgen, a batch";
inline constexpr const char* one_box = "texgen, one box at a time";
inline constexpr const char* one_question = "texgen, one question";
inline constexpr const char* planes = "GLM, plane equations";
inline constexpr const char* planes_looked_up = "GLM, plane equations looked up";
inline constexpr const char* product = "GLM, mat4 * vec4";
inline constexpr const char* one_product = "GLM, mat4 * vec4, one by one";
inline constexpr const char* mix = "GLM, mix";
inline constexpr const char* five_planes = "GLM, five planes";
}  // namespace way

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

// A scene's ways and their times in each build, and how they lie against one another.
std::string table_of(const std::vector<Timings>& builds, const std::string& scene);
std::string chart_of(const std::vector<Timings>& builds, const std::string& scene);

// One of the library's ways and the fastest of the others', or the one that is named; one a build.
struct Contest {
    std::string flags;
    Timing ours, theirs;
};
std::vector<Contest> contests_of(const std::vector<Timings>& builds, const std::string& scene, const std::string& ours,
                                 const std::string& theirs = {});

// Promised against measured for a terminal; the others are further builds, of a few rows.
std::string text_of(const std::vector<Timings>& builds, const std::vector<Timings>& others);

// Parts of the page, nothing without builds: every row, and what was promised of some.
std::string workloads_of(const std::vector<Timings>& builds);
std::string promises_of(const std::vector<Timings>& builds, const std::vector<Timings>& others);

}  // namespace report
