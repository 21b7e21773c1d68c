// The bodies of transform.hpp.

namespace TEXGEN_NAMESPACE {

template <class To, class From>
Transform<To, From> from_row_vectors(const glm::mat4& matrix) noexcept {
    return Transform<To, From>(glm::transpose(matrix));
}

template <class To, class From>
Transform<To, From> from_row_vectors(const glm::dmat4& matrix) noexcept {
    return Transform<To, From>(glm::transpose(matrix));
}

// The rows of M are the columns of its transpose.
template <class To, class From>
Transform<To, From> from_row_vectors(const std::span<const float, 16>& rows) noexcept {
    glm::mat4 columns;
    for (glm::length_t i = 0; i < 16; ++i) columns[i / 4][i % 4] = rows[static_cast<std::size_t>(i)];
    return Transform<To, From>(columns);
}

template <class To, class From>
std::optional<Transform<From, To>> inverse(const Transform<To, From>& transform) noexcept {
    const detail::CertifiedInverse inverse(transform.matrix());
    if (!inverse.is_regular()) return std::nullopt;
    const Transform<From, To> result(inverse.matrix());
    return detail::is_finite(result.matrix()) ? std::optional(result) : std::nullopt;
}

template <class To, class From>
glm::dmat4 inverse_error_bound(const Transform<To, From>& transform, const Transform<From, To>& inverse) noexcept {
    const detail::CertifiedInverse certified(transform.matrix());
    glm::dmat4 bound = certified.error_of(inverse.matrix(), glm::dmat4(1.0));
    if (!detail::is_finite(certified.matrix()))
        for (glm::length_t i = 0; i < 4; ++i) bound[i] = glm::dvec4(detail::infinity);
    return bound;
}

template <class To, class From>
Transform<From, To> inverse_rigid(const Transform<To, From>& transform) noexcept {
    const glm::dmat4& m = transform.matrix();
    TEXGEN_ASSERT(!(detail::distance_from_rigid(m) > 1e-3));
    glm::dmat4 result(1.0);
    for (glm::length_t column = 0; column < 3; ++column) {
        detail::DoubleDouble translation{0.0, 0.0};
        for (glm::length_t row = 0; row < 3; ++row) {
            result[column][row] = m[row][column];
            translation = detail::add_product(translation, -m[column][row], m[3][row]);
        }
        result[3][column] = translation.high;
    }
    return Transform<From, To>(result);
}

}  // namespace TEXGEN_NAMESPACE
