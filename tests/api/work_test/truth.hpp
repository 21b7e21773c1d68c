#pragma once

// What the nearest floats say of a whole rectangle.

#include <cstdint>

#include "judges/exact.hpp"
#include "judges/verdict.hpp"
#include "support/shot.hpp"

namespace work_cases {

using support::ExactTriangle;
using support::hex;
using support::Homogeneous;
using support::Outputs;
using support::Random;
using support::Shot;
using texgen::FragmentRect;
using texgen::TextureRegion;
using texgen::Work;

// What the nearest floats say of every fragment of the rectangle for which something is promised.
struct Truth {
    bool any_lit = false, all_lit = true, any_in_front = false, all_in_front = true, all_promised = true;
};

inline Truth truth_of(const Shot& shot, const ExactTriangle& exact, const TextureRegion& region) {
    Truth truth;
    for (std::int64_t y = shot.rect.y; y < shot.rect.y + static_cast<std::int64_t>(shot.rect.height); ++y) {
        for (std::int64_t x = shot.rect.x; x < shot.rect.x + static_cast<std::int64_t>(shot.rect.width); ++x) {
            if (!exact.has_positive_w(x, y)) {
                truth.all_promised = false;
                continue;
            }
            const Homogeneous at = exact.at(x, y);
            const bool in_front = at.q.sign() > 0;
            const bool lit = support::contains(region, at);
            truth.any_lit = truth.any_lit || lit;
            truth.all_lit = truth.all_lit && lit;
            truth.any_in_front = truth.any_in_front || in_front;
            truth.all_in_front = truth.all_in_front && in_front;
        }
    }
    return truth;
}

}  // namespace work_cases
