// A batch's tiles that doubles leave in doubt: their functions about themselves, and as integers modulo 2^64, as PlaneResidues in
// triangle/close_planes.hpp has them, a tile in each lane. Included by batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// Of a block of tiles: at the first fragment an integer times a grain is F, and so are its steps along a row and down.
struct BatchResidues {
    std::uint64_t base[4][batch_block], dx[4][batch_block], dy[4][batch_block];  // q last
    double grain[4][batch_block];
    double largest_q[batch_block];  // more than q is at any fragment, as the grains have it

    // Of function k of tile i.
    TEXGEN_INLINE Residues at(std::size_t k, std::size_t i, const Residues& x, const Residues& y) const noexcept {
        return x * dx[k][i] + (y * dy[k][i] + base[k][i]);
    }
};

// A tile of the triangle in each lane; returns those whose numbers are too long, or whose area is next to 0.
template <std::size_t Numerators>
TEXGEN_APART LongWords take_residues(const float* const (&triangle)[lanes], const int (*tile)[4], std::size_t first,
                                     BatchResidues& residues) noexcept {
    Words of_tile[4];
    load_fours(*tile, of_tile);
    const Doubles x = to_doubles(of_tile[0]) + 0.5, y = to_doubles(of_tile[1]) + 0.5;
    const Doubles width = to_doubles(of_tile[2]), height = to_doubles(of_tile[3]);
    const VertexLanes vertices(triangle, false);
    ResidueLanes corners(vertices, x, y);
    Residues dx[3], dy[3];
    corners.steps(dx, dy);
    TEXGEN_UNROLL
    for (std::size_t n = 0; n <= Numerators; ++n) {
        const ResidueValues value = corners.values(n < Numerators ? n : 3);
        store(&residues.base[n][first], value.times(corners.side));
        store(&residues.dx[n][first], value.times(dx));
        store(&residues.dy[n][first], value.times(dy));
        store(&residues.grain[n][first], value.grain);
    }
    Doubles size_x[3], size_y[3], largest_q{};
    TEXGEN_UNROLL
    for (std::size_t i = 0; i < 3; ++i) {
        size_x[i] = magnitude(vertices.number(i, 0) - x) + width;
        size_y[i] = magnitude(vertices.number(i, 1) - y) + height;
    }
    TEXGEN_UNROLL
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const std::size_t k = (i + 2) % 3;
        const Doubles weight = vertices.number(j, 2) * vertices.number(k, 2);
        largest_q =
            largest_q + (size_x[j] * size_y[k] + size_y[j] * size_x[k]) * weight * magnitude(vertices.number(i, 6));
    }
    store(&residues.largest_q[first], largest_q * 1.0001);
    return ~corners.is_known;
}

// A tile that has middles. A quotient errs by half of `ulps` of its own, each 2^-52 of it at most, and is within `ulps` of the
// middle m of two floats where that is asked: F - m Q is less than 2 ulps 2^-52 |u| Q. False where a value is in doubt.
template <std::size_t Numerators>
TEXGEN_APART bool divide_tile_by_residues(const BatchPlanes& planes, const BatchTiles& tiles,
                                          const BatchResidues& residues, std::size_t i, const TileShape& shape,
                                          const TileOutputs<Numerators>& original) noexcept {
    constexpr auto size = static_cast<std::size_t>(lanes);
    const TileOutputs<Numerators> out = original;
    const TileFunctions<Numerators> f(planes, tiles, i, shape.is_turned);
    const Doubles last_row = Doubles{} + shape.last_row;
    const double largest = tiles.ulps[i] * 0x1p-51 * residues.largest_q[i];
    const auto ulps = static_cast<std::int64_t>(tiles.ulps[i]) - 1;
    FragmentWalk<Doubles, double> walk(shape.width, shape.per_width, 0.0);
    LongWords doubt{};
    for (std::size_t n = 0; n < shape.count; n += size, walk.advance()) {
        const Doubles y = minimum(walk.y, last_row);
        const Doubles reciprocal = 1.0 / f.at(Numerators, walk.x, y);
        const Residues x_index = to_residues(shape.is_turned ? y : walk.x);
        const Residues y_index = to_residues(shape.is_turned ? walk.x : y);
        const Residues q = residues.at(Numerators, i, x_index, y_index);
        Floats quotient[Numerators];
        TEXGEN_UNROLL
        for (std::size_t k = 0; k < Numerators; ++k) {
            const Doubles value = f.at(k, walk.x, y) * reciprocal;
            quotient[k] = nearest_by_residues(value, ulps, residues.at(k, i, x_index, y_index), residues.grain[k][i], q,
                                              residues.grain[Numerators][i], magnitude(value) * largest, doubt);
        }
        out.put(n, quotient);
    }
    return !any(doubt);
}

