#pragma once

// Rigs: what a user has set up, what is handed of it to the diagnosis, and what that says.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/windows.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/scale_bias.hpp"

namespace diagnose_cases {

using support::any_conventions;
using support::hex;
using support::infinity_double;
using support::Random;
using texgen::Conventions;
using texgen::Defect;
using texgen::DepthMapping;
using texgen::DepthRange;
using texgen::Diagnosis;
using texgen::LensFacts;
using texgen::Object;
using texgen::ProjectionSetup;
using texgen::Projector;
using texgen::TextureRegion;
using texgen::World;

enum class In { object, world, eye };

enum class LensKind { perspective, infinite, frustum, orthographic };

struct Lens {
    LensKind kind;
    double fovy, aspect, z_near, z_far;  // fovy in degrees
    double left, right, bottom, top;     // of frusta and parallel light
    bool is_reversed;

    bool is_symmetric() const { return kind < LensKind::frustum; }
};

inline glm::dmat4 projection(const Lens& lens, Conventions conventions) {
    const double l = lens.left, r = lens.right, b = lens.bottom, t = lens.top, n = lens.z_near, f = lens.z_far;
    const auto result = lens.kind == LensKind::frustum ? frustum({l, r, b, t, n, f, lens.is_reversed}, conventions)
                        : lens.kind == LensKind::orthographic
                            ? orthographic({l, r, b, t, n, f, lens.is_reversed}, conventions)
                            : perspective({.fovy = texgen::degrees(lens.fovy),
                                           .aspect = lens.aspect,
                                           .z_near = n,
                                           .z_far = f,
                                           .reversed_depth = lens.is_reversed},
                                          conventions);
    REQUIRE(result);
    return result->matrix();
}

// What a user has, before something went wrong with it.
struct Rig {
    Conventions conventions = texgen::opengl;
    Lens lens{};
    texgen::Aim aim{};
    glm::dmat4 view{1.0};
    In in = In::object;
    glm::dmat4 pose{1.0};
    TextureRegion region = texgen::whole_texture();
    DepthMapping depth = DepthMapping::unit;
    bool mirrored = false;
};

// What is handed to the diagnosis.
struct Parts {
    std::optional<Projector> projector = std::nullopt;
    std::optional<glm::dmat4> pose = std::nullopt, texgen = std::nullopt;
    In in = In::object;
    std::array<glm::vec3, 8> points{};
    bool has_points = false;
    TextureRegion region = texgen::whole_texture();
    DepthMapping depth = DepthMapping::unit;
    std::optional<Conventions> conventions = std::nullopt;
    glm::dvec2 texels_per_unit{0.0, 0.0};
    LensFacts lens = {};
};

template <class Space>
ProjectionSetup<Space> setup_of(const Parts& parts) {
    ProjectionSetup<Space> setup{.projector = parts.projector,
                                 .region = parts.region,
                                 .depth = parts.depth,
                                 .conventions = parts.conventions,
                                 .texels_per_unit = parts.texels_per_unit,
                                 .lens = parts.lens};
    if (parts.pose) setup.world_from_space.emplace(*parts.pose);
    if (parts.texgen) setup.texgen.emplace(*parts.texgen);
    const glm::vec3& first = parts.points[0];
    if (parts.has_points) setup.points.emplace(&first.x, &first.y, &first.z, parts.points.size(), sizeof first);
    return setup;
}

inline Diagnosis diagnosis_of(const Parts& parts) {
    if (parts.in == In::object) return diagnose(setup_of<Object>(parts));
    if (parts.in == In::world) return diagnose(setup_of<World>(parts));
    return diagnose(setup_of<texgen::Eye>(parts));
}

inline std::string text(const Diagnosis& diagnosis) {
    std::string result = "found:";
    for (const texgen::Finding& finding : diagnosis)
        result += " [" + std::string(finding.what()) + " " + hex(finding.number) + "]";
    return result;
}

inline std::string text(const Parts& parts) {
    std::string result = "in space " + std::to_string(static_cast<int>(parts.in));
    if (parts.projector)
        result += " projection " + hex(parts.projector->projection.matrix()) + " view " +
                  hex(parts.projector->view.matrix()) + " of " + support::text(parts.projector->conventions);
    if (parts.pose) result += " pose " + hex(*parts.pose);
    if (parts.texgen) result += " texgen " + hex(*parts.texgen);
    result += " " + hex(parts.region) + " texels " + hex(parts.texels_per_unit) + " depth " +
              std::to_string(static_cast<int>(parts.depth));
    if (parts.has_points)
        for (const glm::vec3& point : parts.points) result += " " + hex(point);
    return result;
}

inline glm::dmat4 transposed(const glm::dmat4& m) {
    glm::dmat4 result(0.0);
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) result[i][j] = m[j][i];
    return result;
}

