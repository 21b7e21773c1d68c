#pragma once

// Floor 2: the projector P_p V_p. A right-handed eye space that looks down -z, as OpenGL's; the conventions decide the
// rest: where near and far land, and which way y points in NDC.

#include "detail/language.hpp"

#include <cmath>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/expansion.hpp"
#include "detail/arithmetic/inverse.hpp"
#include "detail/arithmetic/rounding.hpp"
#include "transform.hpp"

namespace TEXGEN_NAMESPACE {

// z_near and z_far are distances in front of the eye, in the units of the world. z_far may be infinite.
// reversed_depth maps near to 1 and far to the other end of the range, so that r = 1 at near.
struct PerspectiveLens {
    Angle fovy;  // the full vertical angle, between 0 and 180 degrees, both excluded
    double aspect;
    double z_near, z_far;
    bool reversed_depth = false;
};

// The rectangle is that of the near plane. left > right or bottom > top mirrors the picture, as in OpenGL.
struct FrustumLens {
    double left, right, bottom, top, z_near, z_far;
};

// z_near and z_far may have any sign; left > right or bottom > top mirrors the picture, as in OpenGL.
struct OrthographicLens {
    double left, right, bottom, top, z_near, z_far;
};

// Where it stands, what it looks at, and what is above, in the world.
struct Aim {
    glm::dvec3 position, target, up;
};

namespace detail {
inline namespace TEXGEN_COMPILER {

// What lenses need of two numbers: their sum and difference, both in halves where a sum could leave the range. (Elsewhere
// halves would lose the last bit of subnormal numbers.)
class LensExtent {
public:
    LensExtent(double from, double to) noexcept : unit_(larger(std::fabs(from), std::fabs(to)) < 0x1p1000 ? 1.0 : 0.5) {
        sum_ = unit_ * to + unit_ * from;
        difference_ = unit_ * to - unit_ * from;
    }

    // (to + from) / (to - from), and number / (to - from) for one of the two.
    double sum_over_length() const noexcept { return sum_ / difference_; }
    double end_over_length(double end) const noexcept { return unit_ * end / difference_; }

    // 2 number / (to - from), where neither twice the number nor half the difference leaves the range on the way.
    double twice_over_length(double number) const noexcept {
        if (unit_ < 1.0) return number / difference_;
        return std::fabs(difference_) < 1.0 ? 2.0 * number / difference_ : number / (0.5 * difference_);
    }

private:
    double unit_, sum_, difference_;
};

// Row z of a perspective matrix: clip z = scale * z_eye + offset, clip w = -z_eye.
struct DepthRow {
    double scale, offset;
};

inline DepthRow perspective_depth(double z_near, double z_far, bool reversed, DepthRange range) noexcept {
    const bool infinite = !is_finite(z_far);
    const LensExtent depth(z_near, z_far);
    const double far_ratio = infinite ? 1.0 : depth.end_over_length(z_far);    // far / (far - near)
    const double near_ratio = infinite ? 0.0 : depth.end_over_length(z_near);  // near / (far - near)
    if (range == DepthRange::negative_one_to_one) {
        const double scale = infinite ? 1.0 : depth.sum_over_length();
        const double offset = z_near * (2.0 * far_ratio);
        return reversed ? DepthRow{scale, offset} : DepthRow{-scale, -offset};
    }
    return reversed ? DepthRow{near_ratio, z_near * far_ratio} : DepthRow{-far_ratio, -z_near * far_ratio};
}

inline std::optional<ProjectorProjection> checked_projection(glm::dmat4 matrix, Conventions conventions) noexcept {
    if (conventions.ndc_y == NdcY::down) {
        for (glm::length_t column = 0; column < 4; ++column) matrix[column][1] = -matrix[column][1];
    }
    const bool usable = is_finite(matrix) && matrix[0][0] != 0.0 && matrix[1][1] != 0.0;
    return usable ? std::optional(ProjectorProjection(matrix)) : std::nullopt;
}

inline int largest_exponent(const glm::dvec3& v) noexcept {
    return std::ilogb(std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z))));
}

