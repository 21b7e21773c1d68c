// Vectors as GCC and Clang have them in the language. Included by kernels.inc.hpp once per instruction set; the
// plain-loop twin of this file is loops.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

inline constexpr int lanes = TEXGEN_LANE_BYTES / 8;  // of Doubles, and of the Floats that they round to
inline constexpr int wide_lanes = TEXGEN_LANE_BYTES / 4;
inline constexpr std::size_t at_once = lanes, wide_at_once = wide_lanes;  // the same, of arrays

using Doubles [[gnu::vector_size(TEXGEN_LANE_BYTES)]] = double;
using Floats [[gnu::vector_size(TEXGEN_LANE_BYTES / 2)]] = float;
using Words [[gnu::vector_size(TEXGEN_LANE_BYTES / 2)]] = int;  // the bits of Floats, and masks for them
using WideFloats [[gnu::vector_size(TEXGEN_LANE_BYTES)]] = float;
using WideWords [[gnu::vector_size(TEXGEN_LANE_BYTES)]] = int;

template <class Vector>
TEXGEN_INLINE Vector indices() noexcept {
    using Lane = std::remove_reference_t<decltype(Vector()[0])>;
    Vector result{};
    for (int i = 0; i < static_cast<int>(sizeof(Vector) / sizeof(Lane)); ++i) result[i] = static_cast<Lane>(i);
    return result;
}

template <class To, class From>
TEXGEN_INLINE To bits_as(const From& from) noexcept {
    return __builtin_bit_cast(To, from);
}
TEXGEN_INLINE Doubles to_doubles(const Words& values) noexcept {
    return TEXGEN_NAMED(TEXGEN_DOUBLES_OF_WORDS_, TEXGEN_LANE_BYTES)(values);
}
TEXGEN_INLINE Floats to_floats(const Doubles& values) noexcept { return __builtin_convertvector(values, Floats); }
TEXGEN_INLINE Doubles to_doubles(const Floats& values) noexcept {
    return TEXGEN_NAMED(TEXGEN_DOUBLES_, TEXGEN_LANE_BYTES)(values);
}

template <int First, class Vector, int... Lane>
TEXGEN_INLINE auto half(const Vector& values, std::integer_sequence<int, Lane...>) noexcept {
    return __builtin_shufflevector(values, values, (First + Lane)...);
}
template <int... Lane>
TEXGEN_INLINE WideFloats joined(const Floats& low, const Floats& high, std::integer_sequence<int, Lane...>) noexcept {
    return __builtin_shufflevector(low, high, Lane...);
}
// Calls f(Doubles...) for each half of the vectors.
template <class Function, class... Vector>
TEXGEN_INLINE void for_halves(const Function& f, const Vector&... values) noexcept {
    using Half = std::make_integer_sequence<int, lanes>;
    f(to_doubles(half<0>(values, Half()))...);
    f(to_doubles(half<lanes>(values, Half()))...);
}
// What f returns for each half, rounded to float.
template <class Function, class... Vector>
TEXGEN_INLINE WideFloats in_double(const Function& f, const Vector&... values) noexcept {
    Floats result[2], *next = result;
    for_halves([&](const auto&... doubles) { *next++ = to_floats(f(doubles...)); }, values...);
    return joined(result[0], result[1], std::make_integer_sequence<int, wide_lanes>());
}

// Rounds numbers that an int can hold towards zero.
TEXGEN_INLINE Doubles truncated(const Doubles& values) noexcept {
    return to_doubles(__builtin_convertvector(values, Words));
}

// Masks of Doubles are 64 bits wide.
using LongWords [[gnu::vector_size(TEXGEN_LANE_BYTES)]] = long long;
TEXGEN_INLINE LongWords greater(const Doubles& a, const auto& b) noexcept { return a > b; }
TEXGEN_INLINE LongWords at_most(const Doubles& a, const Doubles& b) noexcept { return a <= b; }
TEXGEN_INLINE LongWords are_nonzero(const Doubles& a) noexcept { return a != 0.0; }
TEXGEN_INLINE Doubles where(const LongWords& mask, const Doubles& values) noexcept {
    return __builtin_bit_cast(Doubles, mask & __builtin_bit_cast(LongWords, values));
}
TEXGEN_INLINE Doubles select(const LongWords& mask, const Doubles& a, const Doubles& b) noexcept {
    return mask ? a : b;
}
// Integers modulo 2^64 or 2^32.
using Residues [[gnu::vector_size(TEXGEN_LANE_BYTES)]] = std::uint64_t;
using WideResidues [[gnu::vector_size(TEXGEN_LANE_BYTES)]] = std::uint32_t;

