// The inner loops of a tile under a tolerance: chunks of its rows about their middle. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// About the middle of a chunk of a row, i fragments from it, F/Q is exactly
//   u + d i / (1 + x),  u = F/Q and d = (F_x - u Q_x) / Q in the middle,  x = b i, b = Q_x / Q in the middle,
// and i fragments before it u - d i / (1 - x): both are of y = i / (1 - x^2), u + d y (1 - x) and u - d y (1 + x). And
// 1 / (1 - x^2) = (1 + x^2) (1 + x^4) ..., which times 1 - x has a relative error of x^(2^n) after n factors, that one
// included: two or three, until a division is cheaper. (A line or a parabola saves nothing beside the stores.)
//
// With h the largest |i|, X = |b| h <= 3/4 and S = 1 + X + 4 X^2 >= 1/(1 - X), no step |d i / (1 + x)| is above h |d| /
// (1 - X), which is at most D = h |d| S. In float, with r = 2^-24, the largest errs by 2 r X/(1 - X) of itself by the
// roundings of b and of x; d and its product add 2 r. With a division x^2 adds r X^2/(1 - X^2), 1 - x^2 and the
// quotient 2 r, y x, of which the step is a sum, r X/(1 + X), and that sum r; factors, where X <= 1/4, add 0.1 r more
// than all that. So with the last sum's share it errs by (6.1 + 2 X/(1 - X) + X/(1 - X^2)) r of itself, and that is
// less than (6.4 + 24 X^4) r D. u adds 2 r |u|, by its rounding and the last sum's. Subnormals, or what is flushed to
// zero, add less than 2^-116; the doubles (e_F + (|u| + D) e_Q) / Q.
// In the code bend is b, extent X, reach D; room is what the tolerance leaves for the factors' remainder, x^(2^n) D.

// A chunk's error but for that remainder, of s or of t, or of both: u, reach, 1 / Q and X^4 at their largest.
template <class Number, class Error, class Extent>
TEXGEN_INLINE Number chunk_error(const Number& u, const Number& reach, const Error& numerator_error, double q_error,
                                 const Extent& reciprocal, const Extent& fourth) noexcept {
    constexpr double middle_roundings = 2.001 * unit_roundoff_float;
    const Extent step_roundings = fourth * (24.0 * unit_roundoff_float) + 6.4 * unit_roundoff_float;
    constexpr double underflow = 0x1p-113;
    return u * middle_roundings + reach * step_roundings + underflow +
           ((u + reach) * q_error + numerator_error) * (reciprocal * 1.001);
}

// One rule in all lanes. Not a closure: behind a precompiled header GCC warns of one that only returns a vector.
TEXGEN_INLINE Doubles in_all_lanes(StepRule rule) noexcept { return Doubles{} + static_cast<double>(rule); }

// The coefficients of `count` chunks from the given one of row y on; none is shorter than a vector.
template <class CompiledWhereCalled = void>
void weigh_chunks(const TileJob& job, ChunkGroup& group, int chunks_of_row, int y, int chunk, int count) noexcept {
    const double width = job.width, length = job.chunk;
    const double per_row = chunks_of_row;
    const double rows_per_chunk = 1.0 / per_row;
    for (int i = 0; i < count; i += lanes) {
        // A half more keeps the quotient away from the integers.
        const Doubles number = indices<Doubles>() + static_cast<double>(chunk + i);
        const Doubles row = truncated((number + 0.5) * rows_per_chunk);
        const Doubles begin = (number - row * per_row) * length;
        const Doubles half = (minimum(begin + length, Doubles{} + width) - begin) * 0.5 - 0.5;
        const Doubles at_x = begin + half, at_y = row + static_cast<double>(y);
        const auto value = [&](double base, double dx, double dy) { return at_x * dx + (at_y * dy + base); };
        const Doubles q = value(job.q.base, job.q.dx, job.q.dy);
        const Doubles reciprocal = 1.0 / q;
        const Doubles bends = reciprocal * job.q.dx;
        store(&group.bend[i], to_floats(bends));
        Doubles u[2], d[2];
        for (std::size_t k = 0; k < 2; ++k) {
            const double dx = job.numerator.dx[k];
            u[k] = value(job.numerator.base[k], dx, job.numerator.dy[k]) * reciprocal;
            d[k] = (u[k] * -job.q.dx + dx) * reciprocal;
            store(&group.middle[k][i], to_floats(u[k]));
            store(&group.slope[k][i], to_floats(d[k]));
        }
        if (job.steps != StepRule::undecided) continue;
        const Doubles extents = magnitude(bends) * half;
        const Doubles stretch = (extents * 4.0 + 1.0) * extents + 1.0;
        Doubles reaches[2], room[2];
        const Doubles square = extents * extents, fourth = square * square;
        for (std::size_t k = 0; k < 2; ++k) {
            reaches[k] = magnitude(d[k]) * half * stretch;
            room[k] = job.tolerance - chunk_error(magnitude(u[k]), reaches[k], job.numerator_error[k], job.q_error,
                                                  reciprocal * stretch, fourth);
        }
        // The cheapest rule with which a chunk stays inside the tolerance.
        const auto fits = [&](const Doubles& share) {
            return at_most(share * reaches[0], room[0]) & at_most(share * reaches[1], room[1]);
        };
        Doubles rules = select(fits(fourth * fourth), in_all_lanes(StepRule::degree8), in_all_lanes(StepRule::divide));
        rules = select(fits(fourth), in_all_lanes(StepRule::degree4), rules);
        rules = select(at_most(extents, Doubles{} + 0.25), rules, in_all_lanes(StepRule::divide));
        const LongWords holds = at_most(extents, Doubles{} + 0.75) & greater(q - q * extents, job.least_q);
        store(&group.rule[i], to_floats(select(holds & fits(Doubles{}), rules, in_all_lanes(StepRule::none))));
    }
}

