#include "room.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <span>
#include <string>
#include <vector>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>
#include <texgen/interpolate.hpp>
#include <texgen/projector.hpp>
#include <texgen/scene.hpp>

#include "html.hpp"
#include "rasterizer.hpp"
#include "room/light.hpp"
#include "room/objects.hpp"
#include "room/pictures.hpp"

namespace report {

namespace {

using lit_room::coloured_by_work;
using lit_room::count_lit;
using lit_room::Counts;
using lit_room::in_reach;
using lit_room::is_across;
using lit_room::light_all;
using lit_room::look;
using lit_room::make_objects;
using lit_room::moved_count;
using lit_room::Numbers;
using lit_room::reach;
using lit_room::Room;
using lit_room::Rules;
using lit_room::rules;
using lit_room::Seen;
using lit_room::shaded;
using lit_room::spot;
using lit_room::work_colours;
using lit_room::WorkColour;

constexpr int frame_count = 6;

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Camera camera_at(int frame, double aspect) {
    const double angle = 0.6 + 0.04 * frame;
    const glm::dvec3 position(14.0 * std::sin(angle), 5.5, 14.0 * std::cos(angle));
    const glm::dmat4 projection = glm::perspective(glm::radians(58.0), aspect, 0.1, 100.0);
    return {projection * glm::lookAt(position, glm::dvec3(0, 0, 0), glm::dvec3(0, 1, 0)), position};
}

}  // namespace

bool RoomReport::is_same_picture() const {
    return std::ranges::all_of(rows, [](const RoomRow& row) { return row.same_picture; });
}

std::string RoomReport::key_of_work() const {
    std::string key;
    for (const WorkColour& work : work_colours)
        if (std::ranges::find(work_picture.pixels, work.colour) != work_picture.pixels.end())
            key += (key.empty() ? "" : ", ") + std::string(work.meaning);
    return key;
}

RoomReport make_room(const Picture& slide, int width, int height) {
    Room room = make_objects();
    RoomReport report{.objects = room.objects.size(),
                      .projectors = room.projectors.size(),
                      .moved_objects = moved_count,
                      .moved_projectors = 1,
                      .lit_share = 0,
                      .dark_pair_share = 0,
                      .update_microseconds = 0,
                      .first_update_microseconds = 0,
                      .rows = {},
                      .in_reach = {},
                      .picture = {},
                      .work_picture = {},
                      .reach_picture = {}};
    texgen::Scene scene, scene_in_reach;
    double start = seconds();
    scene.update(room.view(), {});
    report.first_update_microseconds = 1e6 * (seconds() - start);
    scene_in_reach.update(room.view_in_reach(), {});

    Numbers number;
    std::array<std::vector<double>, rules.size()> times;
    std::array<Counts, rules.size()> counts;
    std::vector<double> updates, times_in_reach;
    Counts counts_in_reach;
    for (int frame = 0; frame < frame_count; ++frame) {
        std::vector<std::uint32_t> moved;
        for (std::size_t i = 0; i < moved_count; ++i) {
            const std::uint32_t o =
                room.crates[static_cast<std::size_t>(number(0, static_cast<double>(room.crates.size())))];
            moved.push_back(o);
            room.models[o] = texgen::ModelMatrix(glm::rotate(room.models[o].matrix(), 0.1, glm::dvec3(0, 1, 0)));
        }
        const auto turned = static_cast<std::uint32_t>(frame);
        room.projectors[turned] = spot(room.positions[turned], number(0, 6.28), is_across(turned));
        const auto update_of = [&](texgen::Scene& changed, const texgen::SceneView& view) {
            start = seconds();
            changed.update(view, {moved, std::span(&turned, 1)});
            return seconds() - start;
        };
        const double update = update_of(scene, room.view());
        updates.push_back(1e6 * update);
        const double update_in_reach = update_of(scene_in_reach, room.view_in_reach());

        const Camera camera = camera_at(frame, static_cast<double>(width) / height);
        const Seen seen = look(room, camera, width, height);
        float sum = 0;
        const auto time = [&](const Rules& rule, const texgen::Scene& of, Counts& count) {
            start = seconds();
            count = light_all(rule, room, seen, of,
                              [&](std::uint32_t, std::uint32_t, std::size_t, std::size_t, texgen::Work,
                                  const RectCoordinates& coordinates) { sum += coordinates.s[0]; });
            return 1e3 * (seconds() - start);
        };
        for (std::size_t turn = 0; turn < rules.size(); ++turn) {
            const std::size_t k = (turn + static_cast<std::size_t>(frame)) % rules.size();
            times[k].push_back(time(rules[k], scene, counts[k]) + (rules[k].scene ? 1e3 * update : 0.0));
        }
        times_in_reach.push_back(time(in_reach, scene_in_reach, counts_in_reach) + 1e3 * update_in_reach);
        static volatile float sink = 0;
        sink = sink + sum;
        if (frame + 1 < frame_count) continue;

        report.picture = shaded(rules.front(), room, seen, scene, camera, slide, width, height);
        const auto row = [&](const Rules& rule, std::vector<double>& milliseconds, const Counts& count, bool is_same) {
            return RoomRow{.rules = rule.name,
                           .milliseconds = median(milliseconds),
                           .pairs = count.pairs,
                           .triangles = count.triangles,
                           .rects = count.rects,
                           .fragments = count.fragments,
                           .same_picture = is_same};
        };
        for (std::size_t k = 0; k < rules.size(); ++k) {
            const Picture again = shaded(rules[k], room, seen, scene, camera, slide, width, height);
            report.rows.push_back(row(rules[k], times[k], counts[k], again.pixels == report.picture.pixels));
        }
        report.reach_picture = shaded(in_reach, room, seen, scene_in_reach, camera, slide, width, height);
        report.in_reach = row(in_reach, times_in_reach, counts_in_reach, false);
        report.work_picture = coloured_by_work(room, seen, scene, width, height);
        count_lit(report, room, seen, scene);
    }
    report.update_microseconds = median(updates);
    return report;
}

namespace {

std::string summary_of(const RoomReport& room) {
    return formatted(
               "%zu objects, %zu projectors; from frame to frame the camera moves, %zu objects turn and %zu projector "
               "swings. %.2f%% of what the covered fragments could get from the projectors is lit. ",
               room.objects, room.projectors, room.moved_objects, room.moved_projectors, 100 * room.lit_share) +
           formatted(
               "The scene's update takes %.0f microseconds a frame (%.0f the first time) and is part of the times with "
               "pairs; of the pairs that it keeps in view, %.1f%% have no lit fragment. The last row of the table is "
               "%.1f times as fast as the first.",
               room.update_microseconds, room.first_update_microseconds, 100 * room.dark_pair_share, room.speedup()) +
           formatted(
               " Where the light ends at the far planes, %.0f from the projectors, %zu pairs in view are left of %zu, "
               "and "
               "a frame takes %.3g ms instead of %.3g.",
               reach, room.in_reach.pairs, room.rows.back().pairs, room.in_reach.milliseconds,
               room.rows.back().milliseconds);
}

}  // namespace

std::string text_of(const RoomReport& room) {
    std::string text = "room: " + summary_of(room) + "\n";
    text += formatted("%-30s %10s %10s %10s %10s %12s %8s\n", "rules", "ms", "pairs", "triangles", "rects", "fragments",
                      "picture");
    for (const RoomRow& row : room.rows)
        text += formatted("%-30s %10.2f %10zu %10zu %10zu %12zu %8s\n", row.rules.c_str(), row.milliseconds, row.pairs,
                          row.triangles, row.rects, row.fragments, row.same_picture ? "the same" : "differs");
    return text;
}

std::string html_of(const RoomReport& room) {
    std::string html =
        "<p>The room above, by which rules leave work out:</p>\n<table>\n<tr><th>rules</th><th>a frame</th>"
        "<th>times as fast</th><th>fragments</th></tr>\n";
    for (const RoomRow& row : room.rows)
        html += "<tr><td>" + escaped(row.rules) + "</td><td>" + duration(1e6 * row.milliseconds) +
                formatted("</td><td>%.1f</td><td>", room.rows.front().milliseconds / row.milliseconds) +
                grouped(row.fragments) + "</td></tr>\n";
    return html + "</table>\n" +
           folded("What the rules are, and what is counted",
                  "<p>" + escaped(summary_of(room)) + " The picture is " +
                      (room.is_same_picture() ? "the same" : "NOT the same") +
                      " by all rules.</p>\n<p>Pairs: Scene keeps only those that coverage() of the object's box does "
                      "not call "
                      "outside. Triangles: one question to the set-up for all its rectangles; it pays only where pairs "
                      "are "
                      "not skipped. Rectangles: Work::nothing; without this rule each fragment is evaluated and "
                      "compared.</p>\n");
}

}  // namespace report
