#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include <stb_easy_font.h>
#include <glm/common.hpp>

#include "picture.hpp"

namespace report {

namespace {

constexpr int side = 1024;
constexpr glm::vec3 ink(0.08f, 0.09f, 0.16f);

void fill(Picture& picture, int left, int top, int right, int bottom, glm::vec3 colour) {
    for (int y = std::max(top, 0); y < std::min(bottom, picture.height); ++y)
        for (int x = std::max(left, 0); x < std::min(right, picture.width); ++x) picture.at(x, y) = colour;
}

// Text of block letters, centred on a point; a letter is about 6 x 9 units of `scale` pixels.
void print(Picture& picture, std::string text, int centre_x, int centre_y, int scale, glm::vec3 colour) {
    struct Vertex {
        float x, y, z;
        unsigned char colour[4];
    };
    std::array<Vertex, 4096> vertices;
    const int quads = stb_easy_font_print(0, 0, text.data(), nullptr, vertices.data(), sizeof vertices);
    const int left = centre_x - stb_easy_font_width(text.data()) * scale / 2;
    const int top = centre_y - 4 * scale;
    const auto pixel = [scale](float unit) { return static_cast<int>(unit * static_cast<float>(scale)); };
    for (int quad = 0; quad < quads; ++quad) {
        const Vertex& min = vertices[static_cast<std::size_t>(4 * quad)];
        const Vertex& max = vertices[static_cast<std::size_t>(4 * quad + 2)];
        fill(picture, left + pixel(min.x), top + pixel(min.y), left + pixel(max.x), top + pixel(max.y), colour);
    }
}

// A checker of 64 texels, of another tint in each quarter, within ramps: red grows with s, green grows with t.
glm::vec3 background(int x, int y) {
    constexpr int frame = 32;
    const float s = (static_cast<float>(x) + 0.5f) / side;
    const float t = 1.0f - (static_cast<float>(y) + 0.5f) / side;
    if (std::min(y, side - 1 - y) < frame) return {s, 0.1f, 0.2f};
    if (std::min(x, side - 1 - x) < frame) return {0.1f, t, 0.2f};
    const glm::vec3 tint = y < side / 2
                               ? (x < side / 2 ? glm::vec3(1.0f, 0.83f, 0.45f) : glm::vec3(0.55f, 0.85f, 1.0f))
                               : (x < side / 2 ? glm::vec3(0.70f, 0.95f, 0.55f) : glm::vec3(1.0f, 0.68f, 0.78f));
    return (x / 64 + y / 64) % 2 == 0 ? tint : glm::mix(tint, glm::vec3(1), 0.55f);
}

void draw_arrow_up(Picture& picture, int centre_x, int top) {
    constexpr int head = 96;
    for (int row = 0; row < head; ++row)
        fill(picture, centre_x - row, top + row, centre_x + row + 1, top + row + 1, ink);
    fill(picture, centre_x - head / 3, top + head, centre_x + head / 3 + 1, top + 2 * head, ink);
}

}  // namespace

Picture built_in_slide() {
    Picture slide(side, side, glm::vec3(1));
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) slide.at(x, y) = background(x, y);

    draw_arrow_up(slide, side / 2, 140);
    print(slide, "UP", side / 2, 374, 8, ink);
    print(slide, "TEXGEN", side / 2, 520, 22, ink);

    print(slide, "s0 t1", 150, 80, 8, ink);
    print(slide, "s1 t1", side - 150, 80, 8, ink);
    print(slide, "s0 t0", 150, side - 80, 8, ink);
    print(slide, "s1 t0", side - 150, side - 80, 8, ink);
    print(slide, "LEFT", 150, 300, 8, ink);
    print(slide, "RIGHT", side - 160, 300, 8, ink);

    // Eight blocks of 64 texels, and strokes of 8 texels above them.
    for (int block = 0; block < 8; ++block) {
        const int left = side / 2 + (block - 4) * 64;
        fill(slide, left, 740, left + 64, 780, block % 2 == 0 ? ink : glm::vec3(1));
        for (int stroke = 0; stroke < 4; ++stroke)
            fill(slide, left + 16 * stroke, 710, left + 16 * stroke + 8, 740, ink);
    }
    print(slide, "64 TEXELS A BLOCK", side / 2, 820, 6, ink);
    return slide;
}

Picture fine_slide() {
    Picture slide(side, side, glm::vec3(1));
    for (int line = 0; line < side / 16; ++line) {
        const int middle = 16 * line + 8;
        if (line % 4 != 3) {
            const std::string words = "a slide as fine as small print, of letters with strokes one texel wide; ";
            print(slide, words + words + words.substr(0, 30), side / 2, middle, 1, ink);
        } else {
            for (int x = 0; x < side; x += 2) fill(slide, x, middle - 6, x + 1, middle + 6, {0.75f, 0.1f, 0.15f});
        }
    }
    return slide;
}

}  // namespace report