// Fills the group's chunks from `first` to `end`, which have one rule and begin at x of the row, and their mask.
template <class CompiledWhereCalled = void>
void fill_chunks(const TileJob& job, const RowOutputs& row, ChunkGroup& group, int first, int end, int x) noexcept {
    const StepRule rule = group.rule_of(job, first);
    const int length = job.length_of_chunk(x);
    // Outputs that the first cache does not hold are stored by whole lines. Vectors of 64 bytes fill a chunk in order.
    // Shorter ones would take longer so: they fill it from both ends, and only the stores in front begin with lines, from
    // the second on (chunks have room for one more); beyond 2^21 floats, which no cache holds, those of 32 bytes go in
    // order, too.
    constexpr bool are_long = wide_lanes == TileJob::longest_vector, are_shortest = wide_lanes == 4;
    static_assert(are_long || 2 * wide_lanes <= TileJob::longest_vector);
    const bool is_in_order = !are_shortest && job.is_beyond(are_long ? floats_in_first_cache : 1 << 21);
    const bool has_lines_in_front = !are_long && job.is_beyond(floats_in_first_cache);
    const std::ptrdiff_t reach = is_in_order ? length : (length + 1) / 2;
    if (length != group.indexed) {
        group.indexed = length;
        const WideFloats first_index = indices<WideFloats>() - 0.5f * static_cast<float>(length - 1);
        for (int i = 0; i < reach + wide_lanes; i += wide_lanes)
            store(group.index + i, first_index + static_cast<float>(i));
    }
    std::int64_t begin = x;
    for (std::ptrdiff_t i = first; i < end; ++i, begin += length) {
        const WideFloats bend = group.bend[i] - WideFloats{};
        const WideFloats middle[2] = {group.middle[0][i] - WideFloats{}, group.middle[1][i] - WideFloats{}};
        const WideFloats slope[2] = {group.slope[0][i] - WideFloats{}, group.slope[1][i] - WideFloats{}};
        float* const s = row.out[0] + begin;
        float* const t = row.out[1] + begin;
        std::ptrdiff_t last = length - wide_lanes, to_next = wide_lanes;
        if (has_lines_in_front) [[unlikely]]
            to_next = next_in_line<WideFloats>(s, 0, wide_lanes);
        // From both ends, where the last vectors may overlap in the middle; or in order. The bits are the same. Indices
        // are loaded, which costs nothing here.
        for (std::ptrdiff_t at = 0; at < reach;) {
            const auto from_middle = load<WideFloats>(group.index + at);
            const WideFloats bent = from_middle * bend, square = bent * bent;
            WideFloats mean;
            if (rule == StepRule::divide) {
                mean = from_middle / (1.0f - square);
            } else {
                mean = from_middle + from_middle * square;
                if (rule == StepRule::degree8) mean = mean + mean * (square * square);
            }
            const WideFloats step = mean - mean * bent;
            store(s + at, step * slope[0] + middle[0]);
            store(t + at, step * slope[1] + middle[1]);
            if (is_in_order) [[unlikely]] {
                if (at == last) break;
                at = next_in_line<WideFloats>(s, at, last);
                continue;
            }
            const WideFloats step_back = reversed(mean + mean * bent);
            store(s + last, middle[0] - step_back * slope[0]);
            store(t + last, middle[1] - step_back * slope[1]);
            at += to_next;
            last -= to_next;
            to_next = wide_lanes;
        }
    }
    light(job, row, x, begin);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
