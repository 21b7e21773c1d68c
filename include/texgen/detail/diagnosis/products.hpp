#pragma once

// The factors of a texgen matrix, the scale-bias S, the projector's P and V, and the pose X (the model matrix M or the
// camera's V_e^-1), their products and what rounding may change of these; and two mistakes that are no product: row r
// of the other depth range, a bias without w.

#include <cmath>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "../arithmetic/inverse.hpp"
#include "../arithmetic/rounding.hpp"
#include "matrix_signs.hpp"

namespace TEXGEN_DETAIL {

// A product, and the sums of the magnitudes of its terms, which its rounding is relative to.
template <class Value>
struct ProductOf {
    Value value, magnitude;
};
template <class A, class B>
auto operator*(const ProductOf<A>& a, const ProductOf<B>& b) noexcept {
    return ProductOf<decltype(a.value * b.value)>{a.value * b.value, a.magnitude * b.magnitude};
}
using Product = ProductOf<glm::dmat4>;

inline Product lens_factor(const glm::dmat4& m) noexcept { return {m, absolute(m)}; }

// Rotations and inverses carry noise relative to the largest element of a column, also where they hold a zero.
inline Product pose_factor(const glm::dmat4& m) noexcept {
    Product result = lens_factor(m);
    for (glm::length_t column = 0; column < 4; ++column) {
        glm::dvec4& c = result.magnitude[column];
        c.x = c.y = c.z = larger(c.x, larger(c.y, c.z));
    }
    return result;
}

// What three products lose in addition where floats are below 2^-126.
inline constexpr double lost_by_subnormal_floats = 0x1p-147;

// What a matrix may differ from a product by: a share of the element, and of the magnitudes of its terms.
struct Closeness {
    double of_element, of_magnitude;
};

// Composed in double, of the same factors, and rounded once at most.
inline constexpr Closeness composed_in_double{0.0, 0x1p-44};
inline constexpr Closeness rounded_once{0x1p-23, 0x1p-44};
// Of the same factors in any order: three products in float of factors rounded to float err by at most 16 * 2^-24.
inline constexpr Closeness products_in_double{0.0, 0x1p-43}, products_in_float{0.0, 0x1p-20};
// Composed with a float inverse among the factors, too.
inline constexpr Closeness composed_in_float{0.0, 0x1p-16};

// The k by which the product is nearest to `given`, in rows that are not zero there (if it was read transposed in such
// columns, too): planes that were never written say nothing. within() gives k where they are that near, else 0.
class Multiple {
public:
    Multiple(const Product& product, const glm::dmat4& given, bool was_transposed = false) noexcept
        : product_(product), given_(given), was_transposed_(was_transposed) {
        double along = 0.0;
        double norm = 0.0;
        for (glm::length_t row = 0; row < 4; ++row) {
            if (is_zero_row(given, row)) continue;
            for (glm::length_t column = 0; column < 4; ++column) {
                const double magnitude = product.magnitude[column][row];
                if (!(magnitude > 0.0) || says_nothing(column)) continue;
                const double value = product.value[column][row] / magnitude;
                const double weight = magnitude / (magnitude + 0x1p-100);  // where floats may be subnormal, little
                along += weight * (given[column][row] / magnitude * value);
                norm += weight * (value * value);
            }
        }
        multiple_ = norm > 0.0 ? along / norm : 0.0;
    }

    double within(const Closeness& closeness) const noexcept {
        for (glm::length_t row = 0; row < 4; ++row) {
            if (is_zero_row(given_, row)) continue;
            for (glm::length_t column = 0; column < 4; ++column) {
                if (says_nothing(column)) continue;
                const double value = product_.value[column][row];
                const double accepted =
                    closeness.of_element * std::fabs(value) + closeness.of_magnitude * product_.magnitude[column][row];
                const double error = std::fabs(given_[column][row] - multiple_ * value);
                if (!(error <= std::fabs(multiple_) * accepted + lost_by_subnormal_floats)) return 0.0;
            }
        }
        return is_finite(multiple_) ? multiple_ : 0.0;
    }

private:
    bool says_nothing(glm::length_t column) const noexcept {
        return was_transposed_ && given_[column] == glm::dvec4(0.0);
    }