// v times a power of two, so that its largest component is in [1, 2); 0 for zero and for what is not finite.
inline glm::dvec3 scaled_near_one(const glm::dvec3& v) noexcept {
    if (!is_finite(v.x) || !is_finite(v.y) || !is_finite(v.z)) return glm::dvec3(0.0);
    if (v.x == 0.0 && v.y == 0.0 && v.z == 0.0) return v;
    const int exponent = largest_exponent(v);
    return glm::dvec3(std::scalbn(v.x, -exponent), std::scalbn(v.y, -exponent), std::scalbn(v.z, -exponent));
}

inline double length(const glm::dvec3& v) noexcept { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

inline glm::dvec3 cross(const glm::dvec3& a, const glm::dvec3& b) noexcept {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}

// v / |v| for a v near 1. The length is that of the exact squares, rounded once, so that it adds next to nothing.
inline glm::dvec3 normalized(const glm::dvec3& v) noexcept {
    DoubleDouble square{0.0, 0.0};
    for (glm::length_t i = 0; i < 3; ++i) square = add_product(square, v[i], v[i]);
    const double root = std::sqrt(square.high);
    return v / (root + 0.5 * (std::fma(-root, root, square.high) + square.low) / root);
}

// row . point for a row of a rotation, within 1 ulp however its terms cancel: far from the origin they do. The point is
// brought to where neither products nor their last bits leave the range.
inline double rotated(const glm::dvec3& row, const glm::dvec3& point) noexcept {
    if (point.x == 0.0 && point.y == 0.0 && point.z == 0.0) return 0.0;
    const int exponent = largest_exponent(point);
    const int shift = exponent > 900 ? 900 - exponent : exponent < -700 ? -700 - exponent : 0;
    Expansion<6> sum;
    for (glm::length_t i = 0; i < 3; ++i) sum.add_product(row[i], std::scalbn(point[i], shift));
    return std::scalbn(sum.estimate(), -shift);
}

// A difference of two points as it is, unrounded: the sum of both.
struct Difference {
    glm::dvec3 high, low;
};

// to - from times a power of two, so that the largest component is in [1, 2); 0 where it is 0 or not finite.
inline Difference scaled_difference(const glm::dvec3& to, const glm::dvec3& from) noexcept {
    const glm::dvec3 rounded = to - from;
    const bool is_in_range = is_finite(rounded.x) && is_finite(rounded.y) && is_finite(rounded.z);
    const double unit = is_in_range ? 1.0 : 0.5;
    Difference result{};
    for (glm::length_t i = 0; i < 3; ++i) {
        const DoubleDouble component = two_sum(unit * to[i], -unit * from[i]);
        result.high[i] = component.high;
        result.low[i] = component.low;
    }
    const glm::dvec3 scaled = scaled_near_one(result.high);
    if (!(length(scaled) > 0.0)) return Difference{};
    const int exponent = largest_exponent(result.high);
    for (glm::length_t i = 0; i < 3; ++i) result.low[i] = std::scalbn(result.low[i], -exponent);
    result.high = scaled;
    return result;
}

// a x b within 1 ulp, component by component.
inline glm::dvec3 cross(const Difference& a, const glm::dvec3& b) noexcept {
    glm::dvec3 result(0.0);
    for (glm::length_t i = 0; i < 3; ++i) {
        const glm::length_t j = (i + 1) % 3;
        const glm::length_t k = (i + 2) % 3;
        Expansion<8> sum;
        sum.add_product(a.high[j], b[k]);
        sum.add_product(a.low[j], b[k]);
        sum.add_product(-a.high[k], b[j]);
        sum.add_product(-a.low[k], b[j]);
        result[i] = sum.estimate();
    }
    return result;
}

}  // namespace TEXGEN_COMPILER
}  // namespace detail

