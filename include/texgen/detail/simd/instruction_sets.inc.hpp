// TEXGEN_KERNELS once per instruction set, inside that set's target region. Included by lanes.hpp, and by what has
// kernels that not all files pay for (batch_lanes.hpp).

// Vector arguments never cross a call that is not inlined, so their calling convention does not matter. GCC 12 fails at
// masks whose code its tracer copies, as it does with -fprofile-use.
#ifdef TEXGEN_HAS_VECTORS
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"
#ifndef __clang__
#pragma GCC push_options
#pragma GCC optimize("no-tracer")
#endif
#endif

#define TEXGEN_ISA TEXGEN_FLAGS(flags_)
#define TEXGEN_LANE_BYTES TEXGEN_BYTES_BY_FLAGS
#include TEXGEN_KERNELS
#undef TEXGEN_ISA
#undef TEXGEN_LANE_BYTES

#ifdef TEXGEN_DISPATCHES

// GCC's targets add up, until all options are popped below.
#define TEXGEN_ISA avx2
#define TEXGEN_LANE_BYTES 32
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2,fma"))), apply_to = function)
#else
#pragma GCC target("avx2,fma")
#endif
#include TEXGEN_KERNELS
#ifdef __clang__
#pragma clang attribute pop
#endif
#undef TEXGEN_ISA
#undef TEXGEN_LANE_BYTES

#define TEXGEN_ISA avx512
#define TEXGEN_LANE_BYTES 64
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx512f,avx512vl,avx512dq,avx512bw,avx2,fma"))), \
                             apply_to = function)
#else
#pragma GCC target("avx512f,avx512vl,avx512dq,avx512bw,prefer-vector-width=512")
#endif
#include TEXGEN_KERNELS
#ifdef __clang__
#pragma clang attribute pop
#endif
#undef TEXGEN_ISA
#undef TEXGEN_LANE_BYTES

#endif

#ifdef TEXGEN_HAS_VECTORS
#ifndef __clang__
#pragma GCC pop_options
#endif
#pragma GCC diagnostic pop
#endif
