// The bodies of TexGenUnit, of fixed_function.hpp.

namespace TEXGEN_DETAIL {

inline bool uses_normal(TexGenMode mode) noexcept {
    return mode == TexGenMode::sphere_map || mode == TexGenMode::reflection_map || mode == TexGenMode::normal_map;
}

// How many coordinates, from s on, may have a mode; 0 for no mode.
inline int coordinates_with(TexGenMode mode) noexcept {
    if (mode == TexGenMode::object_linear || mode == TexGenMode::eye_linear) return 4;
    return mode == TexGenMode::sphere_map ? 2 : uses_normal(mode) ? 3 : 0;
}

// a . b with one rounding: a vertex near the eye, or far from the origin, is a small difference of large terms. The
// product of two floats is exact in double, so only the sum needs care.
inline double cancelling_dot(const glm::vec4& a, const glm::vec4& b) noexcept {
    double sum = 0.0, lost = 0.0;
    for (glm::length_t i = 0; i < 4; ++i) {
        const DoubleDouble next = two_sum(sum, widened(a[i]) * widened(b[i]));
        sum = next.high;
        lost += next.low;
    }
    // What is lost of an infinity is no number.
    return is_finite(sum) ? sum + lost : sum;
}

// v / |v|, and zero for zero. The power of two keeps the squares inside the range of double.
inline glm::dvec3 direction(const glm::dvec3& v) noexcept {
    const double size = largest(v);
    if (!(size > 0.0)) return v;
    const glm::dvec3 near_one = times_power_of_two(v, -std::ilogb(size));
    return near_one / length(near_one);
}

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {

// The way from object space to the eye, prepared once for a MODELVIEW, as far as the unit's modes need it.
class TexGenUnit::EyeSpace {
public:
    EyeSpace(const glm::mat4& modelview, const TexGenUnit& unit) noexcept
        : scaling_(unit.normal_scaling_), rows_(glm::transpose(modelview)) {
        for (const CoordinateState& coordinate : unit.states_) {
            if (!coordinate.enabled) continue;
            wants_position_ = wants_position_ || coordinate.mode != TexGenMode::object_linear;
            wants_normal_ = wants_normal_ || detail::uses_normal(coordinate.mode);
        }
        if (!wants_normal_) return;
        const detail::CertifiedInverse inverse(detail::widened(modelview));
        inverse_ = glm::dmat3(inverse.regular() ? inverse.matrix() : glm::dmat4(detail::nan));
        const glm::dvec3 third_row(inverse_[0][2], inverse_[1][2], inverse_[2][2]);
        const double size = detail::largest(third_row);
        // A zero row has no scale to take away; only a projective M has one.
        if (size > 0.0) {
            const int exponent = std::ilogb(size);
            const glm::dvec3 near_one = detail::times_power_of_two(third_row, -exponent);
            rescale_ = std::scalbn(1.0 / detail::length(near_one), -exponent);
        }
    }

    bool wants_position() const noexcept { return wants_position_; }
    bool wants_normal() const noexcept { return wants_normal_; }
    glm::dvec4 position(const glm::vec4& position) const noexcept {
        return {detail::cancelling_dot(rows_[0], position), detail::cancelling_dot(rows_[1], position),
                detail::cancelling_dot(rows_[2], position), detail::cancelling_dot(rows_[3], position)};
    }

    // Under the unit's normal scaling.
    glm::dvec3 normal(const glm::vec3& normal) const noexcept {
        const glm::dvec3 row = detail::widened(normal);
        const glm::dvec3 result(detail::dot(row, inverse_[0]), detail::dot(row, inverse_[1]),
                                detail::dot(row, inverse_[2]));
        if (scaling_ == NormalScaling::rescale) return result * rescale_;
        return scaling_ == NormalScaling::normalize ? detail::direction(result) : result;
    }

private:
    bool wants_position_ = false, wants_normal_ = false;
    NormalScaling scaling_;
    glm::mat4 rows_;
    glm::dmat3 inverse_{1.0};  // the upper 3x3 of M^-1
    double rescale_ = 1.0;
};

inline TexGenUnit::CoordinateState* TexGenUnit::find(Coordinate coordinate) noexcept {
    const auto index = static_cast<std::size_t>(coordinate);
    return index < states_.size() ? &states_[index] : nullptr;
}

inline TexGenUnit::CoordinateState TexGenUnit::state(Coordinate coordinate) const noexcept {
    const auto index = static_cast<std::size_t>(coordinate);
    return index < states_.size() ? states_[index] : CoordinateState{};
}

inline void TexGenUnit::enable(Coordinate coordinate, bool on) noexcept {
    if (CoordinateState* const state = find(coordinate)) state->enabled = on;
}

inline void TexGenUnit::set_object_plane(Coordinate coordinate, glm::vec4 plane) noexcept {
    if (CoordinateState* const state = find(coordinate)) state->object_plane = plane;
}

inline bool TexGenUnit::set_mode(Coordinate coordinate, TexGenMode mode) noexcept {
    CoordinateState* const state = find(coordinate);
    if (state == nullptr || static_cast<int>(coordinate) >= detail::coordinates_with(mode)) return false;
    state->mode = mode;
    return true;
}

inline bool TexGenUnit::set_eye_plane(Coordinate coordinate, glm::vec4 plane, const glm::mat4& modelview) noexcept {
    CoordinateState* const state = find(coordinate);
    const detail::CertifiedInverse inverse(detail::widened(modelview));
    if (state == nullptr || !inverse.regular()) return false;
    const glm::vec4 stored(inverse.solve_row(detail::widened(plane)));
    if (!detail::is_finite(stored)) return false;
    state->eye_plane = stored;
    return true;
}

inline glm::dvec4 TexGenUnit::eye_plane_error_bound(Coordinate coordinate, glm::vec4 plane,
                                                    const glm::mat4& modelview) const noexcept {
    return detail::CertifiedInverse(detail::widened(modelview))
        .error_of(detail::widened(eye_plane(coordinate)), detail::widened(plane));
}

inline void TexGenUnit::set_normal_scaling(NormalScaling scaling) noexcept {
    if (scaling == NormalScaling::none || scaling == NormalScaling::rescale || scaling == NormalScaling::normalize)
        normal_scaling_ = scaling;
}

inline glm::vec4 TexGenUnit::generate(const FixedFunctionVertex& vertex, const EyeSpace& eye_space) const noexcept {
    const glm::dvec4 eye = eye_space.wants_position() ? eye_space.position(vertex.position) : glm::dvec4(0.0);

    // The reflection is held as r 4^-k with n 2^-k near 1 at most, because a normal under a tiny scale can be too long
    // to square. r + (0, 0, 1) is m/2 long, so its direction halved is what the sphere map adds to 1/2: no square root
    // of a difference, and zero where m is.
    glm::dvec3 normal(0.0), scaled_reflection(0.0), sphere(0.0);
    int exponent = 0;
    if (eye_space.wants_normal()) {
        normal = eye_space.normal(vertex.normal);
        const double size = detail::largest(normal);
        if (size > 1.0 && detail::is_finite(size)) exponent = std::ilogb(size);
        const glm::dvec3 n = detail::times_power_of_two(normal, -exponent);
        const glm::dvec3 to_vertex = detail::direction({eye.x, eye.y, eye.z});
        const double n_dot_u = detail::dot(n, to_vertex);
        const glm::dvec3 u = detail::times_power_of_two(to_vertex, -2 * exponent);
        for (glm::length_t i = 0; i < 3; ++i) scaled_reflection[i] = std::fma(-2.0 * n[i], n_dot_u, u[i]);
        sphere = detail::direction(scaled_reflection + glm::dvec3(0.0, 0.0, std::scalbn(1.0, -2 * exponent)));
    }

    glm::dvec4 generated = detail::widened(vertex.texcoord);
    for (glm::length_t i = 0; i < 4; ++i) {
        const CoordinateState& coordinate = states_[static_cast<std::size_t>(i)];
        if (!coordinate.enabled) continue;
        const TexGenMode mode = coordinate.mode;
        generated[i] = mode == TexGenMode::object_linear
                           ? detail::cancelling_dot(coordinate.object_plane, vertex.position)
                       : mode == TexGenMode::eye_linear     ? detail::dot(detail::widened(coordinate.eye_plane), eye)
                       : mode == TexGenMode::sphere_map     ? 0.5 + 0.5 * sphere[i]
                       : mode == TexGenMode::reflection_map ? std::scalbn(scaled_reflection[i], 2 * exponent)
                                                            : normal[i];
    }
    // The identity is left out, so that a NaN stays in its coordinate.
    if (texture_matrix_ == glm::mat4(1.0f)) return glm::vec4(generated);
    const glm::dmat4 texture_rows = detail::widened(glm::transpose(texture_matrix_));
    return {detail::dot(texture_rows[0], generated), detail::dot(texture_rows[1], generated),
            detail::dot(texture_rows[2], generated), detail::dot(texture_rows[3], generated)};
}

inline glm::vec4 TexGenUnit::generate(const FixedFunctionVertex& vertex, const glm::mat4& modelview) const noexcept {
    return generate(vertex, EyeSpace(modelview, *this));
}

inline void TexGenUnit::generate(std::span<const FixedFunctionVertex> vertices, const glm::mat4& modelview,
                                 std::span<glm::vec4> strq) const noexcept {
    TEXGEN_ASSERT(vertices.size() == strq.size());
    if (vertices.size() != strq.size()) return;
    const EyeSpace eye_space(modelview, *this);
    for (std::size_t i = 0; i < vertices.size(); ++i) strq[i] = generate(vertices[i], eye_space);
}

}  // namespace TEXGEN_NAMESPACE
