#pragma once

// Which vectors the inner loops run on. Instruction sets are told apart here and in instruction_sets.inc.hpp; elsewhere
// only their vectors' size counts, of which 32 and 64 bytes are x86's.
//
// With GCC 12 or Clang the kernels are written on the vectors of the language, and compiled once for the instruction
// set of the flags and, on x86-64, once more for AVX2 and for AVX-512; the machine decides which runs. A table of
// kernels is reached by chosen<Table>(), and is compiled only in files that call a function which needs it. That takes
// a template for every function on the way there: one without another parameter has `class CompiledWhereCalled = void`.
// Macros of the user:
//   TEXGEN_SCALAR            plain loops, as for every other compiler
//   TEXGEN_NO_DISPATCH       only the instruction set of the flags
//   TEXGEN_SEPARATE_KERNELS  the kernels are compiled in one file for all others of the same compiler and flags: in the
//                            file that defines TEXGEN_DEFINE_KERNELS too, before it includes texgen.hpp (and batch.hpp)

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include <glm/vec4.hpp>

#include "../arithmetic/rounding.hpp"
#include "../arithmetic/widen.hpp"
#include "../language.hpp"
#include "box_kernels.hpp"
#include "jobs.hpp"

// TEXGEN_BUILD names the compiler and what the flags decide. Every function that reaches the kernels stands in an
// inline namespace of that name, so that translation units of different ones link, each with its own kernels.
//
// EDG, the front end of nvcc and of others, says that it is its host's compiler, but fails at vectors in templates.
#if !defined(TEXGEN_SCALAR) && (defined(__GNUC__) || defined(__clang__)) && !defined(__NVCC__) && !defined(__EDG__) && \
    defined(__has_builtin)
#if __has_builtin(__builtin_shufflevector)
#define TEXGEN_HAS_VECTORS
#endif
#endif

#ifndef TEXGEN_HAS_VECTORS

#define TEXGEN_FLAGS(name) scalar
#define TEXGEN_BUILD TEXGEN_NAMED(TEXGEN_COMPILER, _scalar)
#define TEXGEN_INLINE inline
#define TEXGEN_FOR for

namespace TEXGEN_DETAIL {

using WideInteger = std::uint64_t;

// Two doubles at a time, for s and t. Laid out as the vector below.
struct alignas(16) Double2 {
    double lane[2];

    double operator[](std::size_t i) const noexcept { return lane[i]; }
    friend Double2 operator-(const Double2& a) noexcept { return {{-a.lane[0], -a.lane[1]}}; }
    friend Double2 operator+(const Double2& a, const Double2& b) noexcept { return {{a[0] + b[0], a[1] + b[1]}}; }
    friend Double2 operator-(const Double2& a, const Double2& b) noexcept { return {{a[0] - b[0], a[1] - b[1]}}; }
    friend Double2 operator*(const Double2& a, const Double2& b) noexcept { return {{a[0] * b[0], a[1] * b[1]}}; }
    friend Double2 operator+(const Double2& a, double b) noexcept { return {{a[0] + b, a[1] + b}}; }
    friend Double2 operator*(const Double2& a, double b) noexcept { return {{a[0] * b, a[1] * b}}; }
    friend Double2 operator/(const Double2& a, double b) noexcept { return {{a[0] / b, a[1] / b}}; }
};
inline Double2 double2_of(double first, double second) noexcept { return {{first, second}}; }
inline Double2 magnitude(const Double2& a) noexcept { return {{magnitude(a[0]), magnitude(a[1])}}; }
template <int Bits>
Double2 leading_bits(const Double2& a) noexcept {
    return {{leading_bits<Bits>(a[0]), leading_bits<Bits>(a[1])}};
}
inline Double2 with_lanes_exchanged(const Double2& a) noexcept { return {{a[1], a[0]}}; }
inline Double2 smaller(const Double2& a, const Double2& b) noexcept {
    return {{smaller(a[0], b[0]), smaller(a[1], b[1])}};
}
inline Double2 larger(const Double2& a, const Double2& b) noexcept {
    return {{larger(a[0], b[0]), larger(a[1], b[1])}};
}
inline bool any_less(const Double2& a, const Double2& b) noexcept { return a[0] < b[0] || a[1] < b[1]; }
inline bool all_less(const Double2& a, const Double2& b) noexcept { return a[0] < b[0] && a[1] < b[1]; }

// Four floats at a time.
struct alignas(16) Float4 {
    float lane[4];

