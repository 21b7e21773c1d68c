// A scene of many objects and projectors over many frames, judged by all its pairs asked one by one.

#include "support/broken_preconditions.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "judges/exact.hpp"
#include "support/allocations.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/scene.hpp"

namespace {

using support::allocations;
using support::broken_preconditions;
using support::hex;
using support::infinity_float;
using support::nan_float;
using support::Random;
using texgen::Box;
using texgen::Coverage;
using texgen::LitPair;
using texgen::ModelMatrix;
using texgen::ObjectTexgen;
using texgen::Projector;
using texgen::Scene;
using texgen::SceneChanges;
using texgen::SceneWork;
using texgen::TextureRegion;

using Indices = std::vector<std::uint32_t>;

// The engine: its arrays, and what it moved.
struct Engine {
    std::vector<ModelMatrix> models;
    std::vector<Box> bounds;
    std::vector<Projector> projectors;
    std::vector<TextureRegion> regions;

    texgen::SceneView view() const { return {models, bounds, projectors, regions}; }
};

Box box_of(const glm::vec3& half) { return {-half, half}; }

// From the origin along -z, so many times.
void give_light_along_z(Engine& engine, std::size_t count) {
    const auto projector = make_projector(texgen::PerspectiveLens{texgen::degrees(40), 1.0, 0.1, 100.0},
                                          texgen::Aim{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}}, texgen::opengl);
    engine.projectors.assign(count, projector.value());
    engine.regions.assign(count, texgen::whole_texture());
}

struct Hostile {
    int nan_model = 0, singular = 0, not_affine = 0, nan_box = 0, empty_box = 0, infinite_box = 0, flat_box = 0;
    int nan_projector = 0, empty_region = 0, far_region = 0;
};

ModelMatrix some_model(Random& random, double size, Hostile* hostile = nullptr) {
    glm::dmat4 m = random.rigid(size);
    if (random.integer(0, 3) == 0)
        for (int j = 0; j < 3; ++j) m[j] *= random.power_of_ten(-1.0, 0.5);
    switch (hostile != nullptr ? random.integer(0, 30) : 30) {
        case 0:
            m[random.integer(0, 3)][random.integer(0, 3)] =
                static_cast<double>(random.coin() ? nan_float : infinity_float);
            ++hostile->nan_model;
            break;
        case 1:
            m[random.integer(0, 2)] = glm::dvec4(0.0);
            ++hostile->singular;
            break;
        case 2:
            m[random.integer(0, 3)].w = random.uniform(-2.0, 2.0);
            ++hostile->not_affine;
            break;
        default:
            break;
    }
    return ModelMatrix(m);
}

Box some_box(Random& random, Hostile* hostile = nullptr) {
    Box box = box_of(
        glm::vec3(random.uniform_float(0.1, 2.0), random.uniform_float(0.1, 2.0), random.uniform_float(0.1, 2.0)));
    const int axis = random.integer(0, 2);
    switch (hostile != nullptr ? random.integer(0, 30) : 30) {
        case 0:
            (random.coin() ? box.min : box.max)[axis] = nan_float;
            ++hostile->nan_box;
            break;
        case 1:
            std::swap(box.min[axis], box.max[axis]);
            ++hostile->empty_box;
            break;
        case 2:
            box.max[axis] = infinity_float;
            ++hostile->infinite_box;
            break;
        case 3:
            box.min[axis] = box.max[axis];
            ++hostile->flat_box;
            break;
        default:
            break;
    }
    return box;
}

