#pragma once

// The corpus of defects, and rigs that are spoilt by one of them or by two.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "api/diagnose_test/rigs.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/projector.hpp"
#include "texgen/scale_bias.hpp"

namespace diagnose_cases {

// What can go wrong, the defect that it is to be found as, and the one thing about the set-up that it changes.
enum class Thing {
    numbers,
    q,
    transposition,
    order,
    pose,
    scale_bias,
    depth_of_scale_bias,
    side_of_s,
    side_of_t,
    depth_of_lens,
    signs,
    hand,
    aspect,
    exchange,
    transposed_projection,
    transposed_view,
    width,
    age,
    points,
    precision,
};

struct Kind {
    const char* name;
    Defect defect;
    Thing thing;
};

inline constexpr std::array kinds{
    Kind{"a NaN", Defect::not_finite, Thing::numbers},
    Kind{"never written", Defect::never_written, Thing::numbers},
    Kind{"t written as s", Defect::rank_below_three, Thing::numbers},
    Kind{"Q not written", Defect::q_row_zero, Thing::q},
    Kind{"transposed", Defect::transposed, Thing::transposition},
    Kind{"S V P X", Defect::view_projection_swapped, Thing::order},
    Kind{"another order", Defect::wrong_order, Thing::order},
    Kind{"V_e for its inverse", Defect::camera_not_inverted, Thing::pose},
    Kind{"no V_e^-1", Defect::camera_left_out, Thing::pose},
    Kind{"V_e^-1 twice", Defect::camera_inverse_doubled, Thing::pose},
    Kind{"M^-1 for M", Defect::model_inverted, Thing::pose},
    Kind{"no M", Defect::model_left_out, Thing::pose},
    Kind{"M twice", Defect::model_doubled, Thing::pose},
    Kind{"no S", Defect::scale_bias_missing, Thing::scale_bias},
    Kind{"S twice", Defect::scale_bias_doubled, Thing::scale_bias},
    Kind{"S of the other range", Defect::depth_range_mismatch, Thing::depth_of_scale_bias},
    Kind{"s turned", Defect::mirrored, Thing::side_of_s},
    Kind{"S of the other origin", Defect::upside_down, Thing::side_of_t},
    Kind{"a lens of the other range", Defect::depth_range_mismatch, Thing::depth_of_lens},
    Kind{"degrees for radians", Defect::angle_unit_mistaken, Thing::signs},
    Kind{"a mirrored lens", Defect::mirrored, Thing::signs},
    Kind{"a lens of the other hand", Defect::mixed_handedness, Thing::hand},
    Kind{"a lens upside-down", Defect::upside_down, Thing::signs},
    Kind{"height over width", Defect::aspect_inverted, Thing::aspect},
    Kind{"view and projection exchanged", Defect::view_projection_swapped, Thing::exchange},
    Kind{"a projection of rows", Defect::transposed, Thing::transposed_projection},
    Kind{"a view of rows", Defect::transposed, Thing::transposed_view},
    Kind{"a lens without width", Defect::rank_below_three, Thing::width},
    Kind{"made before the projector moved", Defect::not_of_this_set_up, Thing::age},
    Kind{"all behind", Defect::everything_behind, Thing::points},
    Kind{"beside the slide", Defect::region_never_hit, Thing::points},
    Kind{"in one texel", Defect::smaller_than_texel, Thing::points},
    Kind{"float far from the origin", Defect::precision_lost, Thing::precision},
};

inline bool is_composition(Thing thing) {
    return thing == Thing::transposition || thing == Thing::order || thing == Thing::pose ||
           thing == Thing::scale_bias || thing == Thing::depth_of_scale_bias || thing == Thing::side_of_s ||
           thing == Thing::side_of_t;
}

// Why one of two hides the other; null where both can be seen.
inline const char* one_hides(Thing a, Thing b) {
    if (a == b) return "they are two states of one thing";
    if (a == Thing::numbers) {
        if (is_composition(b) || b == Thing::q || b == Thing::age || b == Thing::points || b == Thing::precision)
            return "what was lost of the matrix cannot be read";
    }
    if (a == Thing::age && (is_composition(b) || b == Thing::precision))
        return "of other factors nobody knows the product";
    if (a == Thing::scale_bias && (b == Thing::depth_of_scale_bias || b == Thing::side_of_s || b == Thing::side_of_t))
        return "there is no one scale-bias to be wrong in itself";
    if (a == Thing::q && (b == Thing::points || b == Thing::precision)) return "without q no point has coordinates";
    if (a == Thing::width) {
        if (b == Thing::signs || b == Thing::hand || b == Thing::aspect || b == Thing::depth_of_lens)
            return "a lens without width is no lens, upright or not";
        if (is_composition(b) || b == Thing::points || b == Thing::precision || b == Thing::age)
            return "the line that it lights is that of many products";
    }
    if (a == Thing::exchange && (b == Thing::transposed_projection || b == Thing::transposed_view))
        return "a transposed matrix is neither a lens nor a pose, in whose place it may stand";
    if (a == Thing::hand) {
        if (b == Thing::signs) return "with both axes turned round it is the matrix of the other sign";
        if (b == Thing::precision) return "what would be lit is behind";
    }
    if (a == Thing::precision) {
        if (is_composition(b) || b == Thing::exchange || b == Thing::transposed_projection ||
            b == Thing::transposed_view || b == Thing::points)
            return "the error is that of what is lit, and the slide falls elsewhere";
    }
    return nullptr;
}

class Faults {
public:
    explicit Faults(std::vector<const Kind*> faults) : faults_(std::move(faults)) {}

