// The functions of a batch's tiles as integers modulo 2^64, as PlaneResidues in triangle/close_planes.hpp has them, a tile in
// each lane: for quotients next to the middle of two floats. Included by batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// Of a block of tiles: at the first fragment an integer times a grain is F, and so are its steps along a row and down.
struct BatchResidues {
    std::uint64_t base[4][batch_block], dx[4][batch_block], dy[4][batch_block];  // q last
    double grain[4][batch_block];
    double largest_q[batch_block];  // more than q is at any fragment, as the grains have it
};

TEXGEN_INLINE Doubles largest_of_three(const Doubles& a, const Doubles& b, const Doubles& c) noexcept {
    return maximum(a, maximum(b, c));
}

// Three numbers as integers, in a power of two of which they are multiples.
struct IntegerLanes {
    Doubles unit, per_unit, largest;
    Doubles value[3];

    TEXGEN_INLINE IntegerLanes(const Doubles& a, const Doubles& b, const Doubles& c, double largest_unit) noexcept {
        unit = minimum(least_of_three(last_bits(a), last_bits(b), last_bits(c)), Doubles{} + largest_unit);
        per_unit = reciprocals_of_powers(unit);
        value[0] = a * per_unit;
        value[1] = b * per_unit;
        value[2] = c * per_unit;
        largest = largest_of_three(magnitude(value[0]), magnitude(value[1]), magnitude(value[2]));
    }
};

// A tile of the triangle in each lane; returns those whose numbers are too long, or whose area is next to 0.
template <std::size_t Numerators>
TEXGEN_APART LongWords take_residues(const float* const (&triangle)[lanes], const int (*tile)[4], std::size_t first,
                                     BatchResidues& residues) noexcept {
    VertexLanes vertex[3];
    TEXGEN_UNROLL
    for (std::size_t i = 0; i < 3; ++i) vertex[i].load_from(triangle, i, false);
    const auto given = [&](std::size_t i, std::size_t k) { return to_doubles(vertex[i].value[k]); };
    Words of_tile[4];
    load_fours(*tile, of_tile);
    const IntegerLanes x(given(0, 0), given(1, 0), given(2, 0), 0.5);
    const IntegerLanes y(given(0, 1), given(1, 1), given(2, 1), 0.5);
    const Doubles w[3] = {given(0, 2), given(1, 2), given(2, 2)};
    const Doubles to_b_x = given(1, 0) - given(0, 0), to_b_y = given(1, 1) - given(0, 1);
    const Doubles to_c_x = given(2, 0) - given(0, 0), to_c_y = given(2, 1) - given(0, 1);
    const Doubles left = to_b_x * to_c_y, right = to_b_y * to_c_x;
    const Doubles area = left - right;
    LongWords is_known = greater(magnitude(area), (magnitude(left) + magnitude(right)) * gamma(4));
    const IntegerLanes weight(with_sign_of(w[1] * w[2], area), with_sign_of(w[2] * w[0], area),
                              with_sign_of(w[0] * w[1], area), 0x1p500);
    const Doubles left_edge = to_doubles(of_tile[0]) + 0.5, top_edge = to_doubles(of_tile[1]) + 0.5;
    const Doubles width = to_doubles(of_tile[2]), height = to_doubles(of_tile[3]);
    const Doubles first_x = left_edge * x.per_unit, first_y = top_edge * y.per_unit;
    is_known &= greater(Doubles{} + 0x1p62, maximum(largest_of_three(x.largest, y.largest, weight.largest),
                                                    maximum(magnitude(first_x), magnitude(first_y))));
    const auto known = [&](const Doubles& number) { return to_residues(where(is_known, number)); };
    const Residues one_x = known(x.per_unit), one_y = known(y.per_unit);
    Residues to_x[3], to_y[3], edge[3][3];
    Doubles size_x[3], size_y[3], size[3];
    TEXGEN_UNROLL
    for (std::size_t i = 0; i < 3; ++i) {
        to_x[i] = known(x.value[i]) - known(first_x);
        to_y[i] = known(y.value[i]) - known(first_y);
        size_x[i] = magnitude(given(i, 0) - left_edge) + width;
        size_y[i] = magnitude(given(i, 1) - top_edge) + height;
    }
    TEXGEN_UNROLL
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const std::size_t k = (i + 2) % 3;
        const Residues scale = known(weight.value[i]);
        edge[i][0] = scale * (to_x[j] * to_y[k] - to_y[j] * to_x[k]);
        edge[i][1] = scale * ((to_y[j] - to_y[k]) * one_x);
        edge[i][2] = scale * ((to_x[k] - to_x[j]) * one_y);
        size[i] = (size_x[j] * size_y[k] + size_y[j] * size_x[k]) * (w[j] * w[k]);
    }
    TEXGEN_UNROLL
    for (std::size_t n = 0; n <= Numerators; ++n) {
        const std::size_t place = BatchVertex::strq + (n < Numerators ? n : 3);
        const IntegerLanes f(given(0, place), given(1, place), given(2, place), 0x1p500);
        is_known &= greater(Doubles{} + 0x1p62, f.largest);
        Residues value[3];
        TEXGEN_UNROLL
        for (std::size_t i = 0; i < 3; ++i) value[i] = known(f.value[i]);
        const auto sum = [&](std::size_t j) {
            return value[0] * edge[0][j] + (value[1] * edge[1][j] + value[2] * edge[2][j]);
        };
        store(&residues.base[n][first], sum(0));
        store(&residues.dx[n][first], sum(1));
        store(&residues.dy[n][first], sum(2));
        store(&residues.grain[n][first], x.unit * y.unit * (weight.unit * f.unit));
        if (n == Numerators)
            store(&residues.largest_q[first],
                  (size[0] * magnitude(given(0, place)) +
                   (size[1] * magnitude(given(1, place)) + size[2] * magnitude(given(2, place)))) *
                      1.0001);
    }
    return ~is_known;
}

