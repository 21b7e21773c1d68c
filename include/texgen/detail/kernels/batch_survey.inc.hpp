// What is known of a batch's tiles before they are divided, a block of them in lanes. Included by batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// What the kernels need to know of a block of tiles: numerators, q and bounds for the quotients in double; in float,
// about the middle of the tile, u + (dx x + dy y) / (1 + bend_x x + bend_y y).
struct BatchTiles {
    double base[3][batch_block], q[batch_block], error[3][batch_block];
    double ulps[batch_block];  // so many of their own ulps quotients are within; a power of two
    float middle[3][batch_block], dx[3][batch_block], dy[3][batch_block], bend_x[batch_block], bend_y[batch_block];
    // A bit for each tile and kind, in one number: a load of several numbers would wait for their stores.
    enum Kind : std::size_t { is_dark, is_lit, is_exact, may_ask_middles, is_float, is_polynomial };
    std::uint64_t kinds;

    TEXGEN_INLINE void add(Kind kind, const LongWords& mask, std::size_t first) noexcept {
        kinds |= lane_bits(mask) << (kind * batch_block + first);
    }
    TEXGEN_INLINE bool has(Kind kind, std::size_t i) const noexcept { return (all(kind) >> i & 1u) != 0; }
    TEXGEN_INLINE std::uint64_t all(Kind kind) const noexcept { return kinds >> (kind * batch_block) & 0xff; }
};

// A tile in each lane: its first fragment, from the vertex that its functions are about; the steps to its last column
// and row; by how much more the functions may err there than at the vertices; and roundings of a sum for each vector.
struct TileLanes {
    Doubles x, y, right, bottom, stretch, sums;

    TEXGEN_INLINE TileLanes(const int (*tile)[4], const BatchLanes& planes) noexcept {
        Words given[4];
        load_fours(*tile, given);
        const Doubles width = to_doubles(given[2]), height = to_doubles(given[3]);
        x = to_doubles(given[0]) + 0.5 - planes[BatchPlanes::origin];
        y = to_doubles(given[1]) + 0.5 - planes[BatchPlanes::origin + 1];
        right = width - 1.0;
        bottom = height - 1.0;
        stretch = maximum(maximum((magnitude(x) + width) * planes[BatchPlanes::per_reach],
                                  (magnitude(y) + height) * planes[BatchPlanes::per_reach + 1]),
                          Doubles{} + 1.0);
        sums = (width * height * (1.0 / lanes) + 8.0) * unit_roundoff_double;
    }
};

// A linear function of the window over a tile: at its corner fragments, and a bound on its error. At a fragment of the
// first vectors two products, of at most twice its size, and two sums are rounded, by 6 u of it; and one sum for each
// vector below.
struct TileFunction {
    Doubles dx, dy, at[4], least, largest, size, error;

    TEXGEN_INLINE TileFunction(const Doubles* function, const TileLanes& tile) noexcept {
        dx = function[1];
        dy = function[2];
        at[0] = function[0] + (dx * tile.x + dy * tile.y) + 0.0;  // no -0
        at[1] = at[0] + dx * tile.right;
        at[2] = at[0] + dy * tile.bottom;
        at[3] = at[2] + dx * tile.right;
        least = least_at_corners(at);
        largest = largest_at_corners(at);
        size = maximum(largest, least * -1.0);
        error = function[3] * tile.stretch + size * tile.sums;
    }

    TEXGEN_INLINE static Doubles least_at_corners(const Doubles (&at)[4]) noexcept {
        return minimum(minimum(at[0], at[1]), minimum(at[2], at[3]));
    }
    TEXGEN_INLINE static Doubles largest_at_corners(const Doubles (&at)[4]) noexcept {
        return maximum(maximum(at[0], at[1]), maximum(at[2], at[3]));
    }
};

// The tiles whose fragments in front are all below a bound, such as a side of the region, or all above it, with the
// margins of coverage_by_sides() in triangle/corners.hpp.
struct Beyond {
    LongWords below, above;

    TEXGEN_INLINE Beyond(const TileFunction& f, const TileFunction& q, double bound, double tolerance) noexcept {
        const double size = std::fabs(bound);
        const double slack = size * 0x1p-22 + (0x1p-125 + 2.0 * tolerance);
        const Doubles margin = (f.error + q.error * (size + slack) + q.size * (slack + size * gamma(4))) * 1.0002;
        Doubles g[4];
        TEXGEN_FOR (std::size_t i = 0; i < 4; ++i) g[i] = f.at[i] - q.at[i] * bound;
        below = greater(margin * -1.0, TileFunction::largest_at_corners(g));
        above = greater(TileFunction::least_at_corners(g), margin);
    }
};

