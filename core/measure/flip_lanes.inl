// Adds to simd_lanes.inl what the kernels of image errors need: partial vectors, pairs of vectors, and roots,
// logarithms and powers.

/// Returns the first `count` lanes, and 0 in the others.
TRIMTAB_INLINE Floats firstLanes(Floats v, int count) {
  if (count == kWide) return v;
  for (int i = count; i < kWide; ++i) v[i] = 0;
  return v;
}

/// Returns the sum of the first `count` lanes.
TRIMTAB_INLINE double sumOf(Floats v, int count = kWide) {
  const Doubles wide = __builtin_convertvector(firstLanes(v, count), Doubles);
  double sum = 0;
  for (int i = 0; i < kWide; ++i) sum += wide[i];
  return sum;
}

/// Two vectors of floats that go through the same arithmetic side by side, so that one's steps fill the
/// other's waits.
struct Twin {
  Floats a, b;
  Twin() = default;  // implicit constructors around it are not compiled for the level
  TRIMTAB_INLINE Twin(Floats both) : a(both), b(both) {}
  TRIMTAB_INLINE Twin(float both) : Twin(all(both)) {}
  TRIMTAB_INLINE Twin(Floats first, Floats second) : a(first), b(second) {}
};
struct TwinInts {
  Ints a, b;
};
TRIMTAB_INLINE Twin operator+(Twin x, Twin y) {
  return {x.a + y.a, x.b + y.b};
}
TRIMTAB_INLINE Twin operator-(Twin x, Twin y) {
  return {x.a - y.a, x.b - y.b};
}
TRIMTAB_INLINE Twin operator*(Twin x, Twin y) {
  return {x.a * y.a, x.b * y.b};
}
TRIMTAB_INLINE TwinInts operator<=(Twin x, Twin y) {
  return {x.a <= y.a, x.b <= y.b};
}
TRIMTAB_INLINE TwinInts operator>=(Twin x, Twin y) {
  return {x.a >= y.a, x.b >= y.b};
}
TRIMTAB_INLINE TwinInts operator==(Twin x, Twin y) {
  return {x.a == y.a, x.b == y.b};
}
TRIMTAB_INLINE TwinInts operator&(TwinInts x, TwinInts y) {
  return {x.a & y.a, x.b & y.b};
}
TRIMTAB_INLINE TwinInts operator+(TwinInts x, TwinInts y) {
  return {x.a + y.a, x.b + y.b};
}
TRIMTAB_INLINE TwinInts operator-(TwinInts x, TwinInts y) {
  return {x.a - y.a, x.b - y.b};
}
TRIMTAB_INLINE TwinInts operator-(TwinInts x, std::int32_t y) {
  return {x.a - y, x.b - y};
}
TRIMTAB_INLINE TwinInts operator-(std::int32_t x, TwinInts y) {
  return {x - y.a, x - y.b};
}
TRIMTAB_INLINE TwinInts operator>>(TwinInts x, int bits) {
  return {x.a >> bits, x.b >> bits};
}
TRIMTAB_INLINE TwinInts operator<<(TwinInts x, int bits) {
  return {x.a << bits, x.b << bits};
}
TRIMTAB_INLINE Twin select(TwinInts mask, Twin x, Twin y) {
  return {mask.a ? x.a : y.a, mask.b ? x.b : y.b};
}
TRIMTAB_INLINE bool any(TwinInts mask) {
  return any(mask.a | mask.b);
}
TRIMTAB_INLINE Twin fma(Twin x, Twin y, Twin z) {
  return {fma(x.a, y.a, z.a), fma(x.b, y.b, z.b)};
}
TRIMTAB_INLINE Twin negatedFma(Twin x, Twin y, Twin z) {
  return {negatedFma(x.a, y.a, z.a), negatedFma(x.b, y.b, z.b)};
}
TRIMTAB_INLINE Twin squareRoot(Twin x) {
  return {squareRoot(x.a), squareRoot(x.b)};
}
TRIMTAB_INLINE Twin reciprocal(Twin x) {
  return {reciprocal(x.a), reciprocal(x.b)};
}
TRIMTAB_INLINE Twin smaller(Twin x, Twin y) {
  return {smaller(x.a, y.a), smaller(x.b, y.b)};
}
TRIMTAB_INLINE Twin larger(Twin x, Twin y) {
  return {larger(x.a, y.a), larger(x.b, y.b)};
}
TRIMTAB_INLINE Twin magnitude(Twin x) {
  return {magnitude(x.a), magnitude(x.b)};
}
TRIMTAB_INLINE TwinInts bitsOf(Twin x) {
  return {bitsOf(x.a), bitsOf(x.b)};
}
TRIMTAB_INLINE Twin floatOf(TwinInts x) {
  return {floatOf(x.a), floatOf(x.b)};
}
TRIMTAB_INLINE Twin toFloats(TwinInts x) {
  return {toFloats(x.a), toFloats(x.b)};
}
TRIMTAB_INLINE TwinInts toInts(Twin x) {
  return {toInts(x.a), toInts(x.b)};
}

/// x^(1/3) for x in [1e-30, 1e30], to 5e-7 of it.
TRIMTAB_INLINE Twin cubeRoot(Twin x) {
  // x^(-1/3) from a third of the exponent, so that h, the residue of its cube, is within 0.103; then
  // (1 - h)^(-1/3) as the polynomial of degree 4 that interpolates it at Chebyshev's points (to 1e-7).
  const Twin r = floatOf(0x54a1f52a - toInts(toFloats(bitsOf(x)) * (1.0f / 3.0f)));
  const Twin h = negatedFma(x, r * r * r, 1.0f);
  Twin series = fma(h, 0.145503381f, 0.174477149f);
  series = fma(h, series, 0.222218313f);
  series = fma(h, series, 0.333329063f);
  series = fma(h, series, 1.0f);
  const Twin root = r * series;
  return x * (root * root);
}

/// log2 of a normal number above 0, to 3e-7 and the rounding of the result.
TRIMTAB_INLINE Twin log2Of(Twin x) {
  const TwinInts bits = bitsOf(x);
  const TwinInts exponent = (bits - 0x3f3504f3) >> 23;  // the mantissa in [sqrt(1/2), sqrt(2))
  const Twin m = floatOf(bits - (exponent << 23));
  const Twin s = (m - 1.0f) * reciprocal(m + 1.0f);  // log m = 2 artanh s, |s| < 0.172
  const Twin s2 = s * s;
  const Twin series = fma(fma(fma(s2, 0.412198590f, 0.577078016f), s2, 0.961796694f), s2, 2.885390082f);
  return fma(s, series, toFloats(exponent));
}

/// 2^x for x in [-126, 126], to 3e-7 of it.
TRIMTAB_INLINE Twin exp2Of(Twin x) {
  constexpr float kRounder = 12582912.0f;  // 1.5 * 2^23: adding it rounds to a whole number
  const Twin whole = (x + kRounder) - kRounder;
  const Twin f = x - whole;
  Twin series = fma(f, 1.5403530e-4f, 1.3333558e-3f);
  series = fma(series, f, 9.6181291e-3f);
  series = fma(series, f, 5.5504109e-2f);
  series = fma(series, f, 0.24022651f);
  series = fma(series, f, 0.69314718f);
  series = fma(series, f, 1.0f);
  return floatOf(bitsOf(series) + (toInts(whole) << 23));
}
