#pragma once

// Workloads of OpenGL's fixed function.

#include <cstddef>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "support/random.hpp"
#include "support/stopwatch.hpp"
#include "support/workloads/numbers.hpp"
#include "texgen/fixed_function.hpp"

namespace support::detail {

inline Numbers ordinary_vertex(Random& random) {
    Numbers n = numbers(rounded(random.rigid(5.0)), random.vector4(1.0));
    n.back() = 1.0;
    put(n, random.vector3(1.0));
    put(n, random.vector4(1.0));
    return n;
}
inline Numbers draw_vertex(Random& random) {
    Numbers n = random.coin() ? any_numbers<27>(random) : ordinary_vertex(random);
    if (random.coin())
        for (std::size_t i = 16; i < 27; ++i) n[i] = any_float(random);
    return n;
}
inline constexpr Inputs vertex_inputs{27, ordinary_vertex, draw_vertex, "drawn: any numbers"};
template <texgen::TexGenMode Mode>
Calls unit_calls(const Numbers& n) {
    using texgen::Coordinate;
    Reader reader(n);
    const glm::mat4 modelview = reader.mat4();
    texgen::FixedFunctionVertex vertex{};
    vertex.position = reader.vec4();
    vertex.normal = reader.vec3();
    const glm::vec4 plane = reader.vec4();
    texgen::TexGenUnit unit;
    unit.set_normal_scaling(texgen::TexGenUnit::NormalScaling::normalize);
    for (const Coordinate coordinate : {Coordinate::s, Coordinate::t, Coordinate::r, Coordinate::q}) {
        unit.enable(coordinate, unit.set_mode(coordinate, Mode));
        unit.set_object_plane(coordinate, plane);
        static_cast<void>(unit.set_eye_plane(coordinate, plane, modelview));
    }
    return calls_of([unit, vertex, modelview] { keep(unit.generate(vertex, modelview)); });
}
template <bool OfBound>
Calls eye_plane_calls(const Numbers& n) {
    using texgen::Coordinate;
    Reader reader(n);
    const glm::mat4 modelview = reader.mat4();
    const glm::vec4 plane = reader.vec4();
    return calls_of([modelview, plane, unit = texgen::TexGenUnit()]() mutable {
        if constexpr (OfBound)
            keep(unit.eye_plane_error_bound(Coordinate::s, plane, modelview));
        else
            keep(unit.set_eye_plane(Coordinate::s, plane, modelview));
    });
}

// Of a batch, with the normals left as they are.
inline Calls unit_batch_calls(const Numbers& n) {
    using texgen::Coordinate;
    Reader reader(n);
    const glm::mat4 modelview = reader.mat4();
    std::vector<texgen::FixedFunctionVertex> vertices(64);
    vertices[0].position = reader.vec4();
    vertices[0].normal = reader.vec3();
    for (texgen::FixedFunctionVertex& vertex : vertices) vertex = vertices[0];
    texgen::TexGenUnit unit;
    for (const Coordinate coordinate : {Coordinate::s, Coordinate::t, Coordinate::r})
        unit.enable(coordinate, unit.set_mode(coordinate, texgen::TexGenMode::normal_map));
    return calls_of([unit, vertices, modelview, out = std::vector<glm::vec4>(64)]() mutable {
        unit.generate(vertices, modelview, out);
        keep(out[0]);
    });
}

}  // namespace support::detail
