// the planes of a slide as five, whatever depth its region has
#include <array>

#include <texgen/clip.hpp>

using namespace texgen;

void set_clip_plane(const glm::vec4& plane);

void set_clip_planes(const EyeTexgen& texgen, const TextureRegion& region) {
#ifndef MISUSE
    for (const glm::vec4& plane : clip_planes(texgen, region.with_depth())) set_clip_plane(plane);
#else
    const std::array<glm::vec4, 5> planes = clip_planes(texgen, region.with_depth());
    for (const glm::vec4& plane : planes) set_clip_plane(plane);
#endif
}
