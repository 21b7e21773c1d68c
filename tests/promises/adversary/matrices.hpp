#pragma once

// The promises of matrices, lenses and views.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "judges/oracle.hpp"
#include "judges/rational_matrix.hpp"
#include "promises/adversary/inputs.hpp"
#include "promises/adversary/shares.hpp"
#include "support/random.hpp"
#include "support/windows.hpp"
#include "support/workloads/numbers.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace adversary {

using support::exactly;
using support::Rational;
using support::RationalMatrix;
using support::scaled_condition;

// Each element within 2 double ulp of the largest of its terms in X A X.
inline Share inverse_share(const Numbers& n) {
    if (!is_in_range(n, 0x1p-40, 0x1p40)) return says_nothing;
    const glm::dmat4 m = double_matrix(n, 0);
    const std::optional<RationalMatrix> exact = support::inverse(exactly(m));
    const auto computed = inverse(texgen::ModelMatrix(m));
    if (!exact) return computed ? broken : says_nothing;
    if (!(scaled_condition(exactly(m)) < 1e8)) return says_nothing;
    if (!computed) return broken;
    return 0.5 * support::worst_error_of_inverse(exactly(m), exactly(computed->matrix()),
                                                 exactly(texgen::detail::least_scaled));
}
inline Numbers begin_matrix(Random& random) {
    Numbers n(16);
    for (double& x : n) x = random.uniform(-1.0, 1.0);
    const double distance = random.power_of_ten(-7.0, 0.0);
    if (random.coin())
        for (std::size_t k = 0; k < 4; ++k) n[4 * k + 2] = n[4 * k] + distance * n[4 * k + 2];
    return n;
}

// Each element within inverse_error_bound(), whatever the condition.
inline Share inverse_bound_share(const Numbers& n) {
    if (!is_in_range(n, 0x1p-40, 0x1p40)) return says_nothing;
    const texgen::ModelMatrix m(double_matrix(n, 0));
    const auto computed = inverse(m);
    const std::optional<RationalMatrix> exact = support::inverse(exactly(m.matrix()));
    if (!computed || !exact) return says_nothing;
    const glm::dmat4 bound = inverse_error_bound(m, *computed);
    Share worst = 0.0;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            const Rational right = (*exact)[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
            const Rational error = support::magnitude(exactly(computed->matrix()[column][row]) - right);
            if (!std::isfinite(bound[column][row])) continue;
            if (error > exactly(bound[column][row])) return broken;
            worst = std::max(worst, support::nearest<double>(error / exactly(bound[column][row])));
        }
    }
    return worst;
}

// p M^-1, rounded to float, within 0.54 ulp of its largest component.
inline Share eye_planes_share(const Numbers& n) {
    if (!is_in_range(n, 0x1p-40, 0x1p40)) return says_nothing;
    const glm::dmat4 m = float_matrix(n, 0);
    const std::optional<RationalMatrix> exact = support::inverse(exactly(m));
    glm::dmat4 planes(1.0);
    for (int k = 0; k < 4; ++k) planes[k][0] = n[static_cast<std::size_t>(16 + k)];
    const auto stored = eye_planes_as_stored(texgen::WorldTexgen(planes), texgen::ViewMatrix(m));
    if (!exact) return stored ? broken : says_nothing;
    if (!(scaled_condition(exactly(m)) < 1e8)) return says_nothing;
    if (!stored) return broken;
    const RationalMatrix rows = support::operator*(exactly(planes), *exact);
    const glm::mat4 rounded = stored->rounded();
    Rational largest = 0;
    for (const Rational& element : rows[0]) largest = std::max(largest, support::magnitude(element));
    if (largest == 0) return says_nothing;
    Share worst = 0.0;
    for (std::size_t column = 0; column < 4; ++column) {
        const Rational error = support::magnitude(exactly(rounded[static_cast<int>(column)][0]) - rows[0][column]);
        worst = std::max(
            worst,
            support::nearest<double>(error * support::power_of_two(-support::ulp_exponent<float>(largest))) / 0.54);
    }
    return worst;
}
inline Numbers begin_planes(Random& random) {
    Numbers n = begin_matrix(random);
    for (int k = 0; k < 4; ++k) n.push_back(any_float(random));
    for (double& x : n) x = static_cast<double>(support::to_float(x));
    return n;
}

// A fragment, and a camera's projection and view: s/q, t/q and r/q within 2^-47 (m_s + |s/q| m_q) / |q|.
inline Share window_share(const Numbers& n) {
    if (!is_in_range(n, 0x1p-40, 0x1p40)) return says_nothing;
    Random random(9);
    support::WindowScene scene = support::random_window_scene(random, 10.0);
    scene.camera.projection = texgen::ProjectorProjection(double_matrix(n, 3));
    scene.camera.view = texgen::ProjectorView(double_matrix(n, 19));
    for (const std::size_t i : {3u, 19u}) {
        const RationalMatrix m = exactly(double_matrix(n, i));
        if (!support::inverse(m) || !(scaled_condition(m) < 1e8)) return says_nothing;
    }
    const auto texgen = window_linear(scene.projector, scene.camera, scene.viewport, scene.region, scene.depth);
    if (!texgen) return broken;
    return support::ExactWindow(scene).share_of_terms(*texgen, {n[0], n[1], n[2]}) / texgen::window_linear_error;
}
inline Numbers begin_window(Random& random) {
    const support::WindowScene scene = support::random_window_scene(random, random.power_of_ten(-1.0, 7.0));
    return support::detail::numbers(glm::vec3(support::random_fragment(random, scene.viewport)),
                                    scene.camera.projection.matrix(), scene.camera.view.matrix());
}

