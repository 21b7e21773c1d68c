#pragma once

// Slides: as scenes have them, hostile ones, and points on their sides.

#include <cmath>
#include <optional>
#include <string>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "api/coverage_test/judge.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace coverage_cases {

using support::hex;
using support::Random;
using texgen::atlas_tile;
using texgen::degrees;
using texgen::whole_texture;
using texgen::WorldTexgen;

inline std::string hex(const Box& box) { return "box " + hex(box.min) + " to " + hex(box.max); }
inline std::string hex(const texgen::Sphere& sphere) {
    return "sphere " + hex(sphere.centre) + ", radius " + hex(sphere.radius);
}

struct Slide {
    glm::dmat4 matrix;
    TextureRegion region;
    std::optional<glm::vec3> touched = {};  // a point on a side, or on an edge, to within an ulp of double or two
};

inline std::string hex(const Slide& slide) { return "matrix " + hex(slide.matrix) + ", " + hex(slide.region); }

// In one of two slides a depth: the whole one, a part, or to one side.
inline TextureRegion with_some_depth(const TextureRegion& region, texgen::Conventions conventions,
                                     texgen::DepthMapping mapping, Random& random) {
    switch (random.integer(0, 7)) {
        case 0:
            return region.with_depth();
        case 1:
            return region.with_depth(conventions, mapping);
        case 2:
            return region.with_depth(random.uniform(-1.0, 0.9), random.uniform(0.9, 1.1));
        case 3:
            return random.coin() ? region.with_depth(0.0, infinite) : region.with_depth(-infinite, 0.999);
        default:
            return region;
    }
}

// A projector as a scene has it, about a place, and the whole texture or a tile of an atlas.
inline Slide ordinary_slide(Random& random, double distance_from_origin) {
    const glm::dvec3 place = distance_from_origin * random.direction();
    const texgen::Aim aim{.position = place + random.uniform(0.0, 20.0) * random.direction(),
                          .target = place + random.uniform(0.0, 20.0) * random.direction(),
                          .up = random.direction()};
    const TextureRegion region = random.coin() ? whole_texture()
                                               : atlas_tile({random.integer(0, 7) / 8.0, random.integer(0, 3) / 4.0},
                                                            {random.integer(8, 15) / 8.0, random.integer(4, 7) / 4.0});
    const auto slide_of = [&](const auto& lens) -> std::optional<Slide> {
        const texgen::Conventions all[] = {texgen::opengl, texgen::vulkan, texgen::direct3d, texgen::metal};
        const texgen::Conventions of_hand = all[random.integer(0, 3)];
        const texgen::Conventions conventions = random.coin() ? of_hand : left_handed(of_hand);
        auto projector = texgen::make_projector(lens, aim, conventions);
        if (!projector) return {};
        if (random.integer(0, 3) == 0) {  // reversed: z becomes w - z, or -z
            glm::dmat4 reversed = projector->projection.matrix();
            for (int j = 0; j < 4; ++j)
                reversed[j].z =
                    (conventions.depth == texgen::DepthRange::zero_to_one ? reversed[j].w : 0.0) - reversed[j].z;
            projector->projection = texgen::ProjectorProjection(reversed);
        }
        const TextureRegion of_slide = random.coin() ? region : whole_texture();
        const auto mapping = random.coin() ? texgen::DepthMapping::unit : texgen::DepthMapping::ndc;
        return Slide{texgen::texture_from_world(*projector, of_slide, mapping).matrix(),
                     with_some_depth(region, conventions, mapping, random),
                     {}};
    };
    std::optional<Slide> slide;
    switch (random.integer(0, 4)) {
        case 0: {
            const double size = random.uniform(1.0, 15.0);
            slide = slide_of(texgen::OrthographicLens{-size, random.uniform(0.3, 1.0) * size, -size,
                                                      random.uniform(0.3, 1.0) * size, 0.1, 100.0});
            break;
        }
        case 1:
            slide = slide_of(texgen::FrustumLens{random.uniform(-0.5, 0.0), random.uniform(0.1, 0.5),
                                                 random.uniform(-0.5, 0.0), random.uniform(0.1, 0.5), 0.5, 200.0});
            break;
        case 2:
            slide = slide_of(texgen::PinholeLens{
                random.uniform(400.0, 900.0), random.uniform(400.0, 900.0), random.uniform(200.0, 400.0),
                random.uniform(150.0, 300.0), 640.0, 480.0, 0.2, random.coin() ? infinite : 100.0,
                random.coin() ? texgen::PixelCentre::integer : texgen::PixelCentre::half, random.uniform(-2.0, 2.0)});
            break;
        default:
            slide = slide_of(texgen::PerspectiveLens{.fovy = degrees(random.uniform(8.0, 110.0)),
                                                     .aspect = random.uniform(0.5, 2.0),
                                                     .z_near = 0.1,
                                                     .z_far = random.coin() ? infinite : 500.0});
            break;
    }
    return slide ? *slide : ordinary_slide(random, distance_from_origin);
}

