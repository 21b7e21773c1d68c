// Footprints over raw bytes: nothing but the outputs is written, derivatives are within their bound by the exact judge,
// what is behind the projector is 0 or empty, no fragment is outside the extremes, and what is no number is never one.

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "fuzz/input.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "support/footprint_outputs.hpp"
#include "texgen/batch.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"

namespace {

using fuzz::Input;
using fuzz::must;
using fuzz::same;
using support::Dyadic;
using support::Homogeneous;
using texgen::Footprint;
using texgen::footprint_of;
using texgen::FootprintExtremes;
using texgen::FootprintSetup;
using texgen::FragmentRect;
using texgen::TexelsPerUnit;
using texgen::Triangle;
using texgen::TriangleSetup;

TexelsPerUnit texels_of(Input& input) {
    if (input.integer(0, 3) == 0) return {input.wide_number(), input.wide_number()};
    return {std::ldexp(1.0, input.integer(0, 13)), 1.0 + input.integer(0, 4095)};
}

// What texgen::TexelsPerUnit calls good; those beyond 2^+-200 are refused as well.
bool are_good(const TexelsPerUnit& texels) {
    return texels.s > 0x1p-200 && texels.s < 0x1p200 && texels.t > 0x1p-200 && texels.t < 0x1p200;
}

bool is_in(double value, double least, double largest) { return value >= least && value <= largest; }

// The numerators of d(s/q) and d(t/q) over q^2, exactly: S, T and Q are affine, so differences of neighbours are
// slopes.
struct ExactSlopes {
    Dyadic dx[2], dy[2], q_squared;

    ExactSlopes(const support::ExactTriangle& exact, std::int64_t x, std::int64_t y) {
        const Homogeneous here = exact.at(x, y), right = exact.at(x + 1, y), up = exact.at(x, y + 1);
        const auto slope = [&](std::size_t k, const Homogeneous& next) {
            const Dyadic f = here.over_q(k).n;
            return (next.over_q(k).n - f) * here.q - f * (next.q - here.q);
        };
        for (std::size_t k = 0; k < 2; ++k) {
            dx[k] = slope(k, right);
            dy[k] = slope(k, up);
        }
        q_squared = here.q * here.q;
    }
};

// |value - numerator / q_squared| <= bound, for numbers that floats hold.
bool is_within(float value, const Dyadic& numerator, const Dyadic& q_squared, double bound) {
    if (std::isinf(bound)) return true;
    if (std::isnan(value)) return false;
    if (std::isinf(value)) return Dyadic(0x1.ffffffp127) * q_squared <= magnitude(numerator);
    return magnitude(Dyadic(value) * q_squared - numerator) <= Dyadic(bound) * q_squared;
}

// The eight outputs of a footprint, those of `asked` (a bit each) given to the library.
void require_inside(const Footprint& one, double error, const FootprintExtremes& extremes) {
    must(is_in(one.level, extremes.least_level, extremes.largest_level), "no level is outside the extremes");
    // The determinant has digits that an uncertain J has not; their product is the area where J has them too.
    const double area = one.singular_values.x * one.singular_values.y;
    must(!(error <= 0x1p-18 * one.singular_values.x) || is_in(area, extremes.least_area, extremes.largest_area),
         "no area is outside the extremes");
    must(one.anisotropy <= extremes.largest_anisotropy, "no anisotropy is above the largest");
}

// The same triangle, and itself with its corners turned, in runs of a visibility buffer.
struct BufferedFootprints {
    Triangle triangles[2];
    TexelsPerUnit texels;
    std::size_t run;
    support::FootprintOutputs out;

    BufferedFootprints(const Triangle& triangle, const TexelsPerUnit& of_slide, const FragmentRect& rect,
                       unsigned asked, std::size_t length)
        : triangles{triangle, {triangle.b, triangle.c, triangle.a}}, texels(of_slide), run(length), out(rect, asked) {
        texgen::TriangleBatch batch(texgen::whole_texture());
        batch.assign(triangles);
        std::vector<std::uint32_t> ids(support::count_of(rect));
        for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = i / run % 2;
        footprint(batch, ids, rect, texels, out.spans());
        must(out.pads_are_intact(), "footprints of a visibility buffer are written to their outputs only");
    }

