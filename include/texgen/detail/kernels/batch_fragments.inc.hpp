// The inner loops of a batch: fragments of any of its triangles. Included by batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The functions of one triangle, as BatchLanes has those of several.
struct OneTriangle {
    const double* value;
    TEXGEN_INLINE Doubles operator[](std::size_t k) const noexcept { return value[k] - Doubles{}; }
};

TEXGEN_INLINE bool all(const LongWords& mask) noexcept { return lane_bits(mask) == (std::uint64_t{1} << lanes) - 1; }

// A vector of fragments at (x, y): quotients, where they are in front, and the lanes in doubt, of their side or their value.
template <std::size_t Numerators>
struct FragmentLanes {
    Floats quotient[Numerators];
    LongWords front;
    Words doubtful;

    template <class Functions>
    TEXGEN_INLINE void divide(const Functions& functions, const Doubles& x, const Doubles& y,
                              double tolerance) noexcept {
        const Doubles p_x = x - functions[BatchPlanes::origin];
        const Doubles p_y = y - functions[BatchPlanes::origin + 1];
        const Doubles stretch = magnitude(p_x) * functions[BatchPlanes::per_reach] +
                                (magnitude(p_y) * functions[BatchPlanes::per_reach + 1] + 1.001);
        const Doubles q =
            functions[BatchPlanes::q] + (functions[BatchPlanes::q + 1] * p_x + functions[BatchPlanes::q + 2] * p_y);
        const Doubles q_error = functions[BatchPlanes::q + 3] * stretch;
        front = greater(q, q_error * 0x1p24);
        const Doubles reciprocal = where(front, 1.0 / q);
        const Doubles stretched = stretch * (reciprocal * 1.0001);
        Doubles u[Numerators], largest{}, largest_error{};
        TEXGEN_UNROLL
        for (std::size_t k = 0; k < Numerators; ++k) {
            const std::size_t place = BatchPlanes::of_numerator[k];
            u[k] = (functions[place] + (functions[place + 1] * p_x + functions[place + 2] * p_y)) * reciprocal +
                   0.0;  // no -0
            largest = k == 0 ? magnitude(u[k]) : maximum(largest, magnitude(u[k]));
            largest_error = k == 0 ? functions[place + 3] : maximum(largest_error, functions[place + 3]);
            quotient[k] = to_floats(u[k]);
        }
        doubtful = Words{};
        Words can_be_doubtful = ~Words{};
        if (tolerance > 0.0) {
            // Whichever float is taken; what doubles are rounded by is within 1.0002.
            const Doubles written = (largest * functions[BatchPlanes::q + 3] + largest_error) * (stretched * 2.0) +
                                    (largest * (1.0002 * unit_roundoff_float) + 0x1p-149);
            const LongWords is_certain = front & at_most(written, Doubles{} + tolerance);
            if (all(is_certain)) return;
            can_be_doubtful = ~narrow(is_certain);
        }
        if (!all(front)) doubtful = narrow(~(front | greater(q * -1.0, q_error)));
        const Doubles relative_error = functions[BatchPlanes::q + 3] * stretched + 8.0 * unit_roundoff_double;
        TEXGEN_UNROLL
        for (std::size_t k = 0; k < Numerators; ++k) {
            const Doubles error =
                functions[BatchPlanes::of_numerator[k] + 3] * stretched + magnitude(u[k]) * relative_error;
            quotient[k] = to_floats(u[k] - error);
            doubtful |= bits(quotient[k]) ^ bits(to_floats(u[k] + error));
        }
        doubtful &= can_be_doubtful;
    }
};

TEXGEN_INLINE const float* vertices_of(const BatchJob& job, std::size_t triangle) noexcept {
    return job.vertices + 3 * BatchVertex::size * triangle;
}

// Vectors of fragments of one triangle each, in a row each, that have lanes in doubt: so many are decided at once.
struct DoubtfulRuns {
    std::size_t count = 0;
    const float* triangle[lanes];
    double x[lanes], y[lanes];  // of the first fragment
    const FragmentOutputs* out[lanes];
    std::size_t n[lanes], place[lanes];  // of the first fragment: in `out`, and in the block
    Words doubtful[lanes];

    // Puts what is decided to its place; the fragments that stay in doubt are bits of the block.
    template <std::size_t Numerators>
    TEXGEN_APART std::uint64_t decide(double tolerance) noexcept {
        constexpr auto size = static_cast<std::size_t>(lanes);
        for (std::size_t i = count; i < size; ++i) {
            triangle[i] = triangle[0];
            x[i] = x[0];
            y[i] = y[0];
        }
        BatchFunctions functions;
        const Doubles none{};
        const LongWords are_unknown = functions.take<Numerators>(triangle, load<Doubles>(x), load<Doubles>(y),
                                                                 none + static_cast<double>(lanes), none + 1.0, 0);
        const std::uint64_t unknown = lane_bits(are_unknown);
        std::uint64_t undecided = 0;
        for (std::size_t i = 0; i < count; ++i) {
            CloseFragments<Numerators> fragments;
            const BatchFunctionsAt at{functions, i, indices<Doubles>(), none};
            CloseDivisor q;
            q.take(at.values(Numerators));
            fragments.divide(at, q, Numerators, tolerance, true);
            const bool is_unknown = (unknown >> i & 1u) != 0;
            const Words left = is_unknown ? doubtful[i] : doubtful[i] & narrow(fragments.doubtful);
            out[i]->put_where(doubtful[i], n[i], fragments.quotient, q.front);
            undecided |= std::uint64_t{bits_of(left)} << place[i];
        }
        count = 0;
        return undecided;
    }
};

