#pragma once

// Where objects are in the world, and what a projector lights of it at most. What is outside there is dark for certain;
// what is not is asked about again in the object's own space.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "../../conventions.hpp"
#include "../../primitives.hpp"
#include "../arithmetic/inverse.hpp"
#include "../arithmetic/rounding.hpp"
#include "../arithmetic/widen.hpp"
#include "../simd/lanes.hpp"
#include "lit_forms.hpp"
#include "slide_planes.hpp"

namespace TEXGEN_DETAIL {

// The largest element over the smallest that is not 0; infinite where an element is beyond 2^+-200, so that a product
// of three matrices neither overflows nor underflows. Without a depth r is in no form, and may be small.
//
// Each element of such a product, rounded, is a multiple of the product of the factors' last bits. So where this is at
// most object_range for M, and at most projector_range for S P times that for V, no element of T_o that is not 0 is
// below 2^-600 of the largest, and coverage() of it is decided.
inline double range_of(const glm::dmat4& m, bool without_r = false) noexcept {
    double smallest = 0x1p200;
    double largest = 0x1p-200;
    for (glm::length_t column = 0; column < 4; ++column) {
        for (glm::length_t row = 0; row < 4; ++row) {
            const double size = std::fabs(m[column][row]);
            if (!(size <= 0x1p200)) return infinity;
            if (size == 0.0 || (without_r && row == 2)) continue;
            if (size < 0x1p-200) return infinity;
            smallest = smaller(smallest, size);
            largest = larger(largest, size);
        }
    }
    return largest / smallest;
}
inline constexpr double object_range = 0x1p240;
inline constexpr double projector_range = 0x1p190;
// 165 bits: three factors of 53 bits, two sums of four, and 2 to spare.
static_assert(object_range * projector_range * 0x1p165 < 0x1p600);

// a . (x, y, z) + d, known to within error_a size + error_d when it is computed in double in any order, where the size
// of a point is |x| + |y| + |z|. One that is not set excludes nothing.
struct LinearForm {
    std::array<double, 3> a{};
    double d = 0.0, error_a = 1.0, error_d = 1.0;
};

// Where M v is for the points v of an object's box. All numbers are finite.
struct WorldBounds {
    std::array<double, 3> min, max;
    double size;  // >= |M| |v| in each component, which the rounding of any product with M goes by; < 0: no point

    static constexpr double unbounded_size = 0x1p500;
    static constexpr WorldBounds none() noexcept {
        return {{0x1p100, 0x1p100, 0x1p100}, {-0x1p100, -0x1p100, -0x1p100}, -0x1p120};
    }
    static constexpr WorldBounds unbounded() noexcept { return {{}, {}, unbounded_size}; }

    friend bool operator==(const WorldBounds&, const WorldBounds&) = default;
};

// Eight bounds side by side in float, each number rounded once: min, -max and -size, so that the bounds of a row are
// the least of its numbers, and those of none() change nothing there. Bounds beyond 2^100 get a size of 2^120, whose
// error is above all values of the forms, so that they are never left out; none() has -2^120, and always is.
struct BoundsRow {
    static constexpr std::size_t width = 8;
    static constexpr std::size_t of_size = 6;

    Float4 numbers[7][2];

    BoundsRow() noexcept {
        for (std::size_t i = 0; i < width; ++i) put(i, WorldBounds::none());
    }

