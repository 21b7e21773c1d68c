// The inner loops of a tile: the quotients in double, and those that stay in doubt to twice the precision of double.
// Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The functions along a row, of the fragment's index.
struct TileRow {
    double base[2], q;

    TEXGEN_INLINE void move_to(const TileJob& job, int y) noexcept {
        q = job.q.base + y * job.q.dy;
        for (std::size_t k = 0; k < 2; ++k) base[k] = job.numerator.base[k] + y * job.numerator.dy[k];
    }
    TEXGEN_INLINE Doubles q_at(const TileJob& job, const Doubles& index) const noexcept { return index * job.q.dx + q; }
    TEXGEN_INLINE Doubles numerator_at(const TileJob& job, std::size_t k, const Doubles& index) const noexcept {
        return index * job.numerator.dx[k] + base[k];
    }
};

// Rotates by up to 63 bits to the left. (std::rotl() counts in int or in unsigned, depending on the library.)
TEXGEN_INLINE std::uint64_t rotated(std::uint64_t bits, int count) noexcept {
    return bits << count | bits >> (-count & 63);
}

// Divides a part of a row, or whole rows. Returns which fragments are in doubt (they are written all the same). What a
// row's last vector writes beyond it is overwritten by those that follow, and causes needless doubt at worst.
template <class CompiledWhereCalled = void>
std::uint64_t divide_tile(const TileJob& job, const TileJob::Unit& part) noexcept {
    const auto [x_begin, x_end, y_begin, y_end] = part;
    Doubles reciprocal = Doubles{} + 1.0 / job.q.base;
    // Rotates with the vectors, so that the lowest bit is that of the next vector's first fragment.
    std::uint64_t doubtful = 0;
    const int beyond = (x_begin - x_end) & (lanes - 1);
    RowOutputs row(job, y_begin);
    TileRow tile_row;
    for (int y = y_begin; y < y_end; ++y, row.advance()) {
        tile_row.move_to(job, y);
        Doubles index = indices<Doubles>() + static_cast<double>(x_begin);
        Floats quotient[2];
        std::int64_t x = x_begin;  // what follows the last vector may be no int
        const std::int64_t last = row.writable - lanes;
        for (; x < x_end; x += lanes, index += static_cast<double>(lanes)) {
            if (job.is_in_float) {  // without doubt
                const Floats of_q = 1.0f / to_floats(tile_row.q_at(job, index));
                for (std::size_t k = 0; k < 2; ++k)
                    quotient[k] = to_floats(tile_row.numerator_at(job, k, index)) * of_q;
            } else {
                if (!job.q_is_constant) reciprocal = 1.0 / tile_row.q_at(job, index);
                Words in_doubt{};
                TEXGEN_FOR (std::size_t k = 0; k < 2; ++k) {
                    const RoundedEnds ends(tile_row.numerator_at(job, k, index) * reciprocal, job.quotient_error[k]);
                    quotient[k] = ends.below;
                    in_doubt |= ends.differ();
                }
                doubtful = rotated(doubtful | lane_bits(in_doubt), 64 - lanes);
            }
            if (x > last) break;
            TEXGEN_FOR (std::size_t k = 0; k < 2; ++k) store(row.out[k] + x, quotient[k]);
        }
        if (x < x_end)
            for (std::size_t k = 0; k < 2; ++k) store_some(row.out[k] + x, static_cast<int>(x_end - x), quotient[k]);
        light(job, row, x_begin, x_end);
        doubtful = rotated(doubtful, beyond);
    }
    const unsigned count = static_cast<unsigned>(x_end - x_begin) * static_cast<unsigned>(y_end - y_begin);
    return rotated(doubtful, static_cast<int>(count % 64));
}

inline constexpr int pair = 2 * lanes;

// The same for a job that knows its ulps, unit by unit of its rows: a pair of vectors shares a division, which adds two
// roundings to a quotient, and integers tell whether one is in doubt. Returns the first unit with such a quotient. A
// row's last pair ends with it, and may begin in the unit before, certain by then: a first unit is no shorter.
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
            Distances distance = far_from_middles();
            for (int x = certain; x < end; x += pair, index = index + static_cast<double>(pair)) {
                if (x > end - pair) {
                    index = index - static_cast<double>(x - (end - pair));
                    x = end - pair;
                }
                const Doubles next_index = index + static_cast<double>(lanes);
                const Doubles q = tile_row.q_at(job, index), next_q = tile_row.q_at(job, next_index);
                const SharedDivision division(q, next_q);
                Doubles value[2], next_value[2];
                for (std::size_t k = 0; k < 2; ++k) {
                    value[k] = tile_row.numerator_at(job, k, index) * division.reciprocal[0];
                    next_value[k] = tile_row.numerator_at(job, k, next_index) * division.reciprocal[1];
                    store(out[k] + x, to_floats(value[k]));
                    store(out[k] + x + lanes, to_floats(next_value[k]));
                }
                distance = nearer(distance, value[0], value[1], ulps);
                distance = nearer(distance, next_value[0], next_value[1], ulps);
            }
            if (any_zero(distance)) break;
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
    Doubles x, y;
    bool are_close, are_sums_first;

    TEXGEN_INLINE CloseValues values(std::size_t n) const noexcept {
        const auto& [high, low, error, grain, residue] = of[n];
        Doubles rest{};
        if (are_close) rest = x * low.dx + (y * low.dy + low.base);
        return {x * high.dx + (y * high.dy + high.base), rest, Doubles{} + 1.01 * error};
    }
    TEXGEN_INLINE Residues residues(std::size_t n) const noexcept {
        const RampOf<std::uint64_t>& residue = of[n].residue;
        return to_residues(x) * residue.dx + (to_residues(y) * residue.dy + residue.base);
    }
    TEXGEN_INLINE double grain(std::size_t n) const noexcept { return of[n].grain; }
};

