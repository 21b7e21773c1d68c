// The inner loops. Included by lanes.hpp once per instruction set, inside that set's target region, so that one source
// serves all of them. A kernel gets plain numbers; the only decision it makes is how a chunk of a row is divided.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// Where a row of a TileJob goes. Where there is a mask, the numerators are s and t. A copy, so that the compiler knows that
// no store changes it.
template <std::size_t Numerators>
struct RowOutputs {
    float* out[Numerators];
    std::ptrdiff_t pitch[Numerators];
    float* lit;
    std::ptrdiff_t lit_pitch;
    float min[2], max[2];
    std::int64_t writable;  // from its first fragment on: where rows follow one another, the rows below too
    std::int64_t writable_pitch;

    TEXGEN_INLINE RowOutputs(const TileJob& job, int y) noexcept
        : lit(job.lit == nullptr ? nullptr : job.lit + y * job.pitch),
          lit_pitch(job.lit == nullptr ? 0 : job.pitch),
          min{job.min[0], job.min[1]},
          max{job.max[0], job.max[1]},
          writable(job.is_contiguous ? (job.height - std::int64_t{y}) * job.width : job.width),
          writable_pitch(job.is_contiguous ? job.width : 0) {
        for (std::size_t k = 0; k < Numerators; ++k) {
            pitch[k] = job.is_scratch[k] ? 0 : job.pitch;
            out[k] = job.out[k] + y * pitch[k];
        }
    }

    TEXGEN_INLINE void advance() noexcept {
        for (std::size_t k = 0; k < Numerators; ++k) out[k] += pitch[k];
        lit += lit_pitch;
        writable -= writable_pitch;
    }
};

// The functions of the row's index.
template <std::size_t Numerators>
struct TileRow : RowOutputs<Numerators> {
    double base[Numerators];
    double q;

    TEXGEN_INLINE TileRow(const TileJob& job, int y) noexcept
        : RowOutputs<Numerators>(job, y), q(job.q.base + y * job.q.dy) {
        for (std::size_t k = 0; k < Numerators; ++k) base[k] = job.numerator[k].base + y * job.numerator[k].dy;
    }
};

// Whether a mask is asked for, the layout of points and that of their coordinates are looked at vector by vector: a branch
// that is always the same costs next to nothing, and a loop for each combination would be most of what a user compiles.

// Stores one vector of coordinates from out[k] + x on, and its mask from lit + x on: inside the region and in front.
template <std::size_t Numerators, class Vector, class Mask>
TEXGEN_INLINE void store_all(const RowOutputs<Numerators>& row, std::int64_t x, const Vector (&value)[Numerators],
                             const Mask& in_front) noexcept {
    for (std::size_t k = 0; k < Numerators; ++k) store(row.out[k] + x, value[k]);
    if constexpr (Numerators == 2)
        if (row.lit != nullptr)
            store(row.lit + x, one_where(in_front & inside(value[0], row.min[0], row.max[0]) &
                                         inside(value[1], row.min[1], row.max[1])));
}

// A whole vector where it may be written, else up to `end`.
template <std::size_t Numerators, class Vector, class Mask>
TEXGEN_INLINE void store_from(const RowOutputs<Numerators>& row, std::int64_t x, std::int64_t end,
                              const Vector (&value)[Numerators], const Mask& in_front) noexcept {
    constexpr std::size_t size = sizeof(Vector) / sizeof(float);
    if (x + static_cast<std::int64_t>(size) <= row.writable) return store_all(row, x, value, in_front);
    float buffer[Numerators + 1][size]{};
    RowOutputs<Numerators> buffered = row;
    for (std::size_t k = 0; k < Numerators; ++k) buffered.out[k] = buffer[k];
    if (row.lit != nullptr) buffered.lit = buffer[Numerators];
    store_all(buffered, 0, value, in_front);
    for (std::size_t i = 0; i < size && x < end; ++i, ++x) {
        for (std::size_t k = 0; k < Numerators; ++k) row.out[k][x] = buffer[k][i];
        if (row.lit != nullptr) row.lit[x] = buffer[Numerators][i];
    }
}

// ---- Division in double ----------------------------------------------------------------------------------------

