#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "chart.hpp"
#include "compare.hpp"
#include "costs.hpp"
#include "room.hpp"
#include "timings.hpp"
#include "worst_times.hpp"

namespace report {

// A picture as its file beside the page, and as what the page shows of it.
struct PictureOfScene {
    std::string file, caption, png, embedded;  // embedded: PNG or JPEG, whichever is smaller
};

struct SceneReport {
    std::string name, title;
    Comparison comparison;
    std::vector<PictureOfScene> pictures;
    std::size_t shadowed_by_themselves = 0;  // fragments, with the receiver plane's bias: none
};

struct Report {
    std::vector<std::pair<std::string, std::string>> circumstances;  // compiler, flags, machine, ...
    std::vector<SceneReport> scenes;                                 // the first opens the page
    RoomReport room;
    std::vector<PictureOfScene> room_pictures;
    std::vector<Series> times_by_size, errors_by_distance;
    std::vector<Timings> timings;  // these may be empty
    std::vector<Timings> other_timings;
    std::vector<WorstTime> worst;
    std::vector<Cost> costs;
};

// The tables for a terminal, and where the library was at its worst.
std::string text_of(const Report& report);

// The page, which needs no other file to be read: pictures, a table and a chart a task, the rest folded.
std::string html_of(const Report& report);

}  // namespace report
