// The caller's arrays: which of them are computed, and how a kernel's results get there, of points and of values along
// a segment. Included by texcoord.hpp.

namespace TEXGEN_DETAIL {

inline bool is_computed(const std::span<float>& output, std::size_t count) noexcept {
    const bool is_empty_or_has_one_float_each = output.empty() || output.size() == count;
    TEXGEN_ASSERT(is_empty_or_has_one_float_each);
    return !output.empty() && is_empty_or_has_one_float_each;
}

// The array of an output that is computed, or null. The span comes by reference, as all aggregates do everywhere: where
// a function takes it by value, out of an aggregate that the caller has by reference, and returns its pointer, GCC 12 at
// -O2 and -Os forgets that what it points to is written, and the user's variables keep what they held (bug 115033 of
// GCC).
inline float* array_of(const std::span<float>& output, std::size_t count) noexcept {
    return is_computed(output, count) ? output.data() : nullptr;
}

// Calls function(span) for each output of Texcoords or Footprints.
TEXGEN_INLINE void for_each_output(auto& out, const auto& function) noexcept {
    if constexpr (requires { out.s; })
        for (auto* output : {&out.s, &out.t, &out.r, &out.lit}) function(*output);
    else
        for (auto* output :
             {&out.dsdx, &out.dtdx, &out.dsdy, &out.dtdy, &out.level, &out.anisotropy, &out.major_s, &out.major_t})
            function(*output);
}

// Empties the outputs that are not asked for, or have another size; false if none is left.
bool drop_unasked(auto& out, std::size_t count) noexcept {
    bool any = false;
    for_each_output(out, [&](std::span<float>& output) {
        if (!is_computed(output, count)) output = {};
        any = any || !output.empty();
    });
    return any;
}

// Where one or two coordinates of all points go. One that only the mask needs has no array; `st` takes pairs.
struct PointOutputs {
    float* coordinate[2] = {};
    float* lit = nullptr;  // where r alone is computed: what is lit so far, and stays so from r_min to r_max
    float* st = nullptr;
    float r_min = 0.0f, r_max = 0.0f;

    bool are_complete(int numerators) const noexcept {
        return st != nullptr || (coordinate[0] != nullptr && (numerators == 1 || coordinate[1] != nullptr));
    }
};

// Calls group(first, numerators, outputs) for the coordinates that are computed together: s and t where both are asked
// for or the mask is, either one alone, and r, which takes from the mask what a depth does not hold.
void for_each_group(const Texcoords& out, std::size_t count, const LitTest& region, const auto& group) noexcept {
    float* const s = array_of(out.s, count);
    float* const t = array_of(out.t, count);
    float* const r = array_of(out.r, count);
    float* const lit = array_of(out.lit, count);
    const bool are_both = lit != nullptr || (s != nullptr && t != nullptr);
    if (are_both || s != nullptr || t != nullptr) {
        const bool is_t = !are_both && s == nullptr;
        group(is_t ? 1 : 0, are_both ? 2 : 1, PointOutputs{{is_t ? t : s, are_both ? t : nullptr}, lit});
    }
    float* const darkened = region.has_depth ? lit : nullptr;
    if (r != nullptr || darkened != nullptr)
        group(2, 1, PointOutputs{{r}, darkened, nullptr, region.r_min, region.r_max});
}

// The part of the points or values that one job does: `count`, padded to `whole`, a multiple of point_quantum; the
// results belong at `first`.
struct JobPart {
    std::size_t first, count, whole;
};

// Copies hold a block of every kernel, so that a certificate serves as many values as it would without them.
inline constexpr std::size_t copy_size = float_block;

inline namespace TEXGEN_BUILD {

// Runs a job for the r of a part, and darkens what is beyond the depth. Where all is dark already it needs no r.
void darken_part(const auto& original, const PointOutputs& out, const JobPart& part, const auto& run) noexcept {
    constexpr std::size_t size = 4 * copy_size;
    const auto [first, count, whole] = part;
    float buffer[size];
    auto job = original;
    job.lit = nullptr;
    for (std::size_t begin = 0; begin < count; begin += size, job.advance(job.count)) {
        job.count = whole - begin < size ? whole - begin : size;
        const std::size_t here = count - begin < job.count ? count - begin : job.count;
        float* const lit = out.lit + first + begin;
        float* const r = out.coordinate[0] != nullptr ? out.coordinate[0] + first + begin : nullptr;
        bool is_needed = r != nullptr;
        for (std::size_t i = 0; i < here && !is_needed; ++i) is_needed = lit[i] > 0.0f;
        if (!is_needed) continue;
        job.out[0] = r != nullptr && here == job.count ? r : buffer;
        run(job);
        chosen<MaskKernels>().darken(lit, job.out[0], here, out.r_min, out.r_max);
        if (r != nullptr && job.out[0] == buffer) std::memcpy(r, buffer, here * sizeof(float));
    }
}

// Has a kernel write the results of a part straight to their places; false where one has none. The job is changed in
// place: a copy would wait for what has just been written in other sizes.
TEXGEN_INLINE bool place(auto& job, const PointOutputs& out, const JobPart& part) noexcept {
    if (part.count != part.whole || !out.are_complete(job.numerators)) return false;
    if (job.numerators == 1 && out.lit != nullptr) return false;
    job.count = part.count;
    job.interleaved_st = out.st != nullptr;
    for (int k = 0; k < job.numerators; ++k)
        job.out[k] = job.interleaved_st ? out.st + 2 * part.first : out.coordinate[k] + part.first;
    job.lit = out.lit != nullptr ? out.lit + part.first : nullptr;
    return true;
}

// Runs a job for a part. Results that have no place of their own go through buffers.
void run_part(auto& job, const PointOutputs& out, const JobPart& part, const auto& run) noexcept {
    if (job.numerators == 1 && out.lit != nullptr) return darken_part(job, out, part, run);
    if (place(job, out, part)) return run(job);
    float buffer[3 * copy_size];
    job.interleaved_st = out.st != nullptr;
    job.out[0] = buffer;
    job.out[1] = buffer + copy_size;
    job.lit = out.lit != nullptr ? buffer + 2 * copy_size : nullptr;
    for (std::size_t begin = 0; begin < part.count; begin += copy_size) {
        job.count = part.whole - begin < copy_size ? part.whole - begin : copy_size;
        run(job);
        const std::size_t first = part.first + begin;
        const std::size_t end = part.count - begin < job.count ? part.count - begin : job.count;
        const auto copy = [&](float* to, const float* from, std::size_t width) {
            if (to != nullptr) std::memcpy(to + width * first, from, width * end * sizeof(float));
        };
        copy(out.st, buffer, 2);
        for (std::size_t k = 0; k < 2; ++k) copy(out.coordinate[k], buffer + k * copy_size, 1);
        copy(out.lit, buffer + 2 * copy_size, 1);
        job.advance(job.count);
    }
}

// Computes the values of a job from `first` on by its kernel, and by one(job, i) those that it cannot decide.
void fill_blocks(auto kernel, const auto& job, std::size_t first, const auto& one) noexcept {
    for (Undecided undecided = kernel(job, first); undecided.begin < job.count; undecided = kernel(job, first)) {
        for (std::uint64_t values = undecided.values; values != 0; values &= values - 1)
            one(job, undecided.begin + static_cast<std::size_t>(std::countr_zero(values)));
        first = (undecided.begin / exact_block + 1) * exact_block;
    }
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL
