#include "horizon_kernels.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "horizon_geometry.h"
#include "trimtab/units/simd.h"

namespace trimtab::horizon {

#define TRIMTAB_KERNELS "core/culling/horizon_kernels.inl"
#include "trimtab/units/simd_levels.inl"

const Kernels& kernels(SimdLevel atMost) {
  return *TRIMTAB_PICK(atMost, kernels);
}

}  // namespace trimtab::horizon
