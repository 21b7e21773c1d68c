#pragma once

// Where a slide falls, as linear forms. With rows T_s, T_t, T_q of a texgen matrix a point v = (x, y, z, 1) is lit iff
//
//   T_s v - min.x T_q v >= 0,  max.x T_q v - T_s v >= 0,  the same for t,  and  T_q v > 0,
//
// which are the four sides of a pyramid (of a prism, where T_q is constant) and the plane of its apex; and T_r likewise, where
// the region has a depth: the near and the far plane. What is asked of these forms is asked of their exact values, with the
// matrix as it is given. The sides are those beyond which nothing is lit, its rounding to float included; where all is lit,
// the inner sides say (see RoundedSide).

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <glm/mat4x4.hpp>

#include "../../conventions.hpp"
#include "../arithmetic/expansion.hpp"
#include "../arithmetic/inverse.hpp"
#include "../arithmetic/nearest.hpp"
#include "../arithmetic/rounding.hpp"
#include "../simd/box_kernels.hpp"
#include "lit_test.hpp"
#include "slide_planes.hpp"

namespace TEXGEN_DETAIL {

// The coordinates of a vertex, or of the middle of a sphere.
using Point = std::array<double, 3>;

// What T_s, T_t, T_r and T_q are at the point that was last asked about, each once it is needed: what the forms are in doubt at is
// the apex almost always, where all of them meet.
struct CloseRows {
    bool is_made[4] = {};
    Point point = {};
    std::array<CloseSum, 4> row;
};

class LitForms {
public:
    static constexpr std::size_t q = form_of_q;

    LitForms(const glm::dmat4& matrix, const TextureRegion& region, const FormKernels& kernels) noexcept
        : count_(region.depth() ? max_forms : forms_without_depth) {
        const bool is_matrix_finite = is_finite(matrix);
        is_usable_ = is_matrix_finite && take_matrix(matrix) && take_sides(region);
        lights_nothing_ =
            is_matrix_finite && (is_empty(region) || (is_usable_ && lanes_.largest_q == 0.0 && lanes_.last_q == 0.0));
        if (!can_say()) return;
        kernels.weigh(matrix_, weights_, lanes_);
    }

    // Five forms, or seven with a depth.
    std::size_t count() const noexcept { return count_; }

    // Whether exact sums with this side of a region, `none` for none, stay in the range of double.
    static bool is_usable_side(double bound, double none) noexcept {
        const double size = std::fabs(bound);
        return bound == none || size == 0.0 || (size >= 0x1p-200 && size <= 0x1p200);
    }

    // Whether every point is dark: the region is empty or q is 0 everywhere.
    bool light_nothing() const noexcept { return lights_nothing_; }

    // Whether bodies have to be asked about: not where every point is dark, nor for numbers that are not finite or exponents so
    // far apart that an exact sum could leave the range of double.
    bool can_say() const noexcept { return is_usable_ && !lights_nothing_; }

    // The forms, each times a positive number that brings its largest a near to 1.
    const FormLanes& lanes() const noexcept { return lanes_; }
    Point a(std::size_t k) const noexcept { return {lanes_.a[0][k], lanes_.a[1][k], lanes_.a[2][k]}; }
    const glm::dmat4& matrix() const noexcept { return matrix_; }
    const FormWeights& weights() const noexcept { return weights_; }

    // -1, 0, 1: the sign of form k at a finite point, exactly.
    int sign_at(std::size_t k, const Point& point, CloseRows& close) const noexcept {
        const Bounded value = value_at(k, point);
        if (std::fabs(value.value) > value.error) return value.value > 0.0 ? 1 : -1;
        return close_sign_at(k, weight(k), point, close);
    }

    // Whether form k is so large at a finite point that its inner side is above 0 at every point of that size.
    bool is_inside_at(std::size_t k, const Point& point, double size) const noexcept {
        const Bounded value = value_at(k, point);
        const double narrowing = lanes_.narrowing[k] * (lanes_.largest_q * size + lanes_.last_q);
        return value.value - value.error > 1.1 * narrowing;
    }

