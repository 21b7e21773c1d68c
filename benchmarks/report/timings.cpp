#include "timings.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include "chart.hpp"
#include "failure.hpp"
#include "files.hpp"
#include "html.hpp"

namespace report {

namespace {

constexpr std::string_view separator = " > ";

// "key": value of one line, without quotes and the comma.
std::optional<std::pair<std::string, std::string>> parse_line(std::string_view line) {
    const std::size_t key = line.find('"');
    const std::size_t key_end = line.find("\": ");
    if (key == line.npos || key_end == line.npos || key_end <= key) return std::nullopt;
    std::string_view value = line.substr(key_end + 3);
    while (!value.empty() && (value.back() == ',' || value.back() == '\r')) value.remove_suffix(1);
    if (value.size() >= 2 && value.front() == '"' && value.back() == '"') value = value.substr(1, value.size() - 2);
    return std::pair{std::string(line.substr(key + 1, key_end - key - 1)), std::string(value)};
}

// What one "{" to "}" of the file has said.
struct Entry {
    std::string run_name, aggregate;
    std::optional<double> cpu_time, elements, row, texels, ulp;

    void set(const std::string& key, const std::string& value) {
        if (key == "run_name") run_name = value;
        if (key == "aggregate_name") aggregate = value;
        for (auto& [name, number] : {std::pair{"cpu_time", &cpu_time}, std::pair{"elements", &elements},
                                     std::pair{"row", &row}, std::pair{"texels", &texels}, std::pair{"ulp", &ulp}}) {
            double parsed = 0;
            const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), parsed);
            if (key == name && error == std::errc() && end == value.data() + value.size() && std::isfinite(parsed))
                *number = parsed;
        }
    }

    std::optional<Timing> timing() const {
        const std::size_t middle = run_name.find(separator);
        if (aggregate != "median" || middle == run_name.npos || !cpu_time || !elements || !row || !(*elements > 0) ||
            !(*cpu_time > 0))
            return std::nullopt;
        return Timing{.number = *row,
                      .scene = run_name.substr(0, middle),
                      .variant = run_name.substr(middle + separator.size()),
                      .nanoseconds = *cpu_time / *elements,
                      .has_errors = texels && ulp,
                      .texels = texels.value_or(0),
                      .ulp = ulp.value_or(0)};
    }
};

// The two builds of every row, and two of rows of fragments alone.
enum Build { o2, native, avx2, clang };

const Timings* find(Build build, const std::vector<Timings>& builds, const std::vector<Timings>& others) {
    if (build == o2 || build == native) return build < builds.size() ? &builds[build] : nullptr;
    const auto found = std::ranges::find_if(others, [build](const Timings& other) {
        return build == clang ? other.compiler.starts_with("Clang") : other.flags.find("-mavx2") != other.flags.npos;
    });
    return found == others.end() ? nullptr : &*found;
}

// As the issue that set them says it: `than` must take at least `ratio` times as long as `variant`. Without `than` it
// is the nanoseconds that `variant` may take.
struct Promise {
    Build build;
    const char* scene;
    const char* variant;
    const char* than;
    double ratio;
};

using namespace way;
constexpr const char* barycentric = "GLM, barycentric";
constexpr const char* every_pair = "T_o and coverage() of every pair";
constexpr const char* stores = "floor: two store streams";
constexpr const char* copying = "floor: copying as many bytes";

