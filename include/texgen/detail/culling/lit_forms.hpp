#pragma once

// Where a slide falls, as linear forms. With rows T_s, T_t, T_q of a texgen matrix a point v = (x, y, z, 1) is lit iff
//
//   T_s v - min.x T_q v >= 0,  max.x T_q v - T_s v >= 0,  the same for t,  and  T_q v > 0,
//
// which are the four sides of a pyramid (of a prism, where T_q is constant) and the plane of its apex; and T_r
// likewise, where the region has a depth: the near and the far plane. All answers are about the exact values of these
// forms, with the matrix as it is given. The sides are the outer ones of RoundedSide, beyond which nothing is lit even
// once it is rounded to float; whether all is lit its inner ones say.

#include <array>
#include <cmath>
#include <cstddef>

#include <glm/mat4x4.hpp>

#include "../../conventions.hpp"
#include "../arithmetic/inverse.hpp"
#include "../arithmetic/rounding.hpp"
#include "../simd/box_kernels.hpp"
#include "lit_test.hpp"
#include "slide_planes.hpp"

namespace TEXGEN_DETAIL {

struct LitForms {
    static constexpr std::size_t q = form_of_q;

    std::size_t count;                     // of the forms: five, or seven with a depth
    glm::dmat4 matrix{0.0};                // of rows T_s, T_t, T_r and T_q
    std::array<double, max_forms> side{};  // min.x, max.x, min.y, max.y, and behind q those of r
    FormWeights outer, inner;
    FormLanes lanes{};  // the forms, each times a positive number that brings its largest a near to 1
    bool is_usable;
    bool lights_nothing;  // every point is dark: the region is empty or q is 0 everywhere

    LitForms(const glm::dmat4& given, const TextureRegion& region, const FormKernels& kernels) noexcept
        : count(region.depth() ? max_forms : forms_without_depth) {
        const bool is_matrix_finite = is_finite(given);
        is_usable = is_matrix_finite && take_matrix(given) && take_sides(region);
        lights_nothing =
            is_matrix_finite && (is_empty(region) || (is_usable && lanes.largest_q == 0.0 && lanes.last_q == 0.0));
        if (!can_say()) return;
        kernels.weigh(matrix, outer, lanes);
    }

    // Whether exact sums stay in the range of double with this min of a region, or with this max times -1.
    static bool is_usable_side(double min) noexcept {
        const double size = std::fabs(min);
        return min == -infinity || size == 0.0 || (size >= 0x1p-200 && size <= 0x1p200);
    }

    // Whether the forms decide. They do not where every point is dark, where numbers are not finite, or where exponents
    // are so far apart that an exact sum could leave the range of double.
    bool can_say() const noexcept { return is_usable && !lights_nothing; }

    // The forms in float, for many bodies.
    FloatForms in_float(const FloatFormKernels& kernels) const noexcept {
        FloatForms result;
        kernels.round(lanes, count, result);
        return result;
    }

    // The length |a| of a form, or up to 12 u of it more.
    double slope(std::size_t k) const noexcept {
        const double x = lanes.a[0][k], y = lanes.a[1][k], z = lanes.a[2][k];
        return (1.0 + gamma(4)) * std::sqrt(x * x + y * y + z * z);
    }

    // The forms with |a| near 1, for spheres.
    UnitForms unit() const noexcept {
        UnitForms result;
        double scale[form_lanes];
        for (std::size_t k = 0; k < form_lanes; ++k) scale[k] = 1.0 / larger(slope(k), 0x1p-400);
        const auto take = [&](const double(&from)[form_lanes], double(&to)[form_lanes]) {
            for (std::size_t k = 0; k < form_lanes; ++k) to[k] = from[k] * scale[k];
        };
        for (std::size_t j = 0; j < 3; ++j) take(lanes.a[j], result.a[j]);
        take(lanes.d, result.d);
        take(lanes.narrowing, result.narrowing);
        take(lanes.error_a, result.error_a);
        take(lanes.error_d, result.error_d);
        result.largest_q = lanes.largest_q;
        result.last_q = lanes.last_q;
        return result;
    }

    SeparatingPlanes separating(const SeparatingPlaneKernels& kernels) const noexcept {
        SeparatingPlanes result;
        // Elements are 0 or from 2^-600 to 2. Times 2^200 no product of two underflows, so that a cofactor is 0 only
        // where it is exactly 0.
        kernels.make(lanes, matrix * 0x1p200, side.data(), count, result);
        return result;
    }

    // The forms in double, for boxes that floats leave in doubt.
    void take_in_double(DoubleForms& result) const noexcept {
        result.count = count;
        for (std::size_t k = 0; k < count; ++k) {
            take_at_vertex(k, outer, true, result.form[k].largest);
            take_at_vertex(k, inner, false, result.form[k].least);
        }
    }