Projector some_projector(Random& random, double size, Hostile* hostile = nullptr) {
    const glm::dvec3 position(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
    const texgen::Aim aim{position, position + random.direction(), random.direction()};
    const double half = random.uniform(0.5, 0.3 * size);
    auto projector =
        random.integer(0, 3) == 0
            ? make_projector(texgen::OrthographicLens{-half, half, -half, half, 0.1, 100.0}, aim, texgen::opengl)
            : make_projector(texgen::PerspectiveLens{texgen::degrees(random.uniform(5.0, 90.0)), 1.25, 0.1, 100.0}, aim,
                             texgen::vulkan);
    REQUIRE(projector);
    if (hostile != nullptr && random.integer(0, 20) == 0) {
        glm::dmat4 view = projector->view.matrix();
        view[3].x = static_cast<double>(nan_float);
        projector->view = texgen::ProjectorView(view);
        ++hostile->nan_projector;
    }
    return *projector;
}

// In half of the regions.
TextureRegion with_some_depth(const TextureRegion& region, Random& random, bool hostile) {
    switch (random.integer(0, hostile ? 11 : 9)) {
        case 0:
        case 1:
            return region.with_depth();
        case 2:
            return region.with_depth(-1.0, 1.0);
        case 3:
            return region.with_depth(random.uniform(0.0, 0.9), random.uniform(0.95, 1.0));
        case 4:
            return random.coin() ? region.with_depth(0.0, HUGE_VAL) : region.with_depth(-HUGE_VAL, 0.99);
        case 10:
            return region.with_depth(1.0, 0.0);
        case 11:
            return region.with_depth(random.coin() ? std::nan("") : random.power_of_ten(-300.0, 300.0), 1.0);
        default:
            return region;
    }
}

TextureRegion some_sides(Random& random, Hostile* hostile) {
    switch (hostile != nullptr ? random.integer(0, 9) : 9) {
        case 0:
            ++hostile->empty_region;
            return texgen::atlas_tile({0.0, 1.0}, {1.0, 0.0});
        case 1:
            ++hostile->far_region;
            return texgen::atlas_tile({1e6, -1e6}, {1e6 + 1.0, 1.0 - 1e6});
        case 2:
            return texgen::atlas_tile({-HUGE_VAL, 0.0}, {1.0, 1.0});
        case 3:
            return texgen::rectangle_texture(640.0, 480.0);
        default:
            return texgen::whole_texture();
    }
}

TextureRegion some_region(Random& random, Hostile* hostile = nullptr) {
    return with_some_depth(some_sides(random, hostile), random, hostile != nullptr);
}

ObjectTexgen texgen_of(const Engine& engine, std::size_t object, std::size_t projector) {
    return object_linear(engine.projectors[projector], engine.models[object], engine.regions[projector]);
}

bool have_same_bits(const glm::dmat4& a, const glm::dmat4& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// Within the rounding of two compilations of one product; NaN where it is.
bool are_alike(const glm::dmat4& a, const glm::dmat4& b) {
    double largest = 0.0;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) largest = std::fmax(largest, std::fabs(b[column][row]));
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            const double x = a[column][row], y = b[column][row];
            if (std::isfinite(x) != std::isfinite(y)) return false;
            if (std::isfinite(x) && std::fabs(x - y) > 0x1p-40 * largest) return false;
        }
    }
    return true;
}

std::string hex_of(const Engine& engine, std::size_t object, std::size_t projector) {
    return hex(engine.models[object].matrix()) + " box " + hex(engine.bounds[object].min) + " to " +
           hex(engine.bounds[object].max) + " projection " + hex(engine.projectors[projector].projection.matrix()) +
           " view " + hex(engine.projectors[projector].view.matrix()) + " region " +
           hex(engine.regions[projector].min()) + " to " + hex(engine.regions[projector].max()) +
           (engine.regions[projector].depth() ? " depth " + hex(*engine.regions[projector].depth()) : "");
}

struct Tally {
    std::size_t outside = 0, partial = 0, inside = 0;
};

// Every pair that a scene must have, and no other.
void require_all_pairs(const Scene& scene, const Engine& engine, Tally& tally) {
    std::size_t next = 0;
    for (std::uint32_t o = 0; o < engine.models.size(); ++o) {
        std::size_t of_object = 0;
        for (std::uint32_t p = 0; p < engine.projectors.size(); ++p) {
            const ObjectTexgen texgen = texgen_of(engine, o, p);
            const Coverage expected = coverage(texgen, engine.regions[p], engine.bounds[o]);
            ++(expected == Coverage::outside   ? tally.outside
               : expected == Coverage::partial ? tally.partial
                                               : tally.inside);
            if (expected == Coverage::outside) continue;
            ++of_object;
            REQUIRE_MESSAGE(next < scene.pairs().size(), hex_of(engine, o, p));
            const LitPair& pair = scene.pairs()[next++];
            REQUIRE_MESSAGE(pair.object == o, hex_of(engine, o, p));
            REQUIRE_MESSAGE(pair.projector == p, hex_of(engine, o, p));
            // The compiler may have contracted the other product otherwise.
            const ObjectTexgen& of_scene = scene.texgen(pair);
            REQUIRE_MESSAGE(are_alike(of_scene.matrix(), texgen.matrix()), hex_of(engine, o, p));
            REQUIRE_MESSAGE(pair.coverage == coverage(of_scene, engine.regions[p], engine.bounds[o]),
                            hex_of(engine, o, p));
        }
        REQUIRE(scene.pairs_of(o).size() == of_object);
    }
    REQUIRE(next == scene.pairs().size());
}

