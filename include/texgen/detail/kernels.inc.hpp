// The inner loops. Included by lanes.hpp once per instruction set, inside that set's target region, so that one source
// serves all of them. A kernel gets plain numbers; the only decision it makes is the certificate of a polynomial's chunk.

namespace texgen::detail::TEXGEN_ISA {

// A row of a TileJob: functions of the fragment's index alone. Where there is a mask, the numerators are s and t.
template <std::size_t Numerators>
struct TileRow {
    double base[Numerators];
    double q;
    float* out[Numerators];
    float* lit;

    TEXGEN_INLINE TileRow(const TileJob& job, int y) noexcept
        : q(job.q.base + y * job.q.dy), lit(job.lit + y * job.lit_pitch) {
        for (std::size_t k = 0; k < Numerators; ++k) {
            base[k] = job.numerator[k].base + y * job.numerator[k].dy;
            out[k] = job.out[k] + y * job.pitch[k];
        }
    }
};

// Whether a mask is asked for, the layout of points and that of their coordinates are looked at vector by vector: a branch
// that is always the same costs next to nothing, and a loop for each combination would be most of what a user compiles.

// Stores one vector of coordinates from out[k] + x on, and its mask from lit + x on.
template <std::size_t Numerators, class Vector>
TEXGEN_INLINE void store_all(const TileJob& job, const TileRow<Numerators>& row, int x,
                             const Vector (&value)[Numerators]) noexcept {
    for (std::size_t k = 0; k < Numerators; ++k) store(row.out[k] + x, value[k]);
    if constexpr (Numerators == 2)
        if (job.lit != nullptr)
            store(row.lit + x,
                  one_where(inside(value[0], job.min[0], job.max[0]) & inside(value[1], job.min[1], job.max[1])));
}

// The same for the first `count` lanes of a vector: nothing beyond them is touched.
template <std::size_t Numerators, class Vector>
TEXGEN_INLINE void store_first(const TileJob& job, const TileRow<Numerators>& row, int x, int count,
                               const Vector (&value)[Numerators]) noexcept {
    float buffer[Numerators + 1][sizeof(Vector) / sizeof(float)]{};
    TileRow<Numerators> buffered = row;
    for (std::size_t k = 0; k < Numerators; ++k) buffered.out[k] = buffer[k];
    buffered.lit = buffer[Numerators];
    store_all(job, buffered, 0, value);
    for (int i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < Numerators; ++k) row.out[k][x + i] = buffer[k][i];
        if (job.lit != nullptr) row.lit[x + i] = buffer[Numerators][i];
    }
}

// ---- Division in double ----------------------------------------------------------------------------------------

// One vector of quotients from `index` on. With Nearest, marks in `doubtful` where value - error and value + error do
// not round to one float; else numerators and q are rounded to float and divided there.
template <bool ConstantQ, bool Nearest, std::size_t Numerators>
TEXGEN_INLINE void divide_vector(const TileJob& job, const TileRow<Numerators>& row, const Doubles& index,
                                 const Doubles& reciprocal_of_constant, Floats (&quotient)[Numerators],
                                 Words& doubtful) noexcept {
    if constexpr (Nearest) {
        Doubles reciprocal = reciprocal_of_constant;
        if constexpr (!ConstantQ) reciprocal = 1.0 / (index * job.q.dx + row.q);
        for (std::size_t k = 0; k < Numerators; ++k) {
            const Doubles value = (index * job.numerator[k].dx + row.base[k]) * reciprocal;
            quotient[k] = to_floats(value - job.quotient_error[k]);
            doubtful |= bits(quotient[k]) ^ bits(to_floats(value + job.quotient_error[k]));
        }
    } else {
        const Floats reciprocal = 1.0f / to_floats(index * job.q.dx + row.q);
        for (std::size_t k = 0; k < Numerators; ++k)
            quotient[k] = to_floats(index * job.numerator[k].dx + row.base[k]) * reciprocal;
    }
}

