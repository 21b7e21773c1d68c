// eye planes stored under the MODELVIEW of another space
#include <texgen/linear.hpp>

using namespace texgen;

auto stored(const ObjectTexgen& planes, const ModelviewMatrix& modelview, [[maybe_unused]] const ViewMatrix& view) {
#ifndef MISUSE
    return eye_planes_as_stored(planes, modelview);
#else
    return eye_planes_as_stored(planes, view);
#endif
}
