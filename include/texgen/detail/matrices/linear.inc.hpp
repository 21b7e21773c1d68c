// The bodies of linear.hpp.

namespace TEXGEN_DETAIL {

inline Transform<Texture, ProjectorEye> texture_from_projector_eye(const Projector& projector,
                                                                   const TextureRegion& region,
                                                                   DepthMapping depth) noexcept {
    return scale_bias(projector.conventions, region, depth) * projector.projection;
}

// rows A^-1, each row solved and refined by itself. Precondition: A is regular.
inline glm::dmat4 solve_rows(const CertifiedInverse& inverse, const glm::dmat4& rows) noexcept {
    const glm::dmat4 row = glm::transpose(rows);
    return glm::transpose(glm::dmat4(inverse.solve_row(row[0]), inverse.solve_row(row[1]), inverse.solve_row(row[2]),
                                     inverse.solve_row(row[3])));
}

// How far a depth may be from what the buffer stores for it.
inline double depth_rounding(DepthBuffer buffer, double depth) noexcept {
    const double steps = buffer == DepthBuffer::unorm16 ? 0x1p16 - 1.0 : 0x1p24 - 1.0;
    return half_ulp(magnitude(depth)) + (buffer == DepthBuffer::float32 ? 0.0 : 0.6 / steps);
}

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {

inline WorldTexgen texture_from_world(const Projector& projector, const TextureRegion& region,
                                      DepthMapping depth) noexcept {
    return detail::texture_from_projector_eye(projector, region, depth) * projector.view;
}

inline ObjectTexgen object_linear(const Projector& projector, const ModelMatrix& world_from_object,
                                  const TextureRegion& region, DepthMapping depth) noexcept {
    return detail::texture_from_projector_eye(projector, region, depth) * (projector.view * world_from_object);
}

inline EyeTexgen eye_linear(const Projector& projector, const CameraPose& world_from_eye, const TextureRegion& region,
                            DepthMapping depth) noexcept {
    return detail::texture_from_projector_eye(projector, region, depth) * (projector.view * world_from_eye);
}

inline EyeTexgen eye_linear(const ProjectorProjection& projection, const Transform<ProjectorEye, Eye>& view,
                            const Conventions& conventions, const TextureRegion& region, DepthMapping depth) noexcept {
    return scale_bias(conventions, region, depth) * projection * view;
}

inline std::optional<WindowTexgen> window_linear(const Projector& projector, const Projector& camera,
                                                 const Viewport& viewport, const TextureRegion& region,
                                                 DepthMapping depth) noexcept {
    if (viewport.width == 0 || viewport.height == 0) return std::nullopt;
    const detail::CertifiedInverse view(camera.view.matrix()), projection(camera.projection.matrix());
    if (!view.is_regular() || !projection.is_regular()) return std::nullopt;
    // Far from the origin V_p and V_c^-1 cancel in their product, which comes before anything else.
    const glm::dmat4 projector_from_camera = detail::solve_rows(view, projector.view.matrix());
    glm::dmat4 result = detail::solve_rows(
        projection, detail::texture_from_projector_eye(projector, region, depth).matrix() * projector_from_camera);
    // W^-1: x_ndc = (x - centre) / half, y likewise, and the depth from [0, 1].
    const double half_x = 0.5 * viewport.width, half_y = 0.5 * viewport.height;
    const double half_z = camera.conventions.depth == DepthRange::negative_one_to_one ? 0.5 : 1.0;
    result[0] /= half_x;
    result[1] /= half_y;
    result[2] /= half_z;
    result[3] -= (viewport.x + half_x) * result[0] + (viewport.y + half_y) * result[1] + (1.0 - half_z) * result[2];
    return detail::is_finite(result) ? std::optional(WindowTexgen(result)) : std::nullopt;
}

inline glm::dvec2 depth_error_bound(const WindowTexgen& texture_from_window, const glm::vec3& fragment,
                                    DepthBuffer buffer) noexcept {
    const glm::dvec3 v = detail::widened(fragment);
    // A common factor changes no quotient: the terms of q are brought near 1, so that no product leaves the range.
    const double size_of_q = detail::terms_at(detail::form(texture_from_window.matrix(), 3), v);
    const glm::dmat4 m = texture_from_window.matrix() * detail::reciprocal_power_of_two(detail::smaller(
                                                            detail::larger(size_of_q, 0x1p-1000), 0x1p1000));
    const double rounding = detail::depth_rounding(buffer, v.z);
    const detail::Bounded q = detail::value_at(detail::form(m, 3), v);
    const double least_q = q.value - q.error, slope_q = m[2][3];
    const double last_q = least_q - 1.001 * rounding * detail::magnitude(slope_q);
    glm::dvec2 bound(detail::infinity);
    if (!(last_q > 0.0)) return bound;
    for (glm::length_t row = 0; row < 2; ++row) {
        // With d more depth, s/q changes by d (s' q - q' s) / (q (q + d q')), for s' and q' the slopes.
        const detail::Bounded s = detail::value_at(detail::form(m, static_cast<int>(row)), v);
        const double slope = m[2][row], numerator = detail::magnitude(slope * q.value - slope_q * s.value);
        const double size = detail::magnitude(slope) * (q.error + detail::gamma(2) * detail::magnitude(q.value)) +
                            detail::magnitude(slope_q) * (s.error + detail::gamma(2) * detail::magnitude(s.value));
        const double error = 1.001 * rounding * (numerator + size) / least_q / last_q;
        if (error >= 0.0) bound[row] = error + 0x1p-1000;  // for what underflows
    }
    return bound;
}

template <class Space>
std::optional<EyeTexgen> eye_planes_as_stored(const Transform<Texture, Space>& planes,
                                              const Transform<Eye, Space>& modelview) noexcept {
    const detail::CertifiedInverse inverse(modelview.matrix());
    if (!inverse.is_regular()) return std::nullopt;
    const glm::dmat4 stored = detail::solve_rows(inverse, planes.matrix());
    return detail::is_finite(stored) ? std::optional(EyeTexgen(stored)) : std::nullopt;
}

template <class Space>
glm::dmat4 eye_planes_error_bound(const Transform<Texture, Space>& planes, const Transform<Eye, Space>& modelview,
                                  const EyeTexgen& stored) noexcept {
    return detail::CertifiedInverse(modelview.matrix()).error_of(stored.matrix(), planes.matrix());
}

template <class Space>
std::array<glm::vec4, 4> planes(const Transform<Texture, Space>& transform) noexcept {
    const glm::mat4 rows = glm::transpose(transform.rounded());
    return {rows[0], rows[1], rows[2], rows[3]};
}

}  // namespace TEXGEN_NAMESPACE
