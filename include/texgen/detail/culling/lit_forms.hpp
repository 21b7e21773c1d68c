#pragma once

// Where a slide falls, as linear forms. With rows T_s, T_t, T_q of a texgen matrix a point v = (x, y, z, 1) is lit iff
//
//   T_s v - min.x T_q v >= 0,  max.x T_q v - T_s v >= 0,  the same for t,  and  T_q v > 0,
//
// which are the four sides of a pyramid (of a prism, where T_q is constant) and the plane of its apex; and T_r likewise, where
// the region has a depth: the near and the far plane. What is asked of these forms is asked of their exact values, with the matrix as it is given. The sides are those beyond which nothing is
// lit, its rounding to float included; where all is lit, the inner sides say (see RoundedSide).

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
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
    CloseSum row[4];
};

// What the coefficients carry already, and 8 u of each term for its own rounding, for the sums and for the bound's.
inline void set_errors(LinearForm& form, const Point& error_of_a, double error_of_d) noexcept {
    form.error_a = 0.0;
    for (std::size_t j = 0; j < 3; ++j)
        form.error_a = larger(form.error_a, 1.001 * (error_of_a[j] + gamma(8) * std::fabs(form.a[j])));
    form.error_d = 1.001 * (error_of_d + gamma(8) * std::fabs(form.d)) + 0x1p-1000;
    form.error_a += 0x1p-1000;
}

class LitForms {
public:
    static constexpr std::size_t q = form_of_q;

    LitForms(const glm::dmat4& matrix, const TextureRegion& region) noexcept
        : count_(region.depth() ? max_forms : forms_without_depth) {
        const bool is_matrix_finite = is_finite(matrix);
        is_usable_ = is_matrix_finite && take_matrix(matrix) && take_sides(region);
        lights_nothing_ = is_matrix_finite && (is_empty(region) || (is_usable_ && rows_[3] == Row{}));
        if (!is_usable_ || lights_nothing_) return;
        for (std::size_t k = 0; k < count_; ++k) take_form(k);
    }

    // Five forms, or seven with a depth.
    std::size_t count() const noexcept { return count_; }

    // Whether exact sums with this side of a region stay in the range of double.
    static bool is_usable_side(const SlidePlane& side) noexcept {
        const double size = std::fabs(side.bound);
        return side.bound == side.none() || size == 0.0 || (size >= 0x1p-200 && size <= 0x1p200);
    }

    // Whether every point is dark: the region is empty or q is 0 everywhere.
    bool light_nothing() const noexcept { return lights_nothing_; }

    // Whether anything can be said: false for numbers that are not finite, and for exponents so far apart that an exact
    // sum could leave the range of double.
    bool are_usable() const noexcept { return is_usable_; }

    // Form k, times a positive number that brings its largest a near to 1.
    const LinearForm& operator[](std::size_t k) const noexcept { return forms_[k]; }

    // |a| of form k, or up to 2^-49 of it more.
    double slope(std::size_t k) const noexcept { return slopes_[k]; }

    // How much less form k may be for its inner side, at points of this size: (side - inner side) T_q.
    double narrowing(std::size_t k, double size) const noexcept {
        return narrowing_[k] * (largest_q_ * size + std::fabs(rows_[3][3]));
    }

    // -1, 0, 1: the sign of form k at a finite point, exactly.
    int sign_at(std::size_t k, const Point& point, CloseRows& close) const noexcept {
        const Bounded value = value_of(forms_[k].a, forms_[k].d, point);
        if (std::fabs(value.value) > value.error) return value.value > 0.0 ? 1 : -1;
        return close_sign_at(k, weight_[k], point, close);
    }

    // Whether form k is so large at a finite point that its inner side is above 0 at every point of that size.
    bool is_inside_at(std::size_t k, const Point& point, double size) const noexcept {
        const Bounded value = value_of(forms_[k].a, forms_[k].d, point);
        return value.value - value.error > 1.1 * narrowing(k, size);
    }

