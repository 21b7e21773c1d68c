#pragma once

// An engine with its arrays, whatever stands in them, and the pairs that a scene must have of them.

#include "support/broken_preconditions.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/coverage.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/scene.hpp"

namespace scene_cases {

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

inline Box box_of(const glm::vec3& half) { return {-half, half}; }

// From the origin along -z, so many times.
inline void give_light_along_z(Engine& engine, std::size_t count) {
    const auto projector = make_projector(texgen::PerspectiveLens{texgen::degrees(40), 1.0, 0.1, 100.0},
                                          texgen::Aim{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}}, texgen::opengl);
    engine.projectors.assign(count, projector.value());
    engine.regions.assign(count, texgen::whole_texture());
}

struct Hostile {
    int nan_model = 0, singular = 0, not_affine = 0, nan_box = 0, empty_box = 0, infinite_box = 0, flat_box = 0;
    int nan_projector = 0, empty_region = 0, far_region = 0;
};

inline ModelMatrix some_model(Random& random, double size, Hostile* hostile = nullptr) {
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

inline Box some_box(Random& random, Hostile* hostile = nullptr) {
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

inline Projector some_projector(Random& random, double size, Hostile* hostile = nullptr) {
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
inline TextureRegion with_some_depth(const TextureRegion& region, Random& random, bool hostile) {
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
            return random.coin() ? region.with_depth(1.0, 0.0) : region.with_depth(HUGE_VAL, HUGE_VAL);
        case 11:
            return region.with_depth(random.coin() ? std::nan("") : random.power_of_ten(-300.0, 300.0), 1.0);
        default:
            return region;
    }
}

inline TextureRegion some_sides(Random& random, Hostile* hostile) {
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

inline TextureRegion some_region(Random& random, Hostile* hostile = nullptr) {
    return with_some_depth(some_sides(random, hostile), random, hostile != nullptr);
}

inline ObjectTexgen texgen_of(const Engine& engine, std::size_t object, std::size_t projector) {
    return object_linear(engine.projectors[projector], engine.models[object], engine.regions[projector]);
}

inline bool have_same_bits(const glm::dmat4& a, const glm::dmat4& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// Within the rounding of two compilations of one product; NaN where it is.
inline bool are_alike(const glm::dmat4& a, const glm::dmat4& b) {
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

inline std::string hex_of(const Engine& engine, std::size_t object, std::size_t projector) {
    return hex(engine.models[object].matrix()) + " box " + hex(engine.bounds[object].min) + " to " +
           hex(engine.bounds[object].max) + " projection " + hex(engine.projectors[projector].projection.matrix()) +
           " view " + hex(engine.projectors[projector].view.matrix()) + " " + hex(engine.regions[projector]);
}

struct Tally {
    std::size_t outside = 0, partial = 0, inside = 0;
};

// Every pair that a scene must have, and no other.
inline void require_all_pairs(const Scene& scene, const Engine& engine, Tally& tally) {
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

inline void require_same(const Scene& a, const Scene& b) {
    REQUIRE(a.pairs().size() == b.pairs().size());
    for (std::size_t i = 0; i < a.pairs().size(); ++i) {
        const LitPair &x = a.pairs()[i], &y = b.pairs()[i];
        REQUIRE(x.object == y.object);
        REQUIRE(x.projector == y.projector);
        REQUIRE(x.coverage == y.coverage);
        REQUIRE(have_same_bits(a.texgen(x).matrix(), b.texgen(y).matrix()));
    }
}

inline Engine some_engine(Random& random, std::size_t objects, std::size_t projectors, double size,
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

}  // namespace scene_cases