void require_same(const Scene& a, const Scene& b) {
    REQUIRE(a.pairs().size() == b.pairs().size());
    for (std::size_t i = 0; i < a.pairs().size(); ++i) {
        const LitPair &x = a.pairs()[i], &y = b.pairs()[i];
        REQUIRE(x.object == y.object);
        REQUIRE(x.projector == y.projector);
        REQUIRE(x.coverage == y.coverage);
        REQUIRE(have_same_bits(a.texgen(x).matrix(), b.texgen(y).matrix()));
    }
}

Engine some_engine(Random& random, std::size_t objects, std::size_t projectors, double size,
                   Hostile* hostile = nullptr) {
    Engine engine;
    for (std::size_t i = 0; i < objects; ++i) {
        engine.models.push_back(some_model(random, size, hostile));
        engine.bounds.push_back(some_box(random, hostile));
    }
    for (std::size_t i = 0; i < projectors; ++i) {
        engine.projectors.push_back(some_projector(random, size, hostile));
        engine.regions.push_back(some_region(random, hostile));
    }
    return engine;
}

Indices up_to(std::size_t count) {
    Indices all;
    for (std::uint32_t i = 0; i < count; ++i) all.push_back(i);
    return all;
}

}  // namespace

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
            SceneChanges changes;
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

TEST_CASE(
    "no lit point of a box is without its pair, by exact arithmetic, where boxes touch the light's sides far away") {
    Random random(1202);
    int touching = 0, lit_points = 0, pairs = 0;
    for (int round = 0; round < 300; ++round) {
        const double away = random.power_of_ten(0.0, 7.0);
        Engine engine = some_engine(random, 30, 3, 10.0);
        const glm::dvec3 offset = random.direction() * away;
        for (Projector& projector : engine.projectors) {
            glm::dmat4 view = projector.view.matrix();
            view[3] -= view * glm::dvec4(offset, 0.0);
            projector.view = texgen::ProjectorView(view);
        }
        if (random.coin()) {
            // What is left of s and t in such a region is rounded by far more than their sides are apart from it.
            const double far = random.power_of_ten(3.0, 9.0);
            engine.regions[0] = texgen::atlas_tile({far, far}, {far + 0.5, far + 0.5});
        }
        for (std::size_t o = 0; o < engine.models.size(); ++o) {
            // Moved along the gradient of a side until the box touches that from outside; give or take a rounding.
            // Half of them are not turned, so that their bounds in the world have no room to spare.
            glm::dmat4 model = engine.models[o].matrix();
            for (int j = 0; j < 3 && o % 2 == 0; ++j)
                for (int k = 0; k < 3; ++k) model[j][k] = j == k ? 1.0 : 0.0;
            model[3] += glm::dvec4(offset, 0.0);
            const auto p = static_cast<std::size_t>(random.integer(0, 2));
            const std::optional<glm::dvec2> depth = engine.regions[p].depth();
            const bool has_two_limits = depth && std::isfinite(depth->x) && std::isfinite(depth->y);
            const int side = random.integer(0, has_two_limits ? 5 : 3);
            for (int step = 0; step < 4; ++step) {
                const auto form = [&](const glm::dmat4& m) {
                    const int k = side / 2;
                    const glm::dvec2 sides =
                        k == 2 ? *depth : glm::dvec2(engine.regions[p].min()[k], engine.regions[p].max()[k]);
                    glm::dvec4 row;
                    for (int j = 0; j < 4; ++j)
                        row[j] = side % 2 == 0 ? m[j][k] - sides.x * m[j].w : sides.y * m[j].w - m[j][k];
                    return row;
                };
                const glm::dmat4 world = texture_from_world(engine.projectors[p], engine.regions[p]).matrix();
                const glm::dvec4 in_world = form(world);
                const glm::dvec4 in_object =
                    form(object_linear(engine.projectors[p], ModelMatrix(model), engine.regions[p]).matrix());
                double largest = in_object.w;
                for (int j = 0; j < 3; ++j)
                    largest += std::max(in_object[j] * static_cast<double>(engine.bounds[o].min[j]),
                                        in_object[j] * static_cast<double>(engine.bounds[o].max[j]));
                const glm::dvec3 gradient(in_world.x, in_world.y, in_world.z);
                const double squared = gradient.x * gradient.x + gradient.y * gradient.y + gradient.z * gradient.z;
                for (int j = 0; j < 3; ++j) model[3][j] -= largest * gradient[j] / squared;
            }
            if (random.coin()) model[3].x = std::nextafter(model[3].x, random.coin() ? HUGE_VAL : -HUGE_VAL);
            engine.models[o] = ModelMatrix(model);
            ++touching;
        }
        Scene scene;
        scene.update(engine.view(), {});
        Tally tally;
        require_all_pairs(scene, engine, tally);
        pairs += static_cast<int>(scene.pairs().size());
        for (std::uint32_t o = 0; o < engine.models.size(); ++o) {
            for (std::uint32_t p = 0; p < engine.projectors.size(); ++p) {
                const auto of_object = scene.pairs_of(o);
                const bool is_paired = std::any_of(of_object.begin(), of_object.end(),
                                                   [p](const LitPair& pair) { return pair.projector == p; });
                const glm::dmat4 matrix = texgen_of(engine, o, p).matrix();
                const TextureRegion& region = engine.regions[p];
                for (int corner = 0; corner < 8; ++corner) {
                    const Box& box = engine.bounds[o];
                    const glm::vec3 point((corner & 1) != 0 ? box.max.x : box.min.x,
                                          (corner & 2) != 0 ? box.max.y : box.min.y,
                                          (corner & 4) != 0 ? box.max.z : box.min.z);
                    const support::Homogeneous at = support::exactly_at(matrix, point);
                    if (at.q.sign() <= 0) continue;
                    const support::Quotient s = at.over_q(0), t = at.over_q(1);
                    const bool lit = compare(s, region.min().x) >= 0 && compare(s, region.max().x) <= 0 &&
                                     compare(t, region.min().y) >= 0 && compare(t, region.max().y) <= 0 &&
                                     (!region.depth() || (compare(at.over_q(2), region.depth()->x) >= 0 &&
                                                          compare(at.over_q(2), region.depth()->y) <= 0));
                    lit_points += lit;
                    if (lit) REQUIRE_MESSAGE(is_paired, hex_of(engine, o, p));
                }
            }
        }
    }
    CHECK(broken_preconditions == 0);
    CHECK(touching > 1000);
    CHECK(lit_points > 1000);
    CHECK(pairs > 300);
}

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
            REQUIRE(work.bounds_tested <= 24 * 4);  // one a level
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
    const SceneWork work = scene.update(engine.view(), {often, {}});
    CHECK(allocations == named);
    CHECK(work.pairs_tested == 4);
}