// (a & bits) | b.
TEXGEN_INLINE Doubles masked_or(const Doubles& a, long long bits, const Doubles& b) noexcept {
    const auto words = __builtin_bit_cast(LongWords, a), others = __builtin_bit_cast(LongWords, b);
#if TEXGEN_LANE_BYTES == 64
    return __builtin_bit_cast(Doubles, TEXGEN_MASKED_OR(words, LongWords{} + bits, others));
#else
    return __builtin_bit_cast(Doubles, (words & bits) | others);
#endif
}

// The residues of numbers that are integers below 2^63. AVX2 would convert one after another: instead, the low bits of
// a sum with 0x1.8p52 are those of an integer below 2^51.
TEXGEN_INLINE Residues to_residues(const Doubles& integers) noexcept {
#if TEXGEN_LANE_BYTES == 32
    constexpr double rounder = 0x1.8p52;
    const Doubles high = integers * 0x1p-32 + rounder;
    const Doubles low = (integers - (high - rounder) * 0x1p32) + rounder;
    return (__builtin_bit_cast(Residues, high) << 32) +
           (__builtin_bit_cast(Residues, low) - bit_cast<std::uint64_t>(rounder));
#else
    return __builtin_bit_cast(Residues, __builtin_convertvector(integers, LongWords));
#endif
}
// The doubles next to signed integers. For AVX2 bits make 2^52 + the low half and 2^84 + 2^63 + the high one.
TEXGEN_INLINE Doubles signed_numbers(const Residues& a) noexcept {
#if TEXGEN_LANE_BYTES == 32
    const auto low = __builtin_bit_cast(Doubles, (a & 0xffffffff) | bit_cast<std::uint64_t>(0x1p52));
    const auto high = __builtin_bit_cast(Doubles, (a >> 32) ^ bit_cast<std::uint64_t>(0x1.000008p84));
    return (high - (0x1.000008p84 + 0x1p52)) + low;
#else
    return __builtin_convertvector(__builtin_bit_cast(LongWords, a), Doubles);
#endif
}
TEXGEN_INLINE LongWords are_zero(const Residues& a) noexcept { return a == 0; }
TEXGEN_INLINE LongWords are_positive(const Residues& a) noexcept { return __builtin_bit_cast(LongWords, a) > 0; }

TEXGEN_INLINE Words narrow(const LongWords& mask) noexcept {
#if TEXGEN_LANE_BYTES == 64
    return __builtin_ia32_cvtmask2d256(__builtin_ia32_cvtq2mask512(mask));
#elif TEXGEN_LANE_BYTES == 32
    using Half = std::make_integer_sequence<int, lanes>;
    const auto halves = __builtin_bit_cast(WideFloats, mask);
    return bits_as<Words>(__builtin_shufflevector(half<0>(halves, Half()), half<lanes>(halves, Half()), 0, 2, 4, 6));
#else
    return __builtin_convertvector(mask, Words);
#endif
}
TEXGEN_INLINE Words equal(const Words& a, const auto& b) noexcept { return a == b; }
TEXGEN_INLINE Doubles with_sign_of(const Doubles& size, const Doubles& sign) noexcept {
    constexpr auto bit = static_cast<long long>(0x8000000000000000);
    return masked_or(sign, bit, size);
}
TEXGEN_INLINE auto minimum(const auto& a, const auto& b) noexcept { return a < b ? a : b; }
TEXGEN_INLINE auto maximum(const auto& a, const auto& b) noexcept { return a > b ? a : b; }

