#pragma once

// Digests of points and segments.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <texgen/interpolate.hpp>
#include <texgen/linear.hpp>
#include <texgen/texcoord.hpp>

#include "inputs.hpp"
#include "results.hpp"

namespace bits {

inline bool same_in_all_layouts = true;

inline std::uint64_t points(Classes& classes) {
    Random random(1);
    Digest digest;
    std::array<glm::vec3, most> vectors;
    std::array<float, most> x, y, z;
    std::array<float, 7 * most> strided;
    for (int round = 0; round < 12; ++round) {
        const Kind kind = kind_of(round);
        const texgen::WorldTexgen texgen(matrix(random, kind));
        const auto count = static_cast<std::size_t>(random.integer(500, static_cast<int>(most)));
        for (std::size_t i = 0; i < count; ++i) {
            const auto coordinate = [&] {
                return kind == Kind::zeros ? static_cast<float>(random.integer(-8, 8)) : random.unit() * 8.0f;
            };
            x[i] = strided[7 * i] = coordinate();
            y[i] = strided[7 * i + 1] = coordinate();
            z[i] = strided[7 * i + 2] = coordinate();
            vectors[i] = glm::vec3(x[i], y[i], z[i]);
        }
        const auto projected = [&](const texgen::Positions<texgen::World>& positions, texgen::TextureRegion region) {
            Outputs out(count);
            project(texgen, positions, region, out.spans());
            return out;
        };
        const texgen::Positions<texgen::World> layouts[] = {
            texgen::world_space(std::span<const glm::vec3>(vectors.data(), count)),
            texgen::world_space({x.data(), count}, {y.data(), count}, {z.data(), count}),
            texgen::world_space(strided.data(), count, 7 * sizeof(float))};
        const Outputs everywhere = projected(layouts[0], boundless);
        for (const auto& layout : layouts)
            same_in_all_layouts = same_in_all_layouts && projected(layout, boundless) == everywhere;
        add(digest, classes, everywhere, projected(layouts[0], texgen::whole_texture()));
        std::array<glm::vec2, most> st;
        project(texgen, layouts[0], std::span<glm::vec2>(st.data(), count));
        for (std::size_t i = 0; i < count; ++i)
            same_in_all_layouts = same_in_all_layouts && st[i].x == everywhere.s[i] && st[i].y == everywhere.t[i];
    }
    return digest.value();
}

// Forms of small integers are exact in double, so that their rounding is the only one.
inline std::uint64_t homogeneous_points(Classes& classes) {
    Random random(2);
    Digest digest;
    glm::dmat4 m;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) m[column][row] = random.integer(-(1 << 16), 1 << 16);
    std::array<glm::vec3, most> vectors;
    for (glm::vec3& v : vectors) {
        const float x = random.unit(), y = random.unit(), z = random.unit();
        v = glm::vec3(x, y, z);
    }
    std::array<glm::vec4, most> strq;
    generate(texgen::WorldTexgen(m), texgen::world_space(vectors), strq);
    for (const glm::vec4& v : strq) {
        for (int k = 0; k < 4; ++k) digest.add(v[k]);
        ++(v.w > 0.0f ? classes.lit : classes.behind);
    }
    return digest.value();
}

inline std::uint64_t segments(Classes& classes) {
    Random random(3);
    Digest digest;
    for (int round = 0; round < 60; ++round) {
        const Kind kind = kind_of(round);
        const glm::vec4 a = strq(random, kind), b = strq(random, kind);
        const texgen::Segment segment{a, b};
        const auto count = static_cast<std::size_t>(random.integer(1, 200));
        std::array<float, most> alpha;
        for (std::size_t i = 0; i < count; ++i)
            alpha[i] = kind == Kind::any ? static_cast<float>(random.integer(0, 1 << 24)) * 0x1p-24f
                                         : static_cast<float>(random.integer(0, 24)) * 0x1p-5f;
        alpha[0] = static_cast<float>(round % 2);
        const auto interpolated = [&](texgen::TextureRegion region) {
            Outputs out(count);
            interpolate(segment, std::span<const float>(alpha.data(), count), region, out.spans());
            return out;
        };
        add(digest, classes, interpolated(boundless), interpolated(texgen::whole_texture()));
    }
    return digest.value();
}

}  // namespace bits
