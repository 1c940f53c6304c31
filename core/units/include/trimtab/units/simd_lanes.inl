// Vectors as wide as one SimdLevel has, in the words of every kernel: simd_levels.inl includes this once per level, inside
// a namespace of its own. kWide is how many floats one vector holds: 16 (AVX-512), 8 (AVX2 and FMA) or 4 (any machine).
// Where a kernel needs another width, the templates take any vector of the compiler's extension.

#if defined(TRIMTAB_AVX512)
inline constexpr int kWide = 16;
// g++ 12 warns of its own plain forms of some instructions (GCC bug 105593), not of those with a mask.
inline constexpr __mmask16 kEvery = 0xffff;
#elif defined(TRIMTAB_AVX2)
inline constexpr int kWide = 8;
#else
inline constexpr int kWide = 4;
#endif

typedef float Floats __attribute__((vector_size(4 * kWide)));
typedef std::int32_t Ints __attribute__((vector_size(4 * kWide)));
typedef double Doubles __attribute__((vector_size(8 * kWide)));
typedef float UnalignedFloats __attribute__((vector_size(4 * kWide), aligned(4), may_alias));

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
#if defined(TRIMTAB_AVX512)
  return _mm512_fmadd_ps(a, b, c);
#elif defined(TRIMTAB_AVX2)
  return _mm256_fmadd_ps(a, b, c);
#else
  return a * b + c;
#endif
}
/// c - a b
TRIMTAB_INLINE Floats negatedFma(Floats a, Floats b, Floats c) {
#if defined(TRIMTAB_AVX512)
  return _mm512_fnmadd_ps(a, b, c);
#elif defined(TRIMTAB_AVX2)
  return _mm256_fnmadd_ps(a, b, c);
#else
  return c - a * b;
#endif
}
TRIMTAB_INLINE Floats fma(float a, Floats b, Floats c) {
  return fma(all(a), b, c);
}

TRIMTAB_INLINE Floats squareRoot(Floats v) {
#if defined(TRIMTAB_AVX512)
  return _mm512_maskz_sqrt_ps(kEvery, v);
#elif defined(TRIMTAB_AVX2)
  return _mm256_sqrt_ps(v);
#elif defined(__SSE2__)
  return _mm_sqrt_ps(v);
#else
  for (int i = 0; i < kWide; ++i) v[i] = __builtin_sqrtf(v[i]);
  return v;
#endif
}

TRIMTAB_INLINE Floats smaller(Floats a, Floats b) {
#if defined(TRIMTAB_AVX512)
  return _mm512_maskz_min_ps(kEvery, a, b);
#elif defined(TRIMTAB_AVX2)
  return _mm256_min_ps(a, b);
#elif defined(__SSE2__)
  return _mm_min_ps(a, b);
#else
  return a < b ? a : b;
#endif
}
TRIMTAB_INLINE Floats larger(Floats a, Floats b) {
#if defined(TRIMTAB_AVX512)
  return _mm512_maskz_max_ps(kEvery, a, b);
#elif defined(TRIMTAB_AVX2)
  return _mm256_max_ps(a, b);
#elif defined(__SSE2__)
  return _mm_max_ps(a, b);
#else
  return a > b ? a : b;
#endif
}
/// Bit k is set where lane k of a mask is.
TRIMTAB_INLINE unsigned bitsOfMask(Ints mask) {
#if defined(TRIMTAB_AVX512)
  return _mm512_movepi32_mask(reinterpret_cast<__m512i>(mask));
#elif defined(TRIMTAB_AVX2)
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
#elif defined(__SSE2__)
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(mask)));
#else
  unsigned bits = 0;
  for (int i = 0; i < kWide; ++i) bits |= static_cast<unsigned>(mask[i] != 0) << i;
  return bits;
#endif
}
TRIMTAB_INLINE bool any(Ints mask) {
  return bitsOfMask(mask) != 0;
}

/// Returns 1 / x to 3e-7 of it.
TRIMTAB_INLINE Floats reciprocal(Floats x) {
#if defined(TRIMTAB_AVX512)
  const Floats r = _mm512_maskz_rcp14_ps(kEvery, x);
  return fma(r, negatedFma(x, r, all(1.0f)), r);
#else
  return 1.0f / x;
#endif
}

// These functions serve vectors of any width. Masks are vectors of integers whose lanes are 0 or -1.

template <class V, class Mask>
TRIMTAB_INLINE V choose(Mask mask, V yes, V no) {
  return reinterpret_cast<V>((mask & reinterpret_cast<Mask>(yes)) | (~mask & reinterpret_cast<Mask>(no)));
}
/// Returns a vector whose lanes are all alike. Nothing is added, so that a zero keeps its sign.
template <class V, class Number>
TRIMTAB_INLINE V spread(Number v) {
  return v - V{};
}
template <class V, class Number>
TRIMTAB_INLINE V read(const Number* from) {
  V v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
template <class V, class Number>
TRIMTAB_INLINE void write(Number* to, V v) {
  __builtin_memcpy(to, &v, sizeof v);
}
template <class V>
TRIMTAB_INLINE V magnitude(V v) {
  using Whole = decltype(v < v);
  return reinterpret_cast<V>(reinterpret_cast<Whole>(v) & spread<Whole>(0x7fffffff));
}