// The functions of the triangle in each lane about the first fragment of its tile, from the differences between that and the
// vertices: what is large at a far one never enters. Their errors hold for the tile.
template <class CompiledWhereCalled = void>
TEXGEN_APART void move_to_tiles(const float* const (&triangle)[lanes], const int (*tile)[4],
                                BatchPlanes* planes) noexcept {
    Words of_tile[4];
    load_fours(*tile, of_tile);
    const Doubles x = to_doubles(of_tile[0]) + 0.5, y = to_doubles(of_tile[1]) + 0.5;
    const Doubles width = to_doubles(of_tile[2]), height = to_doubles(of_tile[3]);
    const VertexLanes vertices(triangle, false);
    const CloseLanes close(vertices, x, y);
    Doubles dx[3], dy[3];
    TEXGEN_UNROLL
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const std::size_t k = (i + 2) % 3;
        const Doubles weight = with_sign_of(vertices.number(j, 2) * vertices.number(k, 2), close.area);
        dx[i] = (vertices.number(j, 1) - vertices.number(k, 1)) * weight;
        dy[i] = (vertices.number(k, 0) - vertices.number(j, 0)) * weight;
    }
    Doubles value[BatchPlanes::count]{};
    TEXGEN_UNROLL
    for (std::size_t n = 0; n < 4; ++n) {
        Doubles* const function = &value[n < 3 ? BatchPlanes::of_numerator[n] : BatchPlanes::q];
        const Twofold base = close.function(n);
        Doubles terms = magnitude(base.high);
        function[0] = base.high;
        TEXGEN_UNROLL
        for (std::size_t i = 0; i < 3; ++i) {
            const Doubles f = vertices.number(i, 3 + n);
            function[1] = function[1] + f * dx[i];
            function[2] = function[2] + f * dy[i];
            terms = terms + (magnitude(f * dx[i]) * width + magnitude(f * dy[i]) * height);
        }
        function[3] = terms * batch_plane_error + base.lost;
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    value[BatchPlanes::q + 3] = select(close.is_known, value[BatchPlanes::q + 3], Doubles{} + infinity);
    value[BatchPlanes::origin] = x;
    value[BatchPlanes::origin + 1] = y;
    store_planes(value, planes);
}

// A tile as fragments by ids are divided, each with its own bounds: where q = 0 crosses it or comes near. `residues` are null, or tell
// which fragments are behind. As fill_tile().
template <std::size_t Numerators>
TEXGEN_APART bool fill_tile_by_fragments(const TilesJob& job, std::size_t first, std::size_t i,
                                         const BatchPlanes& planes, const BatchResidues* residues,
                                         const TileShape& shape, const FragmentOutputs& out, std::size_t begin,
                                         bool in_scratch, TileScratch& scratch) noexcept {
    const FragmentOutputs here = in_scratch ? scratch.in_place_of(out) : out;
    const int* const tile = job.tiles[first + i];
    const OneTriangle functions{planes.value};
    FragmentWalk<Doubles, double> walk(shape.width, shape.per_width, 0.0);
    Words doubtful{};
    for (std::size_t n = 0; n < shape.count; n += static_cast<std::size_t>(lanes), walk.advance()) {
        const Doubles row = minimum(walk.y, Doubles{} + shape.last_row);
        const Doubles column = shape.is_turned ? row : walk.x;
        const Doubles line = shape.is_turned ? walk.x : row;
        const Doubles x = column + (tile[0] + 0.5), y = line + (tile[1] + 0.5);
        FragmentLanes<Numerators> fragments;
        fragments.divide(functions, x, y, job.tolerance);
        if (residues != nullptr && any(fragments.doubtful)) {
            const Residues q = residues->at(Numerators, i, to_residues(column), to_residues(line));
            const LongWords is_known = greater(Doubles{} + 0x1p62 * residues->grain[Numerators][i], fragments.q_size);
            fragments.doubtful &= ~narrow(is_known & ~are_positive(q));
        }
        const std::size_t at = in_scratch ? n : begin + n;
        if (any(fragments.doubtful))
            doubtful |= put_doubtful(
                fragments, x, y, true, [&](std::size_t) { return vertices_of(job, first + i); }, here, at);
        else
            here.put(at, fragments.quotient, narrow(fragments.front));
    }
    if (in_scratch) scratch.copy_to(out, begin, shape.count);
    return !any(doubtful);
}

