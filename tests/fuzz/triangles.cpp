// Triangles, their rectangles and the clip over raw bytes: nothing but the outputs is written, `nothing` means that
// nothing is lit, fragments that are drawn for it are right by the exact judge, and what is clipped keeps its contract.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fuzz/input.hpp"
#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/verdict.hpp"
#include "support/footprint_outputs.hpp"
#include "support/outputs.hpp"
#include "texgen/batch.hpp"
#include "texgen/clip.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/reference.hpp"

namespace {

using fuzz::Input;
using fuzz::must;
using fuzz::must_be_right;
using support::Dyadic;
using support::Outputs;
using texgen::ClipVertex;
using texgen::FragmentRect;
using texgen::Tolerance;
using texgen::TriangleSetup;
using texgen::Work;

bool is_usable(const texgen::WindowVertex& v) {
    return std::isfinite(v.window.x) && std::isfinite(v.window.y) && std::isfinite(v.clip_w) && v.clip_w > 0.0f &&
           fuzz::all_finite(v.strq);
}

// The precondition of the reference in double.
bool has_exact_differences(const texgen::Triangle& triangle) {
    for (const texgen::WindowVertex* v : support::vertices(triangle))
        for (int k = 0; k < 2; ++k)
            if (const float size = std::fabs(v->window[k]); size != 0.0f && !(size >= 0x1p-13f && size < 0x1p17f))
                return false;
    return true;
}

void interpolate_triangle(Input& input) {
    const texgen::Triangle triangle{input.vertex(), input.vertex(), input.vertex()};
    const texgen::TextureRegion region = input.region_with_depth();
    const Tolerance tolerance = input.tolerance();
    const auto setup = TriangleSetup::of(triangle, region, tolerance);
    const bool usable = is_usable(triangle.a) && is_usable(triangle.b) && is_usable(triangle.c);
    must(usable || !setup, "no setup comes of a bad number");
    if (!setup) return;

    FragmentRect rect{input.integer(-300, 300), input.integer(-300, 300), input.integer(0, 80), input.integer(0, 10)};
    if (input.integer(0, 3) == 0) rect = {rect.x, rect.y, input.integer(1, 1200), 1};
    if (input.integer(0, 3) == 0) rect.width = 32 + input.integer(0, 40), rect.height = 8 + input.integer(0, 40);
    if (input.integer(0, 7) == 0) rect.x = input.raw<int>(), rect.y = input.raw<int>();
    const std::size_t count = support::count_of(rect);
    const unsigned asked = input.raw<std::uint8_t>() & 15u;
    Outputs out(count, asked, input.size(7));
    const Work work = interpolate(*setup, rect, out.spans());
    must(out.pads_are_intact(), "interpolate writes its outputs only");
    must(work == setup->work(rect), "interpolate does what work() says");
    const glm::dvec2 bound = setup->error_bound(rect);
    must(bound.x >= 0.0 && bound.y >= 0.0, "an error bound is no NaN, and not negative");
    if (count == 0) return;

    const support::Shot shot{triangle, rect};
    const support::ExactTriangle exact(triangle);
    support::Seen seen;
    for (int drawn = 0; drawn < 3; ++drawn) {
        const std::size_t i = input.raw<std::uint16_t>() % count;
        must_be_right(what_is_wrong(shot, exact, region, tolerance, work, out, i, seen));
        const std::int64_t x = shot.x(static_cast<std::int64_t>(i) % rect.width);
        const std::int64_t y = shot.y(static_cast<std::int64_t>(i) / rect.width);
        if (!exact.has_positive_w(x, y)) continue;
        const support::Homogeneous at = exact.at(x, y);
        if (work == Work::nothing) {
            must(!support::contains(region, at), "nothing is done only where nothing is lit");
        } else if (at.q.sign() > 0) {
            for (std::size_t k = 0; k < 2; ++k)
                if (out.asked(k) && std::isfinite(bound[static_cast<int>(k)]))
                    must(support::is_within(out[k][i], at.over_q(k), bound[static_cast<int>(k)]),
                         "no error is larger than error_bound says");
        }
    }
    if (support::Outputs one(1, asked); !(tolerance.value > 0.0) && work != Work::nothing) {
        const std::size_t i = input.raw<std::uint16_t>() % count;
        const std::int64_t x = shot.x(static_cast<std::int64_t>(i) % rect.width);
        const std::int64_t y = shot.y(static_cast<std::int64_t>(i) / rect.width);
        if (x > 0x7fffffff || y > 0x7fffffff || !exact.has_positive_w(x, y)) return;
        const Work alone =
            interpolate(*setup, FragmentRect{static_cast<int>(x), static_cast<int>(y), 1, 1}, one.spans());
        for (std::size_t k = 0; k < 4; ++k)
            if (out.asked(k) && (k == 3 || alone != Work::nothing))
                must(fuzz::same(one[k][0], out[k][i]), "a fragment's bits are those that it has alone");
    }
    if (support::Outputs reference(count, asked); count <= 100 && has_exact_differences(triangle)) {
        texgen::reference::interpolate(triangle, region, rect, reference.spans());
        must(reference.pads_are_intact(), "the reference writes its outputs only");
    }
}

// A batch writes its outputs only, keeps the tolerance, and has with `exact` what each of its triangles has alone.
void interpolate_batch(Input& input) {
    std::vector<texgen::Triangle> triangles;
    std::vector<FragmentRect> rects;
    std::size_t fragments = 0;
    for (std::size_t i = input.size(10); i > 0; --i) {
        triangles.push_back({input.vertex(), input.vertex(), input.vertex()});
        rects.push_back(
            {input.integer(-300, 300), input.integer(-300, 300), input.integer(0, 17), input.integer(0, 9)});
        if (input.integer(0, 7) == 0) rects.back().x = input.raw<int>(), rects.back().y = input.raw<int>();
        fragments += support::count_of(rects.back());
    }
    const texgen::TextureRegion region = input.region_with_depth();
    const Tolerance tolerance = input.tolerance();
    const unsigned asked = input.raw<std::uint8_t>() & 15u;
    texgen::TriangleBatch batch(region, tolerance);
    const bool skips_away = input.coin();
    const auto origin = input.coin() ? texgen::TextureOrigin::bottom_left : texgen::TextureOrigin::top_left;
    if (skips_away)
        batch.assign_facing(triangles, origin);
    else
        batch.assign(triangles);
    Outputs out(fragments, asked, input.size(7));
    interpolate(batch, rects, out.spans());
    must(out.pads_are_intact(), "a batch writes its outputs only");

    const FragmentRect rect{input.integer(-300, 300), input.integer(-300, 300), input.integer(1, 20),
                            input.integer(1, 4)};
    std::vector<std::uint32_t> ids(support::count_of(rect));
    for (std::uint32_t& id : ids) {
        id = static_cast<std::uint32_t>(input.integer(0, static_cast<int>(triangles.size())));
        if (id == triangles.size()) id = texgen::no_triangle;
    }
    Outputs by_id(ids.size(), asked, input.size(7));
    interpolate(batch, ids, rect, by_id.spans());
    must(by_id.pads_are_intact(), "a visibility buffer writes its outputs only");
    const auto setup_of = [&](std::size_t i) {
        const auto& [a, b, c] = triangles[i];
        const bool is_away = facing(a.strq, b.strq, c.strq, origin) == texgen::Facing::away;
        return skips_away && is_away ? std::nullopt : TriangleSetup::of(triangles[i], region, tolerance);
    };
    const auto has_same_bits = [&](const Outputs& all, std::size_t first, std::size_t i, const FragmentRect& part) {
        Outputs alone(support::count_of(part), asked | 8u);
        if (tolerance.value > 0.0) return;
        const auto setup = setup_of(i);
        const bool is_written = setup && interpolate(*setup, part, alone.spans()) != Work::nothing;
        bool is_lit = false;
        for (std::size_t n = 0; is_written && n < alone.size(); ++n) is_lit = is_lit || alone[3][n] != 0.0f;
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t n = 0; asked >> k & 1u && n < alone.size(); ++n)
                must((is_written && fuzz::same(all[k][first + n], alone[k][n])) ||
                         (!is_lit && (all[k][first + n] == 0.0f || (setup && !is_written && k != 3))),
                     "a fragment's bits are those that its triangle has alone, or 0 where nothing is lit");
    };
    // One of them by the exact judge.
    const auto keeps = [&](const Outputs& all, std::size_t first, std::size_t i, const FragmentRect& part) {
        const std::size_t n = input.size(255) % support::count_of(part);
        bool is_zero = true;
        for (std::size_t k = 0; k < 4; ++k) is_zero = is_zero && (!all.asked(k) || all[k][first + n] == 0.0f);
        if (!setup_of(i)) return must(is_zero, "of what is refused all is 0");
        const support::ExactTriangle exact(triangles[i]);
        const support::Shot shot{triangles[i], part};
        const auto x = shot.x(static_cast<std::int64_t>(n) % part.width);
        const auto y = shot.y(static_cast<std::int64_t>(n) / part.width);
        if (!exact.has_positive_w(x, y)) return;
        const support::Homogeneous at = exact.at(x, y);
        if (!is_zero)
            must_be_right(what_is_wrong(at, region, tolerance, all, first + n));
        else if (!(tolerance.value > 0.0) && support::contains(region, at))
            must_be_right(what_is_wrong(at, region, tolerance, all, first + n));
    };
    const std::size_t judged = input.size(9);
    for (std::size_t i = 0, first = 0; i < rects.size(); first += support::count_of(rects[i]), ++i) {
        has_same_bits(out, first, i, rects[i]);
        if (i == judged && support::count_of(rects[i]) != 0) keeps(out, first, i, rects[i]);
    }
    const auto width = static_cast<std::size_t>(rect.width);
    const std::size_t judged_id = input.size(79);
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const FragmentRect one{rect.x + static_cast<int>(i % width), rect.y + static_cast<int>(i / width), 1, 1};
        if (ids[i] == texgen::no_triangle) continue;
        has_same_bits(by_id, i, ids[i], one);
        if (i == judged_id) keeps(by_id, i, ids[i], one);
    }

    // Footprints of the last row.
    if (!input.coin()) return;
    const FragmentRect row{rect.x, rect.y + rect.height - 1, rect.width, 1};
    const std::span<const std::uint32_t> ids_of_row = std::span(ids).last(width);
    const texgen::TexelsPerUnit texels{1.0 + input.integer(0, 4095), input.coin() ? 512.0 : input.wide_number()};
    const unsigned footprints_asked = input.raw<std::uint8_t>();
    support::FootprintOutputs footprints(row, footprints_asked, input.size(7));
    footprint(batch, ids_of_row, row, texels, footprints.spans());
    must(footprints.pads_are_intact(), "a visibility buffer's footprints are its outputs only");
    // What is no triangle's is 0; the others' errors are judged in footprints.cpp.
    for (std::size_t i = 0; i < width; ++i) {
        if (ids_of_row[i] != texgen::no_triangle && setup_of(ids_of_row[i])) continue;
        for (std::size_t k = 0; k < 8; ++k)
            must(!footprints.asked(k) || footprints[k][i] == 0.0f, "a footprint of no triangle is 0");
    }
}