inline Slide hostile_slide(Random& random) {
    Slide slide = ordinary_slide(random, random.integer(0, 2) == 0 ? random.power_of_ten(2.0, 6.0) : 0.0);
    const auto any_region = [&] {
        const auto side = [&] {
            const int kind = random.integer(0, 19);
            return kind == 0 ? random.power_of_ten(-300.0, 300.0) : kind == 1 ? 0.0 : random.uniform(-4.0, 4.0);
        };
        glm::dvec2 min{side(), side()}, max{side(), side()};  // braces: from left to right
        if (random.integer(0, 3) == 0) max.x = min.x;
        if (random.integer(0, 3) == 0) min.x = -infinite;
        if (random.integer(0, 3) == 0) max.y = infinite;
        const TextureRegion region = atlas_tile(min, max);
        if (random.coin()) return region;
        const double near = side(), far = random.integer(0, 3) == 0 ? near : side();
        return region.with_depth(random.integer(0, 3) == 0 ? -infinite : near, far);
    };
    switch (random.integer(0, 9)) {
        case 0:
            slide.matrix = glm::dmat4(support::rounded(slide.matrix));
            break;
        case 1:
            slide.matrix *= random.power_of_ten(-30.0, 30.0);
            break;
        case 2: {  // small integers: exact ties everywhere
            for (int j = 0; j < 4; ++j)
                for (int k = 0; k < 4; ++k) slide.matrix[j][k] = random.integer(-2, 2);
            slide.region = atlas_tile({random.integer(-2, 1), random.integer(-2, 1)},
                                      {random.integer(-1, 2), random.integer(-1, 2)});
            if (random.coin()) slide.region = slide.region.with_depth(random.integer(-2, 1), random.integer(-1, 2));
            break;
        }
        case 3: {
            const int axis = random.integer(0, 2);
            slide.matrix[axis] = -slide.matrix[axis];
            break;
        }
        case 4:
            for (int j = 0; j < 4; ++j)
                for (int k = 0; k < 4; ++k)
                    slide.matrix[j][k] = random.uniform(-1.0, 1.0) * random.power_of_ten(-3.0, 3.0);
            break;
        case 5:
            slide.region = any_region();
            break;
        case 6:
            if (random.integer(0, 9) == 0)
                for (int j = 0; j < 4; ++j) slide.matrix[j][random.integer(0, 3)] *= random.power_of_ten(-250.0, 250.0);
            break;
        case 7: {  // aligned with the axes
            const double focal_length = random.power_of_ten(-1.0, 1.0);
            slide.matrix = glm::dmat4(0.0);
            slide.matrix[random.integer(0, 1)][0] = focal_length;
            slide.matrix[random.integer(0, 1)][1] = random.coin() ? focal_length : -focal_length;
            slide.matrix[2][0] = slide.matrix[2][1] = random.coin() ? 0.5 : 0.0;
            slide.matrix[2][3] = random.coin() ? 1.0 : -1.0;
            slide.matrix[2][2] = random.coin() ? 1.0 : 0.5;
            for (const int k : {0, 1, 2, 3}) slide.matrix[3][k] = random.coin() ? 0.0 : random.integer(-3, 3);
            break;
        }
        case 8:  // q hardly changes
            for (int j = 0; j < 3; ++j) slide.matrix[j][3] *= random.power_of_ten(-12.0, -4.0);
            break;
        default:
            break;
    }
    return slide;
}

