// One footprint, the extremes of all, and the bodies of FootprintSetup. Included by footprint.hpp.

namespace TEXGEN_DETAIL {

inline bool is_usable(const TexelsPerUnit& texels) noexcept {
    return texels.s > 0x1p-200 && texels.s < 0x1p200 && texels.t > 0x1p-200 && texels.t < 0x1p200;
}

// A footprint from J and det J: where J is almost singular, det J has digits that J has lost. determinant(unit) is
// unit^2 det J, for a power of two that brings J near 1. So no square leaves the range of double.
Footprint footprint_of(const glm::dvec2& dx, const glm::dvec2& dy, const auto& determinant,
                       const TexelsPerUnit& texels) noexcept {
    const double largest_slope =
        larger_or_nan(larger_or_nan(std::fabs(dx.x), std::fabs(dx.y)), larger_or_nan(std::fabs(dy.x), std::fabs(dy.y)));
    if (!is_usable(texels) || !(largest_slope < infinity)) return {dx, dy, nan, {nan, nan}, nan, {nan, nan}};
    if (!(largest_slope > 0.0)) return {dx, dy, -infinity, {0.0, 0.0}, 1.0, {0.0, 0.0}};
    const double unit = reciprocal_power_of_two(smaller(larger(largest_slope, 0x1p-1000), 0x1p1000));
    const double s_dx = unit * dx.x * texels.s;
    const double t_dx = unit * dx.y * texels.t;
    const double s_dy = unit * dy.x * texels.s;
    const double t_dy = unit * dy.y * texels.t;
    const double size = larger(larger(std::fabs(s_dx), std::fabs(t_dx)), larger(std::fabs(s_dy), std::fabs(t_dy)));
    const double scale = reciprocal_power_of_two(size);
    const glm::dvec2 x(s_dx * scale, t_dx * scale), y(s_dy * scale, t_dy * scale);
    const auto [b, half, root, largest] = Spectrum(x, y);  // det^2 over the larger eigenvalue is the smaller
    const double det = std::fabs(determinant(unit) * (texels.s * scale) * (texels.t * scale));
    const double length = std::sqrt(largest);
    glm::dvec2 major{1.0, 0.0};
    if (root > 0.0) {
        major = half < 0.0 ? glm::dvec2(b, root - half) : glm::dvec2(half + root, b);
        major *= 1.0 / std::sqrt(major.x * major.x + major.y * major.y);
    }
    return {dx,
            dy,
            0.5 * std::log2(larger(glm::dot(x, x), glm::dot(y, y))) - (std::log2(scale) + std::log2(unit)),  // integers
            glm::dvec2(length, smaller(det / length, length)) / scale / unit,
            det > 0.0 ? larger(largest / det, 1.0) : infinity,
            glm::dvec2(major.x / texels.s, major.y / texels.t) * (length / scale) / unit};
}

// q at a fragment, its sign exact, within cancelled_share of itself; where the planes cancel, close_q() has it.
double q_at(const TriangleFunctions& triangle, std::int64_t x, std::int64_t y, const auto& close_q) noexcept {
    const auto is_known = [](const Bounded& q) { return std::fabs(q.value) * cancelled_share > q.error; };
    Bounded q = triangle.planes.at(triangle.q, x, y);
    if (is_known(q)) return q.value;
    q = close_q().at(x, y);
    if (is_known(q) || q.error == 0.0) return q.value;
    return ExactFragment(triangle.planes, x, y).function(3).estimate() * triangle.planes.factor();
}
inline double q_at(const TriangleFunctions& triangle, std::int64_t x, std::int64_t y) noexcept {
    return q_at(triangle, x, y, [&] { return CloseQ(triangle.planes, {x, y, 1, 1}); });
}

// The footprint of a fragment whose q is given.
inline std::optional<Footprint> footprint_at(const FootprintFunctions& functions, const TexelsPerUnit& texels,
                                             std::int64_t x, std::int64_t y, double q) noexcept {
    if (!(q > 0.0)) return std::nullopt;
    const FootprintJob::Slope s = functions.at_first(0, {x, y, 1, 1}), t = functions.at_first(1, {x, y, 1, 1});
    const double reciprocal = 1.0 / q;
    const auto divided = [&](double numerator) { return numerator * reciprocal * reciprocal; };
    return footprint_of(
        {divided(s.dx), divided(t.dx)}, {divided(s.dy), divided(t.dy)},
        [&](double unit) { return functions.determinant * reciprocal * (reciprocal * unit) * (reciprocal * unit); },
        texels);
}

// The extremes over a part of the window. Where the sign of its largest q is in doubt, are_behind() tells it.
template <class AreBehind>
std::optional<FootprintExtremes> extremes_over(const FootprintFunctions& functions, const TexelsPerUnit& texels,
                                               const WindowPolygon& polygon, const AreBehind& are_behind) noexcept {
    const auto& s = functions.slope[0];
    const auto& t = functions.slope[1];
    glm::dvec2 reach(0.0, 0.0);
    for (std::size_t i = 0; i < polygon.count(); ++i)
        for (glm::length_t axis = 0; axis < 2; ++axis) reach[axis] = larger(std::fabs(polygon[i][axis]), reach[axis]);
    const auto size_of = [&](const FootprintJob::Slope& magnitude, double texels_per_unit) {
        const double size = larger(magnitude.dx + reach.y * magnitude.twist, magnitude.dy + reach.x * magnitude.twist);
        return size > 0.0 ? larger(size * texels_per_unit, 0x1p-1000) : 0.0;
    };
    const Ramp& q = functions.triangle.q.value;
    const Ramp& q_magnitude = functions.triangle.q.magnitude;
    const double size = size_of(s.magnitude, texels.s) + size_of(t.magnitude, texels.t);
    const double q_size = q_magnitude.base + reach.x * q_magnitude.dx + reach.y * q_magnitude.dy;
    // Both are brought near 1, so that no fourth power leaves the range of double; J in texels is then `back` times
    // what the field says.
    const double scale = reciprocal_power_of_two(larger(size, 0x1p-700));
    const double q_scale = reciprocal_power_of_two(q_size);
    const double back = q_scale / scale * q_scale;
    const double back_levels = 2.0 * std::log2(q_scale) - std::log2(scale);  // where `back` itself is no normal number
    const auto scaled = [&](double of_s, double of_t) {
        return glm::dvec2(of_s * (texels.s * scale), of_t * (texels.t * scale));
    };
    const FootprintField field{scaled(s.value.dx, t.value.dx),
                               scaled(s.value.dy, t.value.dy),
                               scaled(s.value.twist, t.value.twist),
                               q.base * q_scale,
                               q.dx * q_scale,
                               q.dy * q_scale,
                               gamma(24) * size * scale,
                               gamma(24) * q_size * q_scale};
    const RangeOfQ range = range_of_q(field, polygon);
    if (range.largest <= -field.q_error || (range.largest <= field.q_error && are_behind())) return std::nullopt;
    if (!is_usable(texels)) return FootprintExtremes{nan, nan, nan, nan, nan};

    // Room in the bounds for the roundings of the footprints themselves: of level, and of area and anisotropy.
    constexpr double slack = 0x1p-15;
    const auto level = [&](double square, double outward) {
        if (square == 0.0) return -infinity;
        const double middle = 0.5 * std::log2(square) + back_levels;
        return middle + outward * slack * larger(1.0, std::fabs(middle) / 32.0);
    };
    const double determinant = std::fabs(functions.determinant * (texels.s * scale) * (texels.t * scale)) / q_scale;
    const auto area = [&](double at_q) { return determinant / (at_q * at_q * at_q) * back * back; };
    FootprintExtremes result{level(least_square_of_rho(field, polygon), -1.0), infinity,
                             area(range.largest + field.q_error) * (1.0 - slack), infinity, infinity};
    const double least_q = range.least - field.q_error;
    if (!(least_q > 0x1p20 * field.q_error)) return result;
    const double rho = std::sqrt(largest_square_of_rho(field, polygon)) * (1.0 + 4.0 * field.q_error / least_q);
    const double largest_rho = rho + field.error / (least_q * least_q);
    result.largest_level = level(largest_rho * largest_rho, 1.0);
    result.largest_area = area(least_q) * (1.0 + slack);
    // |L^ + e|^2 / Q <= (L^2 / Q) (1 + e / L)^2, L at its least where the ratio is 1: L^2 = |D| Q.
    const double relative = field.error / std::sqrt(determinant * least_q);
    const double anisotropy = largest_anisotropy(field, polygon) / determinant;
    if (relative < 0x1p-20) result.largest_anisotropy = larger(anisotropy * (1.0 + slack + 4.0 * relative), 1.0);
    return result;
}

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE_COMPILER {

inline Footprint footprint_of(const glm::dvec2& dx, const glm::dvec2& dy, const TexelsPerUnit& texels) noexcept {
    const auto determinant = [&](double unit) {
        return detail::difference_of_products(unit * dx.x, unit * dy.y, unit * dy.x, unit * dx.y);
    };
    return detail::footprint_of(dx, dy, determinant, texels);
}

inline FootprintSetup::FootprintSetup(const TriangleSetup& triangle, const TexelsPerUnit& texels) noexcept
    : functions_(detail::Inside::functions(triangle)), texels_(texels) {}

inline std::optional<Footprint> FootprintSetup::at(int x, int y) const noexcept {
    return detail::footprint_at(functions_, texels_, x, y, detail::q_at(functions_.triangle, x, y));
}

// A numerator N = N^ + e over (Q^ + f)^2: the error is at most (e + 2 |f| |N|/Q) / Q^2 but for squares of f/Q, below
// 2^-23 where the tile is well in front. Rounding adds 4 u |N|/Q^2, and half an ulp. Where the planes cancel anywhere
// in the tile f is what q_at() leaves at most.
inline glm::dvec2 FootprintSetup::error_bound(const FragmentRect& rect) const noexcept {
    if (rect.width <= 0 || rect.height <= 0) return {0.0, 0.0};
    const detail::Tile tile = detail::tile_of(rect);
    const detail::TileSurvey found = detail::survey(functions_.triangle, tile);
    const detail::Corners& at = found.at;
    if (at.all_behind()) return {0.0, 0.0};
    const double share = found.in_doubt.planes ? detail::cancelled_share : at.q_error * at.reciprocal;
    const auto bound = [&](std::size_t k) {
        if (!at.is_well_in_front()) return detail::infinity;
        const double numerator = functions_.largest(k, tile);
        const double error =
            functions_.error(k, tile) + 2.0 * share * numerator + 8.0 * detail::unit_roundoff_double * numerator;
        // Q^-2 may be beyond a double.
        const auto divided = [&](double n) { return n * at.reciprocal * at.reciprocal; };
        return detail::larger(functions_.triangle.tolerance,
                              1.001 * divided(error) + detail::half_ulp(divided(numerator)));
    };
    return {bound(0), bound(1)};
}

inline std::optional<FootprintExtremes> FootprintSetup::extremes(const FragmentRect& rect) const noexcept {
    if (rect.width <= 0 || rect.height <= 0) return std::nullopt;
    const glm::dvec2 first = functions_.triangle.planes.from_a({rect.x, rect.y, 1, 1});
    const glm::dvec2 last = first + glm::dvec2(rect.width - 1, rect.height - 1);
    detail::WindowPolygon polygon;
    polygon.add(first);
    polygon.add({last.x, first.y});
    polygon.add(last);
    polygon.add({first.x, last.y});
    const auto is_behind = [&](std::int64_t x, std::int64_t y) {
        return !(detail::q_at(functions_.triangle, rect.x + x, rect.y + y) > 0.0);
    };
    return detail::extremes_over(functions_, texels_, polygon, [&] {
        return is_behind(0, 0) && is_behind(rect.width - 1, 0) && is_behind(0, rect.height - 1) &&
               is_behind(rect.width - 1, rect.height - 1);
    });
}

inline std::optional<FootprintExtremes> FootprintSetup::extremes() const noexcept {
    detail::WindowPolygon polygon;
    polygon.add({0.0, 0.0});
    polygon.add(functions_.triangle.planes.to_b());
    polygon.add(functions_.triangle.planes.to_c());
    return detail::extremes_over(functions_, texels_, polygon, [&] {
        const auto is_behind = [&](std::size_t i) { return !(functions_.triangle.planes.vertex(i).strq.w > 0.0f); };
        return is_behind(0) && is_behind(1) && is_behind(2);
    });
}

inline double headlights(const Triangle& triangle) noexcept {
    const auto is_nearer = [](const WindowVertex& a, const WindowVertex& b) {
        return a.clip_w < b.clip_w || (a.clip_w == b.clip_w && a.strq.w > b.strq.w);
    };
    const WindowVertex* nearest = &triangle.a;
    const WindowVertex* farthest = &triangle.a;
    bool is_all_in_front = true;
    for (const WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c}) {
        const bool is_usable = vertex->clip_w > 0.0f && detail::is_finite(detail::widened(vertex->clip_w)) &&
                               detail::is_finite(detail::widened(vertex->strq.w));
        if (!is_usable) return detail::nan;
        if (is_nearer(*vertex, *nearest)) nearest = vertex;
        if (is_nearer(*farthest, *vertex)) farthest = vertex;
        is_all_in_front = is_all_in_front && vertex->strq.w > 0.0f;
    }
    const double near_q = detail::widened(nearest->strq.w);
    const double far_q = detail::widened(farthest->strq.w);
    if (!(near_q > 0.0)) return detail::nan;
    return is_all_in_front ? 1.5 * std::log2(near_q / far_q) : detail::infinity;
}

}  // namespace TEXGEN_NAMESPACE_COMPILER
