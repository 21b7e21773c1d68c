// a mirrored view that nobody asked whether it is there
#include <texgen/projector.hpp>

using namespace texgen;

Projector reflected(const Projector& projector, const glm::dvec4& plane) {
    Projector result = projector;
#ifndef MISUSE
    if (const auto view = mirrored(projector.view, plane)) result.view = *view;
#else
    result.view = mirrored(projector.view, plane);
#endif
    return result;
}
