// the precision of a depth buffer as a number of bits, which does not say of what
#include <texgen/linear.hpp>

using namespace texgen;

glm::dvec2 error(const WindowTexgen& texgen, glm::vec3 fragment) {
#ifndef MISUSE
    return depth_error_bound(texgen, fragment, DepthBuffer::unorm24);
#else
    return depth_error_bound(texgen, fragment, 24);
#endif
}
