// positions under the projector's matrix, without the scale-bias
#include <texgen/linear.hpp>
#include <texgen/texcoord.hpp>

using namespace texgen;

void coordinates(const Projector& projector, std::span<const glm::vec3> points, std::span<glm::vec4> strq) {
#ifndef MISUSE
    generate(texture_from_world(projector), world_space(points), strq);
#else
    generate(projector.matrix(), world_space(points), strq);
#endif
}
