#pragma once

// The compiler's name, for an inline namespace around all that makes closures or takes them. Compilers agree on the name of a
// closure's type, and of what takes it, but not on its layout; so what one compiler made must not be linked to what another
// did, as the linker else may with the functions of a header.

#define TEXGEN_JOINED(name, version) name##version
#define TEXGEN_NAMED(name, version) TEXGEN_JOINED(name, version)
#if defined(__clang__)
#define TEXGEN_COMPILER TEXGEN_NAMED(clang, __clang_major__)
#elif defined(__GNUC__)
#define TEXGEN_COMPILER TEXGEN_NAMED(gcc, __GNUC__)
#elif defined(_MSC_VER)
#define TEXGEN_COMPILER TEXGEN_NAMED(msvc, _MSC_VER)
#else
#define TEXGEN_COMPILER other_compiler
#endif
