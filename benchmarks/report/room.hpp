#pragma once

// A room lit by many projectors, of which most need nothing: what each rule skips, what that saves, and that the
// picture stays the same.

#include <cstddef>
#include <string>
#include <vector>

#include "picture.hpp"

namespace report {

// The frame with some of the rules.
struct RoomRow {
    std::string rules;
    double milliseconds;  // median of the frames, in processor time: matrices, set-ups and coordinates
    std::size_t pairs, triangles, rects, fragments;  // what was set up or evaluated
    bool same_picture;                               // to the bit as with no rule
};

struct RoomReport {
    std::size_t objects, projectors, moved_objects, moved_projectors;  // moved: from frame to frame
    double lit_share;        // of fragment and projector, among the covered fragments of the objects in view
    double dark_pair_share;  // of the pairs that are kept and in view, those without a lit fragment
    double update_microseconds, first_update_microseconds;  // of the scene, as part of a frame
    std::vector<RoomRow> rows;                              // none of the rules first, those that pay last
    RoomRow in_reach;                                       // as the last, where the light ends at the far planes
    Picture picture, work_picture, reach_picture;

    bool is_same_picture() const;
    std::string key_of_work() const;  // of the colours that the picture of the work has
    double speedup() const { return rows.front().milliseconds / rows.back().milliseconds; }
};

RoomReport make_room(const Picture& slide, int width, int height);

std::string text_of(const RoomReport& room);

// A part of the page.
std::string html_of(const RoomReport& room);

}  // namespace report
