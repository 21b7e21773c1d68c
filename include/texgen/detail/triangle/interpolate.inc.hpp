// The outputs of a triangle, one after another, and the body of interpolate(). Included by interpolate.hpp. A column
// that one certificate does not serve is taken as a row of the mirrored triangle, as vectors are parts of rows.

namespace TEXGEN_DETAIL_BUILD {

// Darkens the fragments of a tile whose r is beyond the depth; r has no output. The tile is halved until the buffer
// holds it; r is not computed for a half where nothing is lit, or all is in the depth.
template <class CompiledWhereCalled = void>
TEXGEN_RARE inline void darken_beyond_depth(const TriangleFunctions& triangle, const Tile& rect, const Tile& tile,
                                            const std::span<float>& buffer, const std::span<float>& lit) noexcept {
    const auto count = static_cast<std::size_t>(tile.count());
    if (count > buffer.size()) {
        for (const Tile& half : tile.halves()) {
            const Plan plan = survey(triangle, half).plan;
            if (plan.work == Work::nothing)
                fill_rows(lit, rect, half, 0.0f);
            else if (plan.depth != Coverage::inside)
                darken_beyond_depth(triangle, rect, half, buffer, lit);
        }
        return;
    }
    interpolate_alone(triangle, tile, 2, buffer.first(count));
    // Rows that follow one another are one.
    const std::size_t rows = tile.width == rect.width ? 1 : static_cast<std::size_t>(tile.height);
    const std::size_t length = count / rows;
    float* const first = lit.data() + offset_in(rect, tile.x, tile.y);
    for (std::size_t y = 0; y < rows; ++y)
        chosen<MaskKernels>().darken(first + y * static_cast<std::size_t>(rect.width), buffer.data() + y * length,
                                     length, triangle.lit.r_min, triangle.lit.r_max);
}

// Darkens a mask that s and t have made where r is beyond the depth; r is read from its output, if it has one.
template <class CompiledWhereCalled = void>
TEXGEN_APART void darken_beyond_depth(const TriangleFunctions& triangle, const Tile& tile,
                                      const Texcoords& out) noexcept {
    if (out.lit.empty()) return;
    if (out.r.empty()) {
        float buffer[1024];
        darken_beyond_depth(triangle, tile, tile, buffer, out.lit);
    } else {
        chosen<MaskKernels>().darken(out.lit.data(), out.r.data(), out.lit.size(), triangle.lit.r_min,
                                     triangle.lit.r_max);
    }
}

// Makes the mask of a part of few fragments from s and t as they would be written, if one certificate serves all.
template <class CompiledWhereCalled = void>
bool light_small(const TriangleFunctions& triangle, const Tile& rect, const Tile& part,
                 const std::span<float>& lit) noexcept {
    if (part.count() > TileJob::unit_size) return false;
    float mask[TileJob::unit_size];
    Texcoords out;
    out.lit = {mask, static_cast<std::size_t>(part.count())};
    if (fill_small(triangle, part, out) == SmallAnswer::doubt) return false;
    float* to = lit.data() + offset_in(rect, part.x, part.y);
    const auto width = static_cast<std::size_t>(part.width);
    for (const float* from = mask; from != mask + part.count(); from += width, to += rect.width)
        std::memcpy(to, from, width * sizeof(float));
    return true;
}

// Fills the mask, if it is asked for, and s or t, if one of them is. That is computed with the other one for the mask,
// where it takes less.
template <class CompiledWhereCalled = void>
TEXGEN_APART void fill_one_and_mask(const TriangleFunctions& triangle, const Tile& tile, TileSurvey& found,
                                    const Texcoords& out) noexcept {
    Tile rest = tile;
    const bool has_one = out.s.size() + out.t.size() != 0;
    if (out.lit.empty() || !has_one || (triangle.tolerance == 0.0 && tile.count() > most_in_scratch)) {
        interpolate_alone(triangle, tile, found.in_doubt, 0, out.s, &found.plan);
        interpolate_alone(triangle, tile, found.in_doubt, 1, out.t, &found.plan);
        if (out.lit.empty()) return;
        rest = light_spans(triangle, tile, found.at, out.lit);
        if (rest.count() == 0 || light_small(triangle, tile, rest, out.lit)) return;
    }
    TileInterpolator<>(triangle, triangle.st, tile, found.in_doubt, 0, 1, out).interpolate_in_strips(rest, found.plan);
}

// Interpolates a rectangle by a plan; empty outputs are not computed.
template <class CompiledWhereCalled = void>
TEXGEN_APART Work interpolate_by_plan(const TriangleFunctions& triangle, const Tile& tile,
                                      const Texcoords& out) noexcept {
    if (tile.is_column()) return interpolate_by_plan(triangle.mirrored(), tile.mirrored(), out);
    TileSurvey found = survey_rows(triangle, tile);
    const Plan& plan = found.plan;
    if (plan.work == Work::nothing) {
        for (float& lit : out.lit) lit = 0.0f;
        return plan.work;
    }

    // What is certainly inside is lit, and s and t need not be compared.
    const bool is_inside = plan.sides == Coverage::inside;
    if (is_inside && !out.lit.empty()) chosen<MaskKernels>().light_all(out.lit.data(), out.lit.size());
    if (!out.s.empty() && !out.t.empty()) {
        TileInterpolator<> interpolator(triangle, triangle.st, tile, found.in_doubt, 0, 1, out);
        if (is_inside) interpolator.leave_mask();
        interpolator.interpolate(tile, found.at, plan);
    } else {
        Texcoords asked = out;
        if (is_inside) asked.lit = {};
        fill_one_and_mask(triangle, tile, found, asked);
    }
    interpolate_alone(triangle, tile, found.in_doubt, 2, out.r, nullptr);
    if (plan.depth != Coverage::inside) darken_beyond_depth(triangle, tile, out);
    return plan.work;
}

// Interpolates a rectangle, without a plan where none is needed.
template <class CompiledWhereCalled = void>
TEXGEN_INLINE Work interpolate_tile(const TriangleSetup& setup, const Tile& tile, const Texcoords& out) noexcept {
    const TriangleFunctions& triangle = Inside::functions(setup);
    Coverage depth = Coverage::inside;
    SmallAnswer answer = SmallAnswer::doubt;
    if (is_small(tile, triangle.tolerance)) {
        if (triangle.lit.has_depth) depth = depth_coverage(triangle, tile);
        if (depth != Coverage::outside) answer = fill_small(triangle, tile, out);
    }
    if (answer == SmallAnswer::doubt) return interpolate_by_plan(triangle, tile, out);
    if (depth != Coverage::inside) darken_beyond_depth(triangle, tile, out);
    const bool is_lit = answer == SmallAnswer::lit && depth == Coverage::inside;
    return is_constant(triangle.q.value) ? Work::affine : is_lit ? Work::divide : Work::divide_and_test;
}

}  // namespace TEXGEN_DETAIL_BUILD

namespace TEXGEN_NAMESPACE_BUILD {

template <class CompiledWhereCalled>
TEXGEN_INLINE Work interpolate(const TriangleSetup& setup, const FragmentRect& rect, const Texcoords& asked) noexcept {
    Texcoords out = asked;
    const std::size_t count = detail::count_of(rect);
    if (count == 0) return Work::nothing;
    detail::drop_unasked(out, count);
    return detail::interpolate_tile(setup, detail::tile_of(rect), out);
}

}  // namespace TEXGEN_NAMESPACE_BUILD
