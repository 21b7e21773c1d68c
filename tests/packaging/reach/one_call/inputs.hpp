#pragma once

// What the programs of one call each read. It is theirs alone, as in a file of their own: hence the namespace without a
// name.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <texgen/batch.hpp>
#include <texgen/texgen.hpp>

namespace {

using namespace texgen;

glm::dmat4 matrix() {
    return {0.75, 0.125, 0.0, 0.0625, 0.0, 0.5, 0.25, 0.125, 0.25, 0.0, 0.5, 0.0625, 0.125, 0.25, 0.375, 1.0};
}

// Inside the slide and outside of it, in front of the projector and behind it.
glm::vec3 point(int i) {
    const float number = 0.3f * static_cast<float>(i) - 0.25f;
    return {number, 0.5f - 0.5f * number, 0.125f - (i % 4 == 3 ? 100.0f : 0.0f)};
}

Box box(int i) { return {point(i), point(i) + 0.5f}; }
Sphere sphere(int i) { return {point(i), 0.25f}; }

// Whose depth cuts what follows.
TextureRegion volume() { return whole_texture().with_depth(0.25, 0.31); }

constexpr Triangle triangle{{{0.0f, 0.0f}, 1.0f, {0.1f, 0.2f, 0.3f, 1.0f}},
                            {{40.0f, 0.0f}, 3.0f, {2.9f, 0.5f, 0.75f, 2.0f}},
                            {{0.0f, 30.0f}, 2.0f, {0.5f, 1.5f, 0.25f, 1.5f}}};

template <std::size_t count>
[[gnu::noinline]] std::array<glm::vec3, count> points() {
    std::array<glm::vec3, count> result;
    for (std::size_t i = 0; i < count; ++i) result[i] = point(static_cast<int>(i));
    return result;
}
template <std::size_t count>
struct Columns {
    float x[count], y[count], z[count];
};
template <std::size_t count>
[[gnu::noinline]] Columns<count> columns() {
    Columns<count> result;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 at = point(static_cast<int>(i));
        result.x[i] = at.x;
        result.y[i] = at.y;
        result.z[i] = at.z;
    }
    return result;
}
struct Vertex {
    float position[3], other;
};
template <std::size_t count>
[[gnu::noinline]] std::array<Vertex, count> strided() {
    std::array<Vertex, count> result{};
    for (std::size_t i = 0; i < count; ++i)
        for (glm::length_t k = 0; k < 3; ++k) result[i].position[k] = point(static_cast<int>(i))[k];
    return result;
}
template <std::size_t count>
[[gnu::noinline]] std::array<float, count> fractions() {
    std::array<float, count> result;
    for (std::size_t i = 0; i < count; ++i) result[i] = (static_cast<float>(i) + 0.3f) / (count + 1);
    return result;
}
template <std::size_t count>
constexpr std::array<std::uint32_t, count> ids{};
template <std::size_t count, class Body>
[[gnu::noinline]] std::array<Body, count> bodies(Body (*body)(int)) {
    std::array<Body, count> result;
    for (std::size_t i = 0; i < count; ++i) result[i] = body(static_cast<int>(i));
    return result;
}
[[gnu::noinline]] std::optional<TriangleSetup> setup(Tolerance tolerance, const TextureRegion& region) {
    return TriangleSetup::of(triangle, region, tolerance);
}
[[gnu::noinline]] TriangleBatch batch(Tolerance tolerance) {
    TriangleBatch result(whole_texture(), tolerance);
    result.assign({&triangle, 1});
    return result;
}

}  // namespace
