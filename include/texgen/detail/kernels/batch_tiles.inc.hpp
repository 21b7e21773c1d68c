// The inner loops of a batch: small tiles, without what a large one is surveyed for. Included by batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// Of a block of tiles what their kernels need: numerators, q and bounds for the quotients in double; in float, about the middle
// of the tile, u + (dx x + dy y) / (1 + bend_x x + bend_y y).
struct BatchTiles {
    double x[batch_block], y[batch_block], width[batch_block], height[batch_block], per_width[batch_block];
    double base[3][batch_block], q[batch_block], error[3][batch_block];
    float middle[3][batch_block], dx[3][batch_block], dy[3][batch_block], bend_x[batch_block], bend_y[batch_block];
    int is_dark[batch_block], is_exact[batch_block], is_polynomial[batch_block], is_float[batch_block];
};

// A linear function of the window over a tile: at its corner fragments, and a bound on its error.
struct TileFunction {
    Doubles dx, dy, at[4], error;

    TEXGEN_INLINE TileFunction(const Doubles* function, const Doubles& p_x, const Doubles& p_y, const Doubles& right,
                               const Doubles& bottom, const Doubles& stretch) noexcept {
        dx = function[1];
        dy = function[2];
        at[0] = function[0] + (dx * p_x + dy * p_y) + 0.0;  // no -0
        at[1] = at[0] + dx * right;
        at[2] = at[0] + dy * bottom;
        at[3] = at[2] + dx * right;
        error = function[3] * stretch;
    }
};

TEXGEN_INLINE Doubles least_of(const Doubles (&at)[4]) noexcept {
    return minimum(minimum(at[0], at[1]), minimum(at[2], at[3]));
}
TEXGEN_INLINE Doubles largest_of(const Doubles (&at)[4]) noexcept {
    return maximum(maximum(at[0], at[1]), maximum(at[2], at[3]));
}

// Tiles all of whose fragments in front are beyond a side of the region, with the margins of side_of() in triangle/corners.hpp.
// `outwards` is -1 for the lower side and 1 for the upper one.
TEXGEN_INLINE LongWords are_beyond(const TileFunction& f, const TileFunction& q, const Doubles& size_q, double bound,
                                   double outwards, double tolerance) noexcept {
    const double size = std::fabs(bound);
    const double slack = size * 0x1p-22 + (0x1p-125 + 2.0 * tolerance);
    const Doubles margin = (f.error + q.error * (size + slack) + size_q * (slack + size * gamma(4))) * 1.0002;
    Doubles g[4];
    TEXGEN_UNROLL
    for (std::size_t i = 0; i < 4; ++i) g[i] = f.at[i] * outwards - q.at[i] * (outwards * bound);
    return greater(least_of(g) * (1.0 - gamma(4)), margin);
}

