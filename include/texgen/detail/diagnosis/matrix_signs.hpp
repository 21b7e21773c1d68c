#pragma once

// What a matrix shows by itself: the marks of lenses, poses and texgen matrices that no valid one lacks, and those that
// none carries.

#include <cmath>
#include <cstdint>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "../../conventions.hpp"
#include "../arithmetic/inverse.hpp"
#include "../arithmetic/rounding.hpp"
#include "../language.hpp"

namespace TEXGEN_DETAIL {

inline bool is_zero_row(const glm::dmat4& m, glm::length_t row) noexcept {
    return m[0][row] == 0.0 && m[1][row] == 0.0 && m[2][row] == 0.0 && m[3][row] == 0.0;
}

// Whether a number has more bits than the round numbers of a scene that is aligned with the axes.
inline bool has_many_bits(double value) noexcept { return (bit_cast<std::uint64_t>(value) & 0x1fffffffff) != 0; }

// Whether the matrix was rounded to float on its way: all elements are floats, and one but for the last column is no
// round number.
inline bool is_in_float(const glm::dmat4& m) noexcept {
    bool is_rounded = false;
    for (glm::length_t column = 0; column < 4; ++column) {
        for (glm::length_t row = 0; row < 4; ++row) {
            // The last 29 of the 52 bits behind the point.
            if ((bit_cast<std::uint64_t>(m[column][row]) & 0x1fffffff) != 0) return false;
            is_rounded = is_rounded || (column < 3 && has_many_bits(m[column][row]));
        }
    }
    return is_rounded;
}

// The rounding of a matrix in float, or else in double, relative to its elements.
inline double rounding_of(const glm::dmat4& m) noexcept { return is_in_float(m) ? 0x1p-22 : 0x1p-44; }

// What rounding is relative to, where no more is known: the magnitudes of elements that are no round numbers. A row's
// constant counts only where none of its axes is round: beside a round axis it may have many bits and be exact.
inline glm::dmat4 rounded_magnitudes(const glm::dmat4& m) noexcept {
    glm::dmat4 result(0.0);
    for (glm::length_t row = 0; row < 4; ++row) {
        bool any_long = false;
        bool all_long = true;
        for (glm::length_t column = 0; column < 4; ++column) {
            if (column == 3 && !(any_long && all_long)) continue;
            const double element = m[column][row];
            if (has_many_bits(element)) result[column][row] = std::fabs(element);
            any_long = any_long || has_many_bits(element);
            all_long = all_long && (element == 0.0 || has_many_bits(element));
        }
    }
    return result;
}

// A determinant of three rows and three columns, and whether it stands out of the rounding of the elements and of its
// own: with its cofactors C, an error e_ij of the elements changes it by sum e_ij C_ij at first order. That does not
// depend on the scale of any row or column, so these are scaled by powers of two, to keep products in range.
struct Minor {
    double value;  // of the scaled rows and columns
    bool stands_out;
};

inline Minor minor_of(const glm::dmat4& m, const glm::length_t (&rows)[3], const glm::length_t (&columns)[3]) noexcept {
    glm::dmat3 scaled;
    for (glm::length_t i = 0; i < 3; ++i)
        for (glm::length_t j = 0; j < 3; ++j) scaled[i][j] = m[columns[j]][rows[i]];
    for (const bool is_row : {true, false}) {
        for (glm::length_t i = 0; i < 3; ++i) {
            const auto element = [&](glm::length_t j) -> double& { return is_row ? scaled[i][j] : scaled[j][i]; };
            const double largest = larger(larger(std::fabs(element(0)), std::fabs(element(1))), std::fabs(element(2)));
            if (!(largest > 0.0 && largest < infinity)) continue;
            for (glm::length_t j = 0; j < 3; ++j) element(j) = times_power_of_two(element(j), -exponent_of(largest));
        }
    }
    const auto magnitude = [](const glm::dvec3& v, const glm::dvec3& w) { return glm::dot(glm::abs(v), glm::abs(w)); };
    const glm::dvec3 a = scaled[0], b = scaled[1], c = scaled[2];
    const glm::dvec3 of_a = glm::cross(b, c);
    const double value = glm::dot(a, of_a);
    const double change = magnitude(a, of_a) + magnitude(b, glm::cross(c, a)) + magnitude(c, glm::cross(a, b));
    const double terms =
        magnitude(a, {std::fabs(b.y * c.z) + std::fabs(b.z * c.y), std::fabs(b.z * c.x) + std::fabs(b.x * c.z),
                      std::fabs(b.x * c.y) + std::fabs(b.y * c.x)});
    return {value, std::fabs(value) > rounding_of(m) * change + 0x1p-48 * terms};
}

inline constexpr glm::length_t axes[3] = {0, 1, 2};

// Whether three rows have rank 3. Those of valid matrices have it in their axes, or in two axes and the constants where
// light is parallel; translations enter neither.
inline bool are_independent(const glm::dmat4& m, const glm::length_t (&rows)[3]) noexcept {
    return minor_of(m, rows, axes).stands_out || minor_of(m, rows, {0, 1, 3}).stands_out ||
           minor_of(m, rows, {0, 2, 3}).stands_out || minor_of(m, rows, {1, 2, 3}).stands_out;
}

// An affine matrix for row vectors: the translation stands in the last row. An affine one has (0, 0, 0, 1) there.
inline bool is_affine_transposed(const glm::dmat4& m) noexcept {
    return m[3].x == 0.0 && m[3].y == 0.0 && m[3].z == 0.0 && m[3].w != 0.0 &&
           (m[0].w != 0.0 || m[1].w != 0.0 || m[2].w != 0.0);
}

inline bool is_affine(const glm::dmat4& m) noexcept {
    return m[0].w == 0.0 && m[1].w == 0.0 && m[2].w == 0.0 && m[3].w != 0.0;
}

// The form that every lens has, on the axis or off it: x and y cross neither into depth and w nor, but for a skew of x,
// into one another.
inline bool is_lens(const glm::dmat4& p) noexcept {
    const bool apart = p[0].y == 0.0 && p[0].z == 0.0 && p[0].w == 0.0 && p[1].z == 0.0 && p[1].w == 0.0;
    const bool perspective = p[2].w != 0.0 && p[3].w == 0.0 && p[3].x == 0.0 && p[3].y == 0.0;
    const bool parallel = p[2].w == 0.0 && p[3].w != 0.0 && p[2].x == 0.0 && p[2].y == 0.0;
    return apart && (perspective || parallel);
}

inline bool is_perspective(const glm::dmat4& p) noexcept { return is_lens(p) && p[2].w != 0.0; }

// A projection for row vectors. Row w of a perspective is (0, 0, -1, 0), (0, 0, 1, 0) if it is left-handed: the
// transposed has that in its last column, and the depth offset, which is hardly ever 1, in its row w.
inline bool is_lens_transposed(const glm::dmat4& p) noexcept {
    const bool perspective = p[3].x == 0.0 && p[3].y == 0.0 && std::fabs(p[3].z) == 1.0 && p[3].w == 0.0 &&
                             p[0].w == 0.0 && p[1].w == 0.0 && p[2].w != 0.0 && std::fabs(p[2].w) != 1.0;
    return perspective || (is_affine_transposed(p) && is_lens(glm::transpose(p)));
}

// Whether the lens looks down the other axis than eyes of that handedness do. Parallel light does not say where it
// looks.
inline bool looks_away(const glm::dmat4& p, Handedness handedness) noexcept {
    return is_perspective(p) && (p[2].w > 0.0) != (handedness == Handedness::left);
}

// The NDC depth of the near plane, or where depth is reversed of the far one; the other plane has 1.
constexpr double low_end(DepthRange range) noexcept { return range == DepthRange::negative_one_to_one ? -1.0 : 0.0; }

// 1 where a lens looks along +z, else -1. Parallel light does not show it: there the handedness decides.
inline double ahead_of(const glm::dmat4& p, Handedness handedness) noexcept {
    return (is_perspective(p) ? p[2].w > 0.0 : handedness == Handedness::left) ? 1.0 : -1.0;
}

// near and far land on the ends of the range, and infinity beyond the far end: at 1 or more, or reversed at the low end
// or less. So nothing valid has infinity between the ends, or a plane at the low end of the other range.
inline bool mistakes_depth(const glm::dmat4& p, DepthRange range, Handedness handedness,
                           const std::optional<double>& z_near, const std::optional<double>& z_far) noexcept {
    constexpr double rounding = 0x1p-12;
    const double low = low_end(range);
    const double other_low = -1.0 - low;
    const double at_infinity = ratio(p[2].z, p[2].w);
    if (is_perspective(p) && at_infinity > low + rounding && at_infinity < 1.0 - rounding) return true;
    const auto lands_on_other = [&](const std::optional<double>& distance) {
        if (!distance) return false;
        const double z = ahead_of(p, handedness) * *distance;
        if (!is_finite(z)) return std::fabs(at_infinity - other_low) < rounding;
        // Where near and far are next to one another depth is a difference of large numbers.
        const double w = p[2].w * z + p[3].w;
        const double lost = rounding_of(p) * (std::fabs(p[2].z * z) + std::fabs(p[3].z));
        return std::fabs(ratio(p[2].z * z + p[3].z, w) - other_low) < rounding && lost < 0.5 * rounding * std::fabs(w);
    };
    return lands_on_other(z_near) || lands_on_other(z_far);
}

// Whether nothing in front of a perspective is within its depth range: depth is a + b / w, and a near plane in front
// puts a beyond the end to which it grows with w, or falls. A row z that was never written says nothing.
inline bool has_no_depth_in_front(const glm::dmat4& p, DepthRange range) noexcept {
    if (is_zero_row(p, 2)) return false;
    const double at_infinity = ratio(p[2].z, p[2].w), per_distance = p[3].z;
    return !(per_distance < 0.0 && at_infinity > low_end(range)) && !(per_distance > 0.0 && at_infinity < 1.0);
}

// Whether the focal length is that of an angle whose number was taken for one of the other unit, and not that of fovy.
// Degrees taken for radians make many turns, so that they are compared as angles, by the sine of half their difference.
inline bool mistakes_unit(double focal_length, const Angle& fovy) noexcept {
    const auto is_of = [&](double angle) {
        const double expected = std::cos(0.5 * angle) / std::sin(0.5 * angle);
        return std::fabs(focal_length - expected) <= 0x1p-16 * std::fabs(expected);
    };
    if (is_of(fovy.in_radians())) return false;
    const double turned = 2.0 * std::atan2(1.0, focal_length) - fovy.in_degrees();
    return std::fabs(std::sin(0.5 * turned)) <= 0x1p-16 * smaller(fovy.in_degrees(), 1.0) ||
           is_of(degrees(fovy.in_radians()).in_radians());
}

// Row r against row q. Every lens has (0, 0, e, f) in row z and (0, 0, w, h) in row w, so that r = limit q + constant,
// the scale-bias included, and an affine pose on the right keeps it: the directions of the two rows are parallel. A
// transposed matrix or a wrong order loses it. (An oblique near plane loses it, too: that needs its projector.)
struct DepthRows {
    bool are_parallel;
    bool is_parallel_light;  // q is constant
    double limit;            // of r/q at infinity; 0 for parallel light
};

inline DepthRows depth_rows(const glm::dmat4& m) noexcept {
    const glm::dvec3 r{m[0].z, m[1].z, m[2].z};
    const glm::dvec3 q{m[0].w, m[1].w, m[2].w};
    const auto largest = [](const glm::dvec3& v) {
        return larger(std::fabs(v.x), larger(std::fabs(v.y), std::fabs(v.z)));
    };
    // Where the limit is 0 by cancellation, row r is only what the rounding of q has left.
    const double rounding = is_in_float(m) ? 0x1p-20 : 0x1p-44;
    const double size_r = largest(r);
    const double size_q = largest(q);
    const bool are_parallel = !(largest(glm::cross(r, q)) > (0x1p-14 * size_r + rounding * size_q) * size_q);
    const double squared = glm::dot(q, q);
    return {are_parallel, size_q == 0.0, squared > 0.0 ? glm::dot(r, q) / squared : 0.0};
}

// Whether the transposed matrix has the mark of rows r and q, and the matrix has not. Each row of the matrix, a column
// of the transposed, has its own size: a large one would hide what the others show.
inline bool shows_transposed(const glm::dmat4& m) noexcept {
    if (depth_rows(m).are_parallel) return false;
    glm::dmat4 rows = glm::transpose(m);
    for (glm::length_t row = 0; row < 3; ++row) {
        const glm::dvec4 size = glm::abs(rows[row]);
        const double largest = larger(larger(size.x, size.y), larger(size.z, size.w));
        if (largest > 0.0 && largest < infinity)
            rows[row] = times_powers_of_two(rows[row], glm::ivec4(-exponent_of(largest)));
    }
    return depth_rows(rows).are_parallel;
}

// OpenGL's initial planes: S = (1, 0, 0, 0), T = (0, 1, 0, 0), R and Q zero.
inline bool is_opengl_default(const glm::dmat4& m) noexcept {
    glm::dmat4 initial(0.0);
    initial[0][0] = initial[1][1] = 1.0;
    return m == initial;
}

// Whether the picture is mirrored in the world. The directions to the right, up and forwards, as s, t and q say them,
// have a positive determinant in a left-handed world and a negative one in a right-handed one, unless they are
// mirrored. Parallel light does not say which way is forwards.
inline bool is_mirrored(const glm::dmat4& texgen, const glm::dmat4& world_from_space,
                        const Conventions& conventions) noexcept {
    const Minor picture = minor_of(texgen, {0, 1, 3}, axes);
    const Minor pose = minor_of(world_from_space, axes, axes);
    if (!picture.stands_out || !pose.stands_out) return false;
    const bool is_left =
        ((picture.value > 0.0) == (pose.value > 0.0)) == (conventions.origin == TextureOrigin::bottom_left);
    return is_left != (conventions.handedness == Handedness::left);
}

}  // namespace TEXGEN_DETAIL
