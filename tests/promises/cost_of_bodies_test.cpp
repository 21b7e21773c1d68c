// The worst bodies, frames and triangles that a search found, against ordinary ones: what they cost, timed in turn.

// The library's assertions go through all of a scene.
#define TEXGEN_ASSERT(condition) void()

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/limits.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/stopwatch.hpp"
#include "texgen/coverage.hpp"
#include "texgen/fixed_function.hpp"
#include "texgen/footprint.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/scene.hpp"

namespace {

namespace limit = support::limit;

using support::infinity_float;
using support::nan_float;
using support::Random;
using support::worst_over_ordinary_within;
using texgen::Box;
using texgen::Coverage;
using texgen::LitVolume;
using texgen::Sphere;
using texgen::World;
using texgen::WorldTexgen;

constexpr std::size_t count = 1024;

template <class Body, class Make>
std::vector<Body> many(const Make& make) {
    std::vector<Body> bodies;
    for (std::size_t i = 0; i < count; ++i) bodies.push_back(make());
    return bodies;
}

Box some_box(Random& random) {
    const glm::vec3 centre = random.vector3(20.0);
    const glm::vec3 half(random.uniform_float(0.1, 2.0), random.uniform_float(0.1, 2.0),
                         random.uniform_float(0.1, 2.0));
    return {centre - half, centre + half};
}

// A box between x = 4 and something, or y = 4, x = -4, y = -4, which it touches from inside or outside.
Box touching_box(Random& random, bool from_outside) {
    Box box = some_box(random);
    const int axis = random.integer(0, 1);
    const float width = random.uniform_float(0.5, 2.0);
    box.min[1 - axis] = random.uniform_float(-3.0, 0.0);
    box.max[1 - axis] = random.uniform_float(0.0, 3.0);
    box.min[axis] = from_outside ? 4.0f : 4.0f - width;
    box.max[axis] = from_outside ? 4.0f + width : 4.0f;
    box.min.z = random.uniform_float(-3.0, 0.0);
    box.max.z = random.uniform_float(0.0, 3.0);
    if (random.coin()) {
        std::swap(box.min[axis], box.max[axis]);
        box.min[axis] = -box.min[axis];
        box.max[axis] = -box.max[axis];
    }
    return box;
}

struct Slide {
    std::string name;
    WorldTexgen transform;
};

std::vector<Slide> slides() {
    const texgen::Aim aligned{{0, 0, 10}, {0, 0, 0}, {0, 1, 0}};
    const texgen::Aim askew{{1, 2, 10}, {0.3, 0.1, -1}, {0.1, 1, 0}};
    const texgen::PerspectiveLens right_angle{texgen::degrees(90), 1.0, 0.1, 100};
    const auto orthographic = make_projector(texgen::OrthographicLens{-4, 4, -4, 4, 0.1, 100}, aligned, texgen::opengl);
    const auto perspective = make_projector(right_angle, aligned, texgen::opengl);
    const auto turned = make_projector(right_angle, askew, texgen::opengl);
    REQUIRE((orthographic && perspective && turned));
    // As given by hand: lit where |x| and |y| are at most 10 - z.
    glm::dmat4 by_hand(0.0);
    by_hand[0] = {0.5, 0.0, 0.0, 0.0};
    by_hand[1] = {0.0, 0.5, 0.0, 0.0};
    by_hand[2] = {-0.5, -0.5, 0.0, -1.0};
    by_hand[3] = {5.0, 5.0, 0.0, 10.0};
    return {{"orthographic", texture_from_world(*orthographic)},
            {"perspective", texture_from_world(*perspective)},
            {"turned", texture_from_world(*turned)},
            {"by hand", WorldTexgen(by_hand)}};
}

struct Family {
    std::string name;
    double limit;
    std::vector<Box> boxes;
};

std::vector<Family> families(Random& random) {
    std::vector<Family> result;
    const auto touching = [&](const std::string& name, const auto& make) {
        result.push_back({name, limit::touching, many<Box>(make)});
    };
    const auto other = [&](const std::string& name, const auto& make) {
        result.push_back({name, limit::any, many<Box>(make)});
    };
    touching("touch sides from inside", [&] { return touching_box(random, false); });
    touching("touch sides from outside", [&] { return touching_box(random, true); });
    touching("touch all sides", [] { return Box{{-4, -4, -3}, {4, 4, 6}}; });
    touching("columns that touch", [&] {
        Box box = touching_box(random, random.coin());
        box.min.z = -infinity_float;
        box.max.z = infinity_float;
        return box;
    });
    touching("touch q = 0 from behind", [&] {
        return Box{{-1, random.uniform_float(-2.0, -1.0), 10}, {1, 1, random.uniform_float(11.0, 12.0)}};
    });
    touching("touch q = 0 from the front", [&] {
        return Box{{-1, random.uniform_float(-2.0, -1.0), random.uniform_float(0.0, 9.0)}, {1, 1, 10}};
    });
    touching("touch the apex", [&] { return Box{{0, 0, random.uniform_float(0.0, 9.0)}, {1, 1, 10}}; });
    touching("lattice", [&] {
        Box box{};
        for (int j = 0; j < 3; ++j) {
            box.min[j] = static_cast<float>(random.integer(-8, 8));
            box.max[j] = box.min[j] + static_cast<float>(random.integer(0, 4));
        }
        return box;
    });
    other("NaN", [&] { return Box{random.vector3(20.0), glm::vec3(0, nan_float, 0)}; });
    other("empty", [&] {
        const Box box = some_box(random);
        return Box{box.max, box.min};
    });
    other("infinite", [] { return Box{glm::vec3(-infinity_float), glm::vec3(infinity_float)}; });
    other("infinite to one side", [&] {
        Box box = some_box(random);
        box.max[random.integer(0, 2)] = infinity_float;
        return box;
    });
    other("huge", [] { return Box{glm::vec3(-3e38f), glm::vec3(3e38f)}; });
    other("huge to one side", [&] {
        Box box = some_box(random);
        box.max[random.integer(0, 2)] = 3e38f;
        return box;
    });
    other("points", [&] {
        const glm::vec3 point = random.vector3(20.0);
        return Box{point, point};
    });
    other("the origin", [] { return Box{glm::vec3(0.0f), glm::vec3(0.0f)}; });
    other("subnormal", [] { return Box{glm::vec3(-1e-40f), glm::vec3(1e-40f)}; });
    return result;
}

}  // namespace