// The units of the job from `unit` on, up to the first one with a doubtful value (it is written all the same). A last
// vector that is not full overlaps the one before it, or is stored in part.
template <bool ConstantQ, bool Nearest, std::size_t Numerators>
TEXGEN_INLINE TileJob::Unit divide_units(const TileJob& job, TileJob::Unit unit) noexcept {
    const Doubles reciprocal = Doubles{} + (ConstantQ ? 1.0 / job.q.base : 0.0);
    for (; !job.is_done(unit); unit = job.unit_after(unit)) {
        Words doubtful{};
        for (int y = unit.y_begin; y < unit.y_end; ++y) {
            const TileRow<Numerators> row(job, y);
            Floats quotient[Numerators];
            Doubles index = indices<Doubles>() + static_cast<double>(unit.x_begin);
            int x = unit.x_begin;
            for (; x <= unit.x_end - lanes; x += lanes) {
                divide_vector<ConstantQ, Nearest>(job, row, index, reciprocal, quotient, doubtful);
                store_all(job, row, x, quotient);
                index += static_cast<double>(lanes);
            }
            if (x == unit.x_end) continue;
            const int first = unit.x_end >= lanes ? unit.x_end - lanes : 0;
            index = indices<Doubles>() + static_cast<double>(first);
            divide_vector<ConstantQ, Nearest>(job, row, index, reciprocal, quotient, doubtful);
            if (unit.x_end >= lanes)
                store_all(job, row, first, quotient);
            else
                store_first(job, row, 0, unit.x_end, quotient);
        }
        if (!Nearest || !any(doubtful)) continue;
        // The overlapping vector may have rewritten the end of the unit before, and the doubt may be there.
        if (unit.x_end - lanes < unit.x_begin) unit.x_begin = unit.x_end > lanes ? unit.x_end - lanes : 0;
        break;
    }
    return unit;
}

// The job is copied, here and below, so that the compiler knows that no store changes it.
template <class = void>
TileJob::Unit divide_nearest(const TileJob& original, TileJob::Unit first) noexcept {
    const TileJob job = original;
    if (job.q_is_constant)
        return job.numerators == 2 ? divide_units<true, true, 2>(job, first) : divide_units<true, true, 1>(job, first);
    return job.numerators == 2 ? divide_units<false, true, 2>(job, first) : divide_units<false, true, 1>(job, first);
}

template <class = void>
void divide_rounded(const TileJob& original) noexcept {
    const TileJob job = original;
    const TileJob::Unit first = job.unit_at(0, 0);
    if (job.numerators == 2)
        divide_units<false, false, 2>(job, first);
    else
        divide_units<false, false, 1>(job, first);
}

// ---- Division in float -----------------------------------------------------------------------------------------

// Linear functions in float about the middle of a chunk of the row, so that the index stays small.
template <std::size_t Numerators>
TEXGEN_INLINE void divide_float_rows(const TileJob& job) noexcept {
    const auto q_dx = static_cast<float>(job.q.dx);
    float dx[Numerators];
    for (std::size_t k = 0; k < Numerators; ++k) dx[k] = static_cast<float>(job.numerator[k].dx);
    for (int y = 0; y < job.height; ++y) {
        const TileRow<Numerators> row(job, y);
        for (int begin = 0; begin < job.width; begin += job.chunk) {
            const int end = begin + job.chunk < job.width ? begin + job.chunk : job.width;
            const int middle = begin + (end - begin) / 2;
            const auto q = static_cast<float>(row.q + middle * job.q.dx);
            float base[Numerators];
            for (std::size_t k = 0; k < Numerators; ++k)
                base[k] = static_cast<float>(row.base[k] + middle * job.numerator[k].dx);
            int x = begin;
            while (true) {
                const WideFloats index = indices<WideFloats>() + static_cast<float>(x - middle);
                const WideFloats reciprocal = 1.0f / (index * q_dx + q);
                WideFloats quotient[Numerators];
                for (std::size_t k = 0; k < Numerators; ++k) quotient[k] = (index * dx[k] + base[k]) * reciprocal;
                if (x + wide_lanes > end) {
                    store_first(job, row, x, end - x, quotient);
                    break;
                }
                store_all(job, row, x, quotient);
                if (x + wide_lanes == end) break;
                // A last vector that is not full overlaps the one before it.
                x = x + 2 * wide_lanes <= end ? x + wide_lanes : end - wide_lanes;
            }
        }
    }
}

