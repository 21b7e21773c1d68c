// The diagnosis of products that users make by hand: the mistakes of the papers' readers are named first, whatever the
// API, the lens, the place and the precision, and what is right is not found fault with.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "api/diagnose_product_test/users_code.hpp"
#include "support/random.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace product_cases {

namespace {

// Without its projector a matrix shows no lens of parallel light, and of frusta no angle.
bool is_shown(const Meant& m, Mistake mistake) {
    return is_of_range(mistake) ? m.kind != LensKind::orthographic : m.kind <= LensKind::infinite;
}

// Of the rest nothing is seen without the projector: a pose is the view of another, and a lens that looks back a turned
// one.
bool needs_projector(Mistake mistake) {
    return mistake == Mistake::pose_for_view || mistake == Mistake::lens_of_other_hand;
}

}  // namespace

TEST_CASE("what users' own code gets wrong is named first, with the projector that was meant beside it") {
    for (const Mistake mistake : mistakes) {
        Random random(620);
        for (int i = 0; i < 1000;) {
            Meant m = any_meant(mistake, random);
            const In in = put_in_space(m, random);
            const std::optional<Projector> projector = right_projector(m);
            if (!projector || !leaves_a_trace(m, mistake, Told::projector)) continue;
            const glm::dmat4 texgen = made_somehow(m, mistake, random);
            const Diagnosis diagnosis = diagnosis_of(m, in, random.coin() ? *projector : own_projector(m),
                                                     Told::projector, random.coin(), texgen);
            REQUIRE_MESSAGE(!diagnosis.empty(), text(m, texgen, diagnosis));
            REQUIRE_MESSAGE(diagnosis[0].defect == defect_of(mistake), text(m, texgen, diagnosis));
            ++i;
        }
    }
}

TEST_CASE("what users' own code gets wrong is named first, with what is known of the lens beside it") {
    for (const Mistake mistake : mistakes) {
        if (needs_projector(mistake)) continue;
        Random random(621);
        for (int i = 0; i < 1000;) {
            Meant m = any_meant(mistake, random);
            const In in = put_in_space(m, random);
            if (!is_shown(m, mistake) || !leaves_a_trace(m, mistake, Told::lens)) continue;
            const glm::dmat4 texgen = made_somehow(m, mistake, random);
            const bool has_conventions = m.depth == DepthMapping::ndc || random.coin();
            const Diagnosis diagnosis = diagnosis_of(m, in, std::nullopt, Told::lens, has_conventions, texgen);
            REQUIRE_MESSAGE(!diagnosis.empty(), text(m, texgen, diagnosis));
            REQUIRE_MESSAGE(diagnosis[0].defect == defect_of(mistake), text(m, texgen, diagnosis));
            ++i;
        }
    }
}

TEST_CASE("what users' own code gets wrong is named first, with the projector but without the pose") {
    for (const Mistake mistake : mistakes) {
        if (needs_projector(mistake)) continue;
        Random random(629);
        for (int i = 0; i < 300;) {
            Meant m = any_meant(mistake, random);
            m.pose = random.rotation();  // a scale that is not the same in all directions hides the lens
            m.pose[3] = glm::dvec4(m.aim.position, 1.0);
            // Without its unit a matrix has no distance: only the far plane's, over near, is in it.
            const bool is_in_units =
                !is_of_range(mistake) || (m.kind != LensKind::infinite && m.z_far < 1e3 * m.z_near);
            const std::optional<Projector> projector = right_projector(m);
            if (!projector || !is_shown(m, mistake) || !is_in_units || !leaves_a_trace(m, mistake, Told::lens))
                continue;
            const glm::dmat4 texgen = made_somehow(m, mistake, random);
            const Diagnosis diagnosis = diagnose(
                texgen::ObjectTexgen(texgen),
                {.projector = random.coin() ? *projector : own_projector(m), .region = m.region, .depth = m.depth});
            REQUIRE_MESSAGE(!diagnosis.empty(), text(m, texgen, diagnosis));
            REQUIRE_MESSAGE(diagnosis[0].defect == defect_of(mistake), text(m, texgen, diagnosis));
            ++i;
        }
    }
}

