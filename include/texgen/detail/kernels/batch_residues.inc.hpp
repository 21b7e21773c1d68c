// The functions of a batch's tiles as integers modulo 2^64, as PlaneResidues in triangle/close_planes.hpp has them, a tile in
// each lane: for quotients next to the middle of two floats. Included by batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// Of a block of tiles: at the first fragment an integer times a grain is F, and so are its steps along a row and down.
struct BatchResidues {
    std::uint64_t base[4][batch_block], dx[4][batch_block], dy[4][batch_block];  // q last
    double grain[4][batch_block];
    double largest_q[batch_block];  // more than q is at any fragment, as the grains have it
};

// A tile of the triangle in each lane; returns those whose numbers are too long, or whose area is next to 0.
template <std::size_t Numerators>
TEXGEN_APART LongWords take_residues(const float* const (&triangle)[lanes], const int (*tile)[4], std::size_t first,
                                     BatchResidues& residues) noexcept {
    Words of_tile[4];
    load_fours(*tile, of_tile);
    const Doubles x = to_doubles(of_tile[0]) + 0.5, y = to_doubles(of_tile[1]) + 0.5;
    const Doubles width = to_doubles(of_tile[2]), height = to_doubles(of_tile[3]);
    ResidueLanes corners(triangle, x, y, false);
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
        size_x[i] = magnitude(corners.number(i, 0) - x) + width;
        size_y[i] = magnitude(corners.number(i, 1) - y) + height;
    }
    TEXGEN_UNROLL
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const std::size_t k = (i + 2) % 3;
        const Doubles weight = corners.number(j, 2) * corners.number(k, 2);
        largest_q =
            largest_q + (size_x[j] * size_y[k] + size_y[j] * size_x[k]) * weight * magnitude(corners.number(i, 6));
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
        const auto residues_of = [&](std::size_t k) {
            return x_index * residues.dx[k][i] + (y_index * residues.dy[k][i] + residues.base[k][i]);
        };
        const Residues q = residues_of(Numerators);
        Floats quotient[Numerators];
        TEXGEN_UNROLL
        for (std::size_t k = 0; k < Numerators; ++k) {
            const Doubles value = f.at(k, walk.x, y) * reciprocal;
            quotient[k] = nearest_by_residues(value, ulps, residues_of(k), residues.grain[k][i], q,
                                              residues.grain[Numerators][i], magnitude(value) * largest, doubt);
        }
        out.put(n, quotient);
    }
    return !any(doubt);
}

template <std::size_t Numerators>
TEXGEN_APART std::uint64_t decide_tiles(const TilesJob& job, const FragmentOutputs& out, const BatchTiles& tiles,
                                        std::size_t first, const int (*block)[4], std::uint64_t doubtful,
                                        std::size_t done) noexcept {
    BatchResidues residues;
    TileScratch scratch;
    std::uint64_t unknown = 0;
    const auto known = static_cast<std::size_t>(std::countr_zero(doubtful));  // finite, where others may be no numbers
    for (std::size_t i = 0; i < batch_block; i += static_cast<std::size_t>(lanes)) {
        if ((doubtful >> i & ((std::uint64_t{1} << lanes) - 1)) == 0) continue;
        const float* of_lane[lanes];
        TEXGEN_UNROLL
        for (std::size_t j = 0; j < static_cast<std::size_t>(lanes); ++j)
            of_lane[j] = vertices_of(job, first + ((doubtful >> (i + j) & 1u) != 0 ? i + j : known));
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
        const auto by_residues = [&](const TileOutputs<Numerators>& here) {
            return divide_tile_by_residues<Numerators>(job.planes[first + i], tiles, residues, i, shape, here);
        };
        const bool is_decided = tiles.has(BatchTiles::has_middles, i) && (unknown >> i & 1u) == 0 &&
                                fill_tile<Numerators>(out, shape, begin, reaches_beyond, scratch, by_residues);
        if (!is_decided &&
            !fill_tile_by_fragments<Numerators>(job, first + i, shape, out, begin, reaches_beyond, scratch))
            undecided |= std::uint64_t{1} << i;
    }
    return undecided;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