template <class = void>
void divide_float(const TileJob& original) noexcept {
    const TileJob job = original;
    if (job.numerators == 2)
        divide_float_rows<2>(job);
    else
        divide_float_rows<1>(job);
}

// ---- Polynomials -----------------------------------------------------------------------------------------------

// A group of chunks of one row: the coefficients of u = c0 + i (c1 + i c2), i from the middle of the chunk, and the room
// that the certificate leaves below the tolerance, times something positive: it holds where the room is not negative.
template <std::size_t Numerators>
struct ChunkGroup {
    static constexpr int size = 16;

    double room[size];
    float coefficient[Numerators][3][size];
};

// Both polynomials go through the values at the two ends, the quadratic also through the one in the middle. With
// du = |u1 - u0|, dq = |q1 - q0|, m = min(q0, q1) > 0 the largest error is at most
//   affine     du dq (q0 + q1) / (q0^2 + 6 q0 q1 + q1^2)
//   quadratic  du dq^2 (sqrt(3)/18) / (m (q0 + q1))
// (the remainder of interpolation of a quotient of linear functions). Rounding to float adds 2^-24 (2 U + 4 du),
// U = max(|u0|, |u1|): c0, the last sum, and five terms that are at most du; and 2^-134 where coefficients are subnormal.
// The doubles add (e_s + U e_q) / m.
template <bool Affine, std::size_t Numerators>
TEXGEN_INLINE void fill(ChunkGroup<Numerators>& group, const TileJob& job, const TileRow<Numerators>& row, int first,
                        int count) noexcept {
    const double length = job.chunk;
    const double per_length = 1.0 / length;
    for (int i = 0; i < count; i += lanes) {
        const Doubles begin = (indices<Doubles>() + static_cast<double>(first + i)) * length;
        const Doubles middle = begin + 0.5 * length;
        const Doubles end = begin + length;
        const Doubles q0 = begin * job.q.dx + row.q;
        const Doubles q1 = end * job.q.dx + row.q;
        const Doubles reciprocal0 = 1.0 / q0;
        const Doubles reciprocal1 = 1.0 / q1;
        Doubles reciprocal_of_middle{};
        if constexpr (!Affine) reciprocal_of_middle = 1.0 / (middle * job.q.dx + row.q);
        const Doubles q_least = minimum(q0, q1);
        const Doubles q_sum = q0 + q1;
        const Doubles dq = magnitude(q1 - q0);
        Doubles least_room = q_least - job.least_q;
        for (std::size_t k = 0; k < Numerators; ++k) {
            const Doubles u0 = (begin * job.numerator[k].dx + row.base[k]) * reciprocal0;
            const Doubles u1 = (end * job.numerator[k].dx + row.base[k]) * reciprocal1;
            const Doubles du = magnitude(u1 - u0);
            const Doubles largest = maximum(magnitude(u0), magnitude(u1));
            const Doubles beside_rounding = (job.tolerance - 0x1p-134 - largest * 0x2.002p-24) - du * 0x4.004p-24;
            const Doubles room = beside_rounding * q_least - (largest * job.q_error + job.numerator_error[k]);
            store(&group.coefficient[k][1][i], to_floats((u1 - u0) * per_length));
            if constexpr (Affine) {
                store(&group.coefficient[k][0][i], to_floats((u0 + u1) * 0.5));
                least_room = minimum(
                    least_room, room * (q_sum * q_sum + (q0 * q1) * 4.0) - ((du * dq) * (q_sum * q_least)) * 1.0001);
            } else {
                const Doubles u = (middle * job.numerator[k].dx + row.base[k]) * reciprocal_of_middle;
                const Doubles bend = (u1 - u) - (u - u0);
                store(&group.coefficient[k][0][i], to_floats(u));
                store(&group.coefficient[k][2][i], to_floats(bend * (2.0 * per_length * per_length)));
                least_room = minimum(least_room, room * q_sum - (du * (dq * dq)) * 0.0963);
            }
        }
        store(&group.room[i], least_room);
    }
}

