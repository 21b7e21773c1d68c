#pragma once

// Floor 0: what is interpolated and what is culled, and what either needs.

#include "detail/language.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace TEXGEN_NAMESPACE {

// A segment by its ends: (s, t, r, q) at alpha = 0 and at alpha = 1.
struct Segment {
    glm::vec4 a, b;
};

// A corner of a triangle in the window. window: pixels, with pixel centres at +0.5. clip_w: the camera's w, > 0.
// strq: homogeneous texture coordinates.
struct WindowVertex {
    glm::vec2 window;
    float clip_w;
    glm::vec4 strq;
};

// A triangle of the window, in either winding.
struct Triangle {
    WindowVertex a, b, c;
};

// The fragments [x, x + width) x [y, y + height), each at its centre; outputs are row-major, width * height. It is
// empty where a size is not positive.
struct FragmentRect {
    int x, y, width, height;
};

// The window's pixels that NDC [-1, 1] x [-1, 1] covers. A negative width or height mirrors: y grows as NDC y does,
// whatever the origin of textures is, and with a negative height the other way.
struct Viewport {
    int x, y, width, height;
};

// The work that the fragments of a rectangle need, in the order of its cost.
//   nothing          no fragment is lit: all are behind the projector, or outside one side of the region or its depth
//   affine           q/w is constant there (an orthographic projector, a parallel view), or varies so little that
//                    straight lines stay inside the tolerance: no division
//   quadratic        q/w varies, and certified polynomials of a few powers stay inside the tolerance: no division a
//                    fragment
//   divide           one division a fragment; all are in front of the projector, inside the region and its depth
//   divide_and_test  one division a fragment; the sign of q or the sides of the region are tested, or its depth
// Where the region's border crosses an affine or quadratic rectangle, the mask is compared from the coordinates. Rows
// of less than 16 fragments, rectangles of no more than 128, and those of four rows or more that are no wider than eight
// times their height and hold no more than 512 fragments, or 16384 in rows of less than 64, are divided though q/w
// varies: there a polynomial saves nothing.
enum class Work { nothing, affine, quadratic, divide, divide_and_test };

// How much of a box or a sphere the slide lights. A point is lit where q > 0 and (s, t) is in the closed region, as
// real numbers or as the floats that they are rounded to, which project() looks at.
//   outside  no point of the closed body is lit, in either way
//   partial  neither of the others, or not provably one of them
//   inside   all points are lit, in both ways
enum class Coverage { outside, partial, inside };

// The points between two corners, both included. Extents may be infinite.
struct Box {
    glm::vec3 min, max;
};

// The points within `radius` of the centre, those at that distance included.
struct Sphere {
    glm::vec3 centre;
    float radius;
};

}  // namespace TEXGEN_NAMESPACE