    const Product& product_;
    const glm::dmat4& given_;
    bool was_transposed_;
    double multiple_;
};

enum class Order { right, view_before_projection, wrong };
enum class PoseUse { right, inverted, left_out, doubled };
enum class ScaleBiasUse { right, left_out, doubled, without_w };

// How a matrix was made of its factors.
struct Composition {
    bool transposed = false;
    Order order = Order::right;
    PoseUse pose = PoseUse::right;
    ScaleBiasUse scale_bias = ScaleBiasUse::right;
    bool s_mirrored = false, t_mirrored = false, other_depth = false;
    double multiple = 1.0;
};

// Numbers that no scene has cost time (subnormal ones) or make products overflow: small ones become 0, large ones NaN.
inline glm::dmat4 as_in_scenes(const glm::dmat4& matrix) noexcept {
    glm::dmat4 m = matrix;
    for (glm::length_t column = 0; column < 4; ++column) {
        for (glm::length_t row = 0; row < 4; ++row) {
            double& element = m[column][row];
            if (std::fabs(element) < 0x1p-150) element = 0.0;
            if (std::fabs(element) > 0x1p150) element = nan;
        }
    }
    return m;
}

struct Factors {
    glm::dmat4 scale_bias, projection, view;
    std::optional<glm::dmat4> pose;  // empty: the points are in the world

