#pragma once

// The worst of surfaces and quadrilaterals.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "judges/oracle.hpp"
#include "support/random.hpp"
#include "support/surfaces.hpp"
#include "texgen/surface.hpp"

namespace ceilings {

using support::Random;

struct WorstSurfaces {
    double area = 0.0, plane = 0.0;  // relative, in 2^-52
};
inline constexpr std::array<const char*, support::corner_families.size()> corner_families{
    "ordinary", "some corners behind", "next to edge on", "edge on, and a bit beside it", "graded",
    "any bits", "one far to the side"};

inline WorstSurfaces of_surfaces(support::CornerFamily family, std::uint64_t seed) {
    Random random(seed);
    WorstSurfaces worst;
    for (int i = 0; i < 2000; ++i) {
        const support::Corners corners = support::corners_of(family, random);
        if (const auto area = texgen::slide_area(corners[0], corners[1], corners[2]))
            worst.area =
                std::max(worst.area, 0x1p52 * support::relative_error(*area, support::exact_slide_area(corners)));
        const auto plane = texgen::receiver_plane(corners[0], corners[1], corners[2]);
        const auto exact = support::exact_receiver_plane(corners);
        for (int k = 0; k < 3 && plane; ++k)
            worst.plane = std::max(worst.plane,
                                   0x1p52 * support::relative_error((*plane)[k], exact[static_cast<std::size_t>(k)]));
    }
    return worst;
}

inline constexpr std::array<const char*, support::shapes.size()> shapes{
    "ordinary",      "whole numbers", "next to a triangle", "to 1e7 from the origin", "units to 1e100",
    "thin to 1e-18", "graded"};

struct WorstQuadrilaterals {
    double q = 0.0, matrix = 0.0;  // float ulps; 2^-52 of an element's terms
};

inline WorstQuadrilaterals of_quadrilaterals(support::Shape shape, std::uint64_t seed) {
    Random random(seed);
    WorstQuadrilaterals worst;
    for (int i = 0; i < 500; ++i) {
        const support::Quadrilateral corners = support::corners_of(shape, random);
        if (const auto matrix = texgen::keystone(corners); matrix && i % 4 == 0)
            worst.matrix = std::max(
                worst.matrix, 0x1p52 * support::measured_keystone_error(*matrix, corners, texgen::whole_texture()));
        const auto strq = texgen::quadrilateral(corners);
        if (!strq) continue;
        const auto exact = support::exact_q(corners).value();
        for (std::size_t k = 0; k < 4; ++k) worst.q = std::max(worst.q, support::ulp_error((*strq)[k].w, exact[k]));
    }
    return worst;
}

}  // namespace ceilings
