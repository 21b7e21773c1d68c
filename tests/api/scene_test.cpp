// A scene of many objects and projectors over many frames, judged by all its pairs asked one by one.

#include "support/broken_preconditions.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <glm/mat4x4.hpp>

#include "api/scene_test/engine.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/linear.hpp"
#include "texgen/scene.hpp"

namespace scene_cases {

TEST_CASE("over many frames of moves, arrivals and departures the pairs are those of all pairs asked one by one") {
    Random random(1201);
    Hostile hostile;
    Tally tally;
    int grown = 0, shrunk = 0, still = 0;
    for (int round = 0; round < 60; ++round) {
        const double size = round % 3 == 0 ? 100.0 : 12.0;
        Engine engine = some_engine(random, static_cast<std::size_t>(random.integer(0, 90)),
                                    static_cast<std::size_t>(random.integer(0, 12)), size, &hostile);
        Scene scene;
        for (int frame = 0; frame < 25; ++frame) {
            texgen::SceneChanges changes;
            Indices objects, projectors;
            const auto some_of = [&](std::size_t count, Indices& out) {
                for (int n = random.integer(0, 3) == 0 ? 0 : random.integer(0, 9); n > 0 && count > 0; --n)
                    out.push_back(static_cast<std::uint32_t>(random.integer(0, static_cast<int>(count) - 1)));
            };
            if (frame > 0) {
                some_of(engine.models.size(), objects);
                if (random.coin()) some_of(engine.projectors.size(), projectors);
            }
            for (const std::uint32_t i : objects) {
                if (random.integer(0, 3) != 0) engine.models[i] = some_model(random, size, &hostile);
                if (random.integer(0, 3) == 0) engine.bounds[i] = some_box(random, &hostile);
            }
            for (const std::uint32_t i : projectors) {
                engine.projectors[i] = some_projector(random, size, &hostile);
                if (random.coin()) engine.regions[i] = some_region(random, &hostile);
            }
            if (random.integer(0, 4) == 0) {
                for (int n = random.integer(1, 30); n > 0; --n) {
                    engine.models.push_back(some_model(random, size, &hostile));
                    engine.bounds.push_back(some_box(random, &hostile));
                }
                engine.projectors.push_back(some_projector(random, size, &hostile));
                engine.regions.push_back(some_region(random, &hostile));
                ++grown;
            } else if (random.integer(0, 4) == 0 && frame > 0) {
                const auto left = engine.models.size() * 2 / 3;
                engine.models.erase(engine.models.begin() + static_cast<std::ptrdiff_t>(left), engine.models.end());
                engine.bounds.resize(left);
                if (!engine.projectors.empty()) {
                    engine.projectors.pop_back();
                    engine.regions.pop_back();
                }
                ++shrunk;
            }
            changes = {objects, projectors};
            const SceneWork work = scene.update(engine.view(), changes);
            require_all_pairs(scene, engine, tally);
            REQUIRE(work.texgens_computed <= work.pairs_tested);

            Scene fresh;
            fresh.update(engine.view(), {});
            require_same(scene, fresh);

            const SceneWork nothing = scene.update(engine.view(), {});
            REQUIRE(nothing.bounds_tested + nothing.pairs_tested + nothing.texgens_computed == 0);
            require_same(scene, fresh);
            still += work.bounds_tested == 0;
        }
    }
    CHECK(broken_preconditions == 0);
    CHECK(std::min({grown, shrunk, still}) > 10);
    CHECK(tally.outside > 20000);
    CHECK(tally.partial > 5000);
    CHECK(tally.inside > 500);
    CHECK(std::min({hostile.nan_model, hostile.singular, hostile.not_affine}) > 15);
    CHECK(std::min({hostile.nan_box, hostile.empty_box, hostile.infinite_box, hostile.flat_box}) > 15);
    CHECK(std::min({hostile.nan_projector, hostile.empty_region, hostile.far_region}) > 5);
}

TEST_CASE("one T_e a projector, made anew when the camera or the projector moved") {
    Random random(1206);
    Engine engine = some_engine(random, 10, 8, 10.0);
    Scene scene;
    scene.update(engine.view(), {});
    texgen::CameraPose pose(random.rigid(10.0));
    const auto require_right = [&] {
        REQUIRE(scene.eye_texgens().size() == engine.projectors.size());
        for (std::size_t i = 0; i < engine.projectors.size(); ++i)
            REQUIRE(are_alike(scene.eye_texgens()[i].matrix(),
                              eye_linear(engine.projectors[i], pose, engine.regions[i]).matrix()));
    };
    CHECK(scene.update_eye(pose) == 8);
    require_right();
    CHECK(scene.update_eye(pose) == 0);
    require_right();
    const Indices turned{5, 2};
    for (const std::uint32_t i : turned) engine.projectors[i] = some_projector(random, 10.0);
    scene.update(engine.view(), {{}, turned});
    CHECK(scene.update_eye(pose) == 2);
    require_right();
    engine.projectors.pop_back();
    engine.regions.pop_back();
    scene.update(engine.view(), {});
    CHECK(scene.update_eye(pose) == 0);
    require_right();
    for (int k = 0; k < 2; ++k) {
        engine.projectors.push_back(some_projector(random, 10.0));
        engine.regions.push_back(texgen::whole_texture());
    }
    const Indices backwards{8, 7};
    scene.update(engine.view(), {{}, backwards});
    CHECK(scene.update_eye(pose) == 2);
    require_right();
    pose = texgen::CameraPose(random.rigid(10.0));
    CHECK(scene.update_eye(pose) == 9);
    require_right();
    CHECK(broken_preconditions == 0);
}

TEST_CASE("nothing in, nothing out; a projector that is NaN lights all objects in part, an empty box is never lit") {
    Scene scene;
    CHECK(scene.update({}, {}).bounds_tested == 0);
    CHECK(scene.pairs().empty());
    CHECK(scene.pairs_of(3).empty());
    Random random(1207);
    Engine engine = some_engine(random, 20, 1, 10.0);
    engine.bounds[7] = {{1, 1, 1}, {-1, 2, 2}};
    glm::dmat4 view(1.0);
    view[0].x = static_cast<double>(nan_float);
    engine.projectors[0].view = texgen::ProjectorView(view);
    scene.update(engine.view(), {});
    REQUIRE(scene.pairs().size() == 19);
    for (const LitPair& pair : scene.pairs()) {
        CHECK(pair.object != 7);
        CHECK(pair.coverage == Coverage::partial);
    }
    // One slide for all: regions may be left out.
    engine.regions.clear();
    Scene other;
    other.update(engine.view(), {});
    require_same(scene, other);
    engine = {};
    scene.update(engine.view(), {});
    CHECK(scene.pairs().empty());
    CHECK(broken_preconditions == 0);
}

TEST_CASE("what moved without being named is asserted, and stays as it was") {
    Random random(1208);
    Engine engine = some_engine(random, 30, 5, 10.0);
    Scene scene, other;
    scene.update(engine.view(), {});
    other.update(engine.view(), {});
    REQUIRE(broken_preconditions == 0);
    const Engine given = engine;
    engine.models[4] = some_model(random, 10.0);
    scene.update(engine.view(), {});
    CHECK(std::exchange(broken_preconditions, 0) == 1);
    require_same(scene, other);
    engine = given;
    engine.projectors[2] = some_projector(random, 10.0);
    scene.update(engine.view(), {});
    CHECK(std::exchange(broken_preconditions, 0) == 1);
    engine = given;
    engine.projectors[2].view = texgen::ProjectorView(glm::dmat4(2.0));  // which T_e does not see
    scene.update(engine.view(), {});
    CHECK(std::exchange(broken_preconditions, 0) == 1);
    engine = given;
    engine.projectors[2].projection = texgen::ProjectorProjection(glm::dmat4(support::nan_double));
    scene.update(engine.view(), {});
    CHECK(std::exchange(broken_preconditions, 0) == 1);
    engine = given;
    engine.regions[1] = texgen::rectangle_texture(2.0, 2.0);
    scene.update(engine.view(), {});
    CHECK(std::exchange(broken_preconditions, 0) == 1);
    engine = given;
    const Indices nobody{30, 1000000};
    scene.update(engine.view(), {nobody, {}});
    CHECK(std::exchange(broken_preconditions, 0) == 2);
    engine.bounds.pop_back();
    scene.update(engine.view(), {});
    CHECK(std::exchange(broken_preconditions, 0) == 1);
    CHECK(
        std::all_of(scene.pairs().begin(), scene.pairs().end(), [](const LitPair& pair) { return pair.object < 29; }));
    engine = given;
    engine.regions.erase(engine.regions.begin() + 1, engine.regions.end());
    Scene one_region, one_projector;
    one_region.update(engine.view(), {});
    CHECK(std::exchange(broken_preconditions, 0) == 1);
    engine.projectors.erase(engine.projectors.begin() + 1, engine.projectors.end());
    one_projector.update(engine.view(), {});
    CHECK(broken_preconditions == 0);
    require_same(one_region, one_projector);
}

TEST_CASE("a scene that was moved from is empty, and sees the next arrays as a new one does") {
    Random random(1412);
    const Engine engine = some_engine(random, 100, 7, 10.0);
    Scene scene, fresh;
    scene.update(engine.view(), {});
    fresh.update(engine.view(), {});
    Scene moved = std::move(scene);
    for (const bool by_assignment : {false, true}) {
        CAPTURE(by_assignment);
        require_same(moved, fresh);
        CHECK(scene.pairs().empty());
        CHECK(scene.update({}, {}).bounds_tested == 0);
        scene.update(engine.view(), {});
        require_same(scene, fresh);
        moved = std::move(scene);
    }
    CHECK(broken_preconditions == 0);
}

}  // namespace scene_cases