TEXGEN_INLINE WideFloats to_numbers(const WideWords& words) noexcept {
    return __builtin_convertvector(words, WideFloats);
}
TEXGEN_INLINE WideWords halved(const WideWords& words) noexcept { return words >> 1; }
TEXGEN_INLINE WideWords are_negative(const WideFloats& a) noexcept { return a < 0.0f; }

// The larger of |a| and b, or b where a is no number.
TEXGEN_INLINE WideFloats larger_magnitude(const WideFloats& a, const WideFloats& b) noexcept {
#if TEXGEN_LANE_BYTES == 64
    return __builtin_ia32_rangeps512_mask(a, b, 0xb, a, TEXGEN_SIXTEEN_LANES, 4);
#else
    return maximum(bits_as<WideFloats>(bits_as<WideWords>(a) & 0x7fffffff), b);
#endif
}
// The larger of lanes i and i + lanes.
TEXGEN_INLINE Doubles folded(const WideFloats& values) noexcept {
    using Half = std::make_integer_sequence<int, lanes>;
    return to_doubles(maximum(half<0>(values, Half()), half<lanes>(values, Half())));
}

TEXGEN_INLINE auto less(const auto& a, const auto& b) noexcept { return a < b; }
TEXGEN_INLINE WideWords at_most(const WideFloats& a, const WideFloats& b) noexcept { return a <= b; }

TEXGEN_INLINE Doubles magnitude(const Doubles& a) noexcept {
    return __builtin_bit_cast(Doubles, __builtin_bit_cast(LongWords, a) & 0x7fffffffffffffffLL);
}

template <class Vector>
TEXGEN_INLINE Vector load(const void* from) noexcept {
    Vector values;
    __builtin_memcpy(&values, from, sizeof values);
    return values;
}
// Loads what is used several times: else GCC loads it for each use, and a vector as long as a cache line may cross two.
template <class Vector>
TEXGEN_INLINE Vector load_once(const void* from) noexcept {
    struct [[gnu::packed, gnu::may_alias]] Unaligned {
        Vector values;
    };
    if constexpr (sizeof(Vector) < 64) return load<Vector>(from);
    return static_cast<const volatile Unaligned*>(from)->values;
}
TEXGEN_INLINE void store(void* to, const auto& values) noexcept { __builtin_memcpy(to, &values, sizeof values); }

// A mask, all ones where a value is from min to max, else zero.
TEXGEN_INLINE auto inside(const auto& values, float min, float max) noexcept {
    return (values >= min) & (values <= max);
}

TEXGEN_INLINE Floats one_where(const Words& mask) noexcept {
    return __builtin_bit_cast(Floats, mask & bit_cast<int>(1.0f));
}
TEXGEN_INLINE WideFloats one_where(const WideWords& mask) noexcept {
    return __builtin_bit_cast(WideFloats, mask & bit_cast<int>(1.0f));
}

template <int... Lane>
TEXGEN_INLINE WideFloats reversed(const WideFloats& a, std::integer_sequence<int, Lane...>) noexcept {
    return __builtin_shufflevector(a, a, (wide_lanes - 1 - Lane)...);
}
TEXGEN_INLINE WideFloats reversed(const WideFloats& a) noexcept {
    return reversed(a, std::make_integer_sequence<int, wide_lanes>());
}

// Element 3 i + Component, for every lane i, of the three vectors one after another.
template <int Component, class Vector, int... Lane>
TEXGEN_INLINE Vector every_third(const Vector& a, const Vector& b, const Vector& c,
                                 std::integer_sequence<int, Lane...>) noexcept {
    constexpr int n = sizeof...(Lane);
    const Vector ab = __builtin_shufflevector(a, b, (3 * Lane + Component < 2 * n ? 3 * Lane + Component : 0)...);
    return __builtin_shufflevector(ab, c, (3 * Lane + Component < 2 * n ? Lane : 3 * Lane + Component - n)...);
}
template <class Vector>
TEXGEN_INLINE void load_interleaved(const float* from, Vector& x, Vector& y, Vector& z) noexcept {
    constexpr int n = static_cast<int>(sizeof(Vector) / sizeof(float));
    const auto a = load_once<Vector>(from), b = load_once<Vector>(from + n), c = load_once<Vector>(from + 2 * n);
    x = every_third<0>(a, b, c, std::make_integer_sequence<int, n>());
    y = every_third<1>(a, b, c, std::make_integer_sequence<int, n>());
    z = every_third<2>(a, b, c, std::make_integer_sequence<int, n>());
}

