// The inner loops of a tile: the quotients in double, and those that stay in doubt to twice the precision of double. Included
// by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The functions of the row's index.
template <std::size_t Numerators>
struct TileRow : RowOutputs<Numerators> {
    double base[Numerators];
    double q;

    TEXGEN_INLINE TileRow(const TileJob& job, int y) noexcept : RowOutputs<Numerators>(job, y) {}

    TEXGEN_INLINE void move_to(const TileJob& job, int y) noexcept {
        q = job.q.base + y * job.q.dy;
        for (std::size_t k = 0; k < Numerators; ++k) base[k] = job.numerator[k].base + y * job.numerator[k].dy;
    }
};

// One vector of quotients from `index` on. With Exact, marks in `doubtful` where value - error and value + error do
// not round to one float; else numerators and q are rounded to float and divided there.
template <bool Exact, std::size_t Numerators>
TEXGEN_INLINE void divide_vector(const TileJob& job, const TileRow<Numerators>& row, const Doubles& index,
                                 Doubles& reciprocal, Floats (&quotient)[Numerators], Words& doubtful) noexcept {
    if constexpr (Exact) {
        if (!job.q_is_constant) reciprocal = 1.0 / (index * job.q.dx + row.q);
        for (std::size_t k = 0; k < Numerators; ++k) {
            const Doubles value = (index * job.numerator[k].dx + row.base[k]) * reciprocal;
            quotient[k] = to_floats(value - job.quotient_error[k]);
            doubtful |= bits(quotient[k]) ^ bits(to_floats(value + job.quotient_error[k]));
        }
    } else {
        const Floats float_reciprocal = 1.0f / to_floats(index * job.q.dx + row.q);
        for (std::size_t k = 0; k < Numerators; ++k)
            quotient[k] = to_floats(index * job.numerator[k].dx + row.base[k]) * float_reciprocal;
    }
}

// The units of the job from `unit` on, up to the first one with a doubtful value (it is written all the same). What a last
// vector writes beyond its row is written again by those that follow, and may only cause a doubt too many.
template <bool Exact, std::size_t Numerators>
TEXGEN_INLINE TileJob::Unit divide_units(const TileJob& job, TileJob::Unit unit) noexcept {
    Doubles reciprocal = Doubles{} + 1.0 / job.q.base;
    for (; !job.is_done(unit); unit = job.unit_after(unit)) {
        Words doubtful{};
        TileRow<Numerators> row(job, unit.y_begin);
        for (int y = unit.y_begin; y < unit.y_end; ++y, row.advance()) {
            row.move_to(job, y);
            Doubles index = indices<Doubles>() + static_cast<double>(unit.x_begin);
            Floats quotient[Numerators];
            std::int64_t x = unit.x_begin;  // what follows the last vector may be no int
            const std::int64_t last = row.writable - lanes;
            for (; x < unit.x_end && x <= last; x += lanes, index += static_cast<double>(lanes)) {
                divide_vector<Exact>(job, row, index, reciprocal, quotient, doubtful);
                store_all(row, x, quotient, ~Words{});
            }
            if (x >= unit.x_end) continue;
            divide_vector<Exact>(job, row, index, reciprocal, quotient, doubtful);
            store_part(row, x, unit.x_end, quotient, ~Words{});
        }
        if (Exact && any(doubtful)) break;
    }
    return unit;
}

template <class CompiledWhereCalled = void>
TileJob::Unit fill_tile_exact(const TileJob& job, TileJob::Unit first) noexcept {
    return job.numerators == 2 ? divide_units<true, 2>(job, first) : divide_units<true, 1>(job, first);
}

template <class CompiledWhereCalled = void>
void fill_tile_float_divided(const TileJob& job) noexcept {
    divide_units<false, 2>(job, job.unit_at(0, 0));
}

// A function of a row's index.
struct CloseRow {
    Doubles high, high_dx, low, low_dx, error;
    double grain;
    std::uint64_t residue, residue_dx;

    TEXGEN_INLINE void take(const CloseFunction& function) noexcept {
        high_dx = Doubles{} + function.high.dx;
        low_dx = Doubles{} + function.low.dx;
        error = Doubles{} + 1.01 * function.error;
        grain = function.grain;
        residue_dx = function.residue.dx;
    }

