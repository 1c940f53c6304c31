#pragma once

#include <cstddef>
#include <cstdint>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

/// Vectors of floats, as wide as the options of the source file that includes this allow: 16 (AVX-512),
/// 8 (AVX2 and FMA) or 4 (any machine). Everything is in an unnamed namespace, and sources that are compiled
/// for more than any machine has include nothing else, so that no function of theirs can be linked in place
/// of another source's.
namespace trimtab {
namespace {

#if defined(__AVX512F__) && defined(__AVX512DQ__)
inline constexpr int kLanes = 16;
// g++ 12 warns of its own plain forms of some instructions (GCC bug 105593), not of those with a mask.
inline constexpr __mmask16 kEvery = 0xffff;
#elif defined(__AVX2__) && defined(__FMA__)
inline constexpr int kLanes = 8;
#else
inline constexpr int kLanes = 4;
#endif

typedef float Floats __attribute__((vector_size(4 * kLanes)));
typedef std::int32_t Ints __attribute__((vector_size(4 * kLanes)));
typedef float UnalignedFloats __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));

#define TRIMTAB_INLINE [[gnu::always_inline]] inline

TRIMTAB_INLINE Floats load(const float* from) {
  return *reinterpret_cast<const UnalignedFloats*>(from);
}
TRIMTAB_INLINE void store(float* to, Floats v) {
  *reinterpret_cast<UnalignedFloats*>(to) = v;
}
TRIMTAB_INLINE Floats all(float v) {
  return v - Floats{};
}
TRIMTAB_INLINE Ints all(std::int32_t v) {
  return v - Ints{};
}
TRIMTAB_INLINE Ints bitsOf(Floats v) {
  return reinterpret_cast<Ints>(v);
}
TRIMTAB_INLINE Floats floatOf(Ints bits) {
  return reinterpret_cast<Floats>(bits);
}
TRIMTAB_INLINE Floats toFloats(Ints v) {
  return __builtin_convertvector(v, Floats);
}
TRIMTAB_INLINE Ints toInts(Floats v) {
  return __builtin_convertvector(v, Ints);
}

/// a b + c, rounded once where the machine can.
TRIMTAB_INLINE Floats fma(Floats a, Floats b, Floats c) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return _mm512_fmadd_ps(a, b, c);
#elif defined(__AVX2__) && defined(__FMA__)
  return _mm256_fmadd_ps(a, b, c);
#else
  return a * b + c;
#endif
}
TRIMTAB_INLINE Floats fma(float a, Floats b, Floats c) {
  return fma(all(a), b, c);
}

TRIMTAB_INLINE Floats squareRoot(Floats v) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return _mm512_maskz_sqrt_ps(kEvery, v);
#elif defined(__AVX2__) && defined(__FMA__)
  return _mm256_sqrt_ps(v);
#elif defined(__SSE2__)
  return _mm_sqrt_ps(v);
#else
  for (int i = 0; i < kLanes; ++i) v[i] = __builtin_sqrtf(v[i]);
  return v;
#endif
}

TRIMTAB_INLINE Floats smaller(Floats a, Floats b) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return _mm512_maskz_min_ps(kEvery, a, b);
#elif defined(__AVX2__) && defined(__FMA__)
  return _mm256_min_ps(a, b);
#elif defined(__SSE2__)
  return _mm_min_ps(a, b);
#else
  return a < b ? a : b;
#endif
}
TRIMTAB_INLINE Floats larger(Floats a, Floats b) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return _mm512_maskz_max_ps(kEvery, a, b);
#elif defined(__AVX2__) && defined(__FMA__)
  return _mm256_max_ps(a, b);
#elif defined(__SSE2__)
  return _mm_max_ps(a, b);
#else
  return a > b ? a : b;
#endif
}
TRIMTAB_INLINE Floats magnitude(Floats v) {
  return floatOf(bitsOf(v) & 0x7fffffff);
}

TRIMTAB_INLINE bool any(Ints mask) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return _mm512_movepi32_mask(reinterpret_cast<__m512i>(mask)) != 0;
#elif defined(__AVX2__) && defined(__FMA__)
  return _mm256_movemask_ps(reinterpret_cast<__m256>(mask)) != 0;
#elif defined(__SSE2__)
  return _mm_movemask_ps(reinterpret_cast<__m128>(mask)) != 0;
#else
  for (int i = 0; i < kLanes; ++i)
    if (mask[i] != 0) return true;
  return false;
#endif
}

/// The sum of the first `count` lanes.
TRIMTAB_INLINE double sumOf(Floats v, int count = kLanes) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += v[i];
  return sum;
}

/// x^(1/3) for x in [1e-30, 1e30], to 3e-7 of it.
TRIMTAB_INLINE Floats cubeRoot(Floats x) {
  // x^(-1/3) from a third of the exponent (within 4 %), improved by two steps of its series in the residue.
  Floats r = floatOf(0x54a21d2a - toInts(toFloats(bitsOf(x)) * (1.0f / 3.0f)));
  Floats h = 1.0f - x * (r * r * r);
  r = fma(r * h, fma(h, fma(h, all(14.0f / 81.0f), all(2.0f / 9.0f)), all(1.0f / 3.0f)), r);
  h = 1.0f - x * (r * r * r);
  r = fma(r * h, all(1.0f / 3.0f), r);
  return x * (r * r);
}

/// log2 of a normal number above 0, to 3e-7.
TRIMTAB_INLINE Floats log2Of(Floats x) {
  const Ints bits = bitsOf(x);
  const Ints exponent = (bits - 0x3f3504f3) >> 23;  // the mantissa in [sqrt(1/2), sqrt(2))
  const Floats m = floatOf(bits - (exponent << 23));
  const Floats s = (m - 1.0f) / (m + 1.0f);  // log m = 2 artanh s, |s| < 0.172
  const Floats s2 = s * s;
  const Floats series =
      fma(fma(fma(s2, all(0.412198590f), all(0.577078016f)), s2, all(0.961796694f)), s2, all(2.885390082f));
  return fma(s, series, toFloats(exponent));
}

/// 2^x for x in [-126, 126], to 3e-7 of it.
TRIMTAB_INLINE Floats exp2Of(Floats x) {
  constexpr float kRounder = 12582912.0f;  // 1.5 * 2^23: adding it rounds to a whole number
  const Floats whole = (x + kRounder) - kRounder;
  const Floats f = x - whole;
  Floats series = fma(f, all(1.5403530e-4f), all(1.3333558e-3f));
  series = fma(series, f, all(9.6181291e-3f));
  series = fma(series, f, all(5.5504109e-2f));
  series = fma(series, f, all(0.24022651f));
  series = fma(series, f, all(0.69314718f));
  series = fma(series, f, all(1.0f));
  return floatOf(bitsOf(series) + (toInts(whole) << 23));
}

}  // namespace
}  // namespace trimtab
