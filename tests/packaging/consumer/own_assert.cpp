// The user's own assertion is what a broken precondition meets, and nothing else.

#include <cstdio>

static int broken = 0;
#define TEXGEN_ASSERT(condition) ((condition) ? void() : void(++broken))
#include <texgen/texgen.hpp>

int main() {
    const texgen::WorldTexgen texgen(glm::dmat4(1.0));
    const glm::vec3 points[] = {{1, 2, 3}, {4, 5, 6}};
    glm::vec4 strq[2];
    generate(texgen, texgen::world_space(points), strq);
    if (broken != 0) return std::puts("it is called for what is right"), 1;
    generate(texgen, texgen::world_space(points), {strq, 1});
    if (broken == 0) return std::puts("it is not called for outputs that are too short"), 1;
    return 0;
}
