#pragma once

// Derivatives exactly and how far away from q = 0 they are, the triangles that they are asked of, and texels.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/real.hpp"
#include "support/footprint_outputs.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/triangles.hpp"
#include "texgen/batch.hpp"
#include "texgen/footprint.hpp"

namespace footprint_cases {

using support::count_of;
using support::Dyadic;
using support::ExactTriangle;
using support::FootprintOutputs;
using support::hex;
using support::Random;
using support::Real;
using support::same_bits;
using support::setup_of;
using support::Shot;
using texgen::Footprint;
using texgen::FootprintSetup;
using texgen::FragmentRect;
using texgen::TexelsPerUnit;
using texgen::Tolerance;
using texgen::Triangle;
using texgen::WindowVertex;

// Where each output of a batch stands in the arrays below.
enum Output : std::size_t { dsdx, dtdx, dsdy, dtdy, level, anisotropy, major_s, major_t };

// The Jacobian exactly, but for its last division: numerators over q^2, in units of s and t.
struct ExactFootprint {
    Real dx[2], dy[2];

    static Real real(const Dyadic& value) { return Real(value.rational()); }

    // S, T and Q are affine, so differences of neighbours are their slopes exactly.
    ExactFootprint(const ExactTriangle& exact, std::int64_t x, std::int64_t y) {
        const support::Homogeneous here = exact.at(x, y), right = exact.at(x + 1, y), up = exact.at(x, y + 1);
        const Real q_squared = real(here.q) * real(here.q);
        const auto slope = [&](const Dyadic& f, const Dyadic& next, const Dyadic& next_q) {
            return Real(real((next - f) * here.q - f * (next_q - here.q)) / q_squared);
        };
        dx[0] = slope(here.s, right.s, right.q);
        dx[1] = slope(here.t, right.t, right.q);
        dy[0] = slope(here.s, up.s, up.q);
        dy[1] = slope(here.t, up.t, up.q);
    }

    // The singular values in texels, from the eigenvalues of J J^T.
    struct Shape {
        Real rho, largest, least;
    };
    Shape shape(const TexelsPerUnit& texels) const {
        const Real a = dx[0] * Real(texels.s), b = dy[0] * Real(texels.s), c = dx[1] * Real(texels.t),
                   d = dy[1] * Real(texels.t);
        const Real column_x = a * a + c * c, column_y = b * b + d * d;
        const Real sum = column_x + column_y, determinant = a * d - b * c;
        const Real square = (sum + sqrt(Real(sum * sum - 4 * determinant * determinant))) / 2;
        const Real largest = sqrt(square);
        return {sqrt(column_x > column_y ? column_x : column_y), largest,
                largest == 0 ? Real(0) : Real(abs(determinant) / largest)};
    }

    Real norm(std::size_t k) const { return sqrt(Real(dx[k] * dx[k] + dy[k] * dy[k])); }
};

inline double distance(double computed, const Real& exact) { return static_cast<double>(abs(Real(computed) - exact)); }

// q/w at a fragment relative to the largest of its terms: how far away from q = 0 it is.
inline double distance_from_zero(const Triangle& triangle, double x, double y) {
    const auto corner = support::vertices(triangle);
    double sum = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const WindowVertex &j = *corner[(i + 1) % 3], &k = *corner[(i + 2) % 3];
        const double edge = (static_cast<double>(j.window.x) - x) * (static_cast<double>(k.window.y) - y) -
                            (static_cast<double>(j.window.y) - y) * (static_cast<double>(k.window.x) - x);
        const double term = edge * static_cast<double>(corner[i]->strq.w) / static_cast<double>(corner[i]->clip_w);
        sum += term;
        largest = std::max(largest, std::fabs(term));
    }
    return std::fabs(sum) / largest;
}

inline std::string text(const TexelsPerUnit& texels) { return "texels " + hex(texels.s) + ", " + hex(texels.t); }

inline TexelsPerUnit some_texels(Random& random) {
    return {std::ldexp(1.0, random.integer(0, 13)) * (random.coin() ? 1.0 : random.uniform(0.6, 1.4)),
            std::ldexp(1.0, random.integer(0, 13))};
}

// A parallelogram of the window with w = 1, so that q is affine; s/q, t/q and q given at its corners.
inline Triangle flat(const std::array<glm::vec2, 3>& window, const std::array<glm::vec3, 3>& stq) {
    Triangle triangle{};
    const auto corner = support::vertices(triangle);
    for (std::size_t i = 0; i < 3; ++i)
        *corner[i] = {window[i], 1.0f, {stq[i].x * stq[i].z, stq[i].y * stq[i].z, 0.0f, stq[i].z}};
    return triangle;
}

// A window-filling triangle in front: q/w varies by up to `ratio`, s and t by ordinary amounts.
inline Triangle spread_triangle(Random& random, double ratio) {
    for (;;) {
        Triangle triangle{};
        for (WindowVertex* vertex : support::vertices(triangle)) {
            const double w = random.uniform(0.5, 8.0), q = w * std::pow(ratio, random.uniform(0.0, 1.0));
            vertex->window = {random.uniform_float(-100.0, 600.0), random.uniform_float(-100.0, 600.0)};
            vertex->clip_w = support::to_float(w);
            vertex->strq = {support::to_float(random.uniform(-1.0, 2.0) * q),
                            support::to_float(random.uniform(-1.0, 2.0) * q), 0.0f, support::to_float(q)};
        }
        if (std::fabs(support::twice_area(triangle)) > 20000.0) return triangle;
    }
}

// The footprints of a shot's triangle among those of others, in short runs; returns which fragments have it, by id 0.
inline std::vector<std::uint32_t> fill_among_others(const Shot& shot, const TexelsPerUnit& texels, Random& random,
                                                    FootprintOutputs& out) {
    Triangle triangles[4] = {shot.triangle, support::make_triangle(support::Family::friendly, random),
                             support::make_triangle(support::Family::sliver, random),
                             support::make_triangle(support::Family::parallel, random)};
    if (random.coin()) triangles[3].b.window.x = std::numeric_limits<float>::quiet_NaN();
    texgen::TriangleBatch batch(texgen::whole_texture());
    batch.assign(triangles);
    std::vector<std::uint32_t> ids(count_of(shot.rect));
    for (std::size_t i = 0; i < ids.size();) {
        for (int run = random.integer(1, 15); run > 0 && i < ids.size(); --run) ids[i++] = 0;
        const int other = random.integer(-1, 5);
        for (int run = random.integer(1, 5); run > 0 && i < ids.size(); --run)
            ids[i++] = other < 0 ? texgen::no_triangle : static_cast<std::uint32_t>(other);
    }
    footprint(batch, ids, shot.rect, texels, out.spans());
    return ids;
}

}  // namespace footprint_cases