// One vector of quotients from `index` on. With Nearest, marks in `doubtful` where value - error and value + error do
// not round to one float; else numerators and q are rounded to float and divided there.
template <bool Nearest, std::size_t Numerators>
TEXGEN_INLINE void divide_vector(const TileJob& job, const TileRow<Numerators>& row, const Doubles& index,
                                 Doubles& reciprocal, Floats (&quotient)[Numerators], Words& doubtful) noexcept {
    if constexpr (Nearest) {
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
template <bool Nearest, std::size_t Numerators>
TEXGEN_INLINE TileJob::Unit divide_units(const TileJob& job, TileJob::Unit unit) noexcept {
    Doubles reciprocal = Doubles{} + 1.0 / job.q.base;
    for (; !job.is_done(unit); unit = job.unit_after(unit)) {
        Words doubtful{};
        for (int y = unit.y_begin; y < unit.y_end; ++y) {
            const TileRow<Numerators> row(job, y);
            Doubles index = indices<Doubles>() + static_cast<double>(unit.x_begin);
            Floats quotient[Numerators];
            std::int64_t x = unit.x_begin;  // what follows the last vector may be no int
            const std::int64_t last = row.writable - lanes;
            for (; x < unit.x_end && x <= last; x += lanes, index += static_cast<double>(lanes)) {
                divide_vector<Nearest>(job, row, index, reciprocal, quotient, doubtful);
                store_all(row, x, quotient, ~Words{});
            }
            if (x >= unit.x_end) continue;
            divide_vector<Nearest>(job, row, index, reciprocal, quotient, doubtful);
            store_from(row, x, unit.x_end, quotient, ~Words{});
        }
        if (Nearest && any(doubtful)) break;
    }
    return unit;
}

template <class = void>
TileJob::Unit divide_nearest(const TileJob& job, TileJob::Unit first) noexcept {
    return job.numerators == 2 ? divide_units<true, 2>(job, first) : divide_units<true, 1>(job, first);
}

template <class = void>
void divide_rounded(const TileJob& job) noexcept {
    divide_units<false, 2>(job, job.unit_at(0, 0));
}

// ---- Division to twice the precision of double --------------------------------------------------------------------

// A function of a row's index.
struct CloseRow {
    Doubles high, high_dx, low, low_dx, error;
    double least;  // a value below it is 0

    TEXGEN_INLINE explicit CloseRow(const CloseFunction& function) noexcept
        : high{},
          high_dx(Doubles{} + function.high.dx),
          low{},
          low_dx(Doubles{} + function.low.dx),
          error(Doubles{} + 1.01 * function.error),
          least(function.grain > 4.0 * function.error ? 0.5 * function.grain : 0.0) {}

    TEXGEN_INLINE void move_to(const CloseFunction& function, int y) noexcept {
        high = Doubles{} + (function.high.base + y * function.high.dy);
        low = Doubles{} + (function.low.base + y * function.low.dy);
    }
};

// A vector of q, and what its quotients share. In what is left of a quotient, F - m Q, m is the middle of two floats, which
// has 25 bits: with half of the high part of Q in two parts of 26 bits the products with 2 m are exact.
struct CloseQ {
    Doubles upper, lower, low, reciprocal, relative_error;
    LongWords in_front, doubt;

    TEXGEN_INLINE CloseQ(const CloseRow& row, double unit, const Doubles& index) noexcept {
        const Doubles high = index * row.high_dx + row.high;
        const Doubles rest = index * row.low_dx + row.low;
        const Doubles q = high + rest;
        in_front = greater(q, row.error * 256.0);
        doubt = ~(in_front | greater(q * -1.0, row.error) | greater(row.least - magnitude(q), 0.0));
        reciprocal = where(in_front, 1.0 / q);
        relative_error = reciprocal * row.error + 0x1p-50;
        upper = (high + unit) - unit;
        lower = (high - upper) * 0.5;
        upper = upper * 0.5;
        low = rest * 0.5;
    }
};

// The quotients of a vector, 0 behind. Where value - error and value + error do not round to one float but to neighbours, the
// sign of F - m Q decides. That is a multiple of the grain of its terms: what is certainly smaller is 0, and the tie is certain,
// too. Returns the lanes that stay in doubt.
TEXGEN_INLINE Words divide_closely(const CloseRow& row, double grain, const CloseQ& q, const Doubles& half_q_error,
                                   double middle_grain, const Doubles& index, Floats& value) noexcept {
    const Doubles high = index * row.high_dx + row.high;
    const Doubles low = index * row.low_dx + row.low;
    const Doubles sum = high + low;
    const Doubles quotient = where(q.in_front, sum * q.reciprocal);  // no -0 behind
    const Doubles error = magnitude(quotient) * q.relative_error + q.reciprocal * row.error;
    const Floats below = to_floats(quotient - error);
    const Floats above = to_floats(quotient + error);
    value = below;
    const Words differ = bits(below) ^ bits(above);
    if (!any(differ)) return Words{};
    const Doubles middle = to_doubles(below) + to_doubles(above);  // twice it
    const Doubles product = middle * q.upper;
    const Doubles rest = high - product;
    const Doubles taken = rest - high;
    const Doubles lost = (high - (rest - taken)) - (product + taken);
    const Doubles remainder = (rest - middle * q.lower) + (lost + (low - middle * q.low));
    const Doubles unit = power_of_two_below(middle);
    const Doubles bound = magnitude(middle) * half_q_error + row.error;
    const LongWords is_open = greater(magnitude(remainder), bound);
    const LongWords is_tie = greater(minimum(unit * middle_grain, Doubles{} + grain), bound * 4.0);
    // A step from the middle that is less than half of what the floats are away.
    const Doubles step = where(is_open, with_sign_of(unit * 0x1p-26, remainder));
    const Floats nearest = to_floats((middle + step) * 0.5);
    const Words decided = narrow(is_open | is_tie) & equal((bits(above) - bits(below) + 1) & ~2, 0) &
                          ~equal(bits(below) & bits(above) & 0x7f800000, 0);
    value = select(decided, nearest, below);
    const Words doubt = ~(decided | equal(differ, 0));
    if (!any(doubt)) return doubt;
    const Words is_zero = narrow(greater(row.least - magnitude(sum), 0.0) & q.in_front) & doubt;
    value = select(is_zero, Floats{}, value);
    return doubt & ~is_zero;
}

// One numerator stands in both places.
template <class = void>
std::uint64_t divide_closely(const TileJob& job, const CloseFunctions& functions, TileJob::Unit unit) noexcept {
    const CloseFunctions close = functions;
    CloseRow q_row(close.q);
    CloseRow numerator[2] = {CloseRow(close.numerator[0]), CloseRow(close.numerator[1])};
    RowOutputs<2> row(job, unit.y_begin);
    const Doubles half_q_error = q_row.error * 0.5;
    const double middle_grain = 0x1p-25 * close.q.grain;
    std::uint64_t doubtful = 0;
    int shift = 0;
    for (int y = unit.y_begin; y < unit.y_end; ++y, row.advance()) {
        q_row.move_to(close.q, y);
        for (std::size_t k = 0; k < 2; ++k) numerator[k].move_to(close.numerator[k], y);
        for (std::int64_t x = unit.x_begin; x < unit.x_end; x += lanes) {
            const Doubles index = indices<Doubles>() + static_cast<double>(x);
            const CloseQ q(q_row, close.q_unit, index);
            Floats value[2];
            Words doubt = narrow(q.doubt);
            for (std::size_t k = 0; k < 2; ++k)
                doubt |= divide_closely(numerator[k], close.numerator[k].grain, q, half_q_error, middle_grain, index,
                                        value[k]);
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

// ---- Chunks ----------------------------------------------------------------------------------------------------

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
inline constexpr int divided = 4, refused = 5;

TEXGEN_INLINE int chunks_of_row(const TileJob& job) noexcept { return (job.width - 1) / job.chunk + 1; }

// Chunks that follow one another, over the ends of rows too: their coefficients, and where they are not chosen for all of
// the job, what their certificates need.
struct ChunkGroup {
    static constexpr int size = 16;

    float bend[size];
    float middle[2][size], slope[2][size];
    double extent[size], least_q[size];    // X, and what the least q has above job.least_q
    double reach[2][size], room[2][size];  // D, and what is left of the tolerance for x^(2^n) D

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
            if (job.factors == TileJob::any_factors) {
                store(&extent[i], extents);
                store(&least_q[i], (q - q * extents) - job.least_q);
            }
            for (std::size_t k = 0; k < 2; ++k) {
                const Doubles u = value(job.numerator[k]) * reciprocal;
                const Doubles d = (u * -job.q.dx + job.numerator[k].dx) * reciprocal;
                store(&middle[k][i], to_floats(u));
                store(&slope[k][i], to_floats(d));
                if (job.factors != TileJob::any_factors) continue;
                const Doubles size_of_u = magnitude(u);
                const Doubles size_of_step = magnitude(d) * half * stretch;
                store(&reach[k][i], size_of_step);
                store(&room[k][i], (job.tolerance - chunk_underflow) -
                                       (size_of_u * chunk_middle_error + size_of_step * chunk_step_error) -
                                       ((size_of_u + size_of_step) * job.q_error + job.numerator_error[k]) *
                                           (reciprocal * stretch) * 1.001);
            }
        }
    }

    // The fewest factors with which chunk i stays inside the tolerance.
    TEXGEN_INLINE int factors(int i) const noexcept {
        const auto fits = [&](double error) {
            bool all = true;
            for (std::size_t k = 0; k < 2; ++k) all = all && error * reach[k][i] <= room[k][i];
            return all;
        };
        if (!(extent[i] <= 0.75 && least_q[i] > 0.0 && fits(0.0))) return refused;
        if (!(extent[i] <= 0.25)) return divided;
        double error = extent[i];
        for (int n = 1; n < divided; ++n) {
            error *= error;
            if (fits(error)) return n;
        }
        return divided;
    }
};

// i / (1 + i bend), to so many factors.
template <int Factors>
TEXGEN_INLINE WideFloats bent(const WideFloats& i, const WideFloats& bend) noexcept {
    WideFloats x = i * bend;
    if constexpr (Factors == divided) return i / (x + 1.0f);
    WideFloats result = i - i * x;
    for (int n = 1; n < Factors; ++n) {
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

// Chunks first to last of the group.
template <int Factors>
TEXGEN_INLINE void evaluate(const ChunkGroup& group, int first, int last, const TileJob& job,
                            ChunkPlace& place) noexcept {
    const int width = job.width;
    const int longest = job.chunk;
    RowOutputs<2> row(job, place.y);
    int length = 0;
    WideFloats first_index{};
    for (int i = first; i < last; ++i) {
        const int begin = place.chunk * longest;
        const int end = longest < width - begin ? begin + longest : width;
        if (end - begin != length) {
            length = end - begin;
            first_index = indices<WideFloats>() - 0.5f * static_cast<float>(length - 1);
        }
        const WideFloats bend = WideFloats{} + group.bend[i];
        WideFloats middle[2], slope[2];
        for (std::size_t k = 0; k < 2; ++k) {
            middle[k] = WideFloats{} + group.middle[k][i];
            slope[k] = WideFloats{} + group.slope[k][i];
        }
        // By turns, so that the next index does not wait for this one.
        WideFloats index = first_index;
        WideFloats next_index = index + static_cast<float>(wide_lanes);
        for (std::int64_t x = begin; x < end; x += wide_lanes) {
            const WideFloats step = bent<Factors>(index, bend);
            WideFloats value[2];
            for (std::size_t k = 0; k < 2; ++k) value[k] = step * slope[k] + middle[k];
            // What a last vector writes beyond the chunk is written again by those that follow.
            store_from(row, x, end, value, ~WideWords{});
            const WideFloats after_next = index + static_cast<float>(2 * wide_lanes);
            index = next_index;
            next_index = after_next;
        }
        if (place.advance()) row.advance();
    }
}

// Does the job from `first` on. Stops at chunks that no factors serve and returns them, a part of one row or whole rows;
// the empty unit if there are none. The next call starts after them.
template <class = void>
TileJob::Unit divide_chunks(const TileJob& job, TileJob::Unit first) noexcept {
    ChunkPlace place{first.x_begin / job.chunk, first.y_begin, chunks_of_row(job)};
    ChunkGroup group;
    const int height = job.height;
    while (place.y < height) {
        const std::int64_t left = static_cast<std::int64_t>(height - place.y) * place.per_row - place.chunk;
        const int count = left < group.size ? static_cast<int>(left) : group.size;
        group.fill(job, place.y, place.chunk, count);
        for (int i = 0; i < count;) {
            // As many as the same factors serve.
            int factors = job.factors;
            int last = count;
            if (factors == TileJob::any_factors) {
                factors = group.factors(i);
                for (last = i + 1; last < count && group.factors(last) == factors;) ++last;
            }
            switch (factors) {
                case 1:
                    evaluate<1>(group, i, last, job, place);
                    break;
                case 2:
                    evaluate<2>(group, i, last, job, place);
                    break;
                case 3:
                    evaluate<3>(group, i, last, job, place);
                    break;
                case divided:
                    evaluate<divided>(group, i, last, job, place);
                    break;
                default: {
                    if (place.per_row == 1) return {0, job.width, place.y, place.y + (last - i)};
                    const int in_row =
                        place.chunk + (last - i) < place.per_row ? place.chunk + (last - i) : place.per_row;
                    const int end = in_row < place.per_row ? in_row * job.chunk : job.width;
                    return {place.chunk * job.chunk, end, place.y, place.y + 1};
                }
            }
            i = last;
        }
    }
    return {0, 0, height, height};
}

// ---- Points ----------------------------------------------------------------------------------------------------

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA

#include "twofold.inc.hpp"

namespace TEXGEN_DETAIL::TEXGEN_ISA {

template <class Vector, class Job>
TEXGEN_INLINE void load_points(const Job& job, std::size_t i, Vector& x, Vector& y, Vector& z) noexcept {
    if (job.triples) {
        load_triples(job.x + 3 * i, x, y, z);
    } else {
        x = load<Vector>(job.x + i);
        y = load<Vector>(job.y + i);
        z = load<Vector>(job.z + i);
    }
}

// Stores a vector of results from index i on, and their mask: inside the region and in front.
template <std::size_t Numerators, class Vector, class Mask>
TEXGEN_INLINE void store_points(const DividedOutput& output, std::size_t i, const Vector (&value)[Numerators],
                                const Mask& in_front) noexcept {
    if constexpr (Numerators == 2) {
        if (output.lit != nullptr)
            store(output.lit + i, one_where(in_front & inside(value[0], output.min[0], output.max[0]) &
                                            inside(value[1], output.min[1], output.max[1])));
        if (output.pairs) return store_pairs(output.out[0] + 2 * i, value[0], value[1]);
    }
    for (std::size_t k = 0; k < Numerators; ++k) store(output.out[k] + i, value[k]);
}

// Lanes that cannot be vouched for: where value - error and value + error do not round to one float, and where it is not
// certain on which side of the projector the point is.
struct Doubt {
    Words rounding{};
    LongWords side{};
    LongWords behind{};  // no doubt, but no ordinary points

    TEXGEN_INLINE bool any_lane() const noexcept { return any(rounding | narrow(side)); }
};

// numerator[k] / q with these errors, of all or of each lane; the error of the quotient is that of certain_quotient(). With
// Signed, q has either sign, and lanes that are certainly behind give 0; else they are in doubt too; and in none where both
// floats are inside the tolerance. Returns the mask of the lanes in front.
template <bool Signed, std::size_t Numerators, class Error>
TEXGEN_INLINE LongWords divide_certainly(const Doubles (&numerator)[Numerators],
                                         const Error (&numerator_error)[Numerators], const Doubles& q,
                                         const Error& q_error, double tolerance, Floats (&value)[Numerators],
                                         Doubt& doubt) noexcept {
    const LongWords in_front = greater(q - 0x1p20 * q_error, 0.0);
    Doubles reciprocal = 1.0 / q;
    if constexpr (Signed) {
        doubt.behind |= ~in_front;
        doubt.side |= ~(in_front | greater(-1.0 * q - q_error, 0.0));
        reciprocal = where(in_front, reciprocal);
    } else {
        doubt.side |= ~in_front;
    }
    const Doubles relative_error = reciprocal * (q_error * 1.001) + 4.0 * unit_roundoff_double;
    for (std::size_t k = 0; k < Numerators; ++k) {
        Doubles quotient = numerator[k] * reciprocal;
        if constexpr (Signed) quotient = where(in_front, quotient);
        Doubles error = magnitude(quotient) * relative_error + reciprocal * (numerator_error[k] * 1.001);
        if constexpr (Signed) error = where(in_front, error);  // of a numerator that is no number
        value[k] = to_floats(quotient - error);
        const Floats other = to_floats(quotient + error);
        Words differ = bits(value[k]) ^ bits(other);
        if constexpr (Signed) {
            if (tolerance > 0.0 && any(differ)) {
                const Words is_within =
                    narrow(at_most((to_doubles(other) - to_doubles(value[k])) * 2.0, Doubles{} + tolerance));
                value[k] = select(is_within, to_floats(quotient), value[k]);
                differ &= ~is_within;
            }
        }
        doubt.rounding |= differ;
    }
    return in_front;
}

// What doing a block again leaves.
struct Again {
    std::uint64_t doubtful;  // bit i: value begin + i
    bool is_ordinary;        // all in front, and nothing in doubt
    bool is_in_doubt;        // the last vector
};

// Does a block again: for both signs of q and with errors of each lane; a vector that those leave in doubt, and up to 15
// that follow it, in two doubles. Terms are the sums at a vector of values: q and the numerators, nearly and in two doubles,
// and which lanes are behind whatever their q, being no numbers.
template <std::size_t Numerators, class Terms>
TEXGEN_INLINE Again divide_block_again(const DividedOutput& output, const Terms& terms, std::size_t begin,
                                       std::size_t end, bool is_in_doubt) noexcept {
    Again again{0, true, is_in_doubt};
    bool are_ties = false;  // the last vector, or next to ties
    for (std::size_t i = begin; i < end; i += static_cast<std::size_t>(lanes)) {
        const auto at = terms.load(i);
        const LongWords are_dark = terms.are_dark(at);
        Floats value[Numerators];
        if (!again.is_in_doubt || i / static_cast<std::size_t>(lanes) % 16 == 0) {
            Doubles numerator[Numerators], numerator_error[Numerators];
            for (std::size_t k = 0; k < Numerators; ++k) {
                numerator[k] = terms.numerator[k].nearly_at(at);
                numerator_error[k] = terms.numerator[k].error_at(at);
            }
            Doubt doubt;
            const LongWords in_front = divide_certainly<true>(numerator, numerator_error, terms.q.nearly_at(at),
                                                              terms.q.error_at(at), terms.tolerance(), value, doubt);
            are_ties = false;
            again.is_in_doubt = any(doubt.rounding | narrow(doubt.side & ~are_dark));
            if (!again.is_in_doubt) {
                again.is_ordinary = again.is_ordinary && !any(~in_front);
                store_points(output, i, value, narrow(in_front));
                continue;
            }
        }
        again.is_ordinary = false;
        const TwofoldDivisor q(terms.q.at(at));
        LongWords is_known = q.is_known | are_dark;
        for (std::size_t k = 0; k < Numerators; ++k) {
            if (!are_ties)
                are_ties =
                    !divide_nearly(terms.numerator[k].nearly_at(at), terms.numerator[k].error_at(at), q, value[k]);
            if (!are_ties) continue;
            if (terms.numerator[k].is_finite)
                value[k] = nearest_quotients(terms.numerator[k].at(at), q, terms.tolerance(), is_known);
            else
                value[k] = to_floats(where(q.in_front, terms.numerator[k].nearly_at(at) * q.reciprocal));
        }
        store_points(output, i, value, narrow(q.in_front));
        const Words doubt = narrow(~is_known);
        if (!any(doubt)) continue;
        for (int lane = 0; lane < lanes; ++lane)
            if (doubt[lane] != 0) again.doubtful |= std::uint64_t{1} << (i - begin + static_cast<std::size_t>(lane));
    }
    return again;
}

// The largest |x|, |y|, |z| of a block: of all three together for triples. A NaN is the largest.
struct PointExtent {
    double x, y, z;

    TEXGEN_INLINE PointExtent(const WideWords& x_bits, const WideWords& y_bits, const WideWords& z_bits) noexcept
        : x(static_cast<double>(bit_cast<float>(largest_lane(x_bits)))),
          y(static_cast<double>(bit_cast<float>(largest_lane(y_bits)))),
          z(static_cast<double>(bit_cast<float>(largest_lane(z_bits)))) {}

    TEXGEN_INLINE double magnitude_of(const PointForm& form) const noexcept {
        return std::fabs(form.x) * x + std::fabs(form.y) * y + std::fabs(form.z) * z + std::fabs(form.w);
    }
};

TEXGEN_INLINE PointExtent extent_of(const PointJob& job, std::size_t begin, std::size_t end) noexcept {
    WideWords x{};
    WideWords y{};
    WideWords z{};
    for (std::size_t i = begin; i < end; i += static_cast<std::size_t>(wide_lanes)) {
        const float* const from = job.x + 3 * i;
        x = maximum(magnitude_bits(load<WideFloats>(job.triples ? from : job.x + i)), x);
        y = maximum(magnitude_bits(load<WideFloats>(job.triples ? from + wide_lanes : job.y + i)), y);
        z = maximum(magnitude_bits(load<WideFloats>(job.triples ? from + 2 * wide_lanes : job.z + i)), z);
    }
    if (job.triples) x = y = z = maximum(maximum(x, y), z);
    return {x, y, z};
}

TEXGEN_INLINE Doubles at(const PointForm& form, const Doubles& x, const Doubles& y, const Doubles& z) noexcept {
    return x * form.x + (y * form.y + (z * form.z + form.w));
}

// A block of points, with errors that hold for all of it. Returns what is in doubt (it is written all the same).
template <bool Signed, std::size_t Numerators>
TEXGEN_INLINE Doubt divide_points_block(const PointJob& job, std::size_t begin, std::size_t end) noexcept {
    const PointExtent extent = extent_of(job, begin, end);
    double numerator_error[Numerators];
    for (std::size_t k = 0; k < Numerators; ++k) numerator_error[k] = gamma(5) * extent.magnitude_of(job.numerator[k]);
    const double q_error = gamma(5) * extent.magnitude_of(job.q);
    Doubt doubt;
    for (std::size_t i = begin; i < end; i += static_cast<std::size_t>(lanes)) {
        Floats xs, ys, zs;
        load_points(job, i, xs, ys, zs);
        const Doubles x = to_doubles(xs);
        const Doubles y = to_doubles(ys);
        const Doubles z = to_doubles(zs);
        Doubles numerator[Numerators];
        for (std::size_t k = 0; k < Numerators; ++k) numerator[k] = at(job.numerator[k], x, y, z);
        Floats value[Numerators];
        const LongWords in_front = divide_certainly<Signed>(numerator, numerator_error, at(job.q, x, y, z), q_error,
                                                            job.tolerance, value, doubt);
        store_points(job, i, value, narrow(in_front));
    }
    return doubt;
}

// The sums of points, for divide_block_again().
template <std::size_t Numerators>
struct PointTerms {
    const PointJob& job;
    TwofoldForm q;
    TwofoldForm numerator[Numerators];

    TEXGEN_INLINE double tolerance() const noexcept { return job.tolerance; }
    TEXGEN_INLINE explicit PointTerms(const PointJob& points) noexcept : job(points), q(points.q) {
        for (std::size_t k = 0; k < Numerators; ++k) numerator[k] = TwofoldForm(points.numerator[k]);
    }
    TEXGEN_INLINE PointLanes load(std::size_t i) const noexcept {
        Floats x, y, z;
        load_points(job, i, x, y, z);
        return {{to_doubles(x), to_doubles(y), to_doubles(z)}};
    }
    TEXGEN_INLINE LongWords are_dark(const PointLanes& at) const noexcept {
        const Doubles zero =
            (at.v[0] + at.v[1] + at.v[2]) * (q.is_finite ? 0.0 : std::numeric_limits<double>::quiet_NaN());
        return ~at_most(zero, zero);
    }
};

template <std::size_t Numerators>
TEXGEN_APART Again divide_points_again(const PointJob& job, std::size_t begin, std::size_t end,
                                       bool is_in_doubt) noexcept {
    if (!is_in_doubt) {
        const PointJob copy = job;
        const Doubt doubt = divide_points_block<true, Numerators>(copy, begin, end);
        if (!doubt.any_lane()) return {0, !any(doubt.behind), false};
    }
    return divide_block_again<Numerators>(job, PointTerms<Numerators>(job), begin, end, is_in_doubt);
}

// Most blocks are all in front and in no doubt; those that follow one that is not are taken for what it was. The job is
// copied, here and below, so that the compiler knows that no store changes it: nothing that the loop reads may be reached
// from elsewhere.
template <std::size_t Numerators>
TEXGEN_INLINE Undecided divide_points_nearest_of(const PointJob& original, std::size_t first) noexcept {
    const PointJob job = original;
    bool is_ordinary = true;
    bool is_in_doubt = false;
    for (std::size_t begin = first; begin < job.count;) {
        const std::size_t next = begin / nearest_block * nearest_block + nearest_block;
        const std::size_t end = next < job.count ? next : job.count;
        bool is_certain = false;
        if (is_ordinary) is_certain = !divide_points_block<false, Numerators>(job, begin, end).any_lane();
        if (!is_certain) {
            const Again again = divide_points_again<Numerators>(original, begin, end, is_in_doubt);
            is_in_doubt = again.is_in_doubt;
            if (again.doubtful != 0) return {begin, again.doubtful};
            is_ordinary = again.is_ordinary;
        }
        begin = end;
    }
    return {job.count, 0};
}

template <class = void>
Undecided divide_points_nearest(const PointJob& job, std::size_t first) noexcept {
    return job.numerators == 2 ? divide_points_nearest_of<2>(job, first) : divide_points_nearest_of<1>(job, first);
}

// The forms of q and of the numerators in float, in the order in which they are computed.
template <std::size_t Numerators>
struct FormsInFloat {
    float coefficient[1 + Numerators][4];

    TEXGEN_INLINE explicit FormsInFloat(const PointJob& job) noexcept {
        fill(coefficient[0], job.q);
        for (std::size_t k = 0; k < Numerators; ++k) fill(coefficient[1 + k], job.numerator[k]);
    }
    TEXGEN_INLINE WideFloats at(std::size_t k, const WideFloats& x, const WideFloats& y,
                                const WideFloats& z) const noexcept {
        const float(&c)[4] = coefficient[k];
        return x * c[0] + (y * c[1] + (z * c[2] + c[3]));
    }

private:
    TEXGEN_INLINE static void fill(float (&to)[4], const PointForm& form) noexcept {
        to[0] = static_cast<float>(form.x);
        to[1] = static_cast<float>(form.y);
        to[2] = static_cast<float>(form.z);
        to[3] = static_cast<float>(form.w);
    }
};

// The same in double, rounded once.
template <std::size_t Numerators>
struct FormsInDouble {
    const PointJob& job;

    TEXGEN_INLINE explicit FormsInDouble(const PointJob& points) noexcept : job(points) {}
    TEXGEN_INLINE WideFloats at(std::size_t k, const WideFloats& x, const WideFloats& y,
                                const WideFloats& z) const noexcept {
        const PointForm& form = k == 0 ? job.q : job.numerator[k - 1];
        const auto value = [&form](const Doubles& vx, const Doubles& vy, const Doubles& vz) {
            return detail::TEXGEN_ISA::at(form, vx, vy, vz);
        };
        return in_double(value, x, y, z);
    }
};

// Divided in float, in blocks of float_block points. The largest |v_j| bound the terms of the forms, and with the largest
// quotient and the least q, found on the way, the error of every point: see FloatDivision. Returns where the first block
// begins that is not inside the tolerance (it is written all the same), or the count. A NaN makes the largest quotient
// one, and fails.
template <template <std::size_t> class Forms, std::size_t Numerators>
TEXGEN_INLINE std::size_t divide_points_within_of(const PointJob& job, std::size_t first) noexcept {
    constexpr bool in_float = std::is_same_v<Forms<1>, FormsInFloat<1>>;
    constexpr FloatDivision division = in_float ? forms_in_float : forms_in_double;
    const Forms<Numerators> forms(job);
    for (std::size_t begin = first; begin < job.count; begin += float_block) {
        const std::size_t end = begin + float_block < job.count ? begin + float_block : job.count;
        WideWords x_largest{};
        WideWords y_largest{};
        WideWords z_largest{};
        WideWords largest[Numerators] = {};
        WideWords q_least = signed_bits(WideFloats{} + 0x1p100f);
        for (std::size_t i = begin; i < end; i += static_cast<std::size_t>(wide_lanes)) {
            WideFloats x, y, z;
            load_points(job, i, x, y, z);
            x_largest = maximum(magnitude_bits(x), x_largest);
            y_largest = maximum(magnitude_bits(y), y_largest);
            z_largest = maximum(magnitude_bits(z), z_largest);
            const WideFloats q = forms.at(0, x, y, z);
            q_least = minimum(signed_bits(q), q_least);
            const WideFloats reciprocal = 1.0f / q;
            WideFloats value[Numerators];
            for (std::size_t k = 0; k < Numerators; ++k) {
                value[k] = forms.at(1 + k, x, y, z) * reciprocal;
                largest[k] = maximum(magnitude_bits(value[k]), largest[k]);
            }
            store_points(job, i, value, ~WideWords{});
        }
        const PointExtent extent(x_largest, y_largest, z_largest);
        const double size = extent.x + extent.y + extent.z + 1.0;
        // The bits of positive floats have their order; those of a negative one, and of -0, are below them all. A q that
        // overflowed in float would go unnoticed, not being the least; its terms tell.
        const int least_bits = ~largest_lane(~q_least);
        const auto least = static_cast<double>(bit_cast<float>(least_bits));
        bool certified = true;
        for (std::size_t k = 0; k < Numerators; ++k) {
            const auto bound = static_cast<double>(bit_cast<float>(largest_lane(largest[k])));
            const double error =
                division.error(extent.magnitude_of(job.numerator[k]), extent.magnitude_of(job.q), size, least, bound);
            certified = certified && error <= job.tolerance;
        }
        if (!certified) return begin;
    }
    return job.count;
}

template <template <std::size_t> class Forms>
std::size_t divide_points_within(const PointJob& original, std::size_t first) noexcept {
    const PointJob job = original;
    return job.numerators == 2 ? divide_points_within_of<Forms, 2>(job, first)
                               : divide_points_within_of<Forms, 1>(job, first);
}

// The forms at points, in double, rounded once.
template <class = void>
void generate_points(const GenerateJob& original) noexcept {
    const GenerateJob job = original;
    for (std::size_t i = 0; i < job.count; i += static_cast<std::size_t>(lanes)) {
        Floats xs, ys, zs;
        load_points(job, i, xs, ys, zs);
        const Doubles x = to_doubles(xs);
        const Doubles y = to_doubles(ys);
        const Doubles z = to_doubles(zs);
        if (job.quads != nullptr) {
            store_quads(job.quads + 4 * i, to_floats(at(job.form[0], x, y, z)), to_floats(at(job.form[1], x, y, z)),
                        to_floats(at(job.form[2], x, y, z)), to_floats(at(job.form[3], x, y, z)));
        } else {
            for (std::size_t k = 0; k < 4; ++k)
                if (job.out[k] != nullptr) store(job.out[k] + i, to_floats(at(job.form[k], x, y, z)));
        }
    }
}

// ---- Segments --------------------------------------------------------------------------------------------------

// The sums of a segment's values, for divide_block_again().
template <std::size_t Numerators>
struct SegmentTerms {
    struct At {
        Doubles alpha;
    };
    struct Mixture {
        double a, b;
        bool is_finite;

        TEXGEN_INLINE Twofold at(const At& at) const noexcept { return twofold_mixed(a, b, at.alpha); }
        TEXGEN_INLINE Doubles nearly_at(const At& at) const noexcept { return (1.0 - at.alpha) * a + at.alpha * b; }
        TEXGEN_INLINE Doubles error_at(const At& at) const noexcept {
            return (magnitude((1.0 - at.alpha) * a) + magnitude(at.alpha * b)) * gamma(4);
        }
    };

    const SegmentJob& job;
    Mixture q;
    Mixture numerator[Numerators];

    TEXGEN_INLINE double tolerance() const noexcept { return job.tolerance; }
    TEXGEN_INLINE explicit SegmentTerms(const SegmentJob& segment) noexcept
        : job(segment), q(mixture(segment.q_a, segment.q_b)) {
        for (std::size_t k = 0; k < Numerators; ++k) numerator[k] = mixture(segment.a[k], segment.b[k]);
    }
    TEXGEN_INLINE At load(std::size_t i) const noexcept {
        return {to_doubles(detail::TEXGEN_ISA::load<Floats>(job.alpha + i))};
    }
    TEXGEN_INLINE LongWords are_dark(const At& at) const noexcept {
        const Doubles zero = at.alpha * (q.is_finite ? 0.0 : std::numeric_limits<double>::quiet_NaN());
        return ~at_most(zero, zero);
    }

private:
    TEXGEN_INLINE static Mixture mixture(double a, double b) noexcept { return {a, b, 0.0 * (a + b) == 0.0}; }
};

template <std::size_t Numerators>
TEXGEN_APART Again divide_segment_again(const SegmentJob& job, std::size_t begin, std::size_t end,
                                        bool is_in_doubt) noexcept {
    return divide_block_again<Numerators>(job, SegmentTerms<Numerators>(job), begin, end, is_in_doubt);
}

// (1 - a) A + a B in double, in blocks as for points. 1 - a, the products and the sum are rounded once each. Where the
// whole segment is in front one bound serves all values; only an alpha that is NaN is in doubt about its side.
template <bool InFront, std::size_t Numerators>
TEXGEN_INLINE Undecided divide_segment_nearest_of(const SegmentJob& original, std::size_t first) noexcept {
    const SegmentJob job = original;
    double numerator_error[Numerators];
    for (std::size_t k = 0; k < Numerators; ++k)
        numerator_error[k] = gamma(4) * larger(std::fabs(job.a[k]), std::fabs(job.b[k]));
    const double q_error = gamma(4) * larger(std::fabs(job.q_a), std::fabs(job.q_b));
    bool is_in_doubt = false;
    for (std::size_t begin = first; begin < job.count;) {
        const std::size_t next = begin / nearest_block * nearest_block + nearest_block;
        const std::size_t end = next < job.count ? next : job.count;
        bool is_certain = false;
        if (!is_in_doubt) {
            Doubt doubt;
            for (std::size_t i = begin; i < end; i += static_cast<std::size_t>(lanes)) {
                const Doubles alpha = to_doubles(load<Floats>(job.alpha + i));
                const Doubles rest = 1.0 - alpha;
                const Doubles q = rest * job.q_a + alpha * job.q_b;
                Doubles numerator[Numerators];
                for (std::size_t k = 0; k < Numerators; ++k) numerator[k] = rest * job.a[k] + alpha * job.b[k];
                Floats value[Numerators];
                if constexpr (InFront) {
                    doubt.side |= ~greater(q, 0.0);
                    const Doubles reciprocal = 1.0 / q;
                    for (std::size_t k = 0; k < Numerators; ++k) {
                        const Doubles quotient = numerator[k] * reciprocal;
                        value[k] = to_floats(quotient - job.quotient_error[k]);
                        doubt.rounding |= bits(value[k]) ^ bits(to_floats(quotient + job.quotient_error[k]));
                    }
                    store_points(job, i, value, ~Words{});
                } else {
                    const LongWords in_front =
                        divide_certainly<true>(numerator, numerator_error, q, q_error, 0.0, value, doubt);
                    store_points(job, i, value, narrow(in_front));
                }
            }
            is_certain = !doubt.any_lane();
        }
        if (!is_certain) {
            const Again again = divide_segment_again<Numerators>(original, begin, end, is_in_doubt);
            if (again.doubtful != 0) return {begin, again.doubtful};
            is_in_doubt = again.is_in_doubt;
        }
        begin = end;
    }
    return {job.count, 0};
}

template <class = void>
Undecided divide_segment_nearest(const SegmentJob& job, std::size_t first) noexcept {
    if (job.numerators == 2)
        return job.in_front ? divide_segment_nearest_of<true, 2>(job, first)
                            : divide_segment_nearest_of<false, 2>(job, first);
    return job.in_front ? divide_segment_nearest_of<true, 1>(job, first)
                        : divide_segment_nearest_of<false, 1>(job, first);
}

// In float about one end, two vectors by one division, so that an alpha that is no number spoils its neighbour: its block
// is left to divide_nearest.
template <std::size_t Numerators>
TEXGEN_INLINE std::size_t divide_segment_float_of(const SegmentJob& job, std::size_t first) noexcept {
    // alpha, or 1 - alpha.
    const WideFloats start = WideFloats{} + (job.about_b ? 1.0f : 0.0f);
    const float direction = job.about_b ? -1.0f : 1.0f;
    const auto store_value = [&job](std::size_t i, const WideFloats& step) {
        WideFloats value[Numerators];
        for (std::size_t k = 0; k < Numerators; ++k) value[k] = step * job.slope[k] + job.base[k];
        store_points(job, i, value, ~WideWords{});
    };
    for (std::size_t begin = first; begin < job.count; begin += float_block) {
        const std::size_t end = begin + float_block < job.count ? begin + float_block : job.count;
        WideFloats sum{};
        for (std::size_t i = begin; i < end; i += 2 * static_cast<std::size_t>(wide_lanes)) {
            const std::size_t next = i + static_cast<std::size_t>(wide_lanes);
            const WideFloats from = load<WideFloats>(job.alpha + i) * direction + start;
            const WideFloats next_from = load<WideFloats>(job.alpha + (next < end ? next : i)) * direction + start;
            sum = sum + (from + next_from);
            const WideFloats q = from * job.bend + 1.0f;
            const WideFloats next_q = next_from * job.bend + 1.0f;
            const WideFloats of_both = 1.0f / (q * next_q);
            store_value(i, from * (of_both * next_q));
            if (next < end) store_value(next, next_from * (of_both * q));
        }
        if (any_not_finite(sum)) return begin;
    }
    return job.count;
}

template <class = void>
std::size_t divide_segment_float(const SegmentJob& original, std::size_t first) noexcept {
    const SegmentJob job = original;
    return job.numerators == 2 ? divide_segment_float_of<2>(job, first) : divide_segment_float_of<1>(job, first);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA

#include "boxes.inc.hpp"
#include "footprint.inc.hpp"

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// ---- The tables ------------------------------------------------------------------------------------------------

template <class Table>
const Table& kernels() noexcept {
    if constexpr (std::is_same_v<Table, TileKernels>) {
        static constexpr TileKernels table{divide_nearest<>, divide_rounded<>, divide_chunks<>, divide_closely<>};
        return table;
    } else if constexpr (std::is_same_v<Table, PointKernels>) {
        static constexpr PointKernels table{divide_points_nearest<>, divide_points_within<FormsInFloat>,
                                            divide_points_within<FormsInDouble>, generate_points<>};
        return table;
    } else if constexpr (std::is_same_v<Table, SegmentKernels>) {
        static constexpr SegmentKernels table{divide_segment_nearest<>, divide_segment_float<>};
        return table;
    } else if constexpr (std::is_same_v<Table, FootprintKernels>) {
        static constexpr FootprintKernels table{differentiate<>, filter<>};
        return table;
    } else {
        static constexpr BoxKernels table{classify<>, bound<>, separate<>};
        return table;
    }
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
