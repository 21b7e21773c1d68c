// Counts what the program allocates: for one file of a program, as it replaces the operators.

#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>

namespace support {

inline std::size_t allocations = 0;
inline std::size_t allocated_bytes = 0;

}  // namespace support

// Not inlined: else GCC pairs the malloc of one with the delete of another.
[[gnu::noinline]] void* operator new(std::size_t size) {
    ++support::allocations;
    support::allocated_bytes += size;
    if (void* memory = std::malloc(size)) return memory;
    std::abort();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
