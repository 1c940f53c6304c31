#include "trimtab/units/simd.h"

#include <gtest/gtest.h>

#include <cmath>

namespace trimtab {
namespace {

#define TRIMTAB_KERNELS "tests/core/measure/simd_test_kernels.inl"
#include "trimtab/units/simd_levels.inl"

struct Functions {
  float (*cubeRoot)(float), (*log2)(float), (*exp2)(float), (*reciprocal)(float);
};
template <class Of>
Functions from(const Of& of) {
  return {of.cubeRoot, of.log2, of.exp2, of.reciprocal};
}

class Simd : public testing::TestWithParam<SimdLevel> {
 protected:
  void SetUp() override {
    if (GetParam() > simdLevel()) GTEST_SKIP() << "needs a processor with these instructions";
    f = from(portable::functions);
#if defined(__x86_64__)
    if (GetParam() == SimdLevel::avx2) f = from(avx2::functions);
    if (GetParam() == SimdLevel::avx512) f = from(avx512::functions);
#endif
  }
  Functions f;
};

TEST_P(Simd, cubeRootKeepsItsBound) {
  for (float x = 1e-30f; x < 1e30f; x *= 1.0003f)
    ASSERT_NEAR(f.cubeRoot(x) / std::cbrt(static_cast<double>(x)), 1, 5e-7) << x;
}

TEST_P(Simd, logarithmKeepsItsBound) {
  for (float x = 1.2e-38f; x < 3e38f; x *= 1.0003f) {
    const double expected = std::log2(static_cast<double>(x));
    ASSERT_NEAR(f.log2(x), expected, 3e-7 + std::abs(expected) * 0x1p-24) << x;
  }
}

TEST_P(Simd, powerKeepsItsBound) {
  for (float x = -126; x < 126; x += 0.0007f)
    ASSERT_NEAR(f.exp2(x) / std::exp2(static_cast<double>(x)), 1, 3e-7) << x;
}

TEST_P(Simd, reciprocalKeepsItsBound) {
  for (float x = 1e-30f; x < 1e30f; x *= 1.001f)
    ASSERT_NEAR(static_cast<double>(f.reciprocal(x)) * x, 1, 3e-7) << x;
}

INSTANTIATE_TEST_SUITE_P(OfEachLevel, Simd,
                         testing::Values(SimdLevel::portable, SimdLevel::avx2, SimdLevel::avx512));

}  // namespace
}  // namespace trimtab
