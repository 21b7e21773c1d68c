#pragma once

// Floor 0: the input of every interpolator.

#include "detail/language.hpp"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace TEXGEN_NAMESPACE {

// (s, t, r, q) at alpha = 0 and at alpha = 1.
struct Segment {
    glm::vec4 a, b;
};

// window: pixels, with pixel centres at +0.5. clip_w: the camera's w, > 0. strq: homogeneous texture coordinates.
struct WindowVertex {
    glm::vec2 window;
    float clip_w;
    glm::vec4 strq;
};

// In either winding.
struct Triangle {
    WindowVertex a, b, c;
};

// The fragments [x, x + width) x [y, y + height), each at its centre; outputs are row-major, width * height.
struct FragmentRect {
    int x, y, width, height;
};

}  // namespace TEXGEN_NAMESPACE
