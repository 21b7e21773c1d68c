// The inner loops of a mask that a depth bounds. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

template <class CompiledWhereCalled = void>
bool any_lit(const float* lit, std::size_t count) noexcept {
    constexpr auto step = static_cast<std::size_t>(4 * wide_lanes);
    std::size_t i = 0;
    for (; i + step <= count; i += step) {
        WideWords largest{};
        for (std::size_t j = i; j < i + step; j += static_cast<std::size_t>(wide_lanes))
            largest = maximum(magnitude_bits(load<WideFloats>(lit + j)), largest);
        if (largest_lane(largest) != 0) return true;
    }
    for (; i < count; ++i)
        if (lit[i] > 0.0f) return true;
    return false;
}

// The last vector overlaps the one before it: what is darkened twice stays dark.
template <class CompiledWhereCalled = void>
void darken(float* lit, const float* r, std::size_t count, float min, float max) noexcept {
    constexpr auto size = static_cast<std::size_t>(wide_lanes);
    for (std::size_t i = 0; i < count; i += size) {
        if (count < size) {
            for (; i < count; ++i)
                if (!(r[i] >= min && r[i] <= max)) lit[i] = 0.0f;
            return;
        }
        const std::size_t at = i + size <= count ? i : count - size;
        const auto mask = inside(load<WideFloats>(r + at), min, max);
        store(lit + at, select(mask, load<WideFloats>(lit + at), WideFloats{}));
    }
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
