// a view of row vectors for the camera's pose
#include <array>

#include <texgen/transform.hpp>

using namespace texgen;

CameraPose pose_of(const std::array<float, 16>& rows) {
#ifndef MISUSE
    return inverse_rigid(from_row_vectors<Eye, World>(rows));
#else
    return from_row_vectors<Eye, World>(rows);
#endif
}
