#pragma once

// Projectors and texgen matrices, ordinary and drawn, that workloads of points and bodies take.

#include <cmath>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "support/random.hpp"
#include "support/workloads/numbers.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace support::detail {

inline texgen::Aim ordinary_aim(Random& random) {
    const glm::dvec3 position = 4.0 * random.direction();
    return {position, 0.3 * random.direction(), glm::dvec3(0.1, 1.0, 0.2)};
}
inline texgen::Projector ordinary_projector(Random& random) {
    const texgen::PerspectiveLens lens{texgen::degrees(random.uniform(30.0, 60.0)), 1.3, 0.5, 100.0};
    return texgen::make_projector(lens, ordinary_aim(random), texgen::opengl).value();
}
inline glm::dmat4 ordinary_texgen(Random& random) {
    return texgen::texture_from_world(ordinary_projector(random)).matrix();
}
// Along the axes, with small numbers: s = x / 8 + 1/2.
inline glm::dmat4 aligned_texgen(Random& random) {
    const double half = std::ldexp(1.0, random.integer(-1, 3));
    const texgen::OrthographicLens lens{-half, half, -half, half, 0.0, 16.0};
    const texgen::Aim aim{{0.0, 0.0, 8.0}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    const texgen::PerspectiveLens open{texgen::degrees(90.0), 1.0, 0.5, 64.0};
    return texgen::texture_from_world(random.coin() ? texgen::make_projector(lens, aim, texgen::opengl).value()
                                                    : texgen::make_projector(open, aim, texgen::opengl).value())
        .matrix();
}
inline glm::dmat4 drawn_texgen(Random& random) {
    switch (random.integer(0, 3)) {
        case 0:
            return ordinary_texgen(random);
        case 1: {
            glm::dmat4 m(0.0);
            for (int i = 0; i < 4; ++i)
                for (int k = 0; k < 4; ++k) m[i][k] = any_float(random);
            return m;
        }
        default:
            return aligned_texgen(random);
    }
}

}  // namespace support::detail