TEST_CASE("boxes that touch sides, q = 0 or the apex cost at most 10 ordinary ones, all others at most 8") {
    Random random(1301);
    const std::vector<Box> ordinary = many<Box>([&] { return some_box(random); });
    const std::vector<Family> all = families(random);
    for (const Slide& slide : slides()) {
        const LitVolume<World> volume(slide.transform, texgen::whole_texture());
        std::vector<Coverage> out(count);
        const auto batch = [&](const std::vector<Box>& boxes) { return [&] { volume.coverage(boxes, out); }; };
        const auto one_by_one = [&](const std::vector<Box>& boxes) {
            return [&] {
                for (std::size_t i = 0; i < count; ++i) out[i] = volume.coverage(boxes[i]);
            };
        };
        for (const Family& family : all) {
            INFO(slide.name, ": ", family.name);
            const double of_batch = worst_over_ordinary_within(family.limit, batch(ordinary), batch(family.boxes));
            CHECK(of_batch <= family.limit);
            const double of_one =
                worst_over_ordinary_within(family.limit, one_by_one(ordinary), one_by_one(family.boxes));
            CHECK(of_one <= family.limit);
        }
    }
}

TEST_CASE("no sphere costs more than 8 ordinary ones") {
    Random random(1302);
    const std::vector<Sphere> ordinary = many<Sphere>([&] {
        return Sphere{random.vector3(20.0), random.uniform_float(0.1, 2.0)};
    });
    const std::vector<std::pair<std::string, std::vector<Sphere>>> all{
        {"touch a side from inside", many<Sphere>([&] {
             return Sphere{{3, 0, random.uniform_float(-2.0, 2.0)}, 1};
         })},
        {"touch a side from outside", many<Sphere>([&] {
             return Sphere{{5, 0, random.uniform_float(-2.0, 2.0)}, 1};
         })},
        {"touch an edge", many<Sphere>([&] {
             return Sphere{{4.5f, 4.5f, random.uniform_float(-2.0, 2.0)}, 0.8f};
         })},
        {"beside all edges", many<Sphere>([] {
             return Sphere{{0, 0, 0}, 100};
         })},
        {"at the apex", many<Sphere>([] {
             return Sphere{{0, 0, 10}, 1};
         })},
        {"points on an edge", many<Sphere>([] {
             return Sphere{{4, 4, 0}, 0};
         })},
        {"subnormal", many<Sphere>([] {
             return Sphere{glm::vec3(1e-40f), 1e-40f};
         })},
        {"NaN", many<Sphere>([] {
             return Sphere{{0, nan_float, 0}, 1};
         })},
        {"infinite", many<Sphere>([] {
             return Sphere{{0, 0, 0}, infinity_float};
         })}};
    for (const Slide& slide : slides()) {
        const LitVolume<World> volume(slide.transform, texgen::whole_texture());
        std::vector<Coverage> out(count);
        const auto batch = [&](const std::vector<Sphere>& spheres) { return [&] { volume.coverage(spheres, out); }; };
        for (const auto& family : all) {
            INFO(slide.name, ": ", family.first);
            CHECK(worst_over_ordinary_within(limit::any, batch(ordinary), batch(family.second)) <= limit::any);
        }
    }
}

