// A search that tries to break what the library promises: it climbs over the bits of the inputs towards the largest
// share of each stated bound, and towards the decisions that hang by the least. Exact integers and rationals judge.
// Prints, for every promise, the worst input that it met; fails where a promise is broken.
//
//   adversary [--seconds N] [--seed N] [--only WORD] [--towards error]
//
// Towards time it climbs to the inputs that a function takes longest for, as a multiple of what ordinary ones take, and
// fails where that is above its limit (support/limits.hpp). What it prints is a line of worst_inputs.txt, behind what
// it measured; it begins with those, and with 0 seconds they are all. Functions whose names stand behind --but, which a
// | separates, are searched, and never fail.
//
//   adversary --towards time [--seconds N] [--seed N] [--only WORD] [--but NAME|NAME...]

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/rational_matrix.hpp"
#include "judges/verdict.hpp"
#include "support/hard_triangles.hpp"
#include "support/outputs.hpp"
#include "support/race.hpp"
#include "support/random.hpp"
#include "support/surfaces.hpp"
#include "support/windows.hpp"
#include "support/workloads.hpp"
#include "texgen/clip.hpp"
#include "texgen/coverage.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/linear.hpp"
#include "texgen/surface.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::Dyadic;
using support::exactly;
using support::Homogeneous;
using support::Outputs;
using support::Quotient;
using support::Random;
using support::Rational;
using support::RationalMatrix;
using support::scaled_condition;
using texgen::Tolerance;

constexpr double broken = HUGE_VAL;

// The share of its bound that an error takes, or of 300 bits by which a decision was near to the other answer: above 1
// the promise is broken. Below 0: the input says nothing.
using Share = double;
constexpr Share says_nothing = -1.0;

// An input: numbers that are floats, and after them doubles.
using support::Numbers;

struct Promise {
    const char* name;
    std::size_t floats;
    Numbers (*begin)(Random&);
    Share (*share)(const Numbers&);
};

// The inputs

glm::vec4 floats4(const Numbers& n, std::size_t i) {
    return {static_cast<float>(n[i]), static_cast<float>(n[i + 1]), static_cast<float>(n[i + 2]),
            static_cast<float>(n[i + 3])};
}

double any_float(Random& random) {
    const double sign = random.coin() ? 1.0 : -1.0;
    switch (random.integer(0, 3)) {
        case 0:
            return sign * static_cast<double>(support::to_float(random.power_of_ten(-6.0, 6.0)));
        case 1:
            return static_cast<double>(random.integer(-8, 8));
        default:
            return random.uniform_float(-2.0, 2.0);
    }
}

Numbers any_floats(Random& random, std::size_t count) {
    Numbers numbers(count);
    for (double& number : numbers) number = any_float(random);
    return numbers;
}

double tolerance_of(double number) { return std::fabs(number); }
Numbers with_tolerance(Numbers numbers, Random& random) {
    numbers.push_back(random.power_of_ten(-8.0, -1.0));
    return numbers;
}

bool all_finite(const Numbers& n) {
    return std::all_of(n.begin(), n.end(), [](double x) { return std::isfinite(x); });
}

double moved(double number, bool is_float, Random& random) {
    const int width = is_float ? 32 : 64;
    const auto bits =
        is_float ? std::bit_cast<std::uint32_t>(static_cast<float>(number)) : std::bit_cast<std::uint64_t>(number);
    std::uint64_t next = bits;
    switch (random.integer(0, 3)) {
        case 0:
            next ^= std::uint64_t{1} << random.integer(0, width - 1);
            break;
        case 1:
            next += static_cast<std::uint64_t>(static_cast<std::int64_t>(random.integer(-3, 3)));
            break;
        case 2:
            next ^= std::uint64_t{1} << random.integer(0, width - 10);
            break;
        default:
            next += static_cast<std::uint64_t>(std::int64_t{random.integer(-2, 2)}) << random.integer(0, width - 10);
            break;
    }
    const double value = is_float ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(next)))
                                  : std::bit_cast<double>(next);
    return std::isfinite(value) ? value : number;
}

// One number changed, now and then two; or one taken from another place. The first of them are floats.
Numbers moved(std::size_t floats, Numbers numbers, Random& random) {
    const int last = static_cast<int>(numbers.size()) - 1;
    const int changes = random.integer(0, 3) == 0 ? 2 : 1;
    for (int change = 0; change < changes; ++change) {
        const auto i = static_cast<std::size_t>(random.integer(0, last));
        if (random.integer(0, 15) == 0 && i < floats)
            numbers[i] = numbers[static_cast<std::size_t>(random.integer(0, static_cast<int>(floats) - 1))];
        else
            numbers[i] = moved(numbers[i], i < floats, random);
    }
    return numbers;
}

// The shares

// A decision: the smaller the distance from the other answer, relative to its terms, the nearer; on the border itself
// there is only one answer.
Share share_of_decision(double distance) {
    return distance > 0.0 ? std::clamp(-std::log2(distance) / 300.0, 0.0, 1.0) : 0.0;
}

// An error below nothing: some of the way to the bound, so that there is something to climb.
Share share_of_error(double share) { return share > 0.0 ? share : 1e-3 / (1.0 - share); }