// Prepares tiles in float. Returns those that need no more: floats serve, and the middle is lit.
// In float a tile is treated as a chunk is (chunks.inc.hpp), in two directions. With r = 2^-24 the numerator of a step
// D errs by 3 r D, x of the denominator by 3 r X, X being its largest, and the step by 3 r X / (1 - X) D for that; the
// polynomial adds 3 r D (a division 2 r D), the product r D, and the value r D + 2 r |u|.
template <std::size_t Numerators>
TEXGEN_INLINE LongWords prepare_in_float(const BatchJob& job, const BatchPlanes* of_tiles, const int (*block)[4],
                                         std::size_t first, BatchTiles& tiles) noexcept {
    const BatchLanes planes([&](std::size_t j) { return of_tiles[j].value; }, Numerators == 3);
    const TileLanes tile(block, planes);
    // Slopes across a single column or row are of no use, and might be infinite.
    const LongWords has_columns = greater(tile.right, 0.0), has_rows = greater(tile.bottom, 0.0);
    const Doubles half_x = tile.right * 0.5, half_y = tile.bottom * 0.5;
    const Doubles middle_x = tile.x + half_x, middle_y = tile.y + half_y;
    const Doubles* const q = &planes.value[BatchPlanes::q];
    const Doubles middle_q = q[0] + (q[1] * middle_x + q[2] * middle_y);
    const Doubles q_error = q[3] * tile.stretch;
    const Doubles per_q = 1.0 / middle_q;
    const Doubles bend_x = where(has_columns, q[1] * per_q), bend_y = where(has_rows, q[2] * per_q);
    store(&tiles.bend_x[first], to_floats(bend_x));
    store(&tiles.bend_y[first], to_floats(bend_y));
    const Doubles extent = magnitude(bend_x) * half_x + magnitude(bend_y) * half_y;
    const Doubles stretched = (extent * 4.0 + 1.0) * extent + 1.0;
    Doubles share = extent * extent;
    share = share * share;
    share = share * share;
    const Doubles step_error = (extent * stretched * 3.1 + 8.1) * unit_roundoff_float;
    const Doubles error_share = per_q * stretched * 1.001;
    const Doubles tolerance = Doubles{} + job.tolerance * share_for_tiles;
    LongWords is_float = greater(middle_q, q_error * 0x1p26) & at_most(extent, Doubles{} + 0.75);
    LongWords is_polynomial = at_most(extent, Doubles{} + 0.25);
    LongWords is_inside = is_float, is_lit = is_float;
    TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) {
        const Doubles* const f = &planes.value[BatchPlanes::of_coordinate[k]];
        const Doubles u = (f[0] + (f[1] * middle_x + f[2] * middle_y)) * per_q;
        const Doubles slope_x = where(has_columns, (f[1] - u * q[1]) * per_q);
        const Doubles slope_y = where(has_rows, (f[2] - u * q[2]) * per_q);
        store(&tiles.middle[k][first], to_floats(u));
        store(&tiles.dx[k][first], to_floats(slope_x));
        store(&tiles.dy[k][first], to_floats(slope_y));
        const Doubles step = (magnitude(slope_x) * half_x + magnitude(slope_y) * half_y) * stretched;
        const Doubles size_u = magnitude(u);
        const Doubles rest = size_u * (2.001 * unit_roundoff_float) + (step * step_error + 0x1p-113) +
                             ((size_u + step) * q_error + f[3] * tile.stretch) * error_share;
        is_float &= at_most(rest, tolerance);
        is_polynomial &= at_most(rest + step * share, tolerance);
        if (k == 2 && !job.has_depth) continue;
        const double min = job.least[k], max = job.greatest[k];
        is_inside &= ~(greater(u, max) | greater(Doubles{} + min, u));
        is_lit &= greater(u - (step + rest), min) & greater(Doubles{} + max, u + (step + rest));
    }
    tiles.add(BatchTiles::is_float, is_float, first);
    tiles.add(BatchTiles::is_polynomial, is_polynomial & is_float, first);
    tiles.add(BatchTiles::is_lit, is_lit & is_float, first);
    return is_float & is_inside;
}

