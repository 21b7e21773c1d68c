// The bodies of linear.hpp.

namespace TEXGEN_DETAIL {

inline Transform<Texture, ProjectorEye> texture_from_projector_eye(const Projector& projector,
                                                                   const TextureRegion& region,
                                                                   DepthMapping depth) noexcept {
    return scale_bias(projector.conventions, region, depth) * projector.projection;
}

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {

inline WorldTexgen texture_from_world(const Projector& projector, TextureRegion region, DepthMapping depth) noexcept {
    return detail::texture_from_projector_eye(projector, region, depth) * projector.view;
}

inline ObjectTexgen object_linear(const Projector& projector, const ModelMatrix& world_from_object,
                                  TextureRegion region, DepthMapping depth) noexcept {
    return detail::texture_from_projector_eye(projector, region, depth) * (projector.view * world_from_object);
}

inline EyeTexgen eye_linear(const Projector& projector, const CameraPose& world_from_eye, TextureRegion region,
                            DepthMapping depth) noexcept {
    return detail::texture_from_projector_eye(projector, region, depth) * (projector.view * world_from_eye);
}

inline EyeTexgen eye_linear(const ProjectorProjection& projection, const Transform<ProjectorEye, Eye>& view,
                            Conventions conventions, TextureRegion region, DepthMapping depth) noexcept {
    return scale_bias(conventions, region, depth) * projection * view;
}

template <class Space>
std::optional<EyeTexgen> eye_planes_as_stored(const Transform<Texture, Space>& planes,
                                              const Transform<Eye, Space>& modelview) noexcept {
    const detail::CertifiedInverse inverse(modelview.matrix());
    if (!inverse.regular()) return std::nullopt;
    glm::dmat4 stored(0.0);
    for (glm::length_t row = 0; row < 4; ++row) {
        glm::dvec4 plane(0.0);
        for (int column = 0; column < 4; ++column) plane[column] = planes.matrix()[column][row];
        plane = inverse.solve_row(plane);
        for (glm::length_t column = 0; column < 4; ++column) stored[column][row] = plane[column];
    }
    if (!detail::is_finite(stored)) return std::nullopt;
    return EyeTexgen(stored);
}

template <class Space>
glm::dmat4 eye_planes_error_bound(const Transform<Texture, Space>& planes, const Transform<Eye, Space>& modelview,
                                  const EyeTexgen& stored) noexcept {
    return detail::CertifiedInverse(modelview.matrix()).error_of(stored.matrix(), planes.matrix());
}

template <class Space>
std::array<glm::vec4, 4> planes(const Transform<Texture, Space>& transform) noexcept {
    const glm::mat4 m = transform.rounded();
    std::array<glm::vec4, 4> rows;
    for (glm::length_t row = 0; row < 4; ++row)
        rows[static_cast<std::size_t>(row)] = {m[0][row], m[1][row], m[2][row], m[3][row]};
    return rows;
}

}  // namespace TEXGEN_NAMESPACE
