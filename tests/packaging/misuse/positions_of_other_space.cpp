// positions in eye space under an object texgen
#include <texgen/texcoord.hpp>

using namespace texgen;

void coordinates(const ObjectTexgen& texgen, std::span<const glm::vec3> points, std::span<glm::vec4> strq) {
#ifndef MISUSE
    generate(texgen, object_space(points), strq);
#else
    generate(texgen, eye_space(points), strq);
#endif
}