    // Side k, the inner one: its coefficients, each rounded once, and its sign at a finite point, exactly.
    std::array<double, 4> inner_side(std::size_t k) const noexcept { return form_of(k, inner_weight_[k]); }
    int inner_sign_at(std::size_t k, const std::array<double, 4>& form, const Point& point,
                      CloseRows& close) const noexcept {
        const Bounded value = value_of(form, form[3], point);
        if (std::fabs(value.value) > value.error) return value.value > 0.0 ? 1 : -1;
        return close_sign_at(k, inner_weight_[k], point, close);
    }

    // In float, scaled by powers of two so that one bound serves all: 7 u (max|a_j| size + |d|) with u = 2^-24, see classes(),
    // and 0.1 u for the bound's own roundings; 8.1 leaves room for one more. The change over a sphere, whose slope may be
    // sqrt(3) max|a_j|, errs by at most 3 u of it, less than 8.1 u of four radii.
    // |a_j| and |d| are so small that nothing overflows before the size does. What holds with room for the inner sides
    // holds for both, so one bound has that room, too.
    // A form is worth as much as it changes within the scene. How large that is, the distances of the sides from the
    // origin tell: a form that hardly changes there (q, nearly orthographic, or a far plane) is not scaled up to them. Nor
    // is a limit of depth whose rounding moves it far.
    FloatForms in_float() const noexcept {
        const auto gradient = [](const LinearForm& form) {
            return std::fabs(form.a[0]) + std::fabs(form.a[1]) + std::fabs(form.a[2]);
        };
        double extent = 0.0;
        for (std::size_t k = 0; k < q; ++k)
            if (gradient(forms_[k]) > 0.0) extent = larger(extent, std::fabs(forms_[k].d) / gradient(forms_[k]));
        FloatForms result{};
        double largest_a = 0.0;
        double largest_d = 0.0;
        double most_narrowed = 0.0;
        for (std::size_t lane = 0; lane < form_lanes; ++lane) {
            const std::size_t k = lane < count_ ? lane : q;
            const LinearForm& form = forms_[k];
            double size = larger(gradient(form), extent > 0.0 ? std::fabs(form.d) / extent : 0.0);
            if (k > q && extent > 0.0) size = larger(size, 0x1p22 * narrowing(k, extent) / extent);
            const double scale = size > 0x1p-900 && size < 0x1p900 ? 0.125 * reciprocal_power_of_two(size) : 0.0;
            for (std::size_t j = 0; j < 3; ++j) {
                result.a[j][lane] = static_cast<float>(scale * form.a[j]);
                result.magnitude_of_a[j][lane] = std::fabs(result.a[j][lane]);
                largest_a = larger(largest_a, scale * std::fabs(form.a[j]));
            }
            result.twice_d[lane] = static_cast<float>(2.0 * scale * form.d);
            result.slope[lane] = static_cast<float>(scale * slopes_[k]);
            largest_d = larger(largest_d, scale * std::fabs(form.d));
            most_narrowed = larger(most_narrowed, scale * narrowing_[k]);
        }
        result.count = count_;
        if (!(largest_d < 0x1p100)) largest_d = infinity;  // nothing is certain
        const double error_a = 8.1 * unit_roundoff_float * largest_a + 1.1 * most_narrowed * largest_q_;
        const double error_d = 8.1 * unit_roundoff_float * largest_d + 1.1 * most_narrowed * std::fabs(rows_[3][3]);
        result.error_per_size = static_cast<float>(error_a + 0x1p-100);
        result.error = static_cast<float>(2.0 * error_d + 0x1p-100);
        return result;
    }

    // In double, for boxes that floats leave in doubt.
    DoubleForms in_double() const noexcept {
        DoubleForms result;
        result.count = count_;
        for (std::size_t k = 0; k < count_; ++k) {
            take_exact_form(k, weight_[k], result.form[k].outer);
            take_exact_form(k, inner_weight_[k], result.form[k].inner);
            result.form[k].least_lit = k == q ? 0x1p-1000 : 0.0;
        }
        return result;
    }

    // T_s, T_t, T_r and T_q, and the outer sides of s and t: min, max.
    using Row = std::array<double, 4>;
    const Row& row(std::size_t coordinate) const noexcept { return rows_[coordinate]; }
    double side(std::size_t k) const noexcept { return side_[k]; }

