// What a scene tests and computes: what changed and what is lit, however far away objects stand or stood.

#include "support/broken_preconditions.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "api/scene_test/engine.hpp"
#include "support/random.hpp"
#include "texgen/projector.hpp"
#include "texgen/scene.hpp"

namespace scene_cases {

using texgen::Aim;

TEST_CASE("only what changed is tested and computed: the other pairs keep their matrix where it is") {
    Random random(1203);
    Engine engine = some_engine(random, 400, 24, 20.0);
    Scene scene;
    const SceneWork first = scene.update(engine.view(), {});
    CHECK(first.texgens_computed >= scene.pairs().size());
    CHECK(first.pairs_tested < 400 * 24 / 2);
    for (int frame = 0; frame < 40; ++frame) {
        const auto moved = static_cast<std::uint32_t>(random.integer(0, 399));
        const auto turned = static_cast<std::uint32_t>(random.integer(0, 23));
        Indices objects, projectors;
        if (frame % 3 != 1) objects = {moved, moved};
        if (frame % 3 != 0) projectors = {turned};
        if (!objects.empty()) engine.models[moved] = some_model(random, 20.0);
        if (!projectors.empty()) engine.projectors[turned] = some_projector(random, 20.0);
        const std::vector<LitPair> before(scene.pairs().begin(), scene.pairs().end());
        const std::vector<ObjectTexgen> matrices(scene.texgens().begin(), scene.texgens().end());
        const SceneWork work = scene.update(engine.view(), {objects, projectors});
        const auto is_changed = [&](const LitPair& pair) {
            return (!objects.empty() && pair.object == moved) || (!projectors.empty() && pair.projector == turned);
        };
        std::size_t changed = 0;
        for (const LitPair& pair : scene.pairs()) {
            changed += is_changed(pair);
            if (is_changed(pair)) continue;
            const auto same = std::find_if(before.begin(), before.end(), [&](const LitPair& old) {
                return old.object == pair.object && old.projector == pair.projector;
            });
            REQUIRE(same != before.end());
            REQUIRE(same->texgen == pair.texgen);
            REQUIRE(have_same_bits(matrices[pair.texgen].matrix(), scene.texgen(pair).matrix()));
        }
        REQUIRE(work.texgens_computed >= changed);
        REQUIRE(work.pairs_tested <= 24 + 400);
        if (projectors.empty()) {
            REQUIRE(work.pairs_tested <= 24);
            REQUIRE(work.bounds_tested <= 24);
        }
    }
    CHECK(broken_preconditions == 0);
}

TEST_CASE("work grows with what is lit, not with what stands in the dark") {
    Random random(1204);
    std::array<SceneWork, 2> works;
    for (std::size_t k = 0; k < 2; ++k) {
        Engine engine;
        for (int i = 0; i < 100; ++i) {
            glm::dmat4 m(1.0);
            m[3] = glm::dvec4(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), -10.0, 1.0);
            engine.models.push_back(ModelMatrix(m));
        }
        for (int i = 0; i < (k == 0 ? 1000 : 8000); ++i) {
            glm::dmat4 m(1.0);
            m[3] = glm::dvec4(random.uniform(-100.0, 100.0), random.uniform(-100.0, 100.0), random.uniform(10.0, 100.0),
                              1.0);
            engine.models.push_back(ModelMatrix(m));
        }
        engine.bounds.assign(engine.models.size(), box_of(glm::vec3(0.5f)));
        give_light_along_z(engine, 1);
        Scene scene;
        scene.update(engine.view(), {});
        const Indices turned{0};
        works[k] = scene.update(engine.view(), {{}, turned});
        CHECK(scene.pairs().size() == 100);
    }
    CHECK(works[0].pairs_tested == 100);
    CHECK(works[1].pairs_tested == 100);
    CHECK(works[1].bounds_tested < works[0].bounds_tested + 200);
    CHECK(works[1].bounds_tested < 600);
}

