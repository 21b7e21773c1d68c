// The diagnosis: every defect of a seeded corpus is found, alone and in pairs, and none in a million valid set-ups.

#include "texgen/diagnose.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "api/diagnose_test/defects.hpp"
#include "api/diagnose_test/rigs.hpp"
#include "support/allocations.hpp"
#include "support/random.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace diagnose_cases {

using support::allocations;

namespace {

// A set-up without its projector, or with nothing else.
Diagnosis diagnosis_alone(Parts parts) {
    parts.projector = std::nullopt;
    parts.pose = std::nullopt;
    return diagnosis_of(parts);
}

}  // namespace

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
        if (rig.lens.kind == LensKind::orthographic) continue;
        if (rig.lens.is_reversed && rig.conventions.depth == DepthRange::zero_to_one) {
            // OpenGL's scale-bias on depth in [0, 1].
            Rig opengl_depth = rig;
            opengl_depth.conventions = of_other_range(rig.conventions);
            opengl_depth.depth = DepthMapping::unit;
            const glm::dmat4 texgen = composed(opengl_depth, projector_of(opengl_depth, p, rig.view));
            require_said({.texgen = texgen, .in = rig.in}, {Defect::depth_range_mismatch});
            ++reversed;
        }
        glm::dmat4 turned = p;
        for (int i = 0; i < 4; ++i) turned[i][0] = -turned[i][0];
        Parts parts{.texgen = composed(rig, projector_of(rig, turned, rig.view)),
                    .in = rig.in,
                    .region = rig.region,
                    .conventions = rig.conventions};
        if (rig.in != In::world) parts.pose = rig.pose;
        require_said(parts, {Defect::mirrored});
        parts.lens.mirrored = true;
        require_said(parts, {});
        ++mirrored;
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

}  // namespace diagnose_cases
