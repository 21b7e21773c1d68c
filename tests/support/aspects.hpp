// How far lenses and regions of another aspect are from what they should be.

#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "judges/oracle.hpp"
#include "judges/real.hpp"
#include "support/random.hpp"
#include "texgen/projector.hpp"

namespace support {

inline double largest_of(std::initializer_list<double> sides) {
    double largest = 0.0;
    for (const double side : sides) largest = std::max(largest, std::fabs(side));
    return largest;
}

// Where the widths are one: tan(fovy'/2) aspect = tan(fovy/2) of the lens's aspect. In ulps.
inline double narrowed_angle_error(const texgen::PerspectiveLens& lens, const texgen::PerspectiveLens& contained) {
    const Real tangent = tan(Real(Real(lens.fovy.in_radians()) / 2)) * Real(lens.aspect) / Real(contained.aspect);
    return error_in_ulps(contained.fovy.in_radians(), 2 * atan(tangent));
}

// [low, high] at that fraction about its middle, exactly, against what was computed; in units of 2^-53 of the largest
// side.
inline double narrowing_error(double low, double high, const Rational& fraction, double new_low, double new_high,
                              double unit) {
    const Rational middle = (exactly(low) + exactly(high)) / 2, half = fraction * (exactly(high) - exactly(low)) / 2;
    const double error =
        std::max(absolute_error(new_low, Rational(middle - half)), absolute_error(new_high, Rational(middle + half)));
    return error / (0x1p-53 * unit);
}

// What a rectangle's aspect leaves of a picture's width and height, or the picture's of the rectangle's.
struct Narrowing {
    Rational across = 1, upwards = 1;

    template <class RectangularLens>
    Narrowing(const RectangularLens& lens, double aspect) {
        const Rational width = magnitude(exactly(lens.right) - exactly(lens.left));
        const Rational height = magnitude(exactly(lens.top) - exactly(lens.bottom));
        (exactly(aspect) * height > width ? upwards : across) = exactly(aspect) * height > width
                                                                    ? Rational(width / (exactly(aspect) * height))
                                                                    : Rational(exactly(aspect) * height / width);
    }

    bool is_wider() const { return across == 1; }

    // Of the lens that contains the picture, and of the picture's crop that covers the lens.
    template <class RectangularLens>
    double measured_contain_error(const RectangularLens& lens, const RectangularLens& contained) const {
        const double unit = largest_of({lens.left, lens.right, lens.bottom, lens.top});
        return std::max(narrowing_error(lens.left, lens.right, across, contained.left, contained.right, unit),
                        narrowing_error(lens.bottom, lens.top, upwards, contained.bottom, contained.top, unit));
    }
    double measured_cover_error(const texgen::TextureRegion& picture, const texgen::TextureRegion& crop) const {
        const glm::dvec2 low = picture.min(), high = picture.max();
        const double unit = largest_of({low.x, low.y, high.x, high.y});
        return std::max(narrowing_error(low.x, high.x, upwards, crop.min().x, crop.max().x, unit),
                        narrowing_error(low.y, high.y, across, crop.min().y, crop.max().y, unit));
    }
};

// A rectangle somewhere about the axis, which may be mirrored.
template <class RectangularLens>
RectangularLens random_rectangle(Random& random) {
    const double centre_x = random.uniform(-2.0, 2.0), centre_y = random.uniform(-2.0, 2.0);
    const double half_x = random.power_of_ten(-2.0, 1.0) * (random.integer(0, 3) == 0 ? -1.0 : 1.0);
    const double half_y = random.power_of_ten(-2.0, 1.0) * (random.integer(0, 3) == 0 ? -1.0 : 1.0);
    return {centre_x - half_x, centre_x + half_x, centre_y - half_y, centre_y + half_y, 0.5, 50.0};
}

inline texgen::PerspectiveLens random_perspective(Random& random) {
    return {.fovy = texgen::degrees(random.uniform(0.1, 179.9)),
            .aspect = random.power_of_ten(-1.0, 1.0),
            .z_near = 0.1,
            .z_far = HUGE_VAL,
            .reversed_depth = random.coin()};
}

}  // namespace support
