#pragma once

// What is asked of every fragment of a shot, in its mirror image too, and rows whose values all are ties.

#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "texgen/interpolate.hpp"

namespace row_cases {

using support::count_of;
using support::everywhere;
using support::ExactTriangle;
using support::hex;
using support::Outputs;
using support::Random;
using support::same_bits;
using support::Seen;
using support::setup_of;
using support::Shot;
using support::vertices;
using texgen::FragmentRect;
using texgen::Triangle;
using texgen::TriangleSetup;
using texgen::WindowVertex;
using texgen::Work;

// The widths at which something ends: vectors, units of 64 fragments, chunks of 128 and 256, strips of 512.
inline std::vector<int> awkward_widths() {
    std::vector<int> widths;
    for (int width = 1; width <= 71; ++width) widths.push_back(width);
    for (const int middle : {128, 131, 192, 257, 320, 512, 516})
        for (int width = middle - 3; width <= middle + 3; ++width) widths.push_back(width);
    return widths;
}

// A row as a column.
inline Shot mirrored(Shot shot) {
    for (WindowVertex* const vertex : {&shot.triangle.a, &shot.triangle.b, &shot.triangle.c})
        std::swap(vertex->window.x, vertex->window.y);
    std::swap(shot.rect.x, shot.rect.y);
    std::swap(shot.rect.width, shot.rect.height);
    return shot;
}

// And a row as the column of the mirrored triangle, too.
inline void require_right(const Shot& shot, const texgen::TextureRegion& region, Outputs& out, Seen& seen) {
    const Work work = interpolate(setup_of(shot.triangle, region), shot.rect, out.spans());
    const std::string wrong = first_wrong(shot, ExactTriangle(shot.triangle), region, texgen::exact, work, out, seen);
    REQUIRE_MESSAGE(wrong.empty(), wrong, " in ", hex(shot));
    REQUIRE_MESSAGE(out.pads_are_intact(), hex(shot));
    if (shot.rect.height == 1 && shot.rect.width > 1) require_right(mirrored(shot), region, out, seen);
}

// s at fragment i of every row is (2 m + 1) 2^-25 for some integer m: the middle of two floats. q/w is constant.
inline Shot row_of_ties(int width, int height, Random& random) {
    const int x = random.integer(-100, 100), y = random.integer(-100, 100);
    const int step = 2 * random.integer(1, 1000) + 1;
    const int first = random.integer(1 << 23, (1 << 23) + (1 << 22));
    const auto vertex = [&](int column, int row) {
        const auto s = static_cast<float>(first + step * column) * 0x1p-24f;
        return WindowVertex{{static_cast<float>(x + column), static_cast<float>(y + row)}, 1.0f, {s, s, s, 1.0f}};
    };
    return {{vertex(0, 0), vertex(1024, 0), vertex(random.integer(0, 2), 1024)}, {x, y, width, height}};
}

}  // namespace row_cases