constexpr Promise promises[] = {
    {native, "rows, triangles of 8x8 with set-up", exact_batch, planes, 1.2},
    {native, "rows, triangles of 8x8 with set-up", fine_batch, planes, 2.4},
    {o2, "rows, triangles of 8x8 with set-up", exact_batch, planes, 3},
    {o2, "rows, triangles of 8x8 with set-up", fine_batch, planes, 6},
    {native, "rows, triangles of 64x1 with set-up", exact_batch, planes, 1},
    {native, "rows, triangles of 64x1 with set-up", fine_batch, planes, 2},
    {native, "rows, 8x8 of a large triangle", exact, planes, 0.9},
    {native, "rows, 8x8 of a large triangle", fine, planes, 1.4},
    {o2, "rows, 8x8 of a large triangle", exact, planes, 2.4},
    {o2, "rows, 8x8 of a large triangle", fine, planes, 3.5},
    {native, "rows, triangles of 8x8 with set-up", exact, planes, 0.6},
    {native, "rows, triangles of 8x8 with set-up", fine, planes, 0.75},
    {native, "rows, set-up alone", fine, nullptr, 40},
    {native, "visibility buffer, 128x64, runs of 8", exact, planes_looked_up, 1.1},
    {native, "visibility buffer, 128x64, runs of 8", fine, planes_looked_up, 1.5},
    {native, "visibility buffer, 128x64, ids in any order", exact, planes_looked_up, 1},
    {native, "visibility buffer, 128x64, ids in any order", fine, planes_looked_up, 1.3},
    {native, "project interleaved, 1024", one_point, one_product, 0.1},
    {o2, "project interleaved, 1024", one_point, one_product, 0.1},
    {native, "Coverage, 4096 boxes, scattered", one_box, five_planes, 0.8},
    {native, "Coverage, 4096 boxes, scattered", one_question, five_planes, 0.12},
    {native, "Coverage, 4096 spheres, scattered", batch, five_planes, 1.1},
    {native, "rows, 1024x4, q/w by 1.3", fine, planes, 3.8},
    {native, "rows, 1024x4, q/w by 1.3", exact, planes, 1.1},
    {native, "rows, 1024x4, q/w by 1.3", exact, barycentric, 3.2},
    {o2, "rows, 1024x4, q/w by 1.3", fine, barycentric, 50},
    {o2, "rows, 1024x4, q/w by 1.3", exact, barycentric, 17},
    {native, "rows, 1024x4, q/w by 30", fine, planes, 3},
    {native, "rows, 1024x4, q/w by 30", exact, planes, 0.75},
    {native, "rows, 1024x4, q/w by 30", exact, barycentric, 2.2},
    {o2, "rows, 1024x4, q/w by 30", fine, barycentric, 42},
    {clang, "rows, 1024x4, q/w by 1.3", fine, planes, 2.8},
    {clang, "rows, 1024x4, q/w by 30", fine, planes, 2.4},
    {avx2, "rows, 1024x4, q/w by 1.3", fine, planes, 2.2},
    {avx2, "rows, 1024x4, q/w by 30", fine, planes, 2},
    {native, "project planar, 1024", coarse, product, 1.25},
    {native, "project planar, 1024", exact, product, 0.38},
    {native, "project planar, 1024", coarse_within, product, 1.7},
    {native, "project planar, 1024", exact_within, product, 0.42},
    {o2, "project planar, 1024", coarse, product, 40},
    {native, "project interleaved, 1024", coarse, product, 1.1},
    {native, "project interleaved, 1024", exact, product, 0.34},
    {native, "project interleaved, 1024", coarse_within, product, 1.4},
    {o2, "project interleaved, 1024", coarse, product, 32},
    {native, "segment, 1024", coarse, mix, 2.2},
    {native, "segment, 1024", exact, mix, 0.7},
    {o2, "segment, 1024", coarse, mix, 10},
    {native, "Frame, 2 000 objects x 100, of 256 points each", "texgen, 10 % lit", "texgen, 100 % lit", 1 / 0.2},
    {o2, "Frame, 2 000 objects x 100, of 256 points each", "texgen, 1 % lit", "texgen, 100 % lit", 1 / 0.03},
    {native, "rows, DRAM, 4096x4096, q/w by 1.3", exact, stores, 1 / 1.15},
    {native, "project planar, 16 M (DRAM)", exact, copying, 1 / 1.15},
    {o2, "Scene, 2 000 objects x 64", "texgen, 1 % of the objects move", every_pair, 20},
    {o2, "Coverage, 4096 boxes, scattered", batch, five_planes, 4},
    {o2, "Coverage, 4096 boxes, dense", batch, five_planes, 4},
    {o2, "Coverage, 4096 boxes, 1e5 from the origin", batch, five_planes, 4},
    {native, "Coverage, 4096 boxes, scattered", batch, five_planes, 4},
    {native, "Coverage, 4096 boxes, dense", batch, five_planes, 4},
    {native, "Coverage, 4096 boxes, 1e5 from the origin", batch, five_planes, 4},
};

struct Verdict {
    std::string build, scene, variant, than, promised, measured, possible, answer;
};

