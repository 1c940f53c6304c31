#pragma once

#include "simd.h"
#include "simd_kernels.h"

// FLIP's arithmetic. The test picture is carried as its difference from the reference through every linear
// step, and the differences of roots are taken as quotients: what is equal gives exactly 0, and what is
// nearly equal is not lost in rounding, which the last steps (powers of 0.7 and 0.5) would magnify.

namespace trimtab {
namespace {

typedef float Pixel __attribute__((vector_size(16)));
typedef std::int32_t PixelOrder __attribute__((vector_size(16)));

TRIMTAB_INLINE Pixel pixelOf(const std::uint8_t* rgba, const FlipTable& table) {
  const Pixel r = *reinterpret_cast<const Pixel*>(table[0][rgba[0]]);
  const Pixel g = *reinterpret_cast<const Pixel*>(table[1][rgba[1]]);
  const Pixel b = *reinterpret_cast<const Pixel*>(table[2][rgba[2]]);
  return r + g + b;
}

/// Stores the first three lanes of four pixels as three runs of four.
TRIMTAB_INLINE void storeChannels(Pixel a, Pixel b, Pixel c, Pixel d, float* to, std::size_t pitch) {
  const Pixel ab = __builtin_shufflevector(a, b, 0, 4, 1, 5), cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Pixel ab2 = __builtin_shufflevector(a, b, 2, 6, 3, 7),
              cd2 = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  typedef float UnalignedPixel __attribute__((vector_size(16), aligned(4), may_alias));
  *reinterpret_cast<UnalignedPixel*>(to) = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
  *reinterpret_cast<UnalignedPixel*>(to + pitch) = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
  *reinterpret_cast<UnalignedPixel*>(to + 2 * pitch) = __builtin_shufflevector(ab2, cd2, 0, 1, 4, 5);
}

void flipConvert(const std::uint8_t* reference, const std::uint8_t* test, int pixels, const FlipTable& table,
                 float* planes, std::size_t pitch) {
  int x = 0;
  for (; x + 4 <= pixels; x += 4) {
    Pixel r[4], d[4];
    for (int i = 0; i < 4; ++i) {
      r[i] = pixelOf(reference + 4 * (x + i), table);
      d[i] = pixelOf(test + 4 * (x + i), table) - r[i];
    }
    storeChannels(r[0], r[1], r[2], r[3], planes + x, pitch);
    storeChannels(d[0], d[1], d[2], d[3], planes + x + 3 * pitch, pitch);
  }
  for (; x < pixels; ++x) {
    const Pixel r = pixelOf(reference + 4 * x, table), d = pixelOf(test + 4 * x, table) - r;
    for (int c = 0; c < 3; ++c) {
      planes[static_cast<std::size_t>(c) * pitch + static_cast<std::size_t>(x)] = r[c];
      planes[static_cast<std::size_t>(c + 3) * pitch + static_cast<std::size_t>(x)] = d[c];
    }
  }
}

/// A value of the reference, and of the difference.
struct Both {
  Floats r, d;
};
TRIMTAB_INLINE Both operator+(Both a, Both b) {
  return {a.r + b.r, a.d + b.d};
}
TRIMTAB_INLINE Both operator-(Both a, Both b) {
  return {a.r - b.r, a.d - b.d};
}
TRIMTAB_INLINE Both fma(Floats w, Both a, Both b) {
  return {fma(w, a.r, b.r), fma(w, a.d, b.d)};
}
TRIMTAB_INLINE Both times(float w, Both a) {
  return {w * a.r, w * a.d};
}

TRIMTAB_INLINE void horizontalBlock(const float* at, std::size_t pitch, const FlipFilters& f, float* out) {
  const auto value = [&](std::size_t plane, int k) {
    return Both{load(at + plane * pitch + k), load(at + (plane + 3) * pitch + k)};
  };
  const auto keep = [&](int plane, Both v) {
    store(out + plane * kFlipBlock, v.r);
    store(out + (plane + 7) * kFlipBlock, v.d);
  };
  const Both middle = value(0, 0), twice = middle + middle;
  Both luminance = times(f.luminance.weights[0], middle), gauss = times(f.gauss.weights[0], middle);
  Both edge{}, point{};
  int k = 1;
  for (; k <= f.luminance.radius; ++k) {
    const Both left = value(0, -k), right = value(0, k), sum = left + right;
    luminance = fma(all(f.luminance.weights[k]), sum, luminance);
    gauss = fma(all(f.gauss.weights[k]), sum, gauss);
    edge = fma(all(f.edge.weights[k]), right - left, edge);
    point = fma(all(f.point.weights[k]), sum - twice, point);  // of a plane area exactly 0
  }
  for (; k <= f.gauss.radius; ++k) {
    const Both left = value(0, -k), right = value(0, k), sum = left + right;
    gauss = fma(all(f.gauss.weights[k]), sum, gauss);
    edge = fma(all(f.edge.weights[k]), right - left, edge);
    point = fma(all(f.point.weights[k]), sum - twice, point);
  }
  keep(0, luminance);
  keep(4, gauss);
  keep(5, edge);
  keep(6, point);

  Both redGreen = times(f.redGreen.weights[0], value(1, 0));
  for (k = 1; k <= f.redGreen.radius; ++k)
    redGreen = fma(all(f.redGreen.weights[k]), value(1, -k) + value(1, k), redGreen);
  keep(1, redGreen);

  const Both blueYellow = value(2, 0);
  Both one = times(f.blueYellow1.weights[0], blueYellow), two = times(f.blueYellow2.weights[0], blueYellow);
  for (k = 1; k <= f.blueYellow1.radius; ++k) {
    const Both sum = value(2, -k) + value(2, k);
    one = fma(all(f.blueYellow1.weights[k]), sum, one);
    two = fma(all(f.blueYellow2.weights[k]), sum, two);
  }
  keep(2, one);
  keep(3, two);
}

void flipHorizontal(const float* planes, std::size_t pitch, int blocks, const FlipFilters& filters,
                    float* filtered, std::size_t blockPitch) {
  for (int block = 0; block < blocks; ++block)
    for (int x = 0; x < kFlipBlock; x += kLanes)
      horizontalBlock(planes + block * kFlipBlock + x, pitch, filters,
                      filtered + static_cast<std::size_t>(block) * blockPitch + x);
}

/// What the filters leave of the two pictures at a pixel.
struct Seen {
  Both luminance, redGreen, blueYellow;
  Both edgeX, edgeY, pointX, pointY;
};

TRIMTAB_INLINE Seen vertical(const float* filtered, const std::size_t* rowOffset, const FlipFilters& f) {
  const auto value = [&](int plane, int k) {
    const float* at = filtered + rowOffset[k] + plane * kFlipBlock;
    return Both{load(at), load(at + 7 * kFlipBlock)};
  };
  Seen s{};
  const auto symmetric = [&](int plane, const HalfFilter& filter, Both sum) {
    sum = fma(all(filter.weights[0]), value(plane, 0), sum);
    for (int k = 1; k <= filter.radius; ++k)
      sum = fma(all(filter.weights[k]), value(plane, -k) + value(plane, k), sum);
    return sum;
  };
  s.luminance = symmetric(0, f.luminance, Both{});
  s.redGreen = symmetric(1, f.redGreen, Both{});
  s.blueYellow = symmetric(3, f.blueYellow2, symmetric(2, f.blueYellow1, Both{}));
  const Both middle = value(4, 0), twice = middle + middle;
  s.edgeX = times(f.gauss.weights[0], value(5, 0));
  s.pointX = times(f.gauss.weights[0], value(6, 0));
  for (int k = 1; k <= f.gauss.radius; ++k) {
    const Both above = value(4, -k), below = value(4, k);
    s.edgeY = fma(all(f.edge.weights[k]), below - above, s.edgeY);
    s.pointY = fma(all(f.point.weights[k]), (above + below) - twice, s.pointY);
    const Floats gauss = all(f.gauss.weights[k]);
    s.edgeX = fma(gauss, value(5, -k) + value(5, k), s.edgeX);
    s.pointX = fma(gauss, value(6, -k) + value(6, k), s.pointX);
  }
  return s;
}

/// Clamps both colours to [0, 1].
TRIMTAB_INLINE Both clamped(Floats of, Floats difference) {
  const Floats other = of + difference;
  const Floats first = smaller(larger(of, Floats{}), all(1.0f));
  const Floats second = smaller(larger(other, Floats{}), all(1.0f));
  const Ints untouched = (first == of) & (second == other);
  return {first, untouched ? difference : second - first};
}

/// CIE Lab's f.
TRIMTAB_INLINE Both lightness(Both x) {
  constexpr float kDelta = 6.0f / 29.0f, kLimit = kDelta * kDelta * kDelta;
  constexpr float kSlope = 1.0f / (3.0f * kDelta * kDelta), kOffset = 4.0f / 29.0f;
  const Floats other = x.r + x.d;
  const Floats a = cubeRoot(larger(x.r, all(kLimit))), b = cubeRoot(larger(other, all(kLimit)));
  const Floats both = fma(a, a + b, b * b);
  Both f{a, x.d / both};
  const Ints low = x.r <= kLimit, otherLow = other <= kLimit;
  if (any(low | otherLow)) {
    const Floats first = low ? fma(x.r, all(kSlope), all(kOffset)) : a;
    const Floats second = otherLow ? fma(other, all(kSlope), all(kOffset)) : b;
    f.r = first;
    f.d = (low & otherLow) ? x.d * kSlope : ((low | otherLow) ? second - first : f.d);
  }
  return f;
}

/// |sqrt(x^2 + y^2) - sqrt((x + dx)^2 + (y + dy)^2)|
TRIMTAB_INLINE Floats lengthChange(Both x, Both y) {
  const Floats x2 = x.r + x.d, y2 = y.r + y.d;
  const Floats lengths = squareRoot(fma(x.r, x.r, y.r * y.r)) + squareRoot(fma(x2, x2, y2 * y2));
  const Floats change = fma(x.d, x.r + x2, y.d * (y.r + y2));
  return magnitude(change) / larger(lengths, all(1e-30f));
}

/// HyAB of the two colours, Hunt-adjusted, from opponent luminance, X - Y and Y - Z.
TRIMTAB_INLINE Floats colourDifference(const Seen& s) {
  // To linear RGB: the columns of the matrix for the white point's shares of Y, X - Y and Y - Z.
  constexpr float kX = 0.950428545f, kZ = 1.088900371f;
  constexpr float kToRgb[3][3] = {{3.241003275f * kX, -1.537398934f, -0.498615861f * kZ},
                                  {-0.969224334f * kX, 1.875930071f, 0.041554224f * kZ},
                                  {0.055639423f * kX, -0.204011202f, 1.057148933f * kZ}};
  Both rgb[3];
  for (int i = 0; i < 3; ++i) {
    const Floats luminance = all(kToRgb[i][0] + kToRgb[i][1] + kToRgb[i][2]);
    const Floats x = all(kToRgb[i][0]), z = all(-kToRgb[i][2]);
    rgb[i] = clamped(fma(luminance, s.luminance.r, fma(x, s.redGreen.r, z * s.blueYellow.r)),
                     fma(luminance, s.luminance.d, fma(x, s.redGreen.d, z * s.blueYellow.d)));
  }
  constexpr float kInverseX = 1.052156925f, kInverseZ = 0.918357670f;
  constexpr float kToXyz[3][3] = {
      {10135552.0f / 24577794.0f * kInverseX, 8788810.0f / 24577794.0f * kInverseX,
       4435075.0f / 24577794.0f * kInverseX},
      {2613072.0f / 12288897.0f, 8788810.0f / 12288897.0f, 887015.0f / 12288897.0f},
      {1425312.0f / 73733382.0f * kInverseZ, 8788810.0f / 73733382.0f * kInverseZ,
       70074185.0f / 73733382.0f * kInverseZ}};
  Both f[3];
  for (int i = 0; i < 3; ++i) {
    const Floats red = all(kToXyz[i][0]), green = all(kToXyz[i][1]), blue = all(kToXyz[i][2]);
    f[i] = lightness({fma(red, rgb[0].r, fma(green, rgb[1].r, blue * rgb[2].r)),
                      fma(red, rgb[0].d, fma(green, rgb[1].d, blue * rgb[2].d))});
  }
  const Floats l = fma(all(116.0f), f[1].r, all(-16.0f)), dl = 116.0f * f[1].d;
  const auto huntChange = [&](Floats chroma, Floats change) {
    return 0.01f * fma(l, change, dl * (chroma + change));
  };
  const Floats da = huntChange(500.0f * (f[0].r - f[1].r), 500.0f * (f[0].d - f[1].d));
  const Floats db = huntChange(200.0f * (f[1].r - f[2].r), 200.0f * (f[1].d - f[2].d));
  return magnitude(dl) + squareRoot(fma(da, da, db * db));
}

TRIMTAB_INLINE Floats errorOf(const Seen& s, const FlipFilters& f) {
  constexpr float kQc = 0.7f, kPt = 0.95f;
  const Floats hyab = colourDifference(s);
  const Ints equal = hyab <= 1e-30f;
  const Floats raised = kQc * log2Of(larger(hyab, all(1e-30f)));
  Floats colour = raised + f.colourScale;
  const Floats power = exp2Of(raised);
  const Ints beyond = power >= f.colourKnee;
  if (any(beyond)) {
    const Floats upper =
        fma(power - f.colourKnee, all((1 - kPt) / (f.colourMaximum - f.colourKnee)), all(kPt));
    colour = beyond ? log2Of(upper) : colour;
  }
  const Floats change = larger(lengthChange(s.edgeX, s.edgeY), lengthChange(s.pointX, s.pointY));
  const Floats feature = squareRoot(change * 0.70710678f);
  const Floats error = exp2Of(larger(colour * (1.0f - feature), all(-120.0f)));
  return equal ? Floats{} : error;
}

double flipError(const float* filtered, std::size_t blockPitch, const std::size_t* rowOffset, int rows,
                 int columns, const FlipFilters& filters, float* error, std::size_t errorPitch) {
  double sum = 0;
  for (int x = 0; x < columns; x += kLanes) {
    const float* block = filtered + static_cast<std::size_t>(x / kFlipBlock) * blockPitch + x % kFlipBlock;
    const int count = columns - x < kLanes ? columns - x : kLanes;
    for (int row = 0; row < rows; ++row) {
      const Floats e = errorOf(vertical(block, rowOffset + row, filters), filters);
      sum += sumOf(e, count);
      if (!error) continue;
      float* to = error + static_cast<std::size_t>(row) * errorPitch + x;
      if (count == kLanes)
        store(to, e);
      else
        for (int i = 0; i < count; ++i) to[i] = e[i];
    }
  }
  return sum;
}

}  // namespace
}  // namespace trimtab
