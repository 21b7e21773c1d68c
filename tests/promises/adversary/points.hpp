#pragma once

// The promises of points and segments.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "judges/exact.hpp"
#include "promises/adversary/inputs.hpp"
#include "promises/adversary/shares.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "texgen/segment.hpp"
#include "texgen/texcoord.hpp"

namespace adversary {

using support::Outputs;

// |value - exact| <= 1/2 ulp + 2^-50 sum |T_j v_j|: the share of the second term that the first does not cover.
inline Share generate_share(const Numbers& n) {
    if (!is_in_range(n, 0x1p-500, 0x1p500)) return says_nothing;
    const glm::vec3 point(floats4(n, 0));
    glm::dmat4 matrix(0.0);
    for (int j = 0; j < 4; ++j) matrix[j][0] = n[static_cast<std::size_t>(4 + j)];
    glm::vec4 strq(0.0f);
    generate(texgen::ObjectTexgen(matrix), texgen::object_space(std::span(&point, 1)), std::span(&strq, 1));
    if (!std::isfinite(strq.x)) return says_nothing;
    const Dyadic exact = support::exactly_at(matrix, point).s;
    Dyadic terms = magnitude(Dyadic(matrix[3][0]));
    for (int j = 0; j < 3; ++j) terms = terms + magnitude(Dyadic(matrix[j][0]) * Dyadic(point[j]));
    const Dyadic value(static_cast<double>(strq.x));
    const Dyadic middle(support::detail::middle(strq.x, value < exact));
    const Dyadic beyond = magnitude(value - exact) - magnitude(middle - value);
    const double slack = texgen::generate_error * terms.estimate();
    return slack > 0.0 ? share_of_error(beyond.estimate() / slack) : says_nothing;
}

inline Share generate_bound_share(const Numbers& n) {
    if (!is_in_range(n, 0x1p-500, 0x1p500)) return says_nothing;
    const glm::vec3 point(floats4(n, 0));
    glm::dmat4 matrix(0.0);
    for (int j = 0; j < 4; ++j) matrix[j][0] = n[static_cast<std::size_t>(4 + j)];
    const texgen::ObjectTexgen texgen(matrix);
    const auto positions = texgen::object_space(std::span(&point, 1));
    glm::vec4 strq(0.0f);
    generate(texgen, positions, std::span(&strq, 1));
    return share_of_bound(static_cast<double>(strq.x), {support::exactly_at(matrix, point).s, Dyadic(1.0)},
                          generate_error_bound(texgen, positions).x);
}

struct Batch {
    glm::dmat4 matrix{0.0};
    std::vector<glm::vec3> points;
};

// A matrix without its third row, and points that repeat, to fill a block.
inline Batch batch_of(const Numbers& n, std::size_t count) {
    Batch batch;
    for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t row = 0; row < 3; ++row)
            batch.matrix[static_cast<int>(column)][row == 2 ? 3 : static_cast<int>(row)] = n[3 * column + row];
    for (std::size_t i = 0; i < count; ++i) batch.points.push_back(glm::vec3(floats4(n, 12 + 3 * (i % 4))));
    return batch;
}
inline Numbers begin_batch(Random& random) {
    Numbers n = any_floats(random, 25);
    for (std::size_t column = 0; column < 3; ++column)
        if (random.coin()) n[3 * column + 2] *= 0x1p-6;
    if (random.coin()) n[11] = 4.0;
    return n;
}

inline Share project_exact_share(const Numbers& n) {
    const Batch batch = batch_of(n, 1);
    Outputs out(1, 3u);
    project(texgen::ObjectTexgen(batch.matrix), texgen::object_space(batch.points), texgen::whole_texture(),
            out.spans());
    const Homogeneous at = support::exactly_at(batch.matrix, batch.points[0]);
    if (at.q.sign() <= 0) return out.s()[0] == 0.0f ? says_nothing : broken;
    return std::max(share_of_rounding(out.s()[0], at.over_q(0)), share_of_rounding(out.t()[0], at.over_q(1)));
}

inline Share project_within_share(const Numbers& n) {
    const double tolerance = tolerance_of(n[25]);
    if (!(tolerance > 1e-12 && tolerance < 1e6)) return says_nothing;
    const Batch batch = batch_of(n, 16);
    Outputs out(16, 3u);
    project(texgen::ObjectTexgen(batch.matrix), texgen::object_space(batch.points), texgen::whole_texture(),
            out.spans(), {tolerance});
    Share worst = says_nothing;
    for (std::size_t i = 0; i < 4; ++i) {
        const Homogeneous at = support::exactly_at(batch.matrix, batch.points[i]);
        if (at.q.sign() <= 0) {
            if (out.s()[i] != 0.0f) return broken;
            continue;
        }
        for (std::size_t k = 0; k < 2; ++k)
            worst = std::max(worst, share_of_tolerance(out[k][i], at.over_q(k), tolerance));
    }
    return worst;
}

