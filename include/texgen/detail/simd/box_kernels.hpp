#pragma once

// What the kernels for boxes and spheres are given and what they return; see boxes.inc.hpp.

#include <array>
#include <cstddef>

#include <glm/mat4x4.hpp>

#include "../language.hpp"

namespace TEXGEN_DETAIL {

// The forms of a slide: its sides s_min, s_max, t_min, t_max, then q, and r_min, r_max where it has a depth.
inline constexpr std::size_t form_of_q = 4;
inline constexpr std::size_t forms_without_depth = 5;
inline constexpr std::size_t max_forms = 7;

// The edges, in each of which two of these forms meet; those behind the fourth are of a depth.
inline constexpr std::size_t max_edges = 12;
inline constexpr std::size_t first_of_edge[max_edges] = {0, 0, 1, 1, 0, 0, 1, 1, 2, 2, 3, 3};
inline constexpr std::size_t second_of_edge[max_edges] = {2, 3, 2, 3, 5, 6, 5, 6, 5, 6, 5, 6};
constexpr std::size_t edge_count(std::size_t form_count) noexcept { return form_count < max_forms ? 4 : max_edges; }

// The weights of forms, a lane each; lanes behind the last form are q's. Form k is of[0] T_s + of[1] T_t + of[2] T_r +
// of_q T_q: at most one of the three is not 0, but 1 or -1, and of_q is a float. Its inner side has others.
inline constexpr std::size_t form_lanes = 8;
struct FormWeights {
    double of[3][form_lanes], of_q[form_lanes];
};

// The forms a . (x, y, z) + d. A coefficient is rounded, but keeps its sign, and is 0 only if the exact one is; all of
// a form are scaled by a power of two that brings its largest a near to 1. With size = |x| + |y| + |z| a form in double
// errs by at most error_a * size + error_d, and T_q is at most largest_q * size + last_q. The inner side is less by
// narrowing * T_q.
struct FormLanes {
    double a[3][form_lanes], d[form_lanes], narrowing[form_lanes], error_a[form_lanes], error_d[form_lanes];
    double largest_q, last_q;
};

// The same forms, scaled so that |a| is 1, or up to 14 u less; a constant form is far above any radius.
struct UnitForms : FormLanes {};

// The same forms in float, a lane each, of twice the value, with one bound for all: over a body each errs by less than
// error_per_size * size + error, where the size of a box is the sum of |min + max| and max - min of its coordinates,
// that of a sphere twice the sum of |x|, |y|, |z| and four times its radius. Lanes behind the last form are q's.
struct FloatForms {
    float a[3][form_lanes], magnitude_of_a[3][form_lanes];
    float twice_d[form_lanes];
    float slope[form_lanes];  // |a|, or a little more
    std::size_t count;
    float error_per_size, error;
};

// The planes that may separate boxes beside the slide's own: for each axis those of 4 edges, or 12 where there is a
// depth, and of 8 vertices; and those of the apex; in whole vectors. A coordinate whose coefficient is 0 is not used:
// there a box may be infinite. d has its own error added, and `error` is what a point of size 1 adds.
inline constexpr std::size_t max_separating = 3 * 16 + 8 + 3 * 8;
struct SeparatingPlanes {
    double a[3][max_separating], d[max_separating], error[max_separating];
    std::size_t count;
};

// A form at the vertex of a box where it is largest, or least: its four coefficients, each rounded once, and for the
// first three the row of the box that each is multiplied by. Rows are min, max, 1 and 0; a coefficient that is 0 has
// the row of 0, as a box may be infinite there. `term` is the same form as an exact sum, of factors with so few digits
// that the product with any float is a double.
struct FormAtVertex {
    static constexpr std::size_t row_of_1 = 6, row_of_0 = 7, max_terms = 3 * 6 + 3 + 1;
    struct Term {
        double factor;
        std::size_t row;
    };
    std::array<double, 4> coefficient, error;
    std::array<std::size_t, 3> row;
    std::array<Term, max_terms> term;
    std::size_t term_count;
};

// The forms for boxes that floats leave in doubt, where they are largest, and the inner ones where they are least. A
// point is outside where one is below 0, or q is 0.
struct DoubleForms {
    struct Form {
        FormAtVertex largest, least;
    };
    std::array<Form, max_forms> form;
    std::size_t count = 0;
};

// What the forms say of a body: the number of a Coverage (0 outside, 1 partial, 2 inside); where that is not the last
// word 4 more: a further plane may separate what is partial, or there is doubt.
inline constexpr int open_body = 4;
inline constexpr int body_in_doubt = open_body + 3;
inline constexpr int body_not_outside = open_body + 0;  // in doubt is only whether one box is inside
inline constexpr int body_not_inside = open_body + 2;   // or only whether it is outside

// The kernels of many bodies take a multiple of body_quantum.
inline constexpr std::size_t body_quantum = 16;

// Bodies that floats leave open, planar: min and max of boxes, centre and radius of spheres.
using OpenRow = float[body_quantum];

// Each table is compiled where it is asked for: a program has what its questions need. The forms are made in double
// and, for many bodies, in float.
struct FormKernels {
    // `narrowing` is given without the scale that forms get.
    void (*weigh)(const glm::dmat4& matrix, const FormWeights& weights, FormLanes& forms) noexcept;
};
struct FloatFormKernels {
    void (*round)(const FormLanes& forms, std::size_t count, FloatForms& result) noexcept;
};

// Further forms that are >= 0 wherever all of a slide's are, each a combination of those with weights that are exactly
// >= 0. Where one of them is negative over all of a convex body, nothing of the body is lit. The matrix is so large
// that no product of two elements underflows, see LitForms::separating().
struct SeparatingPlaneKernels {
    void (*make)(const FormLanes& forms, const glm::dmat4& matrix, const double* side, std::size_t form_count,
                 SeparatingPlanes& planes) noexcept;
};

// One box.
struct BoxKernels {
    // What doubles are certain of. Empty boxes are in doubt, and those that have a coordinate that is not finite.
    int (*classify)(const FormLanes& forms, const float* min, const float* max) noexcept;
    // What the forms say of a box that has points, exactly; what classify() decided with `answer` is not asked.
    int (*decide)(int answer, const glm::dmat4& matrix, const FormWeights& outer, const FormWeights& inner,
                  const float* min, const float* max) noexcept;
    // Whether one of the planes is negative over all of a box that has points.
    bool (*is_separated)(const SeparatingPlanes& planes, const float* min, const float* max) noexcept;
};

// What floats are certain of. A box is six floats, min first; a sphere four, the radius last. NaN, infinities, empty
// boxes and negative radii are in doubt.
using Classify = void (*)(const FloatForms& forms, const float* bodies, std::size_t count, int* classes) noexcept;

struct BoxBatchKernels {
    Classify classify;
    // Decides by the forms, in double or by exact sums, and by the planes: what one separates is outside. Without
    // forms, what none separates is partial. What has no points is in doubt.
    void (*decide)(const DoubleForms* forms, const SeparatingPlanes& planes, const OpenRow* boxes, std::size_t count,
                   int* classes) noexcept;
};
struct SphereKernels {
    Classify classify;
    // The last word, but for what is infinite and what is no sphere: that is in doubt.
    void (*decide)(const UnitForms& forms, std::size_t form_count, const OpenRow* spheres, std::size_t count,
                   int* classes) noexcept;
};

}  // namespace TEXGEN_DETAIL