    void require(std::size_t i, int x, int y, const support::ExactTriangle& exact) const {
        if (exact.at(x, y).q.sign() <= 0) {
            for (std::size_t k = 0; k < 8; ++k)
                if (out.asked(k)) must(same(out[k][i], 0.0f), "behind, all of a visibility buffer are 0");
            return;
        }
        const ExactSlopes slopes(exact, x, y);
        const FootprintSetup setup(*TriangleSetup::of(triangles[i / run % 2], texgen::whole_texture()), texels);
        const glm::dvec2 bound = setup.error_bound({x, y, 1, 1});
        for (std::size_t k = 0; k < 2; ++k) {
            const double length =
                std::hypot(slopes.dx[k].estimate(), slopes.dy[k].estimate()) / slopes.q_squared.estimate();
            const double allowed = bound[static_cast<int>(k)] + texgen::batch_footprint_error * length;
            if (std::isnan(allowed)) continue;
            if (out.asked(k))
                must(is_within(out[k][i], slopes.dx[k], slopes.q_squared, allowed), "a buffered d/dx is in its bound");
            if (out.asked(2 + k))
                must(is_within(out[2 + k][i], slopes.dy[k], slopes.q_squared, allowed),
                     "a buffered d/dy is in its bound");
        }
    }
};

void footprints_of_triangles(Input& input) {
    const Triangle triangle{input.vertex(), input.vertex(), input.vertex()};
    const auto tolerance = input.tolerance();
    const auto prepared = TriangleSetup::of(triangle, input.region(), tolerance);
    const double score = headlights(triangle);
    for (const texgen::WindowVertex* v : support::vertices(triangle))
        must(std::isnan(score) || (v->clip_w > 0.0f && std::isfinite(v->clip_w) && std::isfinite(v->strq.w)),
             "what is no number has no score");
    if (!prepared) return;
    const TexelsPerUnit texels = texels_of(input);
    const FootprintSetup setup(*prepared, texels);

    FragmentRect rect{input.integer(-300, 300), input.integer(-300, 300), input.integer(0, 80), input.integer(0, 10)};
    if (input.integer(0, 7) == 0) rect = {rect.x, rect.y, input.integer(1, 1200), 1};
    if (input.integer(0, 7) == 0) rect.x = input.raw<int>(), rect.y = input.raw<int>();
    const std::size_t count = support::count_of(rect);
    support::FootprintOutputs out(rect, input.raw<std::uint8_t>(), input.size(7));
    const bool written = footprint(setup, rect, out.spans());
    must(out.pads_are_intact(), "footprint writes its outputs only");
    must(written || out.is_untouched(), "where nothing is lit, nothing is written");
    must(written == (prepared->work(rect) != texgen::Work::nothing), "footprints are where coordinates are");
    const glm::dvec2 bound = setup.error_bound(rect);
    must(bound.x >= 0.0 && bound.y >= 0.0, "an error bound is no NaN, and not negative");
    const auto extremes = setup.extremes(rect);
    must(!extremes || count != 0, "an empty rectangle has no extremes");
    if (extremes) must(are_good(texels) != std::isnan(extremes->least_level), "bad texels have no extremes");
    if (const auto inside = setup.extremes())
        must(are_good(texels) != std::isnan(inside->least_level), "bad texels have no extremes");
    if (count == 0) return;

    const support::ExactTriangle exact(triangle);
    const BufferedFootprints buffered(triangle, texels, rect, input.raw<std::uint8_t>(),
                                      static_cast<std::size_t>(input.integer(1, 40)));
    for (int drawn = 0; drawn < 2; ++drawn) {
        const std::size_t i = input.raw<std::uint16_t>() % count;
        const std::int64_t x = rect.x + static_cast<std::int64_t>(i) % rect.width;
        const std::int64_t y = rect.y + static_cast<std::int64_t>(i) / rect.width;
        if (!exact.has_positive_w(x, y) || x > 0x7fffffff || y > 0x7fffffff) continue;
        const auto one = setup.at(static_cast<int>(x), static_cast<int>(y));
        buffered.require(i, static_cast<int>(x), static_cast<int>(y), exact);
        must(one.has_value() == (exact.at(x, y).q.sign() > 0), "a footprint is there exactly in front");
        if (!one) {
            for (std::size_t k = 0; k < 8 && written; ++k)
                if (out.asked(k)) must(same(out[k][i], 0.0f), "behind, all are 0");
            continue;
        }
        must(extremes.has_value(), "what is in front has extremes");
        const ExactSlopes slopes(exact, x, y);
        for (std::size_t k = 0; k < 2 && written; ++k) {
            const double allowed = bound[static_cast<int>(k)];
            if (out.asked(k))
                must(is_within(out[k][i], slopes.dx[k], slopes.q_squared, allowed), "d/dx is in its bound");
            if (out.asked(2 + k))
                must(is_within(out[2 + k][i], slopes.dy[k], slopes.q_squared, allowed), "d/dy is in its bound");
        }
        if (!are_good(texels)) {
            must(std::isnan(one->level) && std::isnan(one->anisotropy), "bad texels make no level");
            for (std::size_t k = 4; k < 8 && written; ++k)
                if (out.asked(k)) must(std::isnan(out[k][i]), "bad texels make no level");
            continue;
        }
        if (std::isnan(one->level)) continue;  // derivatives beyond the range of double
        must(one->anisotropy >= 1.0, "an anisotropy is at least 1");
        const glm::dvec2 alone = setup.error_bound({static_cast<int>(x), static_cast<int>(y), 1, 1});
        require_inside(*one, alone.x * texels.s + alone.y * texels.t, *extremes);
        if (written && out.asked(4) && !(tolerance.value > 0.0))
            must(is_in(static_cast<double>(out[4][i]), extremes->least_level, extremes->largest_level),
                 "no level is outside the extremes");
    }
}

// The two columns of J in texels, alone: what filters make of them.
void footprints_of_derivatives(Input& input) {
    const glm::dvec2 dx(input.wide_number(), input.wide_number()), dy(input.wide_number(), input.wide_number());
    const TexelsPerUnit texels = texels_of(input);
    const Footprint one = footprint_of(dx, dy, texels);
    for (int k = 0; k < 2; ++k) must(same(one.dx[k], dx[k]) && same(one.dy[k], dy[k]), "derivatives are kept");
    double largest = 0.0, least = HUGE_VAL;
    bool all_finite = true;
    for (const double d : {dx.x, dx.y, dy.x, dy.y}) {
        all_finite = all_finite && std::isfinite(d);
        if (d != 0.0) least = std::fmin(least, std::fabs(d));
        largest = std::fmax(largest, std::fabs(d));
    }
    if (!all_finite || !are_good(texels)) {
        for (const double number :
             {one.level, one.singular_values.x, one.singular_values.y, one.anisotropy, one.major.x, one.major.y})
            must(std::isnan(number), "of what is no number nothing is made");
        return;
    }
    if (largest != 0.0 && !is_in(largest, 0x1p-700, 0x1p700)) return;
    must(one.anisotropy >= 1.0, "an anisotropy is at least 1");
    must(one.singular_values.x >= one.singular_values.y && one.singular_values.y >= 0.0, "the larger comes first");
    must(std::isinf(one.level) == (largest == 0.0), "only the Jacobian 0 has no level");
    // Texels twice as dense: a level more, and nothing else.
    const Footprint twice = footprint_of(dx, dy, {2.0 * texels.s, 2.0 * texels.t});
    if (!are_good({2.0 * texels.s, 2.0 * texels.t}) || largest == 0.0) return;
    must(std::fabs(twice.level - one.level - 1.0) <= 1e-12 * std::fmax(1.0, std::fabs(one.level)),
         "twice the texels are a level more");
    must(same(twice.anisotropy, one.anisotropy), "twice the texels have the same anisotropy");
    // The same derivatives turned by a quarter of the window.
    const Footprint turned = footprint_of(dy, -dx, texels);
    must(same(turned.level, one.level), "a quarter turn of the window changes no level");
    // A power of two brings all near to 1: anisotropy does not see it.
    const int exponent = -std::ilogb(largest);
    if (least > 0x1p-900) {
        const glm::dvec2 near_dx(std::ldexp(dx.x, exponent), std::ldexp(dx.y, exponent));
        const glm::dvec2 near_dy(std::ldexp(dy.x, exponent), std::ldexp(dy.y, exponent));
        must(same(footprint_of(near_dx, near_dy, texels).anisotropy, one.anisotropy),
             "the size of a footprint does not change its shape");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Input input(data, size);
    if (input.integer(0, 3) == 0)
        footprints_of_derivatives(input);
    else
        footprints_of_triangles(input);
    return 0;
}
