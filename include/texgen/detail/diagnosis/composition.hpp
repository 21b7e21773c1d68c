#pragma once

// Which product of the scale-bias S, the projector's P and V, and the pose X (the model matrix M or the camera's V_e^-1)
// a texgen matrix is: the right one, S P V X, or one that a mistake makes of it.

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
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
                along += given[column][row] / magnitude * value;
                norm += value * value;
            }
        }
        multiple_ = along / norm;
    }

    double within(Closeness closeness) const noexcept {
        for (glm::length_t row = 0; row < 4; ++row) {
            if (is_zero_row(given_, row)) continue;
            for (glm::length_t column = 0; column < 4; ++column) {
                if (says_nothing(column)) continue;
                const double value = product_.value[column][row];
                const double accepted =
                    closeness.of_element * std::fabs(value) + closeness.of_magnitude * product_.magnitude[column][row];
                if (!(std::fabs(given_[column][row] - multiple_ * value) <= std::fabs(multiple_) * accepted))
                    return 0.0;
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

// Numbers that no scene has would cost time (subnormal ones) or products their range: small ones are 0, large ones none.
inline glm::dmat4 as_in_scenes(glm::dmat4 m) noexcept {
    for (glm::length_t column = 0; column < 4; ++column) {
        for (glm::length_t row = 0; row < 4; ++row) {
            double& element = m[column][row];
            if (std::fabs(element) < 0x1p-150) element = 0.0;
            if (std::fabs(element) > 0x1p150) element = std::numeric_limits<double>::quiet_NaN();
        }
    }
    return m;
}

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
    return inverse.regular() ? std::optional(pose_factor(as_in_scenes(inverse.matrix()))) : std::nullopt;
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

// S (0), P (1), V (2) and X (3) from left to right.
using FactorOrder = std::array<std::size_t, 4>;
inline constexpr FactorOrder right_order{0, 1, 2, 3};

// The most likely first: V before P, then the row vectors' order, then the others.
inline constexpr std::array<FactorOrder, 23> wrong_orders{
    {{0, 2, 1, 3}, {3, 2, 1, 0}, {3, 0, 1, 2}, {0, 1, 3, 2}, {1, 0, 2, 3}, {1, 2, 0, 3}, {1, 2, 3, 0}, {0, 3, 1, 2},
     {0, 2, 3, 1}, {0, 3, 2, 1}, {1, 0, 3, 2}, {1, 3, 0, 2}, {1, 3, 2, 0}, {2, 0, 1, 3}, {2, 0, 3, 1}, {2, 1, 0, 3},
     {2, 1, 3, 0}, {2, 3, 0, 1}, {2, 3, 1, 0}, {3, 0, 2, 1}, {3, 1, 0, 2}, {3, 1, 2, 0}, {3, 2, 0, 1}}};

// A row of what stands on the left of a product, or columns of what stands on the right, and the magnitudes of their terms.
struct ProductRow {
    glm::dvec4 value, magnitude;
};
struct ProductColumns {
    std::array<glm::dvec4, 2> value, magnitude;
};

inline ProductRow operator*(const ProductRow& row, const Product& m) noexcept {
    return {row.value * m.value, row.magnitude * m.magnitude};
}
inline ProductColumns operator*(const Product& m, const ProductColumns& c) noexcept {
    return {{m.value * c.value[0], m.value * c.value[1]}, {m.magnitude * c.magnitude[0], m.magnitude * c.magnitude[1]}};
}

// What a matrix makes of two directions, seen along a row: few numbers, which tell products apart that are far from it. A
// row or column that says nothing is not in them, and the others weigh about the same.
class Glance {
public:
    Glance(const glm::dmat4& given, bool was_transposed) noexcept
        : row_{{0.6, -0.9, 0.7, 0.8}, {}}, columns_{{{{0.9, -0.4, 0.7, 0.0}, {-0.5, 0.8, 0.9, 0.0}}}, {}} {
        for (glm::length_t i = 0; i < 4; ++i) {
            double largest = 0x1p-1000;
            for (glm::length_t k = 0; k < 4; ++k) largest = larger(largest, std::fabs(given[k][i]));
            row_.value[i] = is_zero_row(given, i) ? 0.0 : row_.value[i] / largest;
            row_.magnitude[i] = std::fabs(row_.value[i]);
            for (std::size_t k = 0; k < 2; ++k) {
                if (was_transposed && given[i] == glm::dvec4(0.0)) columns_.value[k][i] = 0.0;
                columns_.magnitude[k][i] = std::fabs(columns_.value[k][i]);
            }
        }
        const glm::dvec4 seen = row_.value * given;
        for (std::size_t k = 0; k < 2; ++k) given_[k] = dot(seen, columns_.value[k]);
    }

    const ProductRow& row() const noexcept { return row_; }
    const ProductColumns& columns() const noexcept { return columns_; }

    // Whether a multiple of the product may be what was given, composed in whatever way: two numbers g that are k times p,
    // each within its share of the magnitudes m, differ in g0 p1 - g1 p0 by no more than g0 m1 + g1 m0.
    bool may_give(const ProductRow& left, const ProductColumns& right) const noexcept {
        constexpr double share = 1.01 * composed_in_float.of_magnitude;
        const auto value = [&](std::size_t k) { return dot(left.value, right.value[k]); };
        const auto error = [&](std::size_t k) { return share * dot(left.magnitude, right.magnitude[k]); };
        const double accepted = std::fabs(given_[0]) * error(1) + std::fabs(given_[1]) * error(0) + 0x1p-1000;
        return std::fabs(given_[0] * value(1) - given_[1] * value(0)) <= accepted && is_finite(accepted);
    }

private:
    static double dot(const glm::dvec4& a, const glm::dvec4& b) noexcept {
        return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
    }

    ProductRow row_;
    ProductColumns columns_;
    std::array<double, 2> given_{};
};

// S, P, V and X as a mistake has them.
using FactorsInUse = std::array<const Product*, 4>;

inline Product product_of(const FactorsInUse& factors, const FactorOrder& order) noexcept {
    const auto at = [&](std::size_t i) -> const Product& { return *factors[order[i]]; };
    return at(0) * at(1) * (at(2) * at(3));
}

// Calls gives(order) for the wrong orders that may give the matrix, until one does.
template <class Gives>
bool any_wrong_order(const FactorsInUse& factors, const Glance& glance, const Gives& gives) noexcept {
    std::array<std::array<ProductRow, 4>, 4> left;       // of factors a and b
    std::array<std::array<ProductColumns, 4>, 4> right;  // of factors b and a
    for (std::size_t a = 0; a < 4; ++a) {
        const ProductRow row = glance.row() * *factors[a];
        const ProductColumns columns = *factors[a] * glance.columns();
        for (std::size_t b = 0; b < 4; ++b) {
            if (a == b) continue;
            left[a][b] = row * *factors[b];
            right[b][a] = *factors[b] * columns;
        }
    }
    for (const FactorOrder& order : wrong_orders)
        if (glance.may_give(left[order[0]][order[1]], right[order[2]][order[3]]) && gives(order)) return true;
    return false;
}

// The composition with the fewest mistakes, `most` or fewer, that gives the matrix as closely as `closest`; else
// `in_float`, or if that is empty the first that gives the matrix as closely as float.
inline std::optional<Composition> composition_of(const glm::dmat4& texgen, const Factors& factors, int most,
                                                 Closeness closest, std::optional<Composition> in_float) noexcept {
    const std::array<glm::dmat4, 2> given{texgen, glm::transpose(texgen)};
    const std::array<Glance, 2> glances{Glance(given[0], false), Glance(given[1], true)};
    const Product projection = lens_factor(factors.projection);
    const Product view = pose_factor(factors.view);
    // Each is made where it is used first.
    std::array<std::optional<Product>, scale_bias_mistakes.size()> scale_biases;
    std::array<std::optional<Product>, 4> poses;
    for (int allowed = 0; allowed <= most; ++allowed) {
        for (std::size_t use = 0; use < (allowed == 0 ? 1 : poses.size()); ++use) {
            const PoseUse pose = static_cast<PoseUse>(use);
            if (allowed == (pose != PoseUse::right)) poses[use] = pose_factor(factors, pose);
            if (!poses[use]) continue;
            const auto columns = [&](const Glance& glance) {
                return projection * (view * (*poses[use] * glance.columns()));
            };
            const std::array<ProductColumns, 2> lens{columns(glances[0]), columns(glances[1])};
            for (std::size_t i = 0; i < scale_bias_mistakes.size(); ++i) {
                for (const bool transposed : {false, true}) {
                    Composition composition = scale_bias_mistakes[i];
                    composition.pose = pose;
                    composition.transposed = transposed;
                    const int without_order = mistakes(composition);
                    if (without_order > allowed || without_order + 1 < allowed) continue;
                    if (!scale_biases[i]) scale_biases[i] = scale_bias_factor(factors, composition);
                    const FactorsInUse in_use{&*scale_biases[i], &projection, &view, &*poses[use]};
                    const auto gives = [&](const FactorOrder& order) {
                        const Product product = product_of(in_use, order);
                        if (order == wrong_orders[0])
                            composition.order = Order::view_before_projection;
                        else if (order != right_order)
                            composition.order = Order::wrong;
                        const Multiple multiple(product, given[transposed], transposed);
                        composition.multiple = multiple.within(closest);
                        if (composition.multiple != 0.0) return true;
                        if (in_float) return false;
                        composition.multiple = multiple.within(composed_in_float);
                        if (composition.multiple != 0.0) in_float = composition;
                        return false;
                    };
                    const Glance& glance = glances[transposed];
                    const auto may_give = [&] {
                        return glance.may_give(glance.row() * *scale_biases[i], lens[transposed]);
                    };
                    if (without_order < allowed ? any_wrong_order(in_use, glance, gives)
                                                : may_give() && gives(right_order))
                        return composition;
                }
            }
        }
    }
    return in_float;
}

// The same for any closeness. What was composed in float is near to the right product and to others as well, where they
// differ by less than its rounding (as depth ranges do far from the origin): the closest decides.
inline std::optional<Composition> composition_of(const glm::dmat4& texgen, const Factors& factors, const Product& right,
                                                 bool is_in_float) noexcept {
    const Closeness closest = is_in_float ? rounded_once : composed_in_double;
    const Multiple multiple(right, texgen);
    if (multiple.within(closest) > 0.0) return Composition{};
    const bool is_near = multiple.within(composed_in_float) > 0.0;
    const auto pose = factors.pose ? std::optional(as_in_scenes(*factors.pose)) : std::nullopt;
    return composition_of(
        as_in_scenes(texgen),
        {as_in_scenes(factors.scale_bias), as_in_scenes(factors.projection), as_in_scenes(factors.view), pose},
        is_near ? 1 : 2, closest, is_near ? std::optional(Composition{}) : std::nullopt);
}

}  // namespace TEXGEN_DETAIL
