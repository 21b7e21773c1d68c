#pragma once

// What the kernels for boxes are given and what they return; see boxes.inc.hpp.

#include <array>
#include <cstddef>

#include "../language.hpp"

namespace TEXGEN_DETAIL {

// a . (x, y, z) + d, known to within error_a size + error_d when it is computed in double in any order, where the size of a
// point is |x| + |y| + |z|. A coordinate whose coefficient is exactly 0 is not used: there a box may be infinite.
struct LinearForm {
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

// A form by its four coefficients, each rounded once, and as a sum of terms that is exact: of a coordinate, the last of which
// is 1, and a factor with so few digits that its product with any float is a double. There are at least two.
struct ExactForm {
    struct Term {
        double factor;
        std::size_t coordinate;
    };
    std::array<double, 4> rounded;
    std::array<Term, 24> terms;
    std::size_t term_count;
};

// The same five for boxes that floats leave in doubt, and the inner ones. A point is outside where
// a form is below least_lit.
struct DoubleForms {
    struct Form {
        ExactForm outer, inner;
        double least_lit;  // 0, and for q a number that is smaller than any other value
    };
    std::array<Form, lit_form_count> form;
};

// What the five forms say of a box: the number of a Coverage (0 outside, 1 partial, 2 inside), or doubt.
inline constexpr int box_doubtful = 3;

// classify() takes a multiple of box_quantum.
inline constexpr std::size_t box_quantum = 16;

// Boxes, planar.
inline constexpr std::size_t box_block = 8;
struct BoxBlock {
    double min[3][box_block];
    double max[3][box_block];
};

// Bounds on the least over the five forms of the largest value over each box, and on the least of the inner ones: their
// signs are right, and where a lower one is negative beside an upper one that is not, nothing is known.
struct BoxBounds {
    double lower[box_block], upper[box_block];
    double inner_lower[box_block], inner_upper[box_block];
};

struct BoxKernels {
    // What floats are certain of. A box is six floats, min first. NaN, infinities and empty boxes are doubtful.
    void (*classify)(const FloatForms& forms, const float* boxes, std::size_t count, int* classes) noexcept;
    // What doubles are certain of, and where they are not, pairs of doubles. For proper boxes, which may be infinite.
    void (*bound)(const DoubleForms& forms, const BoxBlock& boxes, BoxBounds& bounds) noexcept;
    // The least over the forms of the largest value over each box, never below the exact one.
    void (*separate)(const LinearForm* forms, std::size_t count, const BoxBlock& boxes,
                     double* least_of_largest) noexcept;
};

}  // namespace TEXGEN_DETAIL
