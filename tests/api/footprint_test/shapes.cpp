// Level, anisotropy and major axis are those of the exact Jacobian, at any size.

#include "texgen/footprint.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "api/footprint_test/derivatives.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/real.hpp"
#include "support/footprint_outputs.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/triangles.hpp"
#include "texgen/batch.hpp"
#include "texgen/interpolate.hpp"

namespace footprint_cases {

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
            const auto [x, y] = shot.fragment(k);
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

}  // namespace footprint_cases
