#pragma once

// What is exactly true of a box and a slide, and what is wrong with an answer.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "judges/exact.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/conventions.hpp"
#include "texgen/primitives.hpp"

namespace coverage_cases {

using support::Dyadic;
using support::infinity_float;
using texgen::Box;
using texgen::Coverage;
using texgen::Sphere;
using texgen::TextureRegion;

inline constexpr double infinite = std::numeric_limits<double>::infinity();

// How many bodies a test takes, unless the environment says otherwise.
inline long count_of(const char* name, long usual) {
    const char* text = std::getenv(name);
    return text != nullptr ? std::atol(text) : usual;
}

// c[0] x + c[1] y + c[2] z + c[3] >= 0, or > 0.
struct Inequality {
    std::array<Dyadic, 4> c;
    bool is_strict;
    std::array<double, 4> near_to_c = {};  // within a few ulp, of those that are asked often
};

// Whether a point fulfils all of them: Fourier and Motzkin's elimination, which is exact, and for the last variable its
// greatest lower bound against its least upper one.
inline bool have_a_solution(std::vector<Inequality> all) {
    for (std::size_t variable = 0; variable < 2; ++variable) {
        std::vector<Inequality> rest, lower, upper;
        for (const Inequality& one : all) {
            const int sign = one.c[variable].sign();
            (sign == 0 ? rest : sign > 0 ? lower : upper).push_back(one);
        }
        for (const Inequality& low : lower) {
            for (const Inequality& high : upper) {
                Inequality sum{{}, low.is_strict || high.is_strict, {}};
                for (std::size_t k = variable + 1; k < 4; ++k)
                    sum.c[k] = high.c[k] * low.c[variable] - low.c[k] * high.c[variable];
                rest.push_back(sum);
            }
        }
        all = rest;
    }
    const Inequality *low = nullptr, *high = nullptr;  // z >= -low.c[3] / low.c[2], z <= high.c[3] / -high.c[2]
    for (const Inequality& one : all) {
        const int sign = one.c[2].sign();
        if (sign == 0) {
            if (one.c[3].sign() < (one.is_strict ? 1 : 0)) return false;
            continue;
        }
        const Inequality*& bound = sign > 0 ? low : high;
        if (bound == nullptr) {
            bound = &one;
            continue;
        }
        const int order =
            (one.c[3] * support::magnitude(bound->c[2]) - bound->c[3] * support::magnitude(one.c[2])).sign();
        if (order < 0 || (order == 0 && one.is_strict)) bound = &one;
    }
    if (low == nullptr || high == nullptr) return true;
    const int gap = (high->c[3] * low->c[2] - low->c[3] * high->c[2]).sign();
    return gap > 0 || (gap == 0 && !low->is_strict && !high->is_strict);
}

// A region of real numbers about those that are inside the given one, or may be rounded into it; and one in those that
// are rounded into it. Subnormal numbers may count as 0.
struct Rounded {
    double outer, inner;

    static Rounded of_min(double min) {
        if (!std::isfinite(min)) return {min, min};
        float first = support::to_float(min);
        while (static_cast<double>(first) < min) first = std::nextafter(first, infinity_float);
        if (std::fabs(min) < 0x1p-126) return {-0x1p-126, first > 0.0f ? 0x1p-126 : static_cast<double>(first)};
        return {static_cast<double>(std::nextafter(first, -infinity_float)), static_cast<double>(first)};
    }
    static Rounded of_max(double max) {
        const Rounded mirrored = of_min(-max);
        return {-mirrored.outer, -mirrored.inner};
    }
};

// The coordinates that a region limits, rows of the matrix, and the limits of each: s, t, and r where it has a depth.
inline int limited(const TextureRegion& region) { return region.depth() ? 3 : 2; }
inline glm::dvec2 limits(const TextureRegion& region, int k) {
    return k == 2 ? *region.depth() : glm::dvec2(region.min()[k], region.max()[k]);
}

// The truth: of what is outside, of the outer region; of what is inside, of the inner one. An infinite side is none.
class Judge {
public:
    Judge(const glm::dmat4& matrix, const TextureRegion& region) {
        const auto row = [&](int k) {
            std::array<Dyadic, 4> c;
            for (int j = 0; j < 4; ++j) c[static_cast<std::size_t>(j)] = Dyadic(matrix[j][k]);
            return c;
        };
        const std::array<Dyadic, 4> q = row(3);
        const auto form = [&](const std::array<Dyadic, 4>& coordinate, double side, double sign) {
            Inequality one{{}, false, {}};
            for (std::size_t j = 0; j < 4; ++j) one.c[j] = Dyadic(sign) * (coordinate[j] - Dyadic(side) * q[j]);
            return one;
        };
        for (int k = 0; k < 2 * limited(region); ++k) {
            const double sign = k % 2 == 0 ? 1.0 : -1.0;
            const glm::dvec2 given = limits(region, k / 2);
            const auto [outer, inner] = k % 2 == 0 ? Rounded::of_min(given.x) : Rounded::of_max(given.y);
            if (!std::isinf(outer)) forms_.push_back(form(row(k / 2), outer, sign));
            if (!std::isinf(inner)) inner_forms_.push_back(form(row(k / 2), inner, sign));
            no_float_is_inside_ = no_float_is_inside_ || inner == sign * infinite;
        }
        forms_.push_back({q, true, {}});
        inner_forms_.push_back({q, true, {}});
        for (std::vector<Inequality>* const forms : {&forms_, &inner_forms_})
            for (Inequality& one : *forms)
                for (std::size_t j = 0; j < 4; ++j) one.near_to_c[j] = one.c[j].estimate();
    }

    const std::vector<Inequality>& forms() const { return forms_; }
    const std::vector<Inequality>& inner_forms() const { return inner_forms_; }
    bool no_float_is_inside() const { return no_float_is_inside_; }