    void put(std::size_t i, const WorldBounds& bounds) noexcept {
        const bool is_near = bounds.size < 0x1p100;
        for (std::size_t j = 0; j < 3; ++j) {
            numbers[j][i / 4][i % 4] = is_near ? static_cast<float>(bounds.min[j]) : 0.0f;
            numbers[3 + j][i / 4][i % 4] = is_near ? static_cast<float>(-bounds.max[j]) : 0.0f;
        }
        numbers[of_size][i / 4][i % 4] = is_near ? static_cast<float>(-bounds.size) : -0x1p120f;
    }
    void put(std::size_t i, const BoundsRow& row) noexcept {
        for (std::size_t k = 0; k <= of_size; ++k) {
            const Float4 of_four = smaller(row.numbers[k][0], row.numbers[k][1]);
            float least = of_four[0];
            for (std::size_t lane = 1; lane < 4; ++lane) least = of_four[lane] < least ? of_four[lane] : least;
            numbers[k][i / 4][i % 4] = least;
        }
    }
};

// Unbounded where a number is not finite, M is not affine or its exponents are far apart. Each component has four
// terms, each rounded at most five times.
inline WorldBounds world_bounds(const glm::dmat4& m, const Box& box) noexcept {
    WorldBounds result{};
    const glm::dvec3 low = widened(box.min);
    const glm::dvec3 high = widened(box.max);
    for (glm::length_t i = 0; i < 3; ++i) {
        double least = m[3][i];
        double largest = m[3][i];
        double size = std::fabs(m[3][i]);
        for (glm::length_t j = 0; j < 3; ++j) {
            const double of_low = m[j][i] * low[j];
            const double of_high = m[j][i] * high[j];
            least += smaller(of_low, of_high);
            largest += larger(of_low, of_high);
            size += std::fabs(of_low) + std::fabs(of_high);
        }
        const auto axis = static_cast<std::size_t>(i);
        result.min[axis] = least - gamma(8) * size;
        result.max[axis] = largest + gamma(8) * size;
        if (!(size < 0x1p400)) return WorldBounds::unbounded();
        result.size = larger(result.size, size);
    }
    const bool is_affine = m[0][3] == 0.0 && m[1][3] == 0.0 && m[2][3] == 0.0 && m[3][3] == 1.0;
    if (!is_affine || !(range_of(m) <= object_range)) return WorldBounds::unbounded();
    return low.x > high.x || low.y > high.y || low.z > high.z ? WorldBounds::none() : result;
}

// The forms of a slide in the world (q, and the sides as u - min q and max q - u), with slack for the rounding of any
// T_o that is composed in double. With T = S P V, computed in double, each element of T, of T_o = (S P)(V M) and of a
// form errs by at most gamma(16) of the same product of magnitudes, and so does the form's value at M v: in all by less
// than slack = gamma(64) (|S P| |V|)_form (size, size, size, 1). What rounding makes of a side (see RoundedSide) moves
// the form by at most its width times |T_q| |v|, which is part of the slack. Where a form is below -slack over the
// bounds, that of T_o is negative over the box, and where all are above slack, all of T_o are positive.
class WorldForms {
public:
    // texture_from_eye is S P. Where coverage() may not decide there are no forms, and all is partial. An infinite side
    // has none, as it leaves nothing out.
    WorldForms(const glm::dmat4& texture_from_eye, const glm::dmat4& view, const TextureRegion& region) noexcept {
        const glm::dmat4 matrix = texture_from_eye * view;
        const bool without_r = !region.depth();
        if (!(range_of(texture_from_eye, without_r) * range_of(view) <= projector_range)) return;
        const SlidePlanes planes(region);
        for (const SlidePlane& plane : planes)
            if (!LitForms::is_usable_side(plane.sign * plane.bound)) return;
        const glm::dmat4 magnitude = absolute(texture_from_eye) * absolute(view);
        // q comes last: few bounds are behind a projector and beyond none of its sides.
        for (std::size_t i = 1; i <= planes.size(); ++i) {
            const bool is_q = i == planes.size();
            const SlidePlane& plane = planes[is_q ? 0 : i];
            if (!is_finite(plane.bound)) continue;
            LinearForm& form = forms_[count_++];
            set(form, matrix, magnitude, plane);
            // may_light() does not ask q, nor a side that needs a larger error than it has.
            if (!is_q && form.error_a < 0x1p-21 && form.error_d < 0x1p-21)
                sides_[side_count_++] = {static_cast<float>(form.a[0]), static_cast<float>(form.a[1]),
                                         static_cast<float>(form.a[2]), static_cast<float>(form.d)};
        }
    }

