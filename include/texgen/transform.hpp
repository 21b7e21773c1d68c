#pragma once

// Floor 1: a 4x4 matrix that knows the two spaces it joins.

#include "detail/language.hpp"

#include <optional>
#include <span>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "detail/arithmetic/inverse.hpp"
#include "detail/arithmetic/rounding.hpp"
#include "detail/arithmetic/widen.hpp"
#include "detail/assert.hpp"

namespace TEXGEN_NAMESPACE {

// The spaces. They are names only and stay incomplete.
struct Object;
struct World;
struct Eye;
struct ProjectorEye;
struct ProjectorClip;
struct Texture;
struct Window;  // x, y in pixels (centres at +0.5), z the depth that the buffer holds; y as the viewport's

// A 4x4 matrix of doubles from one space to another. There is no default: a Transform was always given a value.
// Guarantee: holds its matrix unchanged; rounded() rounds each element once; no allocation, noexcept.
// Shape: column vectors, v_to = matrix() * v_from.
// Bad input: NaN and infinity are kept as they are. An element beyond the largest float rounds to infinity.
template <class To, class From>
class Transform {
public:
    explicit Transform(const glm::mat4& matrix) noexcept : matrix_(detail::widened(matrix)) {}
    explicit Transform(const glm::dmat4& matrix) noexcept : matrix_(matrix) {}

    // Refuses an affine matrix whose rows stand in columns: GLM makes a mat4 of it without a word, with the translation
    // in its last row. Its transpose, a mat4x3, is right.
    template <class Number, glm::qualifier Qualifier>
    explicit Transform(const glm::mat<3, 4, Number, Qualifier>&) = delete;

    const glm::dmat4& matrix() const noexcept { return matrix_; }
    glm::mat4 rounded() const noexcept { return glm::mat4(matrix_); }

    // Returns the matrix M for v_to = v_from * M, as in HLSL's mul(v, M): the transpose of rounded(). What holds its
    // rows one after another (row_major in HLSL, an XMFLOAT4X4) takes the memory of rounded() instead.
    glm::mat4 rounded_for_row_vectors() const noexcept { return glm::transpose(rounded()); }

private:
    glm::dmat4 matrix_;
};

// Composes from right to left: A from B times B from C is A from C.
template <class A, class B, class C>
Transform<A, C> operator*(const Transform<A, B>& a_from_b, const Transform<B, C>& b_from_c) noexcept {
    return Transform<A, C>(a_from_b.matrix() * b_from_c.matrix());
}

// Vectors and matrices do not say what space they are of: points go by project() and generate(), all else by matrix().
template <class To, class From, glm::length_t Size, class Number, glm::qualifier Qualifier>
void operator*(const Transform<To, From>&, const glm::vec<Size, Number, Qualifier>&) = delete;
template <class To, class From, glm::length_t Columns, glm::length_t Rows, class Number, glm::qualifier Qualifier>
void operator*(const Transform<To, From>&, const glm::mat<Columns, Rows, Number, Qualifier>&) = delete;

// Makes the Transform of a matrix M that was written for row vectors, v_to = v_from * M, as Direct3D's and Unreal's
// are: from_row_vectors<Eye, World>(view) is its transpose.
// Guarantee: each element is kept exactly; no allocation, noexcept.
// Shape: matrix[column][row] is the element of M, which has its translation in row 3. Of 16 floats: row after row, as
// an XMFLOAT4X4 m is in memory: std::span<const float, 16>(&m.m[0][0], 16). (Those 16 copied into a mat4 are the
// transpose already: a Transform of it is right.)
// Bad input: as Transform.
template <class To, class From>
Transform<To, From> from_row_vectors(const glm::mat4& matrix) noexcept;
template <class To, class From>
Transform<To, From> from_row_vectors(const glm::dmat4& matrix) noexcept;
template <class To, class From>
Transform<To, From> from_row_vectors(const std::span<const float, 16>& rows) noexcept;

// The roles, named as the papers name them; the type says destination from source.
using ModelMatrix = Transform<World, Object>;                        // M
using ViewMatrix = Transform<Eye, World>;                            // V_e
using ModelviewMatrix = Transform<Eye, Object>;                      // V_e M
using CameraPose = Transform<World, Eye>;                            // V_e^-1
using ProjectorView = Transform<ProjectorEye, World>;                // V_p
using ProjectorProjection = Transform<ProjectorClip, ProjectorEye>;  // P_p
using ProjectorMatrix = Transform<ProjectorClip, World>;             // P_p V_p
using ScaleBias = Transform<Texture, ProjectorClip>;                 // S
using ObjectTexgen = Transform<Texture, Object>;                     // T_o
using EyeTexgen = Transform<Texture, Eye>;                           // T_e
using WorldTexgen = Transform<Texture, World>;                       // S P_p V_p
using WindowTexgen = Transform<Texture, Window>;                     // T_w

// Inverts a transform.
// Guarantee: where it answers, each element of X = A^-1 is within 2 double ulp of the largest of its terms in X A X,
// while the condition of A stays below 1e8 (its rows scaled to largest elements near 1, and then its columns), however
// far apart its elements are, as long as that term is, likewise scaled, above 2^-900; an element without terms is 0.
// The answer is certified by its residual, never by the size of a determinant, so any uniform scale is regular. An
// affine A has an exactly affine X. No allocation, noexcept.
// Bad input: empty for a matrix that is singular to working precision, is not finite, or whose inverse overflows, and
// where an element is below 2^-900 of others in its row or column: scaling could round it.
// Source: the residual bounds the error of any inverse: Higham, Accuracy and Stability of Numerical Algorithms, 14.
template <class To, class From>
std::optional<Transform<From, To>> inverse(const Transform<To, From>& transform) noexcept;

// Bounds |inverse - transform^-1|, element by element, for any `inverse`: that of inverse(), of inverse_rigid(), a
// rounded one, or one from elsewhere.
// Guarantee: next to the error itself while the condition, of rows and columns scaled, stays below 1e7 and these are
// within 2^40 of one another in size; never below it. No allocation, noexcept; it costs about what inverse() does.
// Shape: elements as in inverse.matrix().
// Bad input: infinite where inverse() refuses the transform; a NaN or an infinity of the inverse stays in its row, as
// does one that their products make.
// Source: the residual bounds the error of any inverse: Higham, Accuracy and Stability of Numerical Algorithms, 14.
template <class To, class From>
glm::dmat4 inverse_error_bound(const Transform<To, From>& transform, const Transform<From, To>& inverse) noexcept;

// Inverts a rotation and a translation, by transposing: the inverse for a camera or a projector that is posed without
// scale.
// Guarantee: exact transposition of the rotation; the translation -R^T t within 1 double ulp of its exact value for
// that rotation, while its terms do not cancel below 2^-50 of the largest. No allocation, noexcept.
// Precondition, asserted to 1e-3: the transform is rigid (an orthonormal rotation and a translation). The last row is
// read for that alone.
// Bad input: a NaN or an infinity is not asserted, and stays in what is made of it.
template <class To, class From>
Transform<From, To> inverse_rigid(const Transform<To, From>& transform) noexcept;

}  // namespace TEXGEN_NAMESPACE

#include "detail/matrices/transform.inc.hpp"
