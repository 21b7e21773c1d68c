#pragma once

// Workloads of lenses and aims.

#include <cmath>
#include <cstddef>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "support/random.hpp"
#include "support/stopwatch.hpp"
#include "support/workloads/numbers.hpp"
#include "support/workloads/texgens.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/projector.hpp"

namespace support::detail {

inline Numbers ordinary_look(Random& random) {
    const texgen::Aim aim = ordinary_aim(random);
    return numbers(aim.position, aim.target, aim.up, glm::dvec3(0.7, 1.3, 0.5), glm::dvec4(-1.0, 1.1, -0.9, 1.0), 20.0);
}
inline Numbers draw_look(Random& random) {
    Numbers n = ordinary_look(random);
    const int kind = random.integer(0, 3);
    if (kind == 0)
        for (double& x : n) x = any_float(random);
    if (kind == 1)  // up almost along the view
        for (std::size_t k = 0; k < 3; ++k) n[6 + k] = (n[3 + k] - n[k]) * (1.0 + random.power_of_ten(-17.0, -1.0));
    if (kind == 2) {
        const double unit = random.power_of_ten(-300.0, 300.0);
        for (double& x : n) x *= random.coin() ? unit : 1.0;
    }
    return n;
}
inline constexpr Inputs look_inputs{0, ordinary_look, draw_look, "drawn: up next to the view, or numbers of any size"};
inline texgen::Aim aim_of(Reader& reader) {
    const glm::dvec3 position = reader.dvec3(), target = reader.dvec3();
    return {position, target, reader.dvec3()};
}
inline Calls look_at_calls(const Numbers& n) {
    Reader reader(n);
    return calls_of([aim = aim_of(reader)] { keep(texgen::look_at(aim)); });
}
// The numbers behind an aim: an angle, an aspect, a near plane; four sides; a far plane.
template <int Kind>
Calls lens_calls(const Numbers& n) {
    Reader reader(n);
    const texgen::Aim aim = aim_of(reader);
    const glm::dvec3 a = reader.dvec3();
    const glm::dvec4 sides = reader.dvec4();
    const double z_far = reader.real();
    const texgen::PerspectiveLens perspective{texgen::radians(a.x), a.y, a.z, z_far};
    const texgen::FrustumLens frustum{sides.x, sides.y, sides.z, sides.w, a.z, z_far};
    const texgen::OrthographicLens orthographic{sides.x, sides.y, sides.z, sides.w, a.z, z_far};
    const texgen::PinholeLens pinhole{
        a.x, a.y, sides.x, sides.y, std::fabs(sides.z), sides.w, a.z, z_far, texgen::PixelCentre::half};
    return calls_of([=] {
        if constexpr (Kind == 0) keep(texgen::perspective(perspective, texgen::opengl));
        if constexpr (Kind == 1) keep(texgen::frustum(frustum, texgen::opengl));
        if constexpr (Kind == 2) keep(texgen::orthographic(orthographic, texgen::opengl));
        if constexpr (Kind == 3) keep(texgen::make_projector(perspective, aim, texgen::opengl));
        if constexpr (Kind == 4) keep(texgen::make_projector(frustum, aim, texgen::opengl));
        if constexpr (Kind == 5) keep(texgen::make_projector(orthographic, aim, texgen::opengl));
        if constexpr (Kind == 6) keep(texgen::pinhole(pinhole, texgen::opengl));
        if constexpr (Kind == 7) keep(texgen::make_projector(pinhole, aim, texgen::opengl));
        if constexpr (Kind == 8) {
            const glm::dmat4 view{glm::dvec4(aim.position, 0.0), glm::dvec4(aim.target, 0.0), glm::dvec4(aim.up, 0.0),
                                  glm::dvec4(a, 1.0)};
            keep(texgen::mirrored(texgen::ProjectorView(view), sides));
        }
        if constexpr (Kind == 9) keep(texgen::view_from_opencv({aim.position, aim.target, aim.up}, a));
        if constexpr (Kind == 10) keep(texgen::contain(perspective, a.x + a.y));
        if constexpr (Kind == 11) keep(texgen::cover(frustum, sides.y));
        if constexpr (Kind == 12) keep(texgen::diagnose(perspective, aim, texgen::opengl));
        if constexpr (Kind == 13) keep(texgen::diagnose(frustum, aim, texgen::opengl));
        if constexpr (Kind == 14) keep(texgen::diagnose(orthographic, aim, texgen::opengl));
        if constexpr (Kind == 15) keep(texgen::diagnose(pinhole, aim, texgen::opengl));
    });
}

}  // namespace support::detail