TEST_CASE("of a matrix alone the numbers that people write name what is wrong with them") {
    for (const Mistake mistake : mistakes) {
        if (needs_projector(mistake) || mistake == Mistake::inverted_aspect) continue;
        Random random(622);
        int found = 0;
        for (int i = 0; i < 1000; ++i) {
            Meant m = human(mistake, random);
            m.depth = DepthMapping::unit;
            if (!leaves_a_trace(m, mistake, Told::nothing)) m.fovy = 30.0;
            if (mistake == Mistake::no_bias || mistake == Mistake::bias_without_w) m.fovy = random.integer(20, 120);
            // Where r lacks no bias that is round, that is the quarter of a lens as well.
            if (m.fovy == 90.0 && (m.is_zero_to_one() || mistake == Mistake::bias_without_w)) m.fovy = 91.0;
            // Where far is much farther, near is round in float with a bias of r and without one.
            if (!is_of_range(mistake)) m.z_far = std::min(m.z_far, 200.0 * m.z_near);
            const In in = random.coin() ? In::object : In::world;
            if (in == In::world) m.pose = glm::dmat4(1.0);
            // Floats keep few digits of the near plane, and an angle only where the picture stands on its head as well.
            const bool keeps_float = mistake == Mistake::radians ? std::tan(0.5 * m.fovy) < 0.0 : !is_of_range(mistake);
            const glm::dmat4 texgen = keeps_float ? made_somehow(m, mistake, random) : made<double>(m, mistake, random);
            const Diagnosis diagnosis = diagnosis_of(m, in, std::nullopt, Told::nothing, true, texgen);
            found += !diagnosis.empty() && diagnosis[0].defect == defect_of(mistake);
        }
        CHECK_MESSAGE(found >= (is_of_range(mistake) ? 950 : 1000), found, " of ", static_cast<int>(mistake));
    }
}

