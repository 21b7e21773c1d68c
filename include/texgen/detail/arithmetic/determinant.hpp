#pragma once

// Determinants whose terms may cancel to the last bit. They are computed in double, or in two, where a bound decides,
// and else as exact sums.

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "../language.hpp"
#include "expansion.hpp"
#include "rounding.hpp"

namespace TEXGEN_DETAIL {

// Returns a number x to a relative error of 2^-51, so that its sign and its zeros are exact. `close` is within `error`
// of x; where that is not enough exact() is asked.
double settled(const DoubleDouble& close, double error, const auto& exact) noexcept {
    return error <= 0x1p-54 * magnitude(close.high) ? close.high : exact().estimate();
}

// The determinant of three rows of floats. The product of two floats is exact in double, and that of three stays in its
// range. A determinant that is not finite has the sign 0 and the value NaN.
class FloatDeterminant {
public:
    FloatDeterminant(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) noexcept : row_{a, b, c} {}

    int sign() const noexcept {
        const auto [sum, size] = nearly();
        if (magnitude(sum) > gamma(4) * size) return sign_of(sum);
        return size < 0x1p1000 ? exactly().sign() : 0;
    }

    // To a relative error of 2^-51: the three products and the two sums are each within 2^-103 of their terms.
    double value() const noexcept {
        const double size = this->size();
        if (!(size < 0x1p1000)) return nan;
        const auto terms = [&](int i, int j, int k) { return product(exact_minor(i, j), {row_[k].z, 0.0}); };
        return settled(sum(sum(terms(1, 2, 0), terms(2, 0, 1)), terms(0, 1, 2)), 0x1p-100 * size,
                       [&] { return exactly(); });
    }

    // The determinant in double, within gamma(4) size. The size is the sum of the magnitudes of its terms.
    struct Nearly {
        double value, size;
    };
    Nearly nearly() const noexcept {
        return {minor_of(1, 2) * row_[0].z + minor_of(2, 0) * row_[1].z + minor_of(0, 1) * row_[2].z, size()};
    }

    Expansion<12> exactly() const noexcept {
        Expansion<12> sum;
        for (int k = 0; k < 3; ++k) {
            const DoubleDouble minor = exact_minor((k + 1) % 3, (k + 2) % 3);
            sum.add_product(minor.low, row_[k].z);
            sum.add_product(minor.high, row_[k].z);
        }
        return sum;
    }

private:
    double minor_of(int i, int j) const noexcept { return row_[i].x * row_[j].y - row_[j].x * row_[i].y; }
    DoubleDouble exact_minor(int i, int j) const noexcept {
        return two_sum(row_[i].x * row_[j].y, -row_[j].x * row_[i].y);
    }

    double size() const noexcept {
        const auto terms = [&](int i, int j, int k) {
            return (magnitude(row_[i].x * row_[j].y) + magnitude(row_[j].x * row_[i].y)) * magnitude(row_[k].z);
        };
        return terms(1, 2, 0) + terms(2, 0, 1) + terms(0, 1, 2);
    }

    glm::dvec3 row_[3];
};

// Twice the signed area of a triangle, positive where a, b, c run counter-clockwise, to a relative error of 2^-51.
// Precondition: each coordinate is 0, or its magnitude is from 2^-400 to 2^400.
inline double twice_area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) noexcept {
    const auto product_of = [](double x, double x_from, double y, double y_from) {
        return product(two_sum(x, -x_from), two_sum(y, -y_from));
    };
    const DoubleDouble left = product_of(b.x, a.x, c.y, a.y), right = product_of(c.x, a.x, b.y, a.y);
    return settled(sum(left, -right), 0x1p-100 * (magnitude(left.high) + magnitude(right.high)), [&] {
        Expansion<12> sum;
        const auto add = [&sum](const glm::dvec2& from, const glm::dvec2& to) {
            sum.add_product(from.x, to.y);
            sum.add_product(-to.x, from.y);
        };
        add(a, b);
        add(b, c);
        add(c, a);
        return sum;
    });
}

}  // namespace TEXGEN_DETAIL