    float operator[](std::size_t i) const noexcept { return lane[i]; }
    float& operator[](std::size_t i) noexcept { return lane[i]; }
    Float4 operator+(const Float4& b) const noexcept {
        return {{lane[0] + b[0], lane[1] + b[1], lane[2] + b[2], lane[3] + b[3]}};
    }
    Float4 operator+(float b) const noexcept { return *this + Float4{{b, b, b, b}}; }
    Float4 operator*(float b) const noexcept { return {{lane[0] * b, lane[1] * b, lane[2] * b, lane[3] * b}}; }
};
inline Float4 smaller(Float4 a, const Float4& b) noexcept {
    for (std::size_t i = 0; i < 4; ++i) a[i] = a[i] < b[i] ? a[i] : b[i];
    return a;
}
inline bool are_between(const Float4& a, const Float4& min, const Float4& max) noexcept {
    bool result = true;
    for (std::size_t i = 0; i < 4; ++i) result = result && a[i] >= min[i] && a[i] <= max[i];
    return result;
}

}  // namespace TEXGEN_DETAIL

#else

#if defined(__AVX512F__) && defined(__AVX512VL__) && defined(__AVX512DQ__) && defined(__AVX512BW__)
#define TEXGEN_FLAGS(name) name##avx512
#define TEXGEN_BYTES_BY_FLAGS 64
#elif defined(__AVX2__) && defined(__FMA__)
#define TEXGEN_FLAGS(name) name##avx2
#define TEXGEN_BYTES_BY_FLAGS 32
#elif defined(__AVX__) && defined(__FMA__)
#define TEXGEN_FLAGS(name) name##avx_fma
#define TEXGEN_BYTES_BY_FLAGS 32
#elif defined(__AVX__)
#define TEXGEN_FLAGS(name) name##avx
#define TEXGEN_BYTES_BY_FLAGS 32
#elif defined(__SSE4_1__)
#define TEXGEN_FLAGS(name) name##sse4
#define TEXGEN_BYTES_BY_FLAGS 16
#elif defined(__aarch64__)
#define TEXGEN_FLAGS(name) name##neon
#define TEXGEN_BYTES_BY_FLAGS 16
#else
#define TEXGEN_FLAGS(name) name##base
#define TEXGEN_BYTES_BY_FLAGS 16
#endif

// The stack of Win64 is aligned to 16 bytes, but GCC keeps wider vectors there as if it were to theirs (its bug 54412).
#if defined(_WIN64) && !defined(__clang__)
#define TEXGEN_STACK_HOLDS_NARROW_VECTORS
#undef TEXGEN_BYTES_BY_FLAGS
#define TEXGEN_BYTES_BY_FLAGS 16
#endif

#define TEXGEN_INLINE [[gnu::always_inline]] inline

// What GCC and Clang have different words for:
//   TEXGEN_FOR            a loop over an array of vectors: else GCC keeps it, and the array in memory, below -O3
//   TEXGEN_DOUBLES_*      floats, or integers, as 64, 32 or 16 bytes of doubles: GCC 12's generic way is in parts
//   TEXGEN_SIXTEEN_LANES  all of sixteen lanes: GCC's masks are signed
//   TEXGEN_MASKED_OR      (a & bits) | b of 512 bits: GCC 12 would make it two instructions
//   TEXGEN_ANY_BITS       the lanes among sixteen of a mask in which a has any of these bits
#ifdef __clang__
#define TEXGEN_FOR for
#define TEXGEN_DOUBLES_64(values) __builtin_convertvector(values, Doubles)
#define TEXGEN_DOUBLES_32(values) TEXGEN_DOUBLES_64(values)
#define TEXGEN_DOUBLES_16(values) TEXGEN_DOUBLES_64(values)
#define TEXGEN_DOUBLES_OF_WORDS_64(values) TEXGEN_DOUBLES_64(values)
#define TEXGEN_DOUBLES_OF_WORDS_32(values) TEXGEN_DOUBLES_64(values)
#define TEXGEN_DOUBLES_OF_WORDS_16(values) TEXGEN_DOUBLES_64(values)
#define TEXGEN_SIXTEEN_LANES 0xffff
#define TEXGEN_MASKED_OR(a, bits, b) (((a) & (bits)) | (b))
#define TEXGEN_ANY_BITS(a, bits, mask) __builtin_ia32_cmpd512_mask((a) & (bits), WideWords{}, 4, mask)
#else
#define TEXGEN_FOR _Pragma("GCC unroll 32") for
#define TEXGEN_DOUBLES_64(values) __builtin_ia32_cvtps2pd512_mask(values, Doubles{}, static_cast<char>(-1), 4)
#define TEXGEN_DOUBLES_32(values) __builtin_ia32_cvtps2pd256(values)
#define TEXGEN_DOUBLES_OF_WORDS_64(values) __builtin_ia32_cvtdq2pd512_mask(values, Doubles{}, 0xff)
#define TEXGEN_DOUBLES_OF_WORDS_32(values) __builtin_ia32_cvtdq2pd256(values)
#if defined(__SSE2__)
#define TEXGEN_DOUBLES_16(values) __builtin_ia32_cvtps2pd(__builtin_shufflevector(values, values, 0, 1, -1, -1))
#define TEXGEN_DOUBLES_OF_WORDS_16(values) \
    __builtin_ia32_cvtdq2pd(__builtin_shufflevector(values, values, 0, 1, -1, -1))