// Guarantee: each element within 4 double ulp (those of subnormal numbers too), for every lens that is not refused; no
// allocation, noexcept. For OpenGL's conventions, with f = cot(fovy / 2):
//
//     | f/aspect  0            0                     0           |
//     |    0      f            0                     0           |
//     |    0      0  (far + near)/(near - far)  2 far near/(near - far) |
//     |    0      0           -1                     0           |
//
// zero_to_one has far/(near - far) and far near/(near - far) in row z; y down negates row y.
// Shape: projector eye space (looking down -z) to projector clip space.
// Bad input: empty unless 0 < fovy < 180 degrees, aspect > 0 and finite, 0 < z_near < z_far, and z_near finite. Empty, too,
// where the matrix is none of doubles: an element would be infinite, or the scale of x or y 0.
// Source: Everitt, Projective Texture Mapping, P_p in (3); OpenGL 2.1 specification, 2.11 (gluPerspective's lens).
inline std::optional<ProjectorProjection> perspective(const PerspectiveLens& lens, Conventions conventions) noexcept {
    const double half_angle = 0.5 * lens.fovy.in_radians();
    if (!(half_angle > 0.0 && half_angle < 0.5 * 3.14159265358979323846)) return std::nullopt;
    if (!(lens.aspect > 0.0 && detail::is_finite(lens.aspect))) return std::nullopt;
    if (!(lens.z_near > 0.0 && lens.z_near < lens.z_far)) return std::nullopt;
    // cos / sin and not 1 / tan: two correctly rounded functions and one division, at any angle whose half is exact.
    const double focal_length =
        half_angle < 0x1p-30 ? 2.0 / lens.fovy.in_radians() : std::cos(half_angle) / std::sin(half_angle);
    const detail::DepthRow depth =
        detail::perspective_depth(lens.z_near, lens.z_far, lens.reversed_depth, conventions.depth);
    glm::dmat4 matrix(0.0);
    matrix[0][0] = focal_length / lens.aspect;
    matrix[1][1] = focal_length;
    matrix[2][2] = depth.scale;
    matrix[3][2] = depth.offset;
    matrix[2][3] = -1.0;
    return detail::checked_projection(matrix, conventions);
}

// Guarantee, shape: as perspective(); the off-axis terms (right + left)/(right - left) and (top + bottom)/(top - bottom)
// stand in column z.
// Bad input: empty unless all fields are finite, left != right, bottom != top, and 0 < z_near < z_far; and where the matrix
// is none of doubles, as perspective().
// Source: OpenGL 2.1 specification, 2.11.2 (glFrustum).
inline std::optional<ProjectorProjection> frustum(const FrustumLens& lens, Conventions conventions) noexcept {
    if (!(lens.z_near > 0.0 && lens.z_near < lens.z_far && detail::is_finite(lens.z_far))) return std::nullopt;
    const detail::LensExtent width(lens.left, lens.right);
    const detail::LensExtent height(lens.bottom, lens.top);
    const detail::DepthRow depth = detail::perspective_depth(lens.z_near, lens.z_far, false, conventions.depth);
    glm::dmat4 matrix(0.0);
    matrix[0][0] = width.twice_over_length(lens.z_near);
    matrix[1][1] = height.twice_over_length(lens.z_near);
    matrix[2][0] = width.sum_over_length();
    matrix[2][1] = height.sum_over_length();
    matrix[2][2] = depth.scale;
    matrix[3][2] = depth.offset;
    matrix[2][3] = -1.0;
    return detail::checked_projection(matrix, conventions);
}

// Guarantee, shape: as perspective(); the last row is (0, 0, 0, 1), so q = 1 and the slide falls in parallel rays.
// Bad input: empty unless all fields are finite, left != right, bottom != top, and z_near < z_far; and where the matrix is
// none of doubles, as perspective().
// Source: OpenGL 2.1 specification, 2.11.2 (glOrtho).
inline std::optional<ProjectorProjection> orthographic(const OrthographicLens& lens, Conventions conventions) noexcept {
    if (!(lens.z_near < lens.z_far && detail::is_finite(lens.z_near) && detail::is_finite(lens.z_far)))
        return std::nullopt;
    const detail::LensExtent width(lens.left, lens.right);
    const detail::LensExtent height(lens.bottom, lens.top);
    const detail::LensExtent depth(lens.z_near, lens.z_far);
    const bool zero_to_one = conventions.depth == DepthRange::zero_to_one;
    glm::dmat4 matrix(0.0);
    matrix[0][0] = width.twice_over_length(1.0);
    matrix[1][1] = height.twice_over_length(1.0);
    matrix[2][2] = -depth.twice_over_length(zero_to_one ? 0.5 : 1.0);
    matrix[3][0] = -width.sum_over_length();
    matrix[3][1] = -height.sum_over_length();
    matrix[3][2] = -(zero_to_one ? depth.end_over_length(lens.z_near) : depth.sum_over_length());
    matrix[3][3] = 1.0;
    return detail::checked_projection(matrix, conventions);
}

