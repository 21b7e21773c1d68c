#pragma once

// What the library asks of the language and its libraries: every public header includes this first. An #error would be
// one of a thousand, as the compiler would read on; an include that is nowhere ends the compilation.
#if (defined(_MSVC_LANG) ? _MSVC_LANG : __cplusplus) <= 201703L
#include <texgen needs C++20: compile with -std=c++20 or later, MSVC with /std:c++20 or later>
#endif

#include <glm/vec2.hpp>

// No macro of clang++ tells of -funsafe-math-optimizations, nor since 22 of -ffp-model=fast: from here on a file's
// arithmetic is as written, for which the bounds are proved. Before 18 it has no such word for reciprocals.
#if defined(__clang__) && __clang_major__ >= 18
#pragma clang fp reassociate(off) reciprocal(off)
#endif

// All of the library stands in this namespace. What GLM aligns by default has another layout: files that do and files
// that do not link into one program, each with types and functions of its own.
#if defined(GLM_FORCE_DEFAULT_ALIGNED_GENTYPES) && GLM_CONFIG_ALIGNED_GENTYPES == GLM_ENABLE
#define TEXGEN_NAMESPACE texgen::inline aligned_gentypes
static_assert(glm::defaultp == glm::aligned_highp, "GLM was configured otherwise when it was included first");
#else
#define TEXGEN_NAMESPACE texgen
static_assert(glm::defaultp == glm::packed_highp, "GLM was configured otherwise when it was included first");
#endif

// The compiler's name, for an inline namespace around all that makes closures or takes them. Compilers agree on the
// name of a closure's type, and of what takes it, but not on its layout; so what one compiler made must not be linked
// to what another did, as the linker else may with the functions of a header.

#define TEXGEN_JOINED(name, version) name##version
#define TEXGEN_NAMED(name, version) TEXGEN_JOINED(name, version)
#ifdef __NVCC__  // writes the program anew for the compiler of the host, whose name it bears
#define TEXGEN_HOST(name) nvcc_##name
#else
#define TEXGEN_HOST(name) name
#endif
#if defined(__clang__)
#define TEXGEN_COMPILER TEXGEN_NAMED(TEXGEN_HOST(clang), __clang_major__)
#elif defined(__GNUC__)
#define TEXGEN_COMPILER TEXGEN_NAMED(TEXGEN_HOST(gcc), __GNUC__)
#elif defined(_MSC_VER)
#define TEXGEN_COMPILER TEXGEN_NAMED(TEXGEN_HOST(msvc), _MSC_VER)
#else
#define TEXGEN_COMPILER other_compiler
#endif

// Functions that are compiled apart: what is rare, so that it costs the rest no registers, and what only ties need, so
// that it costs the rest no room.
#if defined(__GNUC__) || defined(__clang__)
#define TEXGEN_APART [[gnu::noinline]]
#define TEXGEN_RARE [[gnu::noinline, gnu::cold]]
#else
#define TEXGEN_APART
#define TEXGEN_RARE
#endif

// What is not public stands in the first; in the other what is public, and each compiler's own.
#define TEXGEN_DETAIL TEXGEN_NAMESPACE::detail::inline TEXGEN_COMPILER
#define TEXGEN_NAMESPACE_COMPILER TEXGEN_NAMESPACE::inline TEXGEN_COMPILER

namespace TEXGEN_DETAIL {

// std::bit_cast, which standard libraries got later than the compilers that they come with.
template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
    static_assert(sizeof(To) == sizeof(From));
    return __builtin_bit_cast(To, from);
}

// A number that was stored alone: compilers load it with its neighbour at once, and that load waits for both stores.
template <class Number>
Number read_alone(const Number& number) noexcept {
    return static_cast<const volatile Number&>(number);
}

}  // namespace TEXGEN_DETAIL
