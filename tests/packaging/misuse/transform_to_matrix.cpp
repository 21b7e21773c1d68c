// a transform where a plain matrix is wanted
#include <texgen/transform.hpp>

using namespace texgen;

glm::mat4 uniform(const ObjectTexgen& texgen) {
#ifndef MISUSE
    return texgen.rounded();
#else
    return texgen;
#endif
}
