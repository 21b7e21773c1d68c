#pragma once

// Floor 6: what a primitive, a batch or a box needs. Work that is not needed is not done.

namespace texgen {

// What the fragments of a rectangle need, in the order of its cost.
//   nothing          no fragment is lit: all are behind the projector, or outside one side of the region
//   affine           q/w is constant there (an orthographic projector, a parallel view), or varies so little that straight
//                    lines stay inside the tolerance: no division
//   quadratic        q/w varies, and a certified quadratic stays inside the tolerance: no division a fragment
//   divide           one division a fragment; every fragment is in front of the projector and inside the region
//   divide_and_test  one division a fragment; the sign of q or the sides of the region are tested
// Where the region's border crosses an affine or quadratic rectangle, the mask is compared from the coordinates.
enum class Work { nothing, affine, quadratic, divide, divide_and_test };

}  // namespace texgen
