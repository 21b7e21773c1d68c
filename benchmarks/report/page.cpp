#include "page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "html.hpp"

namespace report {

namespace {

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
       max-width: 70rem; margin: 1.5rem auto; padding: 0 1rem; }
h1, h2, h3 { line-height: 1.2; } h1 { margin: 0; } h2 { margin-top: 3rem; } h3 { margin-top: 2rem; }
.lead { font-size: 1.15rem; margin: 0.3rem 0 1rem; }
.first, .task, .pictures { display: grid; gap: 1.5rem; grid-template-columns: repeat(auto-fit, minmax(min(100%, 20rem), 1fr)); }
.first { grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr)); }
.pairs { grid-template-columns: repeat(auto-fit, minmax(min(100%, 20rem), 25rem)); }
.first > *, .task > *, .pictures > * { min-width: 0; }
.first ul { margin: 0; padding-left: 1.2rem; } .first li { margin-bottom: 0.8rem; }
.pictures figure { max-width: 25rem; }
figure { margin: 0; } .chart { max-width: 36rem; } figure img, .chart > svg { width: 100%; display: block; }
figcaption { font-size: 0.9rem; margin-top: 0.4rem; color: #444a55; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 0.92rem; }
th, td { padding: 0.15rem 0.5rem; text-align: right; border-bottom: 1px solid #dde; }
td { white-space: nowrap; } th:first-child, td:first-child { white-space: normal; text-align: left; padding-left: 0; }
tr.scene td { text-align: left; font-weight: 600; padding: 0.9rem 0 0.15rem; }
tr.library td { background: #eaf3fb; }
.wide { overflow-x: auto; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 0 1rem; } dt { color: #667; } dd { margin: 0; }
details { margin-top: 0.6rem; } summary { cursor: pointer; } code { font-size: 0.8rem; overflow-wrap: anywhere; }
@media (max-width: 32rem) { table { font-size: 0.8rem; } th, td { padding: 0.15rem 0.25rem; } }
)";

constexpr const char* explanation =
    "Errors are those of s and t against the definitions in long double, over the fragments that the slide falls on: "
    "in texels of a 4096 texture, and in units in the last place of float where the coordinate is a texel or more "
    "away from 0. p99.9 is the error that one fragment in a thousand exceeds. A wrong decision is a fragment that is "
    "lit and should be dark, or the reverse; the loops of others know no depth of a region, and are judged without. "
    "Times are medians of the interpolation alone, the set-up of the triangles "
    "included, in processor time; the loops take turns on the same list of triangles and rectangles. All are compiled "
    "with the flags named last; the library's kernels choose the machine's instruction set at run time.";

// What a reader wants done, and the workload that shows it.
struct Task {
    const char* title;
    const char* sentence;
    const char* scene;
    const char* ours;  // of the library's ways the one that stands beside the others': as accurate as they try to be
};

using way::fine;

constexpr Task points{"Points", "1024 positions in the world become s and t; each coordinate has an array of its own.",
                      "project planar, 1024", fine};
constexpr Task rows{
    "Rows of fragments",
    "The fragments of 4 rows of 1024 inside a triangle become s and t; q/w grows by a factor of 1.3 along "
    "them. An element is a fragment.",
    "rows, 1024x4, q/w by 1.3", fine};
constexpr Task small_triangles{"Small triangles",
                               "Triangles of 8 by 8 fragments, each of them set up first. An element is a fragment.",
                               "rows, triangles of 8x8 with set-up", way::fine_batch};
constexpr Task bodies{
    "Bodies",
    "Which of 4096 boxes does the slide of a projector miss, touch or cover? The library never leaves out "
    "one that is lit; five planes in float may. An element is a box.",
    "Coverage, 4096 boxes, scattered", way::batch};
constexpr Task scenes{
    "Scenes",
    "Which of 2000 objects do 64 projectors light, from one frame to the next? An element is a frame's "
    "update.",
    "Scene, 2 000 objects x 64", "texgen, 1 % of the objects move"};
constexpr Task footprints{
    "Footprints",
    "How large is a fragment on the slide? The derivatives of s and t and the level of detail, beside "
    "s and t alone. An element is a fragment.",
    "Footprints, 1024x16, q/w by 1.3", ""};
// What is asked of the library one at a time or in any order, where there is a faster way.
struct SlowWay {
    const char *title, *scene, *ours, *theirs;  // theirs: the fastest, where it is empty
};
constexpr SlowWay slow_ways[] = {
    {"Points, one a call", "project interleaved, 1024", way::one_point, way::one_product},
    {"Small triangles, a set-up each", "rows, triangles of 8x8 with set-up", fine, ""},
    {"A visibility buffer, ids in any order", "visibility buffer, 128x64, ids in any order", way::exact, ""},
    {"Boxes, one a call", "Coverage, 4096 boxes, scattered", way::one_box, ""}};

constexpr const Task* tasks[] = {&points, &rows, &small_triangles, &bodies, &scenes, &footprints};

std::string figure(const PictureOfScene& picture, const std::string& title) {
    const char* type = picture.embedded.starts_with("\x89PNG") ? "png" : "jpeg";
    return "<figure><a href=\"" + picture.file + "\"><img alt=\"" + escaped(title) + "\" src=\"data:image/" + type +
           ";base64," + base64(picture.embedded) + "\"></a><figcaption>" + escaped(picture.caption) +
           "</figcaption></figure>\n";
}

std::string figures(const std::vector<PictureOfScene>& pictures, const std::string& title) {
    std::string html = pictures.size() % 3 != 0 && pictures.size() % 2 == 0 ? "<div class=\"pictures pairs\">\n"
                                                                            : "<div class=\"pictures\">\n";
    for (const PictureOfScene& picture : pictures) html += figure(picture, title);
    return html + "</div>\n";
}

std::vector<Contest> contests_of(const Report& report, const Task& task) {
    return contests_of(report.timings, task.scene, task.ours);
}

std::string contest_of(const Report& report, const Task& task) {
    std::string text;
    for (const Contest& contest : contests_of(report, task)) {
        const double ratio = contest.theirs.nanoseconds / contest.ours.nanoseconds;
        text += "With " + unbroken(contest.flags) + " " + escaped(contest.ours.variant) + " is " +
                (ratio < 1 / 1.03 ? formatted("<b>not the fastest</b>: it takes %.2f times as long as ", 1 / ratio)
                                  : formatted("%.3g times as fast as ", ratio)) +
                escaped(contest.theirs.variant) + ". ";
    }
    return text.empty() ? "" : "<p>" + text + "</p>\n";
}

// From which size on each of the library's ways is the faster one.
std::string crossings_of(const std::vector<Series>& series) {
    const auto is_library = [](const Series& s) { return s.name.starts_with("texgen"); };
    std::string html =
        "<p>So large a triangle, in fragments of its rectangle, takes no longer than in the loops of others, nor does "
        "any "
        "larger one:</p>\n<ul>\n";
    for (const Series& theirs : series) {
        if (is_library(theirs)) continue;
        std::string ways;
        for (const Series& ours : series) {
            if (!is_library(ours)) continue;
            const std::optional<double> at = overtakes_at(ours, theirs);
            ways += (ways.empty() ? "" : "; ") + escaped(ours.name) + ": " +
                    (!at        ? "none up to " + formatted("%g", ours.points.back().x)
                     : *at <= 1 ? "any"
                                : formatted("%.0f", *at));
        }
        html += "<li>" + escaped(theirs.name) + " \u2013 " + ways + "</li>\n";
    }
    return html + "</ul>\n";
}

std::string section_of(const Report& report, const Task& task) {
    const bool is_measured = std::ranges::any_of(report.timings, [&](const Timings& build) {
        return std::ranges::count(build.rows, task.scene, &Timing::scene);
    });
    std::string chart;
    if (&task == &small_triangles)
        chart = chart_of(report.times_by_size, "fragments of the triangle's rectangle", "nanoseconds a triangle",
                         "A triangle with its set-up against its size; compiled with the flags of the pictures.");
    else if (is_measured)
        chart = chart_of(report.timings, task.scene);
    if (chart.empty() && &task != &scenes) return {};
    std::string html =
        "<h3>" + std::string(task.title) + "</h3>\n<p>" + task.sentence + "</p>\n<div class=\"task\"><div>\n";
    if (is_measured) html += table_of(report.timings, task.scene) + contest_of(report, task);
    if (&task == &small_triangles) html += crossings_of(report.times_by_size);
    html += "</div>\n" + chart + "</div>\n";
    if (&task == &scenes) html += html_of(report.room);
    return html;
}

std::string errors_of(const Report& report) {
    std::string html = "<p>" + std::string(explanation) +
                       "</p>\n<div class=\"wide\"><table>\n"
                       "<tr><th>loop</th><th>ns a fragment</th><th>max texel</th><th>p99.9 texel</th><th>max ulp</th>"
                       "<th>p99.9 ulp</th><th>wrong decisions</th></tr>\n";
    for (const SceneReport& scene : report.scenes) {
        html += "<tr class=\"scene\"><td colspan=\"7\">" + escaped(scene.title) + ", " +
                grouped(scene.comparison.evaluated_fragments) + " fragments</td></tr>\n";
        for (const Measurement& measurement : scene.comparison.measurements) {
            const Errors& errors = measurement.errors;
            const bool is_library = measurement.method.starts_with("texgen");
            html += std::string(is_library ? "<tr class=\"library\"><td>" : "<tr><td>") + escaped(measurement.method) +
                    "</td><td>" + formatted("%.3f", measurement.nanoseconds) + "</td><td>" + number(errors.max_texels) +
                    "</td><td>" + number(errors.nearly_max_texels) + "</td><td>" + number(errors.max_ulp) +
                    "</td><td>" + number(errors.nearly_max_ulp) + "</td><td>" + grouped(errors.wrong_decisions) +
                    "</td></tr>\n";
        }
    }
    html += "</table></div>\n";
    for (const SceneReport& scene : report.scenes)
        html += "<p>" + escaped(scene.title) +
                formatted(
                    ": %s covered fragments checked; wherever the library promises the nearest float, it is within "
                    "%.6f ulp. The work of its exact tier: %s.</p>\n",
                    grouped(scene.comparison.covered_fragments).c_str(), scene.comparison.largest_ulp,
                    work_of(scene.comparison).c_str());
    return html;
}

std::string worst_of(const Report& report) {
    std::string html;
    for (const SceneReport& scene : report.scenes)
        for (const Measurement& measurement : scene.comparison.measurements)
            html += "<p>" + escaped(scene.title) + ", " + escaped(measurement.method) + ", " +
                    number(measurement.errors.max_texels) + " texels:<br><code>" +
                    in_hexadecimal(measurement.errors.worst) + "</code></p>\n";
    return html;
}

// The pictures' triangles: the first scene's table, and all scenes in the chart.
std::string pictures_task(const Report& report) {
    std::string html =
        "<h3>Whole pictures</h3>\n<p>The triangles of the pictures above, each with its set-up: s, t, and whether the "
        "slide "
        "falls there. An element is a fragment of a triangle's rectangles; the table is that of the first "
        "picture.</p>\n"
        "<div class=\"task\"><div><table>\n<tr><th>way</th><th>time</th><th>largest error</th></tr>\n";
    std::vector<Series> series;
    for (const SceneReport& scene : report.scenes) {
        for (const Measurement& m : scene.comparison.measurements) {
            if (m.method.ends_with("not skipped")) continue;
            if (&scene == &report.scenes.front())
                html += std::string(m.method.starts_with("texgen") ? "<tr class=\"library\"><td>" : "<tr><td>") +
                        escaped(m.method) + "</td><td>" + duration(m.nanoseconds) + "</td><td>" +
                        number(m.errors.max_texels) + "</td></tr>\n";
            // Where a loop gives what is no number there is no place on an axis.
            if (m.errors.max_texels >= 1e9) continue;
            auto found = std::ranges::find(series, m.method, &Series::name);
            if (found == series.end()) found = series.insert(found, {m.method, Series::Mark::dot, {}});
            found->points.emplace_back(m.nanoseconds, std::max(m.errors.max_texels, 1e-6));
        }
    }
    return html + "</table></div>\n" +
           chart_of(
               series, "nanoseconds a fragment", "largest error, texels of 4096",
               "A dot a scene; none where a loop gives no number. To the left is faster, further down more accurate.") +
           "</div>\n";
}

const Errors& errors_of(const SceneReport& scene, std::string_view method) {
    return std::ranges::find(scene.comparison.measurements, method, &Measurement::method)->errors;
}

// Who has a minute: what it is, how exact, how fast, and where others are faster.
std::string summary_of(const Report& report) {
    std::size_t checked = 0;
    double ulp = 0;
    for (const SceneReport& scene : report.scenes) {
        checked += scene.comparison.covered_fragments;
        ulp = std::max(ulp, scene.comparison.largest_ulp);
    }
    const SceneReport& first = report.scenes.front();
    std::string html =
        "<ul>\n<li><b>How exact.</b> By default each coordinate is the nearest float: all " + grouped(checked) +
        formatted(
            " fragments of these scenes were checked, and the worst is off by %.3f of a unit in the last "
            "place, %s texel of a 4096 texture. Plane equations in float, for the first picture, are "
            "off by %s texels.</li>\n",
            ulp, number(errors_of(first, "texgen, exact").max_texels).c_str(),
            number(errors_of(first, "GLM, plane equations").max_texels).c_str());
    html += "<li><b>How fast.</b> You say which error you accept, and pay for no more. ";
    for (const Contest& contest : contests_of(report, rows))
        html += "With " + unbroken(contest.flags) + " a fragment of a row takes " + duration(contest.ours.nanoseconds) +
                " within 1/512 texel, and " + duration(contest.theirs.nanoseconds) + " by the fastest loop of others. ";
    html += formatted(
        "A room of %zu objects under %zu projectors takes %.3g ms a frame, and %.3g where everything is "
        "evaluated.</li>\n",
        report.room.objects, report.room.projectors, report.room.rows.back().milliseconds,
        report.room.rows.front().milliseconds);
    std::string slower;
    const auto add = [&](const std::string& what, double ratio, const std::string& than) {
        if (ratio > 1.03) slower += "<br>" + what + formatted(": %.2f times the time of ", ratio) + escaped(than);
    };
    for (const SceneReport& scene : report.scenes) {
        const auto fastest = std::ranges::min_element(scene.comparison.measurements, {}, [](const Measurement& m) {
            return m.method.starts_with("texgen") ? HUGE_VAL : m.nanoseconds;
        });
        add("The triangles of the scene \u201c" + escaped(scene.title) + "\u201d",
            scene.comparison.measurements[1].nanoseconds / fastest->nanoseconds, fastest->method);
    }
    for (const Task* task : tasks)
        for (const Contest& contest : contests_of(report, *task))
            add(task->title + (", " + unbroken(contest.flags)), contest.ours.nanoseconds / contest.theirs.nanoseconds,
                contest.theirs.variant);
    for (const auto& [title, scene, ours, theirs] : slow_ways)
        for (const Contest& contest : contests_of(report.timings, scene, ours, theirs))
            add(title + (", " + unbroken(contest.flags)), contest.ours.nanoseconds / contest.theirs.nanoseconds,
                contest.theirs.variant);
    if (!slower.empty())
        html += "<li><b>Where it is not the fastest.</b> " + slower +
                "<br>Those loops are in float, and promise nothing about their errors.</li>\n";
    return html + "</ul>\n";
}

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
    for (const std::string& part : {text_of(report.room), text_of(report.timings, report.other_timings),
                                    text_of(report.worst), text_of(report.costs)}) {
        text += "\n";
        text += part;
    }
    return text;
}

std::string html_of(const Report& report) {
    std::string html =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>texgen: report</title>\n"
        "<style>" +
        std::string(style) +
        "</style>\n</head>\n<body>\n<h1>texgen</h1>\n<p class=\"lead\">Projective texture mapping in C++, on the "
        "processor: a slide projector stands in a scene, and every surface point gets the coordinate of the slide that "
        "falls on it.</p>\n<div class=\"first\">\n";
    const SceneReport& first = report.scenes.front();
    html +=
        figure(first.pictures.front(), first.title) + "<div>" + summary_of(report) + "</div></div>\n<h2>Scenes</h2>\n";
    for (const SceneReport& scene : report.scenes)
        if (&scene != &first) html += "<h3>" + escaped(scene.title) + "</h3>\n" + figures(scene.pictures, scene.title);
    html += "<h3>A room with many projectors, of which most need nothing</h3>\n" +
            figures(report.room_pictures, "The room");
    html +=
        "<h3>Far from the origin</h3>\n<p>An object of one unit and its projector, far away: matrices in float lose "
        "the "
        "slide, one that is composed in double and then rounded keeps it.</p>\n" +
        chart_of(report.errors_by_distance, "distance from the origin, units", "largest error, texels of 4096",
                 "The largest error of s and t at 512 points of the object.");

    html +=
        "<h2>Time and error</h2>\n<p>Errors are in texels of a texture of 4096; half a unit in the last place of a "
        "float "
        "below 1, the least there can be, is 1.2e-4. GLM and Eigen stand for the loops that their users write, in "
        "float. "
        "What is called floor only moves bytes: it stores results, or copies what comes in as well.</p>\n" +
        pictures_task(report);
    for (const Task* task : tasks) html += section_of(report, *task);

    html += "<h2>Everything else</h2>\n";
    html += folded("All scenes: time, error and the work that was skipped", errors_of(report));
    html += folded("All workloads, and how they are measured", workloads_of(report.timings));
    html += folded("Speed promised and measured", promises_of(report.timings, report.other_timings));
    html += folded("The worst input of each function", html_of(report.worst));
    html += folded("What it costs to compile", html_of(report.costs));
    html += folded("The inputs of the largest errors", worst_of(report));
    std::string circumstances = "<dl>\n";
    for (const auto& [name, value] : report.circumstances)
        circumstances += "<dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd>\n";
    return html + folded("Compiler, machine and inputs", circumstances + "</dl>\n") + "</body>\n</html>\n";
}

}  // namespace report
