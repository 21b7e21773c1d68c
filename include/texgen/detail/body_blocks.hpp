#pragma once

// Boxes against the forms of a slide, a block at a time: planar arrays, and loops of a fixed length without branches,
// which compilers turn into vectors from -O2 on. Of most boxes a form is negative throughout, and floats prove it; what
// they leave is decided in double.

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "lit_forms.hpp"
#include "rounding.hpp"

namespace texgen::detail {

inline constexpr std::size_t box_block = 32;
inline constexpr std::size_t double_box_block = 8;

template <class Real, std::size_t N>
struct BoxBlock {
    using Lanes = std::array<Real, N>;

    std::array<Lanes, 3> min, max;

    template <class Box>
    void set(std::size_t i, const Box& box) noexcept {
        min[0][i] = static_cast<Real>(box.min.x);
        min[1][i] = static_cast<Real>(box.min.y);
        min[2][i] = static_cast<Real>(box.min.z);
        max[0][i] = static_cast<Real>(box.max.x);
        max[1][i] = static_cast<Real>(box.max.y);
        max[2][i] = static_cast<Real>(box.max.z);
    }

    // The coordinates of the vertices where a form with these coefficients is largest.
    template <class Coefficient>
    std::array<const Real*, 3> largest_vertices(const std::array<Coefficient, 3>& a) const noexcept {
        const Coefficient zero = 0;
        return {(a[0] > zero ? max : min)[0].data(), (a[1] > zero ? max : min)[1].data(),
                (a[2] > zero ? max : min)[2].data()};
    }
};

// The five forms in float, scaled by powers of two so that one bound serves all. With u = 2^-24 a coefficient is rounded
// (1 u), as are its product (1 u) and at most three sums (3 u), so that a form errs by 5 u (max|a_j| size + |d|) where
// size is the sum of all magnitudes of a box; the sum of the sizes and the bound's own roundings are in the 5.1.
// |a| and |d| stay so small that nothing overflows before the bound does.
class FloatForms {
public:
    // A form is worth as much as it changes within the scene. How large that is, the distances of the sides from the
    // origin tell: a form that hardly changes there (q, nearly orthographic) is not scaled up to them.
    explicit FloatForms(const LitForms& forms) noexcept {
        double extent = 0.0;
        for (std::size_t k = 0; k < LitForms::side_count; ++k)
            if (gradient(forms[k]) > 0.0) extent = larger(extent, std::fabs(forms[k].d) / gradient(forms[k]));
        double largest_a = 0.0;
        double largest_d = 0.0;
        for (std::size_t k = 0; k < LitForms::count; ++k) {
            const double size = larger(gradient(forms[k]), extent > 0.0 ? std::fabs(forms[k].d) / extent : 0.0);
            const double scale = size > 0x1p-900 && size < 0x1p900 ? 0.125 * reciprocal_power_of_two(size) : 0.0;
            for (std::size_t j = 0; j < 3; ++j) {
                forms_[k].a[j] = static_cast<float>(scale * forms[k].a[j]);
                largest_a = larger(largest_a, scale * std::fabs(forms[k].a[j]));
            }
            forms_[k].d = static_cast<float>(scale * forms[k].d);
            largest_d = larger(largest_d, scale * std::fabs(forms[k].d));
        }
        if (!(largest_d < 0x1p100)) largest_d = std::numeric_limits<double>::infinity();  // nothing is certain
        error_per_size_ = static_cast<float>(5.1 * unit_roundoff_float * largest_a + 0x1p-100);
        error_ = static_cast<float>(5.1 * unit_roundoff_float * largest_d + 0x1p-100);
    }

    using Block = BoxBlock<float, box_block>;

