// How far a mirrored view is from V R.

#pragma once

#include <algorithm>

#include "judges/oracle.hpp"
#include "judges/rational_matrix.hpp"
#include "texgen/projector.hpp"

namespace support {

// The largest error of an element in ulps, of those that are off by more than 2^-96 of their terms.
inline double mirror_error(const texgen::ProjectorView& view, const glm::dvec4& plane, const glm::dmat4& mirrored) {
    double worst = 0.0;
    Rational squared = 0;
    for (int k = 0; k < 3; ++k) squared += exactly(plane[k]) * exactly(plane[k]);
    for (int row = 0; row < 4; ++row) {
        Rational factor = 0, size = 0;
        for (int k = 0; k < 3; ++k) {
            const Rational term = 2 * exactly(view.matrix()[k][row]) * exactly(plane[k]) / squared;
            factor += term;
            size += magnitude(term);
        }
        for (int column = 0; column < 4; ++column) {
            const Rational element = exactly(view.matrix()[column][row]), component = exactly(plane[column]);
            const Rational exact = element - factor * component;
            const Rational terms = magnitude(element) + size * magnitude(component);
            const Rational error = magnitude(exactly(mirrored[column][row]) - exact);
            if (error > terms * power_of_two(-96)) worst = std::max(worst, ulp_error(mirrored[column][row], exact));
        }
    }
    return worst;
}

}  // namespace support