TEST_CASE("a few objects that move among many small lights cost each of them some tests of eight bounds at once") {
    Random random(1213);
    Engine engine;
    const auto place = [&] { return glm::dvec3(random.uniform(-100.0, 100.0), 0.0, random.uniform(-100.0, 100.0)); };
    for (int i = 0; i < 5000; ++i) {
        glm::dmat4 m(1.0);
        m[3] = glm::dvec4(place(), 1.0);
        engine.models.push_back(ModelMatrix(m));
    }
    engine.bounds.assign(5000, box_of(glm::vec3(1.0f)));
    for (int i = 0; i < 150; ++i) {
        const glm::dvec3 at = place();
        const Aim down{at + glm::dvec3(0, 2, 0), at, {0, 0, 1}};
        engine.projectors.push_back(
            make_projector(texgen::OrthographicLens{-2, 2, -2, 2, 0, 4}, down, texgen::opengl).value());
    }
    engine.regions.assign(150, texgen::whole_texture().with_depth());
    Scene scene;
    scene.update(engine.view(), {});
    for (const std::size_t count : {1u, 8u, 10u, 100u, 1000u}) {
        Indices moved(count);
        for (std::size_t i = 0; i < count; ++i) {
            moved[i] = static_cast<std::uint32_t>(5 * i);
            glm::dmat4 m = engine.models[moved[i]].matrix();
            m[3].x += random.uniform(-0.3, 0.3);
            engine.models[moved[i]] = ModelMatrix(m);
        }
        const SceneWork work = scene.update(engine.view(), {moved, {}});
        CAPTURE(count);
        CHECK(work.bounds_tested <= 150 * (count <= 8 ? 1 : count <= 10 ? 3 : count <= 100 ? 8 : 16));
        CHECK(work.pairs_tested < count * 150 / 200 + 3);
        Scene fresh;
        fresh.update(engine.view(), {});
        require_same(scene, fresh);
    }
}

TEST_CASE("objects that are gone leave no bounds where nothing stands") {
    Random random(1205);
    Engine engine;
    for (int i = 0; i < 1000; ++i) {
        glm::dmat4 far_away(1.0);
        far_away[3] = glm::dvec4(glm::dvec3(1000.0) + 10.0 * random.direction(), 1.0);
        engine.models.push_back(ModelMatrix(far_away));
    }
    engine.bounds.assign(1000, box_of(glm::vec3(0.5f)));
    give_light_along_z(engine, 1);
    Scene scene;
    scene.update(engine.view(), {});
    engine.models.resize(333, engine.models[0]);
    engine.bounds.resize(333);
    scene.update(engine.view(), {});
    const Indices turned{0};
    const SceneWork work = scene.update(engine.view(), {{}, turned});
    CHECK(work.bounds_tested < 100);
    CHECK(work.pairs_tested == 0);
}

TEST_CASE(
    "objects that moved a few at a time are found as quickly as in a new scene once projectors have asked for them") {
    Random random(1212);
    const texgen::PerspectiveLens lens{texgen::degrees(50), 1.0, 0.5, 12.0};
    for (const double first_place : {0.0, 1e4}) {
        Engine engine;
        for (int i = 0; i < 4000; ++i) {
            glm::dmat4 m(1.0);
            m[3] = {random.uniform(-60.0, 60.0), random.uniform(0.0, 4.0), random.uniform(-60.0, 60.0), 1.0};
            engine.models.push_back(ModelMatrix(m));
        }
        engine.bounds.assign(engine.models.size(), box_of(glm::vec3(0.5f)));
        for (int i = 0; i < 16; ++i) {
            const glm::dvec3 at(random.uniform(-60.0, 60.0), 6.0, random.uniform(-60.0, 60.0));
            const Aim aim{at, at + glm::dvec3(1, -6, 2), {0, 1, 0}};
            engine.projectors.push_back(make_projector(lens, aim, texgen::opengl).value());
        }
        engine.regions.assign(engine.projectors.size(), texgen::whole_texture());
        Indices all(engine.projectors.size());
        std::iota(all.begin(), all.end(), 0u);
        Scene fresh;
        fresh.update(engine.view(), {});
        const std::size_t tested = fresh.update(engine.view(), {{}, all}).bounds_tested;
        for (const std::size_t at_once : {std::size_t{1}, std::size_t{50}}) {
            Engine moving = engine;
            glm::dmat4 elsewhere(1.0);
            elsewhere[3].x = first_place;
            moving.models.assign(engine.models.size(), ModelMatrix(elsewhere));
            // All of them, and all see all objects: that is no measure of what they test later.
            const Aim down{{first_place, 6.0, 0.0}, {first_place, 0.0, 0.0}, {0, 0, 1}};
            moving.projectors.assign(all.size(), make_projector(lens, down, texgen::opengl).value());
            Scene scene;
            scene.update(moving.view(), {});
            scene.update(moving.view(), {{}, all});
            for (std::size_t i = 0; i < moving.models.size(); i += at_once) {
                Indices moved(at_once);
                std::iota(moved.begin(), moved.end(), static_cast<std::uint32_t>(i));
                for (const std::uint32_t object : moved) moving.models[object] = engine.models[object];
                scene.update(moving.view(), {moved, {}});
            }
            moving.projectors = engine.projectors;
            std::size_t in_all = 0, last = 0;
            for (int frame = 0; frame < 12; ++frame) {
                last = scene.update(moving.view(), {{}, all}).bounds_tested;
                in_all += last;
            }
            INFO(at_once, " at once: ", last, " bounds in the twelfth frame, ", in_all, " in all, ", tested);
            CHECK(last <= tested + tested / 4);
            CHECK(in_all <= 60 * tested);
            require_same(scene, fresh);
        }
    }
}

