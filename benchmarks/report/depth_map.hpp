#pragma once

// What a projector sees, by the library's r alone, and which fragments that leaves in shadow.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <texgen/conventions.hpp>

#include "picture.hpp"
#include "rasterizer.hpp"

namespace report {

// Of each texel of the projector's window the least r, and the triangle that has it there. The bottom row is the first.
struct DepthMap {
    static constexpr std::uint32_t nothing = 0xffffffff;

    int width, height;
    std::vector<float> r;                 // infinite where nothing is
    std::vector<std::uint32_t> triangle;  // its DrawnTriangle::source

    std::size_t texel_at(float s, float t) const;
};

// Of what is beyond the projector's near plane. The slide is the whole texture, r runs from 0 to 1.
DepthMap make_depth_map(std::span<const Surface> surfaces, const Camera& projector, int width, int height);

// From light at the near plane to dark at the far one, with a line at each tenth of r. What is beyond is red. The key
// says so of the colours that there are.
Picture picture_of(const DepthMap& map);
std::string key_of(const DepthMap& map);

// What r may exceed a texel's without being in shadow: one number, or what the plane of the triangle climbs to the
// texel's corner.
struct Shadow {
    std::shared_ptr<const DepthMap> map;
    std::optional<double> constant_bias;
};

// The climb of a triangle, by texgen::receiver_plane(); infinite where the projector sees it edge on.
double climb(const texgen::Triangle& triangle, const DepthMap& map);

// Whether the slide reaches a triangle's fragments: not its back, nor what lies behind something else.
class ShadowTest {
public:
    ShadowTest(const Shadow& shadow, const DrawnTriangle& triangle);

    bool is_lit(float s, float t, float r) const { return faces_projector_ && r <= nearest(s, t) + bias_; }
    bool is_shadowed_by_itself(float s, float t, float r) const;

private:
    double nearest(float s, float t) const { return static_cast<double>(map_.r[map_.texel_at(s, t)]); }

    const DepthMap& map_;
    std::uint32_t source_;
    double bias_;
    bool faces_projector_;  // with the side that the camera sees
};

// Of the covered fragments that the slide falls on: those that are lit by the planes of their triangles, those of them
// that are dark by the shadow's bias, and those that the bias lets their own triangle shadow.
struct ShadowCount {
    std::size_t lit = 0, lost = 0, by_themselves = 0;
};
ShadowCount count_shadows(const Shadow& shadow, const Workload& work, const texgen::TextureRegion& region);

}  // namespace report
