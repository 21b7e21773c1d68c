// The inner loops of a batch: small tiles, without what a large one is surveyed for. Included by batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// Where the values of a tile go, whole vectors; none is null, so that loops need not ask.
template <std::size_t Numerators>
struct TileOutputs {
    float* out[Numerators];

    template <class Vector>
    TEXGEN_INLINE void put(std::size_t n, const Vector (&value)[Numerators]) const noexcept {
        TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) store(out[k] + n, value[k]);
    }
};

// Quotients in double, rounded with a certificate. False where a value is in doubt. Apart, its loop has all registers.
template <std::size_t Numerators>
TEXGEN_APART bool divide_batch_tile(const BatchPlanes& planes, const BatchTiles& tiles, std::size_t i,
                                    const ShapeOfTile& shape, const TileOutputs<Numerators>& original) noexcept {
    const TileOutputs<Numerators> out = original;
    const TileFunctions<Numerators> f(planes, tiles, i, shape.is_turned);
    const Doubles last_row = Doubles{} + shape.last_row;
    FragmentWalk<Doubles, double> walk(shape.width, shape.per_width, 0.0);
    Words doubtful{};
    for (std::size_t n = 0; n < shape.count; n += at_once, walk.advance()) {
        const Doubles y = minimum(walk.y, last_row);
        const Doubles reciprocal = 1.0 / f.at(Numerators, walk.x, y);
        Floats quotient[Numerators];
        TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) {
            const Doubles value = f.at(k, walk.x, y) * reciprocal;
            const RoundedEnds ends(value, tiles.error[k][i]);
            quotient[k] = ends.below;
            doubtful |= ends.differ();
        }
        out.put(n, quotient);
    }
    return !any(doubtful);
}

// The same for a tile whose shape is_whole and whose quotients are normal floats. The last vector of a row may overlap
// the one before.
template <std::size_t Numerators, bool HasWholeRows>
TEXGEN_APART bool divide_whole_tile(const BatchPlanes& planes, const BatchTiles& tiles, std::size_t i,
                                    const ShapeOfTile& shape, const TileOutputs<Numerators>& original) noexcept {
    const TileOutputs<Numerators> out = original;
    const TileFunctions<Numerators> f(planes, tiles, i, shape.is_turned);
    const std::size_t end = shape.count;
    const std::size_t pitch = HasWholeRows ? at_once : static_cast<std::size_t>(shape.width);
    const double rows = shape.rows;
    const int ulps = static_cast<int>(tiles.ulps[i]) - 1;
    Doubles x = shape.x;
    Distances distance = far_from_middles();
    for (std::size_t begin = 0;;) {
        // A column of vectors, from one to the next of which the functions grow by `step`; two share a division.
        Doubles value[Numerators + 1], step[Numerators + 1];
        TEXGEN_FOR (std::size_t k = 0; k <= Numerators; ++k) {
            value[k] = f.at(k, x, shape.y);
            step[k] = Doubles{} + f.down[k] * rows;
        }
        std::size_t to_next = pitch;
        for (std::size_t n = begin; n < end; n += 2 * pitch) {
            if (n + pitch >= end) {  // one alone takes both places
                to_next = 0;
                TEXGEN_FOR (Doubles& of_function : step) of_function = Doubles{};
            }
            const Doubles q = value[Numerators], next_q = q + step[Numerators];
            const SharedDivision division(q, next_q);
            value[Numerators] = next_q + step[Numerators];
            Doubles quotient[2][Numerators];
            TEXGEN_FOR (std::size_t j = 0; j < 2; ++j) {
                TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) {
                    quotient[j][k] = value[k] * division.reciprocal[j];
                    value[k] = value[k] + step[k];
                }
            }
            TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k)
                distance = nearer(distance, quotient[0][k], quotient[1][k], ulps);
            TEXGEN_FOR (std::size_t j = 0; j < 2; ++j) {
                Floats rounded[Numerators];
                TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) rounded[k] = to_floats(quotient[j][k]);
                out.put(n + j * to_next, rounded);
            }
        }
        if (HasWholeRows || begin + at_once == pitch) break;
        const std::size_t to_right = begin + 2 * at_once <= pitch ? at_once : pitch - at_once - begin;
        begin += to_right;
        x = x + static_cast<double>(to_right);
    }
    return !any_zero(distance);
}

// 1 / (1 + x), see chunks.inc.hpp; what keeps powers normal adds 2^-61 of it to the roundings.
template <bool IsPolynomial>
TEXGEN_INLINE WideFloats bent_factor(const WideFloats& x) noexcept {
    if constexpr (!IsPolynomial) return 1.0f / (x + 1.0f);
    WideFloats factor = 1.0f - x;
    WideFloats power = x * x + 0x1p-62f;  // subnormal numbers take long
    factor = factor * power + factor;
    power = power * power;
    return factor * power + factor;
}

