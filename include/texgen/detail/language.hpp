#pragma once

// What the library asks of the language and its libraries: every public header includes this first. An include that
// does not exist ends the compilation, while after an #error the compiler would read on and report a thousand others.
#if (defined(_MSVC_LANG) ? _MSVC_LANG : __cplusplus) <= 201703L
#include <texgen needs C++20: compile with -std=c++20 or later, MSVC with /std:c++20 or later>
#endif

#include <glm/vec2.hpp>

// No macro of clang++ says that -funsafe-math-optimizations is on, nor since 22 that -ffp-model=fast is. So from here
// on the arithmetic of the file is set to be as written, as the proofs of the bounds need it. Before 18 clang++ knows
// no such word for reciprocals.
#if defined(__clang__) && __clang_major__ >= 18
#pragma clang fp reassociate(off) reciprocal(off)
#endif

// All of the library stands in this namespace. Where GLM aligns its types by default they have another layout. A file
// that has them aligned gets types and functions of its own, so that it can be linked with files that have not.
#if defined(GLM_FORCE_DEFAULT_ALIGNED_GENTYPES) && GLM_CONFIG_ALIGNED_GENTYPES == GLM_ENABLE
#define TEXGEN_NAMESPACE texgen::inline aligned_gentypes
static_assert(glm::defaultp == glm::aligned_highp, "GLM was configured otherwise when it was included first");
#else
#define TEXGEN_NAMESPACE texgen
static_assert(glm::defaultp == glm::packed_highp, "GLM was configured otherwise when it was included first");
#endif

// The compiler's name, for an inline namespace around all that makes closures or takes them. Compilers agree on the
// name of a closure's type, and of what takes it, but not on its layout. Without this namespace the linker may join the
// functions that two compilers made of one header.

#define TEXGEN_JOINED(name, version) name##version
#define TEXGEN_NAMED(name, version) TEXGEN_JOINED(name, version)
#ifdef __NVCC__  // rewrites the program for the host's compiler and defines its macros, too
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

// Functions that are not inlined: TEXGEN_APART leaves their callers the registers that they need. TEXGEN_RARE also puts
// them elsewhere in memory, so that code for rare cases does not lie among the rest, and has the compiler keep them
// small, which ties in a small tile would wait for.
#if defined(__GNUC__) || defined(__clang__)
#define TEXGEN_APART [[gnu::noinline]]
#define TEXGEN_RARE [[gnu::noinline, gnu::cold]]
#else
#define TEXGEN_APART
#define TEXGEN_RARE
#endif

// The namespaces of what is not public, and of what is public but differs between compilers.
#define TEXGEN_DETAIL TEXGEN_NAMESPACE::detail::inline TEXGEN_COMPILER
#define TEXGEN_NAMESPACE_COMPILER TEXGEN_NAMESPACE::inline TEXGEN_COMPILER

namespace TEXGEN_DETAIL {

// std::bit_cast, which standard libraries got later than the compilers that they come with.
template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
    static_assert(sizeof(To) == sizeof(From));
    return __builtin_bit_cast(To, from);
}

// Reads a number by a load of its own. Compilers load a number together with its neighbour where they can, and where
// the two were stored one by one such a load waits for both stores. By a name: clang++ 14 forgets a cast to volatile.
template <class Number>
Number read_alone(const Number& number) noexcept {
    const volatile Number& alone = number;
    return alone;
}

}  // namespace TEXGEN_DETAIL