    // Side k, the inner one: its coefficients, each rounded once, and its sign at a finite point, exactly.
    std::array<double, 4> inner_side(std::size_t k) const noexcept { return form_of(k, inner_weight_[k]); }
    int inner_sign_at(std::size_t k, const std::array<double, 4>& form, const Point& point,
                      CloseRows& close) const noexcept {
        const Bounded value = value_of(form, form[3], point);
        if (std::fabs(value.value) > value.error) return value.value > 0.0 ? 1 : -1;
        return close_sign_at(k, inner_weight_[k], point, close);
    }

    // In float, for many bodies.
    FloatForms in_float(const FloatFormKernels& kernels) const noexcept {
        FloatForms result;
        kernels.round(lanes_, count_, result);
        return result;
    }

    // |a| of a form, or up to 12 u of it more.
    double slope(std::size_t k) const noexcept {
        const Point of = a(k);
        return (1.0 + gamma(4)) * std::sqrt(of[0] * of[0] + of[1] * of[1] + of[2] * of[2]);
    }

    // For spheres.
    UnitForms unit(const UnitFormKernels& kernels) const noexcept {
        UnitForms result;
        double slopes[form_lanes];
        for (std::size_t k = 0; k < form_lanes; ++k) slopes[k] = slope(k);
        kernels.make(lanes_, slopes, result);
        return result;
    }

    SeparatingForms separating(const SeparatingFormKernels& kernels) const noexcept {
        SeparatingForms result;
        kernels.make(lanes_, matrix_, side_.data(), count_, result);
        return result;
    }

    // In double, for boxes that floats leave in doubt.
    void take_in_double(DoubleForms& result) const noexcept {
        result.count = count_;
        for (std::size_t k = 0; k < count_; ++k) {
            take_at_vertex(k, weight(k), true, result.form[k].largest);
            take_at_vertex(k, inner_weight_[k], false, result.form[k].least);
        }
    }

    // T_s, T_t, T_r and T_q.
    using Row = std::array<double, 4>;
    Row row(std::size_t coordinate) const noexcept {
        const auto i = static_cast<glm::length_t>(coordinate);
        return {matrix_[0][i], matrix_[1][i], matrix_[2][i], matrix_[3][i]};
    }

private:
    // Form k is of_row * (T_s, T_t or T_r) + of_q * T_q.
    struct Weight {
        double of_row, of_q;
    };
    Weight weight(std::size_t k) const noexcept {
        return {k == q ? 0.0 : weights_.of[coordinate_of(k)][k], weights_.of_q[k]};
    }

    // A power of two takes the largest element to 1: nothing changes but the range of the exponents. r is 0 where there is no
    // depth.
    bool take_matrix(const glm::dmat4& matrix) noexcept {
        const double of_r = count_ == forms_without_depth ? 0.0 : 1.0;
        const double is_taken[4] = {1.0, 1.0, of_r, 1.0};
        double largest_of[4] = {};
        double least_of[4] = {infinity, infinity, infinity, infinity};  // but 0
        for (glm::length_t j = 0; j < 4; ++j) {
            for (glm::length_t i = 0; i < 4; ++i) {
                const double size = std::fabs(matrix[j][i] * is_taken[i]);
                largest_of[i] = larger(largest_of[i], size);
                least_of[i] = smaller(least_of[i], size > 0.0 ? size : infinity);
            }
        }
        const double largest = larger(larger(largest_of[0], largest_of[1]), larger(largest_of[2], largest_of[3]));
        const double least = smaller(smaller(least_of[0], least_of[1]), smaller(least_of[2], least_of[3]));
        if (largest > 0.0 && !(largest >= 0x1p-1000 && largest < 0x1p1000)) return false;
        const double scale = largest > 0.0 ? reciprocal_power_of_two(largest) : 1.0;
        for (glm::length_t j = 0; j < 4; ++j)
            for (glm::length_t i = 0; i < 4; ++i) matrix_[j][i] = matrix[j][i] * is_taken[i] * scale;
        lanes_.largest_q = larger(larger(std::fabs(matrix_[0].w), std::fabs(matrix_[1].w)), std::fabs(matrix_[2].w));
        lanes_.last_q = std::fabs(matrix_[3].w);
        return least * scale >= 0x1p-600;
    }

