// The bodies of the inverses of transform.hpp.

namespace TEXGEN_NAMESPACE {

template <class To, class From>
std::optional<Transform<From, To>> inverse(const Transform<To, From>& transform) noexcept {
    const detail::CertifiedInverse inverse(transform.matrix());
    if (!inverse.regular()) return std::nullopt;
    const Transform<From, To> result(inverse.matrix());
    return detail::is_finite(result.matrix()) ? std::optional(result) : std::nullopt;
}

template <class To, class From>
glm::dmat4 inverse_error_bound(const Transform<To, From>& transform, const Transform<From, To>& inverse) noexcept {
    return detail::CertifiedInverse(transform.matrix()).error_of(inverse.matrix(), glm::dmat4(1.0));
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