    TEXGEN_INLINE void move_to(const CloseFunction& function, int y) noexcept {
        high = Doubles{} + (function.high.base + y * function.high.dy);
        low = Doubles{} + (function.low.base + y * function.low.dy);
        residue = function.residue.base + static_cast<std::uint64_t>(y) * function.residue.dy;
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
    Doubles upper, lower, low, reciprocal, relative_error;
    LongWords in_front, doubt;

    TEXGEN_INLINE CloseQ(const CloseRow& row, double unit, const Doubles& index, std::int64_t x) noexcept {
        const Doubles high = index * row.high_dx + row.high;
        const Doubles rest = index * row.low_dx + row.low;
        const Doubles q = high + rest;
        in_front = greater(q, row.error * 256.0);
        doubt = ~(in_front | greater(q * -1.0, row.error));
        if (any(doubt)) doubt &= ~row.are_known(q) | are_positive(row.residues_at(x));
        reciprocal = where(in_front, 1.0 / q);
        relative_error = reciprocal * row.error + 0x1p-50;
        upper = (high + unit) - unit;
        lower = (high - upper) * 0.5;
        upper = upper * 0.5;
        low = rest * 0.5;
    }
};

// The nearer of `below` and `above`, next to one another, by the sign of the remainder that a quotient leaves beyond their
// middle (`middle` is twice that). Returns the lanes that this decides.
TEXGEN_INLINE Words decide_between(const Floats& below, const Floats& above, const Doubles& middle,
                                   const Doubles& remainder, const LongWords& is_open, const LongWords& is_tie,
                                   Floats& value) noexcept {
    // A step from the middle that is less than half of what the floats are away.
    const Doubles unit = power_of_two_below(middle);
    const Doubles step = where(is_open, with_sign_of(unit * 0x1p-26, remainder));
    const Floats nearest = to_floats((middle + step) * 0.5);
    const LongWords are_neighbours = at_most(to_doubles(above) - to_doubles(below), unit * 0x1p-24);
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

// Where F - m Q is in doubt its residue says what it is: the finer one of its terms' grains times an integer. Returns the
// lanes of `doubt` that this does not decide; F nearly is `sum`.
TEXGEN_INLINE Words decide_by_residues(const CloseRow& row, const CloseRow& q, const CloseRemainder& remainder,
                                       const Doubles& sum, std::int64_t x, const Words& doubt, Floats& value) noexcept {
    const Doubles finer = minimum(remainder.unit * (0x1p-25 * q.grain), Doubles{} + row.grain);
    const Doubles per_finer = 1.0 / finer;
    const Doubles of_f = per_finer * row.grain;
    const Doubles of_q = remainder.middle * (0.5 * q.grain) * per_finer;
    const LongWords is_known = greater(finer * 0x1p62, magnitude(remainder.value) + remainder.error) &
                               greater(0x1p62 - maximum(of_f, magnitude(of_q)), 0.0);
    const Residues of_row = row.residues_at(x);
    const Residues residues =
        of_row * to_residues(where(is_known, of_f)) - q.residues_at(x) * to_residues(where(is_known, of_q));
    Floats nearest;
    const Words decided = doubt & decide_between(remainder.below, remainder.above, remainder.middle, signs_of(residues),
                                                 is_known & ~are_zero(residues), is_known, nearest);
    const Words vanishes = doubt & narrow(row.are_known(sum) & are_zero(of_row));
    value = select(vanishes, Floats{}, select(decided, nearest, value));
    return doubt & ~(decided | vanishes);
}

// The quotients of a vector, 0 behind. Where value - error and value + error do not round to one float but to neighbours, the
// sign of F - m Q decides. That is a multiple of the grain of its terms: what is certainly smaller is 0, and the tie is certain,
// too. Returns the lanes that stay in doubt.
TEXGEN_INLINE Words divide_closely(const CloseRow& row, const CloseRow& q_row, const CloseQ& q,
                                   const Doubles& half_q_error, const Doubles& index, std::int64_t x,
                                   Floats& value) noexcept {
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
    const Doubles middle = to_doubles(remainder.below) + to_doubles(remainder.above);
    const Doubles product = middle * q.upper;
    const Doubles rest = high - product;
    const Doubles taken = rest - high;
    const Doubles lost = (high - (rest - taken)) - (product + taken);
    remainder.middle = middle;
    remainder.unit = power_of_two_below(middle);
    remainder.value = (rest - middle * q.lower) + (lost + (low - middle * q.low));
    remainder.error = magnitude(middle) * half_q_error + row.error;
    const LongWords is_open = greater(magnitude(remainder.value), remainder.error);
    const LongWords is_tie =
        greater(minimum(remainder.unit * (0x1p-25 * q_row.grain), Doubles{} + row.grain), remainder.error * 4.0);
    const Words decided =
        decide_between(remainder.below, remainder.above, middle, remainder.value, is_open, is_tie, value);
    const Words doubt = ~(decided | equal(differ, 0));
    return any(doubt) ? decide_by_residues(row, q_row, remainder, sum, x, doubt, value) : doubt;
}

// One numerator stands in both places.
template <class CompiledWhereCalled = void>
std::uint64_t fill_tile_closely(const TileJob& job, const CloseFunctions& functions, TileJob::Unit unit) noexcept {
    const CloseFunction* const function[] = {&functions.numerator[0], &functions.numerator[1], &functions.q};
    CloseRow rows[3];
    for (std::size_t k = 0; k < 3; ++k) rows[k].take(*function[k]);
    const CloseRow& q_row = rows[2];
    RowOutputs<2> row(job, unit.y_begin);
    const Doubles half_q_error = q_row.error * 0.5;
    std::uint64_t doubtful = 0;
    int shift = 0;
    for (int y = unit.y_begin; y < unit.y_end; ++y, row.advance()) {
        for (std::size_t k = 0; k < 3; ++k) rows[k].move_to(*function[k], y);
        for (std::int64_t x = unit.x_begin; x < unit.x_end; x += lanes) {
            const Doubles index = indices<Doubles>() + static_cast<double>(x);
            const CloseQ q(q_row, functions.q_unit, index, x);
            Floats value[2];
            Words doubt = narrow(q.doubt);
            for (std::size_t k = 0; k < 2; ++k)
                doubt |= divide_closely(rows[k], q_row, q, half_q_error, index, x, value[k]);
            store_from(row, x, unit.x_end, value, narrow(q.in_front));
            const int count = unit.x_end - x < lanes ? static_cast<int>(unit.x_end - x) : lanes;
            if (any(doubt))
                for (int i = 0; i < count; ++i)
                    if (lane(doubt, i) != 0) doubtful |= std::uint64_t{1} << (shift + i);
            shift += count;
        }
    }
    return doubtful;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