    // An infinite side is none, and q takes its place: it is one of the forms all the same. An inner side that no float is
    // inside of is where -q is not below 0: nowhere in front. A max is the mirrored min.
    bool take_sides(const TextureRegion& region) noexcept {
        weights_ = {};
        for (double& of_q : weights_.of_q) of_q = 1.0;
        for (double& of_q : weights_.inner_of_q) of_q = 1.0;
        inner_weight_[q] = {0.0, 1.0};
        const auto take = [this](std::size_t k, const glm::dvec2& limits) {
            return take_side(k, 1.0, limits.x) && take_side(k + 1, -1.0, -limits.y);
        };
        return take(0, {(region.min)().x, (region.max)().x}) && take(2, {(region.min)().y, (region.max)().y}) &&
               (count_ == forms_without_depth || take(q + 1, *region.depth()));
    }
    bool take_side(std::size_t k, double sign, double min) noexcept {
        if (!is_usable_side(min, -infinity)) return false;
        const RoundedSide rounded = RoundedSide::of_min(min);
        const auto weight = [sign](double bound) {
            const bool is_finite = std::fabs(bound) < infinity;
            return Weight{is_finite ? sign : 0.0, is_finite ? -bound : bound < 0.0 ? 1.0 : -1.0};
        };
        const Weight outer = weight(rounded.outer);
        weights_.of[coordinate_of(k)][k] = outer.of_row;
        weights_.of_q[k] = outer.of_q;
        inner_weight_[k] = weight(rounded.inner);
        weights_.inner_of_q[k] = outer.of_row != 0.0 ? -rounded.inner : infinity;
        weights_.width[k] = min == -infinity ? 0.0 : std::fabs(rounded.inner - rounded.outer);
        side_[k] = sign * rounded.outer;
        return true;
    }

    static constexpr std::size_t coordinate_of(std::size_t k) noexcept {
        return k < 2 ? 0 : k < q ? 1 : k == q ? 3 : 2;
    }

    Bounded value_at(std::size_t k, const Point& point) const noexcept { return value_of(a(k), lanes_.d[k], point); }
    template <class Coefficients>
    static Bounded value_of(const Coefficients& a, double d, const Point& point) noexcept {
        double value = d;
        double magnitude = std::fabs(d);
        for (std::size_t j = 0; j < 3; ++j) {
            value += a[j] * point[j];
            magnitude += std::fabs(a[j] * point[j]);
        }
        return {value, gamma(8) * magnitude};
    }

    // Each coefficient is rounded so that its sign is right and it is 0 only if it is 0: what the second half of a product
    // leaves of the sum is far below it, or nothing.
    Row form_of(std::size_t k, const Weight& weight) const noexcept {
        const auto i = static_cast<glm::length_t>(coordinate_of(k));
        Row form;
        for (std::size_t j = 0; j < 4; ++j) {
            const glm::dvec4& column = matrix_[static_cast<glm::length_t>(j)];
            const double half = leading_26_bits(column.w);
            const DoubleDouble sum = two_sum(weight.of_row * column[i], weight.of_q * half);
            form[j] = sum.high + (sum.low + weight.of_q * (column.w - half));
        }
        return form;
    }

