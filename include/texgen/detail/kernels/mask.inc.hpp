// The inner loops of a mask that is made apart from coordinates. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

template <class CompiledWhereCalled = void>
void light_all(float* lit, std::size_t count) noexcept {
    const WideFloats ones = WideFloats{} + 1.0f;
    for (; count >= wide_at_once; count -= wide_at_once, lit += wide_at_once) store(lit, ones);
    for (; count > 0; --count, ++lit) *lit = 1.0f;
}

template <class CompiledWhereCalled = void>
void darken(float* lit, const float* r, std::size_t count, float min, float max) noexcept {
    for (; count >= wide_at_once; count -= wide_at_once, lit += wide_at_once, r += wide_at_once)
        store(lit, select(inside(load<WideFloats>(r), min, max), load<WideFloats>(lit), WideFloats{}));
    for (; count > 0; --count, ++lit, ++r)
        if (!(*r >= min && *r <= max)) *lit = 0.0f;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
