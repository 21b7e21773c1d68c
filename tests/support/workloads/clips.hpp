#pragma once

// Workloads of clips, and of vertices that go to the window.

#include <array>
#include <limits>

#include <glm/vec4.hpp>

#include "support/random.hpp"
#include "support/stopwatch.hpp"
#include "support/workloads/numbers.hpp"
#include "texgen/clip.hpp"

namespace support::detail {

inline Numbers ordinary_polygon(Random& random) {
    Numbers n;
    for (int i = 0; i < 3; ++i) {
        const float w = random.uniform_float(1.0, 4.0);
        put(n, glm::vec4(random.vector3(1.0) * w, w));
        if (i == 0) n[2] = -1.5 * n[3];  // one corner behind
        for (const double x : ordinary_strq(random)) n.push_back(x);
        n[n.size() - 4] *= i == 0 ? 2.0 : 1.0;
    }
    for (double& x : n) x = static_cast<double>(to_float(x));
    return n;
}
inline constexpr Inputs polygon_inputs{24, ordinary_polygon, any_numbers<24>, strq_inputs.words};
// Of a camera and of slides as they are, as is_of_a_scene() has them.
template <bool ToNear, texgen::TextureRegion (&Region)() = texgen::whole_texture>
Calls clip_calls(const Numbers& n) {
    Reader reader(n);
    std::array<texgen::ClipVertex, 3> polygon{};
    for (texgen::ClipVertex& vertex : polygon) {
        vertex.position = reader.vec4();
        vertex.strq = reader.vec4();
        if (!is_of_a_scene(vertex.position) || !is_of_a_scene(vertex.strq)) return {};
    }
    return calls_of([polygon, out = std::array<texgen::ClipVertex, 12>{}]() mutable {
        if constexpr (ToNear)
            keep(texgen::clip_to_near(polygon, out, texgen::DepthRange::negative_one_to_one));
        else
            keep(texgen::clip_to_slide(polygon, Region(), out));
    });
}
inline Calls to_window_calls(const Numbers& n) {
    Reader reader(n);
    const glm::vec4 position = reader.vec4(), strq = reader.vec4();
    if (!(position.w >= std::numeric_limits<float>::min())) return {};  // in every state of subnormal numbers
    return calls_of([position, strq] { keep(texgen::to_window({position, strq}, {0, 0, 1024, 768})); });
}

}  // namespace support::detail
