// The inner loops of a tile under a tolerance: chunks of its rows about their middle. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// About the middle of a chunk of a row, i fragments from it, F/Q is exactly
//   u + d i / (1 + x),  u = F/Q and d = (F_x - u Q_x) / Q in the middle,  x = b i, b = Q_x / Q in the middle,
// and 1 / (1 + x) = (1 - x) (1 + x^2) (1 + x^4) ..., which has a relative error of x^(2^n) after n factors: a parabola and
// on, until a division is cheaper. (A line saves nothing beside the stores.)
//
// With h the largest |i|, X = |b| h <= 3/4 and S = 1 + X + 4 X^2 >= 1/(1 - X), no step |d i / (1 + x)| is above
// D = h |d| S. In float, with r = 2^-24, the roundings of b and of x change 1/(1 + x) by at most 2 r X/(1 - X), which is 6 r
// where there is a division (its sum and quotient add 2 r), and 1 r where X <= 1/4 and there are factors (whose products
// and sums add 3.5 r); d and its product add 2 r. Less than 11 r D, and the roundings of u and of the last sum,
// 2 r |u| + r D. Subnormals, or what is flushed to zero, add less than 2^-116; the doubles (e_F + (|u| + D) e_Q) / Q.
// As names: bend is b, extent X, reach D; room is what a chunk leaves of the tolerance for the remainder of its factors,
// x^(2^n) D.

// The rest of a chunk's error, of s or of t, or of both: u, reach and 1 / Q at their largest.
template <class Number, class Error, class Reciprocal>
TEXGEN_INLINE Number chunk_error(const Number& u, const Number& reach, const Error& numerator_error, double q_error,
                                 const Reciprocal& reciprocal) noexcept {
    constexpr double middle_roundings = 2.001 * unit_roundoff_float;
    constexpr double step_roundings = 12.004 * unit_roundoff_float;
    constexpr double underflow = 0x1p-115;
    return u * middle_roundings + reach * step_roundings + underflow +
           ((u + reach) * q_error + numerator_error) * (reciprocal * 1.001);
}

TEXGEN_INLINE int chunks_of_row(const TileJob& job) noexcept { return (job.width - 1) / job.chunk + 1; }

// Chunks that follow one another, over the ends of rows too: their coefficients, and where they are not chosen for all of
// the job, what their certificates need.
struct ChunkGroup {
    static constexpr int size = 16;

    float bend[size];
    float middle[2][size], slope[2][size];
    float rule[size];

    // Of `count` chunks from the given one of row y on.
    TEXGEN_INLINE void fill(const TileJob& job, int y, int chunk, int count) noexcept {
        const double width = job.width;
        const double length = job.chunk;
        const double per_row = chunks_of_row(job);
        const double rows_per_chunk = 1.0 / per_row;
        for (int i = 0; i < count; i += lanes) {
            // Half of one more keeps the quotient away from the integers.
            const Doubles number = indices<Doubles>() + static_cast<double>(chunk + i);
            const Doubles row = truncated((number + 0.5) * rows_per_chunk);
            const Doubles begin = (number - row * per_row) * length;
            const Doubles half = (minimum(begin + length, Doubles{} + width) - begin) * 0.5 - 0.5;
            const Doubles at_x = begin + half;
            const Doubles at_y = row + static_cast<double>(y);
            const auto value = [&](const Ramp& ramp) { return at_x * ramp.dx + (at_y * ramp.dy + ramp.base); };
            const Doubles q = value(job.q);
            const Doubles reciprocal = 1.0 / q;
            const Doubles bends = reciprocal * job.q.dx;
            store(&bend[i], to_floats(bends));
            const Doubles extents = magnitude(bends) * half;
            const Doubles stretch = (extents * 4.0 + 1.0) * extents + 1.0;
            Doubles reaches[2], room[2];
            for (std::size_t k = 0; k < 2; ++k) {
                const Doubles u = value(job.numerator[k]) * reciprocal;
                const Doubles d = (u * -job.q.dx + job.numerator[k].dx) * reciprocal;
                store(&middle[k][i], to_floats(u));
                store(&slope[k][i], to_floats(d));
                reaches[k] = magnitude(d) * half * stretch;
                room[k] = job.tolerance - chunk_error(magnitude(u), reaches[k], job.numerator_error[k], job.q_error,
                                                      reciprocal * stretch);
            }
            if (job.steps != StepRule::undecided) continue;
            // The cheapest rule with which a chunk stays inside the tolerance.
            const auto all = [](StepRule rule_of_all) { return Doubles{} + static_cast<double>(rule_of_all); };
            const auto fits = [&](const Doubles& share) {
                return at_most(share * reaches[0], room[0]) & at_most(share * reaches[1], room[1]);
            };
            const Doubles square = extents * extents;
            const Doubles fourth = square * square;
            Doubles rules = select(fits(fourth * fourth), all(StepRule::degree8), all(StepRule::divide));
            rules = select(fits(fourth), all(StepRule::degree4), rules);
            rules = select(fits(square), all(StepRule::degree2), rules);
            rules = select(at_most(extents, Doubles{} + 0.25), rules, all(StepRule::divide));
            const LongWords holds = at_most(extents, Doubles{} + 0.75) & greater(q - q * extents, job.least_q);
            store(&rule[i], to_floats(select(holds & fits(Doubles{}), rules, all(StepRule::none))));
        }
    }