// In float a tile is what a chunk is (chunks.inc.hpp), in two directions. With r = 2^-24 the numerator of a step D carries 3 r D,
// x of the denominator 3 r X, X being its largest, so that the step has 3 r X / (1 - X) D of it; the polynomial adds 3 r D (a
// division 2 r D), the product r D, and the value r D + 2 r |u|.
//
// Every other bound is that of triangle/corners.hpp: four roundings of a quotient by one division for two vectors, two more
// than there, and one of its bound are below 8 u.
template <std::size_t Numerators>
TEXGEN_INLINE void prepare(const BatchJob& job, const BatchLanes& planes, std::size_t first,
                           BatchTiles& tiles) noexcept {
    const Doubles* const value = planes.value;
    const Doubles width = load<Doubles>(&tiles.width[first]);
    const Doubles height = load<Doubles>(&tiles.height[first]);
    store(&tiles.per_width[first], 1.0 / width);
    const Doubles p_x = load<Doubles>(&tiles.x[first]) - value[BatchPlanes::origin];
    const Doubles p_y = load<Doubles>(&tiles.y[first]) - value[BatchPlanes::origin + 1];
    const Doubles right = width - 1.0;
    const Doubles bottom = height - 1.0;
    const Doubles stretch = maximum(maximum((magnitude(p_x) + width) * value[BatchPlanes::per_reach],
                                            (magnitude(p_y) + height) * value[BatchPlanes::per_reach + 1]),
                                    Doubles{} + 1.0);
    const TileFunction q(&value[BatchPlanes::q], p_x, p_y, right, bottom, stretch);
    const Doubles least_q = least_of(q.at);
    const Doubles largest_q = largest_of(q.at);
    const Doubles size_q = maximum(magnitude(least_q), magnitude(largest_q));
    const Doubles reciprocal = 1.0 / (least_q - q.error);
    const LongWords well_in_front = greater(least_q, q.error * 0x1p24);
    store(&tiles.q[first], q.at[0]);
    store(&tiles.is_exact[first], narrow(well_in_front & greater(least_q, largest_q * 0x1p-12)));
    LongWords is_dark = greater(largest_q * -1.0, q.error);

    // About the middle. Steps along a single column or row say nothing, and might be infinite.
    const Doubles tolerance = Doubles{} + job.tolerance * (1.0 - 0x1p-18);
    const bool has_tolerance = job.tolerance > 0.0;
    const LongWords has_columns = greater(right, 0.0);
    const LongWords has_rows = greater(bottom, 0.0);
    const Doubles half_x = right * 0.5;
    const Doubles half_y = bottom * 0.5;
    Doubles per_q{}, extent{}, stretched{}, share{};
    LongWords is_float{}, is_polynomial{};
    if (has_tolerance) {
        per_q = 1.0 / (q.at[0] + (q.dx * half_x + q.dy * half_y));
        const Doubles bend_x = where(has_columns, q.dx * per_q);
        const Doubles bend_y = where(has_rows, q.dy * per_q);
        store(&tiles.bend_x[first], to_floats(bend_x));
        store(&tiles.bend_y[first], to_floats(bend_y));
        extent = magnitude(bend_x) * half_x + magnitude(bend_y) * half_y;
        stretched = (extent * 4.0 + 1.0) * extent + 1.0;
        share = extent * extent;
        share = share * share;
        share = share * share;
        is_float = well_in_front & at_most(extent, Doubles{} + 0.75);
        is_polynomial = at_most(extent, Doubles{} + 0.25);
    }
    TEXGEN_UNROLL
    for (std::size_t k = 0; k < Numerators; ++k) {
        const TileFunction f(&value[BatchPlanes::of_numerator[k]], p_x, p_y, right, bottom, stretch);
        const Doubles size =
            maximum(maximum(magnitude(f.at[0]), magnitude(f.at[1])), maximum(magnitude(f.at[2]), magnitude(f.at[3])));
        const Doubles largest = (size + f.error) * reciprocal;
        store(&tiles.base[k][first], f.at[0]);
        store(&tiles.error[k][first],
              (f.error + largest * q.error) * (reciprocal * 1.0001) + largest * (8.0 * unit_roundoff_double));
        if (k < 2) {
            is_dark |= are_beyond(f, q, size_q, static_cast<double>(job.min[k]), -1.0, job.tolerance);
            is_dark |= are_beyond(f, q, size_q, static_cast<double>(job.max[k]), 1.0, job.tolerance);
        }
        if (k == 2 && job.has_depth) {
            // Infinite limits as r_coverage() has them.
            const double r_min = larger(-0x1p500, smaller(0x1p128, static_cast<double>(job.r_min)));
            const double r_max = larger(-0x1p128, smaller(0x1p500, static_cast<double>(job.r_max)));
            is_dark |= are_beyond(f, q, size_q, r_min, -1.0, job.tolerance);
            is_dark |= are_beyond(f, q, size_q, r_max, 1.0, job.tolerance);
        }
        if (!has_tolerance) continue;
        const Doubles u = (f.at[0] + (f.dx * half_x + f.dy * half_y)) * per_q;
        const Doubles slope_x = where(has_columns, (f.dx - u * q.dx) * per_q);
        const Doubles slope_y = where(has_rows, (f.dy - u * q.dy) * per_q);
        store(&tiles.middle[k][first], to_floats(u));
        store(&tiles.dx[k][first], to_floats(slope_x));
        store(&tiles.dy[k][first], to_floats(slope_y));
        const Doubles step = (magnitude(slope_x) * half_x + magnitude(slope_y) * half_y) * stretched;
        const Doubles size_u = magnitude(u);
        const Doubles step_error = (extent * stretched * 3.1 + 8.1) * unit_roundoff_float;
        const Doubles rest = size_u * (2.001 * unit_roundoff_float) + step * step_error + 0x1p-115 +
                             ((size_u + step) * q.error + f.error) * (per_q * stretched) * 1.001;
        is_float &= at_most(rest, tolerance);
        is_polynomial &= at_most(rest + step * share, tolerance);
    }
    store(&tiles.is_float[first], narrow(is_float));
    store(&tiles.is_polynomial[first], narrow(is_polynomial & is_float));
    store(&tiles.is_dark[first], narrow(is_dark));
}