template <bool Affine, std::size_t Numerators>
TEXGEN_INLINE void polynomial(const WideFloats (&c)[Numerators][3], const WideFloats& index,
                              WideFloats (&value)[Numerators]) noexcept {
    for (std::size_t k = 0; k < Numerators; ++k) {
        if constexpr (Affine)
            value[k] = index * c[k][1] + c[k][0];
        else
            value[k] = (index * c[k][2] + c[k][1]) * index + c[k][0];
    }
}

// Evaluates chunk i of the group over fragments begin to end of the row.
template <bool Affine, std::size_t Numerators>
TEXGEN_INLINE void evaluate(const ChunkGroup<Numerators>& group, int i, const TileJob& job,
                            const TileRow<Numerators>& row, WideFloats index, int begin, int end) noexcept {
    WideFloats c[Numerators][3];
    for (std::size_t k = 0; k < Numerators; ++k)
        for (std::size_t degree = 0; degree < (Affine ? 2 : 3); ++degree)
            c[k][degree] = WideFloats{} + group.coefficient[k][degree][i];
    int x = begin;
    WideFloats value[Numerators];
    // Two vectors a turn, so that their indices do not wait for one another.
    WideFloats next_index = index + static_cast<float>(wide_lanes);
    for (const int last = end - 2 * wide_lanes; x <= last; x += 2 * wide_lanes) {
        polynomial<Affine>(c, index, value);
        store_all(job, row, x, value);
        polynomial<Affine>(c, next_index, value);
        store_all(job, row, x + wide_lanes, value);
        index += static_cast<float>(2 * wide_lanes);
        next_index += static_cast<float>(2 * wide_lanes);
    }
    for (; x < end; x += wide_lanes) {
        polynomial<Affine>(c, index, value);
        if (x + wide_lanes <= end)
            store_all(job, row, x, value);
        else
            store_first(job, row, x, end - x, value);
        index += static_cast<float>(wide_lanes);
    }
}

// Does the rows of the job from `first` on. Stops at chunks that the certificate does not cover and returns them, a part
// of one row; the empty unit if there are none. The next call starts after them.
template <bool Affine, std::size_t Numerators>
TEXGEN_INLINE TileJob::Unit polynomial_rows(const TileJob& job, const TileJob::Unit& first) noexcept {
    constexpr int group_size = ChunkGroup<Numerators>::size;
    const WideFloats index = indices<WideFloats>() + static_cast<float>(-job.chunk / 2);
    const int chunks = (job.width + job.chunk - 1) / job.chunk;
    int chunk = first.x_begin / job.chunk;
    for (int y = first.y_begin; y < job.height; ++y, chunk = 0) {
        const TileRow<Numerators> row(job, y);
        for (; chunk < chunks; chunk += group_size) {
            ChunkGroup<Numerators> group;
            const int count = chunks - chunk < group_size ? chunks - chunk : group_size;
            fill<Affine>(group, job, row, chunk, count);
            for (int i = 0; i < count; ++i) {
                const int begin = (chunk + i) * job.chunk;
                int end = begin + job.chunk;
                if (group.room[i] >= 0.0) {
                    evaluate<Affine>(group, i, job, row, index, begin, end < job.width ? end : job.width);
                    continue;
                }
                for (int j = i + 1; j < count && !(group.room[j] >= 0.0); ++j) end += job.chunk;
                return {begin, end < job.width ? end : job.width, y, y + 1};
            }
        }
    }
    return {0, 0, job.height, job.height};
}

template <class = void>
TileJob::Unit quadratic(const TileJob& original, TileJob::Unit first) noexcept {
    const TileJob job = original;
    return job.numerators == 2 ? polynomial_rows<false, 2>(job, first) : polynomial_rows<false, 1>(job, first);
}

