// What a scene allocates, how much, and in which updates.

#include "support/broken_preconditions.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "api/scene_test/engine.hpp"
#include "support/allocations.hpp"
#include "support/random.hpp"
#include "texgen/scene.hpp"

namespace scene_cases {

using support::allocations;

namespace {

Indices up_to(std::size_t count) {
    Indices all;
    for (std::uint32_t i = 0; i < count; ++i) all.push_back(i);
    return all;
}

}  // namespace

TEST_CASE("pairs that come at once allocate a few times, and an object that is named often is changed once") {
    Engine engine;
    glm::dmat4 in_front(1.0);
    in_front[3].z = -10.0;
    engine.models.assign(5000, ModelMatrix(in_front));
    engine.bounds.assign(5000, box_of(glm::vec3(0.5f)));
    give_light_along_z(engine, 4);
    Scene scene;
    const std::size_t before = allocations;
    scene.update(engine.view(), {});
    CHECK(allocations - before < 200);
    CHECK(scene.pairs().size() == 20000);
    const Indices often(20000, 7);
    const std::size_t named = allocations;
    const texgen::SceneWork work = scene.update(engine.view(), {often, {}});
    CHECK(allocations == named);
    CHECK(work.pairs_tested == 4);
}

TEST_CASE("what a scene allocates is at most 210 bytes an object, twice 840 a projector, and twice 165 a lit pair") {
    const auto bytes_of = [](std::size_t objects, std::size_t projectors, double z) {
        Engine engine;
        glm::dmat4 in_place(1.0);
        in_place[3].z = z;
        engine.models.assign(objects, ModelMatrix(in_place));
        engine.bounds.assign(objects, box_of(glm::vec3(0.5f)));
        give_light_along_z(engine, projectors);
        const std::size_t before = support::allocated_bytes;
        Scene scene;
        scene.update(engine.view(), {});
        scene.update_eye(texgen::CameraPose(glm::dmat4(1.0)));
        CHECK(scene.pairs().size() == (z < 0.0 ? objects * projectors : 0));
        return support::allocated_bytes - before;
    };
    constexpr double lit = -10.0, behind = 10.0;
    CHECK(bytes_of(20000, 1, behind) - bytes_of(10000, 1, behind) <= 210 * std::size_t{10000});
    CHECK(bytes_of(1, 4096, behind) - bytes_of(1, 1024, behind) <= 2 * 840 * std::size_t{3072});
    CHECK(bytes_of(1024, 32, lit) - bytes_of(1024, 32, behind) <= 2 * 165 * std::size_t{1024 * 32});
}

TEST_CASE("once every count was reached, nothing is allocated") {
    Random random(1205);
    // Frames that come again: objects and projectors move, and some of them go and come back.
    std::vector<Engine> frames;
    for (int k = 0; k < 6; ++k)
        frames.push_back(some_engine(random, 200 - 20 * static_cast<std::size_t>(k % 3),
                                     16 - static_cast<std::size_t>(k % 2), 15.0));
    Scene scene;
    const texgen::CameraPose pose(random.rigid(10.0));
    std::size_t warm = 0, later = 0;
    for (int i = 0; i < 60; ++i) {
        const Engine& engine = frames[static_cast<std::size_t>(i % 6)];
        const Indices objects = up_to(engine.models.size()), projectors = up_to(engine.projectors.size());
        const std::size_t before = allocations;
        scene.update(engine.view(), {objects, projectors});
        scene.update_eye(pose);
        (i < 12 ? warm : later) += allocations - before;
        REQUIRE(!scene.pairs().empty());
    }
    CHECK(warm > 10);
    CHECK(later == 0);
    CHECK(broken_preconditions == 0);
}

TEST_CASE("memory is allocated only in an update in which a count exceeds all former ones") {
    Random random(1210);
    int grown = 0, within = 0;
    for (int round = 0; round < 30; ++round) {
        const Engine all = some_engine(random, 120, 10, 15.0);
        Engine engine;
        Scene scene;
        std::array<std::size_t, 3> most{};
        for (int frame = 0; frame < 60; ++frame) {
            // Counts grow and shrink; some objects change, some twice, sometimes all.
            const auto some = [&](std::size_t size, std::size_t before) {
                const auto most_change = static_cast<int>(size / 8) + 1;
                const int change = random.integer(0, 3) == 0 ? random.integer(-most_change, most_change) : 0;
                return static_cast<std::size_t>(
                    std::clamp(static_cast<int>(before) + change, 0, static_cast<int>(size)));
            };
            const std::size_t objects = frame == 0 ? 40 : some(120, engine.models.size());
            const std::size_t projectors = frame == 0 ? 4 : some(10, engine.projectors.size());
            const std::size_t old_objects = engine.models.size(), old_projectors = engine.projectors.size();
            engine.models.resize(std::min(objects, old_objects), all.models[0]);
            engine.projectors.resize(std::min(projectors, old_projectors), all.projectors[0]);
            for (std::size_t i = engine.models.size(); i < objects; ++i) engine.models.push_back(all.models[i]);
            for (std::size_t i = engine.projectors.size(); i < projectors; ++i)
                engine.projectors.push_back(all.projectors[i]);
            engine.bounds.assign(all.bounds.begin(), all.bounds.begin() + static_cast<std::ptrdiff_t>(objects));
            engine.regions.assign(projectors, texgen::whole_texture());
            Indices moved, turned;
            const int kind = random.integer(0, 3);
            if (kind == 0) moved = up_to(objects);
            for (int n = kind == 1 ? 1 : kind == 2 ? random.integer(0, 9) : 0; n > 0 && objects > 0; --n)
                moved.push_back(static_cast<std::uint32_t>(random.integer(0, static_cast<int>(objects) - 1)));
            if (random.integer(0, 3) == 0 && projectors > 0) turned = {0, 0};
            for (const std::uint32_t i : moved) {
                engine.models[i] = some_model(random, 15.0);
                engine.bounds[i] = all.bounds[i];
            }
            for (const std::uint32_t i : turned) engine.projectors[i] = some_projector(random, 15.0);
            const texgen::CameraPose pose(random.rigid(10.0));

            const std::size_t before = allocations;
            scene.update(engine.view(), {moved, turned});
            const std::size_t of_update = allocations - before;
            scene.update_eye(pose);
            REQUIRE(allocations - before == of_update);
            const std::array<std::size_t, 3> counts{objects, projectors, scene.pairs().size()};
            bool is_more = false;
            for (std::size_t k = 0; k < 3; ++k) {
                is_more = is_more || counts[k] > most[k];
                most[k] = std::max(most[k], counts[k]);
            }
            if (!is_more) REQUIRE(of_update == 0);
            ++(is_more ? grown : within);
        }
    }
    CHECK(broken_preconditions == 0);
    CHECK(grown > 100);
    CHECK(within > 500);
}

}  // namespace scene_cases