inline Share project_bound_share(const Numbers& n) {
    const double tolerance = tolerance_of(n[25]);
    if (!(tolerance > 1e-12 && tolerance < 1e6)) return says_nothing;
    const Batch batch = batch_of(n, 16);
    const texgen::ObjectTexgen texgen(batch.matrix);
    const auto positions = texgen::object_space(batch.points);
    Outputs out(16, 3u);
    project(texgen, positions, texgen::whole_texture(), out.spans(), {tolerance});
    const glm::dvec2 bound = project_error_bound(texgen, positions, {tolerance});
    Share worst = says_nothing;
    for (std::size_t i = 0; i < 4; ++i) {
        const Homogeneous at = support::exactly_at(batch.matrix, batch.points[i]);
        for (std::size_t k = 0; k < 2 && at.q.sign() > 0; ++k)
            worst = std::max(worst,
                             share_of_bound(static_cast<double>(out[k][i]), at.over_q(k), bound[static_cast<int>(k)]));
    }
    return worst;
}

inline texgen::Segment segment_of(const Numbers& n) { return {floats4(n, 0), floats4(n, 4)}; }
inline Numbers begin_segment(Random& random) {
    Numbers n = any_floats(random, 9);
    n[8] = random.coin() ? random.uniform_float(0.0, 1.0)
                         : static_cast<double>(support::to_float(1.0 - random.power_of_ten(-7.0, -1.0)));
    if (random.coin()) n[3] = std::fabs(n[3]), n[7] = std::fabs(n[7]);
    return n;
}

inline Share segment_exact_share(const Numbers& n) {
    const auto alpha = static_cast<float>(n[8]);
    if (!(alpha >= 0.0f && alpha <= 1.0f)) return says_nothing;
    Outputs out(1, 3u);
    interpolate(segment_of(n), std::span(&alpha, 1), texgen::whole_texture(), out.spans());
    const Homogeneous at = support::exactly_at(segment_of(n), alpha);
    if (at.q.sign() <= 0) return out.s()[0] == 0.0f ? says_nothing : broken;
    return std::max(share_of_rounding(out.s()[0], at.over_q(0)), share_of_rounding(out.t()[0], at.over_q(1)));
}

// A value of a segment within a tolerance, and the truth; empty where the numbers ask for neither.
struct SegmentAnswer {
    double tolerance;
    Outputs out;
    Homogeneous at;
};
inline std::optional<SegmentAnswer> segment_answer(const Numbers& n) {
    const double tolerance = tolerance_of(n[9]);
    const auto alpha = static_cast<float>(n[8]);
    if (!(alpha >= 0.0f && alpha <= 1.0f && tolerance > 1e-12 && tolerance < 1e6)) return std::nullopt;
    SegmentAnswer answer{tolerance, Outputs(1, 3u), support::exactly_at(segment_of(n), alpha)};
    interpolate(segment_of(n), std::span(&alpha, 1), texgen::whole_texture(), answer.out.spans(), {tolerance});
    return answer;
}

inline Share segment_within_share(const Numbers& n) {
    const auto answer = segment_answer(n);
    if (!answer) return says_nothing;
    const auto& [tolerance, out, at] = *answer;
    if (at.q.sign() <= 0) return out.s()[0] == 0.0f ? says_nothing : broken;
    return std::max(share_of_tolerance(out.s()[0], at.over_q(0), tolerance),
                    share_of_tolerance(out.t()[0], at.over_q(1), tolerance));
}

inline Share segment_bound_share(const Numbers& n) {
    const auto answer = segment_answer(n);
    if (!answer) return says_nothing;
    const auto& [tolerance, out, at] = *answer;
    if (at.q.sign() <= 0) return says_nothing;
    const glm::dvec2 bound = error_bound(segment_of(n), {tolerance});
    return std::max(share_of_bound(static_cast<double>(out.s()[0]), at.over_q(0), bound.x),
                    share_of_bound(static_cast<double>(out.t()[0]), at.over_q(1), bound.y));
}

}  // namespace adversary