template <class = void>
TileJob::Unit affine(const TileJob& original, TileJob::Unit first) noexcept {
    const TileJob job = original;
    return job.numerators == 2 ? polynomial_rows<true, 2>(job, first) : polynomial_rows<true, 1>(job, first);
}

// ---- Points ----------------------------------------------------------------------------------------------------

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

    TEXGEN_INLINE bool any_lane() const noexcept { return any(rounding | narrow(side)); }
};

// numerator[k] / q with these errors; the error of the quotient is that of certain_quotient(). With Signed, q has either
// sign, and lanes that are certainly behind give 0; else they are in doubt too. Returns the mask of the lanes in front.
template <bool Signed, std::size_t Numerators>
TEXGEN_INLINE LongWords divide_certainly(const Doubles (&numerator)[Numerators],
                                         const double (&numerator_error)[Numerators], const Doubles& q, double q_error,
                                         Floats (&value)[Numerators], Doubt& doubt) noexcept {
    const LongWords in_front = greater(q, 0x1p20 * q_error);
    Doubles reciprocal = 1.0 / q;
    if constexpr (Signed) {
        doubt.side |= ~(in_front | greater(-1.0 * q, q_error));
        reciprocal = where(in_front, reciprocal);
    } else {
        doubt.side |= ~in_front;
    }
    const Doubles relative_error = reciprocal * (1.001 * q_error) + 4.0 * unit_roundoff_double;
    for (std::size_t k = 0; k < Numerators; ++k) {
        Doubles quotient = numerator[k] * reciprocal;
        if constexpr (Signed) quotient = where(in_front, quotient);
        Doubles error = magnitude(quotient) * relative_error + reciprocal * (1.001 * numerator_error[k]);
        if constexpr (Signed) error = where(in_front, error);  // of a numerator that is no number
        value[k] = to_floats(quotient - error);
        doubt.rounding |= bits(value[k]) ^ bits(to_floats(quotient + error));
    }
    return in_front;
}

// The largest |x|, |y|, |z| of a block: of all three together for triples. A NaN is the largest.
struct PointExtent {
    double x, y, z;

    TEXGEN_INLINE PointExtent(const WideWords& x_bits, const WideWords& y_bits, const WideWords& z_bits) noexcept
        : x(static_cast<double>(std::bit_cast<float>(largest_lane(x_bits)))),
          y(static_cast<double>(std::bit_cast<float>(largest_lane(y_bits)))),
          z(static_cast<double>(std::bit_cast<float>(largest_lane(z_bits)))) {}

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

// A block of points. False where a value is in doubt (it is written all the same).
template <bool Signed, std::size_t Numerators>
TEXGEN_INLINE bool divide_points_block(const PointJob& job, std::size_t begin, std::size_t end,
                                       const double (&numerator_error)[Numerators], double q_error) noexcept {
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
        const LongWords in_front =
            divide_certainly<Signed>(numerator, numerator_error, at(job.q, x, y, z), q_error, value, doubt);
        store_points(job, i, value, narrow(in_front));
    }
    return !doubt.any_lane();
}

// Most blocks are all in front; one that is not is done again for both signs of q.
template <std::size_t Numerators>
TEXGEN_INLINE std::size_t divide_points_nearest_of(const PointJob& job, std::size_t first) noexcept {
    for (std::size_t begin = first; begin < job.count;) {
        const std::size_t next = begin / nearest_block * nearest_block + nearest_block;
        const std::size_t end = next < job.count ? next : job.count;
        const PointExtent extent = extent_of(job, begin, end);
        double numerator_error[Numerators];
        for (std::size_t k = 0; k < Numerators; ++k)
            numerator_error[k] = gamma(5) * extent.magnitude_of(job.numerator[k]);
        const double q_error = gamma(5) * extent.magnitude_of(job.q);
        if (!divide_points_block<false>(job, begin, end, numerator_error, q_error) &&
            !divide_points_block<true>(job, begin, end, numerator_error, q_error))
            return begin;
        begin = end;
    }
    return job.count;
}

