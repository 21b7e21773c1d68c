#pragma once

// A triangle with a rectangle of fragments, where one stands about it, and how both are printed.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include <glm/vec2.hpp>

#include "support/random.hpp"
#include "support/triangles.hpp"
#include "texgen/primitives.hpp"

namespace support {

struct Shot {
    texgen::Triangle triangle;
    texgen::FragmentRect rect;

    // The fragment at a column and a row of the rectangle, which may reach beyond the range of int.
    std::int64_t x(std::int64_t column) const { return rect.x + column; }
    std::int64_t y(std::int64_t row) const { return rect.y + row; }

    // The i-th fragment, as outputs have them.
    struct Fragment {
        std::int64_t x, y;
    };
    Fragment fragment(std::size_t i) const {
        const auto at = static_cast<std::int64_t>(i);
        return {rect.x + at % rect.width, rect.y + at / rect.width};
    }
};

inline std::string text(const texgen::FragmentRect& rect) {
    return "{" + std::to_string(rect.x) + ", " + std::to_string(rect.y) + ", " + std::to_string(rect.width) + ", " +
           std::to_string(rect.height) + "}";
}
inline std::string hex(const Shot& shot) { return hex(shot.triangle) + ", " + text(shot.rect); }

inline std::array<texgen::WindowVertex*, 3> vertices(texgen::Triangle& triangle) {
    return {&triangle.a, &triangle.b, &triangle.c};
}
inline std::array<const texgen::WindowVertex*, 3> vertices(const texgen::Triangle& triangle) {
    return {&triangle.a, &triangle.b, &triangle.c};
}

namespace detail {

// A rectangle about a pixel, of every width that a vector's tail can have, and now and then a long row or a block.
inline texgen::FragmentRect rect_about(int x, int y, Random& random) {
    int width = random.integer(1, 67), height = random.integer(1, 2);
    const int shape = random.integer(0, 9);
    if (shape == 0) width = random.integer(68, 300), height = 1;
    if (shape == 1) width = random.integer(1, 9), height = random.integer(1, 12);
    return {x - random.integer(0, width - 1), y - random.integer(0, height - 1), width, height};
}

inline texgen::FragmentRect rect_near(const texgen::Triangle& triangle, Random& random) {
    const texgen::FragmentRect pixel = pixel_near(triangle, random);
    return rect_about(pixel.x, pixel.y, random);
}

// About a point of an edge where a coordinate is 0; its values at the ends of the edge have opposite signs.
inline texgen::FragmentRect rect_at_root(const texgen::Triangle& triangle, int coordinate, Random& random) {
    const auto corner = vertices(triangle);
    for (std::size_t i = 0; i < 3; ++i) {
        const texgen::WindowVertex& from = *corner[i];
        const texgen::WindowVertex& to = *corner[(i + 1) % 3];
        const double a = from.strq[coordinate] / static_cast<double>(from.clip_w);
        const double b = to.strq[coordinate] / static_cast<double>(to.clip_w);
        if (a * b >= 0.0) continue;
        const glm::dvec2 root =
            glm::dvec2(from.window) + (a / (a - b)) * (glm::dvec2(to.window) - glm::dvec2(from.window));
        return rect_about(pixel_of(root.x), pixel_of(root.y), random);
    }
    return rect_near(triangle, random);
}

}  // namespace detail

}  // namespace support
