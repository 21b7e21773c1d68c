// Footprints: derivatives judged exactly and by 400-bit differences, what filters make of them, and their extremes.

#include "texgen/footprint.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "judges/fragments.hpp"
#include "judges/real.hpp"
#include "support/footprint_outputs.hpp"
#include "support/hard_triangles.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/batch.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::count_of;
using support::Dyadic;
using support::everywhere;
using support::ExactTriangle;
using support::FootprintOutputs;
using support::hex;
using support::Homogeneous;
using support::infinity_double;
using support::nan_double;
using support::Random;
using support::Real;
using support::same_bits;
using support::setup_of;
using support::Shot;
using texgen::Footprint;
using texgen::FootprintExtremes;
using texgen::Footprints;
using texgen::FootprintSetup;
using texgen::FragmentRect;
using texgen::TexelsPerUnit;
using texgen::Tolerance;
using texgen::Triangle;
using texgen::TriangleSetup;
using texgen::WindowVertex;

// Where each output of a batch stands in the arrays below.
enum Output : std::size_t { dsdx, dtdx, dsdy, dtdy, level, anisotropy, major_s, major_t };

// The Jacobian exactly, but for its last division: numerators over q^2, in units of s and t.
struct ExactFootprint {
    Real dx[2], dy[2];

    static Real real(const Dyadic& value) { return Real(value.rational()); }

    // S, T and Q are affine, so differences of neighbours are their slopes exactly.
    ExactFootprint(const ExactTriangle& exact, std::int64_t x, std::int64_t y) {
        const Homogeneous here = exact.at(x, y), right = exact.at(x + 1, y), up = exact.at(x, y + 1);
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

double distance(double computed, const Real& exact) { return static_cast<double>(abs(Real(computed) - exact)); }

// q/w at a fragment relative to the largest of its terms: how far away from q = 0 it is.
double distance_from_zero(const Triangle& triangle, double x, double y) {
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

std::string text(const TexelsPerUnit& texels) { return "texels " + hex(texels.s) + ", " + hex(texels.t); }

TexelsPerUnit some_texels(Random& random) {
    return {std::ldexp(1.0, random.integer(0, 13)) * (random.coin() ? 1.0 : random.uniform(0.6, 1.4)),
            std::ldexp(1.0, random.integer(0, 13))};
}

// A parallelogram of the window with w = 1, so that q is affine; s/q, t/q and q given at its corners.
Triangle flat(const std::array<glm::vec2, 3>& window, const std::array<glm::vec3, 3>& stq) {
    Triangle triangle{};
    const auto corner = support::vertices(triangle);
    for (std::size_t i = 0; i < 3; ++i)
        *corner[i] = {window[i], 1.0f, {stq[i].x * stq[i].z, stq[i].y * stq[i].z, 0.0f, stq[i].z}};
    return triangle;
}

// A window-filling triangle in front: q/w varies by up to `ratio`, s and t by ordinary amounts.
Triangle spread_triangle(Random& random, double ratio) {
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

// Makes the third corner's q what has q at a pixel be this share of its term.
void make_q_small(Triangle& triangle, const FragmentRect& pixel, double share) {
    const double x = pixel.x + 0.5, y = pixel.y + 0.5;
    const auto corner = support::vertices(triangle);
    double part[3], rest = 0.0;
    for (std::size_t v = 0; v < 3; ++v) {
        const WindowVertex &j = *corner[(v + 1) % 3], &k = *corner[(v + 2) % 3];
        part[v] = ((static_cast<double>(j.window.x) - x) * (static_cast<double>(k.window.y) - y) -
                   (static_cast<double>(j.window.y) - y) * (static_cast<double>(k.window.x) - x)) /
                  static_cast<double>(corner[v]->clip_w);
        if (v < 2) rest += part[v] * static_cast<double>(corner[v]->strq.w);
    }
    triangle.c.strq.w = support::to_float(-rest / part[2] * (1.0 + share));
}

bool contains_centre(const Triangle& triangle, int x, int y) {
    const auto corner = support::vertices(triangle);
    const double side = support::twice_area(triangle);
    for (std::size_t i = 0; i < 3; ++i) {
        Triangle part = triangle;
        support::vertices(part)[i]->window = glm::vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        if (support::twice_area(part) * side < 0.0) return false;
    }
    return corner[0] != nullptr;
}

// The footprints of a shot's triangle among those of others, in short runs; returns which fragments have it, by id 0.
std::vector<std::uint32_t> fill_among_others(const Shot& shot, const TexelsPerUnit& texels, Random& random,
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

}  // namespace

TEST_CASE("derivatives are the exact ones within the stated bound, for every hard family") {
    bool is_in_buffer = false;
    SUBCASE("by a set-up") {}
    SUBCASE("in a visibility buffer") { is_in_buffer = true; }
    std::uint64_t seed = 6000;
    int checked = 0, behind = 0, unbounded = 0, next_to_zero = 0;
    double worst = 0.0;
    for (const support::HardFamily& family : support::hard_families) {
        Random random(++seed);
        int hard = 0, away = 0;
        double worst_away = 0.0;
        constexpr int shots = 60;
        for (int i = 0; i < shots; ++i) {
            const Shot shot = family.make(random);
            const ExactTriangle exact(shot.triangle);
            hard += family.is_hard(shot, exact);
            const TexelsPerUnit texels = some_texels(random);
            const FootprintSetup setup(setup_of(shot.triangle), texels);
            const glm::dvec2 bound = setup.error_bound(shot.rect);
            FootprintOutputs out(shot.rect, FootprintOutputs::all, static_cast<std::size_t>(random.integer(0, 15)));
            std::vector<std::uint32_t> ids;
            bool written = true;
            if (is_in_buffer)
                ids = fill_among_others(shot, texels, random, out);
            else
                written = footprint(setup, shot.rect, out.spans());
            REQUIRE(out.pads_are_intact());
            if (!written) REQUIRE(out.is_untouched());
            const std::size_t step = count_of(shot.rect) / 6 + 1;
            for (std::size_t k = static_cast<std::size_t>(random.integer(0, 2)); k < count_of(shot.rect); k += step) {
                const std::int64_t x = shot.x(static_cast<std::int64_t>(k) % shot.rect.width);
                const std::int64_t y = shot.y(static_cast<std::int64_t>(k) / shot.rect.width);
                if (!exact.has_positive_w(x, y) || (is_in_buffer && ids[k] != 0)) continue;
                const std::string context = std::string(family.name) + " " + text(texels) + ", fragment " +
                                            std::to_string(x) + " " + std::to_string(y) + " of " + hex(shot);
                if (exact.at(x, y).q.sign() <= 0) {
                    ++behind;
                    for (std::size_t o = 0; o < 8 && written; ++o) REQUIRE_MESSAGE(same_bits(out[o][k], 0.0f), context);
                    continue;
                }
                REQUIRE_MESSAGE(written, context);
                ++checked;
                const ExactFootprint truth(exact, x, y);
                const double zero =
                    distance_from_zero(shot.triangle, static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
                for (std::size_t c = 0; c < 2; ++c) {
                    const double error = std::max(distance(out.at(dsdx + c, k), truth.dx[c]),
                                                  distance(out.at(dsdy + c, k), truth.dy[c]));
                    if (std::isnan(error) || std::isinf(error)) continue;  // beyond the range of float
                    const auto norm = static_cast<double>(truth.norm(c));
                    const double allowed =
                        bound[static_cast<int>(c)] + (is_in_buffer ? texgen::batch_footprint_error * norm : 0.0);
                    REQUIRE_MESSAGE(error <= allowed, context << " error " << error << " allowed " << allowed);
                    unbounded += std::isinf(allowed);
                    if (!std::isinf(allowed)) worst = std::max(worst, error / allowed);
                    // Next to q = 0 there is no bound from doubles, but exact sums.
                    if (std::isinf(allowed) && family.name[0] == 'q' && norm < 1e30) {
                        ++next_to_zero;
                        REQUIRE_MESSAGE(error <= 1e-5 * norm, context);
                    }
                    if (zero > 1e-4 && norm > 1e-30) {
                        ++away;
                        worst_away = std::max(worst_away, error / norm);
                    }
                }
            }
        }
        INFO(family.name);
        CHECK(hard >= family.least_share * shots * 0.6);
        if (family.least_share == 1.0) CHECK(away > (is_in_buffer ? 60 : 100));
        CHECK(worst_away <= 1e-5);
        MESSAGE(std::string(family.name), ": away from q = 0 the largest relative error is ", worst_away, " in ", away);
    }
    MESSAGE(checked, " fragments, ", behind, " behind, ", unbounded, " without a bound; worst error ", worst,
            " of its bound");
    CHECK(checked > (is_in_buffer ? 2000 : 3000));
    CHECK(behind > (is_in_buffer ? 150 : 200));
    CHECK(worst > 0.5);
    CHECK(unbounded < checked / 3);
    CHECK(next_to_zero > (is_in_buffer ? 150 : 200));
}

TEST_CASE("derivatives agree with 400-bit differences of the definition to 1e-5") {
    Random random(6100);
    double worst = 0.0;
    int checked = 0, mirrored = 0, orthographic = 0, steep = 0, tiny = 0, far = 0;
    for (int i = 0; i < 1500; ++i) {
        const auto family = support::families[static_cast<std::size_t>(i) % support::families.size()];
        Triangle triangle = support::make_triangle(family, random);
        if (i % 5 == 1)  // far from the origin of the window
            for (WindowVertex* vertex : support::vertices(triangle)) vertex->window += glm::vec2(16384.0f, -30000.0f);
        if (i % 5 == 2)  // some pixels large
            for (WindowVertex* vertex : support::vertices(triangle)) vertex->window *= 1.0f / 256.0f;
        const FragmentRect pixel = support::pixel_near(triangle, random);
        const double x = pixel.x + 0.5, y = pixel.y + 0.5;
        if (distance_from_zero(triangle, x, y) < 1e-4) continue;
        const FootprintSetup setup(setup_of(triangle), {256.0, 256.0});
        const auto footprint = setup.at(pixel.x, pixel.y);
        const auto corner = support::vertices(triangle);
        // s/q and t/q from the definition: barycentric coordinates over w.
        const auto quotient = [&](const Real& px, const Real& py, int coordinate) {
            Real numerator = 0, denominator = 0;
            for (std::size_t v = 0; v < 3; ++v) {
                const WindowVertex &j = *corner[(v + 1) % 3], &k = *corner[(v + 2) % 3];
                const Real weight = ((Real(j.window.x) - px) * (Real(k.window.y) - py) -
                                     (Real(j.window.y) - py) * (Real(k.window.x) - px)) /
                                    Real(corner[v]->clip_w);
                numerator += weight * Real(corner[v]->strq[coordinate]);
                denominator += weight * Real(corner[v]->strq.w);
            }
            return Real(numerator / denominator);
        };
        if (!footprint) continue;
        const bool well_away = distance_from_zero(triangle, x, y) > 0.1 && family != support::Family::sliver;
        const Real h = ldexp(Real(1), -90);
        for (int c = 0; c < 2; ++c) {
            const Real dx = (quotient(Real(x) + h, y, c) - quotient(Real(x) - h, y, c)) / (2 * h);
            const Real dy = (quotient(x, Real(y) + h, c) - quotient(x, Real(y) - h, c)) / (2 * h);
            const auto norm = static_cast<double>(sqrt(Real(dx * dx + dy * dy)));
            const double error = std::max(distance(footprint->dx[c], dx), distance(footprint->dy[c], dy)) / norm;
            worst = std::max(worst, error);
            REQUIRE_MESSAGE(error <= (well_away ? 1e-11 : 1e-5), hex(triangle)
                                                                     << " fragment " << pixel.x << " " << pixel.y);
        }
        ++checked;
        mirrored += support::twice_area(triangle) < 0.0;
        orthographic += family == support::Family::parallel;
        steep += support::detail::spread(triangle, [](const WindowVertex& v) { return v.strq.w; }) > 100.0;
        tiny += std::fabs(support::twice_area(triangle)) < 16.0;
        far += triangle.a.window.x > 10000.0f;
    }
    MESSAGE(checked, " fragments, worst relative error ", worst);
    CHECK(checked > 900);
    for (const int count : {mirrored, orthographic, steep, tiny, far}) CHECK(count > 80);
}

TEST_CASE("level, anisotropy and major axis are those of the exact Jacobian") {
    bool is_in_buffer = false;
    SUBCASE("by a set-up") {}
    SUBCASE("in a visibility buffer") { is_in_buffer = true; }
    Random random(6200);
    int circular = 0, thin = 0, magnified = 0, minified = 0, checked = 0;
    double worst_level = 0.0, worst_anisotropy = 0.0, worst_major = 0.0;
    for (int i = 0; i < 500; ++i) {
        const auto family = support::families[static_cast<std::size_t>(i) % support::families.size()];
        Triangle triangle = i % 3 == 0 ? spread_triangle(random, random.power_of_ten(0.0, 3.0))
                                       : support::make_triangle(family, random);
        if (i % 11 == 0)  // squares of the window are squares of the texture
            triangle = flat({glm::vec2(0, 0), glm::vec2(512, 0), glm::vec2(0, 512)},
                            {glm::vec3(0, 0, 1), glm::vec3(1, 0, 1), glm::vec3(0, 1, 1)});
        if (i % 11 == 1)  // the t of all corners is nearly a function of their s
            for (WindowVertex* vertex : support::vertices(triangle))
                vertex->strq.y = vertex->strq.x * (1.0f + random.uniform_float(-1e-6, 1e-6));
        const FragmentRect pixel = support::pixel_near(triangle, random);
        const bool large = random.coin();
        const Shot shot{triangle,
                        {pixel.x - random.integer(0, 20), pixel.y - (large ? random.integer(0, 60) : 0),
                         random.integer(1, large ? 600 : 50), large ? random.integer(1, 100) : 2}};
        const TexelsPerUnit texels = i % 11 == 0 ? TexelsPerUnit{256.0, 256.0} : some_texels(random);
        const ExactTriangle exact(triangle);
        const FootprintSetup setup(setup_of(triangle), texels);
        FootprintOutputs out(shot.rect);
        std::vector<std::uint32_t> ids;
        if (is_in_buffer)
            ids = fill_among_others(shot, texels, random, out);
        else if (!footprint(setup, shot.rect, out.spans()))
            continue;
        for (std::size_t k = 0; k < count_of(shot.rect); k += 1 + count_of(shot.rect) / 5) {
            const std::int64_t x = shot.x(static_cast<std::int64_t>(k) % shot.rect.width);
            const std::int64_t y = shot.y(static_cast<std::int64_t>(k) / shot.rect.width);
            if (is_in_buffer && ids[k] != 0) continue;
            if (!exact.has_positive_w(x, y) || exact.at(x, y).q.sign() <= 0) continue;
            if (distance_from_zero(triangle, static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5) < 1e-3)
                continue;
            const ExactFootprint truth(exact, x, y);
            const ExactFootprint::Shape shape = truth.shape(texels);
            const auto rho = static_cast<double>(shape.rho), ratio = static_cast<double>(shape.largest / shape.least);
            const auto length = static_cast<double>(shape.largest);
            const std::string context =
                text(texels) + ", fragment " + std::to_string(x) + " " + std::to_string(y) + " of " + hex(shot);
            ++checked;
            // What the bound on the derivatives leaves open, in levels and relative.
            const glm::dvec2 bound = setup.error_bound({static_cast<int>(x), static_cast<int>(y), 1, 1});
            const double open = 2.0 * std::max(bound.x * texels.s, bound.y * texels.t) / rho;
            if (!(open < 1e-3)) continue;
            const double exact_level = std::log2(rho);
            const double level_error = std::fabs(out.at(level, k) - exact_level);
            const double level_allowed = 0x1p-16 * std::max(1.0, std::fabs(exact_level) / 32.0) + 1.5 * open;
            worst_level = std::max(worst_level, level_error / level_allowed);
            REQUIRE_MESSAGE(level_error <= level_allowed, context);
            if (ratio < 1e30) {
                const double ratio_error = std::fabs(out.at(anisotropy, k) / ratio - 1.0);
                worst_anisotropy = std::max(worst_anisotropy, ratio_error / (0x1p-16 + 2.0 * open));
                REQUIRE_MESSAGE(ratio_error <= 0x1p-16 + 2.0 * open, context);
            }
            // Its length is the larger singular value, and J J^T maps it to itself times the square of that.
            const double m[2] = {out.at(major_s, k) * texels.s, out.at(major_t, k) * texels.t};
            const auto image = [&](std::size_t c) {
                const double scale_c = c == 0 ? texels.s : texels.t;
                double sum = 0.0;
                for (std::size_t j = 0; j < 2; ++j) {
                    const double scale_j = j == 0 ? texels.s : texels.t;
                    sum += static_cast<double>(truth.dx[c] * truth.dx[j] + truth.dy[c] * truth.dy[j]) * scale_c *
                           scale_j * m[j];
                }
                return sum / (length * length);
            };
            const double major_error =
                std::max(std::fabs(std::hypot(m[0], m[1]) - length), std::hypot(image(0) - m[0], image(1) - m[1])) /
                length;
            worst_major = std::max(worst_major, major_error / (0x1p-16 + 4.0 * open));
            REQUIRE_MESSAGE(major_error <= 0x1p-16 + 4.0 * open, context);

            const auto one = setup.at(static_cast<int>(x), static_cast<int>(y));
            REQUIRE(one.has_value());
            CHECK(std::fabs(one->level - exact_level) <= 1e-9 + 1.5 * open);
            CHECK(std::fabs(one->singular_values.x / length - 1.0) <= 1e-9 + 2.0 * open);
            CHECK(std::fabs(one->singular_values.y - static_cast<double>(shape.least)) <= (1e-9 + 2.0 * open) * length);
            if (ratio < 1e30) CHECK(std::fabs(one->anisotropy / ratio - 1.0) <= 1e-6 + 2.0 * open);
            circular += ratio < 1.000001;
            thin += ratio > 1e4;
            magnified += rho < 0.5;
            minified += rho > 2.0;
        }
    }
    MESSAGE(checked, " fragments; of their bounds: level ", worst_level, ", anisotropy ", worst_anisotropy, ", major ",
            worst_major);
    CHECK(checked > 1000);
    for (const int count : {circular, thin, magnified, minified}) CHECK(count > 40);
}

TEST_CASE("where the derivatives of a row nearly vanish at one fragment, it is as right as the others") {
    // S = x - 200.5 and Q = y - (100.5 - 2^-20): along the row Q does not vary, and both columns vanish with the
    // distance from a point 2^-20 of a pixel from the centre of fragment (200, 100).
    Triangle triangle{};
    const std::array window{glm::vec2(0, 100), glm::vec2(400, 100), glm::vec2(200, 101)};
    const auto corner = support::vertices(triangle);
    for (std::size_t i = 0; i < 3; ++i) {
        const float s = window[i].x - 200.5f;
        *corner[i] = {window[i], 1.0f, {s, 0.75f * s, 0.0f, (window[i].y - 100.5f) + 0x1p-20f}};
    }
    const Shot shot{triangle, {150, 100, 100, 1}};
    const TexelsPerUnit texels{256.0, 128.0};
    const ExactTriangle exact(triangle);
    for (const Tolerance tolerance : {texgen::exact, Tolerance{1e-3}}) {
        const FootprintSetup setup(setup_of(triangle, everywhere(), tolerance), texels);
        FootprintOutputs out(shot.rect);
        REQUIRE(footprint(setup, shot.rect, out.spans()));
        for (std::size_t k = 0; k < 100; ++k) {
            const ExactFootprint truth(exact, 150 + static_cast<std::int64_t>(k), 100);
            const ExactFootprint::Shape shape = truth.shape(texels);
            INFO("fragment ", k);
            REQUIRE(std::fabs(out.at(level, k) - std::log2(static_cast<double>(shape.rho))) <= 0x1p-16 * 2.0);
            const double length = std::hypot(out.at(major_s, k) * texels.s, out.at(major_t, k) * texels.t);
            REQUIRE(std::fabs(length / static_cast<double>(shape.largest) - 1.0) <= 0x1p-16);
            REQUIRE(out.at(anisotropy, k) == infinity_double);
        }
    }
}

TEST_CASE("coordinates that are large everywhere leave the anisotropy its digits") {
    Random random(6250);
    double worst = 0.0;
    int checked = 0;
    for (int i = 0; i < 300; ++i) {
        const Triangle triangle = support::make_triangle(support::Family::far_away, random);
        const FragmentRect pixel = support::pixel_near(triangle, random);
        const TexelsPerUnit texels{256.0, 256.0};
        const FootprintSetup setup(setup_of(triangle), texels);
        const auto one = setup.at(pixel.x, pixel.y);
        const ExactTriangle exact(triangle);
        if (!one || !exact.has_positive_w(pixel.x, pixel.y)) continue;
        const ExactFootprint::Shape shape = ExactFootprint(exact, pixel.x, pixel.y).shape(texels);
        const double error = std::fabs(one->anisotropy / static_cast<double>(shape.largest / shape.least) - 1.0);
        worst = std::max(worst, error);
        ++checked;
        REQUIRE_MESSAGE(error <= 1e-12, hex(triangle) << " fragment " << pixel.x << " " << pixel.y);
    }
    MESSAGE(checked, " fragments, worst relative error of the anisotropy ", worst);
    CHECK(checked > 200);
}

TEST_CASE("a tolerance is kept in units a pixel, and some of it is used") {
    std::uint64_t seed = 6300;
    int checked = 0, differ = 0;
    for (const support::HardFamily& family : support::hard_families) {
        Random random(++seed);
        for (int i = 0; i < 40; ++i) {
            const Shot shot = family.make(random);
            const ExactTriangle exact(shot.triangle);
            const double tolerance = random.power_of_ten(-8.0, -2.0);
            const FootprintSetup setup(setup_of(shot.triangle, everywhere(), Tolerance{tolerance}), {1024.0, 1024.0});
            const FootprintSetup strict(setup_of(shot.triangle), {1024.0, 1024.0});
            FootprintOutputs out(shot.rect), of_exact(shot.rect);
            if (!footprint(setup, shot.rect, out.spans())) continue;
            footprint(strict, shot.rect, of_exact.spans());
            const glm::dvec2 bound = setup.error_bound(shot.rect);
            for (std::size_t k = 0; k < count_of(shot.rect); k += 1 + count_of(shot.rect) / 4) {
                const std::int64_t x = shot.x(static_cast<std::int64_t>(k) % shot.rect.width);
                const std::int64_t y = shot.y(static_cast<std::int64_t>(k) / shot.rect.width);
                if (!exact.has_positive_w(x, y) || exact.at(x, y).q.sign() <= 0) continue;
                const ExactFootprint truth(exact, x, y);
                for (std::size_t c = 0; c < 2; ++c) {
                    const double error = std::max(distance(out.at(dsdx + c, k), truth.dx[c]),
                                                  distance(out.at(dsdy + c, k), truth.dy[c]));
                    if (std::isnan(error) || std::isinf(error)) continue;
                    REQUIRE_MESSAGE(error <= bound[static_cast<int>(c)], family.name << " " << hex(shot));
                    ++checked;
                    differ += !same_bits(out[dsdx + c][k], of_exact[dsdx + c][k]);
                }
            }
        }
    }
    MESSAGE(checked, " derivatives, ", differ, " with other bits than those of exact");
    CHECK(checked > 2000);
    CHECK(differ > 300);
}

TEST_CASE("a tolerance of a few units of the derivatives is kept, where floats just serve or just do not") {
    Random random(6350);
    int in_float = 0, in_double = 0;
    for (int i = 0; i < 600; ++i) {
        const Triangle triangle = spread_triangle(random, random.uniform(1.0, 2.0));
        const FragmentRect pixel = support::pixel_near(triangle, random);
        const Shot shot{triangle, {pixel.x, pixel.y, 24, 2}};
        const ExactTriangle exact(triangle);
        const FootprintSetup strict(setup_of(triangle), {1.0, 1.0});
        const glm::dvec2 unit = strict.error_bound(shot.rect);
        if (!std::isfinite(unit.x) || !std::isfinite(unit.y)) continue;
        const Tolerance tolerance{std::max(unit.x, unit.y) * random.power_of_ten(0.0, 1.5)};
        const FootprintSetup setup(setup_of(triangle, everywhere(), tolerance), {1.0, 1.0});
        FootprintOutputs out(shot.rect), of_exact(shot.rect);
        if (!footprint(setup, shot.rect, out.spans())) continue;
        footprint(strict, shot.rect, of_exact.spans());
        bool differs = false;
        for (std::size_t o = 0; o < 4; ++o) differs = differs || !same_bits(out[o], of_exact[o]);
        ++(differs ? in_float : in_double);
        const glm::dvec2 bound = setup.error_bound(shot.rect);
        for (std::size_t k = 0; k < count_of(shot.rect); k += 5) {
            const std::int64_t x = shot.x(static_cast<std::int64_t>(k) % shot.rect.width);
            const std::int64_t y = shot.y(static_cast<std::int64_t>(k) / shot.rect.width);
            if (!exact.has_positive_w(x, y) || exact.at(x, y).q.sign() <= 0) continue;
            const ExactFootprint truth(exact, x, y);
            for (std::size_t c = 0; c < 2; ++c) {
                const double error =
                    std::max(distance(out.at(dsdx + c, k), truth.dx[c]), distance(out.at(dsdy + c, k), truth.dy[c]));
                REQUIRE_MESSAGE(error <= bound[static_cast<int>(c)], hex(tolerance.value) << " " << hex(shot));
            }
        }
    }
    CHECK(in_float > 100);
    CHECK(in_double > 100);
}

TEST_CASE("where q has few digits left the bound of a derivative has them in it") {
    Random random(6360);
    int close = 0;
    for (int i = 0; i < 20000; ++i) {
        Triangle triangle = spread_triangle(random, 3.0);
        const FragmentRect pixel = support::pixel_near(triangle, random);
        make_q_small(triangle, pixel, std::ldexp(random.integer(-4, 4), random.coin() ? -23 : -11));
        const FootprintSetup setup(setup_of(triangle), {1.0, 1.0});
        const glm::dvec2 bound = setup.error_bound(pixel);
        FootprintOutputs out(pixel);
        if (!std::isfinite(bound.x) || !footprint(setup, pixel, out.spans())) continue;
        const ExactTriangle exact(triangle);
        if (!exact.has_positive_w(pixel.x, pixel.y) || exact.at(pixel.x, pixel.y).q.sign() <= 0) continue;
        ++close;
        const ExactFootprint truth(exact, pixel.x, pixel.y);
        for (std::size_t c = 0; c < 2; ++c) {
            const double error =
                std::max(distance(out.at(dsdx + c, 0), truth.dx[c]), distance(out.at(dsdy + c, 0), truth.dy[c]));
            if (std::isfinite(error)) REQUIRE_MESSAGE(error <= bound[static_cast<int>(c)], hex(triangle));
        }
        // In double it holds without the rounding to float, of the larger derivative.
        const auto one = setup.at(pixel.x, pixel.y);
        REQUIRE(one.has_value());
        for (int c = 0; c < 2; ++c) {
            const auto k = static_cast<std::size_t>(c);
            const double rounding = 0x1p-24 * std::max(std::fabs(one->dx[c]), std::fabs(one->dy[c])) + 0x1p-150;
            const double error = std::max(distance(one->dx[c], truth.dx[k]), distance(one->dy[c], truth.dy[k]));
            REQUIRE_MESSAGE(error <= bound[c] - rounding, hex(triangle));
        }
    }
    CHECK(close > 1000);
}

TEST_CASE(
    "the bound of derivatives holds in double where the planes leave digits of q in a part of the rectangle alone") {
    // Of a large triangle q varies by little from one fragment to the next, and is about 2^-12 of its terms.
    Random random(6370);
    int checked = 0;
    double worst = 0.0;
    for (int i = 0; i < 3000; ++i) {
        Triangle triangle = spread_triangle(random, 3.0);
        for (WindowVertex* const vertex : support::vertices(triangle)) vertex->window *= 0x1p10f;
        const FragmentRect pixel = support::pixel_near(triangle, random);
        make_q_small(triangle, pixel, random.uniform(-1.0, 1.0) * std::exp2(random.uniform(-14.0, -9.0)));
        const FragmentRect row{pixel.x, pixel.y, 64, 1};
        const FootprintSetup setup(setup_of(triangle), {1.0, 1.0});
        const ExactTriangle exact(triangle);
        const auto q_at = [&](int x) { return exact.at(x, row.y).q.estimate(); };
        const int last = row.x + row.width - 1;
        const double least_q = std::min(q_at(row.x), q_at(last));
        const glm::dvec2 bound = setup.error_bound(row);
        if (!(least_q > 0.0) || !std::isfinite(bound.x)) continue;
        const ExactFootprint truth[2] = {ExactFootprint(exact, row.x, row.y), ExactFootprint(exact, last, row.y)};
        const int x[2] = {row.x, last};
        for (int c = 0; c < 2; ++c) {
            const auto k = static_cast<std::size_t>(c);
            // What is rounded to a float at most: the largest numerator over the square of the least q.
            double largest = 0.0;
            for (std::size_t end = 0; end < 2; ++end) {
                const double scale = q_at(x[end]) / least_q;
                const double size = std::max(distance(0.0, truth[end].dx[k]), distance(0.0, truth[end].dy[k]));
                largest = std::max(largest, size * scale * scale);
            }
            for (std::size_t end = 0; end < 2; ++end) {
                const auto one = setup.at(x[end], row.y);
                REQUIRE(one.has_value());
                const double error =
                    std::max(distance(one->dx[c], truth[end].dx[k]), distance(one->dy[c], truth[end].dy[k]));
                const double in_double = bound[c] - (0x1p-24 * largest + 0x1p-150);
                REQUIRE_MESSAGE(error <= in_double, hex(triangle));
                worst = std::max(worst, error / in_double);
                ++checked;
            }
        }
    }
    CHECK(checked > 1000);
    CHECK(worst > 0.01);
}

TEST_CASE("a fragment where q is 0, of terms with more bits than two doubles and residues have, has no footprint") {
    Random random(5350);
    for (int i = 0; i < 300; ++i) {
        // It is a fourth of the way between two corners, where 3 c and -c cancel for q = c w; the third has bits for
        // nothing.
        const int x = random.integer(-100, 100), y = random.integer(-100, 100);
        const auto of_20_bits = [&](double size) {
            return std::ldexp(static_cast<float>(random.integer(1 << 19, 1 << 20)), std::ilogb(size) - 19);
        };
        const float dx = of_20_bits(60.0), dy = random.coin() ? of_20_bits(60.0) : -of_20_bits(60.0);
        const auto corner = [&](float at_x, float at_y, float over_w) {
            const float clip_w = of_20_bits(1.0);
            const glm::vec4 strq(random.uniform_float(0.0, 1.0), random.uniform_float(0.0, 1.0), 0.5f, over_w * clip_w);
            return WindowVertex{{at_x, at_y}, clip_w, strq};
        };
        const float middle_x = static_cast<float>(x) + 0.5f, middle_y = static_cast<float>(y) + 0.5f;
        const float tiny = std::ldexp(random.uniform_float(-1.0, 1.0), random.integer(-100, -60));
        const Shot shot{
            {corner(middle_x + 3.0f * dx, middle_y + 3.0f * dy, 3.0f), corner(middle_x - dx, middle_y - dy, -1.0f),
             corner(tiny, random.uniform_float(500.0, 900.0), 1.0f)},
            {x, y, 1, 1}};
        REQUIRE(ExactTriangle(shot.triangle).at(x, y).q.sign() == 0);
        CHECK_MESSAGE(!FootprintSetup(setup_of(shot.triangle), {1024.0, 1024.0}).at(x, y).has_value(), hex(shot));
    }
}

TEST_CASE("only what is asked for is written, the same whatever else is asked for, in any rectangle and alignment") {
    Random random(6400);
    for (int i = 0; i < 300; ++i) {
        const Shot shot = support::detail::ordinary(
            support::families[static_cast<std::size_t>(i) % support::families.size()], random);
        const FootprintSetup setup(setup_of(shot.triangle), some_texels(random));
        FootprintOutputs all(shot.rect);
        const bool written = footprint(setup, shot.rect, all.spans());
        const auto asked = static_cast<unsigned>(random.integer(0, 255));
        FootprintOutputs some(shot.rect, asked, static_cast<std::size_t>(random.integer(0, 15)));
        REQUIRE(footprint(setup, shot.rect, some.spans()) == written);
        REQUIRE(some.pads_are_intact());
        for (std::size_t k = 0; k < 8; ++k)
            if (((asked >> k) & 1u) != 0u)
                for (std::size_t f = 0; f < count_of(shot.rect); ++f)
                    REQUIRE_MESSAGE(
                        (same_bits(some[k][f], all[k][f]) ||
                         (k >= 4 && std::fabs(some.at(k, f) - all.at(k, f)) <= 1e-5 * std::fabs(all.at(k, f)))),
                        hex(shot));
    }
}

TEST_CASE("the footprints of a column are those that it has in a wider rectangle") {
    Random random(6401);
    for (int i = 0; i < 200; ++i) {
        Shot shot = support::detail::ordinary(support::families[static_cast<std::size_t>(i) % support::families.size()],
                                              random);
        shot.rect.width = 3;
        shot.rect.height = random.integer(2, 90);
        const FootprintSetup setup(setup_of(shot.triangle), some_texels(random));
        FootprintOutputs wide(shot.rect);
        if (!footprint(setup, shot.rect, wide.spans())) continue;
        for (int x = 0; x < 3; ++x) {
            const FragmentRect column{shot.rect.x + x, shot.rect.y, 1, shot.rect.height};
            FootprintOutputs of_column(column);
            if (!footprint(setup, column, of_column.spans())) continue;
            REQUIRE(of_column.pads_are_intact());
            for (std::size_t y = 0; y < count_of(column); ++y) {
                const std::size_t f = 3 * y + static_cast<std::size_t>(x);
                const double length = std::hypot(wide.at(6, f), wide.at(7, f));
                for (std::size_t k = 0; k < 8; ++k) {
                    if (k >= 6 && !(wide.at(5, f) > 2.0)) continue;  // the axis of a circle may be any
                    const double value = wide.at(k, f), difference = std::fabs(of_column.at(k, y) - value);
                    const double size = k == 4 ? std::fmax(1.0, std::fabs(value)) : k == 5 ? value : length;
                    REQUIRE_MESSAGE(
                        (same_bits(of_column[k][y], wide[k][f]) || (k >= 4 && difference <= 0x1p-15 * size)), k, " at ",
                        y, " of ", hex(Shot{shot.triangle, column}));
                }
            }
        }
    }
}

TEST_CASE("no fragment of ten million is outside the extremes, and they are reached") {
    Random random(6500);
    std::size_t fragments = 0;
    int rects = 0, wide = 0, inner = 0;
    double worst_gap = 0.0;
    constexpr int side = 128;
    FootprintOutputs out({0, 0, side, side}, (1u << level) | (1u << anisotropy));
    FootprintOutputs derivatives({0, 0, side, side}, 15u);
    while (fragments < 10'000'000u) {
        const double ratio = random.power_of_ten(0.0, 2.5);
        Triangle triangle = spread_triangle(random, ratio);
        const int shape = random.integer(0, 9);
        if (shape == 0)  // q/w constant
            for (WindowVertex* vertex : support::vertices(triangle)) vertex->strq.w = vertex->clip_w;
        if (shape == 1)  // one column of the Jacobian passes through 0
            for (WindowVertex* vertex : support::vertices(triangle)) vertex->strq.y *= 0.01f;
        const FragmentRect rect{random.integer(-100, 500), random.integer(-100, 500), random.integer(2, side),
                                random.integer(2, side)};
        const TexelsPerUnit texels = some_texels(random);
        const FootprintSetup setup(setup_of(triangle), texels);
        const auto extremes = setup.extremes(rect);
        const std::size_t count = count_of(rect);
        Footprints spans = out.spans();
        Footprints of_derivatives = derivatives.spans();
        const bool written = footprint(setup, rect,
                                       {.dsdx = of_derivatives.dsdx.first(count),
                                        .dtdx = of_derivatives.dtdx.first(count),
                                        .dsdy = of_derivatives.dsdy.first(count),
                                        .dtdy = of_derivatives.dtdy.first(count),
                                        .level = spans.level.first(count),
                                        .anisotropy = spans.anisotropy.first(count),
                                        .major_s = {},
                                        .major_t = {}});
        if (!extremes || !written) {
            REQUIRE(!written);
            continue;
        }
        const ExactTriangle exact(triangle);
        bool promised = true;
        for (const int x : {rect.x, rect.x + rect.width - 1})
            for (const int y : {rect.y, rect.y + rect.height - 1})
                promised = promised && exact.has_positive_w(x, y) && exact.at(x, y).q.sign() > 0;
        if (!promised) continue;
        double least = infinity_double, largest = -infinity_double, neighbours = 0.0, thinnest = 0.0,
               area_least = infinity_double, area_largest = 0.0;
        for (std::size_t k = 0; k < count; ++k) {
            const double here = out.at(level, k);
            least = std::min(least, here);
            largest = std::max(largest, here);
            thinnest = std::max(thinnest, out.at(anisotropy, k));
            const double area = std::fabs(derivatives.at(dsdx, k) * derivatives.at(dtdy, k) -
                                          derivatives.at(dsdy, k) * derivatives.at(dtdx, k)) *
                                texels.s * texels.t;
            // What the subtraction of floats loses.
            const double lost = 4e-7 *
                                (std::fabs(derivatives.at(dsdx, k) * derivatives.at(dtdy, k)) +
                                 std::fabs(derivatives.at(dsdy, k) * derivatives.at(dtdx, k))) *
                                texels.s * texels.t;
            area_least = std::min(area_least, area + lost);
            area_largest = std::max(area_largest, area - lost);
            if (k % static_cast<std::size_t>(rect.width) != 0)
                neighbours = std::max(neighbours, std::fabs(here - out.at(level, k - 1)));
            if (k >= static_cast<std::size_t>(rect.width))
                neighbours =
                    std::max(neighbours, std::fabs(here - out.at(level, k - static_cast<std::size_t>(rect.width))));
        }
        const std::string context = text(texels) + " " + hex(Shot{triangle, rect}) + " levels " + hex(least) + " " +
                                    hex(largest) + " bounds " + hex(extremes->least_level) + " " +
                                    hex(extremes->largest_level);
        REQUIRE_MESSAGE(least >= extremes->least_level, context);
        REQUIRE_MESSAGE(largest <= extremes->largest_level, context);
        REQUIRE_MESSAGE(thinnest <= extremes->largest_anisotropy, context);
        REQUIRE_MESSAGE(area_least >= extremes->least_area, context);
        REQUIRE_MESSAGE(area_largest <= extremes->largest_area, context);
        fragments += count;
        ++rects;
        // 1 % of rho, and what may lie between two fragments.
        const double gap = std::max(least - extremes->least_level, extremes->largest_level - largest);
        if (neighbours < 0.02) {
            worst_gap = std::max(worst_gap, gap - neighbours);
            REQUIRE_MESSAGE(gap <= 0.0144 + neighbours, context);
            double corner_least = infinity_double, corner_largest = 0.0, corner_level = infinity_double;
            for (const int x : {rect.x, rect.x + rect.width - 1}) {
                for (const int y : {rect.y, rect.y + rect.height - 1}) {
                    const Footprint at = setup.at(x, y).value();
                    const double area = at.singular_values.x * at.singular_values.y;
                    corner_level = std::min(corner_level, at.level);
                    corner_least = std::min(corner_least, area);
                    corner_largest = std::max(corner_largest, area);
                }
            }
            REQUIRE_MESSAGE(extremes->largest_area <= 1.01 * corner_largest, context);
            REQUIRE_MESSAGE(extremes->least_area >= 0.99 * corner_least, context);
            REQUIRE_MESSAGE(extremes->largest_anisotropy <= thinnest * 1.01, context);
            wide += largest - least > 1.0;
            inner += least < corner_level - 0.01;
        }
    }
    MESSAGE(fragments, " fragments in ", rects, " rectangles; largest gap of a level ", worst_gap);
    CHECK(wide > 20);
    CHECK(inner > 12);  // the least level is at no corner
}

TEST_CASE("the extremes of a triangle hold for all fragments inside it, and are reached") {
    Random random(6600);
    int triangles = 0;
    for (int i = 0; i < 60; ++i) {
        const Triangle triangle = spread_triangle(random, random.power_of_ten(0.0, 2.0));
        const FragmentRect rect{-100, -100, 701, 701};
        const TexelsPerUnit texels = some_texels(random);
        const FootprintSetup setup(setup_of(triangle), texels);
        const auto extremes = setup.extremes();
        REQUIRE(extremes.has_value());
        double least = infinity_double, largest = -infinity_double, thinnest = 0.0;
        FootprintOutputs row({0, 0, rect.width, 1}, (1u << level) | (1u << anisotropy));
        for (int y = rect.y; y < rect.y + rect.height; ++y) {
            if (!footprint(setup, {rect.x, y, rect.width, 1}, row.spans())) continue;
            for (int x = rect.x; x < rect.x + rect.width; ++x) {
                if (!contains_centre(triangle, x, y)) continue;
                const auto k = static_cast<std::size_t>(x - rect.x);
                least = std::min(least, row.at(level, k));
                largest = std::max(largest, row.at(level, k));
                thinnest = std::max(thinnest, row.at(anisotropy, k));
            }
        }
        INFO(hex(triangle), " levels ", least, " ", largest, " bounds ", extremes->least_level, " ",
             extremes->largest_level);
        CHECK(least >= extremes->least_level);
        CHECK(largest <= extremes->largest_level);
        CHECK(thinnest <= extremes->largest_anisotropy);
        // The vertices may be most of a pixel from a centre inside: here the level may change by more than 1 %.
        const auto corner = support::vertices(triangle);
        for (const WindowVertex* vertex : corner) {
            const auto at = setup.at(static_cast<int>(std::floor(vertex->window.x)),
                                     static_cast<int>(std::floor(vertex->window.y)));
            if (at) least = std::min(least, at->level), largest = std::max(largest, at->level);
        }
        ++triangles;
        CHECK(least - extremes->least_level < 0.15);
        CHECK(extremes->largest_level - largest < 0.15);
    }
    CHECK(triangles == 60);
}

TEST_CASE("a level is inside the extremes where texels are beyond 2^500 pixels") {
    const texgen::Triangle triangle{
        {{0.0f, 0.0f}, 0x1p+8f, {0.0f, -0x1p+127f, 0x1p+127f, -0x1p+127f}},
        {{0x1p+127f, 0x1p-149f}, 0x1p+8f, {-0x1p-149f, 0x1p-149f, -0x1p-149f, 0x1p-149f}},
        {{-0x1p-149f, 0.0f}, 0x1.919p+6f, {0x1.9084p+6f, 0x1.919p+6f, 0x1.91ccp+6f, 0x1.919p+6f}}};
    const auto prepared = texgen::TriangleSetup::of(triangle, texgen::whole_texture());
    REQUIRE(prepared.has_value());
    const texgen::FootprintSetup setup(*prepared, {32.0, 4000.0});
    const auto one = setup.at(0, 0);
    const auto extremes = setup.extremes({0, 0, 1, 1});
    REQUIRE(one.has_value());
    REQUIRE(extremes.has_value());
    CHECK(one->level >= extremes->least_level);
    CHECK(one->level <= extremes->largest_level);
    CHECK(extremes->largest_level - extremes->least_level < 0.05);
}

TEST_CASE("next to q = 0 and behind it the extremes say so") {
    // q/w = (x - 100) / 100.
    const Triangle triangle = flat({glm::vec2(0, 0), glm::vec2(200, 0), glm::vec2(0, 200)},
                                   {glm::vec3(0.5f, 0, -1), glm::vec3(0.5f, 1, 1), glm::vec3(1, 0.5f, -1)});
    const FootprintSetup setup(setup_of(triangle), {256.0, 256.0});
    CHECK(!setup.extremes({0, 0, 90, 50}).has_value());
    CHECK(!setup.at(50, 10).has_value());
    const auto across = setup.extremes({50, 0, 100, 50});
    REQUIRE(across.has_value());
    CHECK(std::isinf(across->largest_level));
    CHECK(std::isinf(across->largest_area));
    const auto nearest = setup.at(100, 10);
    REQUIRE(nearest.has_value());
    const auto farthest = setup.at(149, 0);
    REQUIRE(farthest.has_value());
    CHECK(across->least_level <= farthest->level);
    CHECK(nearest->level > farthest->level + 8.0);
    CHECK(!setup.extremes({0, 0, 0, 5}).has_value());

    // Where q is 0 in the middle of a fragment, and only rounding could say that it is not, that one is behind.
    const Triangle root = flat({glm::vec2(0.5f, 0), glm::vec2(200.5f, 0), glm::vec2(0.5f, 200)},
                               {glm::vec3(0.5f, 0, -1), glm::vec3(0.25f, 0, 1), glm::vec3(0.5f, 0, -1)});
    const FootprintSetup at_root(setup_of(root), {256.0, 256.0});
    CHECK(!at_root.at(100, 2).has_value());
    CHECK(!at_root.extremes({100, 0, 1, 5}).has_value());
    const auto from_root = at_root.extremes({100, 0, 2, 5});
    REQUIRE(from_root.has_value());
    CHECK(from_root->least_level <= at_root.at(101, 2)->level);
    CHECK(std::isinf(from_root->largest_level));

    // q = 0 everywhere is behind.
    const Triangle dark = flat({glm::vec2(0, 0), glm::vec2(200, 0), glm::vec2(0, 200)}, {});
    CHECK(!FootprintSetup(setup_of(dark), {256.0, 256.0}).extremes({0, 0, 9, 5}).has_value());
    CHECK(!FootprintSetup(setup_of(dark), {256.0, 256.0}).extremes().has_value());
}

TEST_CASE("there are extremes exactly where a fragment is in front, and of a triangle where a corner is") {
    Random random(4711);
    int on_the_plane = 0, behind = 0, in_front = 0;
    for (int i = 0; i < 20000; ++i) {
        Triangle triangle{};
        const auto whole = [&](int least, int largest) { return static_cast<float>(random.integer(least, largest)); };
        for (WindowVertex* vertex : support::vertices(triangle)) {
            const float w = std::ldexp(1.0f, random.integer(-1, 2));
            *vertex = {
                {whole(-16, 16) * 0.5f, whole(-16, 16) * 0.5f}, w, {whole(-4, 4), whole(-4, 4), 0, whole(-2, 1)}};
        }
        const auto of = TriangleSetup::of(triangle, everywhere());
        if (!of) continue;
        const FootprintSetup setup(*of, some_texels(random));
        const ExactTriangle exact(triangle);
        const FragmentRect rect{random.integer(-9, 9), random.integer(-9, 9), random.integer(1, 4),
                                random.integer(1, 4)};
        bool is_any_in_front = false, is_any_on_the_plane = false;
        for (int y = rect.y; y < rect.y + rect.height; ++y) {
            for (int x = rect.x; x < rect.x + rect.width; ++x) {
                const int side = exact.at(x, y).q.sign();
                is_any_in_front = is_any_in_front || side > 0;
                is_any_on_the_plane = is_any_on_the_plane || side == 0;
            }
        }
        INFO(hex(triangle), " rect ", rect.x, " ", rect.y, " ", rect.width, " x ", rect.height);
        REQUIRE(setup.extremes(rect).has_value() == is_any_in_front);
        const auto& [a, b, c] = triangle;
        REQUIRE(setup.extremes().has_value() == (a.strq.w > 0 || b.strq.w > 0 || c.strq.w > 0));
        on_the_plane += is_any_on_the_plane && !is_any_in_front;
        behind += !is_any_on_the_plane && !is_any_in_front;
        in_front += is_any_in_front;
    }
    CHECK(std::min({on_the_plane, behind, in_front}) > 200);
}

TEST_CASE("footprints of any size have the shape of those near 1") {
    Random random(6750);
    int thin = 0;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec2 dx(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        const glm::dvec2 dy = i % 3 == 0 ? dx * random.uniform(0.1, 1.0) + glm::dvec2(0x1p-40, 0.0)
                                         : glm::dvec2(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        const TexelsPerUnit texels = some_texels(random);
        const Footprint near = texgen::footprint_of(dx, dy, texels);
        thin += near.anisotropy > 1e9;
        const int exponent = random.integer(-900, 900);
        const double size = std::ldexp(1.0, exponent);
        const Footprint far = texgen::footprint_of(size * dx, size * dy, texels);
        REQUIRE_MESSAGE(far.anisotropy == near.anisotropy, hex(dx.x) << " " << exponent);
        REQUIRE(far.singular_values == size * near.singular_values);
        REQUIRE(std::fabs(far.level - near.level - exponent) <= 1e-12 * std::max(1.0, std::fabs(far.level)));
    }
    CHECK(thin > 30);
}

TEST_CASE("a footprint of any finite derivatives is that of 400 bits, next to level 0 and at the ends of the range") {
    Random random(6751);
    const double bound = texgen::footprint_of_error;
    const Real largest_double = std::numeric_limits<double>::max();
    double worst_level = 0.0, worst_value = 0.0, worst_anisotropy = 0.0;
    int near_level_0 = 0, huge = 0, infinite = 0, thin = 0;
    for (int i = 0; i < 20000; ++i) {
        TexelsPerUnit texels = some_texels(random);
        int exponent = random.integer(-1040, 1023);
        if (i % 3 == 0) exponent = random.integer(1000, 1023);
        double size = std::ldexp(1.0, exponent);
        if (i % 3 == 1) {
            // The longer column is next to one texel a pixel.
            texels = {std::ldexp(1.0, random.integer(0, 9)), std::ldexp(1.0, random.integer(0, 9))};
            size = 1.0;
        }
        const auto column = [&](double length) {
            const double angle = random.uniform(0.0, 6.28);
            return glm::dvec2(length * std::cos(angle), length * std::sin(angle));
        };
        glm::dvec2 dx = size * column(random.uniform(0.5, 1.0)), dy = size * column(random.uniform(0.5, 1.0));
        if (i % 3 == 1) {
            dx = column(1.0 + std::ldexp(random.uniform(-1.0, 1.0), -random.integer(10, 53)));
            dx = {dx.x / texels.s, dx.y / texels.t};
            dy = 0.5 * dx + std::ldexp(1.0, -random.integer(10, 40)) * dy / glm::dvec2(texels.s, texels.t);
        }
        if (i % 5 == 0) dy = dx * random.uniform(0.1, 0.9);
        if (i % 15 == 1) {
            // A large number that texels make small takes no digit of the level.
            dy.x *= 0x1p100;
            dx.x *= 0x1p100;
            texels.s *= 0x1p-100;
        }
        const Footprint got = texgen::footprint_of(dx, dy, texels);
        const Real p = Real(dx.x) * texels.s, q = Real(dx.y) * texels.t;
        const Real u = Real(dy.x) * texels.s, v = Real(dy.y) * texels.t;
        const Real a = p * p + u * u, b = p * q + u * v, c = q * q + v * v, half = (a - c) / 2;
        const Real larger = sqrt((a + c) / 2 + sqrt(half * half + b * b));
        const Real smaller = abs(p * v - q * u) / larger;
        const Real longer = p * p + q * q > u * u + v * v ? p * p + q * q : u * u + v * v;
        const Real level = log(longer) / log(Real(2)) / 2;
        const std::string input =
            hex(dx.x) + " " + hex(dx.y) + " " + hex(dy.x) + " " + hex(dy.y) + " " + hex(texels.s) + " " + hex(texels.t);
        const Real size_of_level = abs(level) > 1 ? abs(level) : Real(1);
        const auto of_level = static_cast<double>(abs(Real(got.level) - level) / size_of_level);
        REQUIRE_MESSAGE(of_level <= bound, input);
        worst_level = std::max(worst_level, of_level);
        near_level_0 += abs(level) < 0x1p-9;
        huge += std::max({std::fabs(dx.x), std::fabs(dx.y), std::fabs(dy.x), std::fabs(dy.y)}) > 0x1p1000;
        const Real ratio = smaller > 0 ? Real(larger / smaller) : Real(0);
        if (ratio > 0 && ratio < Real(0x1p40)) {
            const auto error = static_cast<double>(abs(Real(got.anisotropy) - ratio) / (ratio * ratio));
            REQUIRE_MESSAGE(error <= bound, input);
            worst_anisotropy = std::max(worst_anisotropy, error);
        }
        thin += ratio > 1e6;
        if (larger > largest_double) {
            ++infinite;
            REQUIRE_MESSAGE(std::isinf(got.singular_values.x), input);
        } else if (larger > Real(0x1p-1000)) {
            const auto of_larger = static_cast<double>(abs(Real(got.singular_values.x) - larger) / larger);
            const auto of_smaller = static_cast<double>(abs(Real(got.singular_values.y) - smaller) / larger);
            REQUIRE_MESSAGE(of_larger <= bound, input);
            REQUIRE_MESSAGE(of_smaller <= bound, input);
            worst_value = std::max({worst_value, of_larger, of_smaller});
        }
    }
    CHECK(near_level_0 > 4000);
    CHECK(huge > 4000);
    CHECK(infinite > 1000);
    CHECK(thin > 1000);
    MESSAGE((worst_level / bound), " of the bound on the level, ", (worst_value / bound), " on the singular values, ",
            (worst_anisotropy / bound), " on the anisotropy");
    CHECK(texgen::footprint_of({1e303, 0.0}, {0.0, 1e303}, {1.0, 1.0}).singular_values == glm::dvec2(1e303));
    CHECK(std::isnan(texgen::footprint_of({HUGE_VAL, 0.0}, {0.0, 1.0}, {1.0, 1.0}).level));
}

TEST_CASE("triangles that double cannot hold the differences of keep their bounds and their extremes") {
    // Corners that differ by 2^-142 of the third's distance; a Q that grows to 2^269 over one pixel; and weights of
    // 2^-410, of which products of two are below all doubles; and a Q of 2^-514, the square of which is below all
    // doubles.
    const auto corner = [](float x, float y, float w, const glm::vec4& strq) { return WindowVertex{{x, y}, w, strq}; };
    const float tiny = 0x1.fcp-143f;
    const Triangle close{corner(-1.0f, 1.0f, 256.0f, {-1.0f, 62.0f, 2.0f, -0.0f}),
                         corner(-0.0f, -tiny, 165.0f, {tiny, 2.0f * tiny, -2.0f * tiny, 2.0f * tiny}),
                         corner(-2.0f * tiny, 2.0f * tiny, 256.0f, {-2.0f * tiny, 2.0f * tiny, -tiny, 2.0f * tiny})};
    const Triangle steep{corner(0.0f, 0.0f, 238.0f, {0.0f, 0.0f, 0.0f, 0.0f}),
                         corner(0.0f, -tiny, 256.0f, {tiny, -tiny, tiny, -0x1.f5fffep+127f}),
                         corner(-0x1p+80f, 0x1p+80f, 1.0f, {-0x1p+80f, 0x1p+80f, -0x1p+80f, -1.0f})};
    const Triangle faint{corner(0.0f, 0x1.fffffep+127f, 0x1.2p-146f, {0.0f, 0.0f, 0.0f, 0.0f}),
                         corner(0x1.fffffep+127f, -0x1.fffffep+127f, 47.0f, {0.0f, 0.0f, 0.0f, 0x1.78p-144f}),
                         corner(tiny, 2.0f * tiny, 47.0f, {tiny, 2.0f * tiny, tiny, 2.0f * tiny})};
    const Triangle dim{corner(0x1.fffffep+127f, 0x1.ffff26p+127f, 0x1.fffe4ep+127f, {1.0f, 2.0f, 3.0f, 0x1p-126f}),
                       corner(0x1p-126f, 0x1.323232p-77f, 26.0f, {0.0f, 0.0f, 0.0f, 0.0f}),
                       corner(-0x1p-8f, 0x1p-8f, 26.0f, {0.0f, 0.0f, 0.0f, 0.0f})};
    for (const Triangle& triangle : {close, steep, faint, dim}) {
        int bounded = 0;
        const ExactTriangle exact(triangle);
        const FootprintSetup setup(setup_of(triangle), {4096.0, 128.0});
        for (int y = -300; y < 300; y += 13) {
            for (int x = -300; x < 300; x += 7) {
                const auto one = setup.at(x, y);
                if (!exact.has_positive_w(x, y) || !one) continue;
                const auto extremes = setup.extremes({x, y, 1, 1});
                REQUIRE(extremes.has_value());
                const std::string context = "fragment " + std::to_string(x) + " " + std::to_string(y);
                REQUIRE_MESSAGE(one->level >= extremes->least_level, context);
                REQUIRE_MESSAGE(one->level <= extremes->largest_level, context);
                const glm::dvec2 bound = setup.error_bound({x, y, 1, 1});
                const ExactFootprint truth(exact, x, y);
                FootprintOutputs out({x, y, 1, 1});
                REQUIRE(footprint(setup, {x, y, 1, 1}, out.spans()));
                for (std::size_t c = 0; c < 2; ++c) {
                    const double allowed = bound[static_cast<int>(c)];
                    if (std::isinf(allowed)) continue;
                    ++bounded;
                    REQUIRE_MESSAGE(distance(out.at(dsdx + c, 0), truth.dx[c]) <= allowed, context);
                    REQUIRE_MESSAGE(distance(out.at(dsdy + c, 0), truth.dy[c]) <= allowed, context);
                    REQUIRE_MESSAGE(distance(one->dx[static_cast<int>(c)], truth.dx[c]) <= allowed, context);
                    REQUIRE_MESSAGE(distance(one->dy[static_cast<int>(c)], truth.dy[c]) <= allowed, context);
                }
            }
        }
        CHECK(bounded > 500);
    }
}

TEST_CASE("a Jacobian of rank 1 or 0, and texels that are none, get what the header says") {
    const std::array window{glm::vec2(0, 0), glm::vec2(64, 0), glm::vec2(0, 64)};
    const FragmentRect rect{3, 4, 21, 5};
    const Triangle constant =
        flat(window, {glm::vec3(0.25f, 0.5f, 2), glm::vec3(0.25f, 0.5f, 1), glm::vec3(0.25f, 0.5f, 4)});
    const Triangle line = flat(window, {glm::vec3(0, 0, 2), glm::vec3(1, 1, 1), glm::vec3(0.25f, 0.25f, 4)});
    {
        const FootprintSetup setup(setup_of(constant), {64.0, 64.0});
        FootprintOutputs out(rect);
        REQUIRE(footprint(setup, rect, out.spans()));
        for (std::size_t k = 0; k < count_of(rect); ++k) {
            for (const std::size_t o : {dsdx, dtdx, dsdy, dtdy, major_s, major_t}) REQUIRE(out[o][k] == 0.0f);
            REQUIRE(out.at(level, k) == -infinity_double);
            REQUIRE(out[anisotropy][k] == 1.0f);
        }
        const auto extremes = setup.extremes(rect);
        REQUIRE(extremes.has_value());
        CHECK(extremes->least_level == -infinity_double);
        CHECK(extremes->largest_level == -infinity_double);
        CHECK(extremes->largest_area == 0.0);
    }
    {
        const FootprintSetup setup(setup_of(line), {64.0, 64.0});
        FootprintOutputs out(rect);
        REQUIRE(footprint(setup, rect, out.spans()));
        for (std::size_t k = 0; k < count_of(rect); ++k) {
            REQUIRE(out.at(anisotropy, k) == infinity_double);
            REQUIRE(std::isfinite(out.at(level, k)));
            REQUIRE(std::fabs(out.at(major_s, k) - out.at(major_t, k)) <= 1e-5 * std::fabs(out.at(major_s, k)));
        }
        const auto one = setup.at(5, 5);
        REQUIRE(one.has_value());
        CHECK(one->anisotropy == infinity_double);
        CHECK(one->singular_values.y == 0.0);
        CHECK(setup.extremes(rect)->largest_anisotropy == infinity_double);
    }
    // t = 3/4 s at every corner, with all the digits that floats have for it: the rank is exact, sums of doubles are
    // not.
    Random random(6700);
    for (int i = 0; i < 200; ++i) {
        Triangle thin = spread_triangle(random, 4.0);
        for (WindowVertex* vertex : support::vertices(thin)) {
            vertex->strq.x = static_cast<float>(random.integer(-(1 << 21), 1 << 21)) * 0x1p-20f;
            vertex->strq.y = 0.75f * vertex->strq.x;
        }
        const auto one = FootprintSetup(setup_of(thin), {64.0, 64.0}).at(200, 200);
        if (one && one->singular_values.x > 0.0) REQUIRE_MESSAGE(one->anisotropy == infinity_double, hex(thin));
    }
    const Triangle plain = flat(window, {glm::vec3(0, 0, 2), glm::vec3(1, 0, 1), glm::vec3(0.25f, 1, 4)});
    for (const double bad : {0.0, -1.0, nan_double, infinity_double, 0x1p200, 0x1p-202}) {
        const double other = bad > 0.0 && bad < infinity_double ? 0x1p2 * bad : 64.0;
        const TexelsPerUnit texels = bad > 0.0 ? TexelsPerUnit{bad, other} : TexelsPerUnit{64.0, bad};
        const FootprintSetup setup(setup_of(plain), texels), good(setup_of(plain), {64.0, 64.0});
        FootprintOutputs out(rect), right(rect);
        REQUIRE(footprint(setup, rect, out.spans()));
        footprint(good, rect, right.spans());
        for (std::size_t k = 0; k < count_of(rect); ++k) {
            for (const std::size_t o : {dsdx, dtdx, dsdy, dtdy})
                REQUIRE(std::fabs(out.at(o, k) - right.at(o, k)) <= 1e-6 * std::fabs(right.at(o, k)));
            for (const std::size_t o : {level, anisotropy, major_s, major_t}) REQUIRE(std::isnan(out[o][k]));
        }
        CHECK(std::isnan(setup.extremes(rect)->largest_level));
        CHECK(std::isnan(setup.at(5, 5)->level));
    }
    const Footprint none = texgen::footprint_of({nan_double, 0.0}, {0.0, 1.0}, TexelsPerUnit{64.0, 64.0});
    CHECK(std::isnan(none.level));
    CHECK(std::isnan(none.anisotropy));
}

TEST_CASE("one texel a pixel is level 0, whatever the region's units") {
    const std::array window{glm::vec2(0, 0), glm::vec2(256, 0), glm::vec2(0, 128)};
    const auto level_of = [&](const texgen::TextureRegion& region, double width, double height) {
        const glm::vec2 min(region.min()), max(region.max());
        const Triangle triangle =
            flat(window, {glm::vec3(min, 1), glm::vec3(max.x, min.y, 1), glm::vec3(min.x, max.y, 1)});
        const FootprintSetup setup(setup_of(triangle, region), texgen::texels_per_unit(region, width, height));
        return setup.at(10, 10).value();
    };
    for (const texgen::TextureRegion& region :
         {texgen::whole_texture(), texgen::rectangle_texture(256, 128), texgen::atlas_tile({0.25, 0.5}, {0.5, 0.75})}) {
        CHECK(level_of(region, 256, 128).level == doctest::Approx(0.0));
        CHECK(level_of(region, 256, 128).anisotropy == doctest::Approx(1.0));
        CHECK(level_of(region, 1024, 128).level == doctest::Approx(2.0));
        CHECK(level_of(region, 1024, 128).anisotropy == doctest::Approx(4.0));
        CHECK(level_of(region, 1024, 128).major.y == doctest::Approx(0.0));
    }
    CHECK(texgen::texels_per_unit(texgen::rectangle_texture(256, 128), 256, 128).s == 1.0);
}

TEST_CASE("OpenGL's level is that of the longer column, not of the larger singular value") {
    const Footprint sheared = texgen::footprint_of({1.0, 1.0}, {1.0, 1.0 + 1e-9}, TexelsPerUnit{1.0, 1.0});
    CHECK(sheared.level == doctest::Approx(0.5));
    CHECK(sheared.singular_values.x == doctest::Approx(2.0));
    CHECK(sheared.major.x == doctest::Approx(std::sqrt(2.0)));
    CHECK(sheared.major.y == doctest::Approx(std::sqrt(2.0)));
    const Footprint mirrored = texgen::footprint_of({-3.0, 0.0}, {0.0, 2.0}, TexelsPerUnit{2.0, 1.0});
    CHECK(mirrored.singular_values.x == doctest::Approx(6.0));
    CHECK(mirrored.singular_values.y == doctest::Approx(2.0));
    CHECK(mirrored.anisotropy == doctest::Approx(3.0));
    CHECK(std::fabs(mirrored.major.x) == doctest::Approx(3.0));
}

TEST_CASE(
    "a projector that faces the camera has a positive score, a parallel one 0, one beside the camera a negative one") {
    // A floor seen from (0, 2, 10) towards -z.
    const auto camera = texgen::make_projector(
        texgen::PerspectiveLens{.fovy = texgen::degrees(60), .aspect = 1, .z_near = 0.1, .z_far = 100},
        texgen::Aim{.position = {0, 2, 10}, .target = {0, 0, -10}, .up = {0, 1, 0}}, texgen::opengl);
    REQUIRE(camera.has_value());
    const std::array<glm::vec3, 3> floor{glm::vec3(-3, 0, 6), glm::vec3(3, 0, 6), glm::vec3(0, 0, -20)};
    const auto score = [&](const texgen::Projector& projector) {
        std::array<glm::vec4, 3> strq;
        texgen::generate(texgen::texture_from_world(projector), texgen::world_space(floor), std::span(strq));
        Triangle triangle{};
        const auto corner = support::vertices(triangle);
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec4 clip = camera->matrix().matrix() * glm::dvec4(floor[i], 1.0);
            *corner[i] = {glm::vec2(256.0 + 256.0 * clip.x / clip.w, 256.0 + 256.0 * clip.y / clip.w),
                          static_cast<float>(clip.w), strq[i]};
        }
        return texgen::headlights(triangle);
    };
    const texgen::PerspectiveLens lens{.fovy = texgen::degrees(40), .aspect = 1, .z_near = 0.1, .z_far = 100};
    const texgen::Aim facing{.position = {0, 3, -25}, .target = {0, 0, 6}, .up = {0, 1, 0}};
    const texgen::Aim beside{.position = {1, 2, 10}, .target = {0, 0, -10}, .up = {0, 1, 0}};
    const texgen::OrthographicLens parallel{
        .left = -9, .right = 9, .bottom = -9, .top = 9, .z_near = 0.1, .z_far = 100};
    CHECK(score(texgen::make_projector(lens, facing, texgen::opengl).value()) > 3.0);
    CHECK(score(texgen::make_projector(lens, beside, texgen::opengl).value()) < -3.0);
    CHECK(std::fabs(score(texgen::make_projector(parallel, facing, texgen::opengl).value())) < 1e-6);
    Triangle bad = flat({glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)},
                        {glm::vec3(0, 0, 1), glm::vec3(0, 1, 1), glm::vec3(1, 1, 1)});
    bad.a.clip_w = 0.5f;
    bad.c.clip_w = 2.0f;
    bad.c.strq.w = -1.0f;
    CHECK(texgen::headlights(bad) == infinity_double);
    std::swap(bad.b, bad.c);  // no corner is far from it alone
    bad.c.clip_w = 3.0f;
    CHECK(texgen::headlights(bad) == infinity_double);
    const Triangle good = bad;
    for (const float no_number : {std::numeric_limits<float>::quiet_NaN(), HUGE_VALF}) {
        for (std::size_t i = 0; i < 3; ++i) {
            bad = good;
            support::vertices(bad)[i]->strq.w = no_number;
            CHECK(std::isnan(texgen::headlights(bad)));
            bad = good;
            support::vertices(bad)[i]->clip_w = no_number;
            CHECK(std::isnan(texgen::headlights(bad)));
        }
    }
}

TEST_CASE("the score is that of the triangle, in whatever order its corners are") {
    Random random(4713);
    int finite = 0, infinite = 0;
    for (int i = 0; i < 2000; ++i) {
        Triangle triangle{};
        for (WindowVertex* vertex : support::vertices(triangle)) {
            const auto whole = [&](int least, int largest) {
                return static_cast<float>(random.integer(least, largest));
            };
            *vertex = {{0, 0}, whole(1, 3), {0, 0, 0, whole(-1, 4)}};
        }
        const auto& [a, b, c] = triangle;
        const double score = texgen::headlights(triangle);
        for (const Triangle& turned :
             {Triangle{a, c, b}, Triangle{b, a, c}, Triangle{b, c, a}, Triangle{c, a, b}, Triangle{c, b, a}}) {
            const double turned_score = texgen::headlights(turned);
            INFO(hex(triangle), " ", turned_score, " ", score);
            REQUIRE((turned_score == score || (std::isnan(turned_score) && std::isnan(score))));
        }
        float least_w = 4.0f, q_there = 0.0f;
        for (const WindowVertex* vertex : support::vertices(triangle)) {
            if (vertex->clip_w > least_w) continue;
            q_there = vertex->clip_w < least_w ? vertex->strq.w : std::max(q_there, vertex->strq.w);
            least_w = vertex->clip_w;
        }
        REQUIRE(std::isnan(score) == (q_there <= 0.0f));
        finite += std::isfinite(score);
        infinite += std::isinf(score);
        REQUIRE((std::isinf(score) || std::isnan(score)) == (a.strq.w <= 0 || b.strq.w <= 0 || c.strq.w <= 0));
    }
    CHECK(std::min(finite, infinite) > 300);
}

TEST_CASE("no axis is a NaN or infinite, nor an anisotropy that a float holds, whatever the texels") {
    const Triangle triangle{
        {{0, 0}, 1, {0, 0, 0, 1}}, {{16, 0}, 2, {2, 1, 0, 2}}, {{0, 16}, 1.5f, {0.5f, 1.5f, 0, 1.5f}}};
    Triangle constant = triangle;
    for (WindowVertex* vertex : support::vertices(constant)) vertex->strq.x = 0.25f * vertex->strq.w;
    for (const Triangle& one : {triangle, constant}) {
        for (const int exponent :
             {-199, -150, -140, -132, -126, -120, 0, 120, 124, 126, 127, 128, 130, 140, 150, 199}) {
            for (const bool is_of_s : {false, true}) {
                const double many = std::ldexp(1.0, exponent);
                const TexelsPerUnit texels = is_of_s ? TexelsPerUnit{many, 1.0} : TexelsPerUnit{1.0, many};
                const FragmentRect rect{3, 4, 9, 2};
                const FootprintSetup setup(setup_of(one), texels);
                FootprintOutputs of_setup(rect), of_buffer(rect);
                REQUIRE(footprint(setup, rect, of_setup.spans()));
                texgen::TriangleBatch batch(texgen::whole_texture());
                batch.assign({&one, 1});
                const std::vector<std::uint32_t> ids(count_of(rect), 0);
                footprint(batch, ids, rect, texels, of_buffer.spans());
                for (std::size_t k = 0; k < ids.size(); ++k) {
                    const auto at = setup.at(rect.x + static_cast<int>(k) % 9, rect.y + static_cast<int>(k) / 9);
                    REQUIRE(at);
                    for (const FootprintOutputs* out : {&of_setup, &of_buffer}) {
                        CAPTURE(text(texels));
                        const double length = std::hypot(at->major.x, at->major.y);
                        CHECK(std::fabs(out->at(major_s, k) - at->major.x) <= 1e-4 * length);
                        CHECK(std::fabs(out->at(major_t, k) - at->major.y) <= 1e-4 * length);
                        if (at->anisotropy < 0x1.fffp127)
                            CHECK(std::fabs(out->at(anisotropy, k) / at->anisotropy - 1.0) <= 1e-4);
                        else
                            CHECK(out->at(anisotropy, k) >= 0x1.ffep127);
                    }
                }
            }
        }
    }
}
