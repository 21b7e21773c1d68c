// What is said of matrices whose elements no lens and no view has: not finite, of the other sign, or reflected.

#include <doctest/doctest.h>

#include <cstddef>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "api/diagnose_test/rigs.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/windows.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/projector.hpp"

namespace diagnose_cases {

using support::nan_double;

namespace {

// With a lens of that kind, in the world.
Rig rig_of(LensKind kind, Random& random) {
    Rig rig = random_rig(ordinary, random);
    while (rig.lens.kind != kind || rig.in != In::world) rig = random_rig(ordinary, random);
    return rig;
}

glm::dmat4 with(glm::dmat4 m, int column, int row, double value) {
    m[column][row] = value;
    return m;
}

glm::dmat4 with_row_turned(const glm::dmat4& m, int row) { return with(glm::dmat4(1.0), row, row, -1.0) * m; }

}  // namespace

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

TEST_CASE("a matrix of the other sign lights what is behind") {
    Random random(610);
    for (int i = 0; i < 100; ++i) {
        const Rig rig = random_rig(ordinary, random);
        Parts parts = parts_of(rig, projection(rig.lens, rig.conventions), rig.view);
        if (rig.in != In::world) parts.pose = rig.pose;
        parts.texgen = composed(rig, *parts.projector);
        for (int j = 0; j < 4; ++j) (*parts.texgen)[j] = -(*parts.texgen)[j];
        require_said(parts, {Defect::everything_behind});
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
            const texgen::Transform<World, texgen::Window> of_window(transposed(rig.pose));
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

}  // namespace diagnose_cases