#else
#define TEXGEN_DOUBLES_16(values) __builtin_convertvector(values, Doubles)
#define TEXGEN_DOUBLES_OF_WORDS_16(values) __builtin_convertvector(values, Doubles)
#endif
#define TEXGEN_SIXTEEN_LANES (-1)
#define TEXGEN_MASKED_OR(a, bits, b) __builtin_ia32_pternlogq512_mask(a, bits, b, 0xea, 0xff)
#define TEXGEN_ANY_BITS(a, bits, mask) __builtin_ia32_ptestmd512(a, bits, mask)
#endif

namespace TEXGEN_DETAIL {

// The widest integer without a sign.
#ifdef __SIZEOF_INT128__
__extension__ using WideInteger = unsigned __int128;
#else
using WideInteger = std::uint64_t;
#endif

// Two doubles at a time, for s and t. As calls are inlined, -Wpsabi, about how they are returned, does not matter.
using Double2 [[gnu::vector_size(16)]] = double;
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"
TEXGEN_INLINE Double2 double2_of(double first, double second) noexcept { return Double2{first, second}; }
#pragma GCC diagnostic pop
TEXGEN_INLINE Double2 smaller(const Double2& a, const Double2& b) noexcept { return a < b ? a : b; }
TEXGEN_INLINE Double2 larger(const Double2& a, const Double2& b) noexcept { return a > b ? a : b; }
using Bits2 [[gnu::vector_size(16)]] = long long;
// Bit i is that of lane i of a mask.
TEXGEN_INLINE int bits_of(const Bits2& mask) noexcept {
#ifdef __SSE2__
    return __builtin_ia32_movmskpd(__builtin_bit_cast(Double2, mask));
#else
    return static_cast<int>((mask[0] & 1) | (mask[1] & 2));
#endif
}
using Float4 [[gnu::vector_size(16)]] = float;
TEXGEN_INLINE Float4 smaller(const Float4& a, const Float4& b) noexcept { return a < b ? a : b; }
TEXGEN_INLINE bool are_between(const Float4& a, const Float4& min, const Float4& max) noexcept {
    const auto mask = (a >= min) & (a <= max);
#ifdef __SSE2__
    return __builtin_ia32_movmskps(__builtin_bit_cast(Float4, mask)) == 15;
#else
    return (mask[0] & mask[1] & mask[2] & mask[3]) != 0;
#endif
}
TEXGEN_INLINE bool any_less(const Double2& a, const Double2& b) noexcept { return bits_of(a < b) != 0; }
TEXGEN_INLINE bool all_less(const Double2& a, const Double2& b) noexcept { return bits_of(a < b) == 3; }
TEXGEN_INLINE Double2 magnitude(const Double2& a) noexcept {
    return __builtin_bit_cast(Double2, __builtin_bit_cast(Bits2, a) & 0x7fffffffffffffffLL);
}
template <int Bits>
TEXGEN_INLINE Double2 leading_bits(const Double2& a) noexcept {
    return __builtin_bit_cast(Double2, __builtin_bit_cast(Bits2, a) & -(1LL << (53 - Bits)));
}
TEXGEN_INLINE Double2 with_lanes_exchanged(const Double2& a) noexcept { return __builtin_shufflevector(a, a, 1, 0); }

}  // namespace TEXGEN_DETAIL

// The compilers of CUDA and HIP read a file for the device too, with the macros of the host's processor.
#if defined(__x86_64__) && !defined(TEXGEN_NO_DISPATCH) && !defined(__AVX512F__) && \
    !defined(TEXGEN_STACK_HOLDS_NARROW_VECTORS) && !defined(__CUDACC__) && !defined(__HIP__)
#define TEXGEN_DISPATCHES
#define TEXGEN_BUILD TEXGEN_NAMED(TEXGEN_COMPILER, TEXGEN_FLAGS(_dispatched_))
#else
#define TEXGEN_BUILD TEXGEN_NAMED(TEXGEN_COMPILER, TEXGEN_FLAGS(_))
#endif

#endif

// The library's namespaces with what each build has of its own.
#define TEXGEN_DETAIL_BUILD TEXGEN_DETAIL::inline TEXGEN_BUILD
#define TEXGEN_NAMESPACE_BUILD TEXGEN_NAMESPACE::inline TEXGEN_BUILD

