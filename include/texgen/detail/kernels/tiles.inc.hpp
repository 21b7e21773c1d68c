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
            WideWords least = ~WideWords{} & 0x7fffffff;
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
                least = minimum(least, minimum(distances_from_middles(value[0], value[1], ulps),
                                               distances_from_middles(next_value[0], next_value[1], ulps)));
            }
            if (any_zero(least)) break;
            certain = end;
        }
        light(job, row, begin, certain);
        if (certain < width) return job.unit_at(certain, y);
    }
    return {0, 0, height, height};
}

// A function of a row's index.
struct CloseRow {
    double high, high_dx, low, low_dx, error, grain;
    std::uint64_t residue, residue_dx;

    TEXGEN_INLINE void take(const CloseFunction& function) noexcept {
        high_dx = function.high.dx;
        low_dx = function.low.dx;
        error = 1.01 * function.error;
        grain = function.grain;
        residue_dx = function.residue.dx;
    }

    TEXGEN_INLINE void move_to(const CloseFunction& function, int y) noexcept {
        high = function.high.base + y * function.high.dy;
        low = function.low.base + y * function.low.dy;
        residue = function.residue.base + static_cast<std::uint64_t>(y) * function.residue.dy;
    }

    TEXGEN_INLINE Doubles value_at(const Doubles& index) const noexcept {
        return (index * high_dx + high) + (index * low_dx + low);
    }
    TEXGEN_INLINE Residues residues_at(std::int64_t x) const noexcept {
        return (indices<Residues>() + static_cast<std::uint64_t>(x)) * residue_dx + residue;
    }
    // Where the residues are the values, which are nearly these.
    TEXGEN_INLINE LongWords are_known(const Doubles& values) const noexcept {
        return greater(Doubles{} + 0x1p62 * grain, magnitude(values) + error);
    }
};

// A vector of q, and what its quotients share. In what is left of a quotient, F - m Q, m is the middle of two floats, which
// has 25 bits: with half of the high part of Q in two parts of 26 bits the products with 2 m are exact.
struct CloseQ {
    Doubles value, upper, lower, low, reciprocal, relative_error;
    LongWords in_front, doubt;
    Residues residues;

    TEXGEN_INLINE void move_to(const CloseRow& row, double unit, const Doubles& index, std::int64_t x) noexcept {
        const Doubles high = index * row.high_dx + row.high;
        const Doubles rest = index * row.low_dx + row.low;
        const Doubles q = high + rest;
        value = q;
        in_front = greater(q, row.error * 256.0);
        doubt = ~(in_front | greater(q * -1.0, row.error));
        residues = row.residues_at(x);
        doubt &= ~row.are_known(q) | are_positive(residues);
        reciprocal = where(in_front, 1.0 / q);
        relative_error = reciprocal * row.error + 0x1p-50;
        upper = (high + unit) - unit;
        lower = (high - upper) * 0.5;
        upper = upper * 0.5;
        low = rest * 0.5;
    }
};

// The nearer of `below` and `above`, next to one another, by the sign of the remainder that a quotient leaves beyond their
// middle (`middle` is twice that, `unit` the power of two below it). Returns the lanes that this decides.
TEXGEN_INLINE Words decide_between(const Floats& below, const Floats& above, const Doubles& middle, const Doubles& unit,
                                   const Doubles& remainder, const LongWords& is_open, const LongWords& is_tie,
                                   Floats& value) noexcept {
    // A step from the middle that is less than half of what the floats are away.
    const Doubles step = where(is_open, with_sign_of(unit * 0x1p-26, remainder));
    const Floats nearest = to_floats((middle + step) * 0.5);
    const LongWords are_neighbours =
        at_most(to_doubles_as_rounded(above) - to_doubles_as_rounded(below), unit * 0x1p-24);
    const Words decided =
        narrow((is_open | is_tie) & are_neighbours) & ~equal(bits(below) & bits(above) & 0x7f800000, 0);
    value = select(decided, nearest, below);
    return decided;
}

// What F - m Q is of a vector, or nearly: m the middle of the floats below and above a quotient.
struct CloseRemainder {
    Floats below, above;
    Doubles middle, unit, value, error;  // middle is twice m, and unit the power of two below it
};

