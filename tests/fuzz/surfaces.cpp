// What the projection makes of surfaces, over raw bytes: signs are exact, numbers are near to themselves, and what has
// none is empty.

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "fuzz/input.hpp"
#include "support/surfaces.hpp"
#include "texgen/surface.hpp"

namespace {

using fuzz::Input;
using fuzz::must;
using texgen::TextureOrigin;

bool is_known(const glm::vec4& corner) {
    return std::isfinite(corner.x) && std::isfinite(corner.y) && std::isfinite(corner.w);
}

void triangles(Input& input) {
    const glm::vec4 a = input.vector4(), b = input.vector4(), c = input.vector4();
    const support::Corners corners{a, b, c};
    const auto origin = input.coin() ? TextureOrigin::bottom_left : TextureOrigin::top_left;
    const auto facing = texgen::facing(a, b, c, origin);
    const auto area = texgen::slide_area(a, b, c);
    const auto plane = texgen::receiver_plane(a, b, c);
    if (!is_known(a) || !is_known(b) || !is_known(c)) {
        must(facing == texgen::Facing::edge_on, "what is not finite is seen edge on");
        must(!area && !plane, "and has neither an area nor a plane");
        return;
    }
    const int sign = support::exact_determinant(corners).sign();
    must(facing == support::facing_of_sign(sign, origin), "the side that is seen is exact");
    must(area.has_value() == (a.w > 0.0f && b.w > 0.0f && c.w > 0.0f), "an area needs all corners in front");
    if (area)
        must(support::relative_error(*area, support::exact_slide_area(corners)) <= texgen::slide_area_error,
             "an area is within 2^-50 of itself");
    const bool has_depth = std::isfinite(a.z) && std::isfinite(b.z) && std::isfinite(c.z);
    must(plane.has_value() == (has_depth && sign != 0), "a plane needs a triangle that is not seen edge on");
    if (!plane) return;
    const auto exact = support::exact_receiver_plane(corners);
    for (int k = 0; k < 3; ++k)
        must(support::relative_error((*plane)[k], exact[static_cast<std::size_t>(k)]) <= texgen::receiver_plane_error,
             "a slope is within 2^-49 of itself");
}

void quadrilaterals(Input& input) {
    support::Quadrilateral corners;
    bool is_in_range = true, is_soon_divided = true;
    for (glm::dvec2& corner : corners) {
        for (int k = 0; k < 2; ++k) {
            corner[k] = input.wide_number();
            const double size = std::fabs(corner[k]);
            is_in_range = is_in_range && (size == 0.0 || (size >= 0x1p-400 && size <= 0x1p400));
            is_soon_divided = is_soon_divided && (size == 0.0 || (size >= 0x1p-60 && size <= 0x1p60));
        }
    }
    const auto region = input.region();
    const auto strq = texgen::quadrilateral(corners, region);
    const auto matrix = texgen::keystone(corners, region);
    must(is_in_range || (!strq && !matrix), "corners of any size are refused");
    must(!matrix || fuzz::all_finite(matrix->matrix()), "a matrix is finite");
    if (!is_in_range) return;
    const auto exact = support::exact_q(corners);
    must(exact || (!strq && !matrix), "what is not strictly convex is refused");
    for (std::size_t k = 0; k < 4 && strq; ++k)
        must(support::ulp_error((*strq)[k].w, (*exact)[k]) <= 2.51, "a q is the homography's");
    // Fractions of numbers that differ by 2^800 take long.
    if (const auto whole = texgen::keystone(corners); whole && is_soon_divided && input.coin())
        must(support::measured_keystone_error(*whole, corners, texgen::whole_texture()) <= texgen::keystone_error,
             "a matrix is the homography's");
    if (const auto whole = texgen::quadrilateral(corners)) {
        for (std::size_t k = 0; k < 4; ++k) {
            const glm::vec4& corner = (*whole)[k];
            must(corner.x == (k == 1 || k == 2 ? corner.w : 0.0f) && corner.y == (k >= 2 ? corner.w : 0.0f),
                 "the corners of the whole texture are exact");
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Input input(data, size);
    if (input.coin())
        triangles(input);
    else
        quadrilaterals(input);
    return 0;
}
