// What was promised of times, against what was measured.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../html.hpp"
#include "../timings.hpp"

namespace report {

namespace {

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

}  // namespace

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

}  // namespace report
