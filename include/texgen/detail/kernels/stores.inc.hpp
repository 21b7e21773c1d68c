// How vectors of results get to where they belong. Included by kernels.inc.hpp.

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

// Whether a mask is asked for, the layout of points and that of their coordinates are looked at vector by vector: a branch
// that is always the same costs next to nothing, and a loop for each combination would be most of what a user compiles.

// 1 inside the region of an output and in front, else 0.
template <class Output, class Vector, class Mask>
TEXGEN_INLINE Vector lit_of(const Output& to, const Vector (&value)[2], const Mask& in_front) noexcept {
    return one_where(in_front & inside(value[0], to.min[0], to.max[0]) & inside(value[1], to.min[1], to.max[1]));
}

// Stores one vector of coordinates from out[k] + x on, and its mask from lit + x on: inside the region and in front.
template <std::size_t Numerators, class Vector, class Mask>
TEXGEN_INLINE void store_all(const RowOutputs<Numerators>& row, std::int64_t x, const Vector (&value)[Numerators],
                             const Mask& in_front) noexcept {
    for (std::size_t k = 0; k < Numerators; ++k) store(row.out[k] + x, value[k]);
    if constexpr (Numerators == 2)
        if (row.lit != nullptr) store(row.lit + x, lit_of(row, value, in_front));
}

// Up to `end` of a vector that may not be written whole.
template <std::size_t Numerators, class Vector, class Mask>
TEXGEN_INLINE void store_part(const RowOutputs<Numerators>& row, std::int64_t x, std::int64_t end,
                              const Vector (&value)[Numerators], const Mask& in_front) noexcept {
    constexpr std::size_t size = sizeof(Vector) / sizeof(float);
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

// A whole vector where it may be written, else up to `end`.
template <std::size_t Numerators, class Vector, class Mask>
TEXGEN_INLINE void store_from(const RowOutputs<Numerators>& row, std::int64_t x, std::int64_t end,
                              const Vector (&value)[Numerators], const Mask& in_front) noexcept {
    constexpr auto size = static_cast<std::int64_t>(sizeof(Vector) / sizeof(float));
    if (x + size <= row.writable) return store_all(row, x, value, in_front);
    store_part(row, x, end, value, in_front);
}

// The first `count` lanes.
template <class Vector>
TEXGEN_INLINE void store_some(float* to, int count, const Vector& values) noexcept {
    if (count == static_cast<int>(sizeof(Vector) / sizeof(float))) return store(to, values);
    float buffer[sizeof(Vector) / sizeof(float)];
    store(buffer, values);
    for (int i = 0; i < count; ++i) to[i] = buffer[i];
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
