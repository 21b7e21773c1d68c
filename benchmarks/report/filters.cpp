#include "filters.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace report {

namespace {

// Each texel is the mean of the four that it covers; of an odd side the last row or column counts twice.
Picture halved(const Picture& from) {
    Picture to(std::max(1, from.width / 2), std::max(1, from.height / 2), glm::vec3(0));
    for (int y = 0; y < to.height; ++y) {
        for (int x = 0; x < to.width; ++x) {
            const int right = std::min(2 * x + 1, from.width - 1), below = std::min(2 * y + 1, from.height - 1);
            to.at(x, y) = 0.25f * (from.at(std::min(2 * x, right), std::min(2 * y, below)) +
                                   from.at(right, std::min(2 * y, below)) + from.at(std::min(2 * x, right), below) +
                                   from.at(right, below));
        }
    }
    return to;
}

float darkened_at_whole(float value) { return std::fabs(value - std::round(value)) < 0.03f ? 0.55f : 1.0f; }

}  // namespace

MipMap::MipMap(const Picture& picture) {
    levels_.push_back(picture);
    while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(halved(levels_.back()));
}

glm::vec3 MipMap::nearest(glm::vec2 st) const {
    const Picture& picture = levels_.front();
    const auto texel = [](float coordinate, int size) {
        return std::clamp(static_cast<int>(std::floor(coordinate * static_cast<float>(size))), 0, size - 1);
    };
    return picture.at(texel(st.x, picture.width), picture.height - 1 - texel(st.y, picture.height));
}

glm::vec3 MipMap::trilinear(glm::vec2 st, float level) const {
    const float last = static_cast<float>(levels_.size() - 1);
    const float within = level > 0.0f ? std::min(level, last) : 0.0f;  // a NaN is level 0
    const auto lower = static_cast<std::size_t>(within);
    const std::size_t upper = std::min(lower + 1, levels_.size() - 1);
    return glm::mix(levels_[lower].sample(st.x, st.y), levels_[upper].sample(st.x, st.y),
                    within - static_cast<float>(lower));
}

glm::vec3 MipMap::anisotropic(glm::vec2 st, const FilterFootprint& footprint, int most) const {
    const Picture& picture = levels_.front();
    const int probes =
        static_cast<int>(std::ceil(std::clamp(footprint.anisotropy, 1.0f, static_cast<float>(most)) - 0.001f));
    const glm::vec2 in_texels = footprint.major * glm::vec2(picture.width, picture.height);
    const float level = std::log2(glm::length(in_texels) / static_cast<float>(probes));
    glm::vec3 sum(0);
    for (int i = 0; i < probes; ++i) {
        const float along = (static_cast<float>(i) + 0.5f) / static_cast<float>(probes) - 0.5f;
        sum += trilinear(st + along * footprint.major, level);
    }
    return sum / static_cast<float>(probes);
}

glm::vec3 colour_of_level(float level) {
    constexpr glm::vec3 magnified(0.05f, 0.20f, 0.75f), even(0.97f), minified(0.98f, 0.80f, 0.15f),
        most(0.75f, 0.05f, 0.1f);
    const glm::vec3 colour = level < 0.0f   ? glm::mix(even, magnified, std::min(-level / 4.0f, 1.0f))
                             : level < 3.0f ? glm::mix(even, minified, level / 3.0f)
                                            : glm::mix(minified, most, std::min((level - 3.0f) / 4.0f, 1.0f));
    return colour * darkened_at_whole(level);
}

glm::vec3 colour_of_error(double texels) {
    constexpr glm::vec3 least(0.08f, 0.25f, 0.6f), middle(0.97f), most(0.75f, 0.05f, 0.1f);
    const float decades = std::log10(static_cast<float>(std::clamp(texels, 1e-4, 10.0))) + 4.0f;
    return decades < 2.5f ? glm::mix(least, middle, decades / 2.5f) : glm::mix(middle, most, decades / 2.5f - 1.0f);
}

glm::vec3 colour_of_anisotropy(float anisotropy) {
    const float octaves = std::log2(anisotropy);
    const glm::vec3 colour = octaves <= 4.0f ? glm::mix(glm::vec3(0.1f, 0.1f, 0.2f), glm::vec3(1.0f), octaves / 4.0f)
                                             : glm::vec3(0.85f, 0.1f, 0.1f);
    return colour * darkened_at_whole(octaves);
}

}  // namespace report