// The rectangle of a tile as its kernels walk it: a row alone is a column.
struct TileShape {
    int width;
    std::size_t begin, end;  // in the outputs
    double per_width;
    double last_row;
    bool is_turned;

    TEXGEN_INLINE TileShape(int tile_width, int tile_height, double per_tile_width, std::size_t done) noexcept
        : width(tile_height == 1 ? 1 : tile_width),
          begin(done),
          end(done + static_cast<std::size_t>(tile_width) * static_cast<std::size_t>(tile_height)),
          per_width(tile_height == 1 ? 1.0 : per_tile_width),
          last_row((tile_height == 1 ? tile_width : tile_height) - 1),
          is_turned(tile_height == 1) {}
};

// Quotients in double, rounded with a certificate.
template <std::size_t Numerators, bool HasWholeRows>
struct TileDivision {
    Doubles first[Numerators], q_first;  // at the first row, where vectors have whole rows; else at the first fragment
    double dx[Numerators], dy[Numerators], error[Numerators];
    double q_dx, q_dy;

    TEXGEN_INLINE TileDivision(const BatchPlanes& planes, const BatchTiles& tiles, std::size_t i, bool is_turned,
                               const Doubles& x) noexcept {
        const std::size_t along = is_turned ? 2 : 1;
        const std::size_t down = 3 - along;
        q_dx = planes.value[BatchPlanes::q + along];
        q_dy = planes.value[BatchPlanes::q + down];
        q_first = start(tiles.q[i], q_dx, x);
        TEXGEN_UNROLL
        for (std::size_t k = 0; k < Numerators; ++k) {
            dx[k] = planes.value[BatchPlanes::of_numerator[k] + along];
            dy[k] = planes.value[BatchPlanes::of_numerator[k] + down];
            error[k] = tiles.error[k][i];
            first[k] = start(tiles.base[k][i], dx[k], x);
        }
    }

    TEXGEN_INLINE static Doubles start(double base, double f_dx, const Doubles& x) noexcept {
        return HasWholeRows ? x * f_dx + base : Doubles{} + base;
    }
    TEXGEN_INLINE static Doubles value_at(const Doubles& f_first, double f_dx, double f_dy, const Doubles& x,
                                          const Doubles& y) noexcept {
        return HasWholeRows ? y * f_dy + f_first : (x * f_dx + f_first) + y * f_dy;
    }
    TEXGEN_INLINE Doubles q_at(const Doubles& x, const Doubles& y) const noexcept {
        return value_at(q_first, q_dx, q_dy, x, y);
    }
    // Returns the lanes in doubt.
    TEXGEN_INLINE Words divide(const Doubles& x, const Doubles& y, const Doubles& reciprocal,
                               Floats (&quotient)[Numerators]) const noexcept {
        Words doubtful{};
        TEXGEN_UNROLL
        for (std::size_t k = 0; k < Numerators; ++k) {
            const Doubles value = value_at(first[k], dx[k], dy[k], x, y) * reciprocal;
            quotient[k] = to_floats(value - error[k]);
            doubtful |= bits(quotient[k]) ^ bits(to_floats(value + error[k]));
        }
        return doubtful;
    }
};

