// The inner loops of a mask that is made by itself. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

template <class CompiledWhereCalled = void>
void light_all(float* lit, std::size_t count) noexcept {
    constexpr auto size = static_cast<std::size_t>(wide_lanes);
    const WideFloats ones = WideFloats{} + 1.0f;
    for (; count >= size; count -= size, lit += size) store(lit, ones);
    for (; count > 0; --count, ++lit) *lit = 1.0f;
}

template <class CompiledWhereCalled = void>
void darken(float* lit, const float* r, std::size_t count, float min, float max) noexcept {
    constexpr auto size = static_cast<std::size_t>(wide_lanes);
    for (; count >= size; count -= size, lit += size, r += size)
        store(lit, select(inside(load<WideFloats>(r), min, max), load<WideFloats>(lit), WideFloats{}));
    for (; count > 0; --count, ++lit, ++r)
        if (!(*r >= min && *r <= max)) *lit = 0.0f;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
