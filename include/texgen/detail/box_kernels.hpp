#pragma once

// What the kernels for boxes are given and what they return; see boxes.inc.hpp.

#include <array>
#include <cstddef>

namespace TEXGEN_DETAIL {

// a . (x, y, z) + d, known to within error_a (|x| + |y| + |z|) + error_d when it is computed in double in any order. A
// coordinate whose coefficient is exactly 0 is not used: there a box may be infinite.
struct BoundedForm {
    std::array<double, 3> a;
    double d;
    double error_a, error_d;
    std::array<bool, 3> uses;
};

// The forms of a slide: its sides s_min, s_max, t_min, t_max, and q.
inline constexpr std::size_t side_count = 4;
inline constexpr std::size_t lit_form_count = 5;

// The same in float, with one bound for all: each errs by less than error_per_size * size + error at the points of a box,
// where size is the sum of the largest |x|, |y| and |z| in it.
struct FloatForms {
    struct Form {
        float a[3];
        float d;
    };
    Form form[lit_form_count];
    float error_per_size, error;
};

// What the five forms say of a box: the numbers of Coverage's enumerators, or doubt.
inline constexpr int box_outside = 0;
inline constexpr int box_partial = 1;
inline constexpr int box_inside = 2;
inline constexpr int box_doubtful = 3;

// classify() takes a multiple of box_quantum.
inline constexpr std::size_t box_quantum = 16;

// Boxes, planar. size is the larger magnitude of both sides.
inline constexpr std::size_t box_block = 8;
struct BoxBlock {
    double min[3][box_block];
    double max[3][box_block];
    double size[3][box_block];
};

struct BoxKernels {
    // What floats are certain of. A box is six floats, min first. NaN, infinities and empty boxes are doubtful.
    void (*classify)(const FloatForms& forms, const float* boxes, std::size_t count, int* classes) noexcept;
    // The least over the forms of the largest value over each box, never below the exact one.
    void (*separate)(const BoundedForm* forms, std::size_t count, const BoxBlock& boxes,
                     double* least_of_largest) noexcept;
};

}  // namespace TEXGEN_DETAIL