// False where a value is in doubt. Apart, so that its loop has all registers.
template <std::size_t Numerators, bool HasWholeRows>
TEXGEN_APART bool divide_tile(const BatchPlanes& planes, const BatchTiles& tiles, std::size_t i, const TileShape& shape,
                              const FragmentOutputs& original) noexcept {
    constexpr auto size = static_cast<std::size_t>(lanes);
    const FragmentOutputs out = original;
    const std::size_t end = shape.end;
    FragmentWalk<Doubles, double> walk(shape.width, shape.per_width, 0.0);
    const TileDivision<Numerators, HasWholeRows> division(planes, tiles, i, shape.is_turned, walk.x);
    const Doubles last_row = Doubles{} + shape.last_row;
    Words doubtful{};
    Floats quotient[Numerators];
    for (std::size_t n = shape.begin; n < end; n += 2 * size) {
        const Doubles x = walk.x;
        const Doubles y = minimum(walk.y, last_row);
        const Doubles q = division.q_at(x, y);
        if (n + size >= end) {
            doubtful |= division.divide(x, y, 1.0 / q, quotient);
            out.put(n, quotient, ~Words{});
            break;
        }
        walk.template advance<HasWholeRows>();
        const Doubles next_y = minimum(walk.y, last_row);
        const Doubles next_q = division.q_at(walk.x, next_y);
        // One division for two vectors, all of whose fragments are in front.
        const Doubles reciprocal = 1.0 / (q * next_q);
        doubtful |= division.divide(x, y, reciprocal * next_q, quotient);
        out.put(n, quotient, ~Words{});
        doubtful |= division.divide(walk.x, next_y, reciprocal * q, quotient);
        out.put(n + size, quotient, ~Words{});
        walk.template advance<HasWholeRows>();
    }
    return !any(doubtful);
}

template <std::size_t Numerators, bool HasWholeRows, bool IsPolynomial>
TEXGEN_APART void divide_tile_float(const BatchTiles& tiles, std::size_t i, const TileShape& shape,
                                    const FragmentOutputs& original) noexcept {
    const FragmentOutputs out = original;
    const std::size_t end = shape.end;
    FragmentWalk<WideFloats, float> walk(static_cast<float>(shape.width), static_cast<float>(shape.per_width), 0.0);
    const float half_x = 0.5f * static_cast<float>(shape.width - 1);
    const auto half_y = static_cast<float>(0.5 * shape.last_row);
    const float bend_x = shape.is_turned ? tiles.bend_y[i] : tiles.bend_x[i];
    const float bend_y = shape.is_turned ? tiles.bend_x[i] : tiles.bend_y[i];
    float dx[Numerators], dy[Numerators];
    WideFloats middle[Numerators], first[Numerators];
    const WideFloats x_start = walk.x - half_x;
    const WideFloats bend_start = x_start * bend_x;
    TEXGEN_UNROLL
    for (std::size_t k = 0; k < Numerators; ++k) {
        dx[k] = shape.is_turned ? tiles.dy[k][i] : tiles.dx[k][i];
        dy[k] = shape.is_turned ? tiles.dx[k][i] : tiles.dy[k][i];
        middle[k] = WideFloats{} + tiles.middle[k][i];
        first[k] = x_start * dx[k];
    }
    for (std::size_t n = shape.begin; n < end; n += static_cast<std::size_t>(wide_lanes)) {
        const WideFloats y = walk.y - half_y;
        const WideFloats x = walk.x - half_x;
        const WideFloats bend = HasWholeRows ? y * bend_y + bend_start : y * bend_y + x * bend_x;
        WideFloats factor;
        if constexpr (IsPolynomial) {
            factor = 1.0f - bend;
            WideFloats power = bend * bend;
            factor = factor * power + factor;
            power = power * power;
            factor = factor * power + factor;
        } else {
            factor = 1.0f / (bend + 1.0f);
        }
        WideFloats value[Numerators];
        TEXGEN_UNROLL
        for (std::size_t k = 0; k < Numerators; ++k)
            value[k] = (HasWholeRows ? y * dy[k] + first[k] : y * dy[k] + x * dx[k]) * factor + middle[k];
        out.put(n, value, ~WideWords{});
        walk.template advance<HasWholeRows>();
    }
}