// What moving a scene's bytes takes: those that are read, too, where there is a row of that.
const Timing* floor_of(const Timings& build, const char* scene) {
    const Timing* copies = build.find(scene, copying);
    return copies != nullptr ? copies : build.find(scene, stores);
}

// Those of the promises whose rows were measured. What is possible is the peer's time over that of the floor.
std::vector<Verdict> verdicts_of(const std::vector<Timings>& builds, const std::vector<Timings>& others) {
    std::vector<Verdict> verdicts;
    for (const Promise& promise : promises) {
        const Timings* build = find(promise.build, builds, others);
        if (build == nullptr) continue;
        const Timing* ours = build->find(promise.scene, promise.variant);
        const Timing* than = promise.than == nullptr ? ours : build->find(promise.scene, promise.than);
        if (ours == nullptr || than == nullptr) continue;
        const std::string name = promise.build == clang ? "clang++ " + build->flags : build->flags;
        Verdict verdict{name, promise.scene, promise.variant, "", "", "", "", ""};
        if (promise.than == nullptr) {
            verdict.promised = formatted("%.0f ns", promise.ratio);
            verdict.measured = formatted("%.1f ns", ours->nanoseconds);
            verdict.answer = ours->nanoseconds <= promise.ratio ? "yes" : "no";
        } else {
            const double measured = than->nanoseconds / ours->nanoseconds;
            const Timing* floor = floor_of(*build, promise.scene);
            const double possible = floor != nullptr ? than->nanoseconds / floor->nanoseconds : HUGE_VAL;
            verdict.than = promise.than;
            verdict.promised = formatted("%.3gx", promise.ratio);
            verdict.measured = formatted("%.3gx", measured);
            if (floor != nullptr) verdict.possible = formatted("%.3gx", possible);
            verdict.answer = measured >= promise.ratio  ? "yes"
                             : possible < promise.ratio ? "no: beyond the bytes"
                                                        : "no";
        }
        verdicts.push_back(verdict);
    }
    return verdicts;
}

// Where a coarser tolerance takes clearly longer than a finer one.
std::vector<std::string> slower_stops(const std::vector<Timings>& builds) {
    constexpr double noise = 1.1;
    std::vector<std::string> lines;
    for (const Timings& build : builds) {
        for (auto row = build.rows.begin(); row != build.rows.end(); ++row) {
            if (!row->variant.starts_with("texgen")) continue;
            for (auto finer = build.rows.begin(); finer != row; ++finer) {
                if (finer->scene != row->scene || !finer->variant.starts_with("texgen") ||
                    row->nanoseconds <= noise * finer->nanoseconds)
                    continue;
                lines.push_back(build.flags + ": " + row->scene + ": " + row->variant +
                                formatted(" takes %.2f times as long as ", row->nanoseconds / finer->nanoseconds) +
                                finer->variant);
                break;
            }
        }
    }
    return lines;
}

bool is_ours(const Timing& row) { return row.variant.find("texgen") != row.variant.npos; }

// Without what each build has.
std::string short_flags(const Timings& build) { return build.flags.substr(0, build.flags.find(" -DNDEBUG")); }

// The row that a scene's others are compared with.
const Timing* baseline(const Timings& build, const std::string& scene) {
    const auto found = std::ranges::find_if(
        build.rows, [&](const Timing& row) { return row.scene == scene && row.variant.starts_with("GLM"); });
    return found == build.rows.end() ? nullptr : &*found;
}

std::string workload_of(const std::string& scene) { return scene.substr(0, scene.find(',')); }

std::vector<std::string> scenes_of(const std::vector<Timings>& builds) {
    std::vector<std::string> scenes;
    for (const Timing& row : builds.front().rows)
        if (std::ranges::find(scenes, row.scene) == scenes.end()) scenes.push_back(row.scene);
    return scenes;
}

std::string cells_of(const Timings& build, const std::string& scene, const std::string& variant) {
    const Timing* row = build.find(scene, variant);
    if (row == nullptr) return "<td></td><td></td><td></td><td></td>";
    const Timing* glm = baseline(build, scene);
    return "<td>" + formatted("%.3f", row->nanoseconds) + "</td><td>" +
           (glm == nullptr ? "" : formatted("%.2f", glm->nanoseconds / row->nanoseconds)) + "</td><td>" +
           (row->has_errors ? number(row->texels) : "") + "</td><td>" + (row->has_errors ? number(row->ulp) : "") +
           "</td>";
}

