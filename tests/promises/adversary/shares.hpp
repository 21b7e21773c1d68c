#pragma once

// What a promise is, and how near an input comes to breaking it.

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "judges/exact.hpp"
#include "promises/adversary/inputs.hpp"
#include "support/random.hpp"

namespace adversary {

using support::Dyadic;
using support::Homogeneous;
using support::Quotient;

inline constexpr double broken = HUGE_VAL;

// The share of its bound that an error takes, or of 300 bits by which a decision was near to the other answer: above 1
// the promise is broken. Below 0: the input says nothing.
using Share = double;
inline constexpr Share says_nothing = -1.0;

struct Promise {
    const char* name;
    std::size_t floats;
    Numbers (*begin)(Random&);
    Share (*share)(const Numbers&);
};

// A decision: the smaller the distance from the other answer, relative to its terms, the nearer; on the border itself
// there is only one answer.
inline Share share_of_decision(double distance) {
    return distance > 0.0 ? std::clamp(-std::log2(distance) / 300.0, 0.0, 1.0) : 0.0;
}

// An error below nothing: some of the way to the bound, so that there is something to climb.
inline Share share_of_error(double share) { return share > 0.0 ? share : 1e-3 / (1.0 - share); }

// The nearest float: a decision at the middle of two floats.
inline Share share_of_rounding(float value, const Quotient& u) {
    if (!is_nearest(value, u)) return broken;
    if (!std::isfinite(value)) return says_nothing;
    const double middle = support::detail::middle(value, compare(u, static_cast<double>(value)) > 0);
    return share_of_decision(distance(middle, u) / std::fabs(middle - static_cast<double>(value)));
}

// |error| <= max(tolerance, 1/2 ulp).
inline Share share_of_tolerance(float value, const Quotient& u, double tolerance) {
    if (!is_within(value, u, tolerance)) return broken;
    return is_nearest(value, u, false) ? 0.0 : distance(static_cast<double>(value), u) / tolerance;
}

// |value - n/d| <= bound. Where the bound is not finite, or there is no value, nothing is said.
inline Share share_of_bound(double value, const Quotient& u, double bound) {
    if (!std::isfinite(bound) || !std::isfinite(value)) return says_nothing;
    if (!(magnitude(Dyadic(value) * u.d - u.n) <= Dyadic(bound) * u.d)) return broken;
    return bound > 0.0 ? distance(value, u) / bound : 0.0;
}

// How far a coordinate is from the inside of [0, 1], or from its outside, relative to its terms.
inline double distance_to_region(const Homogeneous& at) {
    double distance = HUGE_VAL;
    const double q = at.q.estimate();
    for (const Dyadic& u : {at.s, at.t}) {
        const double terms = std::fabs(u.estimate()) + std::fabs(q);
        distance = std::min({distance, std::fabs(u.estimate()) / terms, std::fabs((u - at.q).estimate()) / terms});
    }
    return distance;
}

}  // namespace adversary