// The ids of a vector of fragments from n on; behind the last one they are any.
struct FragmentIds {
    std::uint32_t last[lanes];
    const std::uint32_t* value;
    bool is_whole;

    TEXGEN_INLINE FragmentIds(const FragmentsJob& job, std::size_t n) noexcept
        : value(job.ids + n), is_whole(n + static_cast<std::size_t>(lanes) <= job.count) {
        if (is_whole) return;
        for (std::size_t i = 0; i < static_cast<std::size_t>(lanes); ++i)
            last[i] = n + i < job.count ? value[i] : value[0];
        value = last;
    }
    TEXGEN_INLINE bool are_one() const noexcept {
        return !any(load<Words>(value) ^ (Words{} + static_cast<int>(value[0])));
    }
};

// A block of fragments of which these lanes of its vectors are in doubt, again. Returns those that stay so, as bits.
template <std::size_t Numerators>
TEXGEN_APART std::uint64_t decide_fragments(const FragmentsJob& job, const FragmentOutputs& out,
                                            const FragmentOutputs& in_scratch, std::size_t begin, std::size_t end,
                                            const Words* doubtful) noexcept {
    constexpr auto size = static_cast<std::size_t>(lanes);
    FragmentWalk<Doubles, double> walk(job.width, 1.0 / job.width, static_cast<double>(begin));
    DoubtfulRuns runs;
    std::uint64_t undecided = 0;
    for (std::size_t n = begin; n < end; n += size, walk.advance(), ++doubtful) {
        if (!any(*doubtful)) continue;
        const FragmentIds ids(job, n);
        const Doubles x = walk.x + (job.x + 0.5), y = walk.y + (job.y + 0.5);
        const float* of_lane[lanes];
        for (std::size_t i = 0; i < size; ++i)
            of_lane[i] = vertices_of(job, ids.value[i] < job.triangles ? ids.value[i] : 0);
        const FragmentOutputs& to = ids.is_whole ? out : in_scratch;
        const std::size_t at = ids.is_whole ? n : 0;
        const Words in_doubt = ~equal(*doubtful, 0);
        double rows[lanes];
        store(rows, y);
        if (ids.are_one() && rows[0] == rows[size - 1]) {
            const std::size_t i = runs.count++;
            double columns[lanes];
            store(columns, x);
            runs.triangle[i] = of_lane[0];
            runs.x[i] = columns[0];
            runs.y[i] = rows[0];
            runs.out[i] = &to;
            runs.n[i] = at;
            runs.place[i] = n - begin;
            runs.doubtful[i] = in_doubt;
            if (runs.count == size) undecided |= runs.decide<Numerators>(job.tolerance);
        } else {
            Floats quotient[Numerators];
            LongWords in_front;
            const Words left = divide_lanes_closely(of_lane, x, y, in_doubt, quotient, in_front);
            to.put_where(in_doubt, at, quotient, in_front);
            undecided |= std::uint64_t{bits_of(left)} << (n - begin);
        }
    }
    if (runs.count != 0) undecided |= runs.decide<Numerators>(job.tolerance);
    return undecided;
}

template <std::size_t Numerators>
TEXGEN_INLINE Undecided divide_all_fragments(const FragmentsJob& job, std::size_t first) noexcept {
    constexpr auto size = static_cast<std::size_t>(lanes);
    const FragmentOutputs out(job);
    ScratchOutputs<size> scratch;
    const FragmentOutputs in_scratch = scratch.in_place_of(out);
    FragmentWalk<Doubles, double> walk(job.width, 1.0 / job.width, static_cast<double>(first));
    const double left = job.x + 0.5;
    const double top = job.y + 0.5;
    const auto planes_of = [&](std::uint32_t id) { return &job.planes[id < job.triangles ? id : job.triangles]; };
    for (std::size_t n = first; n < job.count;) {
        const std::size_t begin = n;
        const std::size_t end = job.count - begin < exact_block ? job.count : begin + exact_block;
        Words doubtful[exact_block / size], any_doubtful{};
        Words* next = doubtful;
        for (; n < end; n += size, walk.advance()) {
            const FragmentIds ids(job, n);
            const Doubles x = walk.x + left;
            const Doubles y = walk.y + top;
            FragmentLanes<Numerators> fragments;
            if (ids.are_one()) {
                fragments.divide(OneTriangle{planes_of(ids.value[0])->value}, x, y, job.tolerance);
            } else {
                const BatchPlanes* of_lane[lanes];
                TEXGEN_UNROLL
                for (std::size_t i = 0; i < size; ++i) of_lane[i] = planes_of(ids.value[i]);
                fragments.divide(BatchLanes(of_lane, Numerators == 3), x, y, job.tolerance);
            }
            const FragmentOutputs& to = ids.is_whole ? out : in_scratch;
            to.put(ids.is_whole ? n : 0, fragments.quotient, fragments.front);
            *next++ = fragments.doubtful;
            any_doubtful |= fragments.doubtful;
        }
        std::uint64_t undecided = 0;
        if (any(any_doubtful)) undecided = decide_fragments<Numerators>(job, out, in_scratch, begin, end, doubtful);
        if (n > job.count) scratch.copy_to(out, n - size, job.count + size - n);
        if (undecided != 0) return {begin, undecided};
    }
    return {job.count, 0};
}

template <class = void>
Undecided divide_batch_fragments(const FragmentsJob& original, std::size_t first) noexcept {
    const FragmentsJob job = original;
    return job.needs_r() ? divide_all_fragments<3>(job, first) : divide_all_fragments<2>(job, first);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