// The sign of F - m Q by its residue: the finer one of its terms' grains times an integer. Returns the lanes of `doubt` that
// this does not decide.
template <class Grain>
TEXGEN_INLINE Words decide_by_residues(const Residues& f, const Grain& f_grain, const Residues& q, const Grain& q_grain,
                                       const CloseRemainder& remainder, const Words& doubt, Floats& value) noexcept {
    const Doubles finer = minimum(remainder.unit * (0x1p-25 * q_grain), Doubles{} + f_grain);
    const Doubles per_finer = reciprocals_of_powers(finer);
    const Doubles of_f = per_finer * f_grain;
    const Doubles of_q = remainder.middle * (0.5 * q_grain) * per_finer;
    const LongWords is_known = greater(finer * 0x1p62, magnitude(remainder.value) + remainder.error) &
                               greater(Doubles{} + 0x1p62, maximum(of_f, magnitude(of_q)));
    const Residues residues = f * to_residues(where(is_known, of_f)) - q * to_residues(where(is_known, of_q));
    Floats nearest;
    const Words decided = doubt & decide_between(remainder.below, remainder.above, remainder.middle, remainder.unit,
                                                 signs_of(residues), is_known & ~are_zero(residues), is_known, nearest);
    value = select(decided, nearest, value);
    return doubt & ~decided;
}
// Where F is 0, as its residue says, so is the quotient.
TEXGEN_INLINE Words decide_zeros(const LongWords& are_zeros, const Words& doubt, Floats& value) noexcept {
    value = select(doubt & narrow(are_zeros), Floats{}, value);
    return doubt & ~narrow(are_zeros);
}

// The quotients of a vector, 0 behind. Where value - error and value + error do not round to one float but to neighbours, the
// sign of F - m Q decides: that of its residue, if there is one that says all of it, else of what two doubles hold. It is a
// multiple of the grain of its terms: what is certainly smaller is 0, and the tie is certain, too. Returns the lanes that stay in
// doubt.
TEXGEN_INLINE Words divide_closely(const CloseRow& row, double q_grain, const CloseQ& q, double half_q_error,
                                   const Doubles& index, std::int64_t x, Floats& value) noexcept {
    const Doubles high = index * row.high_dx + row.high;
    const Doubles low = index * row.low_dx + row.low;
    const Doubles sum = high + low;
    const Doubles quotient = where(q.in_front, sum * q.reciprocal);  // no -0 behind
    const Doubles error = magnitude(quotient) * q.relative_error + q.reciprocal * row.error;
    CloseRemainder remainder;
    remainder.below = to_floats(quotient - error);
    remainder.above = to_floats(quotient + error);
    value = remainder.below;
    const Words differ = bits(remainder.below) ^ bits(remainder.above);
    if (!any(differ)) return Words{};
    const Doubles middle = to_doubles_as_rounded(remainder.below) + to_doubles_as_rounded(remainder.above);
    remainder.middle = middle;
    remainder.unit = power_of_two_below(middle);
    Words doubt = ~equal(differ, 0);
    if (q_grain > 0.0) {
        // The middle is as near to the quotient as F/Q is: so |F - m Q| is at most twice the error times Q.
        remainder.value = Doubles{};
        remainder.error = error * q.value * 2.25;
        const Residues residues = row.residues_at(x);
        doubt = decide_by_residues(residues, row.grain, q.residues, q_grain, remainder, doubt, value);
        if (!any(doubt)) return doubt;
        doubt = decide_zeros(row.are_known(sum) & are_zero(residues), doubt, value);
    }
    const Doubles product = middle * q.upper;
    const Doubles rest = high - product;
    const Doubles taken = rest - high;
    const Doubles lost = (high - (rest - taken)) - (product + taken);
    remainder.value = (rest - middle * q.lower) + (lost + (low - middle * q.low));
    remainder.error = magnitude(middle) * half_q_error + row.error;
    const LongWords is_open = greater(magnitude(remainder.value), remainder.error);
    const LongWords is_tie =
        greater(minimum(remainder.unit * (0x1p-25 * q_grain), Doubles{} + row.grain), remainder.error * 4.0);
    Floats nearest;
    const Words decided = doubt & decide_between(remainder.below, remainder.above, middle, remainder.unit,
                                                 remainder.value, is_open, is_tie, nearest);
    value = select(decided, nearest, value);
    return doubt & ~decided;
}