std::vector<ClipVertex> polygon_of(Input& input) {
    std::vector<ClipVertex> polygon(input.size(9));
    for (ClipVertex& v : polygon) v = {input.vector4(), input.vector4()};
    return polygon;
}

void clip_near(Input& input) {
    const std::vector<ClipVertex> polygon = polygon_of(input);
    const auto range = input.coin() ? texgen::DepthRange::zero_to_one : texgen::DepthRange::negative_one_to_one;
    const bool reversed = input.coin();
    const texgen::Viewport viewport{input.raw<int>(), input.raw<int>(), input.raw<int>(), input.raw<int>()};
    std::vector<ClipVertex> out(polygon.size() + 1 + input.size(2));
    const std::size_t count = clip_to_near(polygon, out, range, reversed);
    must(count <= out.size() && (count == 0 || count >= 3), "a polygon has three vertices, or there is none");
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec4& p = out[i].position;
        must(p.w > 0.0f, "what comes out is in front of the eye");
        const double z = static_cast<double>(p.z), w = static_cast<double>(p.w);
        must(reversed                                   ? z <= w
             : range == texgen::DepthRange::zero_to_one ? z >= 0.0
                                                        : z + w >= 0.0,
             "what comes out is in front of the near plane");
        const texgen::WindowVertex window = to_window(out[i], viewport);
        must(!std::isnan(window.window.x) && !std::isnan(window.window.y), "to_window makes no NaN of numbers");
        must(fuzz::same(window.strq, out[i].strq) && fuzz::same(window.clip_w, p.w), "to_window keeps strq and w");
    }
}