// A tile in double: where a value is in doubt the sign of F - m Q decides, m being the middle of two floats.
// Both F/Q and m are within `error` of the value, m an eighth of it more for the rounding of a sum: F - m Q is at most
// 2.25 error Q.
template <std::size_t Numerators>
TEXGEN_APART bool divide_tile_by_residues(const BatchPlanes& planes, const BatchTiles& tiles,
                                          const BatchResidues& residues, std::size_t i, const TileShape& shape,
                                          const TileOutputs<Numerators>& original) noexcept {
    constexpr auto size = static_cast<std::size_t>(lanes);
    const TileOutputs<Numerators> out = original;
    const TileFunctions<Numerators> f(planes, tiles, i, shape.is_turned);
    const Doubles last_row = Doubles{} + shape.last_row;
    FragmentWalk<Doubles, double> walk(shape.width, shape.per_width, 0.0);
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
            const double error = tiles.error[k][i];
            CloseRemainder remainder;
            remainder.below = to_floats(value - error);
            remainder.above = to_floats(value + error);
            quotient[k] = remainder.below;
            const Words differ = bits(remainder.below) ^ bits(remainder.above);
            if (!any(differ)) continue;
            remainder.middle = to_doubles(remainder.below) + to_doubles(remainder.above);
            remainder.unit = power_of_two_below(remainder.middle);
            remainder.value = Doubles{};
            remainder.error = Doubles{} + 2.25 * error * residues.largest_q[i];
            const Residues of_f = residues_of(k);
            const double grain = residues.grain[k][i];
            const Words doubt = decide_by_residues(of_f, grain, q, residues.grain[Numerators][i], remainder,
                                                   ~equal(differ, 0), quotient[k]);
            if (!any(doubt)) continue;
            const Doubles largest = (magnitude(value) + error) * residues.largest_q[i];
            if (any(decide_zeros(greater(Doubles{} + 0x1p62 * grain, largest) & are_zero(of_f), doubt, quotient[k])))
                return false;
        }
        out.put(n, quotient);
    }
    return true;
}

template <std::size_t Numerators>
TEXGEN_APART std::uint64_t decide_tiles(const TilesJob& job, const FragmentOutputs& out, const BatchTiles& tiles,
                                        std::size_t first, const int (*block)[4], std::uint64_t doubtful,
                                        std::size_t done) noexcept {
    BatchResidues residues;
    ScratchOutputs<largest_batch_tile + wide_lanes> scratch;
    std::uint64_t undecided = 0;
    const auto known = static_cast<std::size_t>(std::countr_zero(doubtful));  // finite, where others may be no numbers
    for (std::size_t i = 0; i < batch_block; i += static_cast<std::size_t>(lanes)) {
        if ((doubtful >> i & ((std::uint64_t{1} << lanes) - 1)) == 0) continue;
        const float* of_lane[lanes];
        TEXGEN_UNROLL
        for (std::size_t j = 0; j < static_cast<std::size_t>(lanes); ++j)
            of_lane[j] =
                job.vertices + 3 * BatchVertex::size * (first + ((doubtful >> (i + j) & 1u) != 0 ? i + j : known));
        undecided |= lane_bits(take_residues<Numerators>(of_lane, block + i, i, residues)) << i;
    }
    undecided &= doubtful;
    for (std::size_t i = 0; i < batch_block; ++i) {
        if (block[i][2] <= 0 || block[i][3] <= 0) continue;
        TileShape shape;
        shape.take(block[i][2], block[i][3], tiles.per_width[i]);
        const std::size_t begin = done;
        done += shape.count;
        if (((doubtful & ~undecided) >> i & 1u) == 0) continue;
        // What follows is there already.
        const bool reaches_beyond = shape.count % static_cast<std::size_t>(lanes) != 0;
        if (!fill_tile<Numerators>(
                out, shape, begin, reaches_beyond, scratch, [&](const TileOutputs<Numerators>& here) {
                    return divide_tile_by_residues<Numerators>(job.planes[first + i], tiles, residues, i, shape, here);
                }))
            undecided |= std::uint64_t{1} << i;
    }
    return undecided;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