    bool has(const char* name) const {
        REQUIRE(
            std::any_of(kinds.begin(), kinds.end(), [&](const Kind& kind) { return std::string(kind.name) == name; }));
        return std::any_of(faults_.begin(), faults_.end(),
                           [&](const Kind* kind) { return std::string(kind->name) == name; });
    }
    bool has(Thing thing) const {
        return std::any_of(faults_.begin(), faults_.end(), [&](const Kind* kind) { return kind->thing == thing; });
    }
    bool has(Defect defect) const {
        return std::any_of(faults_.begin(), faults_.end(), [&](const Kind* kind) { return kind->defect == defect; });
    }

private:
    std::vector<const Kind*> faults_;
};

inline Rig rig_for(const Faults& faults, Random& random) {
    Range range = ordinary;
    if (faults.has(Thing::precision)) range.distance = 6.5;
    if (faults.has(Thing::points)) range.parallel = false;
    for (;;) {
        const Rig rig = random_rig(range, random);
        const bool needs_eye = faults.has(Defect::camera_not_inverted) || faults.has(Defect::camera_left_out) ||
                               faults.has(Defect::camera_inverse_doubled);
        if (needs_eye && rig.in != In::eye) continue;
        if (faults.has(Thing::pose) && !needs_eye && rig.in != In::object) continue;
        const bool needs_lens = faults.has(Thing::aspect) || faults.has("degrees for radians");
        if (needs_lens && !rig.lens.is_symmetric()) continue;
        if (faults.has(Defect::mixed_handedness) && rig.lens.kind == LensKind::orthographic) continue;
        if (faults.has(Thing::precision) && dot3(rig.aim.position, rig.aim.position) < 1e10) continue;
        return rig;
    }
}

inline Conventions of_other_range(Conventions c) {
    return {c.depth == DepthRange::zero_to_one ? DepthRange::negative_one_to_one : DepthRange::zero_to_one, c.ndc_y,
            c.origin, c.handedness};
}

// The projector's two matrices, with what is wrong with them.
inline Projector spoilt_projector(const Rig& rig, const Faults& faults) {
    Lens lens = rig.lens;
    if (faults.has(Thing::aspect)) lens.aspect = 1.0 / lens.aspect;
    glm::dmat4 p =
        projection(lens, faults.has(Thing::depth_of_lens) ? of_other_range(rig.conventions) : rig.conventions);
    glm::dmat4 v = rig.view;
    if (faults.has("degrees for radians")) {
        const double focal_length = 1.0 / std::tan(0.5 * lens.fovy);
        p[0][0] = focal_length / lens.aspect;
        p[1][1] = std::copysign(1.0, p[1][1]) * focal_length;
    }
    if (faults.has("a lens of the other hand")) p[2] = -p[2];
    for (int i = 0; i < 4; ++i) {
        if (faults.has("a mirrored lens")) p[i][0] = -p[i][0];
        if (faults.has("a lens upside-down")) p[i][1] = -p[i][1];
    }
    if (faults.has(Thing::width)) p[0][0] = 0.0;
    if (faults.has(Thing::transposed_projection)) p = transposed(p);
    if (faults.has(Thing::transposed_view)) v = transposed(v);
    if (faults.has(Thing::exchange)) std::swap(p, v);
    return projector_of(rig, p, v);
}

// An order of S (0), P (1), V (2), X (3) of which those that are there stand neither right nor with V and P exchanged.
inline std::optional<std::array<int, 4>> wrong_order(bool has_s, bool has_x, Random& random) {
    std::array<int, 4> order{0, 1, 2, 3};
    for (int i = 3; i > 0; --i)
        std::swap(order[static_cast<std::size_t>(i)], order[static_cast<std::size_t>(random.integer(0, i))]);
    std::vector<int> left;
    for (const int factor : order)
        if ((factor != 0 || has_s) && (factor != 3 || has_x)) left.push_back(factor);
    std::vector<int> swapped = left;
    for (int& factor : swapped) factor = factor == 1 ? 2 : factor == 2 ? 1 : factor;
    if (std::is_sorted(left.begin(), left.end()) || std::is_sorted(swapped.begin(), swapped.end())) return std::nullopt;
    return order;
}

// The texgen matrix, with what is wrong with it; empty where chance made it right, or the wrongs cancel.
inline std::optional<glm::dmat4> spoilt_texgen(const Rig& rig, const Projector& given, const Faults& faults,
                                               Random& random) {
    Projector projector = given;
    if (faults.has(Thing::age)) projector.view = texgen::ProjectorView(random.rigid(5.0) * projector.view.matrix());
    if (faults.has(Thing::precision))
        return rig.in == In::world ? to_float(composed(rig, projector)) : composed_in_float(rig, projector);

    const Conventions c = faults.has(Thing::depth_of_scale_bias) ? of_other_range(rig.conventions) : rig.conventions;
    const bool halves = faults.has(Thing::depth_of_scale_bias) && rig.conventions.depth == DepthRange::zero_to_one;
    glm::dmat4 s = scale_bias(c, rig.region, halves ? DepthMapping::unit : rig.depth).matrix();
    if (faults.has(Thing::depth_of_scale_bias) && s == scale_bias(rig.conventions, rig.region, rig.depth).matrix())
        return std::nullopt;  // depth in NDC is the same for both
    if (faults.has(Thing::side_of_s)) s[0][0] = -s[0][0];
    if (faults.has(Thing::side_of_t)) s[1][1] = -s[1][1];
    if (faults.has(Defect::scale_bias_missing)) s = glm::dmat4(1.0);
    if (faults.has(Defect::scale_bias_doubled)) s = s * s;

    glm::dmat4 x = rig.in == In::world ? glm::dmat4(1.0) : rig.pose;
    const bool left_out = faults.has(Defect::camera_left_out) || faults.has(Defect::model_left_out);
    if (left_out) x = glm::dmat4(1.0);
    if (faults.has(Defect::camera_not_inverted) || faults.has(Defect::model_inverted)) {
        const auto inverted = inverse(texgen::ModelMatrix(x));
        REQUIRE(inverted);
        x = inverted->matrix();
    }
    if (faults.has(Defect::camera_inverse_doubled) || faults.has(Defect::model_doubled)) x = x * x;

    std::optional<std::array<int, 4>> order = std::array{0, 1, 2, 3};
    if (faults.has("S V P X")) order = std::array{0, 2, 1, 3};
    if (faults.has("another order"))
        order = wrong_order(!faults.has(Defect::scale_bias_missing), rig.in != In::world && !left_out, random);
    if (!order) return std::nullopt;
    const std::array<glm::dmat4, 4> factors{s, projector.projection.matrix(), projector.view.matrix(), x};
    const auto factor = [&](std::size_t i) { return factors[static_cast<std::size_t>((*order)[i])]; };
    glm::dmat4 texgen = factor(0) * factor(1) * (factor(2) * factor(3));
    // Far planes do not tell one range of depth from the other, so that in float it may be lost.
    const bool tells_depth = !faults.has(Thing::depth_of_scale_bias) ||
                             (dot3(rig.aim.position, rig.aim.position) < 1e4 && !faults.has(Thing::pose) &&
                              !faults.has(Thing::order) && !faults.has(Thing::exchange));
    if (random.coin() && !faults.has(Thing::points) && tells_depth) texgen = to_float(texgen);

    const bool transpose_last = random.coin();
    if (faults.has(Thing::transposition) && !transpose_last) texgen = transposed(texgen);
    const bool keeps_r = faults.has(Thing::depth_of_scale_bias) || random.coin();
    for (int i = 0; i < 4 && faults.has(Thing::q); ++i) {
        if (!keeps_r) texgen[i][2] = 0.0;
        texgen[i][3] = 0.0;
    }
    if (faults.has(Thing::transposition) && transpose_last) texgen = transposed(texgen);
    for (int i = 0; i < 4 && faults.has("t written as s"); ++i) texgen[i][1] = texgen[i][0];
    if (faults.has("a NaN"))
        texgen[random.integer(0, 3)][random.integer(0, 3)] = random.coin() ? support::nan_double : infinity_double;
    if (faults.has("never written")) {
        texgen = glm::dmat4(0.0);
        if (random.coin()) texgen[0][0] = texgen[1][1] = 1.0;
    }
    return texgen;
}

// Moves a point to where the form is `value`, along its gradient.
inline glm::vec3 moved(const glm::vec3& point, const glm::dvec4& form, double value) {
    const glm::dvec3 gradient = xyz(form), from = glm::dvec3(point);
    return glm::vec3(from + (value - dot3(gradient, from) - form.w) / dot3(gradient, gradient) * gradient);
}

// Whether the points could be had.
inline bool place_points(const Rig& rig, const glm::dmat4& texgen, const Faults& faults, Random& random, Parts& parts) {
    const glm::dvec4 q = row(texgen, 3);
    const double size = std::fabs(q.w) + std::sqrt(dot3(xyz(q), xyz(q)));
    if (faults.has("all behind")) {
        for (glm::vec3& point : parts.points) {
            point = moved(random.vector3(10.0), q, -random.uniform(0.1, 10.0) * size);
            if (!(seen(texgen, rig.region, point).q < -1e-3 * size)) return false;
        }
    }
    if (faults.has("beside the slide")) {
        const bool right = random.coin();
        const glm::dvec4 side =
            right ? row(texgen, 0) - rig.region.max().x * q : rig.region.min().y * q - row(texgen, 1);
        const double unit = std::fabs(side.w) + std::sqrt(dot3(xyz(side), xyz(side)));
        for (glm::vec3& point : parts.points) {
            point = moved(random.vector3(10.0), side, random.uniform(0.1, 10.0) * unit);
            if (!(dot3(xyz(side), glm::dvec3(point)) + side.w > 1e-3 * unit)) return false;
        }
        if (!(seen(texgen, rig.region, parts.points[0]).q > 0.0)) return false;
    }
    if (faults.has("in one texel")) {
        const glm::vec3 centre = seen(texgen, rig.region, parts.points[0]).lit
                                     ? parts.points[0]
                                     : moved(random.vector3(10.0), q, random.uniform(0.5, 5.0) * size);
        const Seen at = seen(texgen, rig.region, centre);
        double most = 0.0;
        for (glm::vec3& point : parts.points) {
            point = centre + random.vector3(1e-5 * static_cast<double>(std::fabs(centre.x) + std::fabs(centre.y)));
            if (!(seen(texgen, rig.region, point).q > 1e-3 * size)) return false;
            const glm::dvec2 away = seen(texgen, rig.region, point).st - at.st;
            const glm::dvec2 extent = rig.region.max() - rig.region.min();
            most = std::max({most, std::fabs(away.x) / extent.x, std::fabs(away.y) / extent.y});
        }
        if (!(4096.0 * most < 0.4) || parts.points[0] == parts.points[1]) return false;
    }
    return true;
}

struct Spoilt {
    Parts parts;
    double error_in_texels = 0.0;
};

inline Spoilt spoilt(const Faults& faults, Random& random) {
    for (int attempt = 0; attempt < 1000; ++attempt) {
        const Rig rig = rig_for(faults, random);
        const Projector projector = spoilt_projector(rig, faults);
        Spoilt result{{.projector = projector, .in = rig.in, .region = rig.region, .depth = rig.depth}};
        Parts& parts = result.parts;
        parts.texgen = spoilt_texgen(rig, projector, faults, random);
        if (!parts.texgen) continue;
        if (rig.in != In::world) parts.pose = rig.pose;
        if (random.coin()) parts.lens = all_facts(rig);
        if (faults.has(Thing::depth_of_lens)) {
            parts.lens.z_near = rig.lens.z_near;
            parts.lens.z_far = rig.lens.z_far;
        }
        if (faults.has(Thing::aspect)) {
            parts.lens.aspect = std::nullopt;
            const glm::dvec2 extent = rig.region.max() - rig.region.min();
            if (random.coin() || faults.has(Thing::precision) || faults.has(Thing::points))
                parts.lens.aspect = rig.lens.aspect;
            else
                parts.texels_per_unit = 1000.0 * glm::dvec2(rig.lens.aspect, 1.0) / extent;
        }
        if (faults.has("degrees for radians")) {
            // Where the tangent is positive, only the angle that was meant can tell.
            const double tangent = std::tan(0.5 * rig.lens.fovy);
            if (tangent > 0.0 || random.coin()) parts.lens.fovy = texgen::degrees(rig.lens.fovy);
            if (std::fabs(tangent) < 1e-3 || std::fabs(tangent) > 1e3) continue;
        }
        if (faults.has(Thing::points) || faults.has(Thing::precision) || random.coin()) {
            parts.has_points = true;
            parts.points = lit_points(rig, random);
            if (!place_points(rig, *parts.texgen, faults, random, parts)) continue;
        }
        if (faults.has(Thing::precision)) {
            result.error_in_texels = measured_error(rig, projector, parts);
            if (!(result.error_in_texels > 1.0 && result.error_in_texels < 1e6)) continue;
        }
        return result;
    }
    FAIL("no such set-up");
    return {};
}

}  // namespace diagnose_cases