template <std::size_t Numerators, bool HasWholeRows, bool IsPolynomial, bool BeginsWithLines = false>
TEXGEN_APART void divide_tile_float(const BatchTiles& tiles, std::size_t i, const ShapeOfTile& shape,
                                    const TileOutputs<Numerators>& original) noexcept {
    const TileOutputs<Numerators> out = original;
    const std::size_t end = shape.count;
    // A row alone is a column, whose x is 0.
    const float bend_x = tiles.bend_x[i];
    const float bend_y = shape.is_turned ? tiles.bend_x[i] : tiles.bend_y[i];
    const auto& down = shape.is_turned ? tiles.dx : tiles.dy;
    float dx[Numerators], dy[Numerators];
    WideFloats middle[Numerators];
    TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) {
        dx[k] = tiles.dx[k][i];
        dy[k] = down[k][i];
        middle[k] = WideFloats{} + tiles.middle[k][i];
    }
    const auto put = [&](std::size_t n, const WideFloats& bend, const auto& step) {
        const WideFloats factor = bent_factor<IsPolynomial>(bend);
        WideFloats value[Numerators];
        TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) value[k] = step(k) * factor + middle[k];
        out.put(n, value);
    };
    const float half_x = 0.5f * static_cast<float>(shape.width - 1);
    const auto half_y = static_cast<float>(0.5 * shape.last_row);
    // All of it, or the first vector, and those that begin with lines.
    for (std::size_t n = 0, stop = BeginsWithLines ? 1 : end;; stop = end) {
        if constexpr (HasWholeRows) {
            const auto x = load<WideFloats>(shape.wide_x + n);
            auto y = load<WideFloats>(shape.wide_y + n);
            const WideFloats bend_start = x * bend_x;
            WideFloats first[Numerators];
            TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) first[k] = x * dx[k];
            for (; n < stop; n += wide_at_once, y = y + shape.wide_rows)
                put(n, y * bend_y + bend_start, [&](std::size_t k) { return y * dy[k] + first[k]; });
        } else {
            FragmentWalk<WideFloats, float> walk(static_cast<float>(shape.width), static_cast<float>(shape.per_width),
                                                 static_cast<double>(n));
            for (; n < stop; n += wide_at_once, walk.advance()) {
                const WideFloats y = walk.y - half_y, x = walk.x - half_x;
                put(n, y * bend_y + x * bend_x, [&](std::size_t k) { return y * dy[k] + x * dx[k]; });
            }
        }
        if (!BeginsWithLines || n >= end) break;
        n = static_cast<std::size_t>(next_in_line<WideFloats>(out.out[0], 0, wide_at_once));
    }
}

// Fills a tile's place in the outputs, from `begin` on; by way of scratch where whole vectors might reach beyond what
// may be written. Returns whether no value is in doubt.
template <std::size_t Numerators>
TEXGEN_INLINE bool fill_tile(const BatchPlanes& planes, const BatchTiles& tiles, std::size_t i,
                             const ShapeOfTile& shape, const FragmentOutputs& out, std::size_t begin, bool in_scratch,
                             TileScratch& scratch) noexcept {
    TileOutputs<Numerators> here;
    TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k)
        here.out[k] = out.out[k] == nullptr || in_scratch ? scratch.values[k] : out.out[k] + begin;
    bool is_certain = true;
    if (!tiles.has(BatchTiles::is_float, i))
        is_certain = !tiles.has(BatchTiles::may_ask_middles, i) || !shape.is_whole
                         ? divide_batch_tile<Numerators>(planes, tiles, i, shape, here)
                     : shape.width <= lanes ? divide_whole_tile<Numerators, true>(planes, tiles, i, shape, here)
                                            : divide_whole_tile<Numerators, false>(planes, tiles, i, shape, here);
    else if (!tiles.has(BatchTiles::is_polynomial, i))
        divide_tile_float<Numerators, false, false>(tiles, i, shape, here);
    else if (wide_lanes == 16 && out.are_beyond(floats_in_first_cache) && !begins_with_line<WideFloats>(here.out[0]) &&
             (shape.has_wide_columns || (Numerators == 3 && shape.count > 8 * wide_at_once)))
        // One vector more takes longer than lines do that it spares of two arrays, where it has to find its rows.
        shape.has_wide_columns ? divide_tile_float<Numerators, true, true, true>(tiles, i, shape, here)
                               : divide_tile_float<Numerators, false, true, Numerators == 3>(tiles, i, shape, here);
    else if (shape.has_wide_columns)
        divide_tile_float<Numerators, true, true>(tiles, i, shape, here);
    else
        divide_tile_float<Numerators, false, true>(tiles, i, shape, here);
    if (out.lit != nullptr) {
        float* const lit = in_scratch ? scratch.values[3] : out.lit + begin;
        // The last vector may end behind what the tile has written, where NaNs would raise an exception.
        if (shape.count % wide_at_once != 0)
            TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) store(here.out[k] + shape.count, WideFloats{});
        for (std::size_t n = 0; n < shape.count; n += wide_at_once) {
            if (tiles.has(BatchTiles::is_lit, i)) {
                store(lit + n, WideFloats{} + 1.0f);
                continue;
            }
            WideFloats value[Numerators];
            TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) value[k] = load<WideFloats>(here.out[k] + n);
            store(lit + n, one_where(out.are_inside(value)));
        }
    }
    if (in_scratch) scratch.copy_to(out, begin, shape.count);
    return is_certain;
}