    // The sign of a form where it is largest over the box (or least).
    static int extreme_sign(const Inequality& form, const Box& box, bool largest) {
        std::array<double, 3> vertex{};
        double nearly = form.near_to_c[3], size = std::fabs(nearly);
        for (int j = 0; j < 3; ++j) {
            const auto i = static_cast<std::size_t>(j);
            const int sign = form.c[i].sign();
            if (sign == 0) continue;
            vertex[i] = static_cast<double>((sign > 0) == largest ? box.max[j] : box.min[j]);
            if (std::isinf(vertex[i])) return largest ? 1 : -1;
            nearly += form.near_to_c[i] * vertex[i];
            size += std::fabs(form.near_to_c[i] * vertex[i]);
        }
        // A dozen roundings, each below 2^-50 of what it is of.
        if (std::fabs(nearly) > 0x1p-45 * size + 0x1p-900 && size < 0x1p900) return nearly > 0.0 ? 1 : -1;
        Dyadic value = form.c[3];
        for (std::size_t j = 0; j < 3; ++j)
            if (form.c[j].sign() != 0) value = value + form.c[j] * Dyadic(vertex[j]);
        return value.sign();
    }

    bool is_outside_a_plane(const Box& box) const {
        return std::ranges::any_of(
            forms_, [&](const Inequality& form) { return extreme_sign(form, box, true) < (form.is_strict ? 1 : 0); });
    }
    bool is_inside(const Box& box) const {
        return !no_float_is_inside_ && std::ranges::all_of(inner_forms_, [&](const Inequality& form) {
            return extreme_sign(form, box, false) >= (form.is_strict ? 1 : 0);
        });
    }
    // Whether it touches one of the inner planes: those of the region as it is given, where its sides are floats.
    bool touches(const Box& box) const {
        return std::ranges::any_of(inner_forms_, [&](const Inequality& form) {
            return extreme_sign(form, box, true) == 0 || extreme_sign(form, box, false) == 0;
        });
    }
    bool is_outside(const Box& box) const {
        std::vector<Inequality> all = forms_;
        for (int j = 0; j < 3; ++j) {
            Inequality low{{}, false, {}}, high{{}, false, {}};
            low.c[static_cast<std::size_t>(j)] = Dyadic(1.0);
            high.c[static_cast<std::size_t>(j)] = Dyadic(-1.0);
            if (!std::isinf(box.min[j])) {
                low.c[3] = -Dyadic(box.min[j]);
                all.push_back(low);
            }
            if (!std::isinf(box.max[j])) {
                high.c[3] = Dyadic(box.max[j]);
                all.push_back(high);
            }
        }
        return !have_a_solution(all);
    }

private:
    std::vector<Inequality> forms_, inner_forms_;  // q is the last
    bool no_float_is_inside_ = false;
};

inline bool has_nan(const Box& box) {
    for (int j = 0; j < 3; ++j)
        if (std::isnan(box.min[j]) || std::isnan(box.max[j])) return true;
    return false;
}
inline bool is_empty(const Box& box) { return box.min.x > box.max.x || box.min.y > box.max.y || box.min.z > box.max.z; }
inline bool has_no_number(const Box& box) {
    for (int j = 0; j < 3; ++j)
        if (box.min[j] == infinity_float || box.max[j] == -infinity_float) return true;
    return false;
}

// Whether the library promises exact decisions at the planes.
inline bool has_moderate_exponents(const glm::dmat4& matrix, const TextureRegion& region) {
    double largest = 0.0, least = infinite;
    for (int j = 0; j < 4; ++j) {
        for (const int k : {0, 1, 2, 3}) {
            if (k == 2 && !region.depth()) continue;
            const double size = std::fabs(matrix[j][k]);
            largest = std::max(largest, size);
            if (size > 0.0) least = std::min(least, size);
        }
    }
    for (int k = 0; k < 2 * limited(region); ++k) {
        const double size = std::fabs(limits(region, k / 2)[k % 2]);
        if (size > 0.0 && size < infinite && !(size >= 0x1p-200 && size <= 0x1p200)) return false;
    }
    return largest == 0.0 || least / largest > 0x1p-598;
}

struct Counts {
    long outside = 0, partial = 0, inside = 0, separated = 0, touching = 0, false_partial = 0;
};

// Empty where the answer is what the contract says. `look_for_false_partials` asks of each `partial` whether it is one.
inline std::string what_is_wrong(Coverage answer, const Judge& judge, bool is_exact, const Box& box, Counts& counts,
                                 bool look_for_false_partials = false) {
    if (has_nan(box)) return answer == Coverage::partial ? "" : "a NaN, and not partial";
    if (is_empty(box)) return answer == Coverage::outside ? "" : "empty, and not outside";
    if (has_no_number(box)) return answer == Coverage::inside ? "no point of it is lit, and it is inside" : "";
    const bool outside_a_plane = judge.is_outside_a_plane(box);
    const bool inside = !outside_a_plane && judge.is_inside(box);
    counts.touching += judge.touches(box);
    switch (answer) {
        case Coverage::outside:
            ++counts.outside;
            if (outside_a_plane) return "";
            ++counts.separated;
            return judge.is_outside(box) ? "" : "a false outside";
        case Coverage::inside:
            ++counts.inside;
            return inside ? "" : "a false inside";
        case Coverage::partial:
            ++counts.partial;
            if (is_exact && outside_a_plane) return "outside a plane, and not outside";
            if (is_exact && inside) return "inside all planes, and not inside";
            if (look_for_false_partials && judge.is_outside(box)) ++counts.false_partial;
            return "";
    }
    return "no answer at all";
}

}  // namespace coverage_cases
