#pragma once

// The textures that the shaders sample.

#include <doctest/doctest.h>

#include <cstddef>
#include <vector>

#include "support/opengl.hpp"

namespace shaded {

namespace gl = support::gl;

inline constexpr int size = 64, detailed = 1024;
inline constexpr std::size_t texel_count = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);

inline unsigned bind_new_texture(const gl::Context& g, gl::Enum filter) {
    unsigned texture = 0;
    g.GenTextures(1, &texture);
    g.BindTexture(gl::texture_2d, texture);
    g.TexParameteri(gl::texture_2d, gl::texture_min_filter, static_cast<int>(filter));
    g.TexParameteri(gl::texture_2d, gl::texture_mag_filter,
                    static_cast<int>(filter == gl::nearest ? gl::nearest : gl::linear));
    return texture;
}

// No two texels are equal, and none is the border.
inline glm::vec3 slide_texel(int column, int row) {
    return {static_cast<float>(column + 1) / size, static_cast<float>(row + 1) / size, 1.0f};
}

inline void bind_slide(const gl::Context& g) {
    bind_new_texture(g, gl::nearest);
    std::vector<glm::vec4> texels;
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) texels.emplace_back(slide_texel(column, row), 1.0f);
    g.TexImage2D(gl::texture_2d, 0, static_cast<int>(gl::rgba32f), size, size, 0, gl::rgba, gl::float_type,
                 texels.data());
    REQUIRE(g.GetError() == gl::no_error);
}

}  // namespace shaded
