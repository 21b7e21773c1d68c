#pragma once

// Which vectors the inner loops run on. The only file with #if on instruction sets.
//
// With GCC 12 or Clang the kernels are written on the vectors of the language, and compiled once for the instruction set of
// the flags and, on x86-64, once more for AVX2 and for AVX-512; the machine decides which runs. A table of kernels is
// reached by chosen<Table>(), and compiled only in files that call something which needs it: so all ways there are
// templates. Macros of the user:
//   TEXGEN_SCALAR            plain loops, as for every other compiler
//   TEXGEN_NO_DISPATCH       only the instruction set of the flags
//   TEXGEN_SEPARATE_KERNELS  the kernels are compiled in one file for all others of the same compiler and flags: in the
//                            file that defines TEXGEN_DEFINE_KERNELS too, before it includes texgen

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "../arithmetic/rounding.hpp"
#include "../language.hpp"
#include "box_kernels.hpp"

namespace TEXGEN_DETAIL {

// Linear functions over a rectangle of fragments: base at its first fragment.
template <class Number>
struct RampOf {
    Number base, dx, dy;
};
using Ramp = RampOf<double>;

// numerator[k] / q over a rectangle; out[k], and lit (or null) from the closed region. With one numerator the second is the
// same again. Rows of the outputs are pitch apart; those of an output that only the mask needs are one and the same.
struct TileJob {
    int numerators;
    int width, height;
    int chunk;    // the most fragments of a row that share a middle
    int factors;  // of divide_chunks, for all of them, or any
    Ramp numerator[2];
    Ramp q;
    bool q_is_constant;
    double quotient_error[2];   // for divide_nearest
    double numerator_error[2];  // for divide_chunks, as what follows
    double q_error;
    double least_q;  // below it no certificate holds
    double tolerance;
    float* out[2];
    bool is_scratch[2];
    float* lit;
    std::ptrdiff_t pitch;
    bool is_contiguous;    // rows follow one another in all outputs
    float min[2], max[2];  // the region

    // The job is done, checked and resumed in units of about 64 fragments: a part of a row, or several short rows.
    // After the last unit comes an empty one.
    struct Unit {
        int x_begin, x_end, y_begin, y_end;
    };

    static constexpr int unit_size = 64;
    static constexpr int any_factors = -1;

    Unit unit_at(int x, int y) const noexcept {
        const int rows = width >= unit_size ? 1 : unit_size / width;
        return {x, unit_size < width - x ? x + unit_size : width, y, rows < height - y ? y + rows : height};
    }
    Unit unit_after(const Unit& unit) const noexcept {
        return unit.x_end < width ? unit_at(unit.x_end, unit.y_begin) : unit_at(0, unit.y_end);
    }
    bool is_done(const Unit& unit) const noexcept { return unit.y_begin >= height; }
};

// The same functions of a tile to twice the precision: each is high + low, within `error` of the exact one, and a multiple of
// `grain`. The coefficients of high are multiples of a unit in which no value of the tile needs more than 52 bits, so that
// its arithmetic is exact; those of low are what is left below the unit.
struct CloseFunction {
    Ramp high, low;
    double error, grain;
};
struct CloseFunctions {
    CloseFunction numerator[2];
    CloseFunction q;
    double q_unit;  // adding and taking it rounds high of q to 26 bits
};

// A linear form of points (x, y, z, 1).
struct PointForm {
    double x, y, z, w;
};

// The number of points, and of values along a segment, that a kernel does is a multiple of point_quantum.
inline constexpr std::size_t point_quantum = 16;
inline constexpr std::size_t nearest_block = 64;
inline constexpr std::size_t float_block = 256;

// One or two divided coordinates in arrays, and their mask.
struct DividedOutput {
    std::size_t count;
    int numerators;
    bool pairs;  // both coordinates follow one another from out[0] on; else there is an array for each
    float* out[2];
    float* lit;            // or null
    float min[2], max[2];  // the region
};

// numerator[k] / q at points.
struct PointJob : DividedOutput {
    bool triples;  // x, y, z follow one another from `x` on; else there are three arrays
    const float* x;
    const float* y;
    const float* z;
    PointForm numerator[2];
    PointForm q;
    double tolerance;

