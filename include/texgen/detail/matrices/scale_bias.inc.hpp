// The bodies of scale_bias.hpp.

namespace TEXGEN_DETAIL {

// Per coordinate: texture = at_minus_w * (w - c)/2 + at_plus_w * (w + c)/2, c the clip coordinate. The two ends say
// everything about the conventions.
struct RemapEnds {
    double at_minus_w, at_plus_w;

    constexpr double scale() const noexcept { return 0.5 * at_plus_w - 0.5 * at_minus_w; }
    constexpr double bias() const noexcept { return 0.5 * at_plus_w + 0.5 * at_minus_w; }
};

// The ends of s, t and r.
constexpr std::array<RemapEnds, 3> texture_remap(const Conventions& conventions, const TextureRegion& region,
                                                 DepthMapping depth) noexcept {
    // t grows with the clip y where the corner that (s, t) = (0, 0) addresses is where clip y is -w.
    const bool t_follows_y = (conventions.ndc_y == NdcY::up) == (conventions.origin == TextureOrigin::bottom_left);
    const RemapEnds up{(region.min)().y, (region.max)().y};
    const RemapEnds down{(region.max)().y, (region.min)().y};
    const bool halve_depth = depth == DepthMapping::unit && conventions.depth == DepthRange::negative_one_to_one;
    return {RemapEnds{(region.min)().x, (region.max)().x}, t_follows_y ? up : down,
            halve_depth ? RemapEnds{0.0, 1.0} : RemapEnds{-1.0, 1.0}};
}

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {

inline ScaleBias scale_bias(const Conventions& conventions, const TextureRegion& region, DepthMapping depth) noexcept {
    const auto [s, t, r] = detail::texture_remap(conventions, region, depth);
    glm::dmat4 matrix(1.0);
    matrix[0].x = s.scale();
    matrix[1].y = t.scale();
    matrix[2].z = r.scale();
    matrix[3] = {s.bias(), t.bias(), r.bias(), 1.0};
    return ScaleBias(matrix);
}

inline glm::vec4 to_texture(const glm::vec4& projector_clip, const Conventions& conventions,
                            const TextureRegion& region, DepthMapping depth) noexcept {
    const auto [s, t, r] = detail::texture_remap(conventions, region, depth);
    const glm::dvec4 clip = detail::widened(projector_clip);
    const auto component = [w = clip.w](double coordinate, const detail::RemapEnds& ends) {
        return static_cast<float>(ends.at_minus_w * (0.5 * (w - coordinate)) +
                                  ends.at_plus_w * (0.5 * (w + coordinate)));
    };
    return {component(clip.x, s), component(clip.y, t), component(clip.z, r), projector_clip.w};
}

}  // namespace TEXGEN_NAMESPACE
