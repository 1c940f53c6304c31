#include <atomic>

#include "simd_kernels.h"

namespace trimtab {
namespace {

const ImageKernels* widest() {
  for (const SimdPath path : {SimdPath::avx512, SimdPath::avx2})
    if (const ImageKernels* kernels = imageKernels(path)) return kernels;
  return &portable::kernels;
}

std::atomic<const ImageKernels*>& chosen() {
  static std::atomic<const ImageKernels*> kernels{widest()};
  return kernels;
}

}  // namespace

const ImageKernels* imageKernels(SimdPath path) {
  switch (path) {
    case SimdPath::portable:
      return &portable::kernels;
#ifdef TRIMTAB_X86_KERNELS
    case SimdPath::avx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? &avx2::kernels : nullptr;
    case SimdPath::avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                     __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
                     __builtin_cpu_supports("fma")
                 ? &avx512::kernels
                 : nullptr;
#else
    default:
      return nullptr;
#endif
  }
  return nullptr;
}

const ImageKernels& imageKernels() {
  return *chosen().load(std::memory_order_relaxed);
}

bool useSimdPath(SimdPath path) {
  const ImageKernels* kernels = imageKernels(path);
  if (kernels) chosen() = kernels;
  return kernels != nullptr;
}

}  // namespace trimtab
