// The inner loops of a tile: the quotients in double, and those that stay in doubt to twice the precision of double. Included
// by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The functions of a row's index.
struct TileRow {
    double base[2], q;

    TEXGEN_INLINE void move_to(const TileJob& job, int y) noexcept {
        q = job.q.base + y * job.q.dy;
        for (std::size_t k = 0; k < 2; ++k) base[k] = job.numerator[k].base + y * job.numerator[k].dy;
    }
    TEXGEN_INLINE Doubles q_at(const TileJob& job, const Doubles& index) const noexcept { return index * job.q.dx + q; }
    TEXGEN_INLINE Doubles numerator_at(const TileJob& job, std::size_t k, const Doubles& index) const noexcept {
        return index * job.numerator[k].dx + base[k];
    }
};

// One vector of quotients: marks in `doubtful` where value - error and value + error do not round to one float.
TEXGEN_INLINE void divide_vector(const TileJob& job, const TileRow& row, const Doubles& index, Doubles& reciprocal,
                                 Floats (&quotient)[2], Words& doubtful) noexcept {
    if (!job.q_is_constant) reciprocal = 1.0 / row.q_at(job, index);
    for (std::size_t k = 0; k < 2; ++k) {
        const Doubles value = row.numerator_at(job, k, index) * reciprocal;
        quotient[k] = to_floats(value - job.quotient_error[k]);
        doubtful |= bits(quotient[k]) ^ bits(to_floats(value + job.quotient_error[k]));
    }
}
// The same of numerators and q that are rounded to float and divided there, with no doubt.
TEXGEN_INLINE void divide_in_float(const TileJob& job, const TileRow& row, const Doubles& index,
                                   Floats (&quotient)[2]) noexcept {
    const Floats reciprocal = 1.0f / to_floats(row.q_at(job, index));
    for (std::size_t k = 0; k < 2; ++k) quotient[k] = to_floats(row.numerator_at(job, k, index)) * reciprocal;
}

// Divides a part of a row, or whole rows. Whether a value is in doubt (it is written all the same). What a last vector writes
// beyond its row is written again by those that follow, and may only cause a doubt too many.
template <class CompiledWhereCalled = void>
bool divide_tile(const TileJob& job, const TileJob::Unit& part) noexcept {
    const auto [x_begin, x_end, y_begin, y_end] = part;
    Doubles reciprocal = Doubles{} + 1.0 / job.q.base;
    Words doubtful{};
    RowOutputs row(job, y_begin);
    TileRow tile_row;
    for (int y = y_begin; y < y_end; ++y, row.advance()) {
        tile_row.move_to(job, y);
        Doubles index = indices<Doubles>() + static_cast<double>(x_begin);
        Floats quotient[2];
        std::int64_t x = x_begin;  // what follows the last vector may be no int
        const std::int64_t last = row.writable - lanes;
        for (; x < x_end; x += lanes, index += static_cast<double>(lanes)) {
            if (job.is_in_float)
                divide_in_float(job, tile_row, index, quotient);
            else
                divide_vector(job, tile_row, index, reciprocal, quotient, doubtful);
            if (x > last) break;
            for (std::size_t k = 0; k < 2; ++k) store(row.out[k] + x, quotient[k]);
        }
        if (x < x_end)
            for (std::size_t k = 0; k < 2; ++k) store_some(row.out[k] + x, static_cast<int>(x_end - x), quotient[k]);
        light(job, row, x_begin, x_end);
    }
    return any(doubtful);
}

