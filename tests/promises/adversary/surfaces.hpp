#pragma once

// The promises of surfaces.

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "judges/exact.hpp"
#include "judges/oracle.hpp"
#include "promises/adversary/inputs.hpp"
#include "promises/adversary/shares.hpp"
#include "support/random.hpp"
#include "support/surfaces.hpp"
#include "texgen/surface.hpp"

namespace adversary {

inline support::Corners surface_of(const Numbers& n) { return {floats4(n, 0), floats4(n, 4), floats4(n, 8)}; }
inline Numbers begin_surface(Random& random) {
    const support::Corners corners =
        support::corners_of(support::corner_families[random.bits() % support::corner_families.size()], random);
    Numbers n;
    for (const glm::vec4& corner : corners)
        for (int k = 0; k < 4; ++k) n.push_back(static_cast<double>(corner[k]));
    return n;
}

inline Share facing_share(const Numbers& n) {
    const support::Corners corners = surface_of(n);
    const Dyadic exact = support::exact_determinant(corners);
    const auto answer = texgen::facing(corners[0], corners[1], corners[2], texgen::TextureOrigin::bottom_left);
    if (answer != support::facing_of_sign(exact.sign(), texgen::TextureOrigin::bottom_left)) return broken;
    Dyadic terms;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 1; j < 3; ++j)
            terms = terms + magnitude(Dyadic(corners[i].x) * Dyadic(corners[(i + j) % 3].y) *
                                      Dyadic(corners[(i + 2 * j) % 3].w));
    return terms.sign() == 0 ? says_nothing : share_of_decision(std::fabs(exact.estimate()) / terms.estimate());
}

inline Share slide_area_share(const Numbers& n) {
    const support::Corners corners = surface_of(n);
    const auto area = texgen::slide_area(corners[0], corners[1], corners[2]);
    if (!area) return says_nothing;
    return support::relative_error(*area, support::exact_slide_area(corners)) / texgen::slide_area_error;
}

inline Share receiver_plane_share(const Numbers& n) {
    const support::Corners corners = surface_of(n);
    const auto plane = texgen::receiver_plane(corners[0], corners[1], corners[2]);
    const Dyadic divisor = support::exact_determinant(corners);
    if (plane.has_value() != (divisor.sign() != 0)) return broken;
    if (!plane) return says_nothing;
    double worst = 0.0;
    for (int k = 0; k < 3; ++k)
        worst = std::max(worst, support::relative_error(
                                    (*plane)[k], support::exact_receiver_plane(corners)[static_cast<std::size_t>(k)]));
    return worst / texgen::receiver_plane_error;
}

inline support::Quadrilateral quadrilateral_of(const Numbers& n) {
    return {glm::dvec2(n[0], n[1]), glm::dvec2(n[2], n[3]), glm::dvec2(n[4], n[5]), glm::dvec2(n[6], n[7])};
}

// The error of an element, and the refusal of what is not strictly convex.
inline Share keystone_share(const Numbers& n) {
    if (!is_in_range(n, 0x1p-400, 0x1p400)) return says_nothing;
    const support::Quadrilateral corners = quadrilateral_of(n);
    const auto matrix = texgen::keystone(corners);
    if (!support::exact_q(corners)) return matrix ? broken : says_nothing;
    if (!matrix) return says_nothing;
    return support::measured_keystone_error(*matrix, corners, texgen::whole_texture()) / texgen::keystone_error;
}

// The worst ulp of a q, where a half is allowed, and the refusal of what is not strictly convex.
inline Share quadrilateral_share(const Numbers& n) {
    if (!is_in_range(n, 0x1p-400, 0x1p400)) return says_nothing;
    const support::Quadrilateral corners = quadrilateral_of(n);
    const auto exact = support::exact_q(corners);
    const auto strq = texgen::quadrilateral(corners);
    if (!exact) return strq ? broken : says_nothing;
    if (!strq) return says_nothing;
    double worst = 0.0;
    for (std::size_t k = 0; k < 4; ++k) worst = std::max(worst, support::ulp_error((*strq)[k].w, (*exact)[k]));
    return worst / 0.51;
}

}  // namespace adversary
