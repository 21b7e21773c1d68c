// transforms multiplied in the wrong order
#include <texgen/transform.hpp>

using namespace texgen;

auto modelview(const ViewMatrix& view, const ModelMatrix& model) {
#ifndef MISUSE
    return view * model;
#else
    return model * view;
#endif
}
