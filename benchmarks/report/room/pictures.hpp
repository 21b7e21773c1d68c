#pragma once

// The pictures of the room, and what is counted in them.

#include <array>

#include <glm/vec3.hpp>
#include <texgen/scene.hpp>

#include "../picture.hpp"
#include "../rasterizer.hpp"
#include "../room.hpp"
#include "light.hpp"
#include "objects.hpp"

namespace report::lit_room {

// Each seen fragment in the colour of the dearest work that a projector asks of its rectangle.
struct WorkColour {
    glm::vec3 colour;
    const char* meaning;
};
inline constexpr std::array<WorkColour, 5> work_colours{{{glm::vec3(0.10f, 0.11f, 0.14f), "dark none"},
                                                         {glm::vec3(0.2f, 0.55f, 0.95f), "blue affine"},
                                                         {glm::vec3(0.25f, 0.75f, 0.45f), "green quadratic"},
                                                         {glm::vec3(0.95f, 0.8f, 0.25f), "yellow a division"},
                                                         {glm::vec3(0.9f, 0.3f, 0.2f), "red a division and a test"}}};

// The picture, lit by all projectors.
Picture shaded(const Rules& rule, const Room& room, const Seen& seen, const texgen::Scene& scene, const Camera& camera,
               const Picture& slide, int width, int height);

Picture coloured_by_work(const Room& room, const Seen& seen, const texgen::Scene& scene, int width, int height);

// How much is lit, and which kept pairs light nothing.
void count_lit(RoomReport& report, const Room& room, const Seen& seen, const texgen::Scene& scene);

}  // namespace report::lit_room