template <class = void>
std::size_t divide_points_nearest(const PointJob& original, std::size_t first) noexcept {
    const PointJob job = original;
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
        const auto least = static_cast<double>(std::bit_cast<float>(least_bits));
        bool certified = true;
        for (std::size_t k = 0; k < Numerators; ++k) {
            const auto bound = static_cast<double>(std::bit_cast<float>(largest_lane(largest[k])));
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

// (1 - a) A + a B in double, in blocks as for points. 1 - a, the products and the sum are rounded once each. Where the
// whole segment is in front one bound serves all values; only an alpha that is NaN is in doubt about its side.
template <bool InFront, std::size_t Numerators>
TEXGEN_INLINE std::size_t divide_segment_nearest_of(const SegmentJob& job, std::size_t first) noexcept {
    double numerator_error[Numerators];
    for (std::size_t k = 0; k < Numerators; ++k)
        numerator_error[k] = gamma(4) * larger(std::fabs(job.a[k]), std::fabs(job.b[k]));
    const double q_error = gamma(4) * larger(std::fabs(job.q_a), std::fabs(job.q_b));
    for (std::size_t begin = first; begin < job.count;) {
        const std::size_t next = begin / nearest_block * nearest_block + nearest_block;
        const std::size_t end = next < job.count ? next : job.count;
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
                const LongWords in_front = divide_certainly<true>(numerator, numerator_error, q, q_error, value, doubt);
                store_points(job, i, value, narrow(in_front));
            }
        }
        if (doubt.any_lane()) return begin;
        begin = end;
    }
    return job.count;
}

template <class = void>
std::size_t divide_segment_nearest(const SegmentJob& original, std::size_t first) noexcept {
    const SegmentJob job = original;
    if (job.numerators == 2)
        return job.in_front ? divide_segment_nearest_of<true, 2>(job, first)
                            : divide_segment_nearest_of<false, 2>(job, first);
    return job.in_front ? divide_segment_nearest_of<true, 1>(job, first)
                        : divide_segment_nearest_of<false, 1>(job, first);
}

// A + a (B - A) would lose the small end next to a large one; A - a A does not.
template <std::size_t Numerators>
TEXGEN_INLINE void divide_segment_float_of(const SegmentJob& job) noexcept {
    float a[Numerators];
    float b[Numerators];
    for (std::size_t k = 0; k < Numerators; ++k) {
        a[k] = static_cast<float>(job.a[k]);
        b[k] = static_cast<float>(job.b[k]);
    }
    const auto q_a = static_cast<float>(job.q_a);
    const auto q_b = static_cast<float>(job.q_b);
    for (std::size_t i = 0; i < job.count; i += static_cast<std::size_t>(wide_lanes)) {
        const auto alpha = load<WideFloats>(job.alpha + i);
        const WideFloats reciprocal = 1.0f / (alpha * q_b + (q_a - alpha * q_a));
        WideFloats value[Numerators];
        for (std::size_t k = 0; k < Numerators; ++k) value[k] = (alpha * b[k] + (a[k] - alpha * a[k])) * reciprocal;
        store_points(job, i, value, ~WideWords{});
    }
}

template <class = void>
void divide_segment_float(const SegmentJob& original) noexcept {
    const SegmentJob job = original;
    if (job.numerators == 2)
        divide_segment_float_of<2>(job);
    else
        divide_segment_float_of<1>(job);
}

}  // namespace texgen::detail::TEXGEN_ISA

#include "boxes.inc.hpp"
#include "footprint.inc.hpp"

namespace texgen::detail::TEXGEN_ISA {

// ---- The tables ------------------------------------------------------------------------------------------------

template <class Table>
const Table& kernels() noexcept {
    if constexpr (std::is_same_v<Table, TileKernels>) {
        static constexpr TileKernels table{divide_nearest<>, divide_rounded<>, divide_float<>, quadratic<>, affine<>};
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
        static constexpr BoxKernels table{classify<>, separate<>};
        return table;
    }
}

}  // namespace texgen::detail::TEXGEN_ISA
