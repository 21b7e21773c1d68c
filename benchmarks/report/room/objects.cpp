#include "objects.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>
#include <texgen/projector.hpp>

namespace report::lit_room {

texgen::Projector spot(glm::dvec3 position, double turn, bool across) {
    const glm::dvec3 down(1.6 * std::cos(turn), -position.y, 1.6 * std::sin(turn));
    const glm::dvec3 target = position + (across ? glm::dvec3(std::cos(turn), -0.2, std::sin(turn)) : down);
    const texgen::PerspectiveLens lens{.fovy = texgen::degrees(32), .aspect = 1, .z_near = 0.1, .z_far = reach};
    return texgen::make_projector(lens, {position, target, {0, 1, 0}}, texgen::opengl).value();
}

Room make_objects() {
    Room room;
    Numbers number;
    const glm::dmat4 in_place(1.0);
    const glm::vec3 plaster(0.8f, 0.78f, 0.74f);
    for (int x = 0; x < floor_cells; ++x)
        for (int z = 0; z < floor_cells; ++z)
            room.add(parallelogram(
                         {cell * static_cast<float>(x) - half_side, 0, cell * static_cast<float>(z + 1) - half_side},
                         {cell, 0, 0}, {0, 0, -cell}, 1),
                     in_place, plaster);
    for (int side = 0; side < 4; ++side) {
        const glm::dmat4 turned = glm::rotate(in_place, glm::radians(90.0 * side), glm::dvec3(0, 1, 0));
        for (int x = 0; x < floor_cells; ++x)
            for (int y = 0; y < wall_rows; ++y)
                room.add(
                    parallelogram({cell * static_cast<float>(x) - half_side, cell * static_cast<float>(y), -half_side},
                                  {cell, 0, 0}, {0, cell, 0}, 1),
                    turned, plaster);
    }
    while (room.objects.size() < object_count) {
        const glm::vec3 half{number(0.08, 0.25), number(0.06, 0.3), number(0.08, 0.25)};
        glm::dmat4 model = glm::translate(in_place, glm::dvec3{number(-14, 14), half.y, number(-14, 14)});
        model = glm::rotate(model, number(0, 6.28), glm::dvec3(0, 1, 0));
        room.crates.push_back(static_cast<std::uint32_t>(room.objects.size()));
        room.add(box(-half, half), model, glm::vec3{number(0.5, 0.95), number(0.5, 0.95), number(0.5, 0.95)});
    }
    for (std::size_t i = 0; i < projector_count; ++i) {
        const glm::dvec3 position(-13.0 + 26.0 / 7.0 * static_cast<double>(i % 8), 5.5,
                                  -13.0 + 26.0 / 7.0 * static_cast<double>(i / 8));
        room.positions.push_back(position);
        room.projectors.push_back(spot(position, number(0, 6.28), is_across(i)));
        room.tints.push_back(glm::vec3{number(0.5, 1), number(0.5, 1), number(0.5, 1)});
        room.regions_in_reach.push_back(volume_region);
    }
    return room;
}

}  // namespace report::lit_room
