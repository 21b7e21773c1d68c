#include "timings.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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
