// What the rounding to float hides and what it loses: along the axes, in parallel light, and far from the origin.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "api/diagnose_test/rigs.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/windows.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace diagnose_cases {

namespace {

// A projector along the axes, or turned about one of them, whose rounding to float leaves rows as they are.
Rig aligned_rig(Random& random) {
    Rig rig;
    rig.conventions = any_conventions(random);
    rig.lens = random_lens(ordinary, random);
    rig.lens.kind = random.integer(0, 2) == 0 ? static_cast<LensKind>(random.integer(0, 2)) : LensKind::orthographic;
    if (rig.lens.kind == LensKind::infinite)
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
    rig.aim.up = any_axis(random);
    glm::dvec3 direction = any_axis_but(rig.aim.up, random);
    if (random.integer(0, 3) == 0) {
        const glm::dvec3 aside = any_axis_but(direction, random);
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
        if (rig.in == In::world || rig.lens.kind != LensKind::infinite || rig.lens.is_reversed ||
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

}  // namespace diagnose_cases
