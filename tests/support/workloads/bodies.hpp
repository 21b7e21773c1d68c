#pragma once

// Workloads of boxes, spheres, the volumes that are lit, and scenes.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "support/random.hpp"
#include "support/stopwatch.hpp"
#include "support/workloads/numbers.hpp"
#include "support/workloads/texgens.hpp"
#include "texgen/clip.hpp"
#include "texgen/coverage.hpp"
#include "texgen/projector.hpp"
#include "texgen/scene.hpp"

namespace support::detail {

inline constexpr std::size_t bodies = 256;
inline constexpr std::size_t body_pattern = 4;

inline Numbers ordinary_boxes(Random& random) {
    Numbers n;
    for (std::size_t i = 0; i < body_pattern; ++i) {
        const glm::vec3 centre = random.vector3(3.0), half(random.uniform_float(0.1, 0.4));
        put(n, centre - half);
        put(n, centre + half);
    }
    put(n, ordinary_texgen(random));
    return n;
}
inline Numbers draw_boxes(Random& random) {
    Numbers n;
    const glm::dmat4 texgen = drawn_texgen(random);
    for (std::size_t i = 0; i < body_pattern; ++i) {
        glm::vec3 a{}, b{};
        for (int k = 0; k < 3; ++k) {
            a[k] = random.coin() ? static_cast<float>(random.integer(-16, 15)) : random.uniform_float(-8.0, 8.0);
            b[k] = a[k] + (random.coin() ? static_cast<float>(random.integer(0, 4)) : random.uniform_float(0.0, 2.0));
        }
        if (random.integer(0, 3) == 0) {
            a.x = to_float(any_float(random));
            b.x = a.x + std::fabs(to_float(any_float(random)));
        }
        put(n, a);
        put(n, b);
    }
    put(n, texgen);
    return n;
}
inline constexpr Inputs box_inputs{
    24, ordinary_boxes, draw_boxes,
    "drawn: boxes with whole coordinates or of any size, under an aligned projector or any matrix"};
inline Numbers ordinary_spheres(Random& random) {
    Numbers n;
    for (std::size_t i = 0; i < body_pattern; ++i) {
        put(n, random.vector3(3.0));
        put(n, random.uniform_float(0.1, 0.4));
    }
    put(n, ordinary_texgen(random));
    return n;
}
inline Numbers draw_spheres(Random& random) {
    Numbers n;
    for (std::size_t i = 0; i < body_pattern; ++i)
        for (const double x : any_numbers<4>(random)) n.push_back(x);
    put(n, drawn_texgen(random));
    return n;
}
inline constexpr Inputs sphere_inputs{16, ordinary_spheres, draw_spheres,
                                      "drawn: spheres of any numbers, under an aligned projector or any matrix"};

// Bodies of a world, and a matrix as cameras of such sizes make it, where a sine that is 0 may be 2^-54. (As
// is_of_a_scene().)
inline bool are_of_a_scene(const Numbers& n) {
    const auto body_end = n.end() - 16;
    return std::all_of(n.begin(), body_end, [](double x) { return is_between(x, 0x1p-20, 0x1p20); }) &&
           std::all_of(body_end, n.end(), [](double x) { return is_between(x, 0x1p-60, 0x1p20); });
}
inline texgen::TextureRegion whole_volume() { return texgen::whole_texture().with_depth(); }
template <class Body, std::size_t Count, texgen::TextureRegion (&Region)() = texgen::whole_texture>
Calls coverage_calls(const Numbers& n) {
    if (!are_of_a_scene(n)) return {};
    Reader reader(n);
    std::vector<Body> all;
    for (std::size_t i = 0; i < body_pattern; ++i) {
        if constexpr (std::is_same_v<Body, texgen::Box>) {
            const glm::vec3 min = reader.vec3(), max = reader.vec3();
            all.push_back({min, max});
        } else {
            const glm::vec3 centre = reader.vec3();
            all.push_back({centre, reader.single()});
        }
    }
    for (std::size_t i = body_pattern; i < Count; ++i) all.push_back(all[i - body_pattern]);
    const texgen::LitVolume<texgen::World> volume(texgen::WorldTexgen(reader.dmat4()), Region());
    std::vector<texgen::Coverage> out(Count);
    return calls_of([=]() mutable {
        if constexpr (Count == 1)
            keep(volume.coverage(all[0]));
        else
            volume.coverage(std::span<const Body>(all), out);
    });
}
// Asked once: the volume is made for it.
template <class Body, texgen::TextureRegion (&Region)() = texgen::whole_texture>
Calls one_question_calls(const Numbers& n) {
    if (!are_of_a_scene(n)) return {};
    Reader reader(n);
    const glm::vec3 a = reader.vec3(), b = reader.vec3();
    Numbers matrix(n.end() - 16, n.end());
    return calls_of([a, b, texgen = texgen::WorldTexgen(Reader(matrix).dmat4())] {
        if constexpr (std::is_same_v<Body, texgen::Box>)
            keep(texgen::coverage(texgen, Region(), texgen::Box{a, b}));
        else
            keep(texgen::coverage(texgen, Region(), texgen::Sphere{a, b.x}));
    });
}
// A frame in which all of 64 objects change, about 4 projectors that have a depth and are one.
inline Calls scene_calls(const Numbers& n) {
    if (!are_of_a_scene(n)) return {};
    struct Engine {
        std::vector<texgen::ModelMatrix> models;
        std::vector<texgen::Box> bounds;
        std::vector<texgen::Projector> projectors;
        std::vector<texgen::TextureRegion> regions;
        std::vector<std::uint32_t> all;
        texgen::Scene scene;
    };
    const auto engine = std::make_shared<Engine>();
    Reader reader(n);
    for (std::uint32_t i = 0; i < 64; ++i) {
        if (i < body_pattern) {
            const glm::vec3 min = reader.vec3(), max = reader.vec3();
            engine->bounds.push_back({min, max});
        } else {
            engine->bounds.push_back(engine->bounds[i - body_pattern]);
        }
        engine->models.emplace_back(glm::dmat4(1.0));
        engine->all.push_back(i);
    }
    glm::dmat4 projection = reader.dmat4();
    for (int k = 0; k < 4; ++k)
        projection[k] = glm::dvec4(2.0 * glm::dvec3(projection[k]) - projection[k].w, projection[k].w);
    engine->projectors.assign(
        4, {texgen::ProjectorProjection(projection), texgen::ProjectorView(glm::dmat4(1.0)), texgen::opengl});
    engine->regions.assign(4, whole_volume());
    return calls_of([engine] {
        keep(engine->scene.update({engine->models, engine->bounds, engine->projectors, engine->regions},
                                  {engine->all, {}}));
    });
}
inline Numbers ordinary_volume(Random& random) {
    return numbers(ordinary_texgen(random), glm::dvec4(0.0, 0.0, 1.0, 1.0));
}
inline Numbers draw_volume(Random& random) {
    Numbers n = numbers(drawn_texgen(random));
    for (const double x : any_numbers<4>(random)) n.push_back(x);
    return n;
}
inline constexpr Inputs volume_inputs{0, ordinary_volume, draw_volume, "drawn: an aligned projector or any matrix"};
inline texgen::TextureRegion read_region(Reader& reader, bool has_depth) {
    const glm::dvec4 sides = reader.dvec4();
    const texgen::TextureRegion region = texgen::atlas_tile({sides.x, sides.y}, {sides.z, sides.w});
    return has_depth ? region.with_depth(sides.x, sides.w) : region;
}
template <bool HasDepth>
Calls volume_calls(const Numbers& n) {
    Reader reader(n);
    const texgen::WorldTexgen texgen(reader.dmat4());
    const texgen::TextureRegion region = read_region(reader, HasDepth);
    return calls_of([texgen, region] { keep(texgen::LitVolume<texgen::World>(texgen, region)); });
}
template <bool HasDepth>
Calls planes_calls(const Numbers& n) {
    Reader reader(n);
    const texgen::WorldTexgen texgen(reader.dmat4());
    const texgen::TextureRegion region = read_region(reader, HasDepth);
    return calls_of([texgen, region] { keep(texgen::clip_planes(texgen, region)); });
}

}  // namespace support::detail
