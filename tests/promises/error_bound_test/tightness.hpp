#pragma once

// How tight bounds are, and the tolerances that they are asked for.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/conventions.hpp"

namespace error_bound_cases {

using support::infinity_double;
using support::Random;
using texgen::Tolerance;

inline bool is_no_bound(double bound) { return !(bound < infinity_double); }

// How many times a bound is the error that was seen; errors of 0 say nothing of it.
class Tightness {
public:
    void add(double bound, double error) {
        if (error > 0.0 && bound < infinity_double) ratios_.push_back(bound / error);
    }
    std::size_t size() const { return ratios_.size(); }
    double median() {
        REQUIRE(!ratios_.empty());
        const auto middle = ratios_.begin() + static_cast<std::ptrdiff_t>(ratios_.size() / 2);
        std::nth_element(ratios_.begin(), middle, ratios_.end());
        return *middle;
    }

private:
    std::vector<double> ratios_;
};

// exact, or of the size that float arithmetic reaches, or any.
inline Tolerance any_tolerance(Random& random) {
    switch (random.integer(0, 3)) {
        case 0:
            return texgen::exact;
        case 1:
            return {random.power_of_ten(-8.0, -5.0)};
        case 2:
            return {random.power_of_ten(-5.0, 0.0)};
        default:
            return {random.power_of_ten(-30.0, 30.0)};
    }
}

}  // namespace error_bound_cases