// Prepares tiles in double, with the bounds of triangle/corners.hpp: the roundings of a quotient, four more than there
// where two share a division, and of its bound are below 10 u.
template <std::size_t Numerators>
TEXGEN_APART void prepare(const BatchJob& job, const BatchPlanes* of_tiles, const int (*block)[4], std::size_t first,
                          BatchTiles& tiles) noexcept {
    const BatchLanes planes([&](std::size_t j) { return of_tiles[j].value; }, Numerators == 3);
    const TileLanes tile(block, planes);
    const Doubles* const value = planes.value;
    const TileFunction q(&value[BatchPlanes::q], tile);
    const Doubles reciprocal = 1.0 / (q.least - q.error);
    const LongWords in_front = greater(q.least, q.error * well_in_front);
    store(&tiles.q[first], q.at[0]);
    const LongWords is_exact = in_front & greater(q.least, q.largest * share_for_one_error);
    LongWords is_dark = greater(q.largest * -1.0, q.error);
    LongWords is_lit = is_exact;
    const auto ask = [&](const TileFunction& f, double min, double max) {
        const Beyond of_min(f, q, min, job.tolerance), of_max(f, q, max, job.tolerance);
        is_dark |= of_min.below | of_max.above;
        is_lit &= of_min.above & of_max.below;
    };
    Doubles ulps = Doubles{} + 4.0;
    // The product of two q, and its reciprocal, are normal numbers.
    LongWords have_middles = is_exact & greater(q.least, 0x1p-500) & greater(Doubles{} + 0x1p500, q.largest);
    TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) {
        const TileFunction f(&value[BatchPlanes::of_coordinate[k]], tile);
        const Doubles largest = (f.size + f.error) * reciprocal;
        const Doubles error =
            (f.error + largest * q.error) * (reciprocal * 1.0001) + largest * (10.0 * unit_roundoff_double);
        store(&tiles.base[k][first], f.at[0]);
        store(&tiles.error[k][first], error);
        // For a numerator of one sign, q times a lower bound on how far quotients are above 2^-125: if that is positive
        // they are normal floats, and an ulp of one in double is at least 2^-53 of it.
        const Doubles least = (maximum(f.least, f.largest * -1.0) - f.error) - q.largest * 0x1p-125;
        const LongWords is_normal = greater(least, 0.0);
        ulps = maximum(ulps, where(is_normal, error * q.largest / least * (0x1p53 * 1.001)));
        have_middles &= is_normal;
        if (k == 2 && !job.has_depth) continue;
        const double min = job.least[k], max = job.greatest[k];
        // If no mask is asked for, one corner in the region is enough: the tile is not dark.
        if (k == 2 || job.lit != nullptr || any(greater(q.at[0] * min, f.at[0]) | greater(f.at[0], q.at[0] * max)))
            ask(f, min, max);
    }
    store(&tiles.ulps[first], power_of_two_below(ulps) * 2.0);
    tiles.add(BatchTiles::is_dark, is_dark, first);
    tiles.add(BatchTiles::is_lit, is_lit, first);
    tiles.add(BatchTiles::is_exact, is_exact, first);
    tiles.add(BatchTiles::may_ask_middles, have_middles & greater(Doubles{} + 0x1p14, ulps), first);
}

using TileScratch = ScratchOutputs<largest_in_scratch + wide_lanes>;

// What the kernels in double know of a tile: its functions as base, along a row and down.
template <std::size_t Numerators>
struct TileFunctions {
    double base[Numerators + 1], along[Numerators + 1], down[Numerators + 1];  // q last

    TEXGEN_INLINE TileFunctions(const BatchPlanes& planes, const BatchTiles& tiles, std::size_t i, bool is_turned,
                                std::size_t known = Numerators) noexcept {
        TEXGEN_FOR (std::size_t k = 0; k <= Numerators; ++k) {
            if (k >= known && k < Numerators) continue;
            const double* const plane = &planes.value[k < Numerators ? BatchPlanes::of_coordinate[k] : BatchPlanes::q];
            base[k] = k < Numerators ? tiles.base[k][i] : tiles.q[i];
            along[k] = plane[1];  // a row alone is a column, whose x is 0
            down[k] = plane[is_turned ? 1 : 2];
        }
    }
    TEXGEN_INLINE Doubles at(std::size_t k, const Doubles& x, const Doubles& y) const noexcept {
        return (x * along[k] + base[k]) + y * down[k];
    }
};

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
