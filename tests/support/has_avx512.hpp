#pragma once

namespace support {

// Whether the library, which chooses at run time, chooses AVX-512 here.
inline bool has_avx512() {
#if defined(__x86_64__)
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}

// Whether the processor does all of such a vector at once, as AMD's do from Zen 5 on, and not half by half.
inline bool has_whole_avx512() {
#if defined(__x86_64__)
    return has_avx512() && __builtin_cpu_is("amd") && __builtin_cpu_supports("avx512vp2intersect");
#else
    return false;
#endif
}

}  // namespace support
