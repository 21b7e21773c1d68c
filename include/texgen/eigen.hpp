#pragma once

// Floor 9: Eigen users' border, not in the umbrella: matrices go across by value and say their spaces, arrays go across
// as views. A view is made of the strides that the Eigen object reports; what has no such view (an expression, another
// scalar, a temporary that owns its numbers, a stride where none can be) does not compile, so nothing is copied and
// nothing is read at a wrong place. A view of a temporary's numbers (make().leftCols(2), or a Ref<const ...> that had
// to copy) has the type of any other, and ends with the statement.

#include "detail/language.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <type_traits>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "detail/eigen.hpp"
#include "texcoord.hpp"
#include "transform.hpp"

namespace TEXGEN_NAMESPACE {

// Makes a Transform of an Eigen matrix: from_eigen<ViewMatrix>(m).
// Guarantee: each element is kept exactly; no allocation, noexcept for a plain matrix.
// Shape: a 4x4 of float or double for column vectors, or an Eigen::Transform of any mode
// (Isometry3d, Affine3f, AffineCompact3d, Projective3d ...). The role names the spaces; there is no default.
// Bad input: NaN and infinity are kept as they are.
template <detail::TransformOfSpaces Role, detail::EigenMatrix4 Matrix>
Role from_eigen(const Matrix& matrix) noexcept(detail::owns_elements<Matrix>) {
    const Eigen::Matrix<typename Matrix::Scalar, 4, 4> value = matrix;
    glm::mat<4, 4, typename Matrix::Scalar> result;
    for (Eigen::Index column = 0; column < 4; ++column)
        for (Eigen::Index row = 0; row < 4; ++row)
            result[static_cast<glm::length_t>(column)][static_cast<glm::length_t>(row)] = value(row, column);
    return Role(result);
}

// Makes a Transform of an Eigen::Transform. Its last row is kept, whatever its mode says; an AffineCompact has none.
template <detail::TransformOfSpaces Role, detail::EigenTransform EigenTransform>
Role from_eigen(const EigenTransform& transform) noexcept {
    if constexpr (static_cast<int>(EigenTransform::Mode) == static_cast<int>(Eigen::AffineCompact))
        return from_eigen<Role>(
            Eigen::Transform<typename EigenTransform::Scalar, 3, Eigen::Projective>(transform).matrix());
    else
        return from_eigen<Role>(transform.matrix());
}

// Makes an Eigen matrix of a Transform.
// Guarantee: exact for Matrix4d and Projective3d; each element rounded once for Matrix4f and Projective3f. No
// allocation, noexcept. Bad input: as Transform.
template <class Target = Eigen::Matrix4d, class To, class From>
Target to_eigen(const Transform<To, From>& transform) noexcept {
    using Scalar = typename Target::Scalar;
    static_assert(std::is_same_v<Target, Eigen::Matrix<Scalar, 4, 4>> ||
                      std::is_same_v<Target, Eigen::Transform<Scalar, 3, Eigen::Projective>>,
                  "Matrix4d, Matrix4f, Projective3d or Projective3f; to_eigen_affine() has the others");
    Target result;
    for (glm::length_t column = 0; column < 4; ++column)
        for (glm::length_t row = 0; row < 4; ++row)
            result(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
                static_cast<Scalar>(transform.matrix()[column][row]);
    return result;
}

// Makes an Affine3d or Affine3f of a Transform.
// Bad input: empty where the last row is not exactly (0, 0, 0, 1), so that no projection is lost; every texgen matrix
// of a perspective projector is such a one.
template <class Target = Eigen::Affine3d, class To, class From>
std::optional<Target> to_eigen_affine(const Transform<To, From>& transform) noexcept {
    static_assert(std::is_same_v<Target, Eigen::Affine3d> || std::is_same_v<Target, Eigen::Affine3f>,
                  "Affine3d or Affine3f");
    const glm::dmat4& m = transform.matrix();
    if (!(m[0][3] == 0.0 && m[1][3] == 0.0 && m[2][3] == 0.0 && m[3][3] == 1.0)) return std::nullopt;
    return Target(to_eigen<Eigen::Matrix<typename Target::Scalar, 4, 4>>(transform));
}

// Makes an Eigen vector of a GLM vector.
// Guarantee: each element is kept. Shapes: glm::vec2, vec3, vec4 and dvec2, dvec3, dvec4; column vectors of as many
// rows.
template <glm::length_t N, detail::FloatOrDouble Scalar, glm::qualifier Q>
Eigen::Matrix<Scalar, static_cast<int>(N), 1> to_eigen(const glm::vec<N, Scalar, Q>& vector) noexcept {
    Eigen::Matrix<Scalar, static_cast<int>(N), 1> result;
    for (glm::length_t i = 0; i < N; ++i) result(static_cast<Eigen::Index>(i)) = vector[i];
    return result;
}

// Makes a GLM vector of an Eigen vector.
template <class Vector>
requires detail::EigenDense<Vector> && detail::FloatOrDouble<typename Vector::Scalar> &&
    (Vector::ColsAtCompileTime == 1 && Vector::RowsAtCompileTime >= 2 &&
     Vector::RowsAtCompileTime <=
         4) glm::vec<Vector::RowsAtCompileTime, typename Vector::Scalar> to_glm(const Vector& vector) {
    const Eigen::Matrix<typename Vector::Scalar, Vector::RowsAtCompileTime, 1> value = vector;
    glm::vec<Vector::RowsAtCompileTime, typename Vector::Scalar> result;
    for (int i = 0; i < Vector::RowsAtCompileTime; ++i) result[static_cast<glm::length_t>(i)] = value(i);
    return result;
}

// Views the floats of an Eigen object as points.
// Guarantee: they are not copied, and must outlive the view; no allocation, noexcept.
// Shapes: points as columns of a 3 x N (Matrix3Xf, Ref, Map, middleRows<3>(i), but not block(i, 0, 3, n), whose rows
// are not known when it is compiled; interleaved where its columns are dense, planar where it is row-major), as rows of
// an N x 3, or as three vectors of coordinates of one size and one inner stride. Any strides. A 3 x 3 may be either, and
// is refused: Map<const Matrix3Xf>(triangle.data(), 3, 3) are its columns.
// Bad input: three vectors that disagree, and strides from point to point that are negative, are asserted; without
// assertions they are no points.
template <class... Floats>
Positions<Object> object_space(Floats&&... values) noexcept requires detail::EigenPositions<Floats...> {
    return detail::positions_of<Object>(values.derived()...);
}
auto object_space(auto&&... values) requires detail::EigenTemporaries<decltype(values)...>
= delete;

// Views the same as points in the world.
template <class... Floats>
Positions<World> world_space(Floats&&... values) noexcept requires detail::EigenPositions<Floats...> {
    return detail::positions_of<World>(values.derived()...);
}
auto world_space(auto&&... values) requires detail::EigenTemporaries<decltype(values)...>
= delete;

// Views the same as points in the eye's space.
template <class... Floats>
Positions<Eye> eye_space(Floats&&... values) noexcept requires detail::EigenPositions<Floats...> {
    return detail::positions_of<Eye>(values.derived()...);
}
auto eye_space(auto&&... values) requires detail::EigenTemporaries<decltype(values)...>
= delete;

// Views the same as fragments: x and y in pixels, z the depth that the buffer holds.
template <class... Floats>
Positions<Window> window_space(Floats&&... values) noexcept requires detail::EigenPositions<Floats...> {
    return detail::positions_of<Window>(values.derived()...);
}
auto window_space(auto&&... values) requires detail::EigenTemporaries<decltype(values)...>
= delete;

// Views the floats of a vector without gaps (VectorXf, Ref<ArrayXf>, a column of a matrix), or of a row-major matrix or
// array that owns them (height x width fragments): an output of Texcoords, or an input of alphas.
// Guarantee: a view as above, std::span<const float> of a const object. A vector that may have gaps does not compile.
auto floats(detail::EigenSpan auto&& values) noexcept {
    return std::span(values.derived().data(), static_cast<std::size_t>(values.size()));
}

}  // namespace TEXGEN_NAMESPACE