    // A coefficient is the sum of three numbers. What is cancelled in the first sum leaves nothing, so that all.high is nearly
    // all of it: that has its sign, is 0 only if it is 0, and the terms have no more in magnitude but for 2^-49 of it.
    void take_at_vertex(std::size_t k, const Weight& weight, bool is_largest, FormAtVertex& form) const noexcept {
        form.term_count = 0;
        const auto add = [&form](double factor, std::size_t row) {
            if (factor != 0.0) form.term[form.term_count++] = {factor, row};
        };
        for (std::size_t j = 0; j < 4; ++j) {
            const glm::dvec4& column = matrix_[static_cast<glm::length_t>(j)];
            const double half = leading_26_bits(column.w);
            const double of_row = weight.of_row * column[static_cast<glm::length_t>(coordinate_of(k))];
            const DoubleDouble most = two_sum(of_row, weight.of_q * half);
            const DoubleDouble rest = two_sum(most.low, weight.of_q * (column.w - half));
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
                const double first = j < 3 ? leading_26_bits(part) : part;
                add(first, row);
                add(part - first, row);
            }
        }
        if (k == q) {
            form.coefficient[3] -= 0x1p-1000;
            add(-0x1p-1000, FormAtVertex::row_of_1);
        }
    }

    // Adds a product with a number of 24 digits.
    static void add_product(CloseSum& sum, double value, double of_few_digits) noexcept {
        const double half = leading_26_bits(value);
        sum.add(half * of_few_digits);
        sum.add((value - half) * of_few_digits);
    }

    // From the rows in two doubles, and at last exactly. of_row is -1, 0 or 1.
    int close_sign_at(std::size_t k, const Weight& weight, const Point& point, CloseRows& close) const noexcept {
        if (point != close.point) {
            close.point = point;
            for (bool& is_made : close.is_made) is_made = false;
        }
        const auto value_of_row = [&](std::size_t coordinate) -> const CloseSum& {
            CloseSum& value = close.row[coordinate];
            if (!close.is_made[coordinate]) {
                close.is_made[coordinate] = true;
                const Row of = row(coordinate);
                value = {of[3], 0.0, 0.0};
                for (std::size_t j = 0; j < 3; ++j)
                    if (of[j] != 0.0) add_product(value, of[j], point[j]);
            }
            return value;
        };
        CloseSum sum{};
        if (weight.of_row != 0.0) {
            const CloseSum& own = value_of_row(coordinate_of(k));
            sum = {weight.of_row * own.high, weight.of_row * own.low, own.lost};
        }
        if (weight.of_q != 0.0) {
            const CloseSum& row_of_q = value_of_row(3);
            add_product(sum, row_of_q.high, weight.of_q);
            add_product(sum, row_of_q.low, weight.of_q);
            sum.lost += 1.001 * std::fabs(weight.of_q) * row_of_q.lost;
        }
        const double value = sum.high + sum.low;
        if (std::fabs(value) <= sum.lost && sum.lost > 0.0) return exactly_at(k, weight, point).sign();
        return sign_of(value);
    }

    using Exact = Expansion<24>;
    Exact exactly_at(std::size_t k, const Weight& weight, const Point& point) const noexcept {
        const Row own = row(coordinate_of(k));
        const Row of_q_row = row(3);
        Exact sum;
        for (std::size_t j = 0; j < 4; ++j) {
            const double coordinate = j < 3 ? point[j] : 1.0;
            const DoubleDouble of_q = two_product(weight.of_q, of_q_row[j]);
            sum.add_product(weight.of_row * own[j], coordinate);
            sum.add_product(of_q.low, coordinate);
            sum.add_product(of_q.high, coordinate);
        }
        return sum;
    }

    static constexpr double infinity = std::numeric_limits<double>::infinity();

    std::size_t count_;
    glm::dmat4 matrix_;                   // of rows T_s, T_t, T_r and T_q
    std::array<double, max_forms> side_;  // min.x, max.x, min.y, max.y, and behind q those of r
    FormWeights weights_;
    std::array<Weight, max_forms> inner_weight_;
    FormLanes lanes_{};
    bool is_usable_;
    bool lights_nothing_;
};

}  // namespace TEXGEN_DETAIL
