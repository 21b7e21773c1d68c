#pragma once

// The ordinary triangle, and how many times its time another one takes.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "judges/fragments.hpp"
#include "support/has_avx512.hpp"
#include "support/hex.hpp"
#include "support/shot.hpp"
#include "support/stopwatch.hpp"
#include "texgen/interpolate.hpp"

namespace triangle_costs {

using support::everywhere;
using support::hex;
using support::Shot;
using texgen::FragmentRect;
using texgen::Tolerance;
using texgen::Triangle;
using texgen::WindowVertex;

// Of masks alone, where ordinary ones are made at once.
inline const double masks_by_vectors = support::has_whole_avx512() ? 1.25 : 1.0;

inline constexpr std::array<Tolerance, 2> tolerances{texgen::exact, texgen::texels(1.0 / 512.0, 4096.0)};

// One triangle with its set-up, over its rectangle: s, t and the mask.
class Workload {
public:
    Workload(const Shot& shot, Tolerance tolerance)
        : shot_(shot), tolerance_(tolerance), s_(support::count_of(shot.rect)), t_(s_.size()), lit_(s_.size()) {}

    void operator()() {
        interpolate(support::setup_of(shot_.triangle, everywhere(), tolerance_), shot_.rect, {s_, t_, {}, lit_});
    }

private:
    Shot shot_;
    Tolerance tolerance_;
    std::vector<float> s_, t_, lit_;
};

inline Shot ordinary(int width, int height) {
    return {{{{3.7f, 5.2f}, 1.1f, {0.1f, 0.2f, 0.3f, 1.0f}},
             {{1030.1f, 2.4f}, 1.4f, {1.2f, 0.1f, 0.3f, 1.3f}},
             {{410.0f, 800.7f}, 1.2f, {0.5f, 1.1f, 0.3f, 1.2f}}},
            {300, 100, width, height}};
}

// The time of a shot over that of the ordinary one of its size; taken anew while it is above the most that it may be.
inline double cost(const Shot& shot, Tolerance tolerance, double most) {
    return support::worst_over_ordinary_within(most, Workload(ordinary(shot.rect.width, shot.rect.height), tolerance),
                                               Workload(shot, tolerance));
}

// The least of some short times: quick, for many shots.
inline double least_time(const Shot& shot, Tolerance tolerance) {
    const support::Calls calls = support::calls_of(Workload(shot, tolerance));
    double least = HUGE_VAL;
    for (int i = 0; i < 8; ++i) least = std::min(least, support::nanoseconds_of(calls, 4));
    return least;
}

inline void require_cost(const char* name, const Shot& shot, double most) {
    for (const Tolerance tolerance : tolerances) {
        const double ratio = cost(shot, tolerance, most);
        REQUIRE_MESSAGE(ratio <= most, name, ", tolerance ", tolerance.value, ": ", ratio, " times in ", hex(shot));
    }
}

inline WindowVertex vertex(float x, float y, float w, float s, float t, float q) {
    return {{x, y}, w, {s, t, 0.5f, q}};
}

}  // namespace triangle_costs