// No depth that is stored as the fragment's is further off than depth_error_bound().
inline Share depth_bound_share(const Numbers& n) {
    const glm::dmat4 matrix = double_matrix(n, 4);
    if (!is_in_range(n, 0x1p-300, 0x1p300)) return says_nothing;
    const glm::vec3 fragment(floats4(n, 0));
    const glm::dvec2 bound = depth_error_bound(texgen::WindowTexgen(matrix), fragment, texgen::DepthBuffer::float32);
    const RationalMatrix m = exactly(matrix);
    const auto z = static_cast<double>(fragment.z);
    Share worst = says_nothing;
    for (const int direction : {-1, 1}) {
        const double other = 0.5 * z + 0.5 * static_cast<double>(support::neighbour(fragment.z, direction));
        const auto here = support::at(m, glm::dvec3(fragment)),
                   there = support::at(m, glm::dvec3(fragment.x, fragment.y, other));
        for (std::size_t k = 0; k < 2; ++k) {
            const double b = bound[static_cast<int>(k)];
            if (!std::isfinite(b)) continue;
            if (!(here[3] > 0 && there[3] > 0)) return broken;
            const Rational change = support::magnitude(there[k] / there[3] - here[k] / here[3]);
            if (change > exactly(b)) return broken;
            if (b > 0.0) worst = std::max(worst, support::nearest<double>(Rational(change / exactly(b))));
        }
    }
    return worst;
}
inline Numbers begin_depth(Random& random) {
    Numbers n = any_floats(random, 4);
    for (const double x : support::detail::numbers(random.rigid(2.0))) n.push_back(x);
    return n;
}

// Each element of the lens of a calibrated camera within 4 ulp.
inline Share pinhole_share(const Numbers& n) {
    if (!is_in_range(n, 0x1p-200, 0x1p200)) return says_nothing;
    const bool at_half = n[7] > 0.0;
    const texgen::PinholeLens lens{.fx = std::fabs(n[0]),
                                   .fy = std::fabs(n[1]),
                                   .cx = n[2],
                                   .cy = n[3],
                                   .width = std::fabs(n[4]),
                                   .height = std::fabs(n[5]),
                                   .z_near = 0.1,
                                   .z_far = 100.0,
                                   .centre = at_half ? texgen::PixelCentre::half : texgen::PixelCentre::integer,
                                   .skew = n[6]};
    const auto projection = pinhole(lens, texgen::opengl);
    if (lens.fx == 0.0 || lens.fy == 0.0 || lens.width == 0.0 || lens.height == 0.0)
        return projection ? broken : says_nothing;
    if (!projection) return broken;
    const glm::dmat4& m = projection->matrix();
    const Rational width = exactly(lens.width), height = exactly(lens.height), edge = at_half ? 0 : 1;
    return 0.25 * std::max({support::ulp_error(m[0][0], Rational(2 * exactly(lens.fx) / width)),
                            support::ulp_error(m[1][1], Rational(2 * exactly(lens.fy) / height)),
                            support::ulp_error(m[1][0], Rational(-2 * exactly(lens.skew) / width)),
                            support::ulp_error(m[2][0], Rational(1 - (2 * exactly(lens.cx) + edge) / width)),
                            support::ulp_error(m[2][1], Rational((2 * exactly(lens.cy) + edge) / height - 1))});
}
inline Numbers begin_pinhole(Random& random) {
    const double width = random.integer(1, 8192), height = random.integer(1, 8192);
    return {random.uniform(0.5, 5.0) * width,
            random.uniform(0.5, 5.0) * height,
            0.5 * width + random.uniform(-1.0, 1.0),
            0.5 * height + random.uniform(-1.0, 1.0),
            width,
            height,
            random.uniform(-1.0, 1.0),
            random.coin() ? 1.0 : -1.0};
}

// Each element of a view in a mirror within 1 ulp of V R, or 2^-96 of its terms.
inline Share mirrored_share(const Numbers& n) {
    if (!is_in_range(n, 0x1p-60, 0x1p60)) return says_nothing;
    const glm::dmat4 view = double_matrix(n, 0);
    const auto mirrored = texgen::mirrored(texgen::ProjectorView(view), {n[16], n[17], n[18], n[19]});
    Rational squared = 0;
    for (std::size_t k = 16; k < 19; ++k) squared += exactly(n[k]) * exactly(n[k]);
    if (squared == 0) return mirrored ? broken : says_nothing;
    if (!mirrored) return broken;
    Share worst = 0.0;
    for (int row = 0; row < 4; ++row) {
        Rational factor = 0, size = 0;
        for (int k = 0; k < 3; ++k) {
            const Rational term = 2 * exactly(view[k][row]) * exactly(n[static_cast<std::size_t>(16 + k)]) / squared;
            factor += term;
            size += support::magnitude(term);
        }
        for (int column = 0; column < 4; ++column) {
            const Rational element = exactly(view[column][row]);
            const Rational component = exactly(n[static_cast<std::size_t>(16 + column)]);
            const Rational exact = element - factor * component;
            const Rational error = support::magnitude(exactly(mirrored->matrix()[column][row]) - exact);
            const Rational terms = support::magnitude(element) + size * support::magnitude(component);
            const Rational bound = std::max(Rational(terms * support::power_of_two(-96)),
                                            support::power_of_two(support::ulp_exponent<double>(exact)));
            worst = std::max(worst, support::nearest<double>(error / bound));
        }
    }
    return worst;
}

}  // namespace adversary