TEST_CASE("a lens of the other range is a lens from another distance, and named by the one that was meant") {
    Meant m, other;
    m.aim = {{1.0, 5.0, 2.0}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    other.z_near = 10.0 / 199.9;
    const glm::dmat4 bias = Code<double>::bias(m), view = Code<double>::view(m);
    const double fovy = glm::radians(m.fovy);
    const glm::dmat4 mistaken = bias * Code<double>::lens(m, fovy, true) * view;
    const glm::dmat4 right = bias * Code<double>::lens(other, fovy, false) * view;
    for (int i = 0; i < 4; ++i)
        for (int row = 0; row < 4; ++row) CHECK(std::fabs(mistaken[i][row] - right[i][row]) < 1e-14);
    for (const glm::dmat4& texgen : {mistaken, glm::dmat4(support::rounded(mistaken))}) {
        const Diagnosis diagnosis = diagnosis_of(m, In::world, std::nullopt, Told::lens, false, texgen);
        REQUIRE(diagnosis.size() == 1);
        CHECK(diagnosis[0].defect == Defect::depth_range_mismatch);
        CHECK(diagnosis_of(other, In::world, std::nullopt, Told::lens, false, texgen).empty());
    }
}

TEST_CASE("degrees as radians are named where the picture is level over y and over z, and up is along one of them") {
    Meant m;
    m.aspect = 4.0 / 3.0;
    for (const glm::dvec3& up : {glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(0.0, 0.0, 1.0)}) {
        for (const glm::dvec3& position :
             {glm::dvec3(0.0, 5.0, 5.0), glm::dvec3(0.0, -5.0, 5.0), glm::dvec3(0.0, 5.0, -5.0),
              glm::dvec3(0.0, -5.0, -5.0), glm::dvec3(0.0, 2.0, 9.0), glm::dvec3(5.0, 0.0, 0.0)}) {
            m.aim = {position, {0.0, 0.0, 0.0}, up};
            for (const double number : {30.0, 45.0, 60.0, 75.0, 90.0}) {
                const auto diagnosis_of_angle = [&](double fovy, bool has_conventions) {
                    const glm::dmat4 clip = Code<double>::lens(m, fovy, false) * Code<double>::view(m);
                    return diagnosis_of(m, In::world, std::nullopt, Told::nothing, has_conventions,
                                        Code<double>::bias(m) * clip);
                };
                for (const bool has_conventions : {false, true}) {
                    CAPTURE(number);
                    CHECK(diagnosis_of_angle(glm::radians(number), has_conventions).empty());
                    const Diagnosis diagnosis = diagnosis_of_angle(number, has_conventions);
                    REQUIRE(!diagnosis.empty());
                    CHECK(diagnosis[0].defect == Defect::angle_unit_mistaken);
                }
            }
        }
    }
}

TEST_CASE("a model that is scaled to nothing shows without any matrix") {
    Random random(625);
    for (int i = 0; i < 200; ++i) {
        Meant m = any_meant(Mistake::none, random);
        const std::optional<Projector> projector = right_projector(m);
        if (!projector) continue;
        texgen::ProjectionSetup<Object> setup{.region = m.region, .depth = m.depth};
        if (random.coin()) setup.projector = projector;
        setup.world_from_space = texgen::ModelMatrix(m.pose);
        CHECK(diagnose(setup).empty());
        for (int axis = 0; axis < 3; ++axis) m.pose[axis] = glm::dvec4(0.0);
        setup.world_from_space = texgen::ModelMatrix(m.pose);
        const Diagnosis diagnosis = diagnose(setup);
        REQUIRE(diagnosis.size() == 1);
        CHECK(diagnosis[0].defect == Defect::rank_below_three);
    }
}

TEST_CASE("of a projector alone the numbers that people write name the wrong unit and the wrong range") {
    Random random(626);
    int angles = 0, ranges = 0;
    for (int i = 0; i < 1000; ++i) {
        const Meant m = human(Mistake::none, random);
        const auto diagnosis_of_lens = [&](double fovy, bool zero_to_one, const texgen::LensFacts& facts = {}) {
            const Projector projector{texgen::ProjectorProjection(Code<double>::lens(m, fovy, zero_to_one)),
                                      texgen::ProjectorView(Code<double>::view(m)), m.conventions};
            return diagnose(texgen::ProjectionSetup<texgen::World>{.projector = projector, .lens = facts});
        };
        const double fovy = glm::radians(m.fovy);
        REQUIRE(diagnosis_of_lens(fovy, m.is_zero_to_one()).empty());
        const Diagnosis of_degrees = diagnosis_of_lens(m.fovy, m.is_zero_to_one());
        REQUIRE(!of_degrees.empty());
        angles += of_degrees[0].defect == Defect::angle_unit_mistaken;
        const Diagnosis of_range = diagnosis_of_lens(fovy, !m.is_zero_to_one());
        ranges += !of_range.empty() && of_range[0].defect == Defect::depth_range_mismatch;
        // Where a plane is known, numbers do not speak: the lens is one for this range that has another near plane.
        if (!m.is_zero_to_one()) REQUIRE(diagnosis_of_lens(fovy, true, {.z_far = m.z_far}).empty());
        REQUIRE(diagnosis_of_lens(fovy, !m.is_zero_to_one(), {.z_near = 1.5 * m.z_near}).empty());
    }
    CHECK(angles == 1000);
    CHECK(ranges >= 950);
}

TEST_CASE(
    "a near plane at the eye, or both planes behind it, are named of a projector alone, and a reversed depth not") {
    Random random(4720);
    for (int i = 0; i < 3000; ++i) {
        Meant m = any_meant(Mistake::lens_of_other_hand, random);
        if (m.kind == LensKind::frustum) m.kind = LensKind::perspective;
        const Meant right = m;
        const bool is_float = random.coin();
        const auto diagnosis_of = [&](const Meant& of) {
            const glm::dmat4 p = is_float ? glm::dmat4(Code<float>::lens(of)) : Code<double>::lens(of);
            return diagnose(
                Projector{texgen::ProjectorProjection(p), texgen::ProjectorView(glm::dmat4(1.0)), of.conventions});
        };
        REQUIRE(diagnosis_of(right).empty());
        std::swap(m.z_near, m.z_far);  // near and far exchanged is a reversed depth, in its range or in the other
        REQUIRE(!diagnosis_of(m).contains(Defect::near_not_in_front));
        m = right;
        m.z_near *= -1.0;
        m.z_far *= -1.0;
        if (right.kind == LensKind::infinite) m.z_far = right.z_far;
        const Diagnosis behind = diagnosis_of(m);
        REQUIRE_MESSAGE(behind.contains(Defect::near_not_in_front), text(m, glm::dmat4(1.0), behind));
        REQUIRE(behind[0].defect == Defect::near_not_in_front);
        if (right.kind == LensKind::infinite) continue;  // GLM divides 0 by 0
        m = right;
        m.z_near = 0.0;
        const Diagnosis at_eye = diagnosis_of(m);
        REQUIRE_MESSAGE(at_eye.contains(Defect::near_not_in_front), text(m, glm::dmat4(1.0), at_eye));
    }
}

TEST_CASE("a matrix that lacks a column, or whose lens is another that mirrors alike, is not of this set-up") {
    Random random(655);
    for (int i = 0; i < 300; ++i) {
        Meant m = any_meant(Mistake::none, random);
        const auto require_stale = [&](const glm::dmat4& texgen, bool mirrored) {
            const Diagnosis diagnosis = diagnose(texgen::WorldTexgen(texgen), {.projector = right_projector(m),
                                                                               .region = m.region,
                                                                               .depth = m.depth,
                                                                               .lens = {.mirrored = mirrored}});
            REQUIRE_MESSAGE(diagnosis.size() == 1, text(m, texgen, diagnosis));
            CHECK(diagnosis[0].defect == Defect::not_of_this_set_up);
        };
        m.kind = LensKind::perspective;
        for (int column = 0; column < 4; ++column) {
            glm::dmat4 texgen = texture_from_world(*right_projector(m), m.region, m.depth).matrix();
            texgen[column] = glm::dvec4(0.0);
            require_stale(texgen, false);
        }
        m.kind = LensKind::frustum;
        if (i % 3 != 1) std::swap(m.left, m.right);
        if (i % 3 != 0) std::swap(m.bottom, m.top);
        Meant other = m;
        other.left *= 1.5, other.right *= 1.7, other.bottom *= 1.3, other.top *= 1.1;
        require_stale(texture_from_world(*right_projector(other), m.region, m.depth).matrix(), true);
    }
}

TEST_CASE("a bias without w is named in a tile of an atlas too, where both s and t lack it and w is what it is") {
    Random random(656);
    for (int i = 0; i < 300; ++i) {
        Meant m = any_meant(Mistake::bias_without_w, random);
        m.region = texgen::atlas_tile({0.25, 0.5}, {0.5, 0.75});
        const In in = put_in_space(m, random);
        const auto is_named = [&](const glm::dmat4& texgen) {
            return diagnosis_of(m, in, right_projector(m), Told::projector, false, texgen)
                .contains(Defect::bias_without_w);
        };
        const glm::dmat4 s = Code<double>::bias(m), right = made<double>(m, Mistake::none, random);
        glm::dmat4 mistaken = made<double>(m, Mistake::no_bias, random);
        for (int row = 0; row < 2; ++row) {
            // By the tile's scale, with s or t turned, or by 1/2.
            const double scale = i % 3 == 2 ? 0.5 : i % 3 == row ? -s[row][row] : s[row][row];
            for (int column = 0; column < 4; ++column) mistaken[column][row] *= scale;
            mistaken[3][row] += i % 3 == 2 ? 0.5 : s[3][row];
        }
        REQUIRE_MESSAGE(is_named(mistaken), text(m, mistaken, {}));
        for (const int row : {0, 1, 3}) {
            glm::dmat4 other = mistaken;
            for (int column = 0; column < 4; ++column)
                other[column][row] = row == 3 ? other[column][3] + other[column][0] : right[column][row];
            REQUIRE_MESSAGE(!is_named(other), text(m, other, {}));
        }
    }
}

}  // namespace product_cases