constexpr const char* explanation =
    "Each row computes what its scene asks for, is checked against the definitions in long double, and is then "
    "timed: medians of rounds in random order, in processor time, over inputs that change. A time is that of one "
    "element: a point, a value of alpha, a fragment; for the set-up a triangle. Matrices: T_o or T_e made anew, "
    "as floats, 1000 from the origin. Generate: points to s, t, r, q. Project: points to s/q, t/q. Segment: a "
    "segment at an array of alpha to s, t, by the C_u note's option (2), interpolate then divide, unless it says "
    "another. Rows: fragments of a triangle to s, t; q/w grows along the rows by the given factor, or not at all "
    "(parallel); set-up counts only where it says so. Coverage: a box or a sphere against one projector. Scene: "
    "an update, from frame to frame. Frame: an update and the coordinates of what is lit. Errors are the "
    "largest, in texels of 4096 and in units in the last place of float. Speed is relative to the first GLM row "
    "of the scene in the same run. Floors only move bytes.";

}  // namespace

const Timing* Timings::find(std::string_view scene, std::string_view variant) const {
    const auto found =
        std::ranges::find_if(rows, [&](const Timing& row) { return row.scene == scene && row.variant == variant; });
    return found == rows.end() ? nullptr : &*found;
}

Timings read_timings(const std::string& file) {
    std::istringstream text(read_file(file));
    Timings timings;
    Entry entry;
    for (std::string line; std::getline(text, line);) {
        if (line.find('{') != line.npos) entry = {};
        if (const auto pair = parse_line(line)) {
            if (pair->first == "compiler") timings.compiler = pair->second;
            if (pair->first == "flags") timings.flags = pair->second;
            entry.set(pair->first, pair->second);
        } else if (line.find('}') != line.npos) {
            if (const auto timing = entry.timing()) timings.rows.push_back(*timing);
            entry = {};
        }
    }
    if (timings.rows.empty()) throw Failure{"no timings in " + file};
    std::ranges::sort(timings.rows, {}, &Timing::number);
    return timings;
}

std::string table_of(const std::vector<Timings>& builds, const std::string& scene) {
    const std::vector<Timing>& rows = builds.front().rows;
    const bool has_errors =
        std::ranges::any_of(rows, [&](const Timing& row) { return row.scene == scene && row.has_errors; });
    std::string html = "<table>\n<tr><th>way</th>";
    for (const Timings& build : builds) html += "<th>" + unbroken(short_flags(build)) + "</th>";
    html += has_errors ? "<th>largest error</th></tr>\n" : "</tr>\n";
    for (const Timing& row : rows) {
        if (row.scene != scene || row.variant.starts_with("rejected")) continue;
        html += is_ours(row) ? "<tr class=\"library\"><td>" : "<tr><td>";
        html += escaped(row.variant) + "</td>";
        for (const Timings& build : builds) {
            const Timing* timing = build.find(scene, row.variant);
            html += "<td>" + (timing == nullptr ? "" : duration(timing->nanoseconds)) + "</td>";
        }
        if (has_errors) html += "<td>" + (row.has_errors ? number(row.texels) : "") + "</td>";
        html += "</tr>\n";
    }
    return html + "</table>\n";
}

std::string chart_of(const std::vector<Timings>& builds, const std::string& scene) {
    std::vector<Series> series;
    std::vector<Bar> bars;
    for (const Timings& build : builds) {
        for (const Timing& row : build.rows) {
            if (row.scene != scene) continue;
            if (&build == &builds.back()) bars.push_back({row.variant, row.nanoseconds});
            if (!row.has_errors) continue;
            const bool is_rejected = row.variant.starts_with("rejected");
            series.push_back({is_rejected ? "rejected ways" : row.variant,
                              &build == &builds.front() ? Series::Mark::ring : Series::Mark::dot,
                              {{row.nanoseconds, std::max(row.texels, 1e-6)}}});
        }
    }
    // Footprints have errors of which only some rows know.
    if (series.size() < bars.size())
        return bars_of(bars, "Compiled with " + short_flags(builds.back()) + "; a shorter bar is faster.");
    return chart_of(
        series, "nanoseconds an element", "largest error, texels of 4096",
        (builds.size() > 1 ? "Rings: " + short_flags(builds.front()) + ". Dots: " + short_flags(builds.back()) + ". "
                           : "") +
            "To the left is faster, further down more accurate.");
}