    // A bit for each of a row that may be lit: no side is negative at the vertex where it is largest. In float a
    // coefficient, a coordinate, a product and two sums are rounded, of less than 2 size + 2 together, and the size:
    // less than 12 u (size + 1). Of the 64 u that it allows the rest is more than the slack.
    std::uint32_t may_light(const BoundsRow& row) const noexcept {
        Float4 least[2] = {Float4{} + 0x1p101f, Float4{} + 0x1p101f};
        for (std::size_t k = 0; k < side_count_; ++k) {
            const auto& side = sides_[k];
            const auto vertex = [&](std::size_t j) { return row.numbers[side[j] > 0.0f ? 3 + j : j]; };
            const Float4 *const x = vertex(0), *const y = vertex(1), *const z = vertex(2);
            const float a = -std::fabs(side[0]), b = -std::fabs(side[1]), c = -std::fabs(side[2]);
            TEXGEN_FOR (std::size_t h = 0; h < 2; ++h)
                least[h] = smaller(x[h] * a + y[h] * b + (z[h] * c + side[3]), least[h]);
        }
        for (std::size_t h = 0; h < 2; ++h)
            least[h] = least[h] + (row.numbers[BoundsRow::of_size][h] + -1.0f) * -0x1p-18f;
        return ~(negative_lanes(least[0]) | negative_lanes(least[1]) << 4) & 0xff;
    }

    // outside and inside are certain. A form over bounds is its value in the middle, give or take its change over half
    // the extents; their rounding is part of the slack.
    Coverage coverage(const WorldBounds& bounds) const noexcept {
        if (bounds.size < 0.0) return Coverage::outside;
        double middle[3];
        double half[3];
        for (std::size_t j = 0; j < 3; ++j) {
            middle[j] = 0.5 * (bounds.max[j] + bounds.min[j]);
            half[j] = 0.5 * (bounds.max[j] - bounds.min[j]);
        }
        bool is_inside = count_ > 0;
        // Unrolled, so that the branch of each form is predicted by itself.
        TEXGEN_FOR (std::size_t k = 0; k < SlidePlanes::max_size; ++k) {
            if (k == count_) break;
            const LinearForm& form = forms_[k];
            const auto& a = form.a;
            const double value = a[0] * middle[0] + a[1] * middle[1] + a[2] * middle[2] + form.d;
            const double change = std::fabs(a[0]) * half[0] + std::fabs(a[1]) * half[1] + std::fabs(a[2]) * half[2];
            const double slack = form.error_a * bounds.size + form.error_d;
            if (value + change < -slack) return Coverage::outside;
            is_inside &= value - change > slack;
        }
        return is_inside ? Coverage::inside : Coverage::partial;
    }

private:
    // The form sign (row - bound q), times a power of two that brings the sum of the magnitudes near 1. The given side
    // is between the outer and the inner one, and may be off by their distance.
    static void set(LinearForm& form, const glm::dmat4& matrix, const glm::dmat4& magnitude,
                    const SlidePlane& plane) noexcept {
        const RoundedSide side = RoundedSide::of_min(plane.sign * plane.bound);
        const double width = plane.coordinate == 3 ? 0.0 : std::fabs(side.inner - side.outer);
        const double of_q = -plane.sign * plane.bound;
        double sizes[4];
        double coefficients[4];
        double sum = 0.0;
        for (glm::length_t j = 0; j < 4; ++j) {
            coefficients[j] = plane.sign * matrix[j][plane.coordinate] + of_q * matrix[j][3];
            sizes[j] = magnitude[j][plane.coordinate] + std::fabs(of_q) * magnitude[j][3];
            sum += sizes[j];
        }
        if (!(sum > 0x1p-400 && sum < 0x1p400)) return;
        const double scale = reciprocal_power_of_two(sum);
        for (std::size_t j = 0; j < 3; ++j) form.a[j] = scale * coefficients[j];
        form.d = scale * coefficients[3];
        const double of_width = 1.1 * width * scale;
        form.error_a = gamma(64) * scale * (sizes[0] + sizes[1] + sizes[2]) + 0x1p-100 +
                       of_width * (magnitude[0][3] + magnitude[1][3] + magnitude[2][3]);
        form.error_d = gamma(64) * scale * sizes[3] + 0x1p-100 + of_width * magnitude[3][3];
    }

    std::array<LinearForm, SlidePlanes::max_size> forms_;
    std::array<std::array<float, 4>, SlidePlanes::max_size - 1> sides_;  // in float
    std::size_t side_count_ = 0;
    std::size_t count_ = 0;
};

}  // namespace TEXGEN_DETAIL
