#pragma once

// What is left of a slide's coordinates far from the origin, by matrices in float and by the library's.

#include <vector>

#include "chart.hpp"

namespace report {

// The largest error in texels of 4096 against how far from the origin an object of unit size and its projector stand.
std::vector<Series> errors_by_distance();

}  // namespace report
