// The diagnosis: every defect of a seeded corpus is found, alone and in pairs, and none in a million valid set-ups.

#include "texgen/diagnose.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/allocations.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/windows.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace {

using support::allocations;
using support::any_conventions;
using support::hex;
using support::infinity_double;
using support::nan_double;
using support::Random;
using texgen::Conventions;
using texgen::Defect;
using texgen::DepthMapping;
using texgen::DepthRange;
using texgen::Diagnosis;
using texgen::Eye;
using texgen::Handedness;
using texgen::LensFacts;
using texgen::NdcY;
using texgen::Object;
using texgen::ProjectionSetup;
using texgen::Projector;
using texgen::TextureOrigin;
using texgen::TextureRegion;
using texgen::Transform;
using texgen::World;

enum class In { object, world, eye };

enum class LensKind { perspective, infinite, reversed, reversed_infinite, frustum, orthographic };

struct Lens {
    LensKind kind;
    double fovy, aspect, z_near, z_far;  // fovy in degrees
    double left, right, bottom, top;     // of frusta and parallel light

    bool is_symmetric() const { return kind < LensKind::frustum; }
    bool is_reversed() const { return kind == LensKind::reversed || kind == LensKind::reversed_infinite; }
};

glm::dmat4 projection(const Lens& lens, Conventions conventions) {
    const double l = lens.left, r = lens.right, b = lens.bottom, t = lens.top, n = lens.z_near, f = lens.z_far;
    const auto result = lens.kind == LensKind::frustum        ? frustum({l, r, b, t, n, f}, conventions)
                        : lens.kind == LensKind::orthographic ? orthographic({l, r, b, t, n, f}, conventions)
                                                              : perspective({.fovy = texgen::degrees(lens.fovy),
                                                                             .aspect = lens.aspect,
                                                                             .z_near = n,
                                                                             .z_far = f,
                                                                             .reversed_depth = lens.is_reversed()},
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

Diagnosis diagnosis_of(const Parts& parts) {
    if (parts.in == In::object) return diagnose(setup_of<Object>(parts));
    if (parts.in == In::world) return diagnose(setup_of<World>(parts));
    return diagnose(setup_of<Eye>(parts));
}

std::string text(const Diagnosis& diagnosis) {
    std::string result = "found:";
    for (const texgen::Finding& finding : diagnosis)
        result += " [" + std::string(finding.what()) + " " + hex(finding.number) + "]";
    return result;
}

std::string text(const Parts& parts) {
    std::string result = "in space " + std::to_string(static_cast<int>(parts.in));
    if (parts.projector) {
        const Conventions& c = parts.projector->conventions;
        result += " projection " + hex(parts.projector->projection.matrix()) + " view " +
                  hex(parts.projector->view.matrix()) + " conventions " +
                  std::to_string(static_cast<int>(c.depth.operator DepthRange())) +
                  std::to_string(static_cast<int>(c.ndc_y.operator NdcY())) +
                  std::to_string(static_cast<int>(c.origin.operator TextureOrigin())) +
                  std::to_string(static_cast<int>(c.handedness.operator Handedness()));
    }
    if (parts.pose) result += " pose " + hex(*parts.pose);
    if (parts.texgen) result += " texgen " + hex(*parts.texgen);
    result += " region " + hex(parts.region.min()) + " " + hex(parts.region.max()) + " texels " +
              hex(parts.texels_per_unit) + " depth " + std::to_string(static_cast<int>(parts.depth));
    if (parts.has_points)
        for (const glm::vec3& point : parts.points) result += " " + hex(point);
    return result;
}

glm::dmat4 transposed(const glm::dmat4& m) {
    glm::dmat4 result(0.0);
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) result[i][j] = m[j][i];
    return result;
}

glm::dvec4 row(const glm::dmat4& m, int i) { return {m[0][i], m[1][i], m[2][i], m[3][i]}; }

glm::dvec3 xyz(const glm::dvec4& v) { return {v.x, v.y, v.z}; }

double dot3(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// R^-1 (v - t) for a rotation times a scale and a translation.
glm::dvec3 back_through(const glm::dmat4& pose, const glm::dvec3& v) {
    const glm::dvec3 from = v - xyz(pose[3]);
    glm::dvec3 result(0.0);
    for (int i = 0; i < 3; ++i) result[i] = dot3(xyz(pose[i]), from) / dot3(xyz(pose[i]), xyz(pose[i]));
    return result;
}

double depth_in(const Rig& rig, Random& random) {
    const double far = std::min(rig.lens.z_far, 1000.0 * rig.lens.z_near);
    return rig.lens.z_near * std::pow(far / rig.lens.z_near, random.uniform(0.1, 0.9));
}

// The point that the slide's (x, y) in [-1, 1] falls on at that depth, relative to the projector, in the world.
glm::dvec3 in_the_light(const Rig& rig, const glm::dmat4& p, double x, double y, double depth) {
    const double z = rig.conventions.handedness == Handedness::left ? depth : -depth;
    const double w = p[2][3] * z + p[3][3];
    const glm::dvec3 eye{(x * w - p[2][0] * z - p[3][0]) / p[0][0], (y * w - p[2][1] * z - p[3][1]) / p[1][1], z};
    const glm::dmat4 axes = transposed(rig.view);
    return eye.x * xyz(axes[0]) + eye.y * xyz(axes[1]) + eye.z * xyz(axes[2]);
}

glm::vec3 in_space(const Rig& rig, const glm::dvec3& from_projector) {
    if (rig.in == In::world) return glm::vec3(rig.aim.position + from_projector);
    glm::dmat4 pose = rig.pose;
    pose[3] = glm::dvec4(xyz(pose[3]) - rig.aim.position, 1.0);
    return glm::vec3(back_through(pose, from_projector));
}

glm::dvec3 somewhere_lit(const Rig& rig, const glm::dmat4& p, Random& random) {
    return in_the_light(rig, p, random.uniform(-0.95, 0.95), random.uniform(-0.95, 0.95), depth_in(rig, random));
}

// How far out of the ordinary a rig may be.
struct Range {
    double least_fovy, most_fovy, distance, least_tile, far_decades, scale_decades;
    bool parallel = true;
};

constexpr Range ordinary{5.0, 110.0, 4.0, 0.1, 4.0, 1.0};
constexpr Range extreme{0.1, 179.9, 7.0, 0x1p-8, 9.0, 30.0};

Lens random_lens(const Range& range, Random& random) {
    Lens lens{};
    lens.kind = static_cast<LensKind>(random.integer(0, range.parallel ? 5 : 4));
    lens.fovy = random.uniform(range.least_fovy, range.most_fovy);
    lens.aspect = random.coin() ? random.uniform(1.2, 3.0) : 1.0 / random.uniform(1.2, 3.0);
    lens.z_near = random.power_of_ten(-2.0, 1.0);
    lens.z_far = lens.z_near * random.power_of_ten(0.7, range.far_decades);
    if (lens.kind == LensKind::infinite || lens.kind == LensKind::reversed_infinite) lens.z_far = infinity_double;
    const double height = random.uniform(0.3, 2.0) * lens.z_near;
    const double width = height * lens.aspect;
    lens.left = random.uniform(-1.5, 0.5) * width;
    lens.right = lens.left + width;
    lens.bottom = random.uniform(-1.5, 0.5) * height;
    lens.top = lens.bottom + height;
    return lens;
}

Rig random_rig(const Range& range, Random& random) {
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

std::array<glm::vec3, 8> lit_points(const Rig& rig, Random& random) {
    const glm::dmat4 p = projection(rig.lens, rig.conventions);
    std::array<glm::vec3, 8> points;
    for (glm::vec3& point : points) point = in_space(rig, somewhere_lit(rig, p, random));
    return points;
}

glm::dmat4 to_float(const glm::dmat4& m) { return glm::dmat4(support::rounded(m)); }

// What the texture coordinates of a point are, and how much of a texel of 4096 floats may lose of them.
struct Seen {
    bool lit;
    glm::dvec2 st;
    double q, lost;
};

Seen seen(const glm::dmat4& texgen, const TextureRegion& region, const glm::vec3& point) {
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
glm::dmat4 composed(const Rig& rig, const Projector& projector) {
    if (rig.in == In::object)
        return object_linear(projector, texgen::ModelMatrix(rig.pose), rig.region, rig.depth).matrix();
    if (rig.in == In::eye) return eye_linear(projector, texgen::CameraPose(rig.pose), rig.region, rig.depth).matrix();
    return texture_from_world(projector, rig.region, rig.depth).matrix();
}

// As a user of GLM does it, in float, from the left or from the right.
glm::dmat4 composed_in_float(const Rig& rig, const Projector& projector, bool from_left = true) {
    const glm::mat4 s = scale_bias(projector.conventions, rig.region, rig.depth).rounded();
    const glm::mat4 p = projector.projection.rounded(), v = projector.view.rounded(), x = support::rounded(rig.pose);
    return to_float(glm::dmat4(from_left ? s * p * v * x : s * (p * (v * x))));
}

Projector projector_of(const Rig& rig, const glm::dmat4& p, const glm::dmat4& v) {
    return {texgen::ProjectorProjection(p), texgen::ProjectorView(v), rig.conventions};
}

LensFacts all_facts(const Rig& rig) {
    LensFacts facts{.z_near = rig.lens.z_near, .z_far = rig.lens.z_far, .mirrored = rig.mirrored};
    if (rig.lens.is_symmetric()) {
        facts.fovy = texgen::degrees(rig.lens.fovy);
        facts.aspect = rig.lens.aspect;
    }
    return facts;
}

struct Classes {
    int far = 0, narrow = 0, wide = 0, parallel = 0, reversed = 0, infinite = 0, off_axis = 0, mirrored = 0, tiles = 0,
        rectangles = 0, mirrored_poses = 0, tiny = 0, huge = 0, in_float = 0, composed_in_float = 0,
        float_projectors = 0, alone = 0, with_points = 0, of_points_with_float = 0;
};

void count(const Rig& rig, Classes& classes) {
    const double scale = std::fabs(rig.pose[0][0]) + std::fabs(rig.pose[0][1]) + std::fabs(rig.pose[0][2]);
    const glm::dvec3& p = rig.aim.position;
    classes.far += std::sqrt(dot3(p, p)) > 1e6;
    classes.narrow += rig.lens.is_symmetric() && rig.lens.fovy < 2.0;
    classes.wide += rig.lens.is_symmetric() && rig.lens.fovy > 178.0;
    classes.parallel += rig.lens.kind == LensKind::orthographic;
    classes.reversed += rig.lens.is_reversed();
    classes.infinite += rig.lens.z_far == infinity_double;
    classes.off_axis += rig.lens.kind == LensKind::frustum;
    classes.mirrored += rig.mirrored;
    classes.tiles += rig.region.min().x > 0.0;
    classes.rectangles += rig.region.max().x > 8.0;
    classes.mirrored_poses +=
        dot3(xyz(rig.pose[0]), {rig.pose[1][1] * rig.pose[2][2] - rig.pose[1][2] * rig.pose[2][1],
                                rig.pose[1][2] * rig.pose[2][0] - rig.pose[1][0] * rig.pose[2][2],
                                rig.pose[1][0] * rig.pose[2][1] - rig.pose[1][1] * rig.pose[2][0]}) < 0.0;
    classes.tiny += scale < 1e-20;
    classes.huge += scale > 1e20;
}

// Whether one of the points is lit at least, and they are not all in one texel.
bool shows_points(const Parts& parts, const glm::dmat4& texgen) {
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

// A set-up that is as it should be, told in part or in whole.
Parts valid_parts(Random& random, Classes& classes) {
    Rig rig = random_rig(random.coin() ? extreme : ordinary, random);
    if (!rig.lens.is_symmetric() && random.integer(0, 3) == 0) {
        rig.mirrored = true;
        if (random.coin()) std::swap(rig.lens.left, rig.lens.right);
        if (random.coin()) std::swap(rig.lens.bottom, rig.lens.top);
    }
    count(rig, classes);

    Parts parts{.in = rig.in, .region = rig.region, .depth = rig.depth};
    if (random.coin()) parts.conventions = rig.conventions;
    const bool is_rectangle = rig.region.max().x > 8.0;
    if (is_rectangle && random.coin()) parts.texels_per_unit = {1.0, 1.0};
    if (!is_rectangle && random.coin()) {
        const double aspect = random.coin() ? 1.0 : rig.lens.aspect;
        const double longer = random.uniform(2048.0, 4096.0);
        parts.texels_per_unit = longer * glm::dvec2(std::min(1.0, aspect), std::min(1.0, 1.0 / aspect));
    }
    parts.lens.mirrored = rig.mirrored;
    if (random.coin()) parts.lens = all_facts(rig);

    // Of what is held in float: no more than half a texel of a picture of 4096 may be lost.
    const glm::dmat4 p = projection(rig.lens, rig.conventions);
    Projector projector = projector_of(rig, p, rig.view);
    parts.points = lit_points(rig, random);
    if (random.coin())
        for (int i = random.integer(1, 7); i < 8; ++i) parts.points[static_cast<std::size_t>(i)] = random.vector3(1e3);
    const auto loses = [&](const glm::dmat4& texgen) {
        double lost = 0.0;
        for (const glm::vec3& point : parts.points) {
            const Seen at = seen(texgen, rig.region, point);
            if (at.lit) lost = std::max(lost, at.lost);
        }
        // The first is before the far plane, if float could hold it.
        return seen(texgen, rig.region, parts.points[0]).lit ? lost : infinity_double;
    };
    glm::dmat4 texgen = composed(rig, projector);
    const bool fits_float = loses(texgen) < 0.5;
    if (fits_float && random.integer(0, 3) == 0) {
        const Projector rounded = projector_of(rig, to_float(p), to_float(rig.view));
        if (rig.in == In::world || loses(composed({.conventions = rig.conventions, .in = In::world}, rounded)) < 0.5) {
            projector = rounded;
            texgen = composed(rig, projector);
            ++classes.float_projectors;
        }
    }
    const int form = random.integer(0, 2);
    if (form == 1 && fits_float) {
        texgen = to_float(texgen);
        ++classes.in_float;
    }
    if (form == 2 && fits_float) {
        const glm::dmat4 in_float = composed_in_float(rig, projector, random.coin());
        double distance = 0.0;
        for (const glm::vec3& point : parts.points) {
            if (!seen(texgen, rig.region, point).lit && !seen(in_float, rig.region, point).lit) continue;
            const glm::dvec2 error = seen(in_float, rig.region, point).st - seen(texgen, rig.region, point).st;
            const glm::dvec2 extent = rig.region.max() - rig.region.min();
            distance = std::max({distance, std::fabs(error.x) / extent.x, std::fabs(error.y) / extent.y});
        }
        if (distance * 4096.0 < 0.5) {
            texgen = in_float;
            ++classes.composed_in_float;
        }
    }

    parts.has_points = shows_points(parts, texgen) && random.integer(0, 3) != 0;

    const int told = random.integer(0, 7);
    if (told != 0) parts.projector = projector;
    if (told != 1 && rig.in != In::world) parts.pose = rig.pose;
    if (told > 2 || told == 0) parts.texgen = texgen;
    classes.alone += told == 0;
    classes.with_points += parts.has_points;
    return parts;
}

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

constexpr std::array kinds{
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

bool is_composition(Thing thing) {
    return thing == Thing::transposition || thing == Thing::order || thing == Thing::pose ||
           thing == Thing::scale_bias || thing == Thing::depth_of_scale_bias || thing == Thing::side_of_s ||
           thing == Thing::side_of_t;
}

// Why one of two hides the other; null where both can be seen.
const char* one_hides(Thing a, Thing b) {
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

Rig rig_for(const Faults& faults, Random& random) {
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

Conventions of_other_range(Conventions c) {
    return {c.depth == DepthRange::zero_to_one ? DepthRange::negative_one_to_one : DepthRange::zero_to_one, c.ndc_y,
            c.origin, c.handedness};
}

// The projector's two matrices, with what is wrong with them.
Projector spoilt_projector(const Rig& rig, const Faults& faults) {
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
std::optional<std::array<int, 4>> wrong_order(bool has_s, bool has_x, Random& random) {
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
std::optional<glm::dmat4> spoilt_texgen(const Rig& rig, const Projector& given, const Faults& faults, Random& random) {
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
        texgen[random.integer(0, 3)][random.integer(0, 3)] = random.coin() ? nan_double : infinity_double;
    if (faults.has("never written")) {
        texgen = glm::dmat4(0.0);
        if (random.coin()) texgen[0][0] = texgen[1][1] = 1.0;
    }
    return texgen;
}

// Moves a point to where the form is `value`, along its gradient.
glm::vec3 moved(const glm::vec3& point, const glm::dvec4& form, double value) {
    const glm::dvec3 gradient = xyz(form), from = glm::dvec3(point);
    return glm::vec3(from + (value - dot3(gradient, from) - form.w) / dot3(gradient, gradient) * gradient);
}

// Whether the points could be had.
bool place_points(const Rig& rig, const glm::dmat4& texgen, const Faults& faults, Random& random, Parts& parts) {
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

// The largest error of the coordinates that the matrix gives to lit points, in texels of a picture of 4096.
double measured_error(const Rig& rig, const Projector& projector, const Parts& parts) {
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

struct Spoilt {
    Parts parts;
    double error_in_texels = 0.0;
};

Spoilt spoilt(const Faults& faults, Random& random) {
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

}  // namespace

TEST_CASE("no valid set-up of a million is found fault with") {
    Random random(600);
    Classes classes;
    for (int i = 0; i < 1000000; ++i) {
        const Parts parts = valid_parts(random, classes);
        const Diagnosis diagnosis = diagnosis_of(parts);
        if (!diagnosis.empty()) FAIL(i, " ", text(diagnosis), " in ", text(parts));
    }
    for (const int seen_so_often :
         {classes.far, classes.narrow, classes.wide, classes.parallel, classes.reversed, classes.infinite,
          classes.off_axis, classes.mirrored, classes.tiles, classes.rectangles, classes.mirrored_poses, classes.tiny,
          classes.huge, classes.in_float, classes.composed_in_float, classes.float_projectors, classes.alone,
          classes.with_points})
        CHECK(seen_so_often > 1000);
}

TEST_CASE("no valid set-up of round numbers is found fault with, where factors commute and elements vanish") {
    Random random(609);
    const auto axis = [&] {
        glm::dvec3 result(0.0);
        result[random.integer(0, 2)] = random.coin() ? 1.0 : -1.0;
        return result;
    };
    const auto whole = [&](int most) { return static_cast<double>(random.integer(-most, most)); };
    int far = 0, empty_poses = 0;
    for (int i = 0; i < 50000; ++i) {
        Rig rig;
        rig.conventions = any_conventions(random);
        rig.lens = {static_cast<LensKind>(random.integer(0, 5)),
                    random.coin() ? 90.0 : 60.0,
                    random.coin() ? 1.0 : 2.0,
                    1.0,
                    4.0,
                    -1.0,
                    1.0,
                    random.coin() ? -1.0 : 0.0,
                    1.0};
        if (rig.lens.kind == LensKind::infinite || rig.lens.kind == LensKind::reversed_infinite)
            rig.lens.z_far = infinity_double;
        const int most = random.integer(0, 2) == 0 ? 10000000 : random.integer(0, 3);
        rig.aim.position = {whole(most), whole(most), whole(most)};
        rig.aim.up = axis();
        glm::dvec3 direction = axis();
        while (std::fabs(dot3(direction, rig.aim.up)) > 0.5) direction = axis();
        rig.aim.target = rig.aim.position + direction;
        rig.view = texgen::look_at(rig.aim, rig.conventions.handedness)->matrix();
        rig.in = static_cast<In>(random.integer(0, 2));
        if (rig.in != In::world && random.coin()) {
            rig.pose[3] = glm::dvec4(rig.aim.position + 2.0 * direction, 1.0);
            if (random.coin()) std::swap(rig.pose[0], rig.pose[2]);
        }
        if (random.coin()) rig.region = texgen::rectangle_texture(256, 128);
        rig.depth = random.coin() ? DepthMapping::unit : DepthMapping::ndc;
        far += most > 1000;
        empty_poses += rig.in != In::world && rig.pose == glm::dmat4(1.0);
        Parts parts{.projector = projector_of(rig, projection(rig.lens, rig.conventions), rig.view),
                    .in = rig.in,
                    .region = rig.region,
                    .depth = rig.depth,
                    .lens = all_facts(rig)};
        if (rig.in != In::world) parts.pose = rig.pose;
        if (random.coin()) parts.texgen = composed(rig, *parts.projector);
        if (most < 10 && rig.in != In::world && random.coin()) {
            // The noise of an inverse, where the pose holds zeros.
            Rig noisy = rig;
            for (int j = 0; j < 3; ++j)
                for (int k = 0; k < 3; ++k) noisy.pose[j][k] += random.uniform(-0x1p-26, 0x1p-26);
            parts.texgen = composed(noisy, *parts.projector);
        }
        const Diagnosis diagnosis = diagnosis_of(parts);
        REQUIRE_MESSAGE(diagnosis.empty(), i, " ", text(diagnosis), " in ", text(parts));
        parts.projector = std::nullopt;
        const Diagnosis alone = diagnosis_of(parts);
        REQUIRE_MESSAGE(alone.empty(), i, " ", text(alone), " in ", text(parts));
    }
    CHECK(far > 1000);
    CHECK(empty_poses > 1000);
}

namespace {

// A projector along the axes, or turned about one of them, whose rounding to float leaves rows as they are.
Rig aligned_rig(Random& random) {
    const auto axis = [&] {
        glm::dvec3 result(0.0);
        result[random.integer(0, 2)] = random.coin() ? 1.0 : -1.0;
        return result;
    };
    Rig rig;
    rig.conventions = any_conventions(random);
    rig.lens = random_lens(ordinary, random);
    rig.lens.kind = random.integer(0, 2) == 0 ? static_cast<LensKind>(random.integer(0, 4)) : LensKind::orthographic;
    if (rig.lens.kind == LensKind::infinite || rig.lens.kind == LensKind::reversed_infinite)
        rig.lens.z_far = infinity_double;
    else if (!(rig.lens.z_far < infinity_double))
        rig.lens.z_far = 1000.0 * rig.lens.z_near;
    if (random.integer(0, 3) != 0) {
        const double width = std::ldexp(1.0, random.integer(-1, 7)), height = std::ldexp(1.0, random.integer(-1, 7));
        rig.lens.left = random.coin() ? -width : 0.0;
        rig.lens.right = width;
        rig.lens.bottom = random.coin() ? -height : 0.0;
        rig.lens.top = height;
        rig.lens.fovy = 90.0;
    }
    const double unit = std::ldexp(1.0, random.integer(-3, 4)), most = random.power_of_ten(0.0, 6.0) / unit;
    for (int i = 0; i < 3; ++i)
        if (random.integer(0, 3) != 0) rig.aim.position[i] = unit * std::round(random.uniform(-most, most));
    rig.aim.up = axis();
    glm::dvec3 direction = axis();
    while (std::fabs(dot3(direction, rig.aim.up)) > 0.5) direction = axis();
    if (random.integer(0, 3) == 0) {
        glm::dvec3 aside = axis();
        while (std::fabs(dot3(aside, direction)) > 0.5) aside = axis();
        direction += random.uniform(-2.0, 2.0) * aside;
    }
    rig.aim.target = rig.aim.position + direction;
    const auto view = texgen::look_at(rig.aim, rig.conventions.handedness);
    if (!view) return aligned_rig(random);
    rig.view = view->matrix();
    rig.in = static_cast<In>(random.integer(0, 2));
    rig.depth = random.coin() ? DepthMapping::unit : DepthMapping::ndc;
    const int region = random.integer(0, 2);
    if (region == 1) rig.region = texgen::rectangle_texture(512, 256);
    if (region == 2) rig.region = texgen::atlas_tile({0.25, 0.5}, {0.5, 0.75});
    if (rig.in != In::world) {
        for (int i = 0; i < 3; ++i) rig.pose[3][i] = std::round(random.uniform(-4.0, 4.0));
        if (random.coin()) std::swap(rig.pose[0], rig.pose[2]);
    }
    return rig;
}

// In texels of a picture of 4096, of all that rounding may lose of a point where it has changed an element at all.
double lost_by_rounding(const glm::dmat4& texgen, const glm::dmat4& rounded, const TextureRegion& region,
                        const glm::vec3& point) {
    const glm::dvec4 v(glm::dvec3(point), 1.0);
    const auto lost = [&](int i) {
        double sum = 0.0;
        for (int j = 0; j < 4; ++j)
            if (texgen[j][i] != rounded[j][i]) sum += 0x1p-24 * std::fabs(texgen[j][i] * v[j]);
        return sum;
    };
    const Seen at = seen(texgen, region, point);
    const glm::dvec2 extent = region.max() - region.min();
    return 4096.0 / at.q *
           std::max((lost(0) + std::fabs(at.st.x) * lost(3)) / extent.x,
                    (lost(1) + std::fabs(at.st.y) * lost(3)) / extent.y);
}

}  // namespace

TEST_CASE("no valid set-up along the axes is found fault with, however far, in float where floats hold what is read") {
    Random random(613);
    int far = 0, parallel = 0, in_float = 0, float_views = 0, alone = 0, lossy = 0;
    for (int i = 0; i < 300000; ++i) {
        const Rig rig = aligned_rig(random);
        const glm::dmat4 p = projection(rig.lens, rig.conventions);
        Projector projector = projector_of(rig, p, rig.view);
        Parts parts{.in = rig.in, .region = rig.region, .depth = rig.depth};
        parts.points = lit_points(rig, random);
        const auto loses = [&](const glm::dmat4& texgen, const glm::dmat4& rounded) {
            double lost = 0.0;
            for (const glm::vec3& point : parts.points) {
                const bool is_lit = seen(texgen, rig.region, point).lit && seen(rounded, rig.region, point).lit;
                lost = std::max(lost, is_lit ? lost_by_rounding(texgen, rounded, rig.region, point) : infinity_double);
            }
            return lost;
        };
        glm::dmat4 texgen = composed(rig, projector);
        if (random.integer(0, 3) == 0) {
            const Projector rounded = projector_of(rig, p, to_float(rig.view));
            if (loses(texgen, composed(rig, rounded)) < 0.5) {
                projector = rounded;
                texgen = composed(rig, projector);
                ++float_views;
            }
        }
        if (random.coin()) {
            const glm::dmat4 rounded = to_float(texgen);
            if (loses(texgen, rounded) < 0.5) {
                far += std::fabs(rig.aim.position.x) + std::fabs(rig.aim.position.y) > 3e4;
                parallel += rig.lens.kind == LensKind::orthographic;
                texgen = rounded;
                ++in_float;
            } else {
                Parts spoilt = parts;
                spoilt.projector = projector;
                if (rig.in != In::world) spoilt.pose = rig.pose;
                spoilt.texgen = rounded;
                spoilt.has_points = true;
                if (measured_error(rig, projector, spoilt) > 1.0) {
                    const Diagnosis diagnosis = diagnosis_of(spoilt);
                    REQUIRE_MESSAGE(diagnosis.contains(Defect::precision_lost), i, " ", text(diagnosis), " in ",
                                    text(spoilt));
                    ++lossy;
                }
            }
        }
        parts.has_points = shows_points(parts, texgen) && random.coin();
        const bool has_projector = random.integer(0, 3) != 0;
        if (has_projector) parts.projector = projector;
        if (rig.in != In::world) parts.pose = rig.pose;
        if (!has_projector || random.integer(0, 3) != 0) parts.texgen = texgen;
        if (random.coin()) parts.lens = all_facts(rig);
        alone += !has_projector;
        const Diagnosis diagnosis = diagnosis_of(parts);
        if (!diagnosis.empty()) FAIL(i, " ", text(diagnosis), " in ", text(parts));
    }
    for (const int seen_so_often : {far, parallel, in_float, float_views, alone, lossy}) CHECK(seen_so_often > 1000);
}

TEST_CASE("a parallel light, however narrow and along whatever diagonal, lacks no w") {
    Random random(4715);
    int lossy = 0;
    for (int i = 0; i < 20000; ++i) {
        const double half = random.power_of_ten(-9.0, 3.0);
        const auto sign = [&] { return random.coin() ? 1.0 : -1.0; };
        const texgen::OrthographicLens lens{-half, half, -half, half, 0.0, random.power_of_ten(-2.0, 3.0)};
        const texgen::Aim aim{.position = glm::dvec3(0.0),
                              .target = random.coin() ? glm::dvec3(sign(), sign(), sign()) : random.direction(),
                              .up = {0.0, 1.0, 0.0}};
        const auto projector = texgen::make_projector(lens, aim, texgen::opengl);
        if (!projector) continue;
        glm::dmat4 model(1.0);
        for (int j = 0; j < 3; ++j) model[3][j] = random.integer(-9, 9);
        const texgen::ObjectTexgen texgen(texgen::object_linear(*projector, texgen::ModelMatrix(model)).rounded());
        for (const Diagnosis& diagnosis :
             {texgen::diagnose(texgen), texgen::diagnose(texgen, {.projector = *projector}),
              texgen::diagnose(texgen, {.projector = *projector, .world_from_space = texgen::ModelMatrix(model)})}) {
            INFO(text(diagnosis), " half ", hex(half), " target ", hex(aim.target), " model ", hex(model));
            lossy += diagnosis.contains(Defect::precision_lost);
            REQUIRE((diagnosis.empty() || (diagnosis.contains(Defect::precision_lost) && diagnosis.size() == 1)));
        }
    }
    CHECK(lossy > 1000);
}

TEST_CASE("every defect of the corpus is found, and stands first") {
    for (const Kind& kind : kinds) {
        Random random(601);
        for (int i = 0; i < 100; ++i) {
            const Spoilt set_up = spoilt(Faults({&kind}), random);
            const Diagnosis diagnosis = diagnosis_of(set_up.parts);
            const auto context = [&] { return kind.name + (": " + text(diagnosis)) + " in " + text(set_up.parts); };
            REQUIRE_MESSAGE(!diagnosis.empty(), context());
            REQUIRE_MESSAGE(diagnosis[0].defect == kind.defect, context());
            if (kind.thing == Thing::precision)
                REQUIRE_MESSAGE(diagnosis[0].number > 0.99 * set_up.error_in_texels, context());
        }
    }
}

// A set-up without its projector, or with nothing else.
Diagnosis diagnosis_alone(Parts parts) {
    parts.projector = std::nullopt;
    parts.pose = std::nullopt;
    return diagnosis_of(parts);
}

TEST_CASE("a texgen matrix alone shows what its rows can show") {
    for (const Kind& kind : kinds) {
        const bool is_shown = kind.thing == Thing::numbers || kind.thing == Thing::q ||
                              kind.thing == Thing::transposition || kind.thing == Thing::order ||
                              kind.thing == Thing::points || kind.thing == Thing::precision;
        if (!is_shown) continue;
        Random random(603);
        for (int i = 0; i < 100; ++i) {
            const Spoilt set_up = spoilt(Faults({&kind}), random);
            // Of a product alone nobody knows its factors: with rows r and q that belong together it could be right.
            const Diagnosis diagnosis = diagnosis_alone(set_up.parts);
            const auto context = [&] { return kind.name + (": " + text(diagnosis)) + " in " + text(set_up.parts); };
            if (kind.thing == Thing::order) {
                const glm::dmat4& m = *set_up.parts.texgen;
                const glm::dvec3 r = xyz(row(m, 2)), q = xyz(row(m, 3));
                const double along = dot3(r, q) * dot3(r, q) / (dot3(r, r) * dot3(q, q));
                if (along < 0.9)
                    REQUIRE_MESSAGE((diagnosis.contains(Defect::wrong_order) || diagnosis.contains(Defect::transposed)),
                                    context());
                continue;
            }
            // What was lost before the matrix was made has left no trace in it.
            if (kind.thing == Thing::precision && set_up.parts.in != In::world) continue;
            REQUIRE_MESSAGE(!diagnosis.empty(), context());
            REQUIRE_MESSAGE(diagnosis[0].defect == kind.defect, context());
            // As planes, all the same.
            if (kind.thing != Thing::numbers && kind.thing != Thing::q) continue;
            const Diagnosis of_planes = texgen::diagnose(planes(texgen::WorldTexgen(*set_up.parts.texgen)));
            REQUIRE_MESSAGE(of_planes.contains(kind.defect), context());
        }
    }
}

TEST_CASE("a projector alone shows what its matrices can show") {
    for (const Kind& kind : kinds) {
        const bool is_shown = kind.thing == Thing::signs || kind.thing == Thing::hand ||
                              kind.thing == Thing::exchange || kind.thing == Thing::transposed_projection ||
                              kind.thing == Thing::transposed_view || kind.thing == Thing::width ||
                              kind.thing == Thing::depth_of_lens;
        if (!is_shown) continue;
        Random random(604);
        int found = 0;
        for (int i = 0; i < 100; ++i) {
            const Spoilt set_up = spoilt(Faults({&kind}), random);
            const glm::dmat4& p = set_up.parts.projector->projection.matrix();
            // A positive tangent is that of some angle, and a depth that is not reversed that of some near plane.
            if (kind.defect == Defect::angle_unit_mistaken && p[0][0] > 0.0) continue;
            if (kind.thing == Thing::depth_of_lens &&
                !(p[2][3] != 0.0 && p[3][2] > 0.0 &&
                  set_up.parts.projector->conventions.depth == DepthRange::negative_one_to_one))
                continue;
            ++found;
            const Diagnosis diagnosis = diagnose(*set_up.parts.projector);
            const auto context = [&] { return kind.name + (": " + text(diagnosis)) + " in " + text(set_up.parts); };
            REQUIRE_MESSAGE(!diagnosis.empty(), context());
            REQUIRE_MESSAGE(diagnosis[0].defect == kind.defect, context());
        }
        CHECK_MESSAGE(found > 5, kind.name);
    }
}

TEST_CASE("reversed depth in the wrong range, and a mirrored picture in the world, show in the matrix alone") {
    Random random(605);
    int reversed = 0, mirrored = 0;
    while (reversed < 100 || mirrored < 100) {
        Rig rig = random_rig(ordinary, random);
        const glm::dmat4 p = projection(rig.lens, rig.conventions);
        if (rig.lens.is_reversed() && rig.conventions.depth == DepthRange::zero_to_one) {
            // OpenGL's scale-bias on depth in [0, 1].
            Rig opengl_depth = rig;
            opengl_depth.conventions = of_other_range(rig.conventions);
            opengl_depth.depth = DepthMapping::unit;
            const glm::dmat4 texgen = composed(opengl_depth, projector_of(opengl_depth, p, rig.view));
            const Diagnosis diagnosis = diagnosis_of({.texgen = texgen, .in = rig.in});
            REQUIRE_MESSAGE(diagnosis.size() == 1, text(diagnosis));
            REQUIRE_MESSAGE(diagnosis.contains(Defect::depth_range_mismatch), text(diagnosis));
            ++reversed;
        }
        if (rig.lens.kind != LensKind::orthographic) {
            glm::dmat4 turned = p;
            for (int i = 0; i < 4; ++i) turned[i][0] = -turned[i][0];
            Parts parts{.texgen = composed(rig, projector_of(rig, turned, rig.view)),
                        .in = rig.in,
                        .region = rig.region,
                        .conventions = rig.conventions};
            if (rig.in != In::world) parts.pose = rig.pose;
            const Diagnosis diagnosis = diagnosis_of(parts);
            REQUIRE_MESSAGE(diagnosis.size() == 1, text(diagnosis));
            REQUIRE_MESSAGE(diagnosis.contains(Defect::mirrored), text(diagnosis));
            parts.lens.mirrored = true;
            REQUIRE(diagnosis_of(parts).empty());
            ++mirrored;
        }
    }
}

TEST_CASE("of two defects of the corpus both are found, where neither hides the other") {
    int pairs = 0, hidden = 0;
    for (const Kind& first : kinds) {
        for (const Kind& second : kinds) {
            if (&first >= &second) continue;
            if (one_hides(first.thing, second.thing) != nullptr || one_hides(second.thing, first.thing) != nullptr) {
                ++hidden;
                continue;
            }
            ++pairs;
            Random random(602);
            for (int i = 0; i < 10; ++i) {
                const Spoilt set_up = spoilt(Faults({&first, &second}), random);
                const Diagnosis diagnosis = diagnosis_of(set_up.parts);
                const auto context = [&] {
                    return first.name + std::string(" and ") + second.name + ": " + text(diagnosis) + " in " +
                           text(set_up.parts);
                };
                CHECK_MESSAGE((diagnosis.contains(first.defect) && diagnosis.contains(second.defect)), context());
            }
        }
    }
    MESSAGE(pairs, " pairs, ", hidden, " hidden");
    CHECK(pairs > hidden);
}

TEST_CASE("what is not finite is said of every argument, and what can be seen beside it as well") {
    Random random(606);
    for (const double bad : {nan_double, infinity_double, -infinity_double}) {
        for (int i = 0; i < 300; ++i) {
            const Rig rig = random_rig(ordinary, random);
            const Projector good = projector_of(rig, projection(rig.lens, rig.conventions), rig.view);
            Parts parts{.projector = good,
                        .pose = rig.pose,
                        .texgen = composed(rig, good),
                        .in = rig.in,
                        .points = lit_points(rig, random),
                        .has_points = true,
                        .region = rig.region,
                        .depth = rig.depth,
                        .lens = all_facts(rig)};
            if (rig.in == In::world) parts.pose = std::nullopt;
            REQUIRE_MESSAGE(diagnosis_of(parts).empty(), text(diagnosis_of(parts)), " in ", text(parts));
            const auto spoil = [&](glm::dmat4 m) {
                m[random.integer(0, 3)][random.integer(0, 3)] = bad;
                return m;
            };
            Parts spoilt_parts = parts;
            const int which = random.integer(0, 12);
            if (which == 0)
                spoilt_parts.projector->projection = texgen::ProjectorProjection(spoil(good.projection.matrix()));
            if (which == 1) spoilt_parts.projector->view = texgen::ProjectorView(spoil(rig.view));
            if (which == 2) spoilt_parts.pose = spoil(rig.pose);
            if (which == 3) spoilt_parts.texgen = spoil(*parts.texgen);
            if (which == 4)
                spoilt_parts.points[static_cast<std::size_t>(random.integer(0, 7))].y = static_cast<float>(bad);
            if (which == 5) spoilt_parts.region = texgen::atlas_tile({0.0, bad}, {1.0, 1.0});
            if (which == 6) spoilt_parts.texels_per_unit = {512.0, bad};
            if (which == 7) spoilt_parts.lens.z_near = bad;
            if (which == 8) spoilt_parts.lens.aspect = bad;
            if (which == 9) spoilt_parts.lens.fovy = texgen::radians(bad);
            if (which == 10) spoilt_parts.region = texgen::atlas_tile({0.0, 0.0}, {1.0, bad});
            if (which == 11) spoilt_parts.region = texgen::whole_texture().with_depth(0.0, nan_double);
            if (which == 12) spoilt_parts.lens.z_far = random.coin() ? nan_double : -infinity_double;
            const Diagnosis diagnosis = diagnosis_of(spoilt_parts);
            REQUIRE_MESSAGE(diagnosis.contains(Defect::not_finite), which, " ", text(diagnosis));
            REQUIRE_MESSAGE(diagnosis[0].defect == Defect::not_finite, which, " ", text(diagnosis));
        }
    }
    // Any bits whatever: an answer, and no more.
    for (int i = 0; i < 20000; ++i) {
        const auto any_matrix = [&] {
            glm::dmat4 m(0.0);
            for (int j = 0; j < 16; ++j) m[j / 4][j % 4] = static_cast<double>(random.any_float());
            return m;
        };
        Parts parts{.in = static_cast<In>(random.integer(0, 2)), .has_points = random.coin()};
        if (random.coin())
            parts.projector = Projector{texgen::ProjectorProjection(any_matrix()), texgen::ProjectorView(any_matrix()),
                                        any_conventions(random)};
        if (random.coin()) parts.pose = any_matrix();
        if (random.coin()) parts.texgen = any_matrix();
        for (glm::vec3& point : parts.points) point = {random.any_float(), random.any_float(), random.any_float()};
        const Diagnosis diagnosis = diagnosis_of(parts);
        REQUIRE(diagnosis.size() <= texgen::defect_count);
    }
}

TEST_CASE("a region without points or below a texel is said without any point") {
    const auto of_region = [](const TextureRegion& region) {
        return diagnose(ProjectionSetup<Object>{.region = region, .texels_per_unit = {256.0, 256.0}});
    };
    CHECK(of_region(texgen::whole_texture()).empty());
    CHECK(of_region(texgen::atlas_tile({0.5, 0.0}, {0.25, 1.0})).contains(Defect::region_never_hit));
    const Diagnosis small = of_region(texgen::atlas_tile({0.5, 0.0}, {0.501, 1.0}));
    REQUIRE(small.contains(Defect::smaller_than_texel));
    CHECK(small[0].number == doctest::Approx(0.256));
}

TEST_CASE("a fan whose vertices all miss the slide may be lit in its middle, and is not found fault with") {
    const glm::vec3 around[] = {{-9.0f, -9.0f, -2.0f}, {9.0f, -9.0f, -2.0f}, {9.0f, 9.0f, -2.0f}, {-9.0f, 9.0f, -2.0f}};
    const texgen::PerspectiveLens lens{.fovy = texgen::degrees(30), .aspect = 1, .z_near = 0.2, .z_far = 1000};
    const auto projector =
        make_projector(lens, {.position = {0, 0, 0}, .target = {0, 0, -1}, .up = {0, 1, 0}}, texgen::opengl);
    REQUIRE(projector);
    ProjectionSetup<World> setup{.projector = projector, .points = texgen::world_space(around)};
    CHECK(diagnose(setup).empty());
    setup.points = texgen::world_space(std::span(around).first(2));
    CHECK(diagnose(setup).contains(Defect::region_never_hit));
}

TEST_CASE("findings keep their order, each once, and each has two sentences") {
    Diagnosis diagnosis;
    Random random(607);
    for (int i = 0; i < 1000; ++i)
        diagnosis.add(static_cast<Defect>(random.integer(0, static_cast<int>(texgen::defect_count) - 1)), i);
    REQUIRE(diagnosis.size() == texgen::defect_count);
    for (std::size_t i = 0; i < diagnosis.size(); ++i) {
        CHECK(static_cast<std::size_t>(diagnosis[i].defect) == i);
        CHECK(diagnosis[i].what().ends_with('.'));
        CHECK(diagnosis[i].remedy().ends_with('.'));
        for (std::size_t j = 0; j < i; ++j) CHECK(diagnosis[i].what() != diagnosis[j].what());
    }
}

TEST_CASE("the diagnosis allocates nothing") {
    Random random(608);
    std::vector<Parts> set_ups;
    for (const Kind& kind : kinds) set_ups.push_back(spoilt(Faults({&kind}), random).parts);
    const std::size_t before = allocations;
    std::size_t findings = 0;
    for (const Parts& parts : set_ups) findings += diagnosis_of(parts).size() + diagnose(*parts.projector).size();
    const std::size_t after = allocations;
    CHECK(after == before);
    CHECK(findings >= kinds.size());
    CHECK(allocations > 0);
}

static_assert(noexcept(diagnose(std::declval<const Projector&>())));
static_assert(noexcept(diagnose(std::declval<const ProjectionSetup<Object>&>())));
static_assert(noexcept(diagnose(std::declval<const texgen::EyeTexgen&>())));
static_assert(noexcept(texgen::diagnose(std::declval<const std::array<glm::vec4, 4>&>())));
static_assert(noexcept(std::declval<const texgen::Finding&>().what()));

TEST_CASE("a matrix of the other sign lights what is behind") {
    Random random(610);
    for (int i = 0; i < 100; ++i) {
        const Rig rig = random_rig(ordinary, random);
        Parts parts{.projector = projector_of(rig, projection(rig.lens, rig.conventions), rig.view),
                    .in = rig.in,
                    .region = rig.region,
                    .depth = rig.depth};
        if (rig.in != In::world) parts.pose = rig.pose;
        parts.texgen = composed(rig, *parts.projector);
        for (int j = 0; j < 4; ++j) (*parts.texgen)[j] = -(*parts.texgen)[j];
        const Diagnosis diagnosis = diagnosis_of(parts);
        REQUIRE_MESSAGE(diagnosis.size() == 1, text(diagnosis), " in ", text(parts));
        CHECK(diagnosis.contains(Defect::everything_behind));
    }
}

TEST_CASE("a reflection in the view mirrors, and one more in the lens undoes it") {
    Random random(611);
    for (int i = 0; i < 100; ++i) {
        const Rig rig = random_rig(ordinary, random);
        glm::dmat4 p = projection(rig.lens, rig.conventions), reflected = rig.view;
        for (int j = 0; j < 4; ++j) reflected[j][0] = -reflected[j][0];
        const Diagnosis once = diagnose(projector_of(rig, p, reflected));
        REQUIRE_MESSAGE(once.size() == 1, text(once));
        CHECK(once.contains(Defect::mirrored));
        const Diagnosis of_rows = diagnose(projector_of(rig, p, transposed(reflected)));
        CHECK(of_rows.contains(Defect::mirrored));
        CHECK(of_rows.contains(Defect::transposed));
        for (int j = 0; j < 4; ++j) p[j][0] = -p[j][0];
        CHECK(diagnose(projector_of(rig, p, reflected)).empty());
    }
}

TEST_CASE("points on the side of the region are in it, and one point alone has no size") {
    // s = x, t = y, q = 1.
    const texgen::WorldTexgen texgen(glm::dmat4(1.0));
    const glm::vec3 on_side[] = {{1.0f, 0.1f, 0.0f}, {1.0f, 0.9f, 0.0f}};
    const glm::vec3 beyond[] = {{1.0001f, 0.1f, 0.0f}, {1.0001f, 0.9f, 0.0f}};
    const glm::vec3 same[] = {{0.3f, 0.1f, 0.0f}, {0.3f, 0.1f, 0.0f}};
    CHECK(diagnose(texgen, {.points = texgen::world_space(on_side)}).empty());
    CHECK(diagnose(texgen, {.points = texgen::world_space(beyond)}).contains(Defect::region_never_hit));
    CHECK(diagnose(texgen, {.points = texgen::world_space(same)}).empty());

    // q = x - y + 2^-60: in front where x = y, by less than the terms' rounding could take.
    glm::dmat4 close(1.0);
    close[0][3] = 1.0;
    close[1][3] = -1.0;
    close[3][3] = 0x1p-60;
    const glm::vec3 in_doubt[] = {{1.0f, 1.0f, 0.0f}, {3.0f, 3.0f, 1.0f}};
    const glm::vec3 behind[] = {{1.0f, 1.5f, 0.0f}, {3.0f, 3.5f, 1.0f}};
    CHECK_FALSE(diagnose(texgen::WorldTexgen(close), {.points = texgen::world_space(in_doubt)})
                    .contains(Defect::everything_behind));
    CHECK(diagnose(texgen::WorldTexgen(close), {.points = texgen::world_space(behind)})
              .contains(Defect::everything_behind));
}

TEST_CASE("points before and beyond the depth of the region are said, and one within it is enough") {
    const texgen::PerspectiveLens lens{.fovy = texgen::degrees(60), .aspect = 1, .z_near = 1, .z_far = 20};
    const texgen::Aim aim{.position = {0, 0, 0}, .target = {0, 0, -1}, .up = {0, 1, 0}};
    for (const texgen::Conventions conventions : {texgen::opengl, texgen::direct3d}) {
        for (const auto mapping : {texgen::DepthMapping::unit, texgen::DepthMapping::ndc}) {
            const TextureRegion region = texgen::whole_texture().with_depth(conventions, mapping);
            const auto at = [&](std::vector<glm::vec3> points, const TextureRegion& seen) {
                return diagnose(ProjectionSetup<World>{.projector = make_projector(lens, aim, conventions),
                                                       .points = texgen::world_space(points),
                                                       .region = seen,
                                                       .depth = mapping});
            };
            const auto beyond = at({{0, 0, -21}, {1, 0, -500}}, region);
            REQUIRE_MESSAGE(beyond.size() == 1, text(beyond));
            CHECK(beyond.contains(Defect::everything_above_depth));
            const auto before = at({{0, 0, -0.9f}, {0.1f, 0, -0.5f}}, region);
            REQUIRE_MESSAGE(before.size() == 1, text(before));
            CHECK(before.contains(Defect::everything_below_depth));
            CHECK(at({{0, 0, -0.9f}, {1, 0, -500}}, region).empty());
            CHECK(at({{0, 0, -21}, {1, 0, -19}}, region).empty());
            CHECK(at({{0, 0, -21}, {1, 0, -500}}, texgen::whole_texture()).empty());
            CHECK(at({{0, 0, -21}, {1, 0, -500}}, texgen::whole_texture().with_depth(0.0, HUGE_VAL)).empty());
            const auto behind = at({{0, 0, 21}, {1, 0, 500}}, region);
            CHECK(behind.contains(Defect::everything_behind));
            CHECK_FALSE(behind.contains(Defect::everything_above_depth));
            CHECK_FALSE(behind.contains(Defect::everything_below_depth));
        }
    }
    const auto of_region = [](const TextureRegion& region) {
        return diagnose(ProjectionSetup<Object>{.region = region});
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(of_region(texgen::whole_texture().with_depth(0.5, 0.25)).contains(Defect::region_never_hit));
    CHECK(of_region(texgen::whole_texture().with_depth(nan, 1.0)).contains(Defect::not_finite));
    CHECK(of_region(texgen::whole_texture().with_depth(0.0, HUGE_VAL)).empty());
}

TEST_CASE("far from the origin the rounding of float hides no depth range, where the matrix was rounded once") {
    Random random(612);
    int found = 0;
    while (found < 100) {
        Rig rig = random_rig({.least_fovy = 20.0,
                              .most_fovy = 60.0,
                              .distance = 5.0,
                              .least_tile = 0.1,
                              .far_decades = 4.0,
                              .scale_decades = 0.0},
                             random);
        if (rig.in == In::world || rig.lens.kind != LensKind::infinite ||
            dot3(rig.aim.position, rig.aim.position) < 1e8)
            continue;
        if (rig.lens.z_near < 0.5) continue;
        rig.conventions = texgen::direct3d;
        const Projector projector = projector_of(rig, projection(rig.lens, rig.conventions), rig.view);
        glm::dmat4 texgen = composed(rig, projector);
        for (int i = 0; i < 4; ++i) texgen[i][2] = 0.5 * texgen[i][2] + 0.5 * texgen[i][3];
        const Diagnosis diagnosis = diagnosis_of({.projector = projector,
                                                  .pose = rig.pose,
                                                  .texgen = to_float(texgen),
                                                  .in = rig.in,
                                                  .region = rig.region,
                                                  .depth = rig.depth});
        REQUIRE_MESSAGE(diagnosis.contains(Defect::depth_range_mismatch), text(diagnosis));
        ++found;
    }
}

namespace {

// These are the findings, and all of them.
void require_said(const Parts& parts, std::initializer_list<Defect> defects) {
    const Diagnosis diagnosis = diagnosis_of(parts);
    const bool is_said = std::equal(diagnosis.begin(), diagnosis.end(), defects.begin(), defects.end(),
                                    [](const auto& finding, Defect defect) { return finding.defect == defect; });
    REQUIRE_MESSAGE(is_said, text(diagnosis), " in ", text(parts));
}

// With a lens of that kind, in the world.
Rig rig_of(LensKind kind, Random& random) {
    Rig rig = random_rig(ordinary, random);
    while (rig.lens.kind != kind || rig.in != In::world) rig = random_rig(ordinary, random);
    return rig;
}

Parts parts_of(const Rig& rig, const glm::dmat4& p, const glm::dmat4& v) {
    return {.projector = projector_of(rig, p, v), .in = rig.in, .region = rig.region, .depth = rig.depth};
}

glm::dmat4 with(glm::dmat4 m, int column, int row, double value) {
    m[column][row] = value;
    return m;
}

glm::dmat4 with_row_turned(const glm::dmat4& m, int row) { return with(glm::dmat4(1.0), row, row, -1.0) * m; }

}  // namespace

TEST_CASE("an element that no lens, no view and no transposed one has makes it none, and nothing is said of it") {
    Random random(650);
    for (int i = 0; i < 100; ++i) {
        const bool is_parallel = i % 2 != 0;
        const Rig rig = rig_of(is_parallel ? LensKind::orthographic : LensKind::perspective, random);
        const glm::dmat4 p = projection(rig.lens, rig.conventions), mirrored = with_row_turned(p, 0),
                         for_rows = transposed(p), v = rig.view, reflected = with_row_turned(v, 0);
        for (int column = 0; column < 4; ++column) {
            for (int row = 0; row < 4; ++row) {
                const bool is_of_w = column == (is_parallel ? 3 : 2);  // off the axis, and w itself
                if (is_of_w || (row == 2 ? column > 1 : row < 2 && column < 2 && column >= row)) continue;
                require_said(parts_of(rig, with(mirrored, column, row, 0.25), v), {});
                if (is_parallel || row == 3 || column == 3)
                    require_said(parts_of(rig, with(for_rows, row, column, 0.25), v), {});
            }
            const double other = column == 3 ? 0.0 : 0.25;
            if (!is_parallel || column < 3) require_said(parts_of(rig, p, with(reflected, column, 3, other)), {});
            require_said(parts_of(rig, p, with(transposed(v), 3, column, other)), {});
            const glm::dmat4 along_axis = with(glm::dmat4(1.0), 3, column % 3, 5.0);
            require_said(parts_of(rig, p, transposed(along_axis)), {Defect::transposed});
            require_said(parts_of(rig, p, with(along_axis, column % 3, 3, 0.25)), {});
        }
        require_said(parts_of(rig, 3.0 * p, v), {});
        require_said(parts_of(rig, mirrored, v), {Defect::mirrored});
        require_said(parts_of(rig, for_rows, v), {Defect::transposed});
        require_said(parts_of(rig, p, reflected), {Defect::mirrored});
        require_said(parts_of(rig, with(mirrored, 1, 1, 0.0), v), {Defect::rank_below_three});
        if (!is_parallel)
            require_said(parts_of(rig, with(with(p, 2, 3, 0.0), 3, 2, 1.0), v), {Defect::rank_below_three});
    }
}

TEST_CASE("a projection of the other sign is of no other hand, and has its view's place where that is not as good") {
    Random random(651);
    for (int i = 0; i < 100; ++i) {
        const Rig parallel = rig_of(LensKind::orthographic, random), rig = rig_of(LensKind::perspective, random);
        const glm::dmat4 p = projection(rig.lens, rig.conventions), v = rig.view, one(1.0),
                         of_parallel = projection(parallel.lens, parallel.conventions);
        require_said(parts_of(parallel, -of_parallel, parallel.view), {Defect::everything_behind});
        require_said(parts_of(rig, -p, v), {Defect::everything_behind});
        glm::dmat4 turned = p;
        turned[2] = -turned[2];
        require_said(parts_of(rig, with_row_turned(turned, 0), v), {Defect::mixed_handedness, Defect::mirrored});
        require_said(parts_of(rig, with_row_turned(turned, 1), v), {Defect::mixed_handedness, Defect::upside_down});

        const auto is_exchanged = [&](const glm::dmat4& lens, const glm::dmat4& view) {
            return diagnosis_of(parts_of(rig, lens, view)).contains(Defect::view_projection_swapped);
        };
        INFO(hex(p), " ", hex(v), " ", hex(of_parallel));
        REQUIRE((is_exchanged(v, p) && is_exchanged(one, p) && is_exchanged(v, of_parallel)));
        REQUIRE_FALSE((is_exchanged(one, of_parallel) || is_exchanged(v, parallel.view) || is_exchanged(p, p)));
        REQUIRE_FALSE(is_exchanged(v, with(p, 0, 0, nan_double)));
    }
}

TEST_CASE("a matrix that holds no numbers, or was never written, is said alone, and a pose or view by itself") {
    Random random(653);
    for (int i = 0; i < 300; ++i) {
        const Rig rig = random_rig(ordinary, random);
        const glm::dmat4 p = projection(rig.lens, rig.conventions);
        Parts parts = parts_of(rig, p, rig.view);
        if (rig.in != In::world) {
            const Transform<World, texgen::Window> of_window(transposed(rig.pose));
            CHECK(diagnose(ProjectionSetup<texgen::Window>{.world_from_space = of_window}).empty());
            parts.pose = of_window.matrix();
            require_said(parts, {Defect::transposed});
            glm::dmat4 far_away = rig.pose;
            far_away[3].x += 1e6;
            parts.pose = transposed(far_away);
            require_said(parts, {Defect::transposed});
            require_said({.pose = parts.pose, .in = rig.in}, {Defect::transposed});
            parts.pose = with(rig.pose, 0, 1, nan_double);
            require_said(parts, {Defect::not_finite});
            parts.pose = rig.pose;
        }
        const Parts good = parts;
        for (const bool has_texgen : {false, true}) {
            for (const double bad : {0.0, nan_double}) {
                const Defect defect = bad == 0.0 ? Defect::never_written : Defect::not_finite;
                if (has_texgen) parts.texgen = bad * p, require_said(parts, {defect});
                if (has_texgen) parts.texgen = composed(rig, *good.projector);
                parts.projector = projector_of(rig, bad * p, rig.view);
                require_said(parts, {defect});
                parts.projector = projector_of(rig, p, bad * rig.view);
                require_said(parts, {defect});
                parts.projector = good.projector;
            }
        }
        parts.projector = projector_of(rig, p, with(glm::dmat4(1.0), 2, 2, 0.0) * rig.view);
        CHECK_MESSAGE(diagnosis_of(parts).contains(Defect::rank_below_three), text(parts));
    }
}

TEST_CASE("points of one ray are smaller than a texel, unless one is behind, and where all are they are in no depth") {
    const texgen::Aim along_z{{0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}};
    for (const Conventions& conventions : {texgen::opengl, texgen::direct3d, left_handed(texgen::vulkan)}) {
        for (const bool is_reversed : {false, true}) {
            const texgen::PerspectiveLens lens{texgen::degrees(40.0), 1.5, 0.5, 100.0, is_reversed};
            Parts parts{.projector = make_projector(lens, along_z, conventions), .in = In::world, .has_points = true};
            const auto place = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c) { parts.points = {a, b, c, a, b, c, a, b}; };
            place({0, 0, -8}, {0, 0, 8}, {0, 0, -8});
            require_said(parts, {});
            place({0, 0, -8}, {0, 0, -9}, {3, 1, 8});
            require_said(parts, {});
            place({0, 0, -8}, {0, 0, -9}, {0, 1e-5f, -8});
            const double size = diagnosis_of(parts)[0].number;
            CHECK(size > 0.0);
            // The texture's size is known where both of its sides are.
            for (const double other : {0.0, -256.0}) {
                for (const glm::dvec2& texels : {glm::dvec2(256.0, other), {other, 256.0}, {other, other}}) {
                    parts.texels_per_unit = texels;
                    require_said(parts, {Defect::smaller_than_texel});
                    CHECK(diagnosis_of(parts)[0].number == size);
                }
            }
            for (const glm::dvec2& corner : {glm::dvec2(1.0, 0.0), {0.0, 1.0}}) {
                const TextureRegion empty = texgen::atlas_tile(corner, glm::dvec2(1.0) - corner);
                require_said({.in = In::world, .region = empty, .texels_per_unit = {256.0, 256.0}},
                             {Defect::region_never_hit});
                parts.texels_per_unit = {0.0, 0.0}, parts.region = empty;
                require_said(parts, {Defect::region_never_hit});
            }
            place({0, 0, 8}, {1, 0, 8}, {0, 2, 9});
            parts.region = texgen::whole_texture().with_depth(0.0, 1.0);
            require_said(parts, {Defect::everything_behind, Defect::region_never_hit});
            parts.projector = std::nullopt;
            require_said(parts, {});
        }
    }
}

TEST_CASE("what is behind or beside the slide loses nothing, and what is lit what is measured where that is known") {
    Random random(654);
    const TextureRegion whole = texgen::whole_texture();
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 position = random.power_of_ten(1.0, 4.5) * random.direction(), forward = random.direction();
        const auto projector = make_projector(texgen::PerspectiveLens{texgen::degrees(40.0), 1.0, 0.5, 10.0},
                                              {position, position + forward, random.direction()}, texgen::opengl);
        REQUIRE(projector);
        const glm::dmat4 right = texture_from_world(*projector).matrix(), texgen = to_float(right);
        // In texels of a picture of 4096; of what every point that is lit loses, on the far plane q is 10.
        double measured = 409.6 * std::max(std::fabs(right[3].x - texgen[3].x), std::fabs(right[3].y - texgen[3].y));
        const auto loss = [&](const glm::dvec3& from_projector, bool is_known) {
            Parts parts{.texgen = texgen, .in = In::world, .has_points = true};
            parts.points.fill(glm::vec3(position + 9.0 * forward));
            parts.points[0] = glm::vec3(position + from_projector);
            if (is_known) parts.projector = projector;
            const Diagnosis diagnosis = diagnosis_of(parts);
            return diagnosis.contains(Defect::precision_lost) ? diagnosis[0].number : 0.0;
        };
        for (const double distance : {8.0, 9.0}) {
            const glm::vec3 point(position + distance * forward);
            const glm::dvec2 error = seen(right, whole, point).st - seen(texgen, whole, point).st;
            measured = std::max({measured, 4096.0 * std::fabs(error.x), 4096.0 * std::fabs(error.y)});
        }
        INFO(hex(texgen), " at ", hex(position), " along ", hex(forward));
        CHECK(loss(8.0 * forward, true) <= 1.001 * measured);
        const glm::dvec3 side = xyz(transposed(projector->view.matrix())[0]);
        for (const bool is_known : {false, true})
            for (const glm::dvec3& place : {5.0 * side + 0.01 * forward, -0.01 * forward})
                CHECK(loss(place, is_known) == loss(9.0 * forward, is_known));
    }
}