    void advance(std::size_t points) noexcept {
        x += triples ? 3 * points : points;
        y += points;
        z += points;
    }
};

// numerator[k] / q along a segment: values at alpha = 0 and at alpha = 1.
struct SegmentJob : DividedOutput {
    const float* alpha;
    double a[2], b[2];
    double q_a, q_b;
    double tolerance;
    bool in_front;  // all of it, well enough that quotient_error bounds the error in double of every value
    double quotient_error[2];
    // For divide_float: about the end where q is less, base + slope i / (1 + bend i), i the alpha from there.
    bool about_b;
    float bend, base[2], slope[2];

    void advance(std::size_t values) noexcept { alpha += values; }
};

// The forms themselves, rounded to float. An output is null or an array; or all go to `quads`, four after one another.
struct GenerateJob {
    std::size_t count;
    bool triples;
    const float* x;
    const float* y;
    const float* z;
    PointForm form[4];
    float* out[4];
    float* quads;
};

// The derivatives of s (0) and t (1) over a rectangle, and what filters make of them. Of d/dx Q^2 and d/dy Q^2 the one
// grows by twist a row, the other shrinks by twist a column. An output is null or an array whose rows are pitch apart.
struct FootprintJob {
    struct Slope {
        double dx, dy, twist;
    };

    // The sum of two squares of `texels` that the filters need in float, when the largest of the job is about 1.
    static constexpr float smallest_square = 0x1p-24f;

    int width, height;
    Ramp q;
    Slope slope[2];
    Slope texels[2];  // the same in texels, times a factor that level_offset and the factors below make good
    bool derivatives_in_float, filters_in_float;
    float level_offset, anisotropy_factor, major_factor[2];
    float* dx[2];
    float* dy[2];
    float* level;
    float* anisotropy;
    float* major[2];
    std::ptrdiff_t pitch;

    float* row(float* output, int y) const noexcept { return output == nullptr ? nullptr : output + y * pitch; }
};

struct TileKernels {
    TileJob::Unit (*divide_nearest)(const TileJob&, TileJob::Unit first) noexcept;
    void (*divide_rounded)(const TileJob&) noexcept;
    TileJob::Unit (*divide_chunks)(const TileJob&, TileJob::Unit first) noexcept;
    // A unit on either side of the projector. A bit for each fragment that stays in doubt, row by row.
    std::uint64_t (*divide_closely)(const TileJob&, const CloseFunctions&, TileJob::Unit unit) noexcept;
};

// Where a kernel stops: at the first block with values that it cannot decide (bit i: value begin + i), or at the count.
// Blocks end at multiples of nearest_block.
struct Undecided {
    std::size_t begin;
    std::uint64_t values;
};

struct PointKernels {
    Undecided (*divide_nearest)(const PointJob&, std::size_t first) noexcept;
    // The first point from `first` on of a block of float_block points that is not inside the tolerance, or the count.
    std::size_t (*divide_float)(const PointJob&, std::size_t first) noexcept;
    std::size_t (*divide_rounded)(const PointJob&, std::size_t first) noexcept;
    void (*generate)(const GenerateJob&) noexcept;
};

struct SegmentKernels {
    Undecided (*divide_nearest)(const SegmentJob&, std::size_t first) noexcept;
    // The first value from `first` on of a block of float_block with an alpha that is no number, or the count.
    std::size_t (*divide_float)(const SegmentJob&, std::size_t first) noexcept;
};

struct FootprintKernels {
    void (*differentiate)(const FootprintJob&) noexcept;
    // The first row from `first` on with a fragment that floats do not serve, or the height.
    int (*filter)(const FootprintJob&, int first) noexcept;
};

}  // namespace TEXGEN_DETAIL

// TEXGEN_BUILD names the compiler and what the flags decide. Every function that reaches the kernels stands in an inline
// namespace of that name, so that translation units of different ones link, each with its own kernels.
#if !defined(TEXGEN_SCALAR) && (defined(__GNUC__) || defined(__clang__)) && defined(__has_builtin)
#if __has_builtin(__builtin_shufflevector)
#define TEXGEN_HAS_VECTORS
#endif
#endif

#ifndef TEXGEN_HAS_VECTORS

