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

// Sums for many vertices. They are not fused: std::fma() is a call where the compiler is given no instruction for it,
// and the bounds do not need the roundings that it saves.
inline double plain_dot(const glm::dvec3& a, const glm::dvec3& b) noexcept { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double plain_dot(const glm::dvec4& a, const glm::dvec4& b) noexcept {
    return (a.x * b.x + a.y * b.y) + (a.z * b.z + a.w * b.w);
}

// a . b with one rounding: a vertex near the eye, or far from the origin, is a small difference of large terms. The
// product of two floats is exact in double, so only the sum needs care.
inline double cancelling_dot(const glm::dvec4& a, const glm::dvec4& b) noexcept {
    const DoubleDouble first = two_sum(a.x * b.x, a.y * b.y);
    const DoubleDouble second = two_sum(a.z * b.z, a.w * b.w);
    const DoubleDouble sum = two_sum(first.high, second.high);
    // What is lost of an infinite sum is a NaN.
    return is_finite(sum.high) ? sum.high + (sum.low + (first.low + second.low)) : sum.high;
}

// The power of two that brings the largest component of a vector near 1.
inline double reciprocal_size(const glm::dvec3& v) noexcept {
    return reciprocal_power_of_two(larger(larger(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z)));
}

// v / |v|, and zero for zero; a component that is 1 may become an ulp more. The power of two keeps the squares inside
// the range of double.
inline glm::dvec3 direction(const glm::dvec3& v) noexcept {
    if (v == glm::dvec3(0.0)) return v;
    const glm::dvec3 near_one = v * reciprocal_size(v);
    return near_one * (1.0 / std::sqrt(plain_dot(near_one, near_one)));
}

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {

// The way from object space to the eye, and what else many vertices share, prepared once for a MODELVIEW, as far as the
// unit's modes need it.
struct TexGenUnit::EyeSpace {
    bool wants_position = false, wants_normal = false, wants_reflection = false;
    NormalScaling scaling;
    glm::dmat4 rows;
    glm::dvec4 planes[4];
    glm::dmat3 inverse{1.0};  // the upper 3x3 of M^-1
    double rescale = 1.0;
    glm::dmat4 texture_rows;
    bool has_texture_matrix;

    EyeSpace(const glm::mat4& modelview, const TexGenUnit& unit) noexcept
        : scaling(unit.normal_scaling_),
          rows(detail::widened(glm::transpose(modelview))),
          texture_rows(detail::widened(glm::transpose(unit.texture_matrix_))),
          has_texture_matrix(unit.texture_matrix_ != glm::mat4(1.0f)) {
        for (std::size_t i = 0; i < unit.states_.size(); ++i) {
            const CoordinateState& coordinate = unit.states_[i];
            const bool is_of_object = coordinate.mode == TexGenMode::object_linear;
            planes[i] = detail::widened(is_of_object ? coordinate.object_plane : coordinate.eye_plane);
            if (!coordinate.enabled) continue;
            const bool is_reflected =
                coordinate.mode == TexGenMode::sphere_map || coordinate.mode == TexGenMode::reflection_map;
            wants_position = wants_position || coordinate.mode == TexGenMode::eye_linear || is_reflected;
            wants_normal = wants_normal || detail::uses_normal(coordinate.mode);
            wants_reflection = wants_reflection || is_reflected;
        }
        if (!wants_normal) return;
        const detail::CertifiedInverse certified(detail::widened(modelview));
        inverse = glm::dmat3(certified.is_regular() ? certified.matrix() : glm::dmat4(detail::nan));
        const glm::dvec3 third_row(inverse[0][2], inverse[1][2], inverse[2][2]);
        const double size = detail::largest(third_row);
        // A zero row has no scale to take away; only a projective M has one.
        if (size > 0.0) {
            const int exponent = detail::exponent_of(size);
            const glm::dvec3 near_one = detail::times_power_of_two(third_row, -exponent);
            rescale = detail::times_power_of_two(1.0 / detail::length(near_one), -exponent);
        }
    }

    glm::dvec4 position(const glm::dvec4& position) const noexcept {
        return {detail::cancelling_dot(rows[0], position), detail::cancelling_dot(rows[1], position),
                detail::cancelling_dot(rows[2], position), detail::cancelling_dot(rows[3], position)};
    }

    // Takes a normal to the eye, under the unit's normal scaling.
    glm::dvec3 normal(const glm::dvec3& row) const noexcept {
        const glm::dvec3 result(detail::plain_dot(row, inverse[0]), detail::plain_dot(row, inverse[1]),
                                detail::plain_dot(row, inverse[2]));
        if (scaling == NormalScaling::rescale) return result * rescale;
        return scaling == NormalScaling::normalize ? detail::direction(result) : result;
    }
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

inline void TexGenUnit::set_object_plane(Coordinate coordinate, const glm::vec4& plane) noexcept {
    if (CoordinateState* const state = find(coordinate)) state->object_plane = plane;
}

inline bool TexGenUnit::set_mode(Coordinate coordinate, TexGenMode mode) noexcept {
    CoordinateState* const state = find(coordinate);
    if (state == nullptr || static_cast<int>(coordinate) >= detail::coordinates_with(mode)) return false;
    state->mode = mode;
    return true;
}

inline bool TexGenUnit::set_eye_plane(Coordinate coordinate, const glm::vec4& plane,
                                      const glm::mat4& modelview) noexcept {
    CoordinateState* const state = find(coordinate);
    const detail::CertifiedInverse inverse(detail::widened(modelview));
    if (state == nullptr || !inverse.is_regular()) return false;
    const glm::vec4 stored(inverse.solve_row(detail::widened(plane)));
    if (!detail::is_finite(stored)) return false;
    state->eye_plane = stored;
    return true;
}

inline glm::dvec4 TexGenUnit::eye_plane_error_bound(Coordinate coordinate, const glm::vec4& plane,
                                                    const glm::mat4& modelview) const noexcept {
    return detail::CertifiedInverse(detail::widened(modelview))
        .error_of(detail::widened(eye_plane(coordinate)), detail::widened(plane));
}

inline void TexGenUnit::set_normal_scaling(NormalScaling scaling) noexcept {
    if (scaling == NormalScaling::none || scaling == NormalScaling::rescale || scaling == NormalScaling::normalize)
        normal_scaling_ = scaling;
}

// Not inlined, so that one vertex and many have the same bits, whatever a compiler fuses.
TEXGEN_APART inline glm::vec4 TexGenUnit::generate(const FixedFunctionVertex& vertex,
                                                   const EyeSpace& eye_space) const noexcept {
    const glm::dvec4 position = detail::widened(vertex.position);
    const glm::dvec4 eye = eye_space.wants_position ? eye_space.position(position) : glm::dvec4(0.0);

    // The reflection is held as r k^2, k a power of two for which n k is near 1 at most, because a normal under a tiny
    // scale can be too long to square. r + (0, 0, 1) is m/2 long, so its direction halved is what the sphere map adds
    // to 1/2: no square root of a difference, and zero where m is.
    glm::dvec3 normal(0.0), scaled_reflection(0.0), sphere(0.0);
    double per_scale = 1.0;
    if (eye_space.wants_normal) normal = eye_space.normal(detail::widened(vertex.normal));
    if (eye_space.wants_reflection) {
        const double scale = detail::smaller(detail::reciprocal_size(normal), 1.0);
        per_scale = 1.0 / scale;
        const glm::dvec3 n = normal * scale;
        const glm::dvec3 to_vertex = detail::direction({eye.x, eye.y, eye.z});
        scaled_reflection = to_vertex * scale * scale - n * (2.0 * detail::plain_dot(n, to_vertex));
        sphere = detail::direction(scaled_reflection + glm::dvec3(0.0, 0.0, scale * scale));
    }

    glm::dvec4 generated = detail::widened(vertex.texcoord);
    for (std::size_t k = 0; k < states_.size(); ++k) {
        if (!states_[k].enabled) continue;
        const auto i = static_cast<glm::length_t>(k);
        const TexGenMode mode = states_[k].mode;
        generated[i] = mode == TexGenMode::object_linear ? detail::cancelling_dot(eye_space.planes[k], position)
                       : mode == TexGenMode::eye_linear  ? detail::plain_dot(eye_space.planes[k], eye)
                       : mode == TexGenMode::sphere_map
                           ? 0.5 + 0.5 * detail::smaller(1.0, detail::larger(-1.0, sphere[i]))
                       : mode == TexGenMode::reflection_map ? scaled_reflection[i] * per_scale * per_scale
                                                            : normal[i];
    }
    // The identity is left out, so that a NaN stays in its coordinate.
    if (!eye_space.has_texture_matrix) return glm::vec4(generated);
    const glm::dmat4& rows = eye_space.texture_rows;
    return {detail::plain_dot(rows[0], generated), detail::plain_dot(rows[1], generated),
            detail::plain_dot(rows[2], generated), detail::plain_dot(rows[3], generated)};
}

inline glm::vec4 TexGenUnit::generate(const FixedFunctionVertex& vertex, const glm::mat4& modelview) const noexcept {
    return generate(vertex, EyeSpace(modelview, *this));
}

inline void TexGenUnit::generate(const std::span<const FixedFunctionVertex>& vertices, const glm::mat4& modelview,
                                 const std::span<glm::vec4>& strq) const noexcept {
    TEXGEN_ASSERT(vertices.size() == strq.size());
    if (vertices.size() != strq.size()) return;
    const EyeSpace eye_space(modelview, *this);
    for (std::size_t i = 0; i < vertices.size(); ++i) strq[i] = generate(vertices[i], eye_space);
}

}  // namespace TEXGEN_NAMESPACE
