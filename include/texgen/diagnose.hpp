#pragma once

// Floor 7: what is wrong with a projector, a texgen matrix or a whole set-up, in words. It looks for marks that no
// valid set-up can carry, so it keeps silent where it cannot know: the more it is told, the more it sees.

#include "detail/language.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/inverse.hpp"
#include "detail/arithmetic/rounding.hpp"
#include "detail/arithmetic/widen.hpp"
#include "detail/culling/slide_planes.hpp"
#include "detail/diagnosis/composition.hpp"
#include "detail/diagnosis/matrix_signs.hpp"
#include "detail/diagnosis/seen_lens.hpp"
#include "linear.hpp"
#include "projector.hpp"
#include "scale_bias.hpp"
#include "texcoord.hpp"
#include "transform.hpp"

namespace TEXGEN_NAMESPACE {

// In the order of the findings: numbers that mean nothing, why a lens or an aim is refused, how a product was made,
// what the lens does, and last what may be no more than the consequence of those before it.
enum class Defect {
    not_finite,
    angle_out_of_range,
    aspect_not_positive,
    near_not_in_front,
    far_not_beyond_near,
    lens_without_extent,
    focal_length_not_positive,
    picture_without_size,
    target_at_position,
    up_is_zero,
    up_parallel_to_view,
    beyond_double,
    never_written,
    q_row_zero,
    rank_below_three,
    transposed,
    view_projection_swapped,
    wrong_order,
    view_not_inverted,
    camera_not_inverted,
    camera_left_out,
    camera_inverse_doubled,
    model_inverted,
    model_left_out,
    model_doubled,
    scale_bias_missing,
    scale_bias_doubled,
    bias_without_w,
    mixed_handedness,
    depth_range_mismatch,
    angle_unit_mistaken,
    upside_down,
    mirrored,
    aspect_inverted,
    not_of_this_set_up,
    precision_lost,
    everything_behind,
    everything_below_depth,
    everything_above_depth,
    region_never_hit,
    smaller_than_texel,
};

// The number of defects.
inline constexpr std::size_t defect_count = static_cast<std::size_t>(Defect::smaller_than_texel) + 1;

// A defect, what is wrong and what to do, a sentence each.
struct DefectInWords {
    Defect defect;
    std::string_view what, remedy;
};

// What to say of each defect, in the order of the enumerators.
inline constexpr std::array<DefectInWords, defect_count> defects_in_words{{
    {Defect::not_finite, "A number is infinite or not a number.",
     "Look for a division by zero, an uninitialised value, or a z_far whose lens has no infinite one."},
    {Defect::angle_out_of_range, "The lens's angle is not between 0 and 180 degrees, both excluded.",
     "Pass the full vertical angle, as texgen::degrees() or texgen::radians()."},
    {Defect::aspect_not_positive, "The lens's aspect is not positive.",
     "Pass width / height, both positive and neither a division of integers."},
    {Defect::near_not_in_front, "The near plane is not in front of the projector.",
     "Pass a z_near above 0: a distance, not a coordinate."},
    {Defect::far_not_beyond_near, "The far plane is not beyond the near plane.",
     "Pass z_near < z_far; reversed depth is a flag of the lens, not an order."},
    {Defect::lens_without_extent, "The lens has no width or no height: left equals right, or bottom equals top.",
     "Pass two sides that differ."},
    {Defect::focal_length_not_positive, "A focal length is not positive.",
     "Pass fx and fy in pixels, as the camera's matrix K has them on its diagonal."},
    {Defect::picture_without_size, "The picture has no width or no height.", "Pass its size in pixels."},
    {Defect::target_at_position, "The projector looks at the point where it stands.",
     "Pass a target that differs from the position."},
    {Defect::up_is_zero, "The up direction is zero.", "Pass a direction, as (0, 1, 0)."},
    {Defect::up_parallel_to_view,
     "The up direction is parallel to the view, so that it does not say how to turn the picture.",
     "Pass another up: for a projector that looks straight down, the direction of the picture's upper side."},
    {Defect::beyond_double, "A number of the lens's or the view's matrix is beyond what a double holds.",
     "Check the units: numbers are too large or too close to one another."},
    {Defect::never_written, "The matrix was never written: it is zero, or holds OpenGL's default planes.",
     "Upload S P_p V_p M (object linear) or S P_p V_p V_e^-1 (eye linear) before it is used."},
    {Defect::q_row_zero, "Row q is zero, so that nothing can be divided by q.",
     "Write the Q plane too: OpenGL leaves R and Q at zero until glTexGen is called for them."},
    {Defect::rank_below_three, "The rows s, t and q are dependent: the picture falls on a line or a point.",
     "Look for a lens without width or height, a scale of zero, or a plane written twice."},
    {Defect::transposed, "The matrix is transposed: it was written for row vectors.",
     "Transpose it, or upload it with the other row or column order."},
    {Defect::view_projection_swapped, "The projector's view and projection have changed places.",
     "Compose P_p V_p, the projection on the left."},
    {Defect::wrong_order, "The factors stand in the wrong order.",
     "Compose S P_p V_p M or S P_p V_p V_e^-1: column vectors, the first on the right, none transposed."},
    {Defect::view_not_inverted, "The projector's pose stands where its view belongs, the pose's inverse.",
     "Pass V_p as look_at() makes it, from the world to the projector: invert the pose."},
    {Defect::camera_not_inverted, "The camera's view matrix stands where its inverse belongs.",
     "Pass the camera's pose, V_e^-1."},
    {Defect::camera_left_out, "The camera's inverse is missing.",
     "Multiply by V_e^-1, or give the planes to glTexGen while MODELVIEW holds V_e."},
    {Defect::camera_inverse_doubled, "The camera's inverse is in the matrix twice.",
     "glTexGen multiplies eye planes by the inverse of MODELVIEW: either let it, or load the identity first."},
    {Defect::model_inverted, "The inverse of the model matrix stands where the model matrix belongs.",
     "Pass the matrix from object to world."},
    {Defect::model_left_out, "The model matrix is missing.",
     "Multiply by M, or generate coordinates from points in the world."},
    {Defect::model_doubled, "The model matrix is in the matrix twice.",
     "Multiply by M once: points in object space need nothing else."},
    {Defect::scale_bias_missing, "The scale-bias is missing: the picture spans [-1, 1].",
     "Multiply by scale_bias() from the left."},
    {Defect::scale_bias_doubled, "The scale-bias is in the matrix twice.",
     "Leave out one of them, in the matrix or in the shader."},
    {Defect::bias_without_w, "The bias is added without w: clip * 0.5 + 0.5 before the division.",
     "Multiply the bias by w, as scale_bias() and to_texture() do, or divide first."},
    {Defect::mixed_handedness,
     "The lens is made for the other handedness: it looks down +z where the conventions' eye looks down -z, or the "
     "reverse.",
     "Take view, lens and conventions for one handedness: left_handed(...) for LookAtLH and PerspectiveFovLH."},
    {Defect::depth_range_mismatch, "The depth range is not that of the conventions.",
     "Build lens and scale-bias for one range, [-1, 1] for OpenGL and [0, 1] for Direct3D, Metal and Vulkan, and one "
     "mapping of r."},
    {Defect::angle_unit_mistaken,
     "The lens opens by another angle than meant, or turns the picture by half a turn: an angle has the wrong unit.",
     "Pass the angle as texgen::degrees() or texgen::radians()."},
    {Defect::upside_down, "The picture is upside-down for the conventions.",
     "Match the y direction and the texture origin, or the order of bottom and top; say so where it is meant."},
    {Defect::mirrored, "The picture is mirrored.",
     "Look for left and right exchanged, or a reflection in the view; say so where it is meant."},
    {Defect::aspect_inverted, "The aspect is inverted: height over width.", "Pass width / height."},
    {Defect::not_of_this_set_up, "The texgen matrix is not what this projector, pose and region compose.",
     "Make it anew whenever one of them changes, and diagnose it with those that it was made from."},
    {Defect::precision_lost, "Precision is lost, far from the origin or in an extreme lens.",
     "Compose in double, and generate from object or eye space: object_linear() or eye_linear()."},
    {Defect::everything_behind, "Every point is behind the projector.",
     "Check the aim, the side that the lens looks to, and the sign of the matrix."},
    {Defect::everything_below_depth,
     "No point reaches the region's depth: r is less than r_min, before the near plane, or beyond the far one where "
     "depth is reversed.",
     "Check z_near and z_far, the depth of the region, and how r is mapped: unit or ndc."},
    {Defect::everything_above_depth,
     "Every point is past the region's depth: r is more than r_max, beyond the far plane, or before the near one where "
     "depth is reversed.",
     "Check z_near and z_far, the depth of the region, and how r is mapped: unit or ndc."},
    {Defect::region_never_hit, "No point can be inside the region: the slide misses all.",
     "Check the aim, the field of view and the region."},
    {Defect::smaller_than_texel, "The picture is smaller than a texel there.",
     "Check the units of the scene, the region and the lens."},
}};

// A defect, and what to say of it.
struct Finding {
    Defect defect;
    double number;  // precision_lost: the expected error, smaller_than_texel: the size, both in texels; otherwise 0

