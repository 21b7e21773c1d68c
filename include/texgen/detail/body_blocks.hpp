#pragma once

// Boxes and spheres against the forms of a slide, a block at a time: planar arrays, and loops of a fixed length without
// branches, which compilers turn into vectors at -O2, with the instruction set of the flags.

#include <array>
#include <cmath>
#include <cstddef>

#include "lit_forms.hpp"
#include "rounding.hpp"

namespace texgen::detail {

inline constexpr std::size_t body_block = 16;

template <class Real>
using Lane = std::array<Real, body_block>;

// The five forms in float, for what they decide without doubt. Scaled by powers of two, so that one bound serves all:
// where |x|, |y|, |z| <= size <= largest_size, each form is computed within error_per_size * size + error. With
// u = 2^-24 a coefficient is rounded (1 u), as are its product (1 u) and at most three sums (3 u).
class FloatForms {
public:
    struct Form {
        std::array<float, 3> a;
        float d;
    };

    // A form is worth as much as it changes within the scene. How large that is, the distances of the sides from the
    // origin tell: a form that hardly changes there (q, nearly orthographic) is not scaled up to them.
    explicit FloatForms(const LitForms& forms) noexcept {
        double extent = 0.0;
        for (std::size_t k = 0; k < LitForms::side_count; ++k)
            if (gradient(forms[k]) > 0.0) extent = larger(extent, std::fabs(forms[k].d) / gradient(forms[k]));
        if (extent == 0.0) extent = 1.0;
        double largest_gradient = 0.0;
        double largest_d = 0.0;
        for (std::size_t k = 0; k < LitForms::count; ++k) {
            const double size = larger(gradient(forms[k]), std::fabs(forms[k].d) / extent);
            const double scale = size > 0x1p-900 && size < 0x1p900 ? reciprocal_power_of_two(size) : 1.0;
            for (std::size_t j = 0; j < 3; ++j) forms_[k].a[j] = static_cast<float>(scale * forms[k].a[j]);
            forms_[k].d = static_cast<float>(scale * forms[k].d);
            largest_gradient = larger(largest_gradient, scale * gradient(forms[k]));
            largest_d = larger(largest_d, scale * std::fabs(forms[k].d));
        }
        // Beyond this nothing is certain.
        if (!(largest_d < 0x1p100 && largest_gradient < 0x1p10)) largest_d = std::numeric_limits<double>::infinity();
        error_per_size_ = static_cast<float>(5.1 * unit_roundoff_float * largest_gradient + 0x1p-100);
        error_ = static_cast<float>(5.1 * unit_roundoff_float * largest_d + 0x1p-100);
    }

    const Form& operator[](std::size_t k) const noexcept { return forms_[k]; }
    float error_per_size() const noexcept { return error_per_size_; }
    float error() const noexcept { return error_; }

    static constexpr float largest_size = 0x1p100f;

private:
    static double gradient(const BoundedForm& form) noexcept {
        return std::fabs(form.a[0]) + std::fabs(form.a[1]) + std::fabs(form.a[2]);
    }

    std::array<Form, LitForms::count> forms_{};
    float error_per_size_;
    float error_;
};

// The enumerators of Coverage are 0, 1 and 2: outside, partial, inside.
inline constexpr int doubtful = 3;

template <class Real>
struct BoxBlock {
    std::array<Lane<Real>, 3> min, max;
};

// What the five planes say of each box, from the vertices that the signs of the coefficients pick: where the largest
// value of a form is negative, the box is outside; where all the least are positive, inside. Empty boxes, NaN and the
// infinities are doubtful.
inline void test_planes(const FloatForms& forms, const BoxBlock<float>& boxes, Lane<int>& verdicts) noexcept {
    Lane<float> least_of_largest;
    Lane<float> least;
    least_of_largest.fill(0x1p120f);
    least.fill(0x1p120f);
    for (std::size_t k = 0; k < LitForms::count; ++k) {
        const auto& [a, d] = forms[k];
        const float* far[3];
        const float* near[3];
        for (std::size_t j = 0; j < 3; ++j) {
            far[j] = (a[j] > 0.0f ? boxes.max : boxes.min)[j].data();
            near[j] = (a[j] > 0.0f ? boxes.min : boxes.max)[j].data();
        }
        for (std::size_t i = 0; i < body_block; ++i) {
            const float high = a[0] * far[0][i] + (a[1] * far[1][i] + (a[2] * far[2][i] + d));
            const float low = a[0] * near[0][i] + (a[1] * near[1][i] + (a[2] * near[2][i] + d));
            least_of_largest[i] = high < least_of_largest[i] ? high : least_of_largest[i];
            least[i] = low < least[i] ? low : least[i];
        }
    }
    for (std::size_t i = 0; i < body_block; ++i) {
        // Flags are numbers: compilers make vectors of these, and none of what could be a branch.
        float size = 0.0f;
        int is_certain = 1;
        for (std::size_t j = 0; j < 3; ++j) {
            const float low = boxes.min[j][i];
            const float high = boxes.max[j][i];
            const float largest = -low < high ? high : -low;
            is_certain &= low <= high ? 1 : 0;
            size = size < largest ? largest : size;
        }
        is_certain &= size <= FloatForms::largest_size ? 1 : 0;
        const float error = forms.error_per_size() * size + forms.error();
        const int outside = least_of_largest[i] < -error ? is_certain : 0;
        const int inside = least[i] > error ? is_certain : 0;
        const int reaches_in = least_of_largest[i] > error ? is_certain : 0;
        const int reaches_out = least[i] < -error ? is_certain : 0;
        verdicts[i] = doubtful - 3 * outside - 2 * (reaches_in & reaches_out) - inside;
    }
}

// The least over all separating forms of the largest value over each box, never below its exact value: where it is
// negative, the box is outside. A box may be infinite, but not empty.
inline void test_separation(const LitForms& forms, const BoxBlock<double>& boxes, Lane<double>& least) noexcept {
    constexpr Lane<double> zeros{};
    std::array<Lane<double>, 3> size;
    for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < body_block; ++i) size[j][i] = larger(-boxes.min[j][i], boxes.max[j][i]);
    least.fill(1.0);
    for (std::size_t k = 0; k < forms.separating_count(); ++k) {
        const BoundedForm& form = forms.separating(k);
        const double* far[3];
        const double* extent[3];
        for (std::size_t j = 0; j < 3; ++j) {
            far[j] = form.uses[j] ? (form.a[j] > 0.0 ? boxes.max : boxes.min)[j].data() : zeros.data();
            extent[j] = form.uses[j] ? size[j].data() : zeros.data();
        }
        const double d = form.d + form.error_d;
        for (std::size_t i = 0; i < body_block; ++i) {
            const double largest = form.a[0] * far[0][i] + (form.a[1] * far[1][i] + (form.a[2] * far[2][i] + d)) +
                                   form.error_a * (extent[0][i] + extent[1][i] + extent[2][i]);
            least[i] = largest < least[i] ? largest : least[i];
        }
    }
}

}  // namespace texgen::detail
