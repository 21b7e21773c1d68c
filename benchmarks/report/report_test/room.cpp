// The room, which every compiler furnishes alike.

#include <doctest/doctest.h>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <texgen/primitives.hpp>

#include "../room/objects.hpp"

TEST_CASE("a crate's numbers are drawn from x to z") {
    const report::lit_room::Room room = report::lit_room::make_objects();
    report::lit_room::Numbers number;
    const double x = number(0.08, 0.25), y = number(0.06, 0.3), z = number(0.08, 0.25);
    const texgen::Box& crate = room.bounds[room.crates.front()];
    CHECK(crate.max == glm::vec3(x, y, z));
    const double along = number(-14, 14), across = number(-14, 14);
    const glm::dvec4 place = room.models[room.crates.front()].matrix()[3];
    CHECK(place == glm::dvec4(along, static_cast<double>(crate.max.y), across, 1.0));
}