#define TEXGEN_BUILD TEXGEN_NAMED(TEXGEN_COMPILER, _scalar)
#define TEXGEN_INLINE inline
#define TEXGEN_APART

namespace TEXGEN_DETAIL {

// Two doubles at a time, for s and t. Laid out as those below.
struct alignas(16) Pair {
    double lane[2];

    double operator[](std::size_t i) const noexcept { return lane[i]; }
    friend Pair operator-(const Pair& a) noexcept { return {{-a.lane[0], -a.lane[1]}}; }
    friend Pair operator+(const Pair& a, const Pair& b) noexcept { return {{a[0] + b[0], a[1] + b[1]}}; }
    friend Pair operator-(const Pair& a, const Pair& b) noexcept { return {{a[0] - b[0], a[1] - b[1]}}; }
    friend Pair operator*(const Pair& a, const Pair& b) noexcept { return {{a[0] * b[0], a[1] * b[1]}}; }
    friend Pair operator+(const Pair& a, double b) noexcept { return {{a[0] + b, a[1] + b}}; }
    friend Pair operator*(const Pair& a, double b) noexcept { return {{a[0] * b, a[1] * b}}; }
    friend Pair operator/(const Pair& a, double b) noexcept { return {{a[0] / b, a[1] / b}}; }
};
inline Pair pair_of(double first, double second) noexcept { return {{first, second}}; }
inline Pair magnitude(const Pair& a) noexcept { return {{magnitude(a[0]), magnitude(a[1])}}; }
inline Pair smaller(const Pair& a, const Pair& b) noexcept { return {{smaller(a[0], b[0]), smaller(a[1], b[1])}}; }
inline Pair larger(const Pair& a, const Pair& b) noexcept { return {{larger(a[0], b[0]), larger(a[1], b[1])}}; }

}  // namespace TEXGEN_DETAIL

#define TEXGEN_ISA scalar
#include "loops.inc.hpp"

#include "../kernels/kernels.inc.hpp"
#undef TEXGEN_ISA
#undef TEXGEN_INLINE
#undef TEXGEN_APART

namespace TEXGEN_DETAIL {
inline namespace TEXGEN_BUILD {
template <class Table>
const Table& chosen() noexcept {
    return scalar::kernels<Table>();
}
}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL

#else

#if defined(__AVX512F__) && defined(__AVX512VL__) && defined(__AVX512DQ__) && defined(__AVX512BW__)
#define TEXGEN_FLAGS(name) name##avx512
#define TEXGEN_LANE_BYTES 64
#elif defined(__AVX2__) && defined(__FMA__)
#define TEXGEN_FLAGS(name) name##avx2
#define TEXGEN_LANE_BYTES 32
#elif defined(__AVX__) && defined(__FMA__)
#define TEXGEN_FLAGS(name) name##avx_fma
#define TEXGEN_LANE_BYTES 32
#elif defined(__AVX__)
#define TEXGEN_FLAGS(name) name##avx
#define TEXGEN_LANE_BYTES 32
#elif defined(__SSE4_1__)
#define TEXGEN_FLAGS(name) name##sse4
#define TEXGEN_LANE_BYTES 16
#elif defined(__aarch64__)
#define TEXGEN_FLAGS(name) name##neon
#define TEXGEN_LANE_BYTES 16
#else
#define TEXGEN_FLAGS(name) name##base
#define TEXGEN_LANE_BYTES 16
#endif

// The stack of Win64 is aligned to 16 bytes, but GCC keeps wider vectors there as if it were to theirs (its bug 54412).
#if defined(_WIN64) && !defined(__clang__)
#define TEXGEN_STACK_HOLDS_NARROW_VECTORS
#undef TEXGEN_LANE_BYTES
#define TEXGEN_LANE_BYTES 16
#endif

#define TEXGEN_INLINE [[gnu::always_inline]] inline
#define TEXGEN_APART [[gnu::noinline]]  // what is rare, so that it costs the rest no registers

// GCC 12 converts eight floats the generic way in two halves.
#ifdef __clang__
#define TEXGEN_EIGHT_DOUBLES(values) __builtin_convertvector(values, Doubles)
#else
#define TEXGEN_EIGHT_DOUBLES(values) __builtin_ia32_cvtps2pd512_mask(values, Doubles{}, char{-1}, 4)
#endif

namespace TEXGEN_DETAIL {

// Two doubles at a time, for s and t.
using Pair [[gnu::vector_size(16)]] = double;
TEXGEN_INLINE Pair pair_of(double first, double second) noexcept { return Pair{first, second}; }
TEXGEN_INLINE Pair smaller(const Pair& a, const Pair& b) noexcept { return a < b ? a : b; }
TEXGEN_INLINE Pair larger(const Pair& a, const Pair& b) noexcept { return a > b ? a : b; }
TEXGEN_INLINE Pair magnitude(const Pair& a) noexcept { return larger(a, -a); }

}  // namespace TEXGEN_DETAIL

// Vector arguments never cross a call that is not inlined, so their calling convention does not matter.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

#define TEXGEN_ISA TEXGEN_FLAGS(flags_)
#include "vectors.inc.hpp"

#include "../kernels/kernels.inc.hpp"
#undef TEXGEN_ISA
#undef TEXGEN_LANE_BYTES

// The compilers of CUDA and HIP read a file for the device too, as if its processor were this one.
#if defined(__x86_64__) && !defined(TEXGEN_NO_DISPATCH) && !defined(__AVX512F__) && \
    !defined(TEXGEN_STACK_HOLDS_NARROW_VECTORS) && !defined(__CUDACC__) && !defined(__HIP__)

#define TEXGEN_BUILD TEXGEN_NAMED(TEXGEN_COMPILER, TEXGEN_FLAGS(_dispatched_))

#define TEXGEN_ISA avx512
#define TEXGEN_LANE_BYTES 64
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx512f,avx512vl,avx512dq,avx512bw,avx2,fma"))), \
                             apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,prefer-vector-width=512")
