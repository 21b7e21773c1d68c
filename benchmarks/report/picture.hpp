#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace report {

// Where a picture shows nothing.
inline constexpr glm::vec3 backdrop(0.11f, 0.12f, 0.15f);

// Colours from 0 to 1, the top row first.
struct Picture {
    int width = 0, height = 0;
    std::vector<glm::vec3> pixels;

    Picture() = default;
    Picture(int columns, int rows, glm::vec3 colour)
        : width(columns),
          height(rows),
          pixels(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), colour) {}

    glm::vec3& at(int x, int y) { return pixels[index(x, y)]; }
    const glm::vec3& at(int x, int y) const { return pixels[index(x, y)]; }

    // Bilinear, clamped to the edge; (s, t) = (0, 0) is the bottom left corner, as OpenGL has it.
    glm::vec3 sample(float s, float t) const;

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

// A PNG or JPEG, reduced by a whole factor to at most 1024 pixels a side. Throws Failure for what is not one.
Picture load_picture(const std::filesystem::path& file);

std::string encode_png(const Picture& picture);

// With losses that the page's small pictures bear.
std::string encode_jpeg(const Picture& picture);

// At most so many pixels a side: each is the mean of what it covers, or as it is in the middle of that, where colours
// stand for numbers.
Picture reduced(const Picture& picture, int most);
Picture thinned(const Picture& picture, int most);

// The part of at most that size that begins at (x, y).
Picture cropped(const Picture& picture, int x, int y, int width, int height);

// A slide that shows where it is turned, mirrored or stretched: letters, an arrow, its corners' coordinates, a ruler in
// texels, and ramps along its sides. 1024 pixels square.
Picture built_in_slide();

// Small print and hairlines, two texels wide.
Picture fine_slide();

// The picture, of which the outermost pixels are white.
Picture with_white_border(const Picture& picture, int border);

}  // namespace report
