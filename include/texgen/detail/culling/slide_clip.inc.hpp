// Polygons at the planes of the slide: in double, in two doubles, and at last exactly; and the planes of a matrix.

namespace TEXGEN_DETAIL {

// The signed distance of (s, t, r, q) from a plane of the slide: sign (u - bound q), in any unit; inside is >= 0.
class SlideDistance {
public:
    explicit SlideDistance(const SlidePlane& plane) noexcept
        : coordinate_(plane.coordinate),
          sign_(plane.sign * unit_of(plane.bound)),
          per_q_(-sign_ * std::copysign(smaller(std::fabs(plane.bound), 0x1p1000), plane.bound)) {
        const bool has_29_digits = leading_bits<29>(per_q_) == per_q_;  // then its product with a float is exact
        product_error_ = has_29_digits ? 0.0 : gamma(1);
    }

    // The error is the rounding of the product and of the sum.
    Bounded operator()(const ClipVertex& vertex) const noexcept {
        const double product = of_q(vertex);
        const double value = own(vertex) + product;
        return {value, gamma(1) * std::fabs(value) + product_error_ * std::fabs(product)};
    }

    // The distance in two doubles, within `error`: 0 unless the digits are too far apart.
    struct Close {
        DoubleDouble value;
        double error;
    };
    Close closely(const ClipVertex& vertex) const noexcept {
        const DoubleDouble product = two_product(per_q_, widened(vertex.strq.w));
        const DoubleDouble sum = two_sum(own(vertex), product.high);
        const DoubleDouble low = two_sum(sum.low, product.low);
        return {two_sum(sum.high, low.high), std::fabs(low.low)};
    }

    Expansion<3> exactly(const ClipVertex& vertex) const noexcept {
        Expansion<3> sum;
        sum.add(own(vertex));
        sum.add_product(per_q_, widened(vertex.strq.w));
        return sum;
    }

    // The sign of the exact distance. A rounded sum has the sign of its terms' sum. Where that is below the error of
    // the product the sum is exact, by cancellation, and only what the product lost is missing.
    int sign(const ClipVertex& vertex) const noexcept {
        const double product = of_q(vertex);
        double value = own(vertex) + product;
        if (!(std::fabs(value) >= product_error_ * std::fabs(product)))
            value += two_product(per_q_, widened(vertex.strq.w)).low;
        return sign_of(value);
    }

private:
    double own(const ClipVertex& vertex) const noexcept { return sign_ * widened(vertex.strq[coordinate_]); }
    double of_q(const ClipVertex& vertex) const noexcept { return per_q_ * widened(vertex.strq.w); }

    // A unit in which no product with floats, whose |u/q| is in [2^-277, 2^277] or 0, leaves the range of double.
    // (Sides beyond 2^1000, and infinite ones, are taken as 2^1000: no float shows the difference.)
    static double unit_of(double side) noexcept {
        const double size = std::fabs(side);
        if (size > 0x1p300) return 0x1p-600;
        return size < 0x1p-300 && size > 0.0 ? 0x1p600 : 1.0;
    }

    glm::length_t coordinate_;
    double sign_, per_q_;   // in that unit
    double product_error_;  // relative
};

// Where the edge from a vertex inside to one outside crosses the side: (d_i outside - d_o inside) / (d_i - d_o) with
// d_i > 0 > d_o. It finds the nearest float to a component of which double leaves that open, by the sign of d_i
// (outside - m) - d_o (inside - m) for the middle m of two floats: in two doubles, or exactly.
class CloseCrossing {
public:
    CloseCrossing(const SlideDistance& side, const ClipVertex& inside, const ClipVertex& outside) noexcept
        : side_(side),
          inside_(inside),
          outside_(outside),
          of_inside_(side.closely(inside)),
          of_outside_(side.closely(outside)) {}

