#pragma once

// What is wrong with the coordinates of a method, against the reference in long double.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <texgen/conventions.hpp>
#include <texgen/primitives.hpp>
#include <texgen/reference.hpp>

#include "../../error.hpp"
#include "../compare.hpp"
#include "../rasterizer.hpp"

namespace report::checks {

inline constexpr double accepted_texels = 1.0 / 512;

struct Exact {
    double s, t, r;
    bool in_front, lit, lit_at_any_depth, near_border, on_slide;
};

inline bool is_within(double value, double min, double max) { return value >= min && value <= max; }

inline Exact exact_at(const texgen::Triangle& triangle, const texgen::TextureRegion& region, int x, int y) {
    const auto strq = texgen::reference::strq<long double>(triangle, x + 0.5L, y + 0.5L);
    if (!(strq[3] > 0)) return {};
    const auto quotient = texgen::reference::quotient<long double>(strq);
    const auto s = static_cast<double>(quotient[0]);
    const auto t = static_cast<double>(quotient[1]);
    const auto r = static_cast<double>(quotient[2]);
    const glm::dvec2& min = region.min();
    const glm::dvec2& max = region.max();
    constexpr double any = std::numeric_limits<double>::max();
    const glm::dvec2 depth = region.depth().value_or(glm::dvec2(-any, any));
    // lit is decided from the computed coordinates: within their error of the border both answers are right.
    const auto is_near = [](double value, double border) {
        constexpr double ulp = std::numeric_limits<float>::epsilon();
        return std::fabs(value - border) <= std::max(accepted_texels / texture_size, ulp * std::fabs(border));
    };
    const bool is_inside = is_within(s, min.x, max.x) && is_within(t, min.y, max.y);
    return {.s = s,
            .t = t,
            .r = r,
            .in_front = true,
            .lit = is_inside && is_within(r, depth.x, depth.y),
            .lit_at_any_depth = is_inside,
            .near_border = is_near(s, min.x) || is_near(s, max.x) || is_near(t, min.y) || is_near(t, max.y) ||
                           is_near(r, depth.x) || is_near(r, depth.y),
            .on_slide = is_within(s, 0, 1) && is_within(t, 0, 1)};
}

inline bool is_one_signed(const texgen::Triangle& triangle) {
    return triangle.a.strq.w > 0.0f && triangle.b.strq.w > 0.0f && triangle.c.strq.w > 0.0f;
}

// The errors of one method, fragment by fragment.
class Collector {
public:
    explicit Collector(bool knows_depth) : knows_depth_(knows_depth) {}

    void add(const Exact& exact, float s, float t, bool lit, const Witness& at) {
        const bool should_be_lit = knows_depth_ ? exact.lit : exact.lit_at_any_depth;
        if (lit != should_be_lit && !exact.near_border) ++errors_.wrong_decisions;
        if (!exact.on_slide || (knows_depth_ && !exact.lit)) return;
        const auto texels =
            static_cast<float>(texture_size * std::max(finite(std::fabs(s - exact.s)), finite(std::fabs(t - exact.t))));
        if (texels > errors_.max_texels) {
            errors_.max_texels = texels;
            errors_.worst = at;
        }
        texels_.push_back(texels);
        for (const auto& [computed, wanted] : {std::pair{s, exact.s}, std::pair{t, exact.t}})
            if (wanted >= 1.0 / texture_size)
                ulp_.push_back(static_cast<float>(finite(in_ulp(computed - wanted, wanted))));
    }

    Errors finish() {
        errors_.nearly_max_texels = percentile(texels_);
        errors_.nearly_max_ulp = percentile(ulp_);
        errors_.max_ulp = ulp_.empty() ? 0.0 : *std::ranges::max_element(ulp_);
        return errors_;
    }

private:
    static double percentile(std::vector<float>& errors) {
        if (errors.empty()) return 0.0;
        const std::size_t rank = errors.size() - 1 - errors.size() / 1000;
        std::ranges::nth_element(errors, errors.begin() + static_cast<std::ptrdiff_t>(rank));
        return errors[rank];
    }

    bool knows_depth_;
    Errors errors_;
    std::vector<float> texels_, ulp_;
};

struct RectCheck {
    texgen::FragmentRect rect;
    const std::array<RowSpan, Workload::rect_height>& coverage;

    // visit(index in the rect, x, y) for each covered fragment.
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (int row = 0; row < rect.height; ++row) {
            const auto [begin, end] = coverage[static_cast<std::size_t>(row)];
            for (int column = begin; column < end; ++column)
                visit(static_cast<std::size_t>(row * rect.width + column), rect.x + column, rect.y + row);
        }
    }
};

// The library's own promise covers more than the slide: every fragment in front of the projector whose coordinates it
// has written.
inline void check_promise(Comparison& comparison, const texgen::Triangle& triangle, const RectCheck& check,
                          std::span<const Exact> exact, const RectCoordinates& coordinates) {
    check.for_each([&](std::size_t i, int x, int y) {
        if (!exact[i].in_front) return;
        for (const auto& [computed, wanted] :
             {std::pair{coordinates.s[i], exact[i].s}, std::pair{coordinates.t[i], exact[i].t},
              std::pair{coordinates.r[i], exact[i].r}}) {
            if (std::fabs(wanted) < std::numeric_limits<float>::min()) continue;
            const double ulp = in_ulp(computed - wanted, wanted);
            if (ulp <= comparison.largest_ulp) continue;
            comparison.largest_ulp = ulp;
            comparison.largest_ulp_at = {triangle, x, y};
        }
    });
}

}  // namespace report::checks
