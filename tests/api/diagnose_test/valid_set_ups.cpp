// Set-ups that are as they should be, random ones and those of round numbers: none is found fault with.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "api/diagnose_test/rigs.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/windows.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/projector.hpp"

namespace diagnose_cases {

namespace {

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
    classes.reversed += rig.lens.is_reversed;
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
    const auto whole = [&](int most) { return static_cast<double>(random.integer(-most, most)); };
    int far = 0, empty_poses = 0;
    for (int i = 0; i < 50000; ++i) {
        Rig rig;
        rig.conventions = any_conventions(random);
        rig.lens = {static_cast<LensKind>(random.integer(0, 3)),
                    random.coin() ? 90.0 : 60.0,
                    random.coin() ? 1.0 : 2.0,
                    1.0,
                    4.0,
                    -1.0,
                    1.0,
                    random.coin() ? -1.0 : 0.0,
                    1.0,
                    random.coin()};
        if (rig.lens.kind == LensKind::infinite) rig.lens.z_far = infinity_double;
        const int most = random.integer(0, 2) == 0 ? 10000000 : random.integer(0, 3);
        rig.aim.position = {whole(most), whole(most), whole(most)};
        rig.aim.up = any_axis(random);
        const glm::dvec3 direction = any_axis_but(rig.aim.up, random);
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
        Parts parts = parts_of(rig, projection(rig.lens, rig.conventions), rig.view);
        parts.lens = all_facts(rig);
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

}  // namespace diagnose_cases
