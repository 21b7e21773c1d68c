#pragma once

// Which objects of Eigen the functions of eigen.hpp take, and which points their floats are.

#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "../texcoord.hpp"
#include "../transform.hpp"
#include "assert.hpp"
#include "language.hpp"

namespace TEXGEN_DETAIL {

template <class T>
concept FloatOrDouble = std::same_as<T, float> || std::same_as<T, double>;

// Concepts ask whether one of these can be called with an object. Not closures: nvcc's front end finds none callable.
template <class Derived>
void take_dense(const Eigen::DenseBase<Derived>&);
template <class Derived>
void take_owner(const Eigen::PlainObjectBase<Derived>&);
template <FloatOrDouble Scalar, int Mode, int Options>
void take_transform(const Eigen::Transform<Scalar, 3, Mode, Options>&);
template <class To, class From>
void take_transform_of_spaces(const Transform<To, From>&);

template <class T>
concept EigenDense = requires(const T& t) {
    take_dense(t);
};

template <class T>
concept EigenTransform = requires(const T& t) {
    take_transform(t);
};

template <class T>
concept TransformOfSpaces = requires(const T& t) {
    take_transform_of_spaces(t);
};

template <class T>
concept EigenMatrix4 =
    EigenDense<T> && FloatOrDouble<typename T::Scalar> && T::RowsAtCompileTime == 4 && T::ColsAtCompileTime == 4;

// Whether a type owns its elements, as a matrix does, and a class derived from one.
template <class T>
inline constexpr bool owns_elements = requires(const std::remove_cvref_t<T>& t) {
    take_owner(t);
};

// The type of an object that a caller may see as its base only, MatrixBase or ArrayBase.
template <class T>
using EigenDerived = std::remove_cvref_t<decltype(std::declval<T&>().derived())>;

// Floats in memory that outlives the call: a view, or an lvalue that owns them. T is deduced as a forwarding reference.
template <class T>
concept EigenFloats = EigenDense<std::remove_cvref_t<T>> && requires(const EigenDerived<T>& t) {
    { t.data() } -> std::convertible_to<const float*>;
} && bool(EigenDerived<T>::Flags& Eigen::DirectAccessBit) &&
    (std::is_lvalue_reference_v<T> || !owns_elements<EigenDerived<T>>);

// Points are the columns of three rows, or the rows of three columns. A 3x3 could be either, and is refused.
template <class T>
concept EigenPoints = EigenFloats<T> &&
                      (EigenDerived<T>::RowsAtCompileTime == 3) != (EigenDerived<T>::ColsAtCompileTime == 3);

template <class T>
concept EigenCoordinates = EigenFloats<T> && bool(EigenDerived<T>::IsVectorAtCompileTime);

template <class... Floats>
concept EigenPositions = (sizeof...(Floats) == 1 && (EigenPoints<Floats> && ...)) ||
                         (sizeof...(Floats) == 3 && (EigenCoordinates<Floats> && ...));

// Floats without gaps in memory; a matrix of them is row-major, as fragments are.
template <class T>
concept EigenSpan = EigenFloats<T> &&
    ((bool(EigenDerived<T>::IsVectorAtCompileTime) && EigenDerived<T>::InnerStrideAtCompileTime == 1) ||
     (bool(EigenDerived<T>::IsRowMajor) && owns_elements<EigenDerived<T>>));

// Three coordinates of which one is a temporary that owns its floats. They are ranges of floats, so that without this
// concept they would convert to std::span, and the view would dangle.
template <class... Floats>
concept EigenTemporaries = sizeof...(Floats) == 3 && (EigenDense<std::remove_cvref_t<Floats>> && ...) &&
                           ((!std::is_lvalue_reference_v<Floats> && owns_elements<Floats>) || ...);

template <class Space, class Points>
Positions<Space> positions_of(const Points& points) noexcept {
    constexpr bool in_columns = Points::RowsAtCompileTime == 3;
    const Eigen::Index count = in_columns ? points.cols() : points.rows();
    const Eigen::Index next_point = in_columns ? points.colStride() : points.rowStride();
    const Eigen::Index next_coordinate = in_columns ? points.rowStride() : points.colStride();
    const bool forwards = next_point >= 0;
    TEXGEN_ASSERT(forwards);
    if (count == 0 || !forwards) return {nullptr, nullptr, nullptr, 0, sizeof(float)};
    const float* const x = points.data();
    return {x, x + next_coordinate, x + 2 * next_coordinate, static_cast<std::size_t>(count),
            static_cast<std::size_t>(next_point) * sizeof(float)};
}

template <class Space, class X, class Y, class Z>
Positions<Space> positions_of(const X& x, const Y& y, const Z& z) noexcept {
    const Eigen::Index next = x.innerStride();
    const bool alike =
        x.size() == y.size() && x.size() == z.size() && next == y.innerStride() && next == z.innerStride() && next >= 0;
    TEXGEN_ASSERT(alike);
    if (x.size() == 0 || !alike) return {nullptr, nullptr, nullptr, 0, sizeof(float)};
    return {x.data(), y.data(), z.data(), static_cast<std::size_t>(x.size()),
            static_cast<std::size_t>(next) * sizeof(float)};
}

}  // namespace TEXGEN_DETAIL
