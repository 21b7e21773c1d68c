// The bodies of the views of projector.hpp, and what makes a projector of an aim and a lens.

namespace TEXGEN_DETAIL {

// row . point for a row of a rotation, within 1 ulp however its terms cancel: far from the origin they do. The terms
// are scaled so that neither they nor their last bits leave the range. Where two cancel they leave 0, or at least
// 2^-106 of themselves: a term below 2^-200 of the largest counts only where all others leave 0.
inline double rotated(const glm::dvec3& row, const glm::dvec3& point) noexcept {
    constexpr int none = -10000;  // less than any
    int exponent[3], largest = none;
    for (glm::length_t i = 0; i < 3; ++i) {
        exponent[i] = row[i] == 0.0 || point[i] == 0.0 ? none : exponent_of(row[i]) + exponent_of(point[i]);
        if (exponent[i] > largest) largest = exponent[i];
    }
    Expansion<6> sum;
    double last = 0.0;
    for (glm::length_t i = 0; i < 3; ++i) {
        if (exponent[i] == none) continue;
        const int of_row = exponent_of(row[i]);
        if (exponent[i] < largest - 200)
            last = row[i] * point[i];
        else
            sum.add_product(times_power_of_two(row[i], -of_row), times_power_of_two(point[i], of_row - largest));
    }
    const double value = sum.estimate();
    return value != 0.0 ? times_power_of_two(value, largest) : last;
}

// A difference of two points, unrounded: high + low.
struct Difference {
    glm::dvec3 high, low;
};

// to - from times a power of two, so that the largest component is in [1, 2); 0 where it is 0 or not finite.
inline Difference scaled_difference(const glm::dvec3& to, const glm::dvec3& from) noexcept {
    const double unit = is_finite(to - from) ? 1.0 : 0.5;
    Difference result{};
    for (glm::length_t i = 0; i < 3; ++i) {
        const DoubleDouble component = two_sum(unit * to[i], -unit * from[i]);
        result.high[i] = component.high;
        result.low[i] = component.low;
    }
    const glm::dvec3 scaled = scaled_near_one(result.high);
    if (!(length(scaled) > 0.0)) return Difference{};
    return {scaled, times_power_of_two(result.low, -exponent_of(largest(result.high)))};
}

// a x b within 1 ulp, component by component.
inline glm::dvec3 cross(const Difference& a, const glm::dvec3& b) noexcept {
    glm::dvec3 result(0.0);
    for (glm::length_t i = 0; i < 3; ++i) {
        const glm::length_t j = (i + 1) % 3, k = (i + 2) % 3;
        Expansion<8> sum;
        sum.add_product(a.high[j], b[k]);
        sum.add_product(a.low[j], b[k]);
        sum.add_product(-a.high[k], b[j]);
        sum.add_product(-a.low[k], b[j]);
        result[i] = sum.estimate();
    }
    return result;
}

// Whether the product view x up, of two vectors near 1, is more than rounding: then up is not parallel to the view.
inline bool is_sideways(const glm::dvec3& product, const glm::dvec3& view, const glm::dvec3& up) noexcept {
    return length(product) > 0x1p-98 * length(view) * length(up);
}

inline std::optional<Projector> assemble(const std::optional<ProjectorProjection>& projection,
                                         const std::optional<ProjectorView>& view,
                                         const Conventions& conventions) noexcept {
    if (!projection || !view) return std::nullopt;
    return Projector{*projection, *view, conventions};
}

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {

inline std::optional<ProjectorView> look_at(const Aim& aim, Handedness handedness) noexcept {
    // The difference is not rounded: where up is nearly parallel to it that would turn the picture.
    const detail::Difference view = detail::scaled_difference(aim.target, aim.position);
    const glm::dvec3& forward = view.high;
    const glm::dvec3 up = detail::scaled_near_one(aim.up);
    const glm::dvec3 sideways = detail::cross(view, up);
    if (!detail::is_sideways(sideways, forward, up)) return std::nullopt;
    const glm::dvec3 side_direction = detail::scaled_near_one(sideways);

    // A left-handed cross product has the other sign, and a left-handed eye looks down +z: half a turn about up.
    const double sign = handedness == Handedness::left ? -1.0 : 1.0;
    const glm::dvec3 side = sign * detail::normalized(side_direction);
    const glm::dvec3 back = -sign * detail::normalized(forward);
    const glm::dvec3 upright = detail::normalized(detail::cross(back, side));
    glm::dmat4 matrix(glm::transpose(glm::dmat3(side, upright, back)));
    matrix[3] = {-detail::rotated(side, aim.position), -detail::rotated(upright, aim.position),
                 -detail::rotated(back, aim.position), 1.0};
    return detail::is_finite(matrix) ? std::optional(ProjectorView(matrix)) : std::nullopt;
}

inline std::optional<ProjectorView> view_from_opencv(const glm::dmat3& rotation, const glm::dvec3& translation,
                                                     Handedness handedness) noexcept {
    const double forward = handedness == Handedness::right ? -1.0 : 1.0;
    glm::dmat4 matrix(0.0);
    for (glm::length_t column = 0; column < 4; ++column) {
        const glm::dvec3& v = column < 3 ? rotation[column] : translation;
        matrix[column] = {v.x, -v.y, forward * v.z, column < 3 ? 0.0 : 1.0};
    }
    return detail::is_finite(matrix) ? std::optional(ProjectorView(matrix)) : std::nullopt;
}

inline std::optional<ProjectorView> mirrored(const ProjectorView& view, const glm::dvec4& plane) noexcept {
    const glm::dvec3 direction{plane.x, plane.y, plane.z};
    const glm::dvec3 normal = detail::scaled_near_one(direction);
    if (!(detail::length(normal) > 0.0)) return std::nullopt;
    const double distance = detail::times_power_of_two(plane.w, -detail::exponent_of(detail::largest(direction)));
    detail::DoubleDouble squared{0.0, 0.0};
    for (glm::length_t i = 0; i < 3; ++i) squared = detail::add_product(squared, normal[i], normal[i]);
    // V R = V - f (n, d), f = 2 V (n, 0) / |n|^2 a column, in two doubles.
    glm::dmat4 matrix = view.matrix();
    for (glm::length_t row = 0; row < 4; ++row) {
        detail::DoubleDouble along{0.0, 0.0};
        for (glm::length_t i = 0; i < 3; ++i) along = detail::add_product(along, matrix[i][row], 2.0 * normal[i]);
        const double factor = along.high / squared.high;
        const detail::DoubleDouble rest =
            detail::add_product(detail::add_product(along, -factor, squared.high), -factor, squared.low);
        const double rest_of_factor = rest.high / squared.high;
        for (glm::length_t column = 0; column < 4; ++column) {
            const double component = column < 3 ? normal[column] : distance;
            const detail::DoubleDouble start{matrix[column][row], 0.0};
            matrix[column][row] =
                detail::add_product(detail::add_product(start, -factor, component), -rest_of_factor, component).high;
        }
    }
    return detail::is_finite(matrix) ? std::optional(ProjectorView(matrix)) : std::nullopt;
}

inline std::optional<Projector> make_projector(const PerspectiveLens& lens, const Aim& aim,
                                               const Conventions& conventions) noexcept {
    return detail::assemble(perspective(lens, conventions), look_at(aim, conventions.handedness), conventions);
}
inline std::optional<Projector> make_projector(const FrustumLens& lens, const Aim& aim,
                                               const Conventions& conventions) noexcept {
    return detail::assemble(frustum(lens, conventions), look_at(aim, conventions.handedness), conventions);
}
inline std::optional<Projector> make_projector(const OrthographicLens& lens, const Aim& aim,
                                               const Conventions& conventions) noexcept {
    return detail::assemble(orthographic(lens, conventions), look_at(aim, conventions.handedness), conventions);
}

inline std::optional<Projector> make_projector(const PinholeLens& lens, const Aim& aim,
                                               const Conventions& conventions) noexcept {
    return detail::assemble(pinhole(lens, conventions), look_at(aim, conventions.handedness), conventions);
}

}  // namespace TEXGEN_NAMESPACE
