// The bodies of surface.hpp.

namespace TEXGEN_DETAIL {

// det [s t q].
inline FloatDeterminant slide_determinant(const glm::dvec4& a, const glm::dvec4& b, const glm::dvec4& c) noexcept {
    return {{a.x, a.y, a.w}, {b.x, b.y, b.w}, {c.x, c.y, c.w}};
}

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {

inline Facing facing(glm::vec4 a, glm::vec4 b, glm::vec4 c, TextureOrigin origin) noexcept {
    const int sign = detail::slide_determinant(detail::widened(a), detail::widened(b), detail::widened(c)).sign();
    if (sign == 0) return Facing::edge_on;
    return (sign > 0) == (origin == TextureOrigin::bottom_left) ? Facing::towards : Facing::away;
}

inline std::optional<double> slide_area(glm::vec4 a, glm::vec4 b, glm::vec4 c) noexcept {
    if (!(a.w > 0.0f && b.w > 0.0f && c.w > 0.0f)) return std::nullopt;
    const glm::dvec4 first = detail::widened(a), second = detail::widened(b), third = detail::widened(c);
    const double area = 0.5 * detail::slide_determinant(first, second, third).value() / (first.w * second.w * third.w);
    return detail::is_finite(area) ? std::optional(area) : std::nullopt;
}

inline std::optional<glm::dvec3> receiver_plane(glm::vec4 a, glm::vec4 b, glm::vec4 c) noexcept {
    const glm::dvec4 corner[] = {detail::widened(a), detail::widened(b), detail::widened(c)};
    const double divisor = detail::slide_determinant(corner[0], corner[1], corner[2]).value();
    // Cramer's rule, with r in the place of a column.
    glm::dvec3 plane(0.0);
    for (glm::length_t k = 0; k < 3; ++k) {
        glm::dvec4 row[] = {corner[0], corner[1], corner[2]};
        for (glm::dvec4& v : row) v[k == 2 ? 3 : k] = v.z;
        plane[k] = detail::slide_determinant(row[0], row[1], row[2]).value() / divisor;
        if (!detail::is_finite(plane[k])) return std::nullopt;
    }
    return plane;
}

}  // namespace TEXGEN_NAMESPACE