    // rejected[i] is 1 where a form is certainly negative over all of box i, else 0. A NaN or an infinity anywhere in a box
    // makes its bound one, and nothing is certain.
    void reject(const Block& boxes, std::array<int, box_block>& rejected) const noexcept {
        std::array<float, box_block> least;
        least.fill(std::numeric_limits<float>::max());
        for (const Form& form : forms_) {
            const auto [x, y, z] = boxes.largest_vertices(form.a);
            const auto [a, b, c] = form.a;
            const float d = form.d;
            for (std::size_t i = 0; i < box_block; ++i) {
                const float largest = a * x[i] + (b * y[i] + (c * z[i] + d));
                least[i] = largest < least[i] ? largest : least[i];
            }
        }
        const float error_per_size = error_per_size_;
        const float error = error_;
        for (std::size_t i = 0; i < box_block; ++i) {
            const float size = (std::fabs(boxes.min[0][i]) + std::fabs(boxes.max[0][i])) +
                               ((std::fabs(boxes.min[1][i]) + std::fabs(boxes.max[1][i])) +
                                (std::fabs(boxes.min[2][i]) + std::fabs(boxes.max[2][i])));
            rejected[i] = least[i] + (error_per_size * size + error) < 0.0f ? 1 : 0;
        }
    }

private:
    struct Form {
        std::array<float, 3> a;
        float d;
    };

    static double gradient(const BoundedForm& form) noexcept {
        return std::fabs(form.a[0]) + std::fabs(form.a[1]) + std::fabs(form.a[2]);
    }

    std::array<Form, LitForms::count> forms_{};
    float error_per_size_;
    float error_;
};

using DoubleBlock = BoxBlock<double, double_box_block>;
using DoubleLanes = DoubleBlock::Lanes;

// The least over the five forms of the largest and of the least value over each box.
inline void find_extremes(const LitForms& forms, const DoubleBlock& boxes, DoubleLanes& least_of_largest,
                          DoubleLanes& least) noexcept {
    least_of_largest.fill(0x1p1000);
    least.fill(0x1p1000);
    for (std::size_t k = 0; k < LitForms::count; ++k) {
        const BoundedForm& form = forms[k];
        const auto [a, b, c] = form.a;
        const double d = form.d;
        const auto [x, y, z] = boxes.largest_vertices(form.a);
        const auto [u, v, w] = boxes.largest_vertices(std::array{-a, -b, -c});
        for (std::size_t i = 0; i < double_box_block; ++i) {
            const double largest = a * x[i] + (b * y[i] + (c * z[i] + d));
            const double smallest = a * u[i] + (b * v[i] + (c * w[i] + d));
            least_of_largest[i] = smaller(largest, least_of_largest[i]);
            least[i] = smaller(smallest, least[i]);
        }
    }
}

// The least over the separating forms of the largest value over each box, never below its exact value. What a form does
// not use is taken for 0, whatever the box has there; a NaN (of an infinity) proves nothing.
inline void find_separation(const LitForms& forms, const DoubleBlock& boxes, DoubleLanes& least_of_largest) noexcept {
    constexpr DoubleLanes zeros{};
    std::array<DoubleLanes, 3> size;
    for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < double_box_block; ++i) size[j][i] = larger(-boxes.min[j][i], boxes.max[j][i]);
    least_of_largest.fill(1.0);
    for (const BoundedForm& form : forms.separating()) {
        auto [x, y, z] = boxes.largest_vertices(form.a);
        const double* sizes[3];
        for (std::size_t j = 0; j < 3; ++j) sizes[j] = form.uses[j] ? size[j].data() : zeros.data();
        if (!form.uses[0]) x = zeros.data();
        if (!form.uses[1]) y = zeros.data();
        if (!form.uses[2]) z = zeros.data();
        const auto [a, b, c] = form.a;
        const auto [u, v, w] = sizes;
        const double d = form.d + form.error_d;
        const double error_a = form.error_a;
        for (std::size_t i = 0; i < double_box_block; ++i) {
            const double largest = a * x[i] + (b * y[i] + (c * z[i] + d)) + error_a * (u[i] + (v[i] + w[i]));
            least_of_largest[i] = smaller(largest, least_of_largest[i]);
        }
    }
}

}  // namespace texgen::detail
