#pragma once

// What Eigen asks of a number that its matrices hold.

#include <Eigen/Core>

#include "judges/numbers.hpp"

template <>
struct Eigen::NumTraits<support::Rational> : Eigen::GenericNumTraits<support::Rational> {
    using Real = support::Rational;
    using NonInteger = support::Rational;
    using Literal = support::Rational;
    using Nested = support::Rational;
    enum {
        IsComplex = 0,
        IsInteger = 0,
        IsSigned = 1,
        RequireInitialization = 1,
        ReadCost = 1,
        AddCost = 8,
        MulCost = 8
    };
    static Real epsilon() { return 0; }
    static Real dummy_precision() { return 0; }
    static int digits() { return 0; }  // none: what has no epsilon has no last digit, of which Eigen 5 asks
    static int digits10() { return 0; }
    static int max_digits10() { return 0; }
};