TEST_CASE("what a scene allocates is at most 225 bytes an object, twice 800 a projector, and twice 165 a lit pair") {
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
    CHECK(bytes_of(20000, 1, behind) - bytes_of(10000, 1, behind) <= 225 * std::size_t{10000});
    CHECK(bytes_of(1, 4096, behind) - bytes_of(1, 1024, behind) <= 2 * 800 * std::size_t{3072});
    CHECK(bytes_of(1024, 32, lit) - bytes_of(1024, 32, behind) <= 2 * 165 * std::size_t{1024 * 32});
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

TEST_CASE("whatever the numbers of matrices and regions are, the pairs are those of all pairs asked one by one") {
    Random random(1211);
    Tally tally;
    int overflown = 0;
    const auto spoil = [&](glm::dmat4 m, int kind, bool keeps_last_row) {
        const double power = random.power_of_ten(-200.0, 200.0);
        for (int column = 0; column < 4; ++column) {
            for (int row = 0; row < (keeps_last_row ? 3 : 4); ++row) {
                double& element = m[column][row];
                switch (kind) {
                    case 0:  // what a product of rotations by right angles leaves, and less
                        if (column != row && random.coin())
                            element = (random.coin() ? 1.0 : -1.0) * random.power_of_ten(-130.0, -15.0);
                        break;
                    case 1:  // graded
                        element *= random.power_of_ten(-70.0, 70.0);
                        break;
                    case 2:
                        element *= power;
                        break;
                    case 3:
                        element *= 1e300;
                        break;
                    case 4:  // subnormal
                        if (random.integer(0, 3) == 0) element = random.uniform(-1.0, 1.0) * 0x1p-1040;
                        break;
                    case 5:
                        element *= 1e-300;
                        break;
                    default:
                        if (random.integer(0, 5) == 0) element = std::nearbyint(element);
                        break;
                }
            }
        }
        return m;
    };
    for (int round = 0; round < 400; ++round) {
        const double size = 12.0;
        Engine engine = some_engine(random, 30, 4, size);
        const auto spoil_object = [&](std::size_t o) {
            const int kind = random.integer(0, 11);
            engine.models[o] = ModelMatrix(spoil(some_model(random, size).matrix(), kind, random.integer(0, 3) != 0));
            if (random.coin())
                engine.bounds[o] = box_of(glm::vec3(support::to_float(random.power_of_ten(-45.0, 38.0))));
        };
        const auto spoil_projector = [&](std::size_t p) {
            const Projector given = some_projector(random, size);
            engine.projectors[p] = {
                texgen::ProjectorProjection(spoil(given.projection.matrix(), random.integer(0, 25), false)),
                texgen::ProjectorView(spoil(given.view.matrix(), random.integer(0, 25), true)), given.conventions};
            const auto side = [&] {
                const int kind = random.integer(0, 9);
                return kind == 0   ? random.power_of_ten(-300.0, 300.0)
                       : kind == 1 ? HUGE_VAL
                                   : random.uniform(-1.0, 1.0);
            };
            if (random.integer(0, 3) == 0) {
                const glm::dvec2 min{-side(), -side()}, max{side(), side()};
                engine.regions[p] = with_some_depth(texgen::atlas_tile(min, max), random, true);
            }
        };
        for (std::size_t o = 0; o < engine.models.size(); ++o)
            if (random.coin()) spoil_object(o);
        for (std::size_t p = 0; p < engine.projectors.size(); ++p)
            if (random.coin()) spoil_projector(p);
        Scene scene;
        scene.update(engine.view(), {});
        for (int frame = 0; frame < 6; ++frame) {
            require_all_pairs(scene, engine, tally);
            Scene fresh;
            fresh.update(engine.view(), {});
            require_same(scene, fresh);
            for (const LitPair& pair : scene.pairs()) {
                const auto is_finite = [](const glm::dmat4& m) {
                    for (int j = 0; j < 4; ++j)
                        for (int k = 0; k < 4; ++k)
                            if (!std::isfinite(m[j][k])) return false;
                    return true;
                };
                const Projector& projector = engine.projectors[pair.projector];
                if (!is_finite(scene.texgen(pair).matrix())) {
                    overflown += is_finite(engine.models[pair.object].matrix()) &&
                                 is_finite(projector.projection.matrix()) && is_finite(projector.view.matrix());
                    REQUIRE(pair.coverage == Coverage::partial);
                }
            }
            Indices objects, projectors;
            for (int n = random.integer(0, 5); n > 0; --n) {
                objects.push_back(static_cast<std::uint32_t>(random.integer(0, 29)));
                spoil_object(objects.back());
            }
            if (random.coin()) {
                projectors.push_back(static_cast<std::uint32_t>(random.integer(0, 3)));
                spoil_projector(projectors.back());
            }
            scene.update(engine.view(), {objects, projectors});
        }
    }
    CHECK(broken_preconditions == 0);
    CHECK(overflown > 1000);
    CHECK(tally.outside > 50000);
    CHECK(tally.partial > 50000);
    CHECK(tally.inside > 100);
}

TEST_CASE("what is before or beyond the depth of a projector is no pair of it, and costs no T_o") {
    Engine engine;
    const texgen::Aim aim{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}};
    for (int i = 0; i < 100; ++i) {
        engine.models.push_back(ModelMatrix(glm::dmat4(1.0)));
        const float z = -5.0f * static_cast<float>(i) - 2.0f;
        engine.bounds.push_back({{-0.1f, -0.1f, z - 1.0f}, {0.1f, 0.1f, z}});
    }
    for (const texgen::Conventions conventions :
         {texgen::opengl, texgen::direct3d, left_handed(texgen::direct3d), texgen::vulkan}) {
        engine.projectors = {
            *make_projector(texgen::PerspectiveLens{texgen::degrees(60), 1.0, 1.0, 20.0}, aim, conventions)};
        engine.regions = {texgen::whole_texture()};
        Scene scene;
        const auto everywhere = scene.update(engine.view(), {});
        CHECK(scene.pairs().size() == 100);
        engine.regions = {texgen::whole_texture().with_depth()};
        const std::uint32_t first = 0;
        const auto within = scene.update(engine.view(), {.objects = {}, .projectors = {&first, 1}});
        REQUIRE(scene.pairs().size() == 4);  // those that begin at 2, 7, 12 and 17
        for (std::uint32_t k = 0; k < 4; ++k) {
            CHECK(scene.pairs()[k].object == k);
            CHECK(scene.pairs()[k].coverage == Coverage::inside);
        }
        CHECK(everywhere.texgens_computed == 100);
        CHECK(within.texgens_computed <= 5);
    }
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