// Guarantee: each element of the rotation within 4 double ulp of 1 (2^-50) of the definition's, its rows orthonormal within
// that, with `up` as near to the view as 2^-98 rad; the translation -R position is within 1 ulp of its exact value for the
// rotation that is returned, at any distance from the origin and however it cancels. No allocation, noexcept.
// Shape: world to projector eye space; the position goes to 0, the target onto the negative z axis, up has x = 0.
// Bad input: empty where target equals position, up is zero or parallel to the view, or a number is not finite, that of the
// translation among them.
// Source: Everitt, Projective Texture Mapping, V_p in (3); OpenGL utility library, gluLookAt.
inline std::optional<ProjectorView> look_at(const Aim& aim) noexcept {
    // Where up is nearly parallel the rounding of target - position would turn the picture.
    const detail::Difference view = detail::scaled_difference(aim.target, aim.position);
    const glm::dvec3& forward = view.high;
    const glm::dvec3 up = detail::scaled_near_one(aim.up);
    if (!(detail::length(forward) > 0.0 && detail::length(up) > 0.0)) return std::nullopt;
    const glm::dvec3 sideways = detail::cross(view, up);
    if (!(detail::length(sideways) > 0x1p-98)) return std::nullopt;
    const glm::dvec3 side_direction = detail::scaled_near_one(sideways);
    if (!(detail::length(side_direction) > 0.0)) return std::nullopt;

    const glm::dvec3 side = detail::normalized(side_direction);
    const glm::dvec3 back = -detail::normalized(forward);
    const glm::dvec3 upright = detail::normalized(detail::cross(back, side));
    glm::dmat4 matrix(1.0);
    for (glm::length_t i = 0; i < 3; ++i) {
        matrix[i][0] = side[i];
        matrix[i][1] = upright[i];
        matrix[i][2] = back[i];
    }
    matrix[3][0] = -detail::rotated(side, aim.position);
    matrix[3][1] = -detail::rotated(upright, aim.position);
    matrix[3][2] = -detail::rotated(back, aim.position);
    if (!detail::is_finite(matrix)) return std::nullopt;
    return ProjectorView(matrix);
}

// A slide projector: where its light goes, and the conventions of its numbers.
struct Projector {
    ProjectorProjection projection;
    ProjectorView view;
    Conventions conventions;

    ProjectorMatrix matrix() const noexcept { return projection * view; }  // P_p V_p
};

namespace detail {
inline namespace TEXGEN_COMPILER {

inline std::optional<Projector> assemble(const std::optional<ProjectorProjection>& projection,
                                         const std::optional<ProjectorView>& view, Conventions conventions) noexcept {
    if (!projection || !view) return std::nullopt;
    return Projector{*projection, *view, conventions};
}

}  // namespace TEXGEN_COMPILER
}  // namespace detail

// A projector from a lens and an aim: empty where either is. Guarantees as perspective(), frustum(), orthographic() and
// look_at().
inline std::optional<Projector> make_projector(const PerspectiveLens& lens, const Aim& aim,
                                               Conventions conventions) noexcept {
    return detail::assemble(perspective(lens, conventions), look_at(aim), conventions);
}
inline std::optional<Projector> make_projector(const FrustumLens& lens, const Aim& aim,
                                               Conventions conventions) noexcept {
    return detail::assemble(frustum(lens, conventions), look_at(aim), conventions);
}
inline std::optional<Projector> make_projector(const OrthographicLens& lens, const Aim& aim,
                                               Conventions conventions) noexcept {
    return detail::assemble(orthographic(lens, conventions), look_at(aim), conventions);
}

}  // namespace TEXGEN_NAMESPACE
