// What kernels make of a Tolerance, of conventions.hpp.

namespace TEXGEN_DETAIL {

// The error that a kernel may make: 0 for exact, and never so much that a float could leave its range.
constexpr double accepted(Tolerance tolerance) noexcept {
    return tolerance.value > 0.0 ? (tolerance.value < 0x1p100 ? tolerance.value : 0x1p100) : 0.0;
}

}  // namespace TEXGEN_DETAIL
