#pragma once

// Floor 7: what is wrong with a projector, a texgen matrix or a whole set-up, in words. It looks for marks that no valid
// set-up can carry, so it keeps silent where it cannot know: the more it is told, the more it sees.

#include "detail/language.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
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
#include "detail/diagnosis/composition.hpp"
#include "detail/diagnosis/matrix_signs.hpp"
#include "linear.hpp"
#include "projector.hpp"
#include "texcoord.hpp"
#include "transform.hpp"

namespace TEXGEN_NAMESPACE {

// In the order of the findings: numbers that mean nothing, how a product was made, what the lens does, and last what may
// be no more than the consequence of those before it.
enum class Defect {
    not_finite,
    never_written,
    q_row_zero,
    rank_below_three,
    transposed,
    view_projection_swapped,
    wrong_order,
    camera_not_inverted,
    camera_left_out,
    camera_inverse_doubled,
    model_inverted,
    model_left_out,
    model_doubled,
    scale_bias_missing,
    scale_bias_doubled,
    depth_range_mismatch,
    angle_unit_mistaken,
    upside_down,
    mirrored,
    aspect_inverted,
    not_of_this_set_up,
    precision_lost,
    everything_behind,
    region_never_hit,
    smaller_than_texel,
};

// Of the defects above.
inline constexpr std::size_t defect_count = static_cast<std::size_t>(Defect::smaller_than_texel) + 1;

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

    bool contains(Defect defect) const noexcept {
        for (const Finding& finding : *this)
            if (finding.defect == defect) return true;
        return false;
    }

    // Keeps the order; a defect that is there already stays as it is.
    void add(Defect defect, double number = 0.0) noexcept {
        if (contains(defect)) return;
        std::size_t i = size_++;
        for (; i > 0 && defect < findings_[i - 1].defect; --i) findings_[i] = findings_[i - 1];
        findings_[i] = {defect, number};
    }

private:
    std::array<Finding, defect_count> findings_{};
    std::size_t size_ = 0;
};

// What the lens was meant to be, as far as it is known.
struct LensFacts {
    std::optional<Angle> fovy = std::nullopt;
    std::optional<double> aspect = std::nullopt;  // otherwise that of the region in texels, where they are given
    std::optional<double> z_near = std::nullopt;
    std::optional<double> z_far = std::nullopt;
    bool mirrored = false;  // left > right or bottom > top on purpose, as for projection from behind
};