    // The float nearest to a component of the new vertex: i inside and o outside. `quotient` errs by `error` at most.
    float nearest(double i, double o, double quotient, double error) const noexcept {
        if (!(error <= 0x1p-26 * std::fabs(quotient))) {
            const Bounded sum = beyond(0.0, i, o);
            const bool is_close = sum.error <= 0x1p-50 * std::fabs(sum.value);
            quotient = (is_close ? sum.value : exactly_beyond(0.0, i, o).estimate()) /
                       (of_inside_.value.high - of_outside_.value.high);
            if (quotient == 0.0) return 0.0f;
            error = 0x1p-48 * std::fabs(quotient);
        }
        return nearest_to(quotient, error, [&](double middle) {
            const Bounded sum = beyond(middle, i, o);
            if (sum.error > 0.0 && std::fabs(sum.value) <= sum.error) return exactly_beyond(middle, i, o).sign();
            return sign_of(sum.value);
        });
    }

private:
    // d_i (o - middle) - d_o (i - middle). Products and their difference are within 2^-103 of their terms, and exact
    // where each factor is one double.
    Bounded beyond(double middle, double i, double o) const noexcept {
        const DoubleDouble to_i = two_sum(i, -middle);
        const DoubleDouble to_o = two_sum(o, -middle);
        const DoubleDouble from_i = product(of_outside_.value, to_i);
        const DoubleDouble from_o = product(of_inside_.value, to_o);
        const double left_out = of_outside_.error * std::fabs(to_i.high) + of_inside_.error * std::fabs(to_o.high);
        const bool is_exact = of_inside_.value.low == 0.0 && of_outside_.value.low == 0.0 && to_i.low == 0.0 &&
                              to_o.low == 0.0 && left_out == 0.0;
        return {(from_o.high - from_i.high) + (from_o.low - from_i.low),
                is_exact ? 0.0 : 0x1p-100 * (std::fabs(from_i.high) + std::fabs(from_o.high)) + 1.001 * left_out};
    }
    Expansion<24> exactly_beyond(double middle, double i, double o) const noexcept {
        Expansion<24> sum;
        for (const double to : {o, -middle}) sum.add_scaled(side_.exactly(inside_), to);
        for (const double to : {-i, middle}) sum.add_scaled(side_.exactly(outside_), to);
        return sum;
    }

