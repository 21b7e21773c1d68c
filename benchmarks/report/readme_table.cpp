#include "readme_table.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

#include "html.hpp"
#include "timings.hpp"

namespace report {

namespace {

// A row in words, and the ways of a scene that stand in its columns.
struct Row {
    const char* words;
    std::string_view scene, exact, tolerant, glm, eigen;
};

using namespace way;
constexpr const char* arrays = "Eigen, plane equations in arrays";
constexpr const char* blocks = "Eigen, array blocks";

constexpr Row rows[] = {
    {"8 x 8 fragments each of many triangles, by a `TriangleBatch`", "rows, triangles of 8x8 with set-up", exact_batch,
     fine_batch, planes, arrays},
    {"the same by a `TriangleSetup` each", "rows, triangles of 8x8 with set-up", exact, fine, planes, arrays},
    {"8 x 8 fragments of a triangle that is ready", "rows, 8x8 of a large triangle", exact, fine, planes, arrays},
    {"a visibility buffer, runs of 8", "visibility buffer, 128x64, runs of 8", exact, fine, planes_looked_up, ""},
    {"the same, ids in any order", "visibility buffer, 128x64, ids in any order", exact, fine, planes_looked_up, ""},
    {"boxes against a projector, one by one, by a `LitVolume`", "Coverage, 4096 boxes, scattered", one_box, "",
     five_planes, ""},
    {"the same, 4096 at once", "Coverage, 4096 boxes, scattered", batch, "", five_planes, ""},
    {"points, one by one", "project interleaved, 1024", one_point, "", one_product, ""},
    {"points, planar", "project planar, 1024", exact, coarse, product, blocks},
    {"the same, `within` a box", "project planar, 1024", exact_within, coarse_within, product, blocks},
    {"a segment", "segment, 1024", exact, coarse, mix, blocks},
    {"rows of 1024 x 4, q/w by 1.3", "rows, 1024x4, q/w by 1.3", exact, fine, planes, arrays},
    {"the same, q/w by 30", "rows, 1024x4, q/w by 30", exact, fine, planes, arrays},
};

std::string time_of(double nanoseconds) {
    return nanoseconds < 9.995 ? formatted("%.2f", nanoseconds) : formatted("%.1f", nanoseconds);
}

// 6.1e-5, not 6.1e-05.
std::string error_of(double texels) {
    if (texels >= 0.1) return formatted("%.3g", texels);
    std::string text = formatted("%.1e", texels);
    if (const std::size_t zero = text.find("e-0"); zero != text.npos) text.erase(zero + 2, 1);
    return text;
}

// The times of all builds, and the largest of their errors.
std::string cell_of(const Report& report, const Row& row, std::string_view variant) {
    std::string times;
    std::optional<double> texels;
    for (const Timings& build : report.timings) {
        const Timing* timing = build.find(row.scene, variant);
        if (timing == nullptr) return " |";
        times.append(times.empty() ? " " : " / ").append(time_of(timing->nanoseconds));
        if (timing->has_errors) texels = std::max(texels.value_or(0.0), timing->texels);
    }
    if (texels) times.append(", ").append(error_of(*texels));
    if (row.scene.starts_with("Coverage") && variant == row.exact) times += ", never false";
    return times + " |";
}

std::string cell_of(const SceneReport& scene, const char* loop) {
    for (const Measurement& of : scene.comparison.measurements)
        if (of.method == loop)
            return formatted(" %s, %s |", time_of(of.nanoseconds).c_str(), error_of(of.errors.max_texels).c_str());
    return " |";
}

}  // namespace

std::string readme_table_of(const Report& report) {
    if (report.timings.size() < 2) return {};
    std::string text;
    for (const Row& row : rows) {
        text += std::string("| ") + row.words + " |";
        for (const std::string_view variant : {row.exact, row.tolerant, row.glm, row.eigen})
            text += cell_of(report, row, variant);
        text += "\n";
    }
    text += "| teapot and floor, triangles with set-up, `-O3` |";
    for (const char* loop : {"texgen, exact", "texgen, 1/512 texel", "GLM, plane equations", "Eigen, plane equations"})
        text += cell_of(report.scenes.front(), loop);
    return text + formatted(
                      "\n| a room, 2 000 objects x 64 projectors, a frame, `-O3` | %.1f ms | | %.0f ms, everything "
                      "evaluated | |\n",
                      report.room.rows.back().milliseconds, report.room.rows.front().milliseconds);
}

}  // namespace report
