// Which numbers are near the middle of two floats, of the vectors of vectors.inc.hpp. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The lanes whose number lies within so many of its ulps, 1 less than a power of two, of the middle of two normal
// floats (or one more beyond it); middle_near() is that middle.
TEXGEN_INLINE LongWords are_near_middles(const Doubles& a, std::int64_t ulps) noexcept {
    return ((__builtin_bit_cast(Residues, a) + static_cast<std::uint64_t>(ulps - 0x10000000)) &
            static_cast<std::uint64_t>(0x1ffffffe - 2 * ulps)) == 0;
}
// The low words of a and b, or the high ones, in whatever order. They are shuffled as floats, within 16 bytes: for
// integers GCC takes instructions that cross these.
template <bool AreHigh, int... Lane>
TEXGEN_INLINE WideResidues words_of(const Doubles& a, const Doubles& b, std::integer_sequence<int, Lane...>) noexcept {
    constexpr int word = AreHigh == (std::endian::native == std::endian::little) ? 1 : 0;
    return __builtin_bit_cast(
        WideResidues, __builtin_shufflevector(__builtin_bit_cast(WideFloats, a), __builtin_bit_cast(WideFloats, b),
                                              (Lane / 4 * 4 + Lane % 2 * 2 + Lane % 4 / 2 * wide_lanes + word)...));
}
TEXGEN_INLINE Doubles middle_near(const Doubles& a) noexcept {
    return masked_or(a, ~0x1fffffffLL, __builtin_bit_cast(Doubles, LongWords{} + 0x10000000));
}

// How far the numbers of two vectors at a time have been from such middles: 0 in each lane where one was near. Low
// words decide. It is a mask of bits where the instruction set has those.
#if TEXGEN_LANE_BYTES == 64
using Distances = std::uint16_t;
TEXGEN_INLINE Distances far_from_middles() noexcept { return 0xffff; }
#else
using Distances = WideWords;
TEXGEN_INLINE Distances far_from_middles() noexcept { return WideWords{} + 1; }
#endif
TEXGEN_INLINE Distances nearer(const Distances& others, const Doubles& a, const Doubles& b, int ulps) noexcept {
    const WideResidues low = words_of<false>(a, b, std::make_integer_sequence<int, wide_lanes>());
    const auto sum = __builtin_bit_cast(WideWords, low + static_cast<std::uint32_t>(ulps - 0x10000000));
    const WideWords bits = WideWords{} + (0x1ffffffe - 2 * ulps);
#if TEXGEN_LANE_BYTES == 64
    return static_cast<Distances>(TEXGEN_ANY_BITS(sum, bits, others));
#else
    return minimum(others, sum & bits);
#endif
}
TEXGEN_INLINE bool any_zero(const Distances& distances) noexcept {
#if TEXGEN_LANE_BYTES == 64
    return distances != far_from_middles();
#else
    const WideWords is_zero = distances == 0;
    return any(is_zero);
#endif
}
// Whether a number, of which none is subnormal, is not 0 in a lane where either distance is 0.
TEXGEN_INLINE bool any_nonzero_near(const Distances& distances, const Doubles& a) noexcept {
    const WideResidues high = words_of<true>(a, a, std::make_integer_sequence<int, wide_lanes>()) & 0x7fffffffu;
#if TEXGEN_LANE_BYTES == 64
    return (TEXGEN_ANY_BITS(__builtin_bit_cast(WideWords, high), ~WideWords{}, far_from_middles()) & ~distances) != 0;
#else
    const WideWords both = (distances == 0) & (high != 0);
    return any(both);
#endif
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
