#pragma once

// Which product of its factors a texgen matrix is: the right one, S P V X, or one that a mistake makes of it.

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <glm/mat2x4.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "../arithmetic/inverse.hpp"
#include "matrix_signs.hpp"
#include "products.hpp"

namespace TEXGEN_DETAIL {

// Mistakes with S. Mirroring and the other depth range are looked for only where S stands once: neither left out nor
// doubled.
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

// The order of the factors from left to right: 0 is S, 1 is P, 2 is V and 3 is X.
using FactorOrder = std::array<std::size_t, 4>;
inline constexpr FactorOrder right_order{0, 1, 2, 3};

// The most likely first: V before P, then the row vectors' order, then the others.
inline constexpr std::array<FactorOrder, 23> wrong_orders{
    {{0, 2, 1, 3}, {3, 2, 1, 0}, {3, 0, 1, 2}, {0, 1, 3, 2}, {1, 0, 2, 3}, {1, 2, 0, 3}, {1, 2, 3, 0}, {0, 3, 1, 2},
     {0, 2, 3, 1}, {0, 3, 2, 1}, {1, 0, 3, 2}, {1, 3, 0, 2}, {1, 3, 2, 0}, {2, 0, 1, 3}, {2, 0, 3, 1}, {2, 1, 0, 3},
     {2, 1, 3, 0}, {2, 3, 0, 1}, {2, 3, 1, 0}, {3, 0, 2, 1}, {3, 1, 0, 2}, {3, 1, 2, 0}, {3, 2, 0, 1}}};

// A row of the left part of a product, and two columns of the right part.
using ProductRow = ProductOf<glm::dvec4>;
using ProductColumns = ProductOf<glm::dmat2x4>;

// A first look at a matrix, which tells it from products that are far from it: a row times it times two columns makes
// two numbers. Rows and columns of it that say nothing have no part in them; the others weigh about the same.
class Glance {
public:
    Glance(const glm::dmat4& given, bool was_transposed) noexcept
        : row_{{0.6, -0.9, 0.7, 0.8}, {}}, columns_{{0.9, -0.4, 0.7, 0.0, -0.5, 0.8, 0.9, 0.0}, {}} {
        for (glm::length_t i = 0; i < 4; ++i) {
            double largest = 0x1p-1000;
            for (glm::length_t k = 0; k < 4; ++k) largest = larger(largest, std::fabs(given[k][i]));
            row_.value[i] = is_zero_row(given, i) ? 0.0 : row_.value[i] / largest;
            row_.magnitude[i] = std::fabs(row_.value[i]);
            for (glm::length_t k = 0; k < 2; ++k) {
                if (was_transposed && given[i] == glm::dvec4(0.0)) columns_.value[k][i] = 0.0;
                columns_.magnitude[k][i] = std::fabs(columns_.value[k][i]);
            }
        }
        given_ = row_.value * given * columns_.value;
    }

    const ProductRow& row() const noexcept { return row_; }
    const ProductColumns& columns() const noexcept { return columns_; }

    // Whether a multiple of the product may be the given matrix, composed in whatever way. Where two given numbers g
    // are k times p, but for each p's share of its magnitude m, g0 p1 and g1 p0 differ by g0 m1 + g1 m0 at most.
    bool may_give(const ProductRow& left, const ProductColumns& right) const noexcept {
        constexpr double share = 1.01 * composed_in_float.of_magnitude;
        const auto [value, magnitude] = left * right;
        const glm::dvec2 error = share * magnitude;
        const double accepted = std::fabs(given_.x) * error.y + std::fabs(given_.y) * error.x + 0x1p-1000;
        return std::fabs(given_.x * value.y - given_.y * value.x) <= accepted && is_finite(accepted);
    }

private:
    ProductRow row_;
    ProductColumns columns_;
    glm::dvec2 given_{0.0};
};

// The factors S, P, V and X as a mistake uses them.
using FactorsInUse = std::array<const Product*, 4>;

inline Product product_of(const FactorsInUse& factors, const FactorOrder& order) noexcept {
    const auto at = [&](std::size_t i) -> const Product& { return *factors[order[i]]; };
    return at(0) * at(1) * (at(2) * at(3));
}

// Calls gives(order) for the wrong orders that may give the matrix, until one does.
bool any_wrong_order(const FactorsInUse& factors, const Glance& glance, const auto& gives) noexcept {
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
// `in_float`, or if that is empty the first that gives the matrix as closely as products in float do.
inline std::optional<Composition> composition_of(const glm::dmat4& texgen, const Factors& factors, int most,
                                                 const Closeness& closest,
                                                 std::optional<Composition> in_float) noexcept {
    const std::array<glm::dmat4, 2> given{texgen, glm::transpose(texgen)};
    const std::array<Glance, 2> glances{Glance(given[0], false), Glance(given[1], true)};
    const Product projection = lens_factor(factors.projection);
    const Product view = pose_factor(factors.view);
    const bool is_near = in_float.has_value();
    // Each of these is made where it is first used.
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
            // Far from the origin a wrong order may come as near in float as the right one: that is likelier.
            for (const bool in_order : {true, false}) {
                for (std::size_t i = 0; i < scale_bias_mistakes.size(); ++i) {
                    // Next to the right product rounding may look like the other range: is_of_other_range() decides.
                    if (is_near && scale_bias_mistakes[i].other_depth) continue;
                    for (const bool transposed : {false, true}) {
                        Composition composition = scale_bias_mistakes[i];
                        composition.pose = pose;
                        composition.transposed = transposed;
                        if (mistakes(composition) != (in_order ? allowed : allowed - 1)) continue;
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
                        if (in_order ? may_give() && gives(right_order) : any_wrong_order(in_use, glance, gives))
                            return composition;
                    }
                }
            }
        }
    }
    return in_float;
}

// The same, with the closeness that the matrix asks for. One that was composed in float is near to the right product
// and to others as well, where these differ by less than its rounding (as depth ranges do far from the origin). The
// closest decides, unless the right one is as near as products of the factors are in their precision: there another may
// be nearer by chance, where factors commute or cancel.
inline std::optional<Composition> composition_of(const glm::dmat4& texgen, const Factors& factors, const Product& right,
                                                 bool is_in_float) noexcept {
    const Closeness closest = is_in_float ? rounded_once : composed_in_double;
    const Multiple multiple(right, texgen);
    if (multiple.within(closest) > 0.0) return Composition{};
    if (is_of_other_range(texgen, factors.scale_bias, right)) return Composition{.other_depth = true};
    if (multiple.within(is_in_float ? products_in_float : products_in_double) > 0.0) return Composition{};
    const bool is_near = multiple.within(composed_in_float) > 0.0;
    for (const bool transposed : {false, true})
        if (!is_near && is_bias_without_w(transposed ? glm::transpose(texgen) : texgen, factors))
            return Composition{.transposed = transposed, .scale_bias = ScaleBiasUse::without_w};
    return composition_of(as_in_scenes(texgen), as_in_scenes(factors), is_near ? 1 : 2, closest,
                          is_near ? std::optional(Composition{}) : std::nullopt);
}

}  // namespace TEXGEN_DETAIL