    TEXGEN_INLINE StepRule rule_of(const TileJob& job, int i) const noexcept {
        return job.steps == StepRule::undecided ? static_cast<StepRule>(static_cast<int>(rule[i])) : job.steps;
    }
};

// i / (1 + i bend).
template <StepRule Rule>
TEXGEN_INLINE WideFloats bent(const WideFloats& i, const WideFloats& bend) noexcept {
    WideFloats x = i * bend;
    if constexpr (Rule == StepRule::divide) return i / (x + 1.0f);
    WideFloats result = i - i * x;
    for (int n = static_cast<int>(StepRule::degree2); n < static_cast<int>(Rule); ++n) {
        x = x * x;
        result = result + result * x;
    }
    return result;
}

// A chunk of a row, counted from the left.
struct ChunkPlace {
    int chunk, y;
    int per_row;

    TEXGEN_INLINE bool advance() noexcept {
        const bool is_last = ++chunk == per_row;
        chunk = is_last ? 0 : chunk;
        y += is_last ? 1 : 0;
        return is_last;
    }
};

// `count` fragments of the group's chunk i, in whole vectors. The indices are loaded, as that is what arithmetic leaves idle.
template <StepRule Rule>
TEXGEN_INLINE void fill_vectors(const ChunkGroup& group, int i, const float* index, float* s, float* t,
                                int count) noexcept {
    const WideFloats bend = WideFloats{} + group.bend[i];
    const WideFloats middle[2] = {WideFloats{} + group.middle[0][i], WideFloats{} + group.middle[1][i]};
    const WideFloats slope[2] = {WideFloats{} + group.slope[0][i], WideFloats{} + group.slope[1][i]};
    for (std::ptrdiff_t x = 0; x < count; x += wide_lanes) {
        const WideFloats step = bent<Rule>(load<WideFloats>(index + x), bend);
        store(s + x, step * slope[0] + middle[0]);
        store(t + x, step * slope[1] + middle[1]);
    }
}

template <class CompiledWhereCalled = void>
TEXGEN_APART void fill_vectors(StepRule rule, const ChunkGroup& group, int i, const float* index, float* s, float* t,
                               int count) noexcept {
    switch (rule) {
        case StepRule::degree2:
            return fill_vectors<StepRule::degree2>(group, i, index, s, t, count);
        case StepRule::degree4:
            return fill_vectors<StepRule::degree4>(group, i, index, s, t, count);
        case StepRule::degree8:
            return fill_vectors<StepRule::degree8>(group, i, index, s, t, count);
        default:
            return fill_vectors<StepRule::divide>(group, i, index, s, t, count);
    }
}

// Does the job from `first` on. Stops at chunks that no rule serves and returns them, a part of one row or whole rows;
// the empty unit if there are none. The next call starts after them.
template <class CompiledWhereCalled = void>
TileJob::Unit fill_tile_polynomial(const TileJob& job, TileJob::Unit first) noexcept {
    const int width = job.width, height = job.height;
    const int longest = job.chunk;
    ChunkPlace place{first.x_begin / longest, first.y_begin, chunks_of_row(job)};
    ChunkGroup group;
    RowOutputs row(job, place.y);
    alignas(WideFloats) float index[longest_chunk];
    int indexed = 0;
    while (place.y < height) {
        const std::int64_t left = static_cast<std::int64_t>(height - place.y) * place.per_row - place.chunk;
        const int count = left < group.size ? static_cast<int>(left) : group.size;
        group.fill(job, place.y, place.chunk, count);
        for (int i = 0; i < count; ++i) {
            const StepRule rule = group.rule_of(job, i);
            const int begin = place.chunk * longest;
            if (rule == StepRule::none) {
                int last = i + 1;
                while (last < count && group.rule_of(job, last) == rule) ++last;
                if (place.per_row == 1) return {0, width, place.y, place.y + (last - i)};
                const int in_row = place.chunk + (last - i) < place.per_row ? place.chunk + (last - i) : place.per_row;
                return {begin, in_row < place.per_row ? in_row * longest : width, place.y, place.y + 1};
            }
            const int length = longest < width - begin ? longest : width - begin;
            if (length != indexed) {
                indexed = length;
                const WideFloats first_index = indices<WideFloats>() - 0.5f * static_cast<float>(length - 1);
                for (int x = 0; x < length; x += wide_lanes) store(index + x, first_index + static_cast<float>(x));
            }
            // What a last vector writes beyond the chunk is written again by those that follow, where it may be written.
            const int rest = (length - 1) % wide_lanes + 1;
            const int whole = std::int64_t{begin} + length + wide_lanes - rest > row.writable ? length - rest : length;
            float* const to[2] = {row.out[0] + begin, row.out[1] + begin};
            fill_vectors(rule, group, i, index, to[0], to[1], whole);
            if (whole != length) {
                float buffer[2][wide_lanes];
                fill_vectors(rule, group, i, index + whole, buffer[0], buffer[1], rest);
                for (int j = 0; j < rest; ++j)
                    for (std::size_t k = 0; k < 2; ++k) to[k][whole + j] = buffer[k][j];
            }
            light(job, row, begin, static_cast<std::int64_t>(begin) + length);
            if (place.advance()) row.advance();
        }
    }
    return {0, 0, height, height};
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
