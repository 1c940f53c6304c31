#include "trimtab/units/simd.h"

namespace trimtab {

SimdLevel simdLevel() {
#if defined(__x86_64__)
  static const SimdLevel level = [] {
    const bool fma = __builtin_cpu_supports("fma");
    if (fma && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
      return SimdLevel::avx512;
    return fma && __builtin_cpu_supports("avx2") ? SimdLevel::avx2 : SimdLevel::portable;
  }();
  return level;
#else
  return SimdLevel::portable;
#endif
}

}  // namespace trimtab
