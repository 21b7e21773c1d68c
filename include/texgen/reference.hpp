#pragma once

// Floor 6: the definitions, straight from the papers, generic over the scalar: double for pictures and checks, an exact
// rational for the judge. Nothing here is fast, and nothing is shared with the fast path.
//
// A Scalar needs an exact constructor from float, + - * / and comparisons, and Eigen::NumTraits; integers are refused.
// What its arithmetic loses is lost: float finds no area in slivers that have one, and asserts.

#include "detail/language.hpp"

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include <Eigen/Core>
#include <glm/vec2.hpp>

#include "conventions.hpp"
#include "detail/assert.hpp"
#include "detail/reference.hpp"
#include "primitives.hpp"
#include "texcoord.hpp"

namespace TEXGEN_NAMESPACE::reference {
inline namespace TEXGEN_COMPILER {

// Column vectors of a scalar.
template <class Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
template <class Scalar>
using Vector4 = Eigen::Matrix<Scalar, 4, 1>;

// The homogeneous (s, t, r, q) that perspective-correct interpolation defines at a point of the window:
// f = (sum lambda_i f_i / w_i) / (sum lambda_i / w_i), lambda the barycentrics of the window.
// Guarantee: exact where the Scalar is; no allocation but the Scalar's own.
// Shape: the window in pixels, pixel centres at +0.5; any point of the plane, where the interpolated 1/w is not 0.
// Bad input: precondition, asserted: the triangle has an area and its clip_w are positive.
// Source: OpenGL 2.1 specification, 3.5.1; Heckbert and Moreton, Interpolation for Polygon Texture Mapping and Shading.
template <detail::HoldsFloats Scalar>
Vector4<Scalar> strq(const Triangle& triangle, Scalar window_x, Scalar window_y) {
    const detail::WindowTriangle<Scalar> t(triangle);
    const Vector3<Scalar> weights = t.weights(window_x, window_y);
    const Vector4<Scalar> sum = weights[0] * t.a.strq + weights[1] * t.b.strq + weights[2] * t.c.strq;
    return sum / Scalar(weights[0] + weights[1] + weights[2]);
}

// The homogeneous (s, t, r, q) at alpha: (1 - alpha) A + alpha B.
// Guarantee: exact where the Scalar is. Shape: alpha = 0 is segment.a, alpha = 1 is segment.b; any alpha.
template <detail::HoldsFloats Scalar>
Vector4<Scalar> strq(const Segment& segment, Scalar alpha) {
    return detail::mix(detail::exactly<Scalar>(segment.a), detail::exactly<Scalar>(segment.b), alpha);
}

// s/q, t/q, r/q, whatever the sign of q: the caller has to look at that.
// Bad input: q = 0 is the Scalar's own division by zero.
template <detail::HoldsFloats Scalar>
Vector3<Scalar> quotient(const Vector4<Scalar>& strq) {
    return {Scalar(strq[0] / strq[3]), Scalar(strq[1] / strq[3]), Scalar(strq[2] / strq[3])};
}

// The three ways to the texture coordinate of C = (1 - alpha) A + alpha B, by their numbers in the C_u note. (1) and
// (2) are equal. (3) is not: it agrees only where A_q = B_q, at the ends, and where A and B fall on the same point.

// (1), direct projection: C in space first, then C_u = ((1 - alpha) A_u + alpha B_u) / ((1 - alpha) A_q + alpha B_q).
// Shape: the points before texture_from_space is applied, w = 1.
template <detail::HoldsFloats Scalar>
Vector3<Scalar> direct_projection(const Eigen::Matrix<Scalar, 4, 4>& texture_from_space, const Vector3<Scalar>& a,
                                  const Vector3<Scalar>& b, Scalar alpha) {
    const Vector3<Scalar> c = Scalar(Scalar(1.0f) - alpha) * a + alpha * b;
    const Vector4<Scalar> projected = c[0] * texture_from_space.col(0) + c[1] * texture_from_space.col(1) +
                                      c[2] * texture_from_space.col(2) + texture_from_space.col(3);
    return quotient(projected);
}

// (2), interpolate then divide: what the library does.
template <detail::HoldsFloats Scalar>
Vector3<Scalar> interpolate_then_divide(const Vector4<Scalar>& a, const Vector4<Scalar>& b, Scalar alpha) {
    return quotient(detail::mix(a, b, alpha));
}

// (3), divide then interpolate: the wrong one, which bends every line. For pictures and tests only.
template <detail::HoldsFloats Scalar>
Vector3<Scalar> wrong_divide_then_interpolate(const Vector4<Scalar>& a, const Vector4<Scalar>& b, Scalar alpha) {
    return Scalar(Scalar(1.0f) - alpha) * quotient(a) + alpha * quotient(b);
}

// (3) over a triangle: s/q, t/q and r/q of the vertices, interpolated as ordinary coordinates are (perspective-correct
// in the camera's w). The wrong one. For pictures and tests only; preconditions as strq().
template <detail::HoldsFloats Scalar>
Vector3<Scalar> wrong_divide_then_interpolate(const Triangle& triangle, Scalar window_x, Scalar window_y) {
    const detail::WindowTriangle<Scalar> t(triangle);
    const Vector3<Scalar> weights = t.weights(window_x, window_y);
    const Vector3<Scalar> sum =
        weights[0] * quotient(t.a.strq) + weights[1] * quotient(t.b.strq) + weights[2] * quotient(t.c.strq);
    return sum / Scalar(weights[0] + weights[1] + weights[2]);
}

// How far interpolate() may be from the definition, before the one rounding to float. With E = interpolation_error and
// k_i = lambda_i / w_i, s is within E (sum |k_i s_i| + |s| Q) / (|sum k_i q_i| - E Q), Q = sum |k_i q_i|; and the sign
// of q is right where |sum k_i q_i| > E Q. Six roundings make each sum: 2 in an edge, 2 in the products, 2 in the sum.
inline constexpr double interpolation_error = 0x1p-50;

// The definition at the fragments of a rect, in double.
// Guarantee: as interpolation_error says, where every difference of a window coordinate and a pixel centre is exact in
// double: coordinates that are 0 or at least 2^-13, below 2^17. No allocation, noexcept.
// Shape: outputs are row-major, width * height; an empty span is not computed. In front of the projector (q > 0) s, t,
// r are the quotients, and lit is 1 where the s and t, and with a depth the r, that are (or would be) written lie in
// the closed region, else 0. Behind (q <= 0) all four are 0. Outside the triangle the values are those of its plane;
// where the interpolated 1/w is not positive nothing is promised.
// Bad input: preconditions, asserted: as strq(), and the sizes agree. NaN and infinity in a coordinate stay in that
// coordinate; in q they make every fragment dark.
inline void interpolate(const Triangle& triangle, const TextureRegion& region, const FragmentRect& rect,
                        const Texcoords& out) noexcept {
    const auto width = static_cast<std::size_t>(rect.width > 0 ? rect.width : 0);
    const auto height = static_cast<std::size_t>(rect.height > 0 ? rect.height : 0);
    for ([[maybe_unused]] const std::span<float> span : {out.s, out.t, out.r, out.lit})
        TEXGEN_ASSERT(span.empty() || span.size() == width * height);

    const std::optional<glm::dvec2> depth = region.depth();
    const detail::WindowTriangle<double> vertices(triangle);
    for (std::size_t row = 0; row < height; ++row) {
        const double y = rect.y + static_cast<double>(row) + 0.5;  // integers
        for (std::size_t column = 0; column < width; ++column) {
            const double x = rect.x + static_cast<double>(column) + 0.5;  // integers
            const Vector3<double> k = vertices.weights(x, y);
            const Vector4<double> strq = k[0] * vertices.a.strq + k[1] * vertices.b.strq + k[2] * vertices.c.strq;
            const bool in_front = strq[3] > 0.0 && std::isfinite(strq[3]);
            const auto divided = [&](int i) { return in_front ? static_cast<float>(strq[i] / strq[3]) : 0.0f; };
            const auto s = detail::exactly<double>(divided(0));
            const auto t = detail::exactly<double>(divided(1));
            const auto r = detail::exactly<double>(divided(2));
            const bool lit = in_front && s >= (region.min)().x && s <= (region.max)().x && t >= (region.min)().y &&
                             t <= (region.max)().y && (!depth || (r >= depth->x && r <= depth->y));
            const std::size_t fragment = row * width + column;
            if (!out.s.empty()) out.s[fragment] = static_cast<float>(s);
            if (!out.t.empty()) out.t[fragment] = static_cast<float>(t);
            if (!out.r.empty()) out.r[fragment] = static_cast<float>(r);
            if (!out.lit.empty()) out.lit[fragment] = lit ? 1.0f : 0.0f;
        }
    }
}

}  // namespace TEXGEN_COMPILER
}  // namespace TEXGEN_NAMESPACE::reference
