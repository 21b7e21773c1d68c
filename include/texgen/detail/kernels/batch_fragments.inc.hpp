// The inner loops of a batch: fragments of any of its triangles. Included by batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The functions of one triangle, as BatchLanes has those of several.
struct OneTriangle {
    const double* value;
    TEXGEN_INLINE Doubles operator[](std::size_t k) const noexcept { return value[k] - Doubles{}; }
};

// A vector of fragments at (x, y): quotients, where they are in front, and the lanes in doubt, of their side or their value.
template <std::size_t Numerators>
struct FragmentLanes {
    Floats quotient[Numerators];
    LongWords front;
    LongWords is_within;  // the tolerance, whichever float is taken
    Words doubtful;
    Doubles u[Numerators], q_size;  // |q| is no more

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
        q_size = magnitude(q) + q_error;
        front = greater(q, q_error * 0x1p24);
        const LongWords is_beside = ~(front | greater(q * -1.0, q_error));
        is_within = LongWords{};
        doubtful = Words{};
        if (any(is_beside)) doubtful = narrow(is_beside);
        const Doubles reciprocal = where(front, 1.0 / q);
        const Doubles relative_error = q_error * (reciprocal * 1.0001) + 8.0 * unit_roundoff_double;
        const Doubles stretched = stretch * (reciprocal * 1.0001);
        Doubles largest{}, largest_error{};
        TEXGEN_UNROLL
        for (std::size_t k = 0; k < Numerators; ++k) {
            const std::size_t place = BatchPlanes::of_numerator[k];
            u[k] = (functions[place] + (functions[place + 1] * p_x + functions[place + 2] * p_y)) * reciprocal +
                   0.0;  // no -0
            largest = k == 0 ? magnitude(u[k]) : maximum(largest, magnitude(u[k]));
            largest_error = k == 0 ? functions[place + 3] : maximum(largest_error, functions[place + 3]);
            quotient[k] = to_floats(u[k]);
        }
        if (tolerance > 0.0) {
            const Doubles written =
                largest_error * stretched + (largest * (relative_error + 1.0001 * unit_roundoff_float) + 0x1p-149);
            is_within = at_most(written, Doubles{} + tolerance);
            if (!any(~is_within)) return;
        }
        TEXGEN_UNROLL
        for (std::size_t k = 0; k < Numerators; ++k) {
            const Doubles error =
                functions[BatchPlanes::of_numerator[k] + 3] * stretched + magnitude(u[k]) * relative_error;
            quotient[k] = to_floats(u[k] - error);
            doubtful |= bits(quotient[k]) ^ bits(to_floats(u[k] + error));
        }
    }
};

TEXGEN_INLINE const float* vertices_of(const BatchJob& job, std::size_t triangle) noexcept {
    return job.vertices + 3 * BatchVertex::size * triangle;
}

// What one double leaves in doubt of a vector of fragments as two have it; vertices(i) are those of lane i. All go to their place.
// Returns the lanes that stay in doubt.
template <std::size_t Numerators, class VerticesOf>
TEXGEN_INLINE Words put_doubtful(const FragmentLanes<Numerators>& fragments, const Doubles& x, const Doubles& y,
                                 bool is_one, const VerticesOf& vertices, const FragmentOutputs& out,
                                 std::size_t n) noexcept {
    const float* of_lane[lanes];
    TEXGEN_UNROLL
    for (std::size_t i = 0; i < static_cast<std::size_t>(lanes); ++i) of_lane[i] = vertices(i);
    const Words are_accepted = narrow(fragments.is_within & fragments.front);
    const Words doubtful = fragments.doubtful & ~are_accepted;
    Words in_front = narrow(fragments.front);
    Floats quotient[Numerators];
    TEXGEN_UNROLL
    for (std::size_t k = 0; k < Numerators; ++k)
        quotient[k] = select(are_accepted, to_floats(fragments.u[k]), fragments.quotient[k]);
    Words undecided{};
    if (any(doubtful)) undecided = divide_lanes_closely(of_lane, x, y, is_one, doubtful, quotient, in_front);
    out.put(n, quotient, in_front);
    return undecided;
}

template <std::size_t Numerators>
TEXGEN_INLINE Undecided divide_all_fragments(const FragmentsJob& job, std::size_t first) noexcept {
    constexpr auto size = static_cast<std::size_t>(lanes);
    BatchPlanes none{};
    none.value[BatchPlanes::q] = -1.0;  // behind everywhere, without a doubt
    const FragmentOutputs out(job);
    ScratchOutputs<size> scratch;
    const FragmentOutputs in_scratch = scratch.in_place_of(out);
    FragmentWalk<Doubles, double> walk(job.width, 1.0 / job.width, static_cast<double>(first));
    const double left = job.x + 0.5;
    const double top = job.y + 0.5;
    const auto planes_of = [&](std::uint32_t id) { return id < job.triangles ? &job.planes[id] : &none; };
    for (std::size_t n = first; n < job.count;) {
        const std::size_t begin = n;
        const std::size_t end = job.count - begin < exact_block ? job.count : begin + exact_block;
        std::uint64_t doubtful = 0;
        for (; n < end; n += size, walk.advance()) {
            std::uint32_t last_ids[lanes];
            const std::uint32_t* ids = job.ids + n;
            if (n + size > job.count) {
                for (std::size_t i = 0; i < size; ++i) last_ids[i] = n + i < job.count ? ids[i] : ids[0];
                ids = last_ids;
            }
            const Doubles x = walk.x + left;
            const Doubles y = walk.y + top;
            const bool is_one = !any(load<Words>(ids) ^ (Words{} + static_cast<int>(ids[0])));
            FragmentLanes<Numerators> fragments;
            if (is_one) {
                fragments.divide(OneTriangle{planes_of(ids[0])->value}, x, y, job.tolerance);
            } else {
                const BatchPlanes* of_lane[lanes];
                TEXGEN_UNROLL
                for (std::size_t i = 0; i < size; ++i) of_lane[i] = planes_of(ids[i]);
                fragments.divide(BatchLanes(of_lane, Numerators == 3), x, y, job.tolerance);
            }
            const bool is_whole = n + size <= job.count;
            const FragmentOutputs& to = is_whole ? out : in_scratch;
            const std::size_t at = is_whole ? n : 0;
            if (!any(fragments.doubtful)) {
                to.put(at, fragments.quotient, narrow(fragments.front));
                continue;
            }
            const auto vertices = [&](std::size_t i) { return vertices_of(job, ids[i] < job.triangles ? ids[i] : 0); };
            const Words undecided = put_doubtful(fragments, x, y, is_one, vertices, to, at);
            doubtful |= std::uint64_t{bits_of(undecided)} << (n - begin);
        }
        if (n > job.count) scratch.copy_to(out, n - size, job.count + size - n);
        if (doubtful != 0) return {begin, doubtful};
    }
    return {job.count, 0};
}

template <class = void>
Undecided divide_batch_fragments(const FragmentsJob& original, std::size_t first) noexcept {
    const FragmentsJob job = original;
    return job.needs_r() ? divide_all_fragments<3>(job, first) : divide_all_fragments<2>(job, first);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