    // In place of braces, for GCC 12: see DoubtfulJob in triangle/doubt.hpp.
    Factors(const glm::dmat4& s, const glm::dmat4& p, const glm::dmat4& v,
            const std::optional<glm::dmat4>& of_points) noexcept
        : scale_bias(s), projection(p), view(v), pose(of_points) {}
};

inline Factors as_in_scenes(const Factors& given) noexcept {
    Factors factors = given;
    for (glm::dmat4* const matrix : {&factors.scale_bias, &factors.projection, &factors.view})
        *matrix = as_in_scenes(*matrix);
    if (factors.pose) factors.pose = as_in_scenes(*factors.pose);
    return factors;
}

inline Product scale_bias_factor(const Factors& factors, const Composition& composition) noexcept {
    if (composition.scale_bias == ScaleBiasUse::left_out) return lens_factor(glm::dmat4(1.0));
    glm::dmat4 matrix = factors.scale_bias;
    if (composition.s_mirrored) matrix[0][0] = -matrix[0][0];
    if (composition.t_mirrored) matrix[1][1] = -matrix[1][1];
    if (composition.other_depth) {
        const bool halves = matrix[3][2] != 0.0;
        matrix[2][2] = halves ? 1.0 : 0.5;
        matrix[3][2] = halves ? 0.0 : 0.5;
    }
    const Product once = lens_factor(matrix);
    return composition.scale_bias == ScaleBiasUse::doubled ? once * once : once;
}

// The pose as a mistake would use it; empty for an inverse that does not exist.
inline std::optional<Product> pose_factor(const Factors& factors, PoseUse use) noexcept {
    if (!factors.pose) return use == PoseUse::right ? std::optional(lens_factor(glm::dmat4(1.0))) : std::nullopt;
    if (use == PoseUse::left_out) return lens_factor(glm::dmat4(1.0));
    if (use == PoseUse::inverted) {
        const CertifiedInverse inverse(*factors.pose);
        return inverse.is_regular() ? std::optional(pose_factor(as_in_scenes(inverse.matrix()))) : std::nullopt;
    }
    const Product once = pose_factor(*factors.pose);
    return use == PoseUse::doubled ? once * once : once;
}

// V X, and S P V X.
inline Product pose_product(const Factors& factors) noexcept {
    const Product view = pose_factor(factors.view);
    return factors.pose ? view * pose_factor(*factors.pose) : view;
}
inline Product right_composition(const Factors& factors) noexcept {
    return scale_bias_factor(factors, {}) * lens_factor(factors.projection) * pose_product(factors);
}

// Whether rows s, t and q are right, and row r = a z + b w is that of a lens or a scale-bias for the other range. Where
// row r is as near to the right one as a product in float may be, the other rows show how large the rounding is: row r
// must be farther from the right one than that, and as near to one of the other range.
inline bool is_of_other_range(const glm::dmat4& texgen, const glm::dmat4& scale_bias, const Product& right) noexcept {
    glm::dmat4 other_rows = texgen;
    for (glm::length_t column = 0; column < 4; ++column) other_rows[column][2] = 0.0;
    const double multiple = Multiple(right, other_rows).within(composed_in_float);
    if (!(multiple > 0.0)) return false;
    // How far row `row` of the matrix is from a times the right product's plus b times its row q, in its magnitudes.
    const auto distance = [&](glm::length_t row, double a, double b) {
        double result = 0.0;
        for (glm::length_t column = 0; column < 4; ++column) {
            const double value = a * right.value[column][row] + b * right.value[column][3];
            const double magnitude =
                std::fabs(a) * right.magnitude[column][row] + std::fabs(b) * right.magnitude[column][3];
            const double error = std::fabs(texgen[column][row] - multiple * value);
            if (error > 0.0) result = larger(result, ratio(error, multiple * magnitude));
        }
        return result;
    };
    const double to_right = distance(2, 1.0, 0.0);
    const double rounding = larger(larger(distance(0, 1.0, 0.0), distance(1, 1.0, 0.0)),
                                   larger(distance(3, 1.0, 0.0), is_in_float(texgen) ? unit_roundoff_float : 0x1p-44));
    const bool is_near = to_right <= composed_in_float.of_magnitude;
    if (is_near && to_right <= 8.0 * rounding) return false;
    const double accepted = is_near ? 4.0 * rounding : composed_in_float.of_magnitude;
    // z, (z + w) / 2, 2 z - w and (z + 3 w) / 4, of r = scale z + bias w.
    const double scale = scale_bias[2][2], bias = scale_bias[3][2];
    for (const glm::dvec2& row :
         {glm::dvec2(1.0, 0.0), glm::dvec2(0.5, 0.5), glm::dvec2(2.0, -1.0), glm::dvec2(0.25, 0.75)}) {
        const double to_other = distance(2, row.x / scale, row.y - row.x * bias / scale);
        if (to_other <= accepted) return true;
    }
    return false;
}

// Whether the matrix is clip * scale + bias with a bias that is not times w, in x and y, and in z and w or not. Scale
// and bias are those of S or 1/2, in either direction of t; glm::mat4 + number has the bias in every column.
inline bool is_bias_without_w(const glm::dmat4& texgen, const Factors& factors) noexcept {
    // Parallel light has w = 1, and needs no other bias.
    if (!is_perspective(factors.projection)) return false;
    const Product clip = lens_factor(factors.projection) * pose_product(factors);
    const auto is_row = [&](glm::length_t row, double scale, const glm::dvec4& bias) {
        for (glm::length_t column = 0; column < 4; ++column) {
            const double magnitude = std::fabs(scale) * clip.magnitude[column][row] + std::fabs(bias[column]);
            const double value = scale * clip.value[column][row] + bias[column];
            if (!(std::fabs(texgen[column][row] - value) <= composed_in_float.of_magnitude * magnitude)) return false;
        }
        return true;
    };
    const glm::dvec4 constant(0.0, 0.0, 0.0, 1.0);
    const auto is_biased = [&](glm::length_t row) {
        const double scale = factors.scale_bias[row][row];
        const glm::dvec4 bias = factors.scale_bias[3][row] * constant;
        return is_row(row, scale, bias) || is_row(row, -scale, bias) || is_row(row, 0.5, 0.5 * constant) ||
               is_row(row, 0.5, glm::dvec4(0.5));
    };
    return is_biased(0) && is_biased(1) &&
           (is_row(3, 1.0, glm::dvec4(0.0)) || is_row(3, 0.5, 0.5 * constant) || is_row(3, 0.5, glm::dvec4(0.5)));
}

}  // namespace TEXGEN_DETAIL