// The nearest float: a decision at the middle of two floats.
Share share_of_rounding(float value, const Quotient& u) {
    if (!is_nearest(value, u)) return broken;
    if (!std::isfinite(value)) return says_nothing;
    const double middle = support::detail::middle(value, compare(u, static_cast<double>(value)) > 0);
    return share_of_decision(distance(middle, u) / std::fabs(middle - static_cast<double>(value)));
}

// |error| <= max(tolerance, 1/2 ulp).
Share share_of_tolerance(float value, const Quotient& u, double tolerance) {
    if (!is_within(value, u, tolerance)) return broken;
    return is_nearest(value, u, false) ? 0.0 : distance(static_cast<double>(value), u) / tolerance;
}

// |value - n/d| <= bound. Where the bound is not finite, or there is no value, nothing is said.
Share share_of_bound(double value, const Quotient& u, double bound) {
    if (!std::isfinite(bound) || !std::isfinite(value)) return says_nothing;
    if (!(magnitude(Dyadic(value) * u.d - u.n) <= Dyadic(bound) * u.d)) return broken;
    return bound > 0.0 ? distance(value, u) / bound : 0.0;
}

glm::dmat4 float_matrix(const Numbers& n, std::size_t i) {
    return glm::dmat4(glm::mat4(floats4(n, i), floats4(n, i + 4), floats4(n, i + 8), floats4(n, i + 12)));
}
glm::dmat4 double_matrix(const Numbers& n, std::size_t i) {
    glm::dmat4 m(0.0);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) m[column][row] = n[i + static_cast<std::size_t>(4 * column + row)];
    return m;
}

bool is_in_range(const Numbers& n, double least, double largest) {
    return std::all_of(n.begin(), n.end(),
                       [&](double x) { return x == 0.0 || (std::fabs(x) >= least && std::fabs(x) <= largest); });
}

