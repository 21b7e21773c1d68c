// Footprints of a visibility buffer where the lanes of vectors find little: what cancels, and what they leave.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "judges/fragments.hpp"
#include "judges/real.hpp"
#include "support/footprint_outputs.hpp"
#include "support/hard_triangles.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "texgen/batch.hpp"

namespace {

using support::FootprintOutputs;
using support::Random;
using support::Real;
using texgen::FragmentRect;
using texgen::Triangle;
using texgen::TriangleBatch;

constexpr texgen::TexelsPerUnit slide_texels{1024.0, 512.0};

// A triangle beyond which q at fragment (0, 0) is above 0 and below 2^-38 of its terms, by the choice of the last q and
// of many w.
std::optional<Triangle> draw_cancelled(Random& random) {
    Triangle triangle = support::make_triangle(support::Family::friendly, random);
    const auto corner = support::vertices(triangle);
    for (texgen::WindowVertex* v : corner)
        v->window = {random.uniform_float(20.0, 200.0), random.uniform_float(20.0, 200.0)};
    for (int tries = 0; tries < 1 << 16; ++tries) {
        for (texgen::WindowVertex* v : corner) v->clip_w = random.uniform_float(1.0, 4.0);
        const auto term = [&](std::size_t i) {
            const texgen::WindowVertex &j = *corner[(i + 1) % 3], &k = *corner[(i + 2) % 3];
            const auto to = [](float x) { return static_cast<long double>(x) - 0.5L; };
            return (to(j.window.x) * to(k.window.y) - to(j.window.y) * to(k.window.x)) / corner[i]->clip_w;
        };
        const long double rest = term(0) * corner[0]->strq.w + term(1) * corner[1]->strq.w;
        corner[2]->strq.w = static_cast<float>(-rest / term(2));
        const long double q = rest + term(2) * corner[2]->strq.w;
        if (std::fabs(q) < 0x1p-39L * std::fabs(rest) && (q > 0) == (support::twice_area(triangle) > 0.0))
            return triangle;
    }
    return std::nullopt;
}

// How many of a buffer's fragments the lanes leave to set-ups.
int left_by_lanes(const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& ids,
                  const FragmentRect& rect) {
    TriangleBatch batch(texgen::whole_texture());
    batch.assign(triangles);
    FootprintOutputs out(rect);
    texgen::detail::BatchFootprintsJob job{};
    texgen::detail::describe(job, batch, ids, rect, slide_texels, out.spans());
    const auto& kernels = texgen::detail::chosen<texgen::detail::BatchFootprintKernels>();
    int left = 0;
    for (std::size_t begin = 0; begin < ids.size();) {
        const texgen::detail::Undecided doubt = kernels.fill(job, begin);
        left += std::popcount(doubt.values);
        begin = std::min(ids.size(), doubt.begin + texgen::detail::exact_block);
    }
    return left;
}

}  // namespace

TEST_CASE("footprints of a visibility buffer keep their digits where q cancels") {
    Random random(8);
    int checked = 0;
    for (int round = 0; round < 40; ++round) {
        const std::optional<Triangle> drawn = draw_cancelled(random);
        if (!drawn) continue;
        const support::ExactTriangle exact(*drawn);
        if (!exact.has_positive_w(0, 0) || exact.at(0, 0).q.sign() <= 0) continue;
        TriangleBatch batch(texgen::whole_texture());
        batch.assign(std::array{*drawn, support::make_triangle(support::Family::friendly, random)});
        const FragmentRect rect{0, 0, 5, 1};
        FootprintOutputs out(rect);
        footprint(batch, std::array<std::uint32_t, 5>{0, 1, 1, 0, 0}, rect, slide_texels, out.spans());
        const support::Homogeneous here = exact.at(0, 0), next[] = {exact.at(1, 0), exact.at(0, 1)};
        for (std::size_t k = 0; k < 4; ++k) {
            const auto slope = [&](std::size_t axis) {
                const support::Dyadic f = here.over_q(k % 2).n;
                return Real(((next[axis].over_q(k % 2).n - f) * here.q - f * (next[axis].q - here.q)).rational()) /
                       Real((here.q * here.q).rational());
            };
            const Real length = sqrt(Real(slope(0) * slope(0) + slope(1) * slope(1)));
            const auto error = static_cast<double>(abs(Real(Real(out.at(k, 0)) - slope(k / 2))) / length);
            CHECK_MESSAGE(error <= 0x1p-24, support::hex(*drawn));
        }
        ++checked;
    }
    CHECK(checked > 20);
}

