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

}  // namespace support
