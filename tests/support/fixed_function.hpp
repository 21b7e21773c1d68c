// What the tests of the fixed function ask about: every coordinate, mode and scaling, and the slide projector of the
// README.

#pragma once

#include <array>

#include "texgen/fixed_function.hpp"
#include "texgen/projector.hpp"

namespace support {

using texgen::Coordinate;
using texgen::TexGenMode;
using texgen::TexGenUnit;
using NormalScaling = TexGenUnit::NormalScaling;

inline constexpr std::array coordinates{Coordinate::s, Coordinate::t, Coordinate::r, Coordinate::q};
inline constexpr std::array modes{TexGenMode::object_linear, TexGenMode::eye_linear, TexGenMode::sphere_map,
                                  TexGenMode::reflection_map, TexGenMode::normal_map};
inline constexpr std::array scalings{NormalScaling::none, NormalScaling::rescale, NormalScaling::normalize};

inline texgen::Projector slide_projector() {
    return texgen::make_projector(
               texgen::PerspectiveLens{.fovy = texgen::degrees(30.0), .aspect = 1.0, .z_near = 0.2, .z_far = 1000.0},
               texgen::Aim{.position = {2.0, 5.0, 5.0}, .target = {-2.0, -4.0, 0.0}, .up = {0.0, 1.0, 0.0}},
               texgen::opengl)
        .value();
}

}  // namespace support
