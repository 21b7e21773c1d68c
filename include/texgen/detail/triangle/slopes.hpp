#pragma once

// The derivatives of a triangle, made ready: what its tiles read.

#include <cmath>
#include <cstddef>
#include <utility>

#include <glm/vec2.hpp>

#include "../arithmetic/rounding.hpp"
#include "../language.hpp"
#include "planes.hpp"

namespace TEXGEN_DETAIL {

// The numerators of the derivatives of s (0) and t (1), see BoundedSlope.
struct FootprintFunctions {
    TriangleFunctions triangle;
    BoundedSlope slope[2];
    double determinant;  // det J Q^3

    explicit FootprintFunctions(const TriangleFunctions& functions) noexcept
        : triangle(functions),
          slope{triangle.planes.slope(0), triangle.planes.slope(1)},
          determinant(triangle.planes.jacobian_determinant()) {}

    // The same in a window whose x and y are exchanged.
    TEXGEN_RARE FootprintFunctions mirrored() const noexcept {
        FootprintFunctions result = *this;
        result.triangle = triangle.mirrored();
        for (BoundedSlope& of : result.slope) {
            std::swap(of.value.dx, of.value.dy);
            std::swap(of.magnitude.dx, of.magnitude.dy);
            of.value.twist = -of.value.twist;
        }
        result.determinant = -determinant;
        return result;
    }

    // At the first fragment of a tile.
    FootprintJob::Slope at_first(std::size_t k, const Tile& tile) const noexcept {
        const glm::dvec2 p = triangle.planes.from_a(tile);
        const FootprintJob::Slope& at_a = slope[k].value;
        return {at_a.dx + p.y * at_a.twist, at_a.dy - p.x * at_a.twist, at_a.twist};
    }

    // The largest slope of a coordinate over a tile, and a bound on its errors.
    double largest(std::size_t k, const Tile& tile) const noexcept {
        const FootprintJob::Slope at = at_first(k, tile);
        const double dx = larger(std::fabs(at.dx), std::fabs(at.dx + (tile.height - 1) * at.twist));
        const double dy = larger(std::fabs(at.dy), std::fabs(at.dy - (tile.width - 1) * at.twist));
        return larger(dx, dy);
    }
    double error(std::size_t k, const Tile& tile) const noexcept {
        const glm::dvec2 p = triangle.planes.from_a(tile);
        const FootprintJob::Slope& magnitude = slope[k].magnitude;
        return gamma(20) * larger(magnitude.dx + (std::fabs(p.y) + tile.height) * magnitude.twist,
                                  magnitude.dy + (std::fabs(p.x) + tile.width) * magnitude.twist);
    }
};

}  // namespace TEXGEN_DETAIL
