// Polygons at the camera's near plane, and their vertices in the window.

namespace TEXGEN_DETAIL {

// The signed distance of a homogeneous point from a clipping plane, in any unit; inside is >= 0, and the sign is exact.
struct ClipDistance {
    double z, w, offset;

    // From the near plane z = -w, z = 0 or (reversed) z = w.
    static ClipDistance from_near(DepthRange range, bool reversed_depth) noexcept {
        if (reversed_depth) return {-1.0, 1.0, 0.0};
        return {1.0, range == DepthRange::negative_one_to_one ? 1.0 : 0.0, 0.0};
    }
    // In front of the eye w > 0, so that w is at least the smallest float. (That is a double: where subnormal floats
    // count as 0 the float would be 0.)
    static ClipDistance from_eye() noexcept { return {0.0, 1.0, 0x1p-149}; }

    double operator()(const ClipVertex& vertex) const noexcept {
        return z * widened(vertex.position.z) + w * widened(vertex.position.w) - offset;
    }

    // The w at which an edge crosses a near plane. It is computed from two products of floats, which are exact, so that
    // it has all its digits where it is small beside the w of both ends.
    float crossing_w(const ClipVertex& inside, const ClipVertex& outside) const noexcept {
        const double z_inside = widened(inside.position.z), w_inside = widened(inside.position.w);
        const double z_outside = widened(outside.position.z), w_outside = widened(outside.position.w);
        const double crossing = z * (z_inside * w_outside - z_outside * w_inside);
        return static_cast<float>(crossing / ((*this)(inside) - (*this)(outside)));
    }
    // The z of a near plane for this w. As it is set, and not computed, it cannot be rounded to the other side.
    float depth_on_plane(float given_w) const noexcept { return static_cast<float>(0.0 - z * w) * given_w; }
};

inline float between(double weight_a, float a, double weight_b, float b) noexcept {
    return static_cast<float>(std::fma(weight_a, widened(a), weight_b * widened(b)) / (weight_a + weight_b));
}

// (weight_a a + weight_b b) / (weight_a + weight_b) for weights >= 0, each component rounded once. std::fma, so that no
// compiler contracts the two products in different ways on the two sides of a shared edge.
inline ClipVertex between(double weight_a, const ClipVertex& a, double weight_b, const ClipVertex& b) noexcept {
    ClipVertex result{};
    for (glm::length_t i = 0; i < 4; ++i) {
        result.position[i] = between(weight_a, a.position[i], weight_b, b.position[i]);
        result.strq[i] = between(weight_a, a.strq[i], weight_b, b.strq[i]);
    }
    return result;
}

// The w, or q, at which an edge that leads behind is cut: a small part of that of its end in front, and above 0 also
// where subnormal numbers count as 0.
inline float just_in_front(float inside) noexcept {
    constexpr float least = 0x1p-126f;
    const float part = 0x1p-20f * inside;
    return part > least ? part : inside < least ? inside : least;
}

// Cuts the convex polygon in storage[0, count) and returns the new count. cut(inside, outside) makes the new vertex of
// an edge. As it gets the ends by their sides, not in the order of the walk, it makes the same one for both neighbours.
std::size_t cut_convex(const std::span<ClipVertex>& storage, std::size_t count, const ClipDistance& distance,
                       const auto& cut) noexcept {
    std::size_t inside = 0;
    std::size_t entries = 0;  // edges that lead from the outside in
    std::size_t entry = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (distance(storage[i]) >= 0.0) {
            ++inside;
        } else if (distance(storage[i + 1 < count ? i + 1 : 0]) >= 0.0) {
            ++entries;
            entry = i;
        }
    }
    if (inside == count) return count;
    // Here nothing is inside, or the polygon is not convex, or there is no room.
    if (entries != 1 || inside + 2 > storage.size()) return 0;
    // A rotation; <algorithm> would take every user longer to compile than all of this header.
    const auto reverse = [storage](std::size_t begin, std::size_t end) {
        for (; begin + 1 < end; ++begin, --end) std::swap(storage[begin], storage[end - 1]);
    };
    reverse(0, entry);
    reverse(entry, count);
    reverse(0, count);

    // Now storage[0] is outside, storage[1 .. inside] are inside, and the rest is outside.
    const ClipVertex before = storage[0];
    const ClipVertex after = storage[inside + 1 < count ? inside + 1 : 0];
    const ClipVertex last = storage[inside];
    std::size_t written = 0;
    if (distance(storage[1]) > 0.0) storage[written++] = cut(storage[1], before);
    for (std::size_t i = 1; i <= inside; ++i) storage[written++] = storage[i];
    if (distance(last) > 0.0) storage[written++] = cut(last, after);
    return written < 3 ? 0 : written;
}

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE_COMPILER {

inline WindowVertex to_window(const ClipVertex& vertex, const Viewport& viewport) noexcept {
    TEXGEN_ASSERT(vertex.position.w > 0.0f);
    const auto along = [w = detail::widened(vertex.position.w)](float clip, int first, int size) {
        const double half = 0.5 * size;
        return static_cast<float>(std::fma(half, detail::widened(clip) / w, first + half));
    };
    return {
        {along(vertex.position.x, viewport.x, viewport.width), along(vertex.position.y, viewport.y, viewport.height)},
        vertex.position.w,
        vertex.strq};
}

inline std::size_t clip_to_near(const std::span<const ClipVertex>& polygon, const std::span<ClipVertex>& out,
                                DepthRange range, bool reversed_depth) noexcept {
    TEXGEN_ASSERT(out.size() > polygon.size());
    if (out.size() <= polygon.size() || polygon.size() < 3) return 0;
    const auto near_plane = detail::ClipDistance::from_near(range, reversed_depth);
    bool any_in_front = false;
    bool any_behind = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        if (!detail::is_finite(polygon[i].position)) return 0;
        out[i] = polygon[i];
        any_in_front = any_in_front || near_plane(out[i]) > 0.0;
        any_behind = any_behind || near_plane(out[i]) < 0.0;
    }
    if (any_behind && !any_in_front) return 0;
    const auto cut_at_near = [&](const ClipVertex& inside, const ClipVertex& outside) {
        ClipVertex cut = detail::between(-near_plane(outside), inside, near_plane(inside), outside);
        cut.position.w = near_plane.crossing_w(inside, outside);
        cut.position.z = near_plane.depth_on_plane(cut.position.w);
        return cut;
    };
    const std::size_t count = detail::cut_convex(out, polygon.size(), near_plane, cut_at_near);

    // The terms of w are at most 2^20 times w, so that double errs by 2^-33 of it and the nearest float is the w aimed
    // at. For the same reason z stays in front of the near plane, as both ends are.
    const auto cut_before_eye = [](const ClipVertex& inside, const ClipVertex& outside) {
        const double w = detail::widened(detail::just_in_front(inside.position.w));
        return detail::between(w - detail::widened(outside.position.w), inside, detail::widened(inside.position.w) - w,
                               outside);
    };
    return detail::cut_convex(out, count, detail::ClipDistance::from_eye(), cut_before_eye);
}

}  // namespace TEXGEN_NAMESPACE_COMPILER
