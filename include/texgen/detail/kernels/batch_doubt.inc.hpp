// Tiles of a batch that are in doubt, decided again. Included by batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The functions of a tile in double, and the column or row where each is 0, in which its quotients have no error. A
// tile that was in doubt only for such zeros is decided by this.
struct TileWithZeros {
    const TileFunctions<3> f;
    double error[3];
    Doubles zero_x[3], zero_y[3];
    std::size_t count;

    TEXGEN_INLINE TileWithZeros(const TilesJob& job, const BatchTiles& tiles, std::size_t triangle, std::size_t i,
                                const int (&tile)[4], bool is_turned) noexcept
        : f(job.planes[triangle], tiles, i, is_turned, job.needs_r() ? 3 : 2), count(job.needs_r() ? 3 : 2) {
        const ZerosOfTile zeros(vertices_of(job, triangle), tile);
        for (std::size_t k = 0; k < count; ++k) {
            error[k] = tiles.error[k][i];
            zero_x[k] = Doubles{} + (is_turned ? zeros.row : zeros.column)[k];
            zero_y[k] = Doubles{} + (is_turned ? zeros.column : zeros.row)[k];
        }
    }

    // Divides a vector of fragments; false where a value stays in doubt.
    TEXGEN_INLINE bool divide(const Doubles& x, const Doubles& y, Floats (&quotient)[3]) const noexcept {
        const Doubles reciprocal = 1.0 / f.at(3, x, y);
        Words doubtful{};
        TEXGEN_FOR (std::size_t k = 0; k < 3; ++k) {
            if (k >= count) continue;
            const LongWords is_not_zero = are_nonzero(x - zero_x[k]) & are_nonzero(y - zero_y[k]);
            const RoundedEnds ends(where(is_not_zero, f.at(k, x, y) * reciprocal),
                                   where(is_not_zero, Doubles{} + error[k]));
            quotient[k] = ends.below;
            doubtful |= ends.differ();
        }
        return !any(doubtful);
    }
};

// Decides the tiles of the block from `first` on that are in doubt, a bit each; its values begin at `of_block`. From
// the first tile that stays in doubt on, functions are made about corners, too. Returns the tiles that this leaves.
TEXGEN_APART inline std::uint64_t decide_tiles(const TilesJob& job, const FragmentOutputs& out, std::size_t first,
                                               const int (*block)[4], const BatchTiles& tiles, std::uint64_t doubtful,
                                               std::size_t of_block, bool about_corners = false) noexcept {
    BatchFunctions functions;
    TileScratch scratch;
    ShapeOfTile shape;
    const auto stand_in = static_cast<std::size_t>(std::countr_zero(doubtful));  // of finite numbers; others may not be
    std::uint64_t taken = 0;
    const auto take = [&](std::size_t tile) {
        const std::size_t i = tile / at_once * at_once;
        taken |= ((std::uint64_t{1} << lanes) - 1) << i;
        const float* of_lane[lanes];
        TEXGEN_FOR (std::size_t j = 0; j < at_once; ++j)
            of_lane[j] = vertices_of(job, first + ((doubtful >> (i + j) & 1u) != 0 ? i + j : stand_in));
        Words given[4];
        load_fours(block[i], given);
        functions.take(of_lane, job.needs_r(), to_doubles(given[0]) + 0.5, to_doubles(given[1]) + 0.5,
                       to_doubles(given[2]), to_doubles(given[3]), i, about_corners);
    };
    std::uint64_t undecided = 0;
    std::size_t done = of_block;
    for (std::size_t i = 0; i < batch_block; ++i) {
        if (block[i][2] <= 0 || block[i][3] <= 0) continue;
        if (!shape.is_of(block[i][2], block[i][3])) shape.take(block[i][2], block[i][3]);
        const std::size_t begin = done;
        done += shape.count;
        if ((doubtful >> i & 1u) == 0) continue;
        // A last vector that is not full must not write over what follows, which is done.
        const bool in_scratch = shape.count % at_once != 0;
        const FragmentOutputs here = in_scratch ? scratch.in_place_of(out) : out;
        const TileWithZeros in_double(job, tiles, first + i, i, block[i], shape.is_turned);
        FragmentWalk<Doubles, double> walk(shape.width, shape.per_width, 0.0);
        Words left{};
        bool is_certain = tiles.has(BatchTiles::is_exact, i);  // as long as no vector before was in doubt
        for (std::size_t n = 0; n < shape.count && !any(left); n += at_once, walk.advance()) {
            const Doubles row = minimum(walk.y, Doubles{} + shape.last_row);
            CloseFragments<3> fragments;
            fragments.quotient[2] = Floats{};
            LongWords front = ~LongWords{};
            is_certain = is_certain && in_double.divide(walk.x, row, fragments.quotient);
            if (!is_certain) {
                if ((taken >> i & 1u) == 0) take(i);
                const BatchFunctionsAt<BatchFunction> at{functions.of[i], shape.is_turned ? row : walk.x,
                                                         shape.is_turned ? walk.x : row};
                const CloseDivisor q(at.values(3));
                fragments.divide(at, q, job.needs_r() ? 3 : 2, job.tolerance, true);
                front = q.front;
                left = narrow(fragments.doubtful);
            }
            here.put(in_scratch ? n : begin + n, fragments.quotient, front);
        }
        if (in_scratch) scratch.copy_to(out, begin, shape.count);
        if (!any(left)) continue;
        if (!about_corners) return decide_tiles(job, out, first, block, tiles, doubtful >> i << i, of_block, true);
        undecided |= std::uint64_t{1} << i;
    }
    return undecided;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