inline glm::dvec4 row(const glm::dmat4& m, int i) { return {m[0][i], m[1][i], m[2][i], m[3][i]}; }

inline glm::dvec3 xyz(const glm::dvec4& v) { return {v.x, v.y, v.z}; }

inline double dot3(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// A direction along an axis, and one that is not along another.
inline glm::dvec3 any_axis(Random& random) {
    glm::dvec3 result(0.0);
    result[random.integer(0, 2)] = random.coin() ? 1.0 : -1.0;
    return result;
}
inline glm::dvec3 any_axis_but(const glm::dvec3& other, Random& random) {
    for (;;)
        if (const glm::dvec3 axis = any_axis(random); std::fabs(dot3(axis, other)) <= 0.5) return axis;
}

// R^-1 (v - t) for a rotation times a scale and a translation.
inline glm::dvec3 back_through(const glm::dmat4& pose, const glm::dvec3& v) {
    const glm::dvec3 from = v - xyz(pose[3]);
    glm::dvec3 result(0.0);
    for (int i = 0; i < 3; ++i) result[i] = dot3(xyz(pose[i]), from) / dot3(xyz(pose[i]), xyz(pose[i]));
    return result;
}

inline double depth_in(const Rig& rig, Random& random) {
    const double far = std::min(rig.lens.z_far, 1000.0 * rig.lens.z_near);
    return rig.lens.z_near * std::pow(far / rig.lens.z_near, random.uniform(0.1, 0.9));
}

// The point that the slide's (x, y) in [-1, 1] falls on at that depth, relative to the projector, in the world.
inline glm::dvec3 in_the_light(const Rig& rig, const glm::dmat4& p, double x, double y, double depth) {
    const double z = rig.conventions.handedness == texgen::Handedness::left ? depth : -depth;
    const double w = p[2][3] * z + p[3][3];
    const glm::dvec3 eye{(x * w - p[2][0] * z - p[3][0]) / p[0][0], (y * w - p[2][1] * z - p[3][1]) / p[1][1], z};
    const glm::dmat4 axes = transposed(rig.view);
    return eye.x * xyz(axes[0]) + eye.y * xyz(axes[1]) + eye.z * xyz(axes[2]);
}

inline glm::vec3 in_space(const Rig& rig, const glm::dvec3& from_projector) {
    if (rig.in == In::world) return glm::vec3(rig.aim.position + from_projector);
    glm::dmat4 pose = rig.pose;
    pose[3] = glm::dvec4(xyz(pose[3]) - rig.aim.position, 1.0);
    return glm::vec3(back_through(pose, from_projector));
}

inline glm::dvec3 somewhere_lit(const Rig& rig, const glm::dmat4& p, Random& random) {
    return in_the_light(rig, p, random.uniform(-0.95, 0.95), random.uniform(-0.95, 0.95), depth_in(rig, random));
}

// How far out of the ordinary a rig may be.
struct Range {
    double least_fovy, most_fovy, distance, least_tile, far_decades, scale_decades;
    bool parallel = true;
};

inline constexpr Range ordinary{5.0, 110.0, 4.0, 0.1, 4.0, 1.0};
inline constexpr Range extreme{0.1, 179.9, 7.0, 0x1p-8, 9.0, 30.0};

inline Lens random_lens(const Range& range, Random& random) {
    Lens lens{};
    lens.kind = static_cast<LensKind>(random.integer(0, range.parallel ? 3 : 2));
    lens.is_reversed = random.coin();
    lens.fovy = random.uniform(range.least_fovy, range.most_fovy);
    lens.aspect = random.coin() ? random.uniform(1.2, 3.0) : 1.0 / random.uniform(1.2, 3.0);
    lens.z_near = random.power_of_ten(-2.0, 1.0);
    lens.z_far = lens.z_near * random.power_of_ten(0.7, range.far_decades);
    if (lens.kind == LensKind::infinite) lens.z_far = infinity_double;
    const double height = random.uniform(0.3, 2.0) * lens.z_near;
    const double width = height * lens.aspect;
    lens.left = random.uniform(-1.5, 0.5) * width;
    lens.right = lens.left + width;
    lens.bottom = random.uniform(-1.5, 0.5) * height;
    lens.top = lens.bottom + height;
    return lens;
}

inline Rig random_rig(const Range& range, Random& random) {
    Rig rig;
    rig.conventions = any_conventions(random);
    rig.lens = random_lens(range, random);
    const double distance = random.power_of_ten(0.0, range.distance);
    rig.aim.position = distance * random.direction();
    rig.aim.target = rig.aim.position + (1.0 + 0.01 * distance) * random.direction();
    rig.aim.up = random.direction();
    const auto view = texgen::look_at(rig.aim, rig.conventions.handedness);
    REQUIRE(view);
    rig.view = view->matrix();
    rig.in = static_cast<In>(random.integer(0, 2));
    rig.depth = random.coin() ? DepthMapping::unit : DepthMapping::ndc;
    const int region = random.integer(0, 2);
    if (region == 1) rig.region = texgen::rectangle_texture(random.integer(16, 4096), random.integer(16, 4096));
    if (region == 2) {
        const glm::dvec2 least{random.uniform(0.0, 0.9), random.uniform(0.0, 0.9)};
        const double side = range.least_tile * random.uniform(1.0, 2.0);
        rig.region = texgen::atlas_tile(least, least + glm::dvec2(side, side * random.uniform(0.5, 2.0)));
    }
    if (rig.in == In::world) return rig;
    // Beside what is lit. Models are scaled and may mirror; cameras are rigid, but for one that sees a reflection.
    const glm::dvec3 place = rig.aim.position + somewhere_lit(rig, projection(rig.lens, rig.conventions), random);
    rig.pose = random.rotation();
    const double scale = rig.in == In::object ? random.power_of_ten(-range.scale_decades, range.scale_decades) : 1.0;
    for (int i = 0; i < 3; ++i) {
        const double unequal = rig.in == In::object ? random.uniform(0.5, 2.0) : 1.0;
        rig.pose[i] *= scale * unequal * (random.integer(0, 3) == 0 ? -1.0 : 1.0);
    }
    rig.pose[3] = glm::dvec4(place, 1.0);
    return rig;
}

inline std::array<glm::vec3, 8> lit_points(const Rig& rig, Random& random) {
    const glm::dmat4 p = projection(rig.lens, rig.conventions);
    std::array<glm::vec3, 8> points;
    for (glm::vec3& point : points) point = in_space(rig, somewhere_lit(rig, p, random));
    return points;
}

inline glm::dmat4 to_float(const glm::dmat4& m) { return glm::dmat4(support::rounded(m)); }

// What the texture coordinates of a point are, and how much of a texel of 4096 floats may lose of them.
struct Seen {
    bool lit;
    glm::dvec2 st;
    double q, lost;
};

inline Seen seen(const glm::dmat4& texgen, const TextureRegion& region, const glm::vec3& point) {
    const glm::dvec4 v(glm::dvec3(point), 1.0);
    const glm::dvec4 strq = texgen * v;
    const auto magnitude = [&](int i) {
        double sum = 0.0;
        for (int j = 0; j < 4; ++j) sum += std::fabs(texgen[j][i] * v[j]);
        return sum;
    };
    const glm::dvec2 st{strq.x / strq.w, strq.y / strq.w};
    const bool lit = strq.w > 0.0 && st.x >= region.min().x && st.x <= region.max().x && st.y >= region.min().y &&
                     st.y <= region.max().y;
    const glm::dvec2 extent = region.max() - region.min();
    const double s_lost = (magnitude(0) + std::fabs(st.x) * magnitude(3)) / strq.w / extent.x;
    const double t_lost = (magnitude(1) + std::fabs(st.y) * magnitude(3)) / strq.w / extent.y;
    return {lit, st, strq.w, 4096.0 * 0x1p-24 * std::max(s_lost, t_lost)};
}

// S P V X, the poses first: as linear.hpp composes it.
inline glm::dmat4 composed(const Rig& rig, const Projector& projector) {
    if (rig.in == In::object)
        return object_linear(projector, texgen::ModelMatrix(rig.pose), rig.region, rig.depth).matrix();
    if (rig.in == In::eye) return eye_linear(projector, texgen::CameraPose(rig.pose), rig.region, rig.depth).matrix();
    return texture_from_world(projector, rig.region, rig.depth).matrix();
}

// As a user of GLM does it, in float, from the left or from the right.
inline glm::dmat4 composed_in_float(const Rig& rig, const Projector& projector, bool from_left = true) {
    const glm::mat4 s = scale_bias(projector.conventions, rig.region, rig.depth).rounded();
    const glm::mat4 p = projector.projection.rounded(), v = projector.view.rounded(), x = support::rounded(rig.pose);
    return to_float(glm::dmat4(from_left ? s * p * v * x : s * (p * (v * x))));
}

inline Projector projector_of(const Rig& rig, const glm::dmat4& p, const glm::dmat4& v) {
    return {texgen::ProjectorProjection(p), texgen::ProjectorView(v), rig.conventions};
}

inline Parts parts_of(const Rig& rig, const glm::dmat4& p, const glm::dmat4& v) {
    return {.projector = projector_of(rig, p, v), .in = rig.in, .region = rig.region, .depth = rig.depth};
}

inline LensFacts all_facts(const Rig& rig) {
    LensFacts facts{.z_near = rig.lens.z_near, .z_far = rig.lens.z_far, .mirrored = rig.mirrored};
    if (rig.lens.is_symmetric()) {
        facts.fovy = texgen::degrees(rig.lens.fovy);
        facts.aspect = rig.lens.aspect;
    }
    return facts;
}

// Whether one of the points is lit at least, and they are not all in one texel.
inline bool shows_points(const Parts& parts, const glm::dmat4& texgen) {
    glm::dvec2 least(infinity_double), most(-infinity_double);
    bool any_lit = false;
    for (const glm::vec3& point : parts.points) {
        const Seen at = seen(texgen, parts.region, point);
        any_lit = any_lit || at.lit;
        least = {std::min(least.x, at.st.x), std::min(least.y, at.st.y)};
        most = {std::max(most.x, at.st.x), std::max(most.y, at.st.y)};
    }
    const glm::dvec2 texels =
        parts.texels_per_unit.x > 0.0 ? parts.texels_per_unit : 4096.0 / (parts.region.max() - parts.region.min());
    return any_lit && std::max((most.x - least.x) * texels.x, (most.y - least.y) * texels.y) > 1.0;
}

// The largest error of the coordinates that the matrix gives to lit points, in texels of a picture of 4096.
inline double measured_error(const Rig& rig, const Projector& projector, const Parts& parts) {
    const glm::dmat4 right = composed(rig, projector);
    const glm::dvec2 extent = rig.region.max() - rig.region.min();
    double worst = 0.0;
    for (const glm::vec3& point : parts.points) {
        const Seen at = seen(right, rig.region, point);
        const glm::dvec2 error = seen(*parts.texgen, rig.region, point).st - at.st;
        if (at.lit)
            worst = std::max({worst, 4096.0 * std::fabs(error.x) / extent.x, 4096.0 * std::fabs(error.y) / extent.y});
    }
    return worst;
}

// These are the findings, and all of them.
inline void require_said(const Parts& parts, std::initializer_list<Defect> defects) {
    const Diagnosis diagnosis = diagnosis_of(parts);
    const bool is_said = std::equal(diagnosis.begin(), diagnosis.end(), defects.begin(), defects.end(),
                                    [](const auto& finding, Defect defect) { return finding.defect == defect; });
    REQUIRE_MESSAGE(is_said, text(diagnosis), " in ", text(parts));
}

}  // namespace diagnose_cases
