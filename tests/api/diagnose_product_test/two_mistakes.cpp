// Products with a second mistake: what is told besides hides nothing that shows without it.

#include <doctest/doctest.h>

#include <optional>
#include <utility>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "api/diagnose_product_test/users_code.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/projector.hpp"

namespace product_cases {

TEST_CASE(
    "a transposed product with another mistake in it is said to be transposed first, and the other is named too") {
    for (const Mistake mistake : mistakes) {
        Random random(660);
        for (int i = 0; i < 300;) {
            const bool is_human = random.coin();
            Meant m = is_human ? human(mistake, random) : any_meant(mistake, random);
            const In in = put_in_space(m, random);
            const std::optional<Projector> projector = right_projector(m);
            if (!projector || !leaves_a_trace(m, mistake, Told::lens)) continue;
            const glm::dmat4 texgen = glm::transpose(made_somehow(m, mistake, random));
            // Far away rows r and q may be anything, within rounding.
            if (!diagnosis_of(m, in, std::nullopt, Told::nothing, false, texgen).contains(Defect::transposed)) continue;
            const Diagnosis diagnosis = diagnosis_of(m, in, random.coin() ? *projector : own_projector(m),
                                                     Told::projector, random.coin(), texgen);
            REQUIRE_MESSAGE(!diagnosis.empty(), text(m, texgen, diagnosis));
            REQUIRE_MESSAGE(diagnosis[0].defect == Defect::transposed, text(m, texgen, diagnosis));
            if (is_human) REQUIRE_MESSAGE(diagnosis.contains(defect_of(mistake)), text(m, texgen, diagnosis));
            ++i;
        }
    }
}

TEST_CASE("a product without its view is transposed first as well, whatever else is told") {
    Random random(661);
    for (int i = 0; i < 1000; ++i) {
        Meant m = human(Mistake::none, random);
        const glm::dmat4 clip = Code<double>::lens(m) * m.pose;
        const glm::dmat4 texgen = glm::transpose(Code<double>::bias(m) * clip);
        for (const Told told : {Told::nothing, Told::lens, Told::projector}) {
            const Diagnosis diagnosis = diagnosis_of(m, In::object, right_projector(m), told, true, texgen);
            REQUIRE_MESSAGE(!diagnosis.empty(), text(m, texgen, diagnosis));
            REQUIRE_MESSAGE(diagnosis[0].defect == Defect::transposed, text(m, texgen, diagnosis));
        }
    }
}

TEST_CASE("one transposed factor of a product is named, whatever the hand") {
    Random random(662);
    for (int i = 0; i < 3000; ++i) {
        const Meant m = human(Mistake::none, random);
        glm::dmat4 s = Code<double>::bias(m), p = Code<double>::lens(m), v = Code<double>::view(m), x = m.pose;
        glm::dmat4& factor = i % 4 == 0 ? s : i % 4 == 1 ? p : i % 4 == 2 ? v : x;
        factor = glm::transpose(factor);
        const glm::dmat4 texgen = s * (p * v * x);
        const Diagnosis diagnosis = diagnosis_of(m, In::object, right_projector(m), Told::projector, false, texgen);
        REQUIRE_MESSAGE(!diagnosis.empty(), text(m, texgen, diagnosis));
        REQUIRE_MESSAGE(diagnosis[0].defect == Defect::transposed, text(m, texgen, diagnosis));
    }
}

TEST_CASE("a scale and a bias in the other order are in the wrong one, and no bias is one without w") {
    Random random(665);
    int seen_alone = 0;
    for (int i = 0; i < 3000; ++i) {
        const Meant m = human(Mistake::none, random);
        const bool is_left_out = i % 2 == 0;
        glm::dmat4 s = Code<double>::bias(m);
        for (glm::length_t row = 0; row < 3; ++row) s[3][row] *= is_left_out ? 0.0 : s[row][row];
        const glm::dmat4 product = s * (Code<double>::lens(m) * Code<double>::view(m) * m.pose);
        const glm::dmat4 texgen = random.coin() ? product : glm::dmat4(support::rounded(product));
        const Diagnosis diagnosis = diagnosis_of(m, In::object, right_projector(m), Told::projector, false, texgen);
        REQUIRE_MESSAGE(diagnosis.size() == 1, text(m, texgen, diagnosis));
        const Defect defect = is_left_out ? Defect::bias_without_w : Defect::wrong_order;
        REQUIRE_MESSAGE(diagnosis[0].defect == defect, text(m, texgen, diagnosis));
        // Where r is halved its limit lies within the range: that shows alone what s and t then say the cause of, unless
        // a bias of texels leaves floats none of the lens.
        const bool is_halved = !m.is_zero_to_one() && m.depth == DepthMapping::unit;
        if (!is_halved || m.kind != LensKind::perspective || (m.region.max)().x > 1.0) continue;
        const Diagnosis alone = diagnosis_of(m, In::object, std::nullopt, Told::nothing, true, texgen);
        REQUIRE_MESSAGE(alone.size() == 1, text(m, texgen, alone));
        REQUIRE_MESSAGE(alone[0].defect == defect, text(m, texgen, alone));
        ++seen_alone;
    }
    CHECK(seen_alone > 500);
}

TEST_CASE("where s and t are wrong as well more is said than that r is of another range") {
    Random random(666);
    int of_depth = 0;
    for (int i = 0; i < 2000; ++i) {
        const Meant m = human(Mistake::none, random);
        glm::dmat4 s = Code<double>::bias(m);
        s[3].x += 0.0625;
        const bool is_halved = s[3].z != 0.0;
        s[2].z = is_halved ? 1.0 : 0.5;
        s[3].z = is_halved ? 0.0 : 0.5;
        const glm::dmat4 texgen = s * (Code<double>::lens(m) * Code<double>::view(m) * m.pose);
        const Diagnosis diagnosis = diagnosis_of(m, In::object, right_projector(m), Told::projector, false, texgen);
        const bool is_of_depth = diagnosis.contains(Defect::depth_range_mismatch);
        of_depth += is_of_depth;
        REQUIRE_MESSAGE(diagnosis.size() > (is_of_depth ? 1u : 0u), text(m, texgen, diagnosis));
    }
    CHECK(of_depth > 100);
}

TEST_CASE("what shows without the pose is named where the pose is mistaken as well") {
    for (const Mistake mistake : mistakes) {
        if (mistake == Mistake::pose_for_view || mistake == Mistake::lens_of_other_hand) continue;
        Random random(663);
        for (int i = 0; i < 300;) {
            Meant m = human(mistake, random);
            m.pose = random.rotation();  // a scale that is not the same in all directions hides the lens
            m.pose[3] = glm::dvec4(random.direction(), 1.0);
            if (!leaves_a_trace(m, mistake, Told::lens)) continue;
            Meant used = m;
            used.pose = i % 2 == 0 ? glm::inverse(m.pose) : m.pose * m.pose;
            const glm::dmat4 texgen = made_somehow(used, mistake, random);
            const Diagnosis without_pose = diagnose(
                texgen::ObjectTexgen(texgen), {.projector = right_projector(m), .region = m.region, .depth = m.depth});
            const Diagnosis diagnosis = diagnosis_of(m, In::object, right_projector(m), Told::projector, false, texgen);
            REQUIRE_MESSAGE(without_pose.contains(defect_of(mistake)), text(m, texgen, without_pose));
            REQUIRE_MESSAGE(diagnosis.contains(defect_of(mistake)), text(m, texgen, diagnosis));
            ++i;
        }
    }
}

TEST_CASE("a scale-bias that is there twice is named without the pose as well, and no range that it makes of depth") {
    Random random(664);
    for (int i = 0; i < 2000; ++i) {
        Meant m = human(Mistake::none, random);
        m.pose = random.rotation();
        m.pose[3] = glm::dvec4(random.direction(), 1.0);
        // A lens whose planes are exchanged reverses depth.
        if (m.kind == LensKind::perspective && random.coin()) std::swap(m.z_near, m.z_far);
        const glm::dmat4 s = Code<double>::bias(m), lens = Code<double>::lens(m), view = Code<double>::view(m);
        const Projector projector{texgen::ProjectorProjection(lens), texgen::ProjectorView(view), m.conventions};
        const glm::dmat4 right = s * (lens * view * m.pose);
        const glm::dmat4 texgen = random.coin() ? s * right : glm::dmat4(support::rounded(s * right));
        const Diagnosis diagnosis =
            diagnose(texgen::ObjectTexgen(texgen), {.projector = projector, .region = m.region, .depth = m.depth});
        REQUIRE_MESSAGE(diagnosis.size() == 1, text(m, texgen, diagnosis));
        REQUIRE_MESSAGE(diagnosis[0].defect == Defect::scale_bias_doubled, text(m, texgen, diagnosis));
    }
}

TEST_CASE(
    "a lens without a far plane is of the other range by its near plane, before a camera whose pose is not given") {
    Random random(668);
    for (int i = 0; i < 2000; ++i) {
        Meant m = human(Mistake::lens_of_other_range, random);
        m.kind = LensKind::infinite;
        m.depth = DepthMapping::unit;
        m.pose = random.rotation();
        m.pose[3] = glm::dvec4(m.aim.position + random.direction(), 1.0);
        const Mistake mistake = random.coin() ? Mistake::lens_of_other_range : Mistake::bias_of_other_range;
        const glm::dmat4 texgen = made<double>(m, mistake, random);
        const Diagnosis diagnosis = diagnose(texgen::EyeTexgen(texgen),
                                             {.region = m.region,
                                              .conventions = m.conventions,
                                              .lens = {texgen::degrees(m.fovy), m.aspect, m.z_near, infinity_double}});
        REQUIRE_MESSAGE(diagnosis.size() == 1, text(m, texgen, diagnosis));
        REQUIRE_MESSAGE(diagnosis[0].defect == Defect::depth_range_mismatch, text(m, texgen, diagnosis));
    }
}

TEST_CASE("parallel light of the other hand is named where all is told, and its r is not taken for another range") {
    Random random(669);
    for (int i = 0; i < 2000; ++i) {
        Meant m = any_meant(Mistake::none, random);
        m.kind = LensKind::orthographic;
        const glm::dmat4 right = Code<double>::lens(m);
        glm::dmat4 other = right;
        other[2] = -other[2];
        const glm::dmat4 product = Code<double>::bias(m) * (other * Code<double>::view(m) * m.pose);
        const glm::dmat4 texgen = random.coin() ? product : glm::dmat4(support::rounded(product));
        const Projector projector{texgen::ProjectorProjection(right), texgen::ProjectorView(Code<double>::view(m)),
                                  m.conventions};
        const Diagnosis diagnosis = diagnosis_of(m, In::object, projector, Told::projector, false, texgen);
        REQUIRE_MESSAGE(!diagnosis.empty(), text(m, texgen, diagnosis));
        REQUIRE_MESSAGE(diagnosis[0].defect == Defect::mixed_handedness, text(m, texgen, diagnosis));
    }
}

}  // namespace product_cases