    // A bit for each form that is not certain to be above 0 at a finite point.
    std::uint32_t dark_at(const Point& point) const noexcept {
        std::uint32_t dark = 0;
        for (std::size_t k = 0; k < count_; ++k) {
            const Bounded value = value_of(forms_[k].a, forms_[k].d, point);
            dark |= static_cast<std::uint32_t>(!(value.value > value.error)) << k;
        }
        return dark;
    }

private:
    // Form k is of_row * (T_s, T_t or T_r) + of_q * T_q.
    struct Weight {
        double of_row, of_q;
    };

    // A power of two takes the largest element to 1: nothing changes but the range of the exponents.
    bool take_matrix(const glm::dmat4& matrix) noexcept {
        double largest = 0.0;
        for (std::size_t k = 0; k < 4; ++k) {
            if (k == 2 && count_ == forms_without_depth) continue;
            for (std::size_t j = 0; j < 4; ++j) {
                rows_[k][j] = matrix[static_cast<glm::length_t>(j)][static_cast<glm::length_t>(k)];
                largest = larger(largest, std::fabs(rows_[k][j]));
            }
        }
        if (largest == 0.0) return true;
        if (!(largest >= 0x1p-1000 && largest < 0x1p1000)) return false;
        const double scale = reciprocal_power_of_two(largest);
        for (Row& row : rows_) {
            for (double& element : row) {
                if (element == 0.0) continue;
                element *= scale;
                if (!(std::fabs(element) >= 0x1p-600)) return false;
            }
        }
        for (std::size_t j = 0; j < 3; ++j) largest_q_ = larger(largest_q_, std::fabs(rows_[3][j]));
        return true;
    }

    // An infinite side is none, and q takes its place: it is one of the forms all the same. An inner side that no float is
    // inside of is where -q is not below 0: nowhere in front.
    bool take_sides(const TextureRegion& region) noexcept {
        const auto planes = slide_planes(region);
        for (const SlidePlane& plane : planes) {
            if (plane.coordinate == 3) continue;
            const std::size_t k = form_of(plane);
            if (!is_usable_side(plane)) return false;
            const RoundedSide rounded = RoundedSide::of(plane);
            const auto weight = [&](double u) {
                if (u == plane.none()) return Weight{0.0, 1.0};
                if (u == -plane.none()) return Weight{0.0, -1.0};
                return Weight{plane.sign, -plane.sign * u};
            };
            side_[k] = rounded.outer;
            weight_[k] = weight(rounded.outer);
            inner_weight_[k] = weight(rounded.inner);
            narrowing_[k] = plane.bound == plane.none() ? 0.0 : std::fabs(rounded.inner - rounded.outer);
        }
        weight_[q] = inner_weight_[q] = {0.0, 1.0};
        return true;
    }

    static std::size_t form_of(const SlidePlane& plane) noexcept {
        const std::size_t least = plane.coordinate == 2 ? q + 1 : 2 * static_cast<std::size_t>(plane.coordinate);
        return plane.sign > 0.0 ? least : least + 1;
    }
    const Row& row_of(std::size_t k) const noexcept { return rows_[k < 2 ? 0 : k < q ? 1 : k == q ? 3 : 2]; }

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

    // Each coefficient is rounded once, so that its sign is right and it is 0 only if it is 0.
    Row form_of(std::size_t k, const Weight& weight) const noexcept {
        const Row& row = row_of(k);
        Row form;
        for (std::size_t j = 0; j < 4; ++j) form[j] = std::fma(weight.of_q, rows_[3][j], weight.of_row * row[j]);
        return form;
    }

    void take_form(std::size_t k) noexcept {
        const Row form = form_of(k, weight_[k]);
        const double largest = larger(larger(std::fabs(form[0]), std::fabs(form[1])), std::fabs(form[2]));
        const double scale = reciprocal_power_of_two(largest > 0.0 ? largest : larger(std::fabs(form[3]), 0x1p-900));
        LinearForm& bounded = forms_[k];
        for (std::size_t j = 0; j < 3; ++j) {
            bounded.a[j] = scale * form[j];
            bounded.uses[j] = form[j] != 0.0;
        }
        bounded.d = scale * form[3];
        narrowing_[k] *= scale;
        set_errors(bounded, {}, 0.0);
        const auto& [a, b, c] = bounded.a;
        slopes_[k] = (1.0 + gamma(8)) * std::sqrt(a * a + b * b + c * c);
    }