TEST_CASE("no frame of a scene of 10 000 objects costs more than 200 median ones, whatever has to be sorted anew") {
    constexpr std::size_t objects = 10000, frames = 25000, moves = 2;
    Random random(1303);
    const auto some_place = [&](glm::dmat4 model) {
        model[3] = glm::dvec4(random.vector3(100.0), 1.0);
        return texgen::ModelMatrix(model);
    };
    std::vector<texgen::ModelMatrix> models;
    for (std::size_t i = 0; i < objects; ++i) models.push_back(some_place(random.rotation()));
    const std::vector<Box> bounds(objects, Box{glm::vec3(-0.5f), glm::vec3(0.5f)});
    std::vector<texgen::Projector> projectors;
    for (int i = 0; i < 4; ++i) {
        const glm::dvec3 position(random.vector3(100.0));
        projectors.push_back(*make_projector(texgen::PerspectiveLens{texgen::degrees(20), 1.0, 0.1, 30.0},
                                             texgen::Aim{position, position + random.direction(), random.direction()},
                                             texgen::opengl));
    }
    // The same frames again and again; of each the fastest counts, which nothing interrupted.
    std::vector<double> seconds(frames, HUGE_VAL);
    const std::uint64_t seed = random.bits();
    for (int repeat = 0; repeat < 5; ++repeat) {
        random = Random(seed);
        std::vector<texgen::ModelMatrix> moved_models = models;
        texgen::Scene scene;
        scene.update({moved_models, bounds, projectors}, {});
        for (double& least : seconds) {
            std::vector<std::uint32_t> moved;
            for (std::size_t i = 0; i < moves; ++i) {
                moved.push_back(static_cast<std::uint32_t>(random.integer(0, static_cast<int>(objects) - 1)));
                moved_models[moved.back()] = some_place(models[moved.back()].matrix());
            }
            const auto begin = std::chrono::steady_clock::now();
            scene.update({moved_models, bounds, projectors}, {moved, {}});
            least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
        }
    }
    std::sort(seconds.begin(), seconds.end());
    const double median = seconds[frames / 2];
    MESSAGE("median frame " << 1e6 * median << " us, worst " << 1e6 * seconds.back() << " us");
    CHECK(seconds.back() <= limit::frame * median);
}