    const SlideDistance& side_;
    const ClipVertex& inside_;
    const ClipVertex& outside_;
    SlideDistance::Close of_inside_, of_outside_;
};

// The vertex where the edge crosses the side. Where d_i and d_o err by E_i and E_o, the numerator errs by E_o |inside|
// + E_i |outside| and three roundings, the quotient by that and E_i + E_o of itself, over the difference, and its own.
inline ClipVertex cut_at(const SlideDistance& side, const ClipVertex& inside, const ClipVertex& outside) noexcept {
    const Bounded of_inside = side(inside);
    const Bounded of_outside = side(outside);
    const double difference = of_inside.value - of_outside.value;
    const double difference_error = of_inside.error + of_outside.error + gamma(2) * std::fabs(difference);
    const bool is_apart = difference > 2.0 * difference_error;
    const double per_difference = is_apart ? 1.001 / (difference - difference_error) : 0x1p900;
    OnDemand<CloseCrossing> close;
    const auto component = [&](float given_inside, float given_outside) {
        if (given_inside == given_outside) return given_inside;
        const double i = widened(given_inside);
        const double o = widened(given_outside);
        const double from_i = -of_outside.value * i;
        const double from_o = of_inside.value * o;
        const double quotient = (from_i + from_o) / difference;
        const double size = std::fabs(from_i) + std::fabs(from_o);
        if (!(size < 0x1p1000)) return static_cast<float>(quotient);  // not finite
        const double error = per_difference * (of_outside.error * std::fabs(i) + of_inside.error * std::fabs(o) +
                                               difference_error * std::fabs(quotient) + gamma(6) * size);
        if (rounds_alone(quotient, error)) return static_cast<float>(quotient);
        if (!close) close.make(side, inside, outside);
        return close->nearest(i, o, quotient, error);
    };
    ClipVertex result{};
    for (glm::length_t k = 0; k < 4; ++k) {
        result.position[k] = component(inside.position[k], outside.position[k]);
        result.strq[k] = component(inside.strq[k], outside.strq[k]);
    }
    return result;
}

// Cuts the polygon in storage[0, count) edge by edge and returns the new count; 0 where nothing is inside but corners
// on the side, or where storage has no room. sign() is that of the distance of a vertex; cut() as for cut_convex. The
// polygon is read from the end of the storage, so that what is written at its begin grows into free room.
std::size_t cut_edges(const std::span<ClipVertex>& storage, std::size_t count, const auto& sign,
                      const auto& cut) noexcept {
    std::size_t inside = 0;
    while (inside < count && sign(storage[inside]) >= 0) ++inside;
    if (inside == count) return count;
    const std::size_t first = storage.size() - count;
    for (std::size_t i = count; i-- > 0;) storage[first + i] = storage[i];
    const ClipVertex first_vertex = storage[first];
    ClipVertex to = first_vertex;
    int to_sign = sign(to);
    bool touches = true;  // no vertex is strictly inside
    std::size_t written = 0;
    for (std::size_t i = first; i < storage.size(); ++i) {
        const ClipVertex from = to;
        const int from_sign = to_sign;
        to = i + 1 < storage.size() ? storage[i + 1] : first_vertex;
        to_sign = sign(to);
        touches = touches && from_sign <= 0;
        const bool crosses = (from_sign > 0 && to_sign < 0) || (from_sign < 0 && to_sign > 0);
        // Vertices up to i have been read, and their room is free.
        if (written + (from_sign >= 0) + crosses > i + 1) return 0;
        if (from_sign >= 0) storage[written++] = from;
        if (crosses) storage[written++] = from_sign > 0 ? cut(from, to) : cut(to, from);
    }
    return written < 3 || touches ? 0 : written;
}

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {

template <class Space>
ClipPlanes clip_planes(const Transform<Texture, Space>& texgen, const TextureRegion& region) noexcept {
    ClipPlanes result;
    for (const detail::SlidePlane& plane : detail::SlidePlanes(region)) {
        glm::vec4& coefficients = result.planes_[result.size_++];
        for (glm::length_t i = 0; i < 4; ++i) {
            const glm::dvec4& column = texgen.matrix()[i];
            coefficients[i] = static_cast<float>(plane.at(column[plane.coordinate], column.w));
        }
    }
    return result;
}

inline namespace TEXGEN_COMPILER {

inline std::size_t clip_to_slide(const std::span<const ClipVertex>& polygon, const TextureRegion& region,
                                 const std::span<ClipVertex>& out) noexcept {
    const detail::SlidePlanes planes(region);
    const bool has_depth = planes.size() > planes.without_depth;
    TEXGEN_ASSERT(out.size() >= polygon.size() + planes.size());
    if (out.size() < polygon.size() + planes.size() || polygon.size() < 3) return 0;
    if (detail::is_empty(region)) return 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::vec4& strq = polygon[i].strq;
        if (!detail::is_finite(glm::vec4(strq.x, strq.y, has_depth ? strq.z : 0.0f, strq.w))) return 0;
        out[i] = polygon[i];
    }

    // What is beyond a plane, or only touches it, is dropped first: a cut at another could round it to within.
    for (const detail::SlidePlane& plane : planes) {
        const detail::SlideDistance side(plane);
        bool is_beyond = false, is_within = false;
        for (const ClipVertex& vertex : out.first(polygon.size())) {
            const int sign = side.sign(vertex);
            is_beyond = is_beyond || sign < 0;
            is_within = is_within || sign > 0;
        }
        if (is_beyond && !is_within) return 0;
    }

    std::size_t count = polygon.size();
    // q >= 0 comes first: it and the sides leave a cone, in which q = 0 only where s = t = 0.
    for (const detail::SlidePlane& plane : planes) {
        const detail::SlideDistance side(plane);
        count = detail::cut_edges(
            out, count, [&](const ClipVertex& v) { return side.sign(v); },
            [&](const ClipVertex& inside, const ClipVertex& outside) { return cut_at(side, inside, outside); });
    }
    const auto in_front = [](const ClipVertex& v) { return v.strq.w > 0.0f ? 1 : -1; };
    const auto cut_before_projector = [](const ClipVertex& inside, const ClipVertex& outside) {
        const double q = detail::widened(detail::just_in_front(inside.strq.w));
        return detail::between(q, inside, detail::widened(inside.strq.w) - q, outside);
    };
    return detail::cut_edges(out, count, in_front, cut_before_projector);
}

}  // namespace TEXGEN_COMPILER
}  // namespace TEXGEN_NAMESPACE
