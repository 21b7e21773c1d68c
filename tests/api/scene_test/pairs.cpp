// Which pairs there are: where boxes touch the sides, whatever the numbers are, and within the depth of a projector.

#include "support/broken_preconditions.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "api/scene_test/engine.hpp"
#include "judges/exact.hpp"
#include "support/random.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/scene.hpp"

namespace scene_cases {

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

}  // namespace scene_cases