std::vector<Contest> contests_of(const std::vector<Timings>& builds, const std::string& scene, const std::string& ours,
                                 const std::string& theirs) {
    std::vector<Contest> contests;
    for (const Timings& build : builds) {
        const Timing* best = nullptr;
        for (const Timing& row : build.rows)
            if (row.scene == scene && (theirs.empty() || row.variant == theirs) && !is_ours(row) &&
                !row.variant.starts_with("rejected") && !row.variant.starts_with("floor") &&
                (best == nullptr || row.nanoseconds < best->nanoseconds))
                best = &row;
        const Timing* row = build.find(scene, ours);
        if (row != nullptr && best != nullptr) contests.push_back({short_flags(build), *row, *best});
    }
    return contests;
}

std::string text_of(const std::vector<Timings>& builds, const std::vector<Timings>& others) {
    std::string text;
    for (const Verdict& v : verdicts_of(builds, others))
        text +=
            formatted("%-26s %-34s %-28s %-29s %8s %8s %8s  %s\n", v.build.c_str(), v.scene.c_str(), v.variant.c_str(),
                      v.than.c_str(), v.promised.c_str(), v.measured.c_str(), v.possible.c_str(), v.answer.c_str());
    for (const std::string& line : slower_stops(builds)) text += line + "\n";
    return text;
}

std::string promises_of(const std::vector<Timings>& builds, const std::vector<Timings>& others) {
    if (builds.empty()) return {};
    std::string html =
        "<p>What the rows above were meant to reach, beside what they reach here. Possible is the peer's time over "
        "that "
        "of moving the bytes alone: where it is below the promise, no loop on this processor can keep it.</p>\n"
        "<div class=\"wide\"><table>\n"
        "<tr><th>scene</th><th>row</th><th>against</th><th>build</th><th>promised</th><th>measured</th>"
        "<th>possible</th><th>kept</th></tr>\n";
    for (const Verdict& v : verdicts_of(builds, others)) {
        html += "<tr>";
        for (const std::string* cell :
             {&v.scene, &v.variant, &v.than, &v.build, &v.promised, &v.measured, &v.possible, &v.answer})
            html += "<td>" + escaped(*cell) + "</td>";
        html += "</tr>\n";
    }
    html += "</table></div>\n";
    if (const std::vector<std::string> lines = slower_stops(builds); !lines.empty()) {
        html += "<p>Where accepting a larger error costs time:</p>\n<ul>\n";
        for (const std::string& line : lines) html += "<li>" + escaped(line) + "</li>\n";
        html += "</ul>\n";
    }

    return html;
}

std::string workloads_of(const std::vector<Timings>& builds) {
    if (builds.empty()) return {};
    std::string html = "<p>" + std::string(explanation) + "</p>\n";
    std::string header = "<tr><th></th>", names = "<tr><th>row</th>";
    for (const Timings& build : builds) {
        header += "<th colspan=\"4\">" + escaped(build.compiler + " " + build.flags) + "</th>";
        names += "<th>ns</th><th>speed</th><th>max texel</th><th>max ulp</th>";
    }
    header += "</tr>\n" + names + "</tr>\n";
    std::string workload;
    for (const std::string& scene : scenes_of(builds)) {
        if (workload_of(scene) != workload) {
            html += workload.empty() ? "" : "</table></div>\n";
            workload = workload_of(scene);
            html += "<h3>" + escaped(workload) + "</h3>\n<div class=\"wide\"><table>\n" + header;
        }
        html += formatted("<tr class=\"scene\"><td colspan=\"%zu\">", 1 + 4 * builds.size()) + escaped(scene) +
                "</td></tr>\n";
        for (const Timing& row : builds.front().rows) {
            if (row.scene != scene) continue;
            html += row.variant.starts_with("texgen") ? "<tr class=\"library\"><td>" : "<tr><td>";
            html += escaped(row.variant) + "</td>";
            for (const Timings& build : builds) html += cells_of(build, scene, row.variant);
            html += "</tr>\n";
        }
    }
    return html + "</table></div>\n";
}

}  // namespace report