    // The first 26 digits of a double; 27 are left. Times 24 digits, of a float or of a weight, which is one, either is a double.
    static double first_half(double value) noexcept {
        return bit_cast<double>(bit_cast<std::uint64_t>(value) & 0xfffffffff8000000);
    }

    void take_exact_form(std::size_t k, const Weight& weight, ExactForm& form) const noexcept {
        form.rounded = form_of(k, weight);
        form.term_count = 0;
        for (std::size_t j = 0; j < 4; ++j) {
            const auto add = [&](double factor) {
                if (factor != 0.0) form.terms[form.term_count++] = {factor, j};
            };
            if (form.rounded[j] == 0.0) continue;
            const double half = first_half(rows_[3][j]);
            const DoubleDouble most = two_sum(weight.of_row * row_of(k)[j], weight.of_q * half);
            const DoubleDouble all = two_sum(most.high, weight.of_q * (rows_[3][j] - half));
            for (const double part : {all.high, all.low, most.low}) {
                const double first = first_half(part);
                add(first);
                add(part - first);
            }
        }
        while (form.term_count < 2) form.terms[form.term_count++] = {0.0, 3};
    }

    // From the rows in two doubles, and at last exactly. of_row is -1, 0 or 1.
    int close_sign_at(std::size_t k, const Weight& weight, const Point& point, CloseRows& close) const noexcept {
        if (point != close.point) close = {{}, point, {}};
        const auto value_of_row = [&](const Row& row) -> const CloseSum& {
            const auto i = static_cast<std::size_t>(&row - rows_.data());
            CloseSum& value = close.row[i];
            if (!close.is_made[i]) {
                close.is_made[i] = true;
                value = {row[3], 0.0, 0.0};
                for (std::size_t j = 0; j < 3; ++j) value.add_product(row[j], point[j]);
            }
            return value;
        };
        CloseSum sum{};
        if (weight.of_row != 0.0) {
            const CloseSum& row = value_of_row(row_of(k));
            sum = {weight.of_row * row.high, weight.of_row * row.low, row.lost};
        }
        const CloseSum& row_of_q = value_of_row(rows_[3]);
        sum.add_product(weight.of_q, row_of_q.high);
        sum.add_product(weight.of_q, row_of_q.low);
        sum.lost += 1.001 * std::fabs(weight.of_q) * row_of_q.lost;
        const double value = sum.high + sum.low;
        if (std::fabs(value) <= sum.lost && sum.lost > 0.0) return exactly_at(k, weight, point).sign();
        return value > 0.0 ? 1 : value < 0.0 ? -1 : 0;
    }

    using Exact = Expansion<24>;
    Exact exactly_at(std::size_t k, const Weight& weight, const Point& point) const noexcept {
        const Row& row = row_of(k);
        Exact sum;
        for (std::size_t j = 0; j < 4; ++j) {
            const double coordinate = j < 3 ? point[j] : 1.0;
            const DoubleDouble of_q = two_product(weight.of_q, rows_[3][j]);
            sum.add_product(weight.of_row * row[j], coordinate);
            sum.add_product(of_q.low, coordinate);
            sum.add_product(of_q.high, coordinate);
        }
        return sum;
    }

    static constexpr double infinity = std::numeric_limits<double>::infinity();

    std::size_t count_;
    std::array<Row, 4> rows_{};                  // T_s, T_t, T_r, T_q
    std::array<double, max_forms> side_{};       // min.x, max.x, min.y, max.y, and behind q those of r
    std::array<double, max_forms> narrowing_{};  // their distance from the inner ones, times the scale of the form
    std::array<Weight, max_forms> weight_{}, inner_weight_{};
    double largest_q_ = 0.0;  // of the three coefficients
    std::array<LinearForm, max_forms> forms_{};
    std::array<double, max_forms> slopes_{};
    bool is_usable_;
    bool lights_nothing_;
};

}  // namespace TEXGEN_DETAIL

#include "separating_forms.inc.hpp"
