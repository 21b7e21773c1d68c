#pragma once

// The reciprocal estimate of x86 in the widest vectors that the flags allow, with Newton steps: a rejected variant.

#if defined(__GNUC__) && defined(__SSE__)
#define TEXGEN_BENCH_ESTIMATE

#include <cstddef>

#include <immintrin.h>

namespace bench {

#if defined(__AVX512F__)
using Lanes = __m512;
inline Lanes load(const float* from) { return _mm512_loadu_ps(from); }
inline void store(float* to, Lanes lanes) { _mm512_storeu_ps(to, lanes); }
// Masked, as g++ 12 warns of the undefined source of the plain one.
inline Lanes estimate(Lanes lanes) { return _mm512_maskz_rcp14_ps(0xffff, lanes); }
#else
using Lanes = __m128;
inline Lanes load(const float* from) { return _mm_loadu_ps(from); }
inline void store(float* to, Lanes lanes) { _mm_storeu_ps(to, lanes); }
inline Lanes estimate(Lanes lanes) { return _mm_rcp_ps(lanes); }
#endif

constexpr std::size_t lane_count = sizeof(Lanes) / sizeof(float);

template <int newton_steps>
Lanes reciprocal(Lanes q) {
    Lanes result = estimate(q);
    for (int step = 0; step < newton_steps; ++step) result = result * (2.0f - q * result);
    return result;
}

}  // namespace bench

#endif