// Where doubles do not know the middles of a tile, it is divided by functions about itself.
template <std::size_t Numerators>
TEXGEN_APART std::uint64_t decide_tiles(const TilesJob& job, const FragmentOutputs& out, const BatchTiles& tiles,
                                        std::size_t first, const int (*block)[4], std::uint64_t doubtful,
                                        std::size_t done) noexcept {
    BatchResidues residues;
    BatchTiles about_themselves;
    BatchPlanes moved[batch_block];
    TileScratch scratch;
    about_themselves.kinds = 0;
    std::uint64_t unknown = 0;
    const std::uint64_t are_moved = doubtful & ~tiles.all(BatchTiles::has_middles);
    const auto known = static_cast<std::size_t>(std::countr_zero(doubtful));  // finite, where others may be no numbers
    for (std::size_t i = 0; i < batch_block; i += static_cast<std::size_t>(lanes)) {
        constexpr auto all_lanes = (std::uint64_t{1} << lanes) - 1;
        if ((doubtful >> i & all_lanes) == 0) continue;
        const float* of_lane[lanes];
        TEXGEN_UNROLL
        for (std::size_t j = 0; j < static_cast<std::size_t>(lanes); ++j)
            of_lane[j] = vertices_of(job, first + ((doubtful >> (i + j) & 1u) != 0 ? i + j : known));
        if ((are_moved >> i & all_lanes) != 0) {
            move_to_tiles(of_lane, block + i, moved + i);
            prepare<Numerators>(job, moved + i, block + i, i, about_themselves);
        }
        unknown |= lane_bits(take_residues<Numerators>(of_lane, block + i, i, residues)) << i;
    }
    std::uint64_t undecided = 0;
    for (std::size_t i = 0; i < batch_block; ++i) {
        if (block[i][2] <= 0 || block[i][3] <= 0) continue;
        TileShape shape;
        shape.take(block[i][2], block[i][3], tiles.per_width[i]);
        const std::size_t begin = done;
        done += shape.count;
        if ((doubtful >> i & 1u) == 0) continue;
        // What follows is there already.
        const bool reaches_beyond = shape.count % static_cast<std::size_t>(lanes) != 0;
        const bool is_moved = (are_moved >> i & 1u) != 0;
        const BatchPlanes& planes = is_moved ? moved[i] : job.planes[first + i];
        const BatchTiles& known_of_it = is_moved ? about_themselves : tiles;
        const auto by_residues = [&](const TileOutputs<Numerators>& here) {
            return divide_tile_by_residues<Numerators>(planes, known_of_it, residues, i, shape, here);
        };
        const bool has_residues = (unknown >> i & 1u) == 0;
        const bool is_decided = has_residues && known_of_it.has(BatchTiles::has_middles, i) &&
                                fill_tile<Numerators>(out, shape, begin, reaches_beyond, scratch, by_residues);
        if (!is_decided &&
            !fill_tile_by_fragments<Numerators>(job, first, i, planes, has_residues && is_moved ? &residues : nullptr,
                                                shape, out, begin, reaches_beyond, scratch))
            undecided |= std::uint64_t{1} << i;
    }
    return undecided;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