// Half an ulp is all that error_bound() leaves where the larger derivative is just above a power of two: there what else
// they err by is seen, next to the middle of two floats.
TEST_CASE("derivatives of a visibility buffer err by no more than batch_footprint_error besides") {
    Random random(11);
    int checked = 0, next_to_middle = 0;
    for (int round = 0; round < 30000; ++round) {
        Triangle triangle = support::make_triangle(support::Family::friendly, random);
        const FragmentRect pixel = support::pixel_near(triangle, random);
        const auto footprint_of = [&]() -> std::optional<texgen::Footprint> {
            const auto setup = texgen::TriangleSetup::of(triangle, texgen::whole_texture());
            if (!setup) return std::nullopt;
            return texgen::FootprintSetup(*setup, slide_texels).at(pixel.x, pixel.y);
        };
        const auto before = footprint_of();
        if (!before) continue;
        int exponent = 0;
        const double larger = std::max(std::fabs(before->dx.x), std::fabs(before->dy.x));
        const double mantissa = std::frexp(larger, &exponent);
        for (texgen::WindowVertex* v : support::vertices(triangle))
            v->strq.x = static_cast<float>(static_cast<double>(v->strq.x) * (0.5002 / mantissa));
        const support::ExactTriangle exact(triangle);
        if (!exact.has_positive_w(pixel.x, pixel.y) || exact.at(pixel.x, pixel.y).q.sign() <= 0) continue;
        TriangleBatch batch(texgen::whole_texture());
        batch.assign({&triangle, 1});
        const std::uint32_t id = 0;
        FootprintOutputs out(pixel);
        footprint(batch, {&id, 1}, pixel, slide_texels, out.spans());
        const auto expected = footprint_of();
        REQUIRE(expected);
        const auto setup = texgen::TriangleSetup::of(triangle, texgen::whole_texture());
        const double bound = texgen::FootprintSetup(*setup, slide_texels).error_bound(pixel).x;
        const double allowed = bound + texgen::batch_footprint_error * std::hypot(expected->dx.x, expected->dy.x);
        const support::Homogeneous here = exact.at(pixel.x, pixel.y);
        const support::Dyadic q_squared = here.q * here.q, f = here.over_q(0).n;
        for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
            const int right = axis == 0 ? 1 : 0;
            const support::Homogeneous next = exact.at(pixel.x + right, pixel.y + 1 - right);
            const support::Dyadic slope = (next.over_q(0).n - f) * here.q - f * (next.q - here.q);
            const support::Dyadic error = magnitude(support::Dyadic(out.at(2 * axis, 0)) * q_squared - slope);
            CHECK_MESSAGE(error <= support::Dyadic(allowed) * q_squared, support::hex(triangle));
            next_to_middle += support::Dyadic(0.995 * bound) * q_squared <= error;
            ++checked;
        }
    }
    CHECK(checked > 30000);
    CHECK(next_to_middle > 50);
}

TEST_CASE("few fragments of a visibility buffer are left to set-ups of their footprints") {
    Random random(9);
    for (const support::HardFamily& family : support::hard_families) {
        int left = 0, all = 0;
        for (int round = 0; round < 40; ++round) {
            const support::Shot shot = family.make(random);
            const FragmentRect rect{shot.rect.x, shot.rect.y, std::min(shot.rect.width, 60),
                                    std::min(shot.rect.height, 8)};
            std::vector<std::uint32_t> ids(support::count_of(rect));
            for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<std::uint32_t>(i / 3 % 2);
            const Triangle& t = shot.triangle;
            left += left_by_lanes({t, {t.b, t.c, t.a}}, ids, rect);
            all += static_cast<int>(ids.size());
        }
        INFO(family.name, ": ", left, " of ", all);
        // The factor before derivatives leaves the range of double there.
        if (std::string_view(family.name) != "all units about 1e-40") CHECK(left * 100 <= all);
    }
}

