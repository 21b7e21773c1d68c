#pragma once

// Counts what the library asserts; the program goes on, as one without assertions does. Included before any header of
// the library. A test leaves the count at 0, for the next.

#include <cstddef>

#ifdef TEXGEN_ASSERT
#error "A header of the library was included before"
#endif

namespace support {

inline std::size_t broken_preconditions = 0;

}  // namespace support

#define TEXGEN_ASSERT(condition) ((condition) ? void() : void(++support::broken_preconditions))