// Lanes First, First + 2, ... of both vectors.
template <int First, class Vector, int... Lane>
TEXGEN_INLINE Vector every_second(const Vector& a, const Vector& b, std::integer_sequence<int, Lane...>) noexcept {
    return __builtin_shufflevector(a, b, (2 * Lane + First)...);
}
// Loads boxes of two corners of three floats.
TEXGEN_INLINE void load_boxes(const float* from, WideFloats (&min)[3], WideFloats (&max)[3]) noexcept {
    WideFloats first[3], second[3];
    load_interleaved(from, first[0], first[1], first[2]);
    load_interleaved(from + 3 * wide_lanes, second[0], second[1], second[2]);
    TEXGEN_FOR (int j = 0; j < 3; ++j) {
        min[j] = every_second<0>(first[j], second[j], std::make_integer_sequence<int, wide_lanes>());
        max[j] = every_second<1>(first[j], second[j], std::make_integer_sequence<int, wide_lanes>());
    }
}

// Loads four numbers for every lane, which follow one another.
template <class Vector, class Number>
TEXGEN_INLINE void load_fours(const Number* from, Vector (&values)[4]) noexcept {
    constexpr int n = static_cast<int>(sizeof(Vector) / sizeof(Number));
    using Lanes = std::make_integer_sequence<int, n>;
    Vector four[4];
    TEXGEN_FOR (int i = 0; i < 4; ++i) four[i] = load<Vector>(from + i * n);
    const Vector even[2] = {every_second<0>(four[0], four[1], Lanes()), every_second<0>(four[2], four[3], Lanes())};
    const Vector odd[2] = {every_second<1>(four[0], four[1], Lanes()), every_second<1>(four[2], four[3], Lanes())};
    values[0] = every_second<0>(even[0], even[1], Lanes());
    values[1] = every_second<0>(odd[0], odd[1], Lanes());
    values[2] = every_second<1>(even[0], even[1], Lanes());
    values[3] = every_second<1>(odd[0], odd[1], Lanes());
}

// Lane i of both vectors in turn.
template <int First, class Vector, int... Lane>
TEXGEN_INLINE Vector zipped(const Vector& a, const Vector& b, std::integer_sequence<int, Lane...>) noexcept {
    constexpr int n = sizeof...(Lane);
    return __builtin_shufflevector(a, b, (First + Lane / 2 + Lane % 2 * n)...);
}
template <class Vector>
TEXGEN_INLINE void store_interleaved(float* to, const Vector& a, const Vector& b) noexcept {
    constexpr int n = static_cast<int>(sizeof(Vector) / sizeof(float));
    store(to, zipped<0>(a, b, std::make_integer_sequence<int, n>()));
    store(to + n, zipped<n / 2>(a, b, std::make_integer_sequence<int, n>()));
}

// Lane i of all four in turn.
template <class Vector>
TEXGEN_INLINE void store_interleaved(float* to, const Vector& a, const Vector& b, const Vector& c,
                                     const Vector& d) noexcept {
    constexpr int n = static_cast<int>(sizeof(Vector) / sizeof(float));
    using Lanes = std::make_integer_sequence<int, n>;
    store_interleaved(to, zipped<0>(a, c, Lanes()), zipped<0>(b, d, Lanes()));
    store_interleaved(to + 2 * n, zipped<n / 2>(a, c, Lanes()), zipped<n / 2>(b, d, Lanes()));
}