TEST_CASE("what vectors leave in doubt of a visibility buffer's footprints is that of a set-up") {
    // A sliver 2^22 long, and fragments as far off it as there are.
    const Triangle sliver{
        {{-0x1.610d8ep-10f, 0x1.0cd416p+22f}, 1.0f, {0x1.61b07cp-1f, 0x1.45a8acp+0f, -0x1.6156cap-10f, 1.0f}},
        {{-0x1.6156cap-10f, -0x1.e10c8ep-10f},
         0x1.000004p+0f,
         {0x1.d09ep+0f, 0x1.9f129ep-1f, 0x1.000104p-8f, 0x1.000004p+0f}},
        {{-0x1.6156cap-10f, -0x1.aec8d6p+0f}, 1.0f, {0x1.d09dfep+0f, 0x1.d09ep+0f, 0x1.b0c988p-2f, 1.0f}}};
    const std::vector<Triangle> triangles(8, sliver);
    const FragmentRect rect{std::numeric_limits<int>::min(), std::numeric_limits<int>::min(), 64, 4};
    std::vector<std::uint32_t> ids(256);
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = i % 8;
    CHECK(left_by_lanes(triangles, ids, rect) > 0);
    TriangleBatch batch(texgen::whole_texture());
    batch.assign(triangles);
    FootprintOutputs out(rect);
    footprint(batch, ids, rect, slide_texels, out.spans());
    const texgen::FootprintSetup setup(*texgen::TriangleSetup::of(sliver, texgen::whole_texture()), slide_texels);
    for (int i = 0; i < 256; ++i) {
        const auto exact = setup.at(rect.x + i % 64, rect.y + i / 64);
        CHECK(out[0][static_cast<std::size_t>(i)] == (exact ? static_cast<float>(exact->dx.x) : 0.0f));
        CHECK(out[3][static_cast<std::size_t>(i)] == (exact ? static_cast<float>(exact->dy.y) : 0.0f));
    }
}

TEST_CASE("a visibility buffer's slides may be very large or small, as those of a set-up") {
    Random random(10);
    int checked = 0;
    for (int round = 0; round < 300; ++round) {
        Triangle triangle = support::make_triangle(support::Family::friendly, random);
        const int exponent = random.coin() ? random.integer(60, 118) : random.integer(-118, -60);
        for (texgen::WindowVertex* v : support::vertices(triangle))
            for (int k = 0; k < 2; ++k) v->strq[k] = std::ldexp(v->strq[k], exponent);
        const auto setup = texgen::TriangleSetup::of(triangle, texgen::whole_texture());
        REQUIRE(setup);
        const FragmentRect pixel = support::pixel_near(triangle, random);
        const auto expected = texgen::FootprintSetup(*setup, slide_texels).at(pixel.x, pixel.y);
        if (!expected) continue;
        TriangleBatch batch(texgen::whole_texture());
        batch.assign({&triangle, 1});
        const std::uint32_t id = 0;
        FootprintOutputs out(pixel);
        footprint(batch, {&id, 1}, pixel, slide_texels, out.spans());
        CHECK_MESSAGE(std::fabs(out.at(4, 0) - expected->level) <= 1e-3, support::hex(triangle));
        CHECK_MESSAGE(std::fabs(out.at(5, 0) / expected->anisotropy - 1.0) <= 1e-4, support::hex(triangle));
        const double length = std::hypot(expected->major.x, expected->major.y);
        const double computed = std::hypot(out.at(6, 0), out.at(7, 0));
        if (length > 0x1p-120 && length < 0x1p120) CHECK(std::fabs(computed / length - 1.0) <= 1e-4);
        ++checked;
    }
    CHECK(checked > 200);
}
