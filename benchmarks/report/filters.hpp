#pragma once

// The filters of graphics hardware on a picture, driven by footprints.

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "picture.hpp"

namespace report {

// What a fragment's footprint says to a filter, in units of s and t and in texels of level 0.
struct FilterFootprint {
    float level, anisotropy;
    glm::vec2 major;  // the longer half axis, in units of s and t
};

// A picture and its halves down to one texel. Coordinates are clamped to the edge.
class MipMap {
public:
    explicit MipMap(const Picture& picture);

    glm::vec3 nearest(glm::vec2 st) const;
    glm::vec3 trilinear(glm::vec2 st, float level) const;
    // The mean of up to `most` trilinear probes along the major axis, of the level where each is as wide as its share.
    // Source: EXT_texture_filter_anisotropic.
    glm::vec3 anisotropic(glm::vec2 st, const FilterFootprint& footprint, int most = 16) const;

private:
    std::vector<Picture> levels_;
};

// The level of detail as a colour: blue where the picture is magnified, white at one texel a pixel, from yellow to red
// where it is minified, and a dark line at each whole level.
glm::vec3 colour_of_level(float level);

// An error as a colour: blue up to 1e-4 texel, white at 1/30, red from 10 texels on.
glm::vec3 colour_of_error(double texels);

// The anisotropy as a colour: black at 1, white at 16, red beyond, and a dark line at each power of two.
glm::vec3 colour_of_anisotropy(float anisotropy);

}  // namespace report
