#pragma once

// The states of the floating-point unit that a host program may leave behind: the default, and subnormal numbers taken
// as 0.

#include <array>
#include <cstdint>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace support {

struct FloatState {
    const char* name;
    bool flushes;  // FTZ and DAZ on x86, FZ on Arm
};

inline constexpr std::array float_states{
    FloatState{"default", false},
    FloatState{"flushing", true},
};

namespace detail {

#if defined(__SSE__)
inline constexpr bool can_flush = true;
inline std::uint64_t control() { return _mm_getcsr(); }
inline void set_control(std::uint64_t value) { _mm_setcsr(static_cast<unsigned>(value)); }
inline constexpr std::uint64_t flushing = 0x8040;  // FTZ and DAZ
#elif defined(__aarch64__)
inline constexpr bool can_flush = true;
inline std::uint64_t control() {
    std::uint64_t value;
    __asm__ volatile("mrs %0, fpcr" : "=r"(value));
    return value;
}
inline void set_control(std::uint64_t value) { __asm__ volatile("msr fpcr, %0" ::"r"(value) : "memory"); }
inline constexpr std::uint64_t flushing = 1u << 24;  // FZ
#else
inline constexpr bool can_flush = false;
inline std::uint64_t control() { return 0; }
inline void set_control(std::uint64_t) {}
inline constexpr std::uint64_t flushing = 0;
#endif

}  // namespace detail

// Whether this machine has the state.
inline bool has(const FloatState& state) { return !state.flushes || detail::can_flush; }

// Calls body() in the state, and puts the old one back. The call goes through memory, so that no arithmetic moves
// across.
template <class Body>
void under(const FloatState& state, const Body& body) {
    void (*volatile const call)(const void*) = [](const void* any) { (*static_cast<const Body*>(any))(); };
    const volatile std::uint64_t before = detail::control();
    if (state.flushes) detail::set_control(detail::control() | detail::flushing);
    call(&body);
    detail::set_control(before);
}

}  // namespace support