    // Takes the matrix times a power of two that brings its largest element near 1: only exponents change. r is 0 where
    // there is no depth. False where exponents are too far apart.
    bool take_matrix(const glm::dmat4& given) noexcept {
        const double of_r = count == forms_without_depth ? 0.0 : 1.0;
        const double is_taken[4] = {1.0, 1.0, of_r, 1.0};
        double largest_of[4] = {};
        double least_of[4] = {infinity, infinity, infinity, infinity};  // of those that are not 0
        for (glm::length_t j = 0; j < 4; ++j) {
            for (glm::length_t i = 0; i < 4; ++i) {
                const double size = std::fabs(given[j][i] * is_taken[i]);
                largest_of[i] = larger(largest_of[i], size);
                least_of[i] = smaller(least_of[i], size > 0.0 ? size : infinity);
            }
        }
        const double largest = larger(larger(largest_of[0], largest_of[1]), larger(largest_of[2], largest_of[3]));
        const double least = smaller(smaller(least_of[0], least_of[1]), smaller(least_of[2], least_of[3]));
        if (largest > 0.0 && !(largest >= 0x1p-1000 && largest < 0x1p1000)) return false;
        const double scale = largest > 0.0 ? reciprocal_power_of_two(largest) : 1.0;
        for (glm::length_t j = 0; j < 4; ++j)
            for (glm::length_t i = 0; i < 4; ++i) matrix[j][i] = given[j][i] * is_taken[i] * scale;
        lanes.largest_q = larger(larger(std::fabs(matrix[0].w), std::fabs(matrix[1].w)), std::fabs(matrix[2].w));
        lanes.last_q = std::fabs(matrix[3].w);
        return least * scale >= 0x1p-600;
    }

    // Where a side is infinite, q >= 0 stands in its place, which is one of the forms anyway. Where no float is inside
    // an inner side, -q >= 0 does, which holds nowhere in front. A max is taken as a min with all signs changed.
    bool take_sides(const TextureRegion& region) noexcept {
        for (FormWeights* weights : {&outer, &inner}) {
            *weights = {};
            for (double& of_q : weights->of_q) of_q = 1.0;
        }
        const auto take = [this](std::size_t k, const glm::dvec2& limits) {
            return take_side(k, 1.0, limits.x) && take_side(k + 1, -1.0, -limits.y);
        };
        return take(0, {(region.min)().x, (region.max)().x}) && take(2, {(region.min)().y, (region.max)().y}) &&
               (count == forms_without_depth || take(q + 1, *region.depth()));
    }
    bool take_side(std::size_t k, double sign, double min) noexcept {
        if (!is_usable_side(min)) return false;
        const RoundedSide rounded = RoundedSide::of_min(min);
        const auto weigh = [sign, k](FormWeights& weights, double bound) {
            const bool is_finite = std::fabs(bound) < infinity;
            weights.of[coordinate_of(k)][k] = is_finite ? sign : 0.0;
            weights.of_q[k] = is_finite ? -bound : bound < 0.0 ? 1.0 : -1.0;
        };
        weigh(outer, rounded.outer);
        weigh(inner, rounded.inner);
        lanes.narrowing[k] = min == -infinity ? 0.0 : std::fabs(rounded.inner - rounded.outer);
        side[k] = sign * rounded.outer;
        return true;
    }

    // The coordinate of a side's form; for q's it does not matter, as its weight is 0.
    static constexpr std::size_t coordinate_of(std::size_t k) noexcept { return k < 2 ? 0 : k < q ? 1 : 2; }

    // Takes a form at the vertex of a box where it is largest, or least. A coefficient is the sum of three numbers.
    // Where the first two cancel their sum is exact, so that all.high is nearly the whole coefficient: it has its sign,
    // is 0 only if that is 0, and the parts have no more in magnitude but for 2^-49 of it.
    void take_at_vertex(std::size_t k, const FormWeights& weights, bool is_largest, FormAtVertex& form) const noexcept {
        const double own = weights.of[coordinate_of(k)][k], of_q = weights.of_q[k];
        form.term_count = 0;
        const auto add = [&form](double factor, std::size_t row) {
            if (factor != 0.0) form.term[form.term_count++] = {factor, row};
        };
        for (std::size_t j = 0; j < 4; ++j) {
            const glm::dvec4& column = matrix[static_cast<glm::length_t>(j)];
            const double half = leading_bits<26>(column.w);
            const double of_row = own * column[static_cast<glm::length_t>(coordinate_of(k))];
            const DoubleDouble most = two_sum(of_row, of_q * half);
            const DoubleDouble rest = two_sum(most.low, of_q * (column.w - half));
            const DoubleDouble all = two_sum(most.high, rest.high);
            const double coefficient = all.high + (all.low + rest.low);
            form.coefficient[j] = coefficient;
            form.error[j] = std::fabs(coefficient) * gamma(8);
            const std::size_t row = j == 3                              ? FormAtVertex::row_of_1
                                    : coefficient == 0.0                ? FormAtVertex::row_of_0
                                    : (coefficient > 0.0) == is_largest ? 3 + j
                                                                        : j;
            if (j < 3) form.row[j] = row;
            for (const double part : {all.high, all.low, rest.low}) {
                const double first = j < 3 ? leading_bits<26>(part) : part;
                add(first, row);
                add(part - first, row);
            }
        }
    }
};

}  // namespace TEXGEN_DETAIL