TEST_CASE("no triangle's extremes cost more than those of 8 ordinary ones") {
    using texgen::Triangle;
    using texgen::WindowVertex;
    const auto setup_of = [](const Triangle& triangle) {
        return std::optional<texgen::FootprintSetup>(
            {*texgen::TriangleSetup::of(triangle, texgen::whole_texture()), {512, 512}});
    };
    Random random(1304);
    std::vector<texgen::FootprintSetup> ordinary;
    while (ordinary.size() < 200) {
        Triangle triangle{};
        for (WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c}) {
            const float q = random.uniform_float(1.0, 10.0);
            vertex->window = {random.uniform_float(0.0, 512.0), random.uniform_float(0.0, 512.0)};
            vertex->clip_w = random.uniform_float(1.0, 10.0);
            vertex->strq = {q * random.uniform_float(0.0, 1.0), q * random.uniform_float(0.0, 1.0), 0.0f, q};
        }
        if (const auto setup = texgen::TriangleSetup::of(triangle, texgen::whole_texture()))
            ordinary.push_back({*setup, {512, 512}});
    }
    const Triangle worst[] = {
        {{{0x1.af3334p-12f, 0x1.638262p+12f}, 0x1.ee9654p+6f, {0x1.09c46cp+2f, 0x1.a9e8f6p-1f, 0, 0x1.1a67d8p+3f}},
         {{-0x1.d05646p+1f, 0x1.5d6edp+8f}, 0x1.388fc8p+3f, {-0x1.0f17a4p-9f, 0x1.226826p+1f, 0, 0x1.f231fcp+1f}},
         {{0x1.2b300cp+1f, 0x1.90e1c2p+9f}, 0x1.a12028p+6f, {-0x1.e71176p+1f, -0x1.0d7384p-2f, 0, 0x1.1b9e7ep-3f}}},
        {{{-0x1.478aap+6f, 0x1.d8be2p+3f}, 0x1.bd39b4p+8f, {0x1.11a1dap-4f, -0x1.0d1c64p-2f, 0, 0x1.b188d6p+2f}},
         {{0x1.114e7ap+1f, 0x1.aafa8cp+19f}, 0x1p+0f, {0x1.679a1p+4f, -0x1.378c54p-4f, 0, 0x1.99ae3ep+2f}},
         {{-0x1.b7a6a6p+5f, 0x1.93c612p-4f}, 0x1.1c87aep-2f, {0x1.86375ep-2f, -0x1.1fa8bep-2f, 0, 0x1.3d0f3ep+1f}}}};
    volatile double sink = 0.0;
    for (const Triangle& triangle : worst) {
        const auto setup = setup_of(triangle);
        const auto ordinary_ones = [&] {
            for (const texgen::FootprintSetup& one : ordinary) sink = one.extremes()->least_level;
        };
        const auto worst_ones = [&] {
            for (std::size_t i = 0; i < ordinary.size(); ++i) sink = setup->extremes()->least_level;
        };
        CHECK(worst_over_ordinary_within(limit::any, ordinary_ones, worst_ones) <= limit::any);
    }
}

TEST_CASE("what is not asked for costs nothing: modes that are off, footprints where extremes are found") {
    volatile double sink = 0.0;
    using texgen::Coordinate;
    texgen::TexGenUnit linear;
    linear.enable(Coordinate::s);
    texgen::TexGenUnit with_sphere_map = linear;  // which needs an inverse, and is off
    REQUIRE(with_sphere_map.set_mode(Coordinate::t, texgen::TexGenMode::sphere_map));
    const texgen::FixedFunctionVertex vertex{
        .position = {1.0f, 2.0f, -3.0f, 1.0f}, .normal = {0.0f, 0.6f, 0.8f}, .texcoord = {0.0f, 0.0f, 0.0f, 1.0f}};
    const glm::mat4 modelview(2.0f);
    const auto generated_by = [&](const texgen::TexGenUnit& unit) {
        return [&] {
            for (int i = 0; i < 200; ++i) sink = static_cast<double>(unit.generate(vertex, modelview).x);
        };
    };
    CHECK(worst_over_ordinary_within(4.0, generated_by(linear), generated_by(with_sphere_map)) <= 4.0);

    const auto inverted = [&](const texgen::WorldTexgen& matrix) {
        return [&, matrix] {
            for (int i = 0; i < 200; ++i) sink = inverse(matrix).has_value() ? 1.0 : 0.0;
        };
    };
    glm::dmat4 regular(0.0);
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) regular[j][i] = 1.0 / (1.0 + i + j) + (i == j ? 1.0 : 0.0);
    glm::dmat4 singular = regular;
    singular[3] = singular[0] + singular[1];
    REQUIRE(inverse(texgen::WorldTexgen(regular)).has_value());
    REQUIRE_FALSE(inverse(texgen::WorldTexgen(singular)).has_value());
    CHECK(worst_over_ordinary_within(2.5, inverted(texgen::WorldTexgen(regular)),
                                     inverted(texgen::WorldTexgen(singular))) <= 2.5);

    const texgen::Triangle triangle{{{0.0f, 0.0f}, 1.0f, {0.0f, 0.0f, 0.0f, 1.0f}},
                                    {{64.0f, 0.0f}, 2.0f, {3.0f, 0.0f, 0.0f, 3.0f}},
                                    {{0.0f, 64.0f}, 4.0f, {0.0f, 2.0f, 0.0f, 2.0f}}};
    const texgen::FootprintSetup setup({*texgen::TriangleSetup::of(triangle, texgen::whole_texture()), {512, 512}});
    const auto alone = [&] {
        for (int i = 0; i < 40 * 20; ++i) sink = setup.at(i % 8, 9)->level;
    };
    const auto extremes = [&] {
        for (int i = 0; i < 20; ++i) sink = setup.extremes()->least_level;
    };
    CHECK(worst_over_ordinary_within(1.0, alone, extremes) <= 1.0);  // 40 fragments
}