// The same of a job that knows its ulps, unit by unit of its rows: pairs of vectors share a division, which adds two roundings to a
// quotient, and integers are asked whether it is in doubt. Returns the first unit that is. The last pair of a row ends with it,
// and may begin in the unit before, which was certain in here: the first unit is no shorter than a pair.
inline constexpr int pair = 2 * lanes;
template <class CompiledWhereCalled = void>
TileJob::Unit divide_in_pairs(const TileJob& job, const TileJob::Unit& first) noexcept {
    const int width = job.width, height = job.height;
    const int ulps = job.ulps;
    RowOutputs row(job, first.y_begin);
    TileRow tile_row;
    int begin = first.x_begin;
    for (int y = first.y_begin; y < height; ++y, row.advance(), begin = 0) {
        tile_row.move_to(job, y);
        float* const out[2] = {row.out[0], row.out[1]};
        Doubles index = indices<Doubles>() + static_cast<double>(begin);
        int certain = begin;
        while (certain < width) {
            const int end = width - certain < TileJob::unit_size ? width : certain + TileJob::unit_size;
            Distances least = far_from_middles();
            for (int x = certain; x < end; x += pair, index = index + static_cast<double>(pair)) {
                if (x > end - pair) {
                    index = index - static_cast<double>(x - (end - pair));
                    x = end - pair;
                }
                const Doubles next_index = index + static_cast<double>(lanes);
                const Doubles q = tile_row.q_at(job, index), next_q = tile_row.q_at(job, next_index);
                const Doubles of_both = 1.0 / (q * next_q);
                const Doubles reciprocal = of_both * next_q, next_reciprocal = of_both * q;
                Doubles value[2], next_value[2];
                for (std::size_t k = 0; k < 2; ++k) {
                    value[k] = tile_row.numerator_at(job, k, index) * reciprocal;
                    next_value[k] = tile_row.numerator_at(job, k, next_index) * next_reciprocal;
                    store(out[k] + x, to_floats(value[k]));
                    store(out[k] + x + lanes, to_floats(next_value[k]));
                }
                least = nearer(least, value[0], value[1], ulps);
                least = nearer(least, next_value[0], next_value[1], ulps);
            }
            if (any_zero(least)) break;
            certain = end;
        }
        light(job, row, begin, certain);
        if (certain < width) return job.unit_at(certain, y);
    }
    return {0, 0, height, height};
}

// A tile's functions at a vector of fragments.
struct CloseFunctionsAt {
    const CloseFunction (&of)[3];
    std::int64_t x;
    int y;

    TEXGEN_INLINE CloseValues values(std::size_t n) const noexcept {
        const Doubles index = indices<Doubles>() + static_cast<double>(x);
        const auto& [high, low, error, grain, residue] = of[n];
        return {index * high.dx + (high.base + y * high.dy), index * low.dx + (low.base + y * low.dy),
                Doubles{} + 1.01 * error};
    }
    TEXGEN_INLINE Residues residues(std::size_t n) const noexcept {
        const RampOf<std::uint64_t>& residue = of[n].residue;
        return (indices<Residues>() + static_cast<std::uint64_t>(x)) * residue.dx +
               (residue.base + static_cast<std::uint64_t>(y) * residue.dy);
    }
    TEXGEN_INLINE double grain(std::size_t n) const noexcept { return of[n].grain; }
};

// Vectors of which nothing is asked stay as they are. One numerator alone stands in both places.
template <class CompiledWhereCalled = void>
std::uint64_t fill_tile_closely(const TileJob& job, const CloseFunctions& functions, TileJob::Unit unit,
                                std::uint64_t asked) noexcept {
    const bool is_more_known = functions.have_residues || functions.are_close;
    const std::size_t numerators = job.out[0] == job.out[1] ? 1 : 2;
    const bool q_is_constant = is_constant(functions.function[CloseFunctions::q].high) &&
                               is_constant(functions.function[CloseFunctions::q].low);
    bool q_is_known = false;
    CloseDivisor q;
    RowOutputs row(job, unit.y_begin);
    std::uint64_t doubtful = 0;
    int place = 0;
    for (int y = unit.y_begin; y < unit.y_end; ++y, row.advance()) {
        for (std::int64_t x = unit.x_begin; x < unit.x_end; x += lanes) {
            const std::int64_t left = unit.x_end - x;
            const int count = left < lanes ? static_cast<int>(left) : lanes;
            const std::uint64_t all = ((std::uint64_t{1} << count) - 1) << place;
            place += count;
            if ((asked & all) == 0) continue;
            CloseFragments<2> fragments;
            const CloseFunctionsAt at{functions.function, x, y};
            if (!q_is_known) q.take(at.values(CloseFunctions::q));
            q_is_known = q_is_constant;
            fragments.divide(at, q, numerators, functions.tolerance, is_more_known);
            doubtful |= bits_of(fragments.doubtful) << (place - count) & all;
            Floats result[3] = {fragments.quotient[numerators - 1], fragments.quotient[0]};
            if (row.lit != nullptr) result[2] = lit_of(job, fragments.quotient, narrow(q.front));
            float* const to[3] = {row.out[1], row.out[0], row.lit};
            const std::int64_t writable = asked == ~std::uint64_t{0} ? row.writable : unit.x_end;
            for (std::size_t k = 0; k < 3; ++k)
                if (to[k] != nullptr) store_from(to[k], x, unit.x_end, writable, result[k]);
        }
    }
    return doubtful;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
