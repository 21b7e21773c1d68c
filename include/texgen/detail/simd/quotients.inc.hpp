// What quotients share wherever they are made: two divisors' one division, and what an error leaves of a float.
// Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The reciprocals of two vectors by one division, 1/a = b (1/(a b)). Each is rounded three times.
struct SharedDivision {
    Doubles product, of_both, reciprocal[2];

    TEXGEN_INLINE SharedDivision(const Doubles& a, const Doubles& b) noexcept
        : product(a * b), of_both(1.0 / product), reciprocal{of_both * b, of_both * a} {}
};

// A number within an error as a float: in doubt where its ends do not round to one.
struct RoundedEnds {
    Floats below, above;

    TEXGEN_INLINE RoundedEnds(const Doubles& value, const auto& error) noexcept
        : below(to_floats(value - error)), above(to_floats(value + error)) {}

    TEXGEN_INLINE Words differ() const noexcept { return bits(below) ^ bits(above); }
};

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
