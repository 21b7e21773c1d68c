#pragma once

// What the library asks of the language and its libraries: every public header includes this first. An #error would be one
// of a thousand, as the compiler would read on; an include that is nowhere ends the compilation.
#if (defined(_MSVC_LANG) ? _MSVC_LANG : __cplusplus) <= 201703L
#include <texgen needs C++20: compile with -std=c++20 or later, MSVC with /std:c++20 or later>
#endif

namespace texgen::detail {

// std::bit_cast, which standard libraries got later than the compilers that they come with.
template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
    static_assert(sizeof(To) == sizeof(From));
    return __builtin_bit_cast(To, from);
}

}  // namespace texgen::detail