// |value - exact| <= 1/2 ulp + 2^-50 sum |T_j v_j|: the share of the second term that the first does not cover.
Share generate_share(const Numbers& n) {
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

Share generate_bound_share(const Numbers& n) {
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
Batch batch_of(const Numbers& n, std::size_t count) {
    Batch batch;
    for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t row = 0; row < 3; ++row)
            batch.matrix[static_cast<int>(column)][row == 2 ? 3 : static_cast<int>(row)] = n[3 * column + row];
    for (std::size_t i = 0; i < count; ++i) batch.points.push_back(glm::vec3(floats4(n, 12 + 3 * (i % 4))));
    return batch;
}
Numbers begin_batch(Random& random) {
    Numbers n = any_floats(random, 25);
    for (std::size_t column = 0; column < 3; ++column)
        if (random.coin()) n[3 * column + 2] *= 0x1p-6;
    if (random.coin()) n[11] = 4.0;
    return n;
}

Share project_exact_share(const Numbers& n) {
    const Batch batch = batch_of(n, 1);
    Outputs out(1, 3u);
    project(texgen::ObjectTexgen(batch.matrix), texgen::object_space(batch.points), texgen::whole_texture(),
            out.spans());
    const Homogeneous at = support::exactly_at(batch.matrix, batch.points[0]);
    if (at.q.sign() <= 0) return out.s()[0] == 0.0f ? says_nothing : broken;
    return std::max(share_of_rounding(out.s()[0], at.over_q(0)), share_of_rounding(out.t()[0], at.over_q(1)));
}

Share project_within_share(const Numbers& n) {
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

Share project_bound_share(const Numbers& n) {
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

texgen::Segment segment_of(const Numbers& n) { return {floats4(n, 0), floats4(n, 4)}; }
Numbers begin_segment(Random& random) {
    Numbers n = any_floats(random, 9);
    n[8] = random.coin() ? random.uniform_float(0.0, 1.0)
                         : static_cast<double>(support::to_float(1.0 - random.power_of_ten(-7.0, -1.0)));
    if (random.coin()) n[3] = std::fabs(n[3]), n[7] = std::fabs(n[7]);
    return n;
}

Share segment_exact_share(const Numbers& n) {
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
std::optional<SegmentAnswer> segment_answer(const Numbers& n) {
    const double tolerance = tolerance_of(n[9]);
    const auto alpha = static_cast<float>(n[8]);
    if (!(alpha >= 0.0f && alpha <= 1.0f && tolerance > 1e-12 && tolerance < 1e6)) return std::nullopt;
    SegmentAnswer answer{tolerance, Outputs(1, 3u), support::exactly_at(segment_of(n), alpha)};
    interpolate(segment_of(n), std::span(&alpha, 1), texgen::whole_texture(), answer.out.spans(), {tolerance});
    return answer;
}

Share segment_within_share(const Numbers& n) {
    const auto answer = segment_answer(n);
    if (!answer) return says_nothing;
    const auto& [tolerance, out, at] = *answer;
    if (at.q.sign() <= 0) return out.s()[0] == 0.0f ? says_nothing : broken;
    return std::max(share_of_tolerance(out.s()[0], at.over_q(0), tolerance),
                    share_of_tolerance(out.t()[0], at.over_q(1), tolerance));
}

Share segment_bound_share(const Numbers& n) {
    const auto answer = segment_answer(n);
    if (!answer) return says_nothing;
    const auto& [tolerance, out, at] = *answer;
    if (at.q.sign() <= 0) return says_nothing;
    const glm::dvec2 bound = error_bound(segment_of(n), {tolerance});
    return std::max(share_of_bound(static_cast<double>(out.s()[0]), at.over_q(0), bound.x),
                    share_of_bound(static_cast<double>(out.t()[0]), at.over_q(1), bound.y));
}

// Seven numbers a vertex: the window, w, and s, t, r, q.
texgen::Triangle triangle_of(const Numbers& n) {
    const auto vertex = [&](std::size_t i) {
        return texgen::WindowVertex{
            {static_cast<float>(n[i]), static_cast<float>(n[i + 1])}, static_cast<float>(n[i + 2]), floats4(n, i + 3)};
    };
    return {vertex(0), vertex(7), vertex(14)};
}
Numbers numbers_of(const texgen::Triangle& triangle) {
    Numbers n;
    for (const texgen::WindowVertex* v : support::vertices(triangle))
        for (const float x : {v->window.x, v->window.y, v->clip_w, v->strq.x, v->strq.y, v->strq.z, v->strq.w})
            n.push_back(static_cast<double>(x));
    return n;
}

// A triangle of a hard family, moved so that its rectangle begins at a small pixel.
Numbers begin_triangle(Random& random) {
    const auto family = support::families[static_cast<std::size_t>(random.integer(0, 7))];
    Numbers n = numbers_of(support::make_triangle(family, random));
    for (std::size_t i = 0; i < 21; i += 7)
        for (std::size_t k = 0; k < 2; ++k)
            n[i + k] = static_cast<double>(support::to_float(0.25 * std::clamp(n[i + k], -400.0, 1e3)));
    return n;
}

constexpr texgen::FragmentRect wide{0, 0, 64, 4};
constexpr std::array<std::size_t, 7> looked_at{0, 21, 31, 32, 63, 130, 255};

Share triangle_exact_share(const Numbers& n) {
    const texgen::Triangle triangle = triangle_of(n);
    const auto setup = texgen::TriangleSetup::of(triangle, support::everywhere());
    if (!setup) return says_nothing;
    constexpr texgen::FragmentRect rect{20, 20, 2, 1};
    Outputs out(2, 3u);
    const texgen::Work work = interpolate(*setup, rect, out.spans());
    const support::ExactTriangle exact(triangle);
    if (!exact.has_positive_w(20, 20)) return says_nothing;
    const Homogeneous at = exact.at(20, 20);
    if (work == texgen::Work::nothing) return at.q.sign() > 0 ? broken : says_nothing;
    if (at.q.sign() <= 0) return out.s()[0] == 0.0f ? says_nothing : broken;
    return std::max(share_of_rounding(out.s()[0], at.over_q(0)), share_of_rounding(out.t()[0], at.over_q(1)));
}

template <bool OfBound>
Share triangle_within_share(const Numbers& n) {
    const double tolerance = tolerance_of(n[21]);
    if (!(tolerance > 1e-12 && tolerance < 1e6)) return says_nothing;
    const texgen::Triangle triangle = triangle_of(n);
    const auto setup = texgen::TriangleSetup::of(triangle, support::everywhere(), {tolerance});
    if (!setup) return says_nothing;
    Outputs out(256, 3u);
    const glm::dvec2 bound = setup->error_bound(wide);
    if (interpolate(*setup, wide, out.spans()) == texgen::Work::nothing) return says_nothing;
    const support::ExactTriangle exact(triangle);
    Share worst = says_nothing;
    for (const std::size_t i : looked_at) {
        const auto x = static_cast<std::int64_t>(i % 64), y = static_cast<std::int64_t>(i / 64);
        if (!exact.has_positive_w(x, y)) continue;
        const Homogeneous at = exact.at(x, y);
        if (at.q.sign() <= 0) continue;
        for (std::size_t k = 0; k < 2; ++k) {
            const double of_bound = bound[static_cast<int>(k)];
            if (!OfBound)
                worst = std::max(worst, share_of_tolerance(out[k][i], at.over_q(k), tolerance));
            else if (of_bound > 0.0 && std::isfinite(of_bound))
                worst = std::max(worst, is_within(out[k][i], at.over_q(k), of_bound)
                                            ? distance(static_cast<double>(out[k][i]), at.over_q(k)) / of_bound
                                            : broken);
        }
    }
    return worst;
}

// Derivatives within their bound, whose numerators are the differences of neighbours; and each level of a fragment in
// front inside the extremes of the rectangle: the share that rounding takes of the room that they leave for it.
enum class OfFootprints { bound, extremes, batch };
template <OfFootprints Of>
Share footprint_share(const Numbers& n) {
    constexpr bool OfExtremes = Of == OfFootprints::extremes;
    const texgen::Triangle triangle = triangle_of(n);
    const auto prepared = texgen::TriangleSetup::of(triangle, support::everywhere());
    if (!prepared || !is_in_range(n, 0x1p-30, 0x1p30)) return says_nothing;
    const texgen::FootprintSetup setup(*prepared, {256.0, 1000.0});
    Outputs out(256), levels(256, 1u);
    const texgen::Texcoords spans = out.spans();
    const texgen::Footprints footprints{.dsdx = spans.s,
                                        .dtdx = spans.t,
                                        .dsdy = spans.r,
                                        .dtdy = spans.lit,
                                        .level = levels.spans().s,
                                        .anisotropy = {},
                                        .major_s = {},
                                        .major_t = {}};
    if (Of == OfFootprints::batch) {
        texgen::TriangleBatch batch(support::everywhere());
        const texgen::Triangle both[] = {triangle, {triangle.b, triangle.c, triangle.a}};
        batch.assign(both);
        std::vector<std::uint32_t> ids(256);
        for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = i / 3 % 2;
        footprint(batch, ids, wide, {256.0, 1000.0}, footprints);
    } else if (!footprint(setup, wide, footprints)) {
        return says_nothing;
    }
    const glm::dvec2 of_rect = setup.error_bound(wide);
    const auto extremes = setup.extremes(wide);
    const support::ExactTriangle exact(triangle);
    Share worst = says_nothing;
    for (const std::size_t i : looked_at) {
        const auto x = static_cast<int>(i % 64), y = static_cast<int>(i / 64);
        const Homogeneous at = exact.at(x, y);
        if (!exact.has_positive_w(x, y) || at.q.sign() <= 0) continue;
        if (OfExtremes) {
            const auto one = setup.at(x, y);
            if (!one || !extremes) return broken;
            const auto level = static_cast<double>(levels.s()[i]);
            if (!std::isfinite(level)) continue;
            const double room = std::min(level - extremes->least_level, extremes->largest_level - level);
            if (!(room >= 0.0) || !(one->anisotropy <= extremes->largest_anisotropy)) return broken;
            worst = std::max(worst, share_of_error(1.0 - 0x1p15 * room / std::max(1.0, std::fabs(level) / 32.0)));
            continue;
        }
        const Homogeneous next[] = {exact.at(x + 1, y), exact.at(x, y + 1)};
        glm::dvec2 bound = of_rect;
        if (Of == OfFootprints::batch) {
            const auto turned = texgen::TriangleSetup::of({triangle.b, triangle.c, triangle.a}, support::everywhere());
            if (!turned) return broken;
            const texgen::FootprintSetup setup_of_id(i / 3 % 2 == 0 ? *prepared : *turned, {256.0, 1000.0});
            const auto one = setup_of_id.at(x, y);
            if (!one) return broken;
            const auto length = [&](int k) { return std::hypot(one->dx[k], one->dy[k]); };
            bound = setup_of_id.error_bound({x, y, 1, 1}) +
                    texgen::batch_footprint_error * glm::dvec2(length(0), length(1));
        }
        for (std::size_t k = 0; k < 4; ++k) {
            const Dyadic here = at.over_q(k % 2).n;
            const Homogeneous& neighbour = next[k / 2];
            const Dyadic slope = (neighbour.over_q(k % 2).n - here) * at.q - here * (neighbour.q - at.q);
            worst = std::max(worst, share_of_bound(static_cast<double>(out[k][i]), {slope, at.q * at.q},
                                                   bound[static_cast<int>(k % 2)]));
        }
    }
    return worst;
}

// How far a coordinate is from the inside of [0, 1], or from its outside, relative to its terms.
double distance_to_region(const Homogeneous& at) {
    double distance = HUGE_VAL;
    const double q = at.q.estimate();
    for (const Dyadic& u : {at.s, at.t}) {
        const double terms = std::fabs(u.estimate()) + std::fabs(q);
        distance = std::min({distance, std::fabs(u.estimate()) / terms, std::fabs((u - at.q).estimate()) / terms});
    }
    return distance;
}

// Nothing is done only where nothing is lit; no test is left out where something is dark.
Share work_share(const Numbers& n) {
    const texgen::Triangle triangle = triangle_of(n);
    const texgen::TextureRegion region = texgen::whole_texture();
    const auto setup = texgen::TriangleSetup::of(triangle, region);
    if (!setup) return says_nothing;
    constexpr texgen::FragmentRect rect{20, 20, 3, 2};
    const texgen::Work work = setup->work(rect);
    if (work != texgen::Work::nothing && work != texgen::Work::divide) return says_nothing;
    const support::ExactTriangle exact(triangle);
    double nearest = HUGE_VAL;
    for (std::int64_t i = 0; i < 6; ++i) {
        const std::int64_t x = 20 + i % 3, y = 20 + i / 3;
        if (!exact.has_positive_w(x, y)) return says_nothing;
        const Homogeneous at = exact.at(x, y);
        const bool lit = support::contains(region, at);
        if (lit != (work == texgen::Work::divide)) return broken;
        if (at.q.sign() > 0) nearest = std::min(nearest, distance_to_region(at));
    }
    return std::isfinite(nearest) ? share_of_decision(nearest) : says_nothing;
}

// Boxes: outside means that no vertex is lit (they are points of it), inside that all are.
Share coverage_share(const Numbers& n) {
    const glm::dmat4 matrix = batch_of(n, 0).matrix;
    const glm::vec3 a(floats4(n, 12)), b(floats4(n, 15));
    const texgen::Box box{glm::min(a, b), glm::max(a, b)};
    const texgen::TextureRegion region = texgen::whole_texture();
    const texgen::Coverage coverage = texgen::coverage(texgen::ObjectTexgen(matrix), region, box);
    if (coverage == texgen::Coverage::partial) return says_nothing;
    double nearest = HUGE_VAL;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 point{((corner & 1) != 0 ? box.max : box.min).x, ((corner & 2) != 0 ? box.max : box.min).y,
                              ((corner & 4) != 0 ? box.max : box.min).z};
        const Homogeneous at = support::exactly_at(matrix, point);
        const bool lit = at.q.sign() > 0 && at.s.sign() >= 0 && at.t.sign() >= 0 && at.s <= at.q && at.t <= at.q;
        if (lit != (coverage == texgen::Coverage::inside)) return broken;
        if (at.q.sign() > 0) nearest = std::min(nearest, distance_to_region(at));
    }
    return std::isfinite(nearest) ? share_of_decision(nearest) : says_nothing;
}

// Each element within 2 double ulp of the largest of its terms in X A X.
Share inverse_share(const Numbers& n) {
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
Numbers begin_matrix(Random& random) {
    Numbers n(16);
    for (double& x : n) x = random.uniform(-1.0, 1.0);
    const double distance = random.power_of_ten(-7.0, 0.0);
    if (random.coin())
        for (std::size_t k = 0; k < 4; ++k) n[4 * k + 2] = n[4 * k] + distance * n[4 * k + 2];
    return n;
}

// Each element within inverse_error_bound(), whatever the condition.
Share inverse_bound_share(const Numbers& n) {
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
Share eye_planes_share(const Numbers& n) {
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
Numbers begin_planes(Random& random) {
    Numbers n = begin_matrix(random);
    for (int k = 0; k < 4; ++k) n.push_back(any_float(random));
    for (double& x : n) x = static_cast<double>(support::to_float(x));
    return n;
}

std::vector<texgen::ClipVertex> polygon_of(const Numbers& n) {
    return {{floats4(n, 0), floats4(n, 4)}, {floats4(n, 8), floats4(n, 12)}, {floats4(n, 16), floats4(n, 20)}};
}

// What comes out of the clip to the slide is inside the region but for slide_clip_error.
Share clip_to_slide_share(const Numbers& n) {
    if (!is_in_range(n, 0x1p-60, 0x1p60)) return says_nothing;
    std::array<texgen::ClipVertex, 8> out{};
    // Sides that are no floats: on those of the whole texture s, t and q are rounded alike.
    const texgen::TextureRegion region = texgen::atlas_tile({0.1, 0.3}, {0.7, 0.9});
    const std::size_t count = clip_to_slide(polygon_of(n), region, out);
    Share worst = says_nothing;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec4& strq = out[i].strq;
        if (!(strq.w > 0.0f)) return broken;
        for (int k = 0; k < 2; ++k) {
            const auto u = static_cast<double>(strq[k]), q = static_cast<double>(strq.w);
            const double min = region.min()[k], max = region.max()[k];
            worst = std::max(worst,
                             share_of_error(std::max(min * q - u, u - max * q) / (texgen::slide_clip_error * max * q)));
        }
    }
    return worst;
}

// What comes out of the clip to the near plane is in front of it and of the eye, each component of a new vertex within
// 1/2 ulp + clip_error of the intersection; here the component x of the vertex on the first edge.
Share clip_to_near_share(const Numbers& n) {
    if (!is_in_range(n, 0x1p-60, 0x1p60)) return says_nothing;
    const std::vector<texgen::ClipVertex> polygon = polygon_of(n);
    std::array<texgen::ClipVertex, 5> out{};
    const std::size_t count = clip_to_near(polygon, out, texgen::DepthRange::negative_one_to_one);
    Share worst = says_nothing;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec4& p = out[i].position;
        if (!(p.w > 0.0f) || !(static_cast<double>(p.z) + static_cast<double>(p.w) >= 0.0)) return broken;
    }
    for (std::size_t e = 0; e < 3 && count != 0; ++e) {
        const glm::vec4 &a = polygon[e].position, &b = polygon[(e + 1) % 3].position;
        const Dyadic da = Dyadic(a.z) + Dyadic(a.w), db = Dyadic(b.z) + Dyadic(b.w);
        // Where the near plane leaves no room for w <= 0 the edge is cut once.
        if (!(da.sign() * db.sign() < 0) || !(a.w > 0.0f && b.w > 0.0f)) continue;
        const Dyadic weight_a = magnitude(db), weight_b = magnitude(da);
        const Quotient x{weight_a * Dyadic(a.x) + weight_b * Dyadic(b.x), weight_a + weight_b};
        const Quotient terms{weight_a * magnitude(Dyadic(a.x)) + weight_b * magnitude(Dyadic(b.x)),
                             weight_a + weight_b};
        Share nearest = broken;
        for (std::size_t i = 0; i < count; ++i) {
            const float value = out[i].position.x;
            const double half = std::fabs(support::detail::middle(value, compare(x, static_cast<double>(value)) > 0) -
                                          static_cast<double>(value));
            const double bound = half + texgen::clip_error * terms.estimate();
            if (bound > 0.0) nearest = std::min(nearest, distance(static_cast<double>(value), x) / bound);
        }
        // Another plane of the eye may cut the vertex off again.
        if (count == 3 || count == 4) worst = std::max(worst, nearest);
    }
    return worst;
}

// A fragment, and a camera's projection and view: s/q, t/q and r/q within 2^-47 (m_s + |s/q| m_q) / |q|.
Share window_share(const Numbers& n) {
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
Numbers begin_window(Random& random) {
    const support::WindowScene scene = support::random_window_scene(random, random.power_of_ten(-1.0, 7.0));
    return support::detail::numbers(glm::vec3(support::random_fragment(random, scene.viewport)),
                                    scene.camera.projection.matrix(), scene.camera.view.matrix());
}

// No depth that is stored as the fragment's is further off than depth_error_bound().
Share depth_bound_share(const Numbers& n) {
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
Numbers begin_depth(Random& random) {
    Numbers n = any_floats(random, 4);
    for (const double x : support::detail::numbers(random.rigid(2.0))) n.push_back(x);
    return n;
}

// Surfaces

support::Corners surface_of(const Numbers& n) { return {floats4(n, 0), floats4(n, 4), floats4(n, 8)}; }
Numbers begin_surface(Random& random) {
    const support::Corners corners =
        support::corners_of(support::corner_families[random.bits() % support::corner_families.size()], random);
    Numbers n;
    for (const glm::vec4& corner : corners)
        for (int k = 0; k < 4; ++k) n.push_back(static_cast<double>(corner[k]));
    return n;
}

Share facing_share(const Numbers& n) {
    const support::Corners corners = surface_of(n);
    const Dyadic exact = support::exact_determinant(corners);
    const auto answer = texgen::facing(corners[0], corners[1], corners[2], texgen::TextureOrigin::bottom_left);
    if (answer != support::facing_of_sign(exact.sign(), texgen::TextureOrigin::bottom_left)) return broken;
    Dyadic terms;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 1; j < 3; ++j)
            terms = terms + magnitude(Dyadic(corners[i].x) * Dyadic(corners[(i + j) % 3].y) *
                                      Dyadic(corners[(i + 2 * j) % 3].w));
    return terms.sign() == 0 ? says_nothing : share_of_decision(std::fabs(exact.estimate()) / terms.estimate());
}

Share slide_area_share(const Numbers& n) {
    const support::Corners corners = surface_of(n);
    const auto area = texgen::slide_area(corners[0], corners[1], corners[2]);
    if (!area) return says_nothing;
    return support::relative_error(*area, support::exact_slide_area(corners)) / texgen::slide_area_error;
}

Share receiver_plane_share(const Numbers& n) {
    const support::Corners corners = surface_of(n);
    const auto plane = texgen::receiver_plane(corners[0], corners[1], corners[2]);
    const Dyadic divisor = support::exact_determinant(corners);
    if (plane.has_value() != (divisor.sign() != 0)) return broken;
    if (!plane) return says_nothing;
    double worst = 0.0;
    for (int k = 0; k < 3; ++k)
        worst = std::max(worst, support::relative_error(
                                    (*plane)[k], support::exact_receiver_plane(corners)[static_cast<std::size_t>(k)]));
    return worst / texgen::receiver_plane_error;
}

// Each element of the lens of a calibrated camera within 4 ulp.
Share pinhole_share(const Numbers& n) {
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
Numbers begin_pinhole(Random& random) {
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
Share mirrored_share(const Numbers& n) {
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

support::Quadrilateral quadrilateral_of(const Numbers& n) {
    return {glm::dvec2(n[0], n[1]), glm::dvec2(n[2], n[3]), glm::dvec2(n[4], n[5]), glm::dvec2(n[6], n[7])};
}

// The error of an element, and the refusal of what is not strictly convex.
Share keystone_share(const Numbers& n) {
    if (!is_in_range(n, 0x1p-400, 0x1p400)) return says_nothing;
    const support::Quadrilateral corners = quadrilateral_of(n);
    const auto matrix = texgen::keystone(corners);
    if (!support::exact_q(corners)) return matrix ? broken : says_nothing;
    if (!matrix) return says_nothing;
    return support::measured_keystone_error(*matrix, corners, texgen::whole_texture()) / texgen::keystone_error;
}

// The worst ulp of a q, where a half is allowed, and the refusal of what is not strictly convex.
Share quadrilateral_share(const Numbers& n) {
    if (!is_in_range(n, 0x1p-400, 0x1p400)) return says_nothing;
    const support::Quadrilateral corners = quadrilateral_of(n);
    const auto exact = support::exact_q(corners);
    const auto strq = texgen::quadrilateral(corners);
    if (!exact) return strq ? broken : says_nothing;
    if (!strq) return says_nothing;
    double worst = 0.0;
    for (std::size_t k = 0; k < 4; ++k) worst = std::max(worst, support::ulp_error((*strq)[k].w, (*exact)[k]));
    return worst / 0.51;
}

const std::array promises{
    Promise{"generate: 2^-50 of the terms", 4,
            [](Random& random) {
                Numbers n = any_floats(random, 4);
                for (int k = 0; k < 4; ++k) n.push_back(random.coin() ? any_float(random) : random.uniform(-1.0, 1.0));
                return n;
            },
            generate_share},
    Promise{"generate: generate_error_bound", 4, [](Random& random) { return any_floats(random, 8); },
            generate_bound_share},
    Promise{"project, exact: the nearest float, a decision", 25, begin_batch, project_exact_share},
    Promise{"project: the tolerance", 25, [](Random& random) { return with_tolerance(begin_batch(random), random); },
            project_within_share},
    Promise{"project: project_error_bound", 25,
            [](Random& random) { return with_tolerance(begin_batch(random), random); }, project_bound_share},
    Promise{"segment, exact: the nearest float, a decision", 9, begin_segment, segment_exact_share},
    Promise{"segment: the tolerance", 9, [](Random& random) { return with_tolerance(begin_segment(random), random); },
            segment_within_share},
    Promise{"segment: error_bound", 9, [](Random& random) { return with_tolerance(begin_segment(random), random); },
            segment_bound_share},
    Promise{"triangle, exact: the nearest float, a decision", 21, begin_triangle, triangle_exact_share},
    Promise{"triangle: the tolerance", 21,
            [](Random& random) { return with_tolerance(begin_triangle(random), random); },
            triangle_within_share<false>},
    Promise{"triangle: error_bound", 21, [](Random& random) { return with_tolerance(begin_triangle(random), random); },
            triangle_within_share<true>},
    Promise{"triangle: work, a decision", 21, begin_triangle, work_share},
    Promise{"footprint: error_bound", 21, begin_triangle, footprint_share<OfFootprints::bound>},
    Promise{"footprint: extremes", 21, begin_triangle, footprint_share<OfFootprints::extremes>},
    Promise{"footprint of ids: error_bound", 21, begin_triangle, footprint_share<OfFootprints::batch>},
    Promise{"box: coverage, a decision", 25, begin_batch, coverage_share},
    Promise{"inverse: 2 ulp of the largest term", 0, begin_matrix, inverse_share},
    Promise{"inverse: inverse_error_bound", 0, begin_matrix, inverse_bound_share},
    Promise{"pinhole: 4 ulp", 0, begin_pinhole, pinhole_share},
    Promise{"mirrored: 1 ulp, or 2^-96 of the terms", 0,
            [](Random& random) {
                Numbers n(20);
                for (double& x : n) x = random.uniform(-1.0, 1.0);
                return n;
            },
            mirrored_share},
    Promise{"eye planes: 0.54 ulp of the largest", 20, begin_planes, eye_planes_share},
    Promise{"clip to the slide: slide_clip_error", 24, [](Random& random) { return any_floats(random, 24); },
            clip_to_slide_share},
    Promise{"clip to near: 1/2 ulp + clip_error", 24, [](Random& random) { return any_floats(random, 24); },
            clip_to_near_share},
    Promise{"window_linear: 2^-47 of the terms", 3, begin_window, window_share},
    Promise{"depth_error_bound", 4, begin_depth, depth_bound_share},
    Promise{"facing: the exact sign, a decision", 12, begin_surface, facing_share},
    Promise{"slide_area: 2^-50 of itself", 12, begin_surface, slide_area_share},
    Promise{"receiver_plane: 2^-49 of itself", 12, begin_surface, receiver_plane_share},
    Promise{"quadrilateral: the homography's q, a decision", 0, support::detail::draw_quadrilateral,
            quadrilateral_share},
    Promise{"keystone: 2^-48 of its terms, a decision", 0, support::detail::draw_quadrilateral, keystone_share},
};

// The search

struct Find {
    Share share = says_nothing;
    Numbers numbers;
    long tried = 0;
};

// Climbs from many beginnings, and back to the best of them now and then; gives up a climb that stands still.
Find search(const Promise& promise, double seconds, std::uint64_t seed) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    Random random(seed);
    Find best;
    do {
        Numbers here = best.share >= 0.0 && random.integer(0, 3) == 0 ? best.numbers : promise.begin(random);
        Share share = promise.share(here);
        for (int idle = 0; idle < 400 && !(share > 1.0) && Clock::now() < end; ++idle) {
            const Numbers next = moved(promise.floats, here, random);
            if (!all_finite(next)) continue;
            const Share of_next = promise.share(next);
            ++best.tried;
            if (!(of_next >= share)) continue;
            if (of_next > share) idle = 0;
            here = next;
            share = of_next;
        }
        if (share > best.share) {
            best.share = share;
            best.numbers = here;
        }
    } while (!(best.share > 1.0) && Clock::now() < end);
    return best;
}

// Towards time

// Where a climb begins: the hard families of triangles serve as well.
Numbers begin(const support::Workload& workload, Random& random) {
    if (workload.hostile.draw != support::detail::draw_triangle || random.coin()) return workload.hostile.draw(random);
    const auto last = static_cast<int>(support::hard_families.size()) - 1;
    const support::Shot shot = support::hard_families[static_cast<std::size_t>(random.integer(0, last))].make(random);
    return support::detail::numbers(shot.triangle, static_cast<float>(shot.rect.x), static_cast<float>(shot.rect.y));
}

// Looks at the recorded inputs, and for some seconds climbs from the slowest of some beginnings, or from the slowest
// input so far.
std::vector<support::SlowInput> search(const support::Workload& workload,
                                       const std::vector<support::RecordedInput>& recorded, double seconds,
                                       std::uint64_t seed) {
    using Clock = std::chrono::steady_clock;
    Random random(seed);
    const support::Race race(workload);
    support::Slowest slowest(workload, race);
    const auto look = [&](const Numbers& numbers, const std::string& words = "found by a search") {
        const double ratio = race.glance(numbers);
        slowest.offer(numbers, ratio, words);
        return ratio;
    };
    for (const support::RecordedInput& input : recorded)
        if (input.function == workload.function) look(input.numbers, input.words);
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    while (Clock::now() < end) {
        Numbers here = begin(workload, random);
        double ratio = look(here);
        for (int i = 0; i < 8 && Clock::now() < end; ++i) {
            const auto known = static_cast<int>(slowest.inputs().size());
            const Numbers other =
                known == 0 || random.integer(0, 15) != 0
                    ? begin(workload, random)
                    : slowest.inputs()[static_cast<std::size_t>(random.integer(0, known - 1))].numbers;
            const double of_other = look(other);
            if (of_other <= ratio) continue;
            here = other;
            ratio = of_other;
        }
        for (int idle = 0; idle < 100 && Clock::now() < end; ++idle) {
            const Numbers next = moved(workload.floats, here, random);
            const double of_next = look(next);
            if (of_next < 0.98 * ratio) continue;
            if (of_next > 1.02 * ratio) idle = 0;
            here = next;
            ratio = std::max(ratio, of_next);
        }
    }
    return slowest.inputs();
}

// What is above its limit once has to be so again and again, and by more than noise.
bool is_above_limit(const support::Workload& workload, const support::SlowInput& input) {
    const double limit = support::limit::noise * input.limit;
    if (!(input.slowness.ratio() > limit)) return false;
    std::list<support::Race> races;  // all are kept, so that the arrays of each begin elsewhere
    for (int attempt = 0; attempt < 5; ++attempt)
        if (!(races.emplace_back(workload).measure(input.numbers, 40).ratio() > limit)) return false;
    return true;
}

bool near_cuts_keep_limits(const support::Workload& workload) {
    for (int attempt = 0;; ++attempt) {
        const support::NearCutTimes times = support::race_near_cuts(workload, 40);
        const bool kept = times.slowest.ratio() <= support::limit::near_plane &&
                          times.of_99_in_100.ratio() <= support::limit::near_plane_99_of_100 &&
                          times.rotation.ratio() <= support::limit::rotation &&
                          times.crossed.ratio() <= support::limit::q_is_zero;
        if (!kept && attempt < 2) continue;
        std::printf(
            "%s cut by the near plane: %.1f at most (%g), %.1f for 99 of 100 (%g), %.1f between rotations (%g), %.1f "
            "where q = 0 "
            "crosses (%g)\n",
            workload.function, times.slowest.ratio(), support::limit::near_plane, times.of_99_in_100.ratio(),
            support::limit::near_plane_99_of_100, times.rotation.ratio(), support::limit::rotation,
            times.crossed.ratio(), support::limit::q_is_zero);
        return kept;
    }
}

bool is_one_of(std::string_view name, std::string_view names) {
    while (!names.empty()) {
        const std::string_view first = names.substr(0, names.find('|'));
        if (name == first) return true;
        names.remove_prefix(std::min(names.size(), first.size() + 1));
    }
    return false;
}

bool search_towards_time(double seconds, std::uint64_t seed, std::string_view only, std::string_view excepted) {
    const auto is_asked_for = [&](const support::Workload& workload) {
        return std::string_view(workload.function).find(only) != std::string_view::npos;
    };
    std::ifstream file(TEXGEN_TEST_DATA "/promises/worst_inputs.txt");
    const std::vector<support::RecordedInput> recorded = support::read_inputs(file);
    const auto count = std::count_if(support::workloads.begin(), support::workloads.end(), is_asked_for);
    bool all_kept = true;
    for (const support::Workload& workload : support::workloads) {
        if (!is_asked_for(workload)) continue;
        const bool is_excepted = is_one_of(workload.function, excepted);
        if (workload.takes_near_cuts() && !near_cuts_keep_limits(workload) && !is_excepted) all_kept = false;
        for (const support::SlowInput& input : search(workload, recorded, seconds / static_cast<double>(count), seed)) {
            const bool is_above = is_above_limit(workload, input);
            all_kept = all_kept && (is_excepted || !is_above);
            const char* verdict = is_above ? is_excepted ? "EXCEPTED," : "BROKEN," : "kept,";
            std::printf("%s %.1f times the ordinary %.1f ns, limit %g: %s | %s |", verdict, input.slowness.ratio(),
                        input.slowness.ordinary, input.limit, workload.function, input.words.c_str());
            for (const double number : input.numbers) std::printf(" %a", number);
            std::printf("\n");
            std::fflush(stdout);
        }
    }
    return all_kept;
}

bool search_towards_error(double seconds, std::uint64_t seed, std::string_view only) {
    bool all_kept = true;
    for (const Promise& promise : promises) {
        if (std::string_view(promise.name).find(only) == std::string_view::npos) continue;
        const Find worst = search(promise, seconds / static_cast<double>(promises.size()), seed);
        const bool kept = worst.share >= 0.0 && worst.share <= 1.0;
        all_kept = all_kept && kept;
        std::printf("%-48s %s %.6f of it after %ld inputs:", promise.name, kept ? "kept," : "BROKEN,", worst.share,
                    worst.tried);
        for (const double number : worst.numbers) std::printf(" %a", number);
        std::printf("\n");
        std::fflush(stdout);
    }
    return all_kept;
}

}  // namespace

int main(int count, char** arguments) {
    double seconds = 5.0;
    std::uint64_t seed = 1;
    std::string_view only, excepted, towards = "error";
    for (int i = 1; i + 1 < count; i += 2) {
        const std::string_view option = arguments[i];
        if (option == "--seconds") seconds = std::atof(arguments[i + 1]);
        if (option == "--seed") seed = std::strtoull(arguments[i + 1], nullptr, 10);
        if (option == "--only") only = arguments[i + 1];
        if (option == "--but") excepted = arguments[i + 1];
        if (option == "--towards") towards = arguments[i + 1];
    }
    const bool all_kept = towards == "time" ? search_towards_time(seconds, seed, only, excepted)
                                            : search_towards_error(seconds, seed, only);
    if (std::ferror(stdout) != 0) {
        std::fputs("adversary: cannot write to standard output\n", stderr);
        return EXIT_FAILURE;
    }
    return all_kept ? EXIT_SUCCESS : EXIT_FAILURE;
}
