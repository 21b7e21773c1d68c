#pragma once

// Errors as ceilings hold them: in ulps, and as shares of what is allowed.

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "judges/exact.hpp"
#include "support/outputs.hpp"
#include "texgen/conventions.hpp"

namespace ceilings {

using support::Homogeneous;
using support::Outputs;
using support::Quotient;
using texgen::Tolerance;

// Half an ulp is a half, whatever the binade of the result.
inline double error_in_ulps(float value, const Quotient& u) {
    if (!std::isfinite(value)) return 0.0;
    const double middle = support::detail::middle(value, compare(u, static_cast<double>(value)) > 0);
    return 0.5 * distance(static_cast<double>(value), u) / std::fabs(middle - static_cast<double>(value));
}

// The error beyond that of the nearest float, which is always allowed, as a share of the tolerance.
inline double share_of(Tolerance tolerance, float value, const Quotient& u) {
    return is_nearest(value, u, false) ? 0.0 : distance(static_cast<double>(value), u) / tolerance.value;
}

struct Worst {
    double exact = 0.0, share = 0.0, bound = 0.0;
};

inline void take(Worst& worst, const Homogeneous& at, const Outputs& exact, const Outputs& within, Tolerance tolerance,
                 std::size_t i) {
    if (at.q.sign() <= 0) return;
    for (std::size_t k = 0; k < 2; ++k) {
        worst.exact = std::max(worst.exact, error_in_ulps(exact[k][i], at.over_q(k)));
        worst.share = std::max(worst.share, share_of(tolerance, within[k][i], at.over_q(k)));
    }
}

inline constexpr Tolerance tolerance_of(double unit) { return {unit * 0x1p-18}; }

}  // namespace ceilings
