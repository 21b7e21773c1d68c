#pragma once

// Which product of the scale-bias S, the projector's P and V, and the pose X (the model matrix M or the camera's V_e^-1)
// a texgen matrix is: the right one, S P V X, or one that a mistake makes of it.

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <glm/mat4x4.hpp>

#include "../arithmetic/inverse.hpp"
#include "matrix_signs.hpp"

namespace TEXGEN_DETAIL {

// A product, and the sums of the magnitudes of its terms, which its rounding is relative to.
struct Product {
    glm::dmat4 value, magnitude;
};

inline Product operator*(const Product& a, const Product& b) noexcept {
    return {a.value * b.value, a.magnitude * b.magnitude};
}

inline Product lens_factor(const glm::dmat4& m) noexcept {
    Product result{m, m};
    for (glm::length_t column = 0; column < 4; ++column)
        for (glm::length_t row = 0; row < 4; ++row) result.magnitude[column][row] = std::fabs(m[column][row]);
    return result;
}

// Rotations and inverses carry noise relative to the largest element of a column, also where they hold a zero.
inline Product pose_factor(const glm::dmat4& m) noexcept {
    Product result = lens_factor(m);
    for (glm::length_t column = 0; column < 4; ++column) {
        glm::dvec4& c = result.magnitude[column];
        c.x = c.y = c.z = larger(c.x, larger(c.y, c.z));
    }
    return result;
}

// What a matrix may differ from a product by: a share of the element, and of the magnitudes of its terms.
struct Closeness {
    double of_element, of_magnitude;
};

// Composed in double, of the same factors, and rounded once at most.
inline constexpr Closeness composed_in_double{0.0, 0x1p-44};
inline constexpr Closeness rounded_once{0x1p-23, 0x1p-44};
// Three products in float of factors rounded to float err by 16 * 2^-24 at most; a float inverse may be among them.
inline constexpr Closeness composed_in_float{0.0, 0x1p-16};

// k where `given` is k times the product, in the rows (and, of what was read transposed, the columns) in which it is not
// zero: planes that were never written say nothing. 0 where it is not.
inline double multiple_of(const Product& product, const glm::dmat4& given, Closeness closeness,
                          bool was_transposed = false) noexcept {
    const auto says_nothing = [&](glm::length_t column) { return was_transposed && given[column] == glm::dvec4(0.0); };
    double along = 0.0;
    double norm = 0.0;
    for (glm::length_t row = 0; row < 4; ++row) {
        if (is_zero_row(given, row)) continue;
        for (glm::length_t column = 0; column < 4; ++column) {
            const double magnitude = product.magnitude[column][row];
            if (!(magnitude > 0.0) || says_nothing(column)) continue;
            const double value = product.value[column][row] / magnitude;
            along += given[column][row] / magnitude * value;
            norm += value * value;
        }
    }
    const double multiple = along / norm;
    for (glm::length_t row = 0; row < 4; ++row) {
        if (is_zero_row(given, row)) continue;
        for (glm::length_t column = 0; column < 4; ++column) {
            if (says_nothing(column)) continue;
            const double value = product.value[column][row];
            const double accepted =
                closeness.of_element * std::fabs(value) + closeness.of_magnitude * product.magnitude[column][row];
            if (!(std::fabs(given[column][row] - multiple * value) <= std::fabs(multiple) * accepted)) return 0.0;
        }
    }
    return is_finite(multiple) ? multiple : 0.0;
}

enum class Order { right, view_before_projection, wrong };
enum class PoseUse { right, left_out, inverted, doubled };
enum class ScaleBiasUse { right, left_out, doubled };

// How a matrix was made of its factors.
struct Composition {
    bool transposed = false;
    Order order = Order::right;
    PoseUse pose = PoseUse::right;
    ScaleBiasUse scale_bias = ScaleBiasUse::right;
    bool s_mirrored = false, t_mirrored = false, other_depth = false;
    double multiple = 1.0;
};

struct Factors {
    glm::dmat4 scale_bias, projection, view;
    std::optional<glm::dmat4> pose;  // empty: the points are in the world
};

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
    switch (use) {
        case PoseUse::right:
            return pose_factor(*factors.pose);
        case PoseUse::left_out:
            return lens_factor(glm::dmat4(1.0));
        case PoseUse::doubled:
            return pose_factor(*factors.pose) * pose_factor(*factors.pose);
        case PoseUse::inverted:
            break;
    }
    const CertifiedInverse inverse(*factors.pose);
    return inverse.regular() ? std::optional(pose_factor(inverse.matrix())) : std::nullopt;
}

