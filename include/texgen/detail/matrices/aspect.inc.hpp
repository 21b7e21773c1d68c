// The bodies of contain() and cover() of projector.hpp.

namespace TEXGEN_DETAIL {

// Whether it is half of an angle that a lens may open by.
inline bool is_half_angle(double radians) noexcept { return radians > 0.0 && radians < 0.5 * std::numbers::pi; }
inline bool is_aspect(double aspect) noexcept { return aspect > 0.0 && is_finite(aspect); }

// The aspect of a rectangle. Large numbers are halved, so that no difference leaves the range; small ones stay exact.
double aspect_of(const auto& lens) noexcept {
    const double largest = larger(larger(std::fabs(lens.left), std::fabs(lens.right)),
                                  larger(std::fabs(lens.bottom), std::fabs(lens.top)));
    const double unit = largest < 0x1p1000 ? 1.0 : 0.5;
    return std::fabs((unit * lens.right - unit * lens.left) / (unit * lens.top - unit * lens.bottom));
}

// Narrows [low, high] to that fraction about its middle.
inline void narrow(double& low, double& high, double fraction) noexcept {
    const double cut = (0.5 - 0.5 * fraction) * high - (0.5 - 0.5 * fraction) * low;
    low += cut;
    high -= cut;
}

template <class RectangularLens>
RectangularLens contain_rectangle(const RectangularLens& given, double aspect) noexcept {
    RectangularLens lens = given;
    const double of_lens = aspect_of(lens);
    if (!is_aspect(aspect) || !is_aspect(of_lens))
        lens.left = lens.right = nan;
    else if (aspect < of_lens)
        narrow(lens.left, lens.right, aspect / of_lens);
    else
        narrow(lens.bottom, lens.top, of_lens / aspect);
    return lens;
}

inline TextureRegion cover_aspect(double of_lens, double aspect, const TextureRegion& picture) noexcept {
    glm::dvec2 low = (picture.min)(), high = (picture.max)();
    if (!is_aspect(aspect) || !is_aspect(of_lens)) return atlas_tile({nan, nan}, {nan, nan});
    if (aspect > of_lens)
        narrow(low.x, high.x, of_lens / aspect);
    else
        narrow(low.y, high.y, aspect / of_lens);
    const TextureRegion part = atlas_tile(low, high);
    const std::optional<glm::dvec2> depth = picture.depth();
    return depth ? part.with_depth(depth->x, depth->y) : part;
}

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {

inline PerspectiveLens contain(const PerspectiveLens& lens, double aspect) noexcept {
    PerspectiveLens result = lens;
    result.aspect = aspect;
    const double half_angle = 0.5 * lens.fovy.in_radians();
    if (!detail::is_aspect(lens.aspect)) result.aspect = lens.aspect;
    // An angle out of range keeps its number: by way of its tangent it could become one in range.
    if (aspect > lens.aspect && detail::is_half_angle(half_angle))
        result.fovy = radians(2.0 * std::atan(std::tan(half_angle) * (lens.aspect / aspect)));
    return result;
}
inline FrustumLens contain(const FrustumLens& lens, double aspect) noexcept {
    return detail::contain_rectangle(lens, aspect);
}
inline OrthographicLens contain(const OrthographicLens& lens, double aspect) noexcept {
    return detail::contain_rectangle(lens, aspect);
}

inline TextureRegion cover(const PerspectiveLens& lens, double aspect, const TextureRegion& picture) noexcept {
    return detail::cover_aspect(lens.aspect, aspect, picture);
}
inline TextureRegion cover(const FrustumLens& lens, double aspect, const TextureRegion& picture) noexcept {
    return detail::cover_aspect(detail::aspect_of(lens), aspect, picture);
}
inline TextureRegion cover(const OrthographicLens& lens, double aspect, const TextureRegion& picture) noexcept {
    return detail::cover_aspect(detail::aspect_of(lens), aspect, picture);
}

}  // namespace TEXGEN_NAMESPACE