void clip_slide(Input& input) {
    const std::vector<ClipVertex> polygon = polygon_of(input);
    const texgen::TextureRegion region = input.region_with_depth();
    std::vector<ClipVertex> out(polygon.size() + (region.depth() ? 7 : 5) + input.size(4));
    const std::size_t count = clip_to_slide(polygon, region, out);
    must(count <= out.size() && (count == 0 || count >= 3), "a polygon has three vertices, or there is none");
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec4& strq = out[i].strq;
        must(strq.w > 0.0f, "what comes out is in front of the projector");
        const auto q = static_cast<double>(strq.w);
        for (int k = 0; k < (region.depth() ? 3 : 2); ++k) {
            const double u = static_cast<double>(strq[k]);
            const double min = k == 2 ? region.depth()->x : region.min()[k];
            const double max = k == 2 ? region.depth()->y : region.max()[k];
            const double room = texgen::slide_clip_error * std::fmax(std::fabs(min), std::fabs(max)) * q;
            // Products that leave the normal floats are promised nothing.
            if (!(room < 0x1p120) || !(q > 0x1p-100) || !(room > 0x1p-120)) continue;
            must(min * q - u <= room && u - max * q <= room, "what comes out is inside the region");
        }
    }
}

void planes_of_clip(Input& input) {
    const glm::dmat4 matrix = input.wide_matrix();
    const texgen::TextureRegion region = input.region_with_depth();
    const texgen::ClipPlanes planes = clip_planes(texgen::ObjectTexgen(matrix), region);
    must(planes.size() == (region.depth() ? 7 : 5), "a side is a plane");
    for (int i = 0; i < 4; ++i) {
        const double q = matrix[i].w;
        must(fuzz::same(planes[0][i], static_cast<float>(q)), "the first plane is q");
        for (std::size_t k = 1; k < planes.size(); ++k) {
            const std::size_t coordinate = (k - 1) / 2;
            const glm::dvec2 limits = support::limits_of(region, coordinate);
            const double bound = k % 2 == 1 ? limits.x : limits.y, sign = k % 2 == 1 ? 1.0 : -1.0;
            const double u = matrix[i][static_cast<int>(coordinate)];
            const float value = planes[k][i];
            if (coordinate == 2 && bound == -sign * HUGE_VAL) {
                must(fuzz::same(value, static_cast<float>(q)), "no limit of depth is q");
                continue;
            }
            if (!std::isfinite(u) || !std::isfinite(q) || !std::isfinite(bound)) {
                must(!std::isfinite(value) || std::isfinite(bound), "what is not finite stays so");
                continue;
            }
            const Dyadic exact = Dyadic(sign) * (Dyadic(u) - Dyadic(bound) * Dyadic(q));
            if (exact.sign() == 0) must(value == 0.0f, "a coefficient 0 is 0");
            must(exact.sign() == 0 || std::signbit(value) == (exact.sign() < 0), "a coefficient has its sign");
            if (std::isinf(value)) {
                must(Dyadic(0x1.fffffefp127) <= magnitude(exact), "a coefficient is infinite beyond the largest float");
                continue;
            }
            const float size = std::fabs(value);
            const double ulp = std::isinf(std::nextafter(size, HUGE_VALF))
                                   ? 0x1p104
                                   : static_cast<double>(std::nextafter(size, HUGE_VALF)) - static_cast<double>(size);
            must(magnitude(Dyadic(static_cast<double>(value)) - exact) <= Dyadic((0.5 + 0x1p-29) * ulp),
                 "a coefficient is next to the exact one");
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Input input(data, size);
    switch (input.integer(0, 5)) {
        case 0:
            clip_near(input);
            break;
        case 3:
            planes_of_clip(input);
            break;
        case 1:
            clip_slide(input);
            break;
        case 2:
            interpolate_batch(input);
            break;
        default:
            interpolate_triangle(input);
            break;
    }
    return 0;
}
