#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

/// The one way in which inner loops are written for vector instructions.
///
/// A file of kernels, NAME_kernels.inl, has neither include guard nor includes. A source names it and
/// includes simd_levels.inl, which compiles it once per SimdLevel into the namespaces portable, avx2 and
/// avx512, each with the vector types of simd_lanes.inl in front. `pick` then chooses a kernel at run time.
/// Everything in between is in an unnamed namespace and always inlined, so that no code for one level can be
/// linked in place of another's.
///
/// Google Highway's form gives the same bits. Of this form's speed, the frustum test reaches 0.98 to 1.00 with
/// it, and FLIP 0.94 to 1.03 with the version in Debian 12, but a quarter on processors without SSSE3. FLIP's
/// files would lose a fifth of their lines, and every IG that links the library would gain a dependency.
namespace trimtab {

enum class SimdLevel { portable, avx2, avx512 };

/// Returns the widest level that this processor has: avx2 with FMA; avx512 with F, DQ, BW and VL.
SimdLevel simdLevel();

/// Returns the kernel of the lower of `level` and simdLevel().
template <class Kernel>
Kernel pickKernel(SimdLevel level, Kernel portable, Kernel avx2, Kernel avx512) {
  if (simdLevel() < level) level = simdLevel();
  return level == SimdLevel::portable ? portable : level == SimdLevel::avx2 ? avx2 : avx512;
}

}  // namespace trimtab

/// TRIMTAB_PICK(level, name): the kernel `name` that simd_levels.inl compiled for that level.
#if defined(__x86_64__)
#define TRIMTAB_PICK(level, name) ::trimtab::pickKernel(level, &portable::name, &avx2::name, &avx512::name)
#else
#define TRIMTAB_PICK(level, name) ((void)(level), &portable::name)
#endif

#define TRIMTAB_INLINE [[gnu::always_inline]] inline