inline Product right_composition(const Factors& factors) noexcept {
    const Product lens = scale_bias_factor(factors, {}) * lens_factor(factors.projection);
    const Product view = pose_factor(factors.view);
    return factors.pose ? lens * (view * pose_factor(*factors.pose)) : lens * view;
}

// Mirroring, depth and the use of a factor are told apart only where S stands once.
inline constexpr std::array scale_bias_mistakes{
    Composition{},
    Composition{.scale_bias = ScaleBiasUse::left_out},
    Composition{.scale_bias = ScaleBiasUse::doubled},
    Composition{.t_mirrored = true},
    Composition{.other_depth = true},
    Composition{.s_mirrored = true},
    Composition{.s_mirrored = true, .t_mirrored = true},
    Composition{.s_mirrored = true, .other_depth = true},
    Composition{.t_mirrored = true, .other_depth = true},
};

constexpr int mistakes(const Composition& c) noexcept {
    return c.transposed + (c.order != Order::right) + (c.pose != PoseUse::right) +
           (c.scale_bias != ScaleBiasUse::right) + c.s_mirrored + c.t_mirrored + c.other_depth;
}

// The orders of S (0), P (1), V (2) and X (3), the right one left out and the most likely first: V before P, then the
// row vectors' order, then the others.
inline constexpr std::array<std::array<std::size_t, 4>, 23> wrong_orders{
    {{0, 2, 1, 3}, {3, 2, 1, 0}, {3, 0, 1, 2}, {0, 1, 3, 2}, {1, 0, 2, 3}, {1, 2, 0, 3}, {1, 2, 3, 0}, {0, 3, 1, 2},
     {0, 2, 3, 1}, {0, 3, 2, 1}, {1, 0, 3, 2}, {1, 3, 0, 2}, {1, 3, 2, 0}, {2, 0, 1, 3}, {2, 0, 3, 1}, {2, 1, 0, 3},
     {2, 1, 3, 0}, {2, 3, 0, 1}, {2, 3, 1, 0}, {3, 0, 2, 1}, {3, 1, 0, 2}, {3, 1, 2, 0}, {3, 2, 0, 1}}};

// The composition with the fewest mistakes that gives the matrix; empty where none with `most` does.
inline std::optional<Composition> composition_of(const glm::dmat4& texgen, const Factors& factors, int most,
                                                 Closeness closeness) noexcept {
    const std::array<glm::dmat4, 2> given{texgen, detail::transposed(texgen)};
    for (int allowed = 0; allowed <= most; ++allowed) {
        for (const PoseUse pose : {PoseUse::right, PoseUse::inverted, PoseUse::left_out, PoseUse::doubled}) {
            const std::optional<Product> x = pose_factor(factors, pose);
            if (!x) continue;
            for (const Composition& scale_bias_mistake : scale_bias_mistakes) {
                for (const bool transposed : {false, true}) {
                    Composition composition = scale_bias_mistake;
                    composition.pose = pose;
                    composition.transposed = transposed;
                    const int without_order = mistakes(composition);
                    if (without_order > allowed || without_order + 1 < allowed) continue;
                    const std::array<Product, 4> product{scale_bias_factor(factors, composition),
                                                         lens_factor(factors.projection), pose_factor(factors.view),
                                                         *x};
                    const auto gives = [&](const std::array<std::size_t, 4>& order) {
                        composition.multiple =
                            multiple_of(product[order[0]] * product[order[1]] * (product[order[2]] * product[order[3]]),
                                        given[transposed], closeness, transposed);
                        return composition.multiple != 0.0;
                    };
                    if (without_order == allowed) {
                        if (gives({0, 1, 2, 3})) return composition;
                        continue;
                    }
                    for (const std::array<std::size_t, 4>& order : wrong_orders) {
                        if (!gives(order)) continue;
                        composition.order = order == wrong_orders[0] ? Order::view_before_projection : Order::wrong;
                        return composition;
                    }
                }
            }
        }
    }
    return std::nullopt;
}

// The same for any closeness. What was composed in float is near to the right product and to others as well, where they
// differ by less than its rounding (as depth ranges do far from the origin): the closest decides.
inline std::optional<Composition> composition_of(const glm::dmat4& texgen, const Factors& factors, const Product& right,
                                                 bool is_in_float) noexcept {
    const Closeness closest = is_in_float ? rounded_once : composed_in_double;
    if (multiple_of(right, texgen, closest) > 0.0) return Composition{};
    const bool is_near = multiple_of(right, texgen, composed_in_float) > 0.0;
    const auto composition = composition_of(texgen, factors, is_near ? 1 : 2, closest);
    if (composition) return composition;
    return is_near ? Composition{} : composition_of(texgen, factors, 2, composed_in_float);
}

}  // namespace TEXGEN_DETAIL