TEST_CASE("objects far away, or twice so far, leave the others to be found as quickly") {
    Random random(1210);
    const auto projector = make_projector(texgen::PerspectiveLens{texgen::degrees(20), 1.0, 0.1, 100.0},
                                          texgen::Aim{{0, 30, 0}, {0, 0, 0}, {0, 0, 1}}, texgen::opengl);
    REQUIRE(projector);
    Engine engine;
    for (int i = 0; i < 10000; ++i) {
        glm::dmat4 m(1.0);
        m[3] = glm::dvec4(random.vector3(500.0), 1.0);
        engine.models.push_back(ModelMatrix(m));
    }
    engine.bounds.assign(engine.models.size(), box_of(glm::vec3(0.5f)));
    give_light_along_z(engine, 1);
    const Indices turned{0};
    Indices all(engine.models.size());
    std::iota(all.begin(), all.end(), 0u);
    const auto tested_beside = [&](const std::vector<double>& distances) {
        Engine with = engine;
        for (std::size_t i = 0; i < distances.size(); ++i)
            with.models[7 + i] = ModelMatrix(
                glm::dmat4(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, distances[i], distances[i], distances[i], 1));
        Scene scene;
        scene.update(with.view(), {});
        const std::size_t at_once = scene.update(with.view(), {{}, turned}).bounds_tested;
        // In a scene that was sorted before, they are sorted out in some frames in which all move.
        Scene later;
        later.update(engine.view(), {});
        for (int frame = 0; frame < 4; ++frame) later.update(with.view(), {all, {}});
        CHECK(later.update(with.view(), {{}, turned}).bounds_tested < 2 * at_once + 200);
        return at_once;
    };
    const std::size_t ordinary = tested_beside({});
    CHECK(ordinary < 2000);
    std::vector<double> another_town;
    for (int k = 0; k < 4000; ++k) another_town.push_back(1e9 + 10.0 * k);
    CHECK(tested_beside(another_town) < 4 * ordinary);
    for (const std::vector<double>& distances : {std::vector{1e6},
                                                 {-1e6, 1e9},
                                                 {1e9},
                                                 {-1e9},
                                                 {1e9, 1e20},
                                                 {-1e9, -1e20},
                                                 {1e300},
                                                 {HUGE_VAL, 1e9},
                                                 {NAN, 1e9}})
        CHECK(tested_beside(distances) < 4 * ordinary);
}

TEST_CASE("towns far from one another that move, grow and vanish have the pairs of a new scene, whatever was sorted") {
    Random random(1211);
    Tally tally;
    for (int run = 0; run < 12; ++run) {
        // Some crowds within crowds, and objects that are nowhere or everywhere.
        std::vector<glm::dvec3> towns{glm::dvec3(0.0)};
        for (int i = 0; i < 4; ++i)
            towns.push_back(towns[towns.size() / 2] + random.power_of_ten(2.0, 12.0) * random.direction());
        const auto place = [&](ModelMatrix& model) {
            glm::dmat4 m = random.rigid(10.0);
            m[3] += glm::dvec4(towns[static_cast<std::size_t>(random.integer(0, 4))], 0.0);
            if (random.integer(0, 200) == 0) m[3][random.integer(0, 2)] = random.coin() ? HUGE_VAL : 1e300;
            model = ModelMatrix(m);
        };
        Engine engine = some_engine(random, 700, 6, 10.0);
        for (ModelMatrix& model : engine.models) place(model);
        const Engine all = engine;
        Scene scene;
        scene.update(engine.view(), {});
        for (int frame = 0; frame < 60; ++frame) {
            Indices moved;
            const int share = random.integer(0, 3) == 0 ? 1 : random.integer(2, 100);
            for (std::uint32_t i = 0; i < engine.models.size(); ++i) {
                if (random.integer(1, share) != 1) continue;
                place(engine.models[i]);
                moved.push_back(i);
            }
            if (random.integer(0, 5) == 0) {
                const auto count = static_cast<std::size_t>(random.integer(100, 1400));
                while (engine.models.size() > count) {
                    engine.models.pop_back();
                    engine.bounds.pop_back();
                }
                while (engine.models.size() < count) {
                    moved.push_back(static_cast<std::uint32_t>(engine.models.size()));
                    engine.models.push_back(all.models[0]);
                    place(engine.models.back());
                    engine.bounds.push_back(all.bounds[engine.bounds.size() % 700]);
                }
                std::erase_if(moved, [&](std::uint32_t i) { return i >= count; });
            }
            scene.update(engine.view(), {moved, {}});
            Scene fresh;
            fresh.update(engine.view(), {});
            require_same(scene, fresh);
            if (frame % 20 == 19) require_all_pairs(scene, engine, tally);
        }
    }
    CHECK(broken_preconditions == 0);
    CHECK(tally.partial + tally.inside > 1000);
    CHECK(tally.outside > 10000);
}

}  // namespace scene_cases