// The same of both numerators, and the lanes of a vector that stay in doubt.
template <class CompiledWhereCalled = void>
TEXGEN_RARE void decide_vector(const CloseRow (&rows)[3], double q_unit, std::int64_t x, bool q_is_known, CloseQ& q,
                               Floats (&value)[2], Words& doubt) noexcept {
    const Doubles index = indices<Doubles>() + static_cast<double>(x);
    if (!q_is_known) q.move_to(rows[2], q_unit, index, x);
    doubt = narrow(q.doubt);
    for (std::size_t k = 0; k < 2; ++k)
        doubt |= divide_closely(rows[k], rows[2].grain, q, rows[2].error * 0.5, index, x, value[k]);
}

// A vector is asked more only where it has a lane in doubt, and only if more is known; at once if residues are, but of a mask
// alone, whose doubt about q = 0 has no company. One numerator stands in both places.
template <class CompiledWhereCalled = void>
std::uint64_t fill_tile_closely(const TileJob& job, const CloseFunctions& functions, TileJob::Unit unit) noexcept {
    const CloseFunction* const function[] = {&functions.numerator[0], &functions.numerator[1], &functions.q};
    CloseRow rows[3];
    for (std::size_t k = 0; k < 3; ++k) rows[k].take(*function[k]);
    const bool at_once = functions.have_residues && !(job.is_scratch[0] && job.is_scratch[1]);
    const bool q_is_constant =
        is_constant(functions.q.high) && is_constant(functions.q.low) && is_constant(functions.q.residue);
    bool q_is_known = false;
    CloseQ close_q;
    RowOutputs row(job, unit.y_begin);
    std::uint64_t doubtful = 0;
    for (int y = unit.y_begin; y < unit.y_end; ++y, row.advance()) {
        for (std::size_t k = 0; k < 3; ++k) rows[k].move_to(*function[k], y);
        for (std::int64_t x = unit.x_begin; x < unit.x_end; x += lanes) {
            const int count = unit.x_end - x < lanes ? static_cast<int>(unit.x_end - x) : lanes;
            Floats value[2];
            LongWords in_front{};
            Words doubt{};
            if (!at_once) {
                const Doubles index = indices<Doubles>() + static_cast<double>(x);
                const Doubles q = rows[2].value_at(index);
                in_front = greater(q, rows[2].error * 256.0);
                const Doubles reciprocal = where(in_front, 1.0 / q);
                const Doubles relative_error = reciprocal * rows[2].error + 0x1p-50;
                doubt = narrow(~greater(magnitude(q), rows[2].error * 256.0));
                TEXGEN_UNROLL
                for (std::size_t k = 0; k < 2; ++k) {
                    const Doubles quotient = where(in_front, rows[k].value_at(index) * reciprocal);  // no -0 behind
                    const Doubles error = magnitude(quotient) * relative_error + reciprocal * rows[k].error;
                    value[k] = to_floats(quotient - error);
                    doubt |= bits(value[k]) ^ bits(to_floats(quotient + error));
                }
            }
            if (at_once || any(doubt)) {
                if (at_once || functions.have_residues || functions.are_close) {
                    Floats decided[2];  // in memory: the values are in registers
                    Words open;
                    decide_vector(rows, functions.q_unit, x, q_is_known, close_q, decided, open);
                    q_is_known = q_is_constant;
                    in_front = close_q.in_front;
                    doubt = open;
                    TEXGEN_UNROLL
                    for (std::size_t k = 0; k < 2; ++k) value[k] = decided[k];
                }
                const auto first = (y - unit.y_begin) * (unit.x_end - unit.x_begin) + (x - unit.x_begin);
                for (int i = 0; i < count; ++i)
                    if (lane(doubt, i) != 0) doubtful |= std::uint64_t{1} << (first + i);
            }
            const Floats lit = lit_of(job, value, narrow(in_front));
            if (x + lanes <= row.writable) {
                TEXGEN_UNROLL
                for (std::size_t k = 0; k < 2; ++k) store(row.out[k] + x, value[k]);
                if (row.lit != nullptr) store(row.lit + x, lit);
            } else {
                const Floats result[3] = {value[0], value[1], lit};
                float* const to[3] = {row.out[0], row.out[1], row.lit};
                for (std::size_t k = 0; k < 3; ++k)
                    if (to[k] != nullptr) store_some(to[k] + x, count, result[k]);
            }
        }
    }
    return doubtful;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