namespace TEXGEN_DETAIL {

using DoubleDouble2 = DoubleDoubleOf<Double2>;

// Bit i is set where lane i is negative.
inline std::uint32_t negative_lanes(const Float4& a) noexcept {
#if defined(TEXGEN_HAS_VECTORS) && defined(__SSE2__)
    return static_cast<std::uint32_t>(__builtin_ia32_movmskps(a));
#else
    std::uint32_t result = 0;
    for (std::uint32_t i = 0; i < 4; ++i) result |= static_cast<std::uint32_t>(a[i] < 0.0f) << i;
    return result;
#endif
}

// Four doubles at a time, for s, t, r and q. They are one vector only where the flags have AVX: functions that are
// compiled without it cannot pass one on.
#if defined(TEXGEN_HAS_VECTORS) && defined(__AVX__)
using Double4 [[gnu::vector_size(32)]] = double;
TEXGEN_INLINE Double4 magnitude(const Double4& a) noexcept {
    using Bits4 [[gnu::vector_size(32)]] = long long;
    return __builtin_bit_cast(Double4, __builtin_bit_cast(Bits4, a) & 0x7fffffffffffffffLL);
}
TEXGEN_INLINE Double4 four_widened(const glm::vec4& v) noexcept {
    using Given [[gnu::vector_size(16), gnu::aligned(4), gnu::may_alias]] = float;
    using Doubles [[maybe_unused]] = Double4;
    return TEXGEN_DOUBLES_32(reinterpret_cast<const volatile Given&>(v));
}
TEXGEN_INLINE Double2 first_two(const Double4& a) noexcept { return __builtin_shufflevector(a, a, 0, 1); }
TEXGEN_INLINE Double2 last_two(const Double4& a) noexcept { return __builtin_shufflevector(a, a, 2, 3); }
#else
struct Double4 {
    Double2 two[2];

    Double4 operator+(const Double4& b) const noexcept { return {{two[0] + b.two[0], two[1] + b.two[1]}}; }
    Double4 operator-(const Double4& b) const noexcept { return {{two[0] - b.two[0], two[1] - b.two[1]}}; }
    Double4 operator*(double b) const noexcept { return {{two[0] * b, two[1] * b}}; }
};
inline Double4 magnitude(const Double4& a) noexcept { return {{magnitude(a.two[0]), magnitude(a.two[1])}}; }
inline Double4 four_widened(const glm::vec4& v) noexcept {
    return {{double2_of(widened(v.x), widened(v.y)), double2_of(widened(v.z), widened(v.w))}};
}
inline Double2 first_two(const Double4& a) noexcept { return a.two[0]; }
inline Double2 last_two(const Double4& a) noexcept { return a.two[1]; }
#endif

}  // namespace TEXGEN_DETAIL

#define TEXGEN_KERNELS "../kernels/kernels.inc.hpp"
#include "instruction_sets.inc.hpp"
#undef TEXGEN_KERNELS

namespace TEXGEN_DETAIL_BUILD {

namespace of_flags = TEXGEN_FLAGS(flags_);

template <class Table>
const Table& chosen() noexcept {
#ifdef TEXGEN_DISPATCHES
    static const Table& table = []() -> const Table& {
        __builtin_cpu_init();
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
            __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
            return avx512::kernel_table<Table>;
        if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return avx2::kernel_table<Table>;
        return of_flags::kernel_table<Table>;
    }();
    return table;
#else
    return of_flags::kernel_table<Table>;
#endif
}

struct ThisBuild;  // the argument of member templates that each build compiles, of classes that all builds share

}  // namespace TEXGEN_DETAIL_BUILD

#ifdef TEXGEN_SEPARATE_KERNELS
#ifdef TEXGEN_DEFINE_KERNELS
#define TEXGEN_EXTERN
#else
#define TEXGEN_EXTERN extern
#endif
namespace TEXGEN_DETAIL_BUILD {
TEXGEN_EXTERN template const TileKernels& chosen<TileKernels>() noexcept;
TEXGEN_EXTERN template const PointKernels& chosen<PointKernels>() noexcept;
TEXGEN_EXTERN template const SegmentKernels& chosen<SegmentKernels>() noexcept;
TEXGEN_EXTERN template const MaskKernels& chosen<MaskKernels>() noexcept;
TEXGEN_EXTERN template const FootprintKernels& chosen<FootprintKernels>() noexcept;
TEXGEN_EXTERN template const FormKernels& chosen<FormKernels>() noexcept;
TEXGEN_EXTERN template const FloatFormKernels& chosen<FloatFormKernels>() noexcept;
TEXGEN_EXTERN template const SeparatingPlaneKernels& chosen<SeparatingPlaneKernels>() noexcept;
TEXGEN_EXTERN template const BoxKernels& chosen<BoxKernels>() noexcept;
TEXGEN_EXTERN template const BoxBatchKernels& chosen<BoxBatchKernels>() noexcept;
TEXGEN_EXTERN template const SphereKernels& chosen<SphereKernels>() noexcept;
}  // namespace TEXGEN_DETAIL_BUILD
#endif
