#include "page.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "html.hpp"

namespace report {

namespace {

// 1234567 as 1 234 567.
std::string grouped(std::size_t count, const char* separator) {
    std::string digits = std::to_string(count);
    for (auto i = static_cast<std::ptrdiff_t>(digits.size()) - 3; i > 0; i -= 3)
        digits.insert(static_cast<std::size_t>(i), separator);
    return digits;
}

// Which work the library did, in percent of the fragments.
std::string work_of(const Comparison& comparison) {
    constexpr std::array names{"nothing", "affine", "quadratic", "divide", "divide and test"};
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (comparison.fragments_of_work[i] == 0) continue;
        const double percent = 100.0 * static_cast<double>(comparison.fragments_of_work[i]) /
                               static_cast<double>(comparison.evaluated_fragments);
        text += (text.empty() ? "" : ", ") + std::string(names[i]) + formatted(" %.1f%%", percent);
    }
    return text;
}

constexpr const char* style = R"(
body { font: 16px/1.5 system-ui, sans-serif; color: #1c1e24; background: #fff;
       max-width: 68rem; margin: 2rem auto; padding: 0 1rem; }
h1, h2 { line-height: 1.2; }
h2 { margin-top: 2.5rem; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: 0.15rem 0.8rem; text-align: right; border-bottom: 1px solid #dde; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
tr.scene td { text-align: left; font-weight: 600; padding: 0.9rem 0 0.15rem; }
tr.library td { background: #eef6ee; }
figure { margin: 0; flex: 1 1 24rem; }
figure img { width: 100%; display: block; }
figcaption { font-size: 0.9rem; margin-top: 0.4rem; }
figure.plot { max-width: 44rem; }
.pictures { display: flex; flex-wrap: wrap; gap: 1.5rem; }
.pictures figure:only-child { max-width: 42rem; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 0 1rem; }
dt { color: #667; } dd { margin: 0; }
details { margin-top: 0.8rem; } code { font-size: 0.8rem; overflow-wrap: anywhere; }
)";

constexpr const char* explanation =
    "Errors are those of s and t against the definitions in long double, over the fragments that the slide falls on: "
    "in texels of a 4096 texture, and in units in the last place of float where the coordinate is a texel or more "
    "away from 0. p99.9 is the error that one fragment in a thousand exceeds. A wrong decision is a fragment that is "
    "lit and should be dark, or the reverse. Times are medians of the interpolation alone, the set-up of the triangles "
    "included, in processor time; the loops take turns on the same list of triangles and rectangles. All are compiled "
    "with the flags above; the library's kernels choose the machine's instruction set at run time.";

}  // namespace

std::string text_of(const Report& report) {
    std::string text;
    for (const auto& [name, value] : report.circumstances) text += name + ": " + value + "\n";
    text += formatted("\n%-14s %-26s %11s %10s %10s %11s %10s %11s %8s\n", "scene", "loop", "fragments", "ns each",
                      "max texel", "p99.9 texel", "max ulp", "p99.9 ulp", "wrong");
    for (const SceneReport& scene : report.scenes) {
        for (const Measurement& measurement : scene.comparison.measurements) {
            const Errors& errors = measurement.errors;
            text += formatted("%-14s %-26s %11zu %10.3f %10s %11s %10s %11s %8zu\n", scene.name.c_str(),
                              measurement.method.c_str(), scene.comparison.evaluated_fragments, measurement.nanoseconds,
                              number(errors.max_texels).c_str(), number(errors.nearly_max_texels).c_str(),
                              number(errors.max_ulp).c_str(), number(errors.nearly_max_ulp).c_str(),
                              errors.wrong_decisions);
        }
    }
    text += "\n";
    for (const SceneReport& scene : report.scenes) text += scene.name + ": work: " + work_of(scene.comparison) + "\n";
    text += "\n";
    for (const SceneReport& scene : report.scenes)
        text += formatted("%s: %zu covered fragments checked, the library within %.6f ulp; at its worst ",
                          scene.name.c_str(), scene.comparison.covered_fragments, scene.comparison.largest_ulp) +
                in_hexadecimal(scene.comparison.largest_ulp_at) + "\n";
    return text;
}

std::string plot_of(const Report& report, const std::string& svg_file) {
    std::string script =
        "set terminal svg size 900,560 font 'sans-serif,14' background 'white'\n"
        "set output '" +
        svg_file +
        "'\n"
        "set logscale xy\n"
        "set format y '10^{%L}'\n"
        "set xlabel 'ns a fragment'\n"
        "set ylabel 'largest error, texels of 4096'\n"
        "set grid\n"
        "set key outside right top reverse Left\n";
    const auto& methods = report.scenes.front().comparison.measurements;
    for (std::size_t m = 0; m < methods.size(); ++m) {
        script += "$method" + std::to_string(m) + " << end\n";
        for (const SceneReport& scene : report.scenes) {
            const Measurement& measurement = scene.comparison.measurements[m];
            // A logarithmic axis has no 0.
            script += formatted("%.6g %.6g \"%s\"\n", measurement.nanoseconds,
                                std::max(measurement.errors.max_texels, 1e-6), scene.name.c_str());
        }
        script += "end\n";
    }
    script += "plot ";
    for (std::size_t m = 0; m < methods.size(); ++m)
        script += formatted("%s$method%zu using 1:2 with points pointtype %d pointsize 1.2 title '%s'",
                            m == 0 ? "" : ", \\\n     ", m, methods[m].method.starts_with("texgen") ? 7 : 6,
                            methods[m].method.c_str());
    return script + "\n";
}

std::string html_of(const Report& report, const std::string& plot_svg, const std::string& timings_html) {
    std::string html =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>texgen: report</title>\n"
        "<style>" +
        std::string(style) + "</style>\n</head>\n<body>\n<h1>texgen: pictures, run time and error</h1>\n<dl>\n";
    for (const auto& [name, value] : report.circumstances)
        html += "<dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd>\n";
    html += "</dl>\n<h2>Run time and error</h2>\n<p>" + std::string(explanation) +
            "</p>\n<table>\n"
            "<tr><th>loop</th><th>ns a fragment</th><th>max texel</th><th>p99.9 texel</th><th>max ulp</th>"
            "<th>p99.9 ulp</th><th>wrong decisions</th></tr>\n";
    for (const SceneReport& scene : report.scenes) {
        html += "<tr class=\"scene\"><td colspan=\"7\">" + escaped(scene.title) + ", " +
                grouped(scene.comparison.evaluated_fragments, "&#8239;") + " fragments</td></tr>\n";
        for (const Measurement& measurement : scene.comparison.measurements) {
            const Errors& errors = measurement.errors;
            const bool is_library = measurement.method.starts_with("texgen");
            html += std::string(is_library ? "<tr class=\"library\"><td>" : "<tr><td>") + escaped(measurement.method) +
                    "</td><td>" + formatted("%.3f", measurement.nanoseconds) + "</td><td>" + number(errors.max_texels) +
                    "</td><td>" + number(errors.nearly_max_texels) + "</td><td>" + number(errors.max_ulp) +
                    "</td><td>" + number(errors.nearly_max_ulp) + "</td><td>" +
                    grouped(errors.wrong_decisions, "&#8239;") + "</td></tr>\n";
        }
    }
    html += "</table>\n";
    html += figure(plot_svg, "Run time against error",
                   "One point a scene. To the left is faster, further down is more accurate.");
    html += timings_html;
    for (const SceneReport& scene : report.scenes) {
        html += "<h2>" + escaped(scene.title) + "</h2>\n<div class=\"pictures\">\n";
        for (const PictureOfScene& picture : scene.pictures)
            html += "<figure><img alt=\"" + escaped(picture.caption) + "\" src=\"data:image/png;base64," +
                    base64(picture.png) + "\"><figcaption>" + escaped(picture.caption) + "</figcaption></figure>\n";
        html +=
            "</div>\n<p>" +
            formatted(
                "%s covered fragments checked; wherever the library promises the nearest float, it is within %.6f ulp. "
                "The work of its exact tier: %s.",
                grouped(scene.comparison.covered_fragments, "&#8239;").c_str(), scene.comparison.largest_ulp,
                work_of(scene.comparison).c_str()) +
            "</p>\n<details><summary>The worst inputs</summary>\n";
        for (const Measurement& measurement : scene.comparison.measurements)
            html += "<p>" + escaped(measurement.method) + ", " + number(measurement.errors.max_texels) +
                    " texels:<br><code>" + in_hexadecimal(measurement.errors.worst) + "</code></p>\n";
        html += "</details>\n";
    }
    return html + "</body>\n</html>\n";
}

}  // namespace report