// Moves one or two sides of the slide into a point, so that their forms cancel there as far as double can say.
inline void touch(Slide& slide, const glm::vec3& point, Random& random) {
    const auto linear = [&](int k) {
        long double sum = 0;
        for (int j = 0; j < 3; ++j) sum += static_cast<long double>(slide.matrix[j][k]) * point[j];
        return sum;
    };
    const long double q = linear(3) + slide.matrix[3][3];
    for (int k = 0; k < limited(slide.region); ++k) {
        const bool is_min = random.coin();
        const double given = limits(slide.region, k)[is_min ? 0 : 1];
        const Rounded rounded = is_min ? Rounded::of_min(given) : Rounded::of_max(given);
        const int kind = random.integer(0, 2);
        const double side = kind == 0 ? given : kind == 1 ? rounded.outer : rounded.inner;
        if (std::isinf(side) || random.integer(0, 3) == 0) continue;
        double moved = static_cast<double>(side * q - linear(k));
        for (int steps = random.integer(-2, 2); steps != 0; steps += steps < 0 ? 1 : -1)
            moved = std::nextafter(moved, steps < 0 ? -infinite : infinite);
        slide.matrix[3][k] = moved;
        slide.touched = point;
    }
}

// A point where `forms` of them are 0, as far as double goes: on a side, on an edge, at the apex.
inline glm::dvec3 point_on(const Slide& slide, int forms, Random& random, const glm::dvec3& about) {
    const auto row = [&](int k) {
        return glm::dvec4(slide.matrix[0][k], slide.matrix[1][k], slide.matrix[2][k], slide.matrix[3][k]);
    };
    const glm::dvec4 q = row(3);
    const auto side = [&](int k) {
        const double value = limits(slide.region, k)[random.integer(0, 1)];
        return std::isinf(value) ? q : row(k) - value * q;
    };
    const int coordinates = limited(slide.region);
    const int first = random.integer(0, coordinates - 1), step_on = random.integer(1, coordinates - 1);
    const bool is_edge_of_depth = coordinates == 3 && forms == 2;
    const glm::dvec4 plane[3] = {forms == 1 && random.integer(0, 3) == 0 ? q : side(first),
                                 side(is_edge_of_depth ? first : 0),
                                 side(is_edge_of_depth ? (first + step_on) % coordinates : 1)};
    glm::dvec3 p = about;
    const auto normal = [](const glm::dvec4& f) { return glm::dvec3(f.x, f.y, f.z); };
    const auto dot = [](const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
    for (int step = 0; step < (forms == 1 ? 3 : 60); ++step) {
        const glm::dvec4& f = forms == 1      ? plane[0]
                              : forms == 2    ? plane[1 + step % 2]
                              : step % 3 == 2 ? q
                                              : plane[1 + step % 3];
        const glm::dvec3 n = normal(f);
        const double squared = dot(n, n);
        if (squared > 0.0) p -= (dot(n, p) + f.w) / squared * n;
    }
    return p;
}

// Whether the region has a point.
inline bool is_a_region(const TextureRegion& region) {
    return region.min().x <= region.max().x && region.min().y <= region.max().y &&
           (!region.depth() || region.depth()->x <= region.depth()->y);
}

}  // namespace coverage_cases
