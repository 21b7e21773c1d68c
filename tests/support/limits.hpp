#pragma once

// What the worst inputs of functions may cost.

#include "support/has_avx512.hpp"

namespace support {

// How many times the ordinary time the worst input of a function may take.
namespace limit {
inline constexpr double any = 8.0;
inline constexpr double near_plane = 16.0;           // a triangle that the camera's near plane has cut
inline constexpr double near_plane_99_of_100 = 4.0;  // of such triangles
inline constexpr double rotation = 3.0;              // between the orders of the corners of one triangle
inline constexpr double q_is_zero = 24.0;            // a tile that q = 0 crosses
inline constexpr double touching = 10.0;             // a body that touches a side
inline constexpr double all_sizes = 24.0;            // the sign of a determinant of numbers that are 256 times apart
inline constexpr double frame = 200.0;               // of Scene::update, over the median frame

// Without AVX-512 what is in doubt is decided in vectors of half as many doubles, and with more instructions, and
// ordinary inputs are floats that lose less: there limits of any inputs are as many times these. Where whole vectors of
// AVX-512 are done at once ordinary inputs take half as long, but not what is in doubt, of which much is no vector.
inline double times_by_vectors() { return has_whole_avx512() ? 1.75 : has_avx512() ? 1.0 : 1.5; }

// What a busy machine, or where arrays happen to stand in memory, adds for minutes to the worst inputs, which read and
// write more than the ordinary ones.
inline constexpr double noise = 1.05;
}  // namespace limit

}  // namespace support
