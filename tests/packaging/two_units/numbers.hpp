#pragma once

#include <array>
#include <texgen/texgen.hpp>

// What each unit computes: s, t and lit of points on a floor, then of the fragments of a triangle.
inline constexpr std::size_t side = 16;
using Plane = std::array<float, side * side>;
struct Numbers {
    texgen::Work (*interpolate)(const texgen::TriangleSetup&, const texgen::FragmentRect&,
                                const texgen::Texcoords&) noexcept;  // its own
    Plane point_s, point_t, point_lit, fragment_s, fragment_t, fragment_lit;
};

// Static, so that each unit has its own; what it calls in the library is shared, if the linker so decides.
static Numbers numbers() {
    using namespace texgen;
    const auto projector =
        make_projector(PerspectiveLens{.fovy = degrees(30), .aspect = 1, .z_near = 0.2, .z_far = 1000},
                       Aim{.position = {2, 5, 5}, .target = {-2, -4, 0}, .up = {0, 1, 0}}, opengl);
    const WorldTexgen texture_from_floor = texture_from_world(*projector);
    Numbers result{};
    result.interpolate = &interpolate<void>;

    std::array<glm::vec3, side * side> points;
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = {-10.0f + static_cast<float>(i % side), -4.0f, -8.0f + static_cast<float>(i / side)};
    project(texture_from_floor, world_space(points), whole_texture(),
            {.s = result.point_s, .t = result.point_t, .r = {}, .lit = result.point_lit});

    std::array<glm::vec4, 3> strq;
    const glm::vec3 corners[] = {{-10, -4, -8}, {6, -4, -8}, {-2, -4, 8}};
    generate(texture_from_floor, world_space(corners), strq);
    const auto setup =
        TriangleSetup::of({{{0, 0}, 1, strq[0]}, {{16, 0}, 3, strq[1]}, {{8, 16}, 2, strq[2]}}, whole_texture());
    if (setup)
        interpolate(*setup, {0, 0, static_cast<int>(side), static_cast<int>(side)},
                    {.s = result.fragment_s, .t = result.fragment_t, .r = {}, .lit = result.fragment_lit});
    return result;
}