// Decides the fragments of a unit that are asked for, none beyond it. They are gathered into vectors wherever they
// stand, as in a column; more than half of a unit is asked as all of it. One numerator alone stands in both places.
template <class CompiledWhereCalled = void>
TEXGEN_LARGE std::uint64_t fill_tile_closely(const TileJob& job, const CloseFunctions& functions,
                                             const TileJob::Unit& unit, std::uint64_t asked) noexcept {
    constexpr int most = TileJob::unit_size + lanes;
    const bool is_more_known = functions.have_residues || functions.are_close;
    const std::size_t numerators = job.out[0] == job.out[1] ? 1 : 2;
    const int width = unit.x_end - unit.x_begin;
    const int size = width * (unit.y_end - unit.y_begin);
    const std::uint64_t all = ~std::uint64_t{0} >> (TileJob::unit_size - size);
    if (asked == 0) return 0;
    const bool are_all = 2 * std::popcount(asked) > size;
    if (are_all) asked = all;
    double number[most], x[most], y[most];
    int count = are_all ? size : 0;
    for (std::uint64_t left = are_all ? 0 : asked; left != 0; left &= left - 1)
        number[count++] = std::countr_zero(left);
    if (!are_all) store(number + count, Doubles{});
    for (int i = 0; i < count; i += lanes) {
        const Doubles n = are_all ? indices<Doubles>() + static_cast<double>(i) : load<Doubles>(number + i);
        // A half more keeps the quotient away from the integers.
        const Doubles row = truncated((n + 0.5) * (1.0 / width));
        store(x + i, n - row * static_cast<double>(width) + static_cast<double>(unit.x_begin));
        store(y + i, row + static_cast<double>(unit.y_begin));
    }
    float result[3][most];
    std::uint64_t doubtful = 0;
    for (int i = 0; i < count; i += lanes) {
        const CloseFunctionsAt at{functions.function, load<Doubles>(x + i), load<Doubles>(y + i), functions.are_close,
                                  functions.are_sums_first};
        const CloseDivisor q(at.values(CloseFunctions::q));
        CloseFragments<2, false> fragments;
        fragments.divide(at, q, numerators, functions.tolerance, is_more_known);
        doubtful |= lane_bits(fragments.doubtful) << i;
        // Where most of the first vector stay in doubt, the others are likely to need more as well.
        if (!is_more_known && i == 0 && 2 * std::popcount(doubtful) > lanes) return asked;
        for (std::size_t k = 0; k < numerators; ++k) store(result[k] + i, fragments.quotient[k]);
        if (job.lit != nullptr) store(result[2] + i, lit_of(job, fragments.quotient, narrow(q.front)));
    }
    float* const to[3] = {job.is_scratch[0] ? nullptr : job.out[0],
                          job.is_scratch[1] || numerators == 1 ? nullptr : job.out[1], job.lit};
    const auto offset = [&](int column, int row) { return static_cast<std::ptrdiff_t>(row) * job.pitch + column; };
    const int run = width == job.pitch ? size : width;  // rows that follow one another are one
    std::ptrdiff_t place[most];
    for (int i = 0; !are_all && i < count; ++i) place[i] = offset(static_cast<int>(x[i]), static_cast<int>(y[i]));
    for (std::size_t k = 0; k < 3; ++k) {
        if (to[k] == nullptr) continue;
        float* row = to[k] + offset(unit.x_begin, unit.y_begin);
        for (int i = 0; are_all && i < size; i += run, row += job.pitch)
            std::memcpy(row, result[k] + i, static_cast<std::size_t>(run) * sizeof(float));
        for (int i = 0; !are_all && i < count; ++i) to[k][place[i]] = result[k][i];
    }
    doubtful &= ~std::uint64_t{0} >> (TileJob::unit_size - count);
    if (are_all) return doubtful;
    for (asked = 0; doubtful != 0; doubtful &= doubtful - 1)
        asked |= std::uint64_t{1} << static_cast<int>(number[std::countr_zero(doubtful)]);
    return asked;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
