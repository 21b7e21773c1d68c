#pragma once

// What the definitions of reference.hpp are made of: floats as given, mixtures, and the barycentrics of the window. It
// shares nothing with the fast path.

#include <cmath>

#include <Eigen/Core>
#include <glm/vec4.hpp>

#include "../primitives.hpp"
#include "assert.hpp"
#include "language.hpp"

namespace TEXGEN_NAMESPACE::reference {
inline namespace TEXGEN_COMPILER {
namespace detail {

// A type that can hold floats. An integer type is refused, as it would drop their fractions without a word.
template <class Scalar>
concept HoldsFloats = !Eigen::NumTraits<Scalar>::IsInteger;

// Converts the very float that was given. It is read as a volatile because g++ 12 takes (double)(float)x of neighbours
// for x where it inlines a caller that rounds x to float.
template <class Scalar>
Scalar exactly(float value) {
    const volatile float given = value;
    return Scalar(static_cast<float>(given));
}

template <class Scalar>
Eigen::Matrix<Scalar, 4, 1> exactly(const glm::vec4& v) {
    return {exactly<Scalar>(v.x), exactly<Scalar>(v.y), exactly<Scalar>(v.z), exactly<Scalar>(v.w)};
}

template <class Scalar>
Eigen::Matrix<Scalar, 4, 1> mix(const Eigen::Matrix<Scalar, 4, 1>& a, const Eigen::Matrix<Scalar, 4, 1>& b,
                                const Scalar& alpha) {
    return Scalar(Scalar(1.0f) - alpha) * a + alpha * b;
}

template <class Scalar>
Scalar cross(const Scalar& ax, const Scalar& ay, const Scalar& bx, const Scalar& by) {
    return ax * by - ay * bx;
}

// The two products cancel in double where a triangle is a sliver; the fused form keeps 1.5 ulp of the difference.
// Source: Kahan.
inline double cross(double ax, double ay, double bx, double by) noexcept {
    const double product = ay * bx;
    return std::fma(ax, by, -product) + std::fma(-ay, bx, product);
}

template <class Scalar>
struct Vertex {
    Scalar x, y, w;
    Eigen::Matrix<Scalar, 4, 1> strq;

    explicit Vertex(const WindowVertex& vertex)
        : x(exactly<Scalar>(vertex.window.x)),
          y(exactly<Scalar>(vertex.window.y)),
          w(exactly<Scalar>(vertex.clip_w)),
          strq(exactly<Scalar>(vertex.strq)) {}
};

// Twice the signed area of the triangle (from, to, point).
template <class Scalar>
Scalar edge(const Vertex<Scalar>& from, const Vertex<Scalar>& to, const Scalar& x, const Scalar& y) {
    return cross(Scalar(from.x - x), Scalar(from.y - y), Scalar(to.x - x), Scalar(to.y - y));
}

template <class Scalar>
struct WindowTriangle {
    Vertex<Scalar> a, b, c;
    Scalar side;  // 1, or -1 for a triangle that is seen from behind

    explicit WindowTriangle(const Triangle& triangle) : a(triangle.a), b(triangle.b), c(triangle.c) {
        const Scalar area = edge(a, b, c.x, c.y), zero(Scalar(0.0f));
        side = Scalar(area > zero ? 1.0f : area < zero ? -1.0f : 0.0f);
        TEXGEN_ASSERT(side != zero && a.w > zero && b.w > zero && c.w > zero);
    }

    // lambda_i / w_i for each corner, all times the same positive number: twice the area times the three w. It cancels
    // in every quotient, so nothing is divided by the area.
    Eigen::Matrix<Scalar, 3, 1> weights(const Scalar& x, const Scalar& y) const {
        return {Scalar(side * edge(b, c, x, y) * (b.w * c.w)), Scalar(side * edge(c, a, x, y) * (c.w * a.w)),
                Scalar(side * edge(a, b, x, y) * (a.w * b.w))};
    }
};

}  // namespace detail
}  // namespace TEXGEN_COMPILER
}  // namespace TEXGEN_NAMESPACE::reference
