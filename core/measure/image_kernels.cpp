#include "image_kernels.h"

#include <atomic>

namespace trimtab {

#define TRIMTAB_KERNELS "core/measure/image_kernels.inl"
#include "trimtab/units/simd_levels.inl"

namespace {

std::atomic<const ImageKernels*>& chosen() {
  static std::atomic<const ImageKernels*> kernels{&imageKernels(simdLevel())};
  return kernels;
}

}  // namespace

const ImageKernels& imageKernels(SimdLevel level) {
  return *TRIMTAB_PICK(level, kernels);
}

const ImageKernels& imageKernels() {
  return *chosen().load(std::memory_order_relaxed);
}

bool useSimdLevel(SimdLevel level) {
  if (level > simdLevel()) return false;
  chosen() = &imageKernels(level);
  return true;
}

}  // namespace trimtab