// Lane i of vector k becomes lane k of vector i: in blocks of 16 bytes, then block by block, as crossing them is dear.
template <int First, int Block, class Vector, int... Lane>
TEXGEN_INLINE Vector zipped_in_blocks(const Vector& a, const Vector& b, std::integer_sequence<int, Lane...>) noexcept {
    return __builtin_shufflevector(a, b,
                                   (Lane / Block * Block + First * Block / 2 + Lane % Block / 2 + Lane % 2 * lanes)...);
}
template <int First, int Block, class Vector, int... Lane>
TEXGEN_INLINE Vector every_second_block(const Vector& a, const Vector& b,
                                        std::integer_sequence<int, Lane...>) noexcept {
    return __builtin_shufflevector(a, b, ((2 * (Lane / Block) + First) * Block + Lane % Block)...);
}
template <class Vector>
TEXGEN_INLINE void transpose(Vector (&rows)[lanes]) noexcept {
    using Lanes = std::make_integer_sequence<int, lanes>;
    constexpr int in_16_bytes = 16 * lanes / static_cast<int>(sizeof(Vector));
    constexpr int block = in_16_bytes < lanes ? in_16_bytes : lanes;
    Vector mixed[lanes];
    TEXGEN_FOR (int size = 1; size < lanes; size *= 2) {
        TEXGEN_FOR (int i = 0; i < lanes / 2; ++i) {
            if (size < block) {
                const Vector& a = rows[2 * i / block * block + i % (block / 2)];
                const Vector& b = rows[2 * i / block * block + i % (block / 2) + block / 2];
                mixed[2 * i] = zipped_in_blocks<0, block>(a, b, Lanes());
                mixed[2 * i + 1] = zipped_in_blocks<1, block>(a, b, Lanes());
            } else {
                const Vector& a = rows[i / block * 2 * block + i % block];
                const Vector& b = rows[i / block * 2 * block + i % block + block];
                mixed[i] = every_second_block<0, block>(a, b, Lanes());
                mixed[i + lanes / 2] = every_second_block<1, block>(a, b, Lanes());
            }
        }
        TEXGEN_FOR (int i = 0; i < lanes; ++i) rows[i] = mixed[i];
    }
}

TEXGEN_INLINE bool any(const Words& mask) noexcept {
    using Quadwords [[gnu::vector_size(TEXGEN_LANE_BYTES / 2)]] = long long;
    const auto quadwords = __builtin_bit_cast(Quadwords, mask);
#if TEXGEN_LANE_BYTES == 64
    return !__builtin_ia32_ptestz256(quadwords, quadwords);
#elif TEXGEN_LANE_BYTES == 32
    return !__builtin_ia32_ptestz128(quadwords, quadwords);
#else
    return quadwords[0] != 0;
#endif
}
// Bit i for lane i.
TEXGEN_INLINE std::uint64_t lane_bits(const LongWords& mask) noexcept {
#if TEXGEN_LANE_BYTES == 64
    return static_cast<std::uint8_t>(__builtin_ia32_cvtq2mask512(mask));
#elif TEXGEN_LANE_BYTES == 32
    return static_cast<std::uint64_t>(__builtin_ia32_movmskpd256(__builtin_bit_cast(Doubles, mask)));
#else
    return static_cast<std::uint64_t>((mask[0] & 1) | (mask[1] & 2));
#endif
}
// Bit i where word i is not 0.
TEXGEN_INLINE std::uint64_t lane_bits(const Words& words) noexcept {
#if TEXGEN_LANE_BYTES == 64
    return static_cast<std::uint8_t>(__builtin_ia32_cmpd256_mask(words, Words{}, 4, 0xff));
#elif TEXGEN_LANE_BYTES == 32
    return static_cast<std::uint64_t>(__builtin_ia32_movmskps(__builtin_bit_cast(Floats, words != 0)));
#else
    return (words[0] != 0 ? 1u : 0u) | (words[1] != 0 ? 2u : 0u);
#endif
}
TEXGEN_INLINE bool any(const LongWords& mask) noexcept {
#if TEXGEN_LANE_BYTES == 64
    return lane_bits(mask) != 0;
#elif TEXGEN_LANE_BYTES == 32
    return !__builtin_ia32_ptestz256(mask, mask);
#else
    return (mask[0] | mask[1]) != 0;
#endif
}
TEXGEN_INLINE bool any(const WideWords& mask) noexcept {
#if TEXGEN_LANE_BYTES == 64
    return __builtin_ia32_cvtd2mask512(mask) != 0;
#else
    return any(__builtin_bit_cast(LongWords, mask));
#endif
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