// False where a value is in doubt.
template <std::size_t Numerators>
TEXGEN_INLINE bool divide_tile(const TilesJob& job, const BatchPlanes& planes, const BatchTiles& tiles, std::size_t i,
                               const TileShape& shape, const FragmentOutputs& out) noexcept {
    if (job.tolerance > 0.0 && tiles.is_float[i] != 0) {
        if (tiles.is_polynomial[i] == 0)
            divide_tile_float<Numerators, false, false>(tiles, i, shape, out);
        else if (wide_lanes % shape.width == 0)
            divide_tile_float<Numerators, true, true>(tiles, i, shape, out);
        else
            divide_tile_float<Numerators, false, true>(tiles, i, shape, out);
        return true;
    }
    return lanes % shape.width == 0 ? divide_tile<Numerators, true>(planes, tiles, i, shape, out)
                                    : divide_tile<Numerators, false>(planes, tiles, i, shape, out);
}

// The last tile, whose vectors do not end with the outputs.
template <std::size_t Numerators>
TEXGEN_APART bool divide_last_tile(const TilesJob& job, const BatchPlanes& planes, const BatchTiles& tiles,
                                   std::size_t i, const TileShape& shape, const FragmentOutputs& out) noexcept {
    ScratchOutputs<largest_batch_tile + wide_lanes> scratch;
    const std::size_t count = shape.end - shape.begin;
    TileShape in_scratch = shape;
    in_scratch.begin = 0;
    in_scratch.end = count;
    const bool is_certain = divide_tile<Numerators>(job, planes, tiles, i, in_scratch, scratch.in_place_of(out));
    scratch.copy_to(out, shape.begin, count);
    return is_certain;
}

template <std::size_t Numerators>
TEXGEN_INLINE Undecided divide_all_tiles(const TilesJob& job, std::size_t first, std::size_t done) noexcept {
    const FragmentOutputs out(job);
    BatchTiles tiles{};
    for (; first < job.tile_count; first += batch_block) {
        const std::size_t count = job.tile_count - first < batch_block ? job.tile_count - first : batch_block;
        for (std::size_t i = 0; i < count; ++i) {
            const auto& [x, y, width, height] = job.tiles[first + i];
            tiles.x[i] = x + 0.5;
            tiles.y[i] = y + 0.5;
            tiles.width[i] = width;
            tiles.height[i] = height;
        }
        for (std::size_t i = 0; i < count; i += static_cast<std::size_t>(lanes)) {
            const BatchPlanes* of_tile[lanes];
            TEXGEN_UNROLL
            for (std::size_t j = 0; j < static_cast<std::size_t>(lanes); ++j) of_tile[j] = &job.planes[first + i + j];
            BatchLanes planes;
            planes.load_from(of_tile, Numerators == 3);
            prepare<Numerators>(job, planes, i, tiles);
        }
        std::uint64_t doubtful = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const int width = job.tiles[first + i][2];
            const int height = job.tiles[first + i][3];
            if (width <= 0 || height <= 0) continue;
            const TileShape shape(width, height, tiles.per_width[i], done);
            bool is_certain = false;
            if (tiles.is_dark[i] != 0) {
                for (float* const array : {out.out[0], out.out[1], out.out[2], out.lit})
                    for (std::size_t n = shape.begin; array != nullptr && n < shape.end; ++n) array[n] = 0.0f;
                is_certain = true;
            } else if (tiles.is_exact[i] != 0 && shape.end - shape.begin <= largest_batch_tile) {
                const BatchPlanes& planes = job.planes[first + i];
                is_certain = shape.end + static_cast<std::size_t>(wide_lanes) <= job.count
                                 ? divide_tile<Numerators>(job, planes, tiles, i, shape, out)
                                 : divide_last_tile<Numerators>(job, planes, tiles, i, shape, out);
            }
            if (!is_certain) doubtful |= std::uint64_t{1} << i;
            done = shape.end;
        }
        if (doubtful != 0) return {first, doubtful};
    }
    return {job.tile_count, 0};
}

template <class = void>
Undecided divide_batch_tiles(const TilesJob& original, std::size_t first, std::size_t done) noexcept {
    const TilesJob job = original;
    return job.needs_r() ? divide_all_tiles<3>(job, first, done) : divide_all_tiles<2>(job, first, done);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
