#pragma once

#include "picture.hpp"
#include "scenes.hpp"

namespace report {

// The mean of four frames that are shifted by a quarter of a pixel each way; one frame where a filter is shown.
Picture render(const Scene& scene, const View& view, int width, int height);

}  // namespace report