    std::string_view what() const noexcept;    // what is wrong, a sentence
    std::string_view remedy() const noexcept;  // what to do, a sentence
};

// The findings, each defect at most once, so that there is room for all; most likely first.
class Diagnosis {
public:
    bool empty() const noexcept { return size_ == 0; }
    std::size_t size() const noexcept { return size_; }
    const Finding* begin() const noexcept { return findings_.data(); }
    const Finding* end() const noexcept { return findings_.data() + size_; }
    const Finding& operator[](std::size_t i) const noexcept { return findings_[i]; }

    bool contains(Defect defect) const noexcept;

    // Keeps the order; a defect that is there already stays as it is.
    void add(Defect defect, double number = 0.0) noexcept;

private:
    std::array<Finding, defect_count> findings_{};
    std::size_t size_ = 0;
};

// What the lens was meant to be, as far as it is known. A mistake is named that makes of it the lens that is there;
// where none does, that is another lens, and not wrong.
struct LensFacts {
    std::optional<Angle> fovy = std::nullopt;
    std::optional<double> aspect = std::nullopt;  // otherwise that of the region in texels, where they are given
    std::optional<double> z_near = std::nullopt;
    std::optional<double> z_far = std::nullopt;
    bool mirrored = false;  // left > right or bottom > top on purpose, as for projection from behind
};

// What is known of a set-up whose points are in Space. Every field may be left out: region and depth are then what
// linear.hpp takes them for.
template <class Space>
struct ProjectionSetup {
    std::optional<Projector> projector = std::nullopt;
    std::optional<Transform<World, Space>> world_from_space = std::nullopt;  // M, or the camera's V_e^-1
    std::optional<Transform<Texture, Space>> texgen = std::nullopt;
    std::optional<Positions<Space>> points = std::nullopt;  // vertices, so that what matters is in their convex hull
    TextureRegion region = whole_texture();
    DepthMapping depth = DepthMapping::unit;
    std::optional<Conventions> conventions = std::nullopt;  // of a texgen matrix whose projector is not given
    glm::dvec2 texels_per_unit{};  // the texture's size, or (1, 1) for a rectangle texture; 0 where not known
    LensFacts lens = {};
};

// The former name, until 0.5.
template <class Space>
using Setup = ProjectionSetup<Space>;

// Says what is wrong with a set-up, most likely first; empty where nothing is known to be.
// Guarantee: no finding for a set-up that projector.hpp and linear.hpp can make, in double or rounded to float, under
// any conventions, lens, pose of regular matrices (of a camera that is not given: a rigid one) and distance from the
// origin, but for what is true of it: that it lights none of the points, shows all of them less than a texel, or loses
// half a texel (of a picture of 4096, where the texture's size is not given). A lens that mirrors says so in its facts,
// a model may mirror. No mistake is named of numbers beyond 2^150 or below 2^-150. No allocation, noexcept.
// What it sees: of a projector alone, its matrices' own marks (transposed, exchanged, of rank
// below 3, mirrored, reversed depth in the wrong range, a near plane that is not in front); with facts of the lens also
// an aspect, an angle or a depth range that becomes theirs by a mistake: inverted, in another unit, for the other
// range. With the projector, and the model or the camera, which of their products a texgen matrix is, of up to two
// mistakes; and if it is none of them whether it or a factor of it is transposed, the lens that it was made with, P' =
// S^-1 T X^-1 V^-1, against the projector's, and what shows without the pose. Of a texgen matrix alone, the marks of
// rows r and q; with facts of the lens the lens in it, the scale-bias and the depth range; and without them what
// numbers say that people write: whole degrees, or planes of two digits, which a mistake explains and nothing valid
// does. In float, or of factors in float, numbers have too few digits for a range, and for an angle unless the picture
// stands on its head in the world for the conventions given. Of a window's fragments: numbers, rank and points alone.
// What it cannot see: mistakes that are other set-ups, until it is told what was meant. The lens from 0.1 to 100 for
// [0, 1], under the bias of [-1, 1], is the one from 10/199.9 to 100 for [-1, 1]: any row z that is not reversed is
// that of some lens in both ranges. A matrix in NDC, without the bias, is that of an off-axis lens (with a fovy of 90
// degrees even of one with round numbers); a pose is the view from another place; and a lens along an axis of an object
// whose pose is not given may have been stretched with it. A near plane that is oblique, by hand, shows a wrong order
// until projector and model are given.
// Cost: about a microsecond for what was composed in double, several for what was composed in float or has a defect;
// the worst set-up takes at most 8 times what one with a single defect does.
// Bad input: what is not finite is reported, and the rest is examined without it.
// Source: Everitt, Projective Texture Mapping, (3) and (4), and what is made of them.
template <class Space>
Diagnosis diagnose(const ProjectionSetup<Space>& setup) noexcept;

// Says the same of a projector alone.
inline Diagnosis diagnose(const Projector& projector) noexcept;

// Says the same of a texgen matrix, with what else is known.
template <class Space>
Diagnosis diagnose(const Transform<Texture, Space>& texgen,
                   const ProjectionSetup<std::type_identity_t<Space>>& setup = {}) noexcept;

// Says the same of a texgen matrix that is given as planes S, T, R, Q, as glGetTexGen or planes() returns them.
template <class Space = Object>
Diagnosis diagnose(const std::array<glm::vec4, 4>& planes, const ProjectionSetup<Space>& setup = {}) noexcept;

// Says why make_projector(lens, aim, conventions) is empty: each way in which the lens and the aim are refused.
// Guarantee: empty where, and only where, make_projector() makes a projector. No allocation, noexcept.
// An angle of more than a turn is taken for degrees that were passed as radians.
// Bad input: what is not finite is reported, and the rest is examined without it.
inline Diagnosis diagnose(const PerspectiveLens& lens, const Aim& aim, const Conventions& conventions) noexcept;
inline Diagnosis diagnose(const FrustumLens& lens, const Aim& aim, const Conventions& conventions) noexcept;
inline Diagnosis diagnose(const OrthographicLens& lens, const Aim& aim, const Conventions& conventions) noexcept;
inline Diagnosis diagnose(const PinholeLens& lens, const Aim& aim, const Conventions& conventions) noexcept;

}  // namespace TEXGEN_NAMESPACE

#include "detail/diagnosis/points.inc.hpp"
#include "detail/diagnosis/projector.inc.hpp"
#include "detail/diagnosis/refusals.inc.hpp"
#include "detail/diagnosis/see_through.inc.hpp"
#include "detail/diagnosis/seen_alone.inc.hpp"
#include "detail/diagnosis/set_up.inc.hpp"