// Fills the outputs of a tile with one value.
TEXGEN_APART inline void fill_all(const FragmentOutputs& out, std::size_t begin, std::size_t count,
                                  float value) noexcept {
    const WideFloats values = WideFloats{} + value;
    for (float* const array : {out.out[0], out.out[1], out.out[2], out.lit}) {
        if (array == nullptr) continue;
        std::size_t n = begin;
        for (; n + wide_at_once <= begin + count; n += wide_at_once) store(array + n, values);
        for (; n < begin + count; ++n) array[n] = value;
    }
}

template <std::size_t Numerators>
TEXGEN_INLINE Undecided divide_all_tiles(const TilesJob& job, std::size_t first, std::size_t done) noexcept {
    const FragmentOutputs out{job};
    TileScratch scratch;
    BatchTiles tiles;
    ShapeOfTile shape;
    // Within a tolerance a set-up's chunks take less than large tiles do here, the sooner the fewer lanes there are.
    constexpr std::size_t largest_in_float = wide_lanes == 16 ? 2048 : lanes < 4 ? largest_in_scratch : 1024;
    std::size_t most = job.tolerance > 0.0 ? largest_in_float : largest_batch_tile;
    for (std::size_t k = 0; k < Numerators; ++k)
        if (out.out[k] == nullptr) most = largest_in_scratch;
    const bool is_mask_alone = out.out[0] == nullptr && out.out[1] == nullptr && out.out[2] == nullptr;
    for (; first < job.tile_count; first += batch_block) {
        const std::size_t count = job.tile_count - first < batch_block ? job.tile_count - first : batch_block;
        tiles.kinds = 0;
        // The last tiles are copied to a whole block.
        int padded[batch_block][4];
        const int(*block)[4] = job.tiles + first;
        if (count < batch_block) {
            std::memset(padded, 0, sizeof padded);
            std::memcpy(padded, block, count * sizeof padded[0]);
            block = padded;
        }
        for (std::size_t i = 0; i < count; i += at_once) {
            const BatchPlanes* const planes = job.planes + first + i;
            const std::uint64_t asked = (std::uint64_t{1} << (count - i)) - 1;
            const bool is_all_float =
                job.tolerance > 0.0 &&
                (lane_bits(~prepare_in_float<Numerators>(job, planes, block + i, i, tiles)) & asked) == 0;
            if (!is_all_float) prepare<Numerators>(job, planes, block + i, i, tiles);
        }
        std::uint64_t doubtful = 0, in_doubt = 0;
        const std::size_t begin_of_block = done;
        for (std::size_t i = 0; i < count; ++i) {
            const int width = job.tiles[first + i][2], height = job.tiles[first + i][3];
            if (width <= 0 || height <= 0) continue;
            if (!shape.is_of(width, height)) shape.take(width, height);
            const std::size_t begin = done;
            done += shape.count;
            if (tiles.has(BatchTiles::is_dark, i) || (is_mask_alone && tiles.has(BatchTiles::is_lit, i))) {
                fill_all(out, begin, shape.count, tiles.has(BatchTiles::is_dark, i) ? 0.0f : 1.0f);
                continue;
            }
            const bool is_large = shape.count > largest_in_scratch;
            const bool is_at_end = done + wide_at_once > job.count;
            const bool is_certain =
                shape.count <= (is_at_end ? largest_in_scratch : most) &&
                (tiles.has(BatchTiles::is_exact, i) || tiles.has(BatchTiles::is_float, i)) &&
                fill_tile<Numerators>(job.planes[first + i], tiles, i, shape, out, begin, is_at_end, scratch);
            if (!is_certain) (is_large ? doubtful : in_doubt) |= std::uint64_t{1} << i;
        }
        if (in_doubt != 0) doubtful |= decide_tiles(job, out, first, block, tiles, in_doubt, begin_of_block);
        if (doubtful != 0) return {first, doubtful};
    }
    return {job.tile_count, 0};
}

template <class CompiledWhereCalled = void>
Undecided divide_batch_tiles(const TilesJob& original, std::size_t first, std::size_t done) noexcept {
    const TilesJob job = original;
    return job.needs_r() ? divide_all_tiles<3>(job, first, done) : divide_all_tiles<2>(job, first, done);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
