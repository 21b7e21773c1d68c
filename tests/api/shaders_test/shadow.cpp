// The README's shadow.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "api/shaders_test/comparison.hpp"
#include "api/shaders_test/readme.hpp"
#include "api/shaders_test/scenes.hpp"
#include "api/shaders_test/textures.hpp"
#include "support/opengl.hpp"
#include "support/random.hpp"

namespace shaded {

namespace {

TEST_CASE("the README's shadow compares r as the library computes it") {
    const gl::Context& g = gl::Context::or_skip();
    Random random(205);
    std::vector<float> depth(texel_count);
    for (float& value : depth) value = random.uniform_float(0.75, 1.0);
    bind_new_texture(g, gl::nearest);
    g.TexImage2D(gl::texture_2d, 0, static_cast<int>(gl::depth_component24), size, size, 0, gl::depth_component,
                 gl::float_type, depth.data());
    g.TexParameteri(gl::texture_2d, gl::texture_compare_mode, static_cast<int>(gl::compare_ref_to_texture));
    g.TexParameteri(gl::texture_2d, gl::texture_compare_func, static_cast<int>(gl::less_or_equal));
    for (const gl::Enum wrap : {gl::texture_wrap_s, gl::texture_wrap_t})
        g.TexParameteri(gl::texture_2d, wrap, static_cast<int>(gl::clamp_to_border));
    const glm::vec4 lit_border(1.0f);
    g.TexParameterfv(gl::texture_2d, gl::texture_border_color, &lit_border[0]);
    REQUIRE(g.GetError() == gl::no_error);

    std::size_t in_shadow = 0;
    const Expect expect = [&](const Scene&, const Fragment& fragment) -> std::optional<Expected> {
        if (fragment.behind) return Expected{glm::vec3(0.0f), 0.0};
        const auto column = texel(fragment.str.x, fragment.allowed.x), row = texel(fragment.str.y, fragment.allowed.y);
        if (!column || !row) return std::nullopt;
        const bool is_on_map = *column >= 0 && *column < size && *row >= 0 && *row < size;
        const double nearest =
            is_on_map ? static_cast<double>(depth[static_cast<std::size_t>(*row * size + *column)]) : 1.0;
        // What is compared with a depth of 24 bits is clamped as it is: beyond z_far there is light.
        const double behind_it = std::min(fragment.str.z - static_cast<double>(bias), 1.0) - nearest;
        if (std::fabs(behind_it) <= fragment.allowed.z) return std::nullopt;
        in_shadow += behind_it > 0.0;
        return Expected{behind_it > 0.0 ? glm::vec3(0.0f) : surface, 0.0};
    };
    judge(shadow, broken_vertices,
          {{"strq.q > 0.0 ? light : 0.0", "light"},
           {"bias * strq.q", "bias"},
           {"bias * strq.q", "0.0"},
           {"textureProj(depth_map, strq - ", "textureProj(depth_map, strq.tspq - "},
           {"surface * ", "vec3(1.0) * "}},
          expect, 205);
    CHECK(in_shadow > 5000);
}

}  // namespace

}  // namespace shaded