#endif
#include "vectors.inc.hpp"

#include "../kernels/kernels.inc.hpp"
#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#undef TEXGEN_ISA
#undef TEXGEN_LANE_BYTES

#define TEXGEN_ISA avx2
#define TEXGEN_LANE_BYTES 32
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2,fma"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,fma")
#endif
#include "vectors.inc.hpp"

#include "../kernels/kernels.inc.hpp"
#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#undef TEXGEN_ISA
#undef TEXGEN_LANE_BYTES

namespace TEXGEN_DETAIL {
inline namespace TEXGEN_BUILD {

template <class Table>
const Table& choose() noexcept {
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw"))
        return avx512::kernels<Table>();
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return avx2::kernels<Table>();
    return TEXGEN_FLAGS(flags_)::kernels<Table>();
}

template <class Table>
const Table& chosen() noexcept {
    static const Table& table = choose<Table>();
    return table;
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL

#else

#define TEXGEN_BUILD TEXGEN_NAMED(TEXGEN_COMPILER, TEXGEN_FLAGS(_))

namespace TEXGEN_DETAIL {
inline namespace TEXGEN_BUILD {
template <class Table>
const Table& chosen() noexcept {
    return TEXGEN_FLAGS(flags_)::kernels<Table>();
}
}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL

#endif

#pragma GCC diagnostic pop
#undef TEXGEN_STACK_HOLDS_NARROW_VECTORS
#undef TEXGEN_EIGHT_DOUBLES
#undef TEXGEN_INLINE
#undef TEXGEN_APART

#endif
#undef TEXGEN_HAS_VECTORS

#ifdef TEXGEN_SEPARATE_KERNELS
#ifdef TEXGEN_DEFINE_KERNELS
#define TEXGEN_EXTERN
#else
#define TEXGEN_EXTERN extern
#endif
namespace TEXGEN_DETAIL {
inline namespace TEXGEN_BUILD {
TEXGEN_EXTERN template const TileKernels& chosen<TileKernels>() noexcept;
TEXGEN_EXTERN template const PointKernels& chosen<PointKernels>() noexcept;
TEXGEN_EXTERN template const SegmentKernels& chosen<SegmentKernels>() noexcept;
TEXGEN_EXTERN template const FootprintKernels& chosen<FootprintKernels>() noexcept;
TEXGEN_EXTERN template const BoxKernels& chosen<BoxKernels>() noexcept;
}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL
#undef TEXGEN_EXTERN
#endif
