// Compiles the file of kernels that TRIMTAB_KERNELS names, once per SimdLevel; simd.h says how. Include it inside a
// namespace, after every header that the kernels need.

namespace portable {
namespace {
#include "trimtab/units/simd_lanes.inl"
#include TRIMTAB_KERNELS
}  // namespace
}  // namespace portable

#if defined(__x86_64__)
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,fma"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,fma")
#endif
#define TRIMTAB_AVX2
namespace avx2 {
namespace {
#include "trimtab/units/simd_lanes.inl"
#include TRIMTAB_KERNELS
}  // namespace
}  // namespace avx2
#undef TRIMTAB_AVX2
#if defined(__clang__)
#pragma clang attribute pop
#pragma clang attribute push(__attribute__((target("avx512f,avx512vl,avx512dq,avx512bw,avx2,fma"))), \
                             apply_to = function)
#else
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,prefer-vector-width=512")
#endif
#define TRIMTAB_AVX512
namespace avx512 {
namespace {
#include "trimtab/units/simd_lanes.inl"
#include TRIMTAB_KERNELS
}  // namespace
}  // namespace avx512
#undef TRIMTAB_AVX512
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif
#undef TRIMTAB_KERNELS
