// How vectors of results get to where they belong. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// Loops over points look vector by vector at the layouts of points and coordinates, and whether a mask is asked for: a
// branch that is always the same costs next to nothing, and a loop for each combination would be most of what a user
// compiles.

// A mask of what is inside the region of an output, by its first two coordinates.
template <class Output, class Vector, std::size_t Numerators>
TEXGEN_INLINE auto in_region(const Output& to, const Vector (&value)[Numerators]) noexcept {
    return inside(value[0], to.min[0], to.max[0]) & inside(value[1], to.min[1], to.max[1]);
}
// 1 inside the region and in front, else 0.
template <class Output, class Vector, class Mask>
TEXGEN_INLINE Vector lit_of(const Output& to, const Vector (&value)[2], const Mask& in_front) noexcept {
    return one_where(in_front & in_region(to, value));
}

// Where the vector behind the one at `at` begins, so that it does not span two lines of a cache; at `last` at most, where
// it overlaps. Vectors that span two, stored to one array and another in turn, take twice as long where the first cache
// does not hold these.
template <class Vector>
TEXGEN_INLINE std::ptrdiff_t next_in_line(const float* to, std::ptrdiff_t at, std::ptrdiff_t last) noexcept {
    const std::uintptr_t behind = reinterpret_cast<std::uintptr_t>(to + at) % sizeof(Vector);
    at += static_cast<std::ptrdiff_t>((sizeof(Vector) - behind) / sizeof(float));
    return at < last ? at : last;
}

template <class Vector>
TEXGEN_INLINE bool begins_with_line(const float* to) noexcept {
    return reinterpret_cast<std::uintptr_t>(to) % sizeof(Vector) == 0;
}

// Stores the first `count` lanes, by parts of fixed sizes: lane by lane, compilers make a call of memcpy of it.
template <class Vector>
TEXGEN_INLINE void store_some(float* to, int count, const Vector& values) noexcept {
    constexpr auto size = sizeof(Vector) / sizeof(float);
    if (count == static_cast<int>(size)) return store(to, values);
    float buffer[size];
    store(buffer, values);
    const float* from = buffer;
    TEXGEN_FOR (int part = static_cast<int>(size) / 2; part > 0; part /= 2) {
        if ((count & part) == 0) continue;
        std::memcpy(to, from, static_cast<std::size_t>(part) * sizeof(float));
        to += part;
        from += part;
    }
}

// Makes the mask of `count` fragments or values in front from their stored coordinates, so that the loops that compute
// these know no mask. The last vector ends with them, and overlaps. False where they are fewer than a vector has.
template <class Vector>
TEXGEN_INLINE bool light_in(const float (&min)[2], const float (&max)[2], const float* s, const float* t, float* lit,
                            std::int64_t count) noexcept {
    constexpr auto size = static_cast<std::int64_t>(sizeof(Vector) / sizeof(float));
    if (count < size) return false;
    const std::int64_t last = count - size;
    for (std::int64_t at = 0;; at = at + size < last ? at + size : last) {
        const Vector value[2] = {load<Vector>(s + at), load<Vector>(t + at)};
        store(lit + at, one_where(inside(value[0], min[0], max[0]) & inside(value[1], min[1], max[1])));
        if (at == last) return true;
    }
}
template <class CompiledWhereCalled = void>
TEXGEN_APART void light_apart(const float (&min)[2], const float (&max)[2], const float* s, const float* t, float* lit,
                              std::int64_t count) noexcept {
    if (light_in<WideFloats>(min, max, s, t, lit, count) || light_in<Floats>(min, max, s, t, lit, count)) return;
    for (std::int64_t x = 0; x < count; ++x) {
        const bool is_lit = s[x] >= min[0] && s[x] <= max[0] && t[x] >= min[1] && t[x] <= max[1];
        lit[x] = is_lit ? 1.0f : 0.0f;
    }
}
// Makes the mask of a part of a row, where one is asked for.
template <class CompiledWhereCalled = void>
TEXGEN_INLINE void light(const TileJob& job, const RowOutputs& row, std::int64_t x, std::int64_t end) noexcept {
    if (row.lit != nullptr) light_apart(job.min, job.max, row.out[0] + x, row.out[1] + x, row.lit + x, end - x);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