// What is known of a set-up whose points are in Space. Every field may be left out.
template <class Space>
struct Setup {
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

namespace detail {
inline namespace TEXGEN_COMPILER {

struct Sentences {
    std::string_view what, remedy;
};

inline constexpr std::array<Sentences, defect_count> sentences{{
    {"A number is infinite or not a number.",
     "Look for a division by zero, an empty lens or an uninitialised value before it."},
    {"The matrix was never written: it is zero, or holds OpenGL's default planes.",
     "Upload S P_p V_p M (object linear) or S P_p V_p V_e^-1 (eye linear) before it is used."},
    {"Row q is zero, so that nothing can be divided by q.",
     "Write the Q plane too: OpenGL leaves R and Q at zero until glTexGen is called for them."},
    {"The rows s, t and q are dependent: the picture falls on a line or a point.",
     "Look for a lens without width or height, a scale of zero, or a plane written twice."},
    {"The matrix is transposed: it was written for row vectors.",
     "Transpose it, or upload it with the other row or column order."},
    {"The projector's view and projection have changed places.", "Compose P_p V_p, the projection on the left."},
    {"The factors stand in the wrong order.",
     "Compose S P_p V_p M or S P_p V_p V_e^-1: column vectors, the first transform on the right."},
    {"The camera's view matrix stands where its inverse belongs.", "Pass the camera's pose, V_e^-1."},
    {"The camera's inverse is missing.",
     "Multiply by V_e^-1, or give the planes to glTexGen while MODELVIEW holds V_e."},
    {"The camera's inverse is in the matrix twice.",
     "glTexGen multiplies eye planes by the inverse of MODELVIEW: either let it, or load the identity first."},
    {"The inverse of the model matrix stands where the model matrix belongs.", "Pass the matrix from object to world."},
    {"The model matrix is missing.", "Multiply by M, or generate coordinates from points in the world."},
    {"The model matrix is in the matrix twice.", "Multiply by M once: points in object space need nothing else."},
    {"The scale-bias is missing: the picture spans [-1, 1].", "Multiply by scale_bias() from the left."},
    {"The scale-bias is in the matrix twice.", "Leave out one of them, in the matrix or in the shader."},
    {"The depth range is not that of the conventions.",
     "Build projection and scale-bias for one range: [-1, 1] for OpenGL, [0, 1] for Direct3D, Metal and Vulkan."},
    {"The lens opens by another angle than meant, or turns the picture by half a turn: an angle has the wrong unit.",
     "Pass the angle as texgen::degrees() or texgen::radians()."},
    {"The picture is upside-down for the conventions.",
     "Match the y direction and the texture origin, or the order of bottom and top; say so where it is meant."},
    {"The picture is mirrored.",
     "Look for left and right exchanged, or a reflection in the view; say so where it is meant."},
    {"The aspect is inverted: height over width.", "Pass width / height."},
    {"The texgen matrix is not what this projector, pose and region compose.",
     "Make it anew whenever one of them changes, and diagnose it with those that it was made from."},
    {"Precision is lost, far from the origin or in an extreme lens.",
     "Compose in double, and generate from object or eye space: object_linear() or eye_linear()."},
    {"Every point is behind the projector.",
     "Check the aim, the side that the lens looks to, and the sign of the matrix."},
    {"No point can be inside the region: the slide misses all.", "Check the aim, the field of view and the region."},
    {"The picture is smaller than a texel there.", "Check the units of the scene, the region and the lens."},
}};

// Whether a matrix holds numbers to go on with; if not, says why.
inline bool is_usable(const glm::dmat4& m, Diagnosis& diagnosis) noexcept {
    if (!is_finite(m)) {
        diagnosis.add(Defect::not_finite);
        return false;
    }
    if (m == glm::dmat4(0.0)) {
        diagnosis.add(Defect::never_written);
        return false;
    }
    return true;
}

inline constexpr double accepted_error_in_texels = 0.5;

struct Picture {
    TextureRegion region = whole_texture();
    glm::dvec2 texels_per_unit{};

    bool is_empty() const noexcept {
        return (region.min)().x > (region.max)().x || (region.min)().y > (region.max)().y;
    }
    bool is_measured() const noexcept { return texels_per_unit.x > 0.0 && texels_per_unit.y > 0.0; }
    glm::dvec2 extent() const noexcept { return (region.max)() - (region.min)(); }

    // Of a picture of 4096 texels where the texture's size is not known.
    glm::dvec2 texels() const noexcept { return is_measured() ? texels_per_unit : 4096.0 / extent(); }
};

inline void examine_lens(const glm::dmat4& p, bool view_reflects, Conventions conventions, const LensFacts& facts,
                         const Picture& picture, Diagnosis& diagnosis) noexcept {
    const double unit = is_perspective(p) ? std::fabs(p[2].w) : p[3].w;
    const double width = p[0].x / unit;
    const double height = (conventions.ndc_y == NdcY::up ? p[1].y : -p[1].y) / unit;
    if (unit < 0.0) diagnosis.add(Defect::everything_behind);
    if (mistakes_depth(p, conventions.depth, facts.z_near, facts.z_far)) diagnosis.add(Defect::depth_range_mismatch);
    if (is_perspective(p) && facts.fovy && mistakes_unit(height, *facts.fovy))
        diagnosis.add(Defect::angle_unit_mistaken);

    if (!facts.mirrored) {
        // A tangent beyond 90 degrees turns both axes round: no lens does it, and an angle in the wrong unit does.
        if (view_reflects) {
            if (width * height > 0.0) diagnosis.add(Defect::mirrored);
        } else if (width < 0.0 && height < 0.0) {
            diagnosis.add(Defect::angle_unit_mistaken);
        } else if (width < 0.0) {
            diagnosis.add(Defect::mirrored);
        } else if (height < 0.0) {
            diagnosis.add(Defect::upside_down);
        }
    }

    const glm::dvec2 size = picture.extent() * picture.texels_per_unit;
    const double meant = facts.aspect ? *facts.aspect : picture.is_measured() ? size.x / size.y : 1.0;
    const double aspect = std::fabs(height / width);
    // Texels need not be square: without the aspect that was meant only the very inverse, in floats, is a mark.
    const double rounding = facts.aspect ? 0x1p-12 : 0x1p-22;
    if (std::fabs(meant - 1.0) > 0x1p-10 && std::fabs(aspect * meant - 1.0) <= rounding)
        diagnosis.add(Defect::aspect_inverted);
}

inline void examine(const Projector& projector, const LensFacts& facts, const Picture& picture,
                    Diagnosis& diagnosis) noexcept {
    glm::dmat4 p = projector.projection.matrix();
    glm::dmat4 v = projector.view.matrix();
    const bool has_projection = is_usable(p, diagnosis);
    const bool has_view = is_usable(v, diagnosis);

    // A view is affine, and one that is not is no view; a rotation is no lens.
    if (has_projection && has_view && is_lens(v) && distance_from_rigid(p) < 1e-3 &&
        (is_perspective(v) || !is_lens(p))) {
        diagnosis.add(Defect::view_projection_swapped);
        std::swap(p, v);
    }
    if (has_view) {
        if (is_affine_transposed(v)) {
            diagnosis.add(Defect::transposed);
            v = transposed(v);
        }
        if (!are_independent(v, axes)) diagnosis.add(Defect::rank_below_three);
    }
    if (has_projection) {
        if (is_lens_transposed(p)) {
            diagnosis.add(Defect::transposed);
            p = transposed(p);
        }
        const bool regular = are_independent(p, {0, 1, 3});
        if (!regular) diagnosis.add(Defect::rank_below_three);
        const bool view_reflects = has_view && is_affine(v) && minor(v, axes, axes).value < 0.0;
        if (regular && is_lens(p)) examine_lens(p, view_reflects, projector.conventions, facts, picture, diagnosis);
    }
}

inline void examine(const Composition& composition, bool in_eye_space, Diagnosis& diagnosis) noexcept {
    if (composition.transposed) diagnosis.add(Defect::transposed);
    if (composition.order == Order::view_before_projection) diagnosis.add(Defect::view_projection_swapped);
    if (composition.order == Order::wrong) diagnosis.add(Defect::wrong_order);
    switch (composition.pose) {
        case PoseUse::right:
            break;
        case PoseUse::inverted:
            diagnosis.add(in_eye_space ? Defect::camera_not_inverted : Defect::model_inverted);
            break;
        case PoseUse::left_out:
            diagnosis.add(in_eye_space ? Defect::camera_left_out : Defect::model_left_out);
            break;
        case PoseUse::doubled:
            diagnosis.add(in_eye_space ? Defect::camera_inverse_doubled : Defect::model_doubled);
            break;
    }
    if (composition.scale_bias == ScaleBiasUse::left_out) diagnosis.add(Defect::scale_bias_missing);
    if (composition.scale_bias == ScaleBiasUse::doubled) diagnosis.add(Defect::scale_bias_doubled);
    if (composition.other_depth) diagnosis.add(Defect::depth_range_mismatch);
    if (composition.t_mirrored) diagnosis.add(Defect::upside_down);
    if (composition.s_mirrored) diagnosis.add(Defect::mirrored);
    if (composition.multiple < 0.0) diagnosis.add(Defect::everything_behind);
}

// Everything but the points, and the matrix that these are to be seen with: the texgen matrix that is given, or the one
// that the set-up composes.
struct Examined {
    std::optional<glm::dmat4> texgen, right;  // right: what the set-up composes, where texgen is that but for rounding
    // What floats lose of the texgen matrix, element by element: half the bound on their rounding, where they are rounded.
    glm::dmat4 lost{0.0};
};

// What is lost of s and t at every point that is lit: that of the rows' constants, where q is largest, on the far plane.
// 0 where that is infinitely far, or row r does not say.
inline double least_error_in_texels(const Examined& examined, const Picture& picture, DepthMapping depth) noexcept {
    const glm::dmat4& texgen = *examined.texgen;
    const DepthRows rows = depth_rows(texgen);
    const double constant = texgen[3].z - rows.limit * texgen[3].w;  // r = limit q + constant
    const double far_end = rows.limit > 0.5 ? 1.0 : depth == DepthMapping::unit ? 0.0 : -1.0;
    const double largest_q = rows.is_parallel_light ? texgen[3].w : constant / (far_end - rows.limit);
    const glm::dvec2 texels = picture.texels();
    const double error = larger(examined.lost[3].x * texels.x, examined.lost[3].y * texels.y) / largest_q;
    return rows.are_parallel && largest_q > 0.0 && is_finite(error) ? error : 0.0;
}

// What the points say. Each question is whether all of them are on one side of a plane, with the bound on the rounding:
// then their convex hull is too, and no face between them is lit.
class PointReport {
public:
    PointReport(const Examined& examined, const Picture& picture, DepthMapping depth) noexcept
        : has_texgen_(examined.texgen),
          has_right_(examined.right),
          texgen_(rows(examined.texgen)),
          right_(rows(examined.right)),
          lost_(rows(examined.lost)),
          picture_(picture) {
        if (has_texgen_) error_in_texels_ = least_error_in_texels(examined, picture, depth);
    }

    void add(const glm::dvec3& v) noexcept {
        if (!is_finite(v.x) || !is_finite(v.y) || !is_finite(v.z)) {
            all_finite_ = false;
            return;
        }
        const Bounded s = value_at(texgen_[0], v);
        const Bounded t = value_at(texgen_[1], v);
        const Bounded q = value_at(texgen_[2], v);
        ++count_;
        behind_ = behind_ && q.value <= -q.error;
        for (std::size_t side = 0; side < 4; ++side) {
            const Bounded& u = side < 2 ? s : t;
            const double end = at(side % 2 == 0 ? (picture_.region.min)() : (picture_.region.max)(), side / 2);
            const double distance = side % 2 == 0 ? u.value - end * q.value : end * q.value - u.value;
            const double error =
                u.error + std::fabs(end) * q.error + gamma(3) * (std::fabs(u.value) + std::fabs(end * q.value));
            outside_[side] = outside_[side] && distance < -error;
        }
        const glm::dvec2 st = glm::dvec2(s.value, t.value) / q.value;
        // What floats have thrown behind the projector too.
        if (has_right_ && q.value != 0.0) compare(v, st);
        if (!(q.value > q.error)) {
            all_in_front_ = false;
            return;
        }
        if (in_front_++ == 0) {
            first_ = v;
            least_ = most_ = st;
        }
        distinct_ = distinct_ || v != first_;
        for (glm::length_t k = 0; k < 2; ++k) {
            least_[k] = smaller(least_[k], st[k]);
            most_[k] = larger(most_[k], st[k]);
        }
        // Where it is known what is right, compare() has measured it.
        if (!has_right_ && is_lit(st)) {
            const double lost_of_q = terms_at(lost_[2], v);
            for (glm::length_t k = 0; k < 2; ++k)
                raise((terms_at(lost_[k == 0 ? 0 : 1], v) + std::fabs(st[k]) * lost_of_q) / q.value,
                      picture_.texels()[k]);
        }
    }

    void conclude(Diagnosis& diagnosis) const noexcept {
        if (!all_finite_) diagnosis.add(Defect::not_finite);
        if (error_in_texels_ > accepted_error_in_texels) diagnosis.add(Defect::precision_lost, error_in_texels_);
        if (count_ == 0 || !has_texgen_) return;
        if (behind_) diagnosis.add(Defect::everything_behind);
        for (const bool outside : outside_)
            if (outside) diagnosis.add(Defect::region_never_hit);
        const glm::dvec2 texels = picture_.texels();
        const double size = larger((most_.x - least_.x) * texels.x, (most_.y - least_.y) * texels.y);
        if (all_in_front_ && distinct_ && texels.x > 0.0 && texels.y > 0.0 && size < 1.0)
            diagnosis.add(Defect::smaller_than_texel, size);
    }

private:
    // Rows s, t and q; zero where there is no matrix.
    static std::array<PointForm, 3> rows(const std::optional<glm::dmat4>& m) noexcept {
        if (!m) return {};
        return {{form(*m, 0), form(*m, 1), form(*m, 3)}};
    }

    static double at(const glm::dvec2& v, std::size_t component) noexcept { return component == 0 ? v.x : v.y; }

    bool is_lit(const glm::dvec2& st) const noexcept {
        return st.x >= (picture_.region.min)().x && st.x <= (picture_.region.max)().x &&
               st.y >= (picture_.region.min)().y && st.y <= (picture_.region.max)().y;
    }

    void raise(double error, double texels) noexcept { error_in_texels_ = larger(error * texels, error_in_texels_); }

    // With what the set-up composes in double.
    void compare(const glm::dvec3& v, const glm::dvec2& st) noexcept {
        const double q = value_at(right_[2], v).value;
        const glm::dvec2 right = glm::dvec2(value_at(right_[0], v).value, value_at(right_[1], v).value) / q;
        if (!(q > 0.0) || !is_lit(right)) return;
        for (glm::length_t k = 0; k < 2; ++k) raise(std::fabs(st[k] - right[k]), picture_.texels()[k]);
    }

    bool has_texgen_, has_right_;
    std::array<PointForm, 3> texgen_, right_, lost_;  // rows s, t and q
    Picture picture_;
    std::size_t count_ = 0, in_front_ = 0;
    bool all_finite_ = true, behind_ = true, all_in_front_ = true, distinct_ = false;
    std::array<bool, 4> outside_{true, true, true, true};
    glm::dvec3 first_{0.0};
    glm::dvec2 least_{0.0}, most_{0.0};
    double error_in_texels_ = 0.0;
};

// All of a set-up but its points.
struct SetupMatrices {
    const Projector* projector = nullptr;
    const glm::dmat4* pose = nullptr;    // null: not known, or the points are in the world
    const glm::dmat4* texgen = nullptr;  // null: what the projector and the pose compose
    bool are_planes = false;             // texgen is what hardware holds, in float whatever its numbers
    bool in_world_space = false, in_eye_space = false;
    Picture picture = {};
    DepthMapping depth = DepthMapping::unit;
    std::optional<Conventions> conventions = std::nullopt;
    LensFacts lens = {};
};

inline bool is_nan(double value) noexcept { return !(std::fabs(value) <= std::numeric_limits<double>::infinity()); }

inline bool are_numbers(const SetupMatrices& setup) noexcept {
    const TextureRegion& region = setup.picture.region;
    const LensFacts& lens = setup.lens;
    // An infinite side of the region is none, but no scale-bias reaches it.
    const auto is_side = [&](const glm::dvec2& side) {
        return setup.projector != nullptr ? is_finite(side.x) && is_finite(side.y) : !is_nan(side.x) && !is_nan(side.y);
    };
    const auto is_given_finite = [](const std::optional<double>& value) { return !value || is_finite(*value); };
    return is_side((region.min)()) && is_side((region.max)()) && is_finite(setup.picture.texels_per_unit.x) &&
           is_finite(setup.picture.texels_per_unit.y) && is_given_finite(lens.aspect) && is_given_finite(lens.z_near) &&
           !(lens.z_far && is_nan(*lens.z_far)) && !(lens.fovy && !is_finite(lens.fovy->in_radians()));
}

// Returns whether it is transposed.
inline bool examine_alone(const glm::dmat4& texgen, const SetupMatrices& setup, Diagnosis& diagnosis) noexcept {
    constexpr double margin = 0x1p-10;
    const DepthRows rows = depth_rows(texgen);
    if (!rows.are_parallel) {
        const bool is_transposed = depth_rows(transposed(texgen)).are_parallel;
        diagnosis.add(is_transposed ? Defect::transposed : Defect::wrong_order);
        return is_transposed;
    }
    // As in mistakes_depth(): no range has infinity there.
    if (rows.limit > margin && rows.limit < 1.0 - margin) diagnosis.add(Defect::depth_range_mismatch);
    const std::optional<Conventions> conventions =
        setup.projector != nullptr ? std::optional(setup.projector->conventions) : setup.conventions;
    const bool is_placed = setup.in_world_space || setup.pose != nullptr;
    if (conventions && is_placed && !setup.lens.mirrored &&
        is_mirrored(texgen, setup.pose != nullptr ? *setup.pose : glm::dmat4(1.0), conventions->origin))
        diagnosis.add(Defect::mirrored);
    return false;
}

// Half the bound on the rounding of an element to float, relative to it.
inline constexpr double expected_rounding = 0.5 * unit_roundoff_float;

// The smaller of the magnitudes of both elements.
inline glm::dmat4 smaller_elements(const glm::dmat4& a, const glm::dmat4& b) noexcept {
    glm::dmat4 result(0.0);
    for (glm::length_t column = 0; column < 4; ++column)
        for (glm::length_t row = 0; row < 4; ++row)
            result[column][row] = smaller(std::fabs(a[column][row]), std::fabs(b[column][row]));
    return result;
}

// What floats lose of the matrix where the product is known: nothing of elements that are its own. The rounding of others moves the multiple that
// fits best, so that one of few bits next to it is taken for what was meant.
inline glm::dmat4 lost_of(const glm::dmat4& texgen, const Product& right) noexcept {
    const double fitted = multiple_of(right, texgen, composed_in_float);
    const double large = 0x1p37 * fitted;
    const double of_few_bits = (fitted + large) - large;
    const double multiple = std::fabs(fitted - of_few_bits) < 0x1p-20 * fitted ? of_few_bits : fitted;
    return smaller_elements(texgen - multiple * right.value, expected_rounding * texgen);
}

inline Examined examine(const SetupMatrices& setup, Diagnosis& diagnosis) noexcept {
    if (!are_numbers(setup)) diagnosis.add(Defect::not_finite);
    if (setup.picture.is_empty()) diagnosis.add(Defect::region_never_hit);
    const glm::dvec2 texels = setup.picture.extent() * setup.picture.texels_per_unit;
    if (setup.picture.is_measured() && !setup.picture.is_empty() && smaller(texels.x, texels.y) < 1.0)
        diagnosis.add(Defect::smaller_than_texel, smaller(texels.x, texels.y));

    Examined examined;
    std::optional<Factors> factors;
    if (setup.projector != nullptr) {
        examine(*setup.projector, setup.lens, setup.picture, diagnosis);
        if (setup.pose != nullptr || setup.in_world_space) {
            factors = Factors{setup.projector->projection.matrix(), setup.projector->view.matrix(), std::nullopt,
                              setup.projector->conventions,         setup.picture.region,           setup.depth};
        }
    }
    if (setup.pose != nullptr) {
        if (!is_usable(*setup.pose, diagnosis)) factors.reset();
        if (is_affine_transposed(*setup.pose)) diagnosis.add(Defect::transposed);
        if (factors) factors->pose = *setup.pose;
    }
    std::optional<Product> right;
    if (factors) {
        right = right_composition(*factors);
        if (!is_finite(right->value) || right->value == glm::dmat4(0.0)) right.reset();
    }

    if (setup.texgen == nullptr) {
        if (!right) return examined;
        examined.texgen = right->value;
        const glm::dmat4& view = setup.projector->view.matrix();
        if (is_in_float(view)) {
            const Product lens = scale_bias_factor(*factors, {}) * lens_factor(factors->projection);
            const glm::dmat4 by_view = lens.magnitude * rounded_magnitudes(view);
            const glm::dmat4 by_all = factors->pose ? by_view * lens_factor(*factors->pose).magnitude : by_view;
            examined.lost = expected_rounding * smaller_elements(by_all, right->value);
        }
        return examined;
    }
    const glm::dmat4& texgen = *setup.texgen;
    if (!is_usable(texgen, diagnosis)) return examined;
    if (is_opengl_default(texgen)) {
        diagnosis.add(Defect::never_written);
        return examined;
    }
    examined.texgen = texgen;
    const bool in_float = setup.are_planes || is_in_float(texgen);
    if (in_float) examined.lost = expected_rounding * rounded_magnitudes(texgen);
    const bool has_q = !is_zero_row(texgen, 3);
    const bool is_dependent = has_q && !are_independent(texgen, {0, 1, 3});
    bool was_transposed = false;
    const auto composition = right ? composition_of(texgen, *factors, *right, in_float) : std::nullopt;
    if (composition) {
        examine(*composition, setup.in_eye_space, diagnosis);
        const bool is_right = mistakes(*composition) == 0 && composition->multiple > 0.0;
        if (is_right) {
            examined.right = right->value;
            if (in_float) examined.lost = lost_of(texgen, *right);
        }
        if (is_right && is_dependent) diagnosis.add(Defect::rank_below_three);
        was_transposed = composition->transposed;
    } else if (is_dependent) {
        diagnosis.add(Defect::rank_below_three);
    } else if (right) {
        diagnosis.add(Defect::not_of_this_set_up);
    } else if (has_q) {
        was_transposed = examine_alone(texgen, setup, diagnosis);
    }
    if (!has_q || (was_transposed && is_zero_row(transposed(texgen), 3))) diagnosis.add(Defect::q_row_zero);
    if (!has_q) examined.texgen.reset();
    return examined;
}

template <class Space>
SetupMatrices matrices_of(const Setup<Space>& setup, bool are_planes) noexcept {
    return {setup.projector ? &*setup.projector : nullptr,
            setup.world_from_space ? &setup.world_from_space->matrix() : nullptr,
            setup.texgen ? &setup.texgen->matrix() : nullptr,
            are_planes,
            std::is_same_v<Space, World>,
            std::is_same_v<Space, Eye>,
            {setup.region, setup.texels_per_unit},
            setup.depth,
            setup.conventions,
            setup.lens};
}

template <class Space>
Diagnosis diagnose(const Setup<Space>& setup, bool are_planes) noexcept {
    Diagnosis diagnosis;
    const SetupMatrices matrices = matrices_of(setup, are_planes);
    const Examined examined = examine(matrices, diagnosis);
    PointReport report(examined, matrices.picture, matrices.depth);
    const std::size_t count = setup.points ? setup.points->size() : 0;
    for (std::size_t i = 0; i < count; ++i) report.add(widened((*setup.points)[i]));
    report.conclude(diagnosis);
    return diagnosis;
}

}  // namespace TEXGEN_COMPILER
}  // namespace detail

inline std::string_view Finding::what() const noexcept {
    return detail::sentences[static_cast<std::size_t>(defect)].what;
}
inline std::string_view Finding::remedy() const noexcept {
    return detail::sentences[static_cast<std::size_t>(defect)].remedy;
}

// What is wrong with a set-up, most likely first; empty where nothing is known to be.
// Guarantee: no finding for a set-up that projector.hpp and linear.hpp can make, in double or rounded to float, under any
// conventions, lens, pose of regular matrices and distance from the origin, but for what is true of it: that it lights
// none of the points, shows all of them less than a texel, or loses half a texel (of a picture of 4096, where the
// texture's size is not given). A lens that mirrors says so in its facts, a model may mirror. No allocation, noexcept.
// Microseconds, and tenths of a millisecond where the texgen matrix is not what the set-up composes.
// What it sees: of a projector alone, its matrices' own marks (transposed, exchanged, of rank below 3, mirrored, reversed
// depth in the wrong range); with facts of the lens also its depth range, aspect and angle. Of a texgen matrix alone,
// those of its rows r and q. With the projector, and the model or the camera, which of their products it is, of up to
// two mistakes. Depth that is not reversed needs the distance of a plane: any row z is that of some lens in both ranges.
// Bad input: what is not finite is reported, and the rest is examined without it.
// Source: Everitt, Projective Texture Mapping, (3) and (4), and what is made of them.
template <class Space>
Diagnosis diagnose(const Setup<Space>& setup) noexcept {
    return detail::diagnose(setup, false);
}

// The same of a projector alone.
inline Diagnosis diagnose(const Projector& projector) noexcept {
    Diagnosis diagnosis;
    const detail::Examined examined = detail::examine({.projector = &projector, .in_world_space = true}, diagnosis);
    detail::PointReport(examined, {}, DepthMapping::unit).conclude(diagnosis);
    return diagnosis;
}

// The same of a texgen matrix, with what else is known.
template <class Space>
Diagnosis diagnose(const Transform<Texture, Space>& texgen,
                   const Setup<std::type_identity_t<Space>>& setup = {}) noexcept {
    Setup<Space> whole = setup;
    whole.texgen = texgen;
    return diagnose(whole);
}

// The same of planes S, T, R, Q as glGetTexGen or planes() returns them.
template <class Space = Object>
Diagnosis diagnose(const std::array<glm::vec4, 4>& planes, const Setup<Space>& setup = {}) noexcept {
    const glm::dmat4 rows(detail::widened(planes[0]), detail::widened(planes[1]), detail::widened(planes[2]),
                          detail::widened(planes[3]));
    Setup<Space> whole = setup;
    whole.texgen.emplace(detail::transposed(rows));
    return detail::diagnose(whole, true);
}

}  // namespace TEXGEN_NAMESPACE
