// What quotients share wherever they are made: one division for two divisors, and the floats at the ends of an error.
// Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The bits of numbers. Those of |a| have the order of |a|, with a NaN beyond infinity: a maximum keeps it.
TEXGEN_INLINE WideWords signed_bits(const WideFloats& a) noexcept { return bits_as<WideWords>(a); }
TEXGEN_INLINE WideWords magnitude_bits(const WideFloats& a) noexcept { return signed_bits(a) & 0x7fffffff; }
TEXGEN_INLINE WideFloats from_bits(const WideWords& words) noexcept { return bits_as<WideFloats>(words); }
TEXGEN_INLINE WideFloats magnitude(const WideFloats& a) noexcept { return from_bits(magnitude_bits(a)); }
template <class Mask, class Vector>
TEXGEN_INLINE Vector select(const Mask& mask, const Vector& a, const Vector& b) noexcept {
    return bits_as<Vector>((mask & bits_as<Mask>(a)) | (~mask & bits_as<Mask>(b)));
}
template <int Bits>
TEXGEN_INLINE Doubles leading_bits(const Doubles& a) noexcept {
    return bits_as<Doubles>(bits_as<Residues>(a) & ~std::uint64_t{0} << (53 - Bits));
}
// The power of two at or below the magnitude of a normal number; and the reciprocals of powers that have normal ones,
// 2^1023 for 0.
TEXGEN_INLINE Doubles power_of_two_below(const Doubles& a) noexcept {
    return bits_as<Doubles>(bits_as<Residues>(a) & std::uint64_t{0x7ff0000000000000});
}
TEXGEN_INLINE Doubles reciprocals_of_powers(const Doubles& a) noexcept {
    return bits_as<Doubles>(std::uint64_t{0x7fe0000000000000} - bits_as<Residues>(a));
}
// A number without its last bit that is set. A power of two has none, and gives nothing of use.
TEXGEN_INLINE Doubles without_last_bit(const Doubles& a) noexcept {
    return bits_as<Doubles>(bits_as<Residues>(a) & (bits_as<Residues>(a) - std::uint64_t{1}));
}

// The reciprocals of two vectors by one division, 1/a = b (1/(a b)). Each is rounded three times.
struct SharedDivision {
    Doubles product, of_both, reciprocal[2];

    TEXGEN_INLINE SharedDivision(const Doubles& a, const Doubles& b) noexcept
        : product(a * b), of_both(1.0 / product), reciprocal{of_both * b, of_both * a} {}
};

// Both ends of value +- error, rounded to float: the float is in doubt where they differ.
struct RoundedEnds {
    Floats below, above;

    TEXGEN_INLINE RoundedEnds(const Doubles& value, const auto& error) noexcept
        : below(to_floats(value - error)), above(to_floats(value + error)) {}

    TEXGEN_INLINE Words differ() const noexcept { return bits_as<Words>(below) ^ bits_as<Words>(above); }
};

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
