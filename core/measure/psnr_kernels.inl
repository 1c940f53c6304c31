#if defined(TRIMTAB_AVX512)
using Bytes = __m512i;
TRIMTAB_INLINE Bytes loadBytes(const std::uint8_t* from) {
  return _mm512_loadu_si512(from);
}
TRIMTAB_INLINE Bytes distance(Bytes a, Bytes b) {
  return _mm512_or_si512(_mm512_subs_epu8(a, b), _mm512_subs_epu8(b, a));
}
TRIMTAB_INLINE Bytes squaresOfEven(Bytes v) {
  const Bytes even = _mm512_and_si512(v, _mm512_set1_epi32(0x00ff00ff));
  return _mm512_madd_epi16(even, even);
}
TRIMTAB_INLINE Bytes squaresOfGreen(Bytes v) {
  const Bytes green = _mm512_and_si512(_mm512_maskz_srli_epi32(kEvery, v, 8), _mm512_set1_epi32(0xff));
  return _mm512_madd_epi16(green, green);
}
TRIMTAB_INLINE Bytes sum(Bytes a, Bytes b) {
  return _mm512_add_epi32(a, b);
}
#elif defined(TRIMTAB_AVX2)
using Bytes = __m256i;
TRIMTAB_INLINE Bytes loadBytes(const std::uint8_t* from) {
  return _mm256_loadu_si256(reinterpret_cast<const Bytes*>(from));
}
TRIMTAB_INLINE Bytes distance(Bytes a, Bytes b) {
  return _mm256_or_si256(_mm256_subs_epu8(a, b), _mm256_subs_epu8(b, a));
}
TRIMTAB_INLINE Bytes squaresOfEven(Bytes v) {
  const Bytes even = _mm256_and_si256(v, _mm256_set1_epi32(0x00ff00ff));
  return _mm256_madd_epi16(even, even);
}
TRIMTAB_INLINE Bytes squaresOfGreen(Bytes v) {
  const Bytes green = _mm256_and_si256(_mm256_srli_epi32(v, 8), _mm256_set1_epi32(0xff));
  return _mm256_madd_epi16(green, green);
}
TRIMTAB_INLINE Bytes sum(Bytes a, Bytes b) {
  return _mm256_add_epi32(a, b);
}
#elif defined(__SSE2__)
using Bytes = __m128i;
TRIMTAB_INLINE Bytes loadBytes(const std::uint8_t* from) {
  return _mm_loadu_si128(reinterpret_cast<const Bytes*>(from));
}
TRIMTAB_INLINE Bytes distance(Bytes a, Bytes b) {
  return _mm_or_si128(_mm_subs_epu8(a, b), _mm_subs_epu8(b, a));
}
TRIMTAB_INLINE Bytes squaresOfEven(Bytes v) {
  const Bytes even = _mm_and_si128(v, _mm_set1_epi32(0x00ff00ff));
  return _mm_madd_epi16(even, even);
}
TRIMTAB_INLINE Bytes squaresOfGreen(Bytes v) {
  const Bytes green = _mm_and_si128(_mm_srli_epi32(v, 8), _mm_set1_epi32(0xff));
  return _mm_madd_epi16(green, green);
}
TRIMTAB_INLINE Bytes sum(Bytes a, Bytes b) {
  return _mm_add_epi32(a, b);
}
#endif

std::uint64_t squaredErrorOneByOne(const std::uint8_t* a, const std::uint8_t* b, std::size_t pixels) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const int d = a[4 * i + c] - b[4 * i + c];
      sum += static_cast<std::uint32_t>(d * d);
    }
  return sum;
}

std::uint64_t squaredError(const std::uint8_t* a, const std::uint8_t* b, std::size_t pixels) {
#if defined(__SSE2__)
  constexpr std::size_t kStep = 4 * sizeof(Bytes);
  std::uint64_t total = 0;
  std::size_t at = 0;
  const std::size_t end = 4 * pixels / kStep * kStep;
  while (at < end) {
    // A lane of 32 bits holds the squares of 5,000 times four pixels.
    const std::size_t stop = end - at < 5000 * kStep ? end : at + 5000 * kStep;
    Bytes sums[4] = {};
    for (; at < stop; at += kStep)
#pragma GCC unroll 4
      for (std::size_t i = 0; i < 4; ++i) {
        const Bytes d =
            distance(loadBytes(a + at + i * sizeof(Bytes)), loadBytes(b + at + i * sizeof(Bytes)));
        sums[i] = sum(sums[i], sum(squaresOfEven(d), squaresOfGreen(d)));
      }
    std::uint32_t lanes[kStep / 4];
    __builtin_memcpy(lanes, sums, kStep);
    for (const std::uint32_t lane : lanes) total += lane;
  }
  return total + squaredErrorOneByOne(a + at, b + at, pixels - at / 4);
#else
  return squaredErrorOneByOne(a, b, pixels);
#endif
}
