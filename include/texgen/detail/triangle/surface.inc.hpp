// The bodies of surface.hpp.

namespace TEXGEN_DETAIL {

// det [s t q].
inline FloatDeterminant slide_determinant(const glm::dvec4& a, const glm::dvec4& b, const glm::dvec4& c) noexcept {
    return {{a.x, a.y, a.w}, {b.x, b.y, b.w}, {c.x, c.y, c.w}};
}

// The corners of a strictly convex quadrilateral, with the areas that say what its q are. Of homogeneous corners P_i =
// (x, y, 1) the homography takes T_i = (s, t, 1) to area_i P_i, as area_0 P_0 - area_1 P_1 + area_2 P_2 - area_3 P_3 =
// 0 and T_0 - T_1 + T_2 - T_3 = 0: q_i is 1 / area_i, up to a factor.
class ConvexQuadrilateral {
public:
    explicit ConvexQuadrilateral(const std::array<glm::dvec2, 4>& corners) noexcept : corner_(corners) {
        const auto is_in_range = [](double x) {
            return x == 0.0 || (magnitude(x) >= 0x1p-400 && magnitude(x) <= 0x1p400);
        };
        for (const glm::dvec2& corner : corners)
            if (!is_in_range(corner.x) || !is_in_range(corner.y)) return;
        for (std::size_t i = 0; i < 4; ++i)
            area_[i] = twice_area(corners[(i + 1) % 4], corners[(i + 2) % 4], corners[(i + 3) % 4]);
        winding_ = area_[0] < 0.0 ? -1.0 : 1.0;
        for (double& area : area_) area *= winding_;
        least_area_ = smaller(smaller(area_[0], area_[1]), smaller(area_[2], area_[3]));
    }

    // If not, as where corners are out of range, nothing else is asked.
    bool is_convex() const noexcept { return least_area_ > 0.0; }

    double q(std::size_t i) const noexcept { return least_area_ / area_[i]; }

    // The linear function that is 0 on a side and q on the opposite one: x, y and a constant. q may be as small as
    // 2^-1700, and the rest as large as 2^900: no product leaves the doubles before all of it does.
    glm::dvec3 from_side(std::size_t i) const noexcept {
        const glm::dvec2 &from = corner_[i], &to = corner_[(i + 1) % 4];
        const glm::dvec3 line(from.y - to.y, to.x - from.x, difference_of_products(from.x, to.y, to.x, from.y));
        const double area = area_[(i + 2) % 4];
        return winding_ / area_[(i + 3) % 4] * line * (least_area_ / smaller(area, 1.0)) / larger(area, 1.0);
    }

private:
    std::array<glm::dvec2, 4> corner_;
    std::array<double, 4> area_{};  // twice the area of the triangle of the other corners
    double winding_ = 1.0, least_area_ = 0.0;
};

// (u q, v q, 0, q) for a corner of the region, such that the quotients are u and v.
inline glm::vec4 strq_of_corner(float u, float v, float nearest_q) noexcept {
    const auto times_q = [](float coordinate, float q) { return static_cast<float>(widened(coordinate) * widened(q)); };
    const auto is_exact = [&](float coordinate, float q) { return times_q(coordinate, q) / q == coordinate; };
    float q = nearest_q;
    for (const int ulps : {0, 1, -1, 2, -2}) {
        const auto neighbour = bit_cast<float>(bit_cast<std::uint32_t>(nearest_q) + static_cast<std::uint32_t>(ulps));
        if (!is_exact(u, neighbour) || !is_exact(v, neighbour)) continue;
        q = neighbour;
        break;
    }
    return {times_q(u, q), times_q(v, q), 0.0f, q};
}

// Whether a product with q, which is no normal float, has lost digits of the other factor.
inline bool is_lost(float product, float factor) noexcept { return factor != 0.0f && std::fabs(product) < 0x1p-126f; }

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {

inline Facing facing(const glm::vec4& a, const glm::vec4& b, const glm::vec4& c, TextureOrigin origin) noexcept {
    const int sign = detail::slide_determinant(detail::widened(a), detail::widened(b), detail::widened(c)).sign();
    if (sign == 0) return Facing::edge_on;
    return (sign > 0) == (origin == TextureOrigin::bottom_left) ? Facing::towards : Facing::away;
}

inline std::optional<double> slide_area(const glm::vec4& a, const glm::vec4& b, const glm::vec4& c) noexcept {
    if (!(a.w > 0.0f && b.w > 0.0f && c.w > 0.0f)) return std::nullopt;
    const glm::dvec4 first = detail::widened(a), second = detail::widened(b), third = detail::widened(c);
    const double area = 0.5 * detail::slide_determinant(first, second, third).value() / (first.w * second.w * third.w);
    return detail::is_finite(area) ? std::optional(area) : std::nullopt;
}

inline std::optional<glm::dvec3> receiver_plane(const glm::vec4& a, const glm::vec4& b, const glm::vec4& c) noexcept {
    const glm::dvec4 corner[] = {detail::widened(a), detail::widened(b), detail::widened(c)};
    const double divisor = detail::slide_determinant(corner[0], corner[1], corner[2]).value();
    if (divisor == 0.0) return std::nullopt;
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

inline std::optional<std::array<glm::vec4, 4>> quadrilateral(const std::array<glm::dvec2, 4>& corners,
                                                             const TextureRegion& region) noexcept {
    const detail::ConvexQuadrilateral shape(corners);
    if (!shape.is_convex()) return std::nullopt;
    const glm::vec2 least{(region.min)()}, greatest{(region.max)()};
    std::array<glm::vec4, 4> strq{};
    for (std::size_t i = 0; i < 4; ++i) {
        const auto q = static_cast<float>(shape.q(i));
        const float u = i == 1 || i == 2 ? greatest.x : least.x, v = i >= 2 ? greatest.y : least.y;
        if (!(q >= 0x1p-126f)) return std::nullopt;
        strq[i] = detail::strq_of_corner(u, v, q);
        if (detail::is_lost(strq[i].x, u) || detail::is_lost(strq[i].y, v)) return std::nullopt;
    }
    return strq;
}

inline std::optional<WindowTexgen> keystone(const std::array<glm::dvec2, 4>& corners,
                                            const TextureRegion& region) noexcept {
    const detail::ConvexQuadrilateral shape(corners);
    if (!shape.is_convex()) return std::nullopt;
    const glm::dvec3 from_bottom = shape.from_side(0), from_right = shape.from_side(1), from_top = shape.from_side(2),
                     from_left = shape.from_side(3);
    const glm::dvec2 &least = (region.min)(), &greatest = (region.max)();
    const glm::dvec3 s = least.x * from_right + greatest.x * from_left,
                     t = least.y * from_top + greatest.y * from_bottom, q = from_right + from_left;
    const glm::dmat4 matrix(s.x, t.x, 0.0, q.x, s.y, t.y, 0.0, q.y, 0.0, 0.0, 0.0, 0.0, s.z, t.z, 0.0, q.z);
    return detail::is_finite(matrix) ? std::optional(WindowTexgen(matrix)) : std::nullopt;
}

}  // namespace TEXGEN_NAMESPACE
