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

void flipConvert(const std::uint8_t* reference, const std::uint8_t* test, int pixels, const FlipTable& table,
                 float* planes, std::size_t pitch) {
  for (int x = 0; x < pixels; ++x) {
    const Pixel r = pixelOf(reference + 4 * x, table), d = pixelOf(test + 4 * x, table) - r;
    for (int c = 0; c < 3; ++c) {
      planes[static_cast<std::size_t>(c) * pitch + static_cast<std::size_t>(x)] = r[c];
      planes[static_cast<std::size_t>(c + 3) * pitch + static_cast<std::size_t>(x)] = d[c];
    }
  }
}

/// Vertical pass of one picture's luminance at one column: contrast sensitivity, then the features' three.
void verticalLuminance(const float* const* rows, std::size_t at, const FlipFilters& f, float* out,
                       std::size_t pitch) {
  const Floats middle = load(rows[0] + at), twice = middle + middle;
  Floats luminance = middle, gauss = middle, edge{}, point{};
  int k = 1;
  // (a + b) - 2 m: a plane area has exactly no second derivative.
  for (; k <= f.luminance.radius; ++k) {
    const Floats above = load(rows[-k] + at), below = load(rows[k] + at);
    const Floats bend = (above + below) - twice;
    luminance = fma(f.luminance.weights[k], bend, luminance);
    gauss = fma(f.gauss.weights[k], bend, gauss);
    edge = fma(f.edge.weights[k], below - above, edge);
    point = fma(f.point.weights[k], bend, point);
  }
  for (; k <= f.gauss.radius; ++k) {
    const Floats above = load(rows[-k] + at), below = load(rows[k] + at);
    const Floats bend = (above + below) - twice;
    gauss = fma(f.gauss.weights[k], bend, gauss);
    edge = fma(f.edge.weights[k], below - above, edge);
    point = fma(f.point.weights[k], bend, point);
  }
  store(out, luminance);
  store(out + 4 * pitch, gauss);
  store(out + 5 * pitch, edge);
  store(out + 6 * pitch, point);
}

void verticalColour(const float* const* rows, std::size_t at, std::size_t pitch, const FlipFilters& f,
                    float* out) {
  Floats redGreen = load(rows[0] + at);
  const Floats twice = redGreen + redGreen;
  for (int k = 1; k <= f.redGreen.radius; ++k)
    redGreen = fma(f.redGreen.weights[k], (load(rows[-k] + at) + load(rows[k] + at)) - twice, redGreen);
  const std::size_t second = at + pitch;
  const Floats middle = load(rows[0] + second), twiceMiddle = middle + middle;
  Floats one = middle * f.blueYellow1.sum, two = middle * f.blueYellow2.sum;
  for (int k = 1; k <= f.blueYellow1.radius; ++k) {
    const Floats bend = (load(rows[-k] + second) + load(rows[k] + second)) - twiceMiddle;
    one = fma(f.blueYellow1.weights[k], bend, one);
    two = fma(f.blueYellow2.weights[k], bend, two);
  }
  store(out + pitch, redGreen);
  store(out + 2 * pitch, one);
  store(out + 3 * pitch, two);
}

void flipVertical(const float* const* rows, std::size_t pitch, int from, int to, const FlipFilters& filters,
                  float* filtered) {
  for (int x = from; x < to; x += kLanes)
    for (std::size_t picture = 0; picture < 2; ++picture) {
      const std::size_t at = static_cast<std::size_t>(x) + picture * 3 * pitch;
      float* out = filtered + static_cast<std::size_t>(x) + picture * 7 * pitch;
      verticalLuminance(rows, at, filters, out, pitch);
      verticalColour(rows, at + pitch, pitch, filters, out);
    }
}

/// What the filters leave of one picture at a pixel.
struct Seen {
  Floats luminance, redGreen, blueYellow;
  Floats edgeX, edgeY, pointX, pointY;
};

TRIMTAB_INLINE Floats symmetric(const float* at, const HalfFilter& filter, Floats sum) {
  const Floats middle = load(at), twice = middle + middle;
  sum = fma(filter.sum, middle, sum);
  for (int k = 1; k <= filter.radius; ++k)
    sum = fma(filter.weights[k], (load(at - k) + load(at + k)) - twice, sum);
  return sum;
}

TRIMTAB_INLINE Seen horizontal(const float* at, std::size_t pitch, const FlipFilters& f) {
  Seen s{};
  s.luminance = symmetric(at, f.luminance, Floats{});
  s.redGreen = symmetric(at + pitch, f.redGreen, Floats{});
  s.blueYellow = symmetric(at + 3 * pitch, f.blueYellow2, symmetric(at + 2 * pitch, f.blueYellow1, Floats{}));
  s.edgeY = symmetric(at + 5 * pitch, f.gauss, Floats{});
  s.pointY = symmetric(at + 6 * pitch, f.gauss, Floats{});
  at += 4 * pitch;
  const Floats middle = load(at), twice = middle + middle;
  for (int k = 1; k <= f.gauss.radius; ++k) {
    const Floats left = load(at - k), right = load(at + k);
    s.edgeX = fma(f.edge.weights[k], right - left, s.edgeX);
    s.pointX = fma(f.point.weights[k], (left + right) - twice, s.pointX);
  }
  return s;
}

/// A linear colour and the difference of another one from it.
struct Pair {
  Floats of, difference;
};

/// Clamps both colours to [0, 1].
TRIMTAB_INLINE Pair clamped(Floats of, Floats difference) {
  const Floats other = of + difference;
  const Floats first = smaller(larger(of, Floats{}), all(1.0f));
  const Floats second = smaller(larger(other, Floats{}), all(1.0f));
  const Ints untouched = (first == of) & (second == other);
  return {first, untouched ? difference : second - first};
}

/// CIE Lab's f.
TRIMTAB_INLINE Pair lightness(Pair x) {
  constexpr float kDelta = 6.0f / 29.0f, kLimit = kDelta * kDelta * kDelta;
  constexpr float kSlope = 1.0f / (3.0f * kDelta * kDelta), kOffset = 4.0f / 29.0f;
  const Floats other = x.of + x.difference;
  const Floats a = cubeRoot(larger(x.of, all(kLimit))), b = cubeRoot(larger(other, all(kLimit)));
  const Floats both = fma(a, a + b, b * b);
  Pair f{a, x.difference / both};
  const Ints low = x.of <= kLimit, otherLow = other <= kLimit;
  if (any(low | otherLow)) {
    const Floats first = low ? fma(x.of, all(kSlope), all(kOffset)) : a;
    const Floats second = otherLow ? fma(other, all(kSlope), all(kOffset)) : b;
    f.of = first;
    f.difference =
        (low & otherLow) ? x.difference * kSlope : ((low | otherLow) ? second - first : f.difference);
  }
  return f;
}

/// |sqrt(x^2 + y^2) - sqrt((x + dx)^2 + (y + dy)^2)|
TRIMTAB_INLINE Floats lengthChange(Floats x, Floats y, Floats dx, Floats dy) {
  const Floats x2 = x + dx, y2 = y + dy;
  const Floats lengths = squareRoot(fma(x, x, y * y)) + squareRoot(fma(x2, x2, y2 * y2));
  const Floats change = fma(dx, x + x2, dy * (y + y2));
  return magnitude(change) / larger(lengths, all(1e-30f));
}

/// HyAB of the two colours, Hunt-adjusted, from opponent luminance, X - Y and Y - Z.
TRIMTAB_INLINE Floats colourDifference(const Seen& r, const Seen& d) {
  // To linear RGB: the columns of the matrix for the white point's shares of Y, X - Y and Y - Z.
  constexpr float kX = 0.950428545f, kZ = 1.088900371f;
  constexpr float kToRgb[3][3] = {{3.241003275f * kX, -1.537398934f, -0.498615861f * kZ},
                                  {-0.969224334f * kX, 1.875930071f, 0.041554224f * kZ},
                                  {0.055639423f * kX, -0.204011202f, 1.057148933f * kZ}};
  Pair rgb[3];
  for (int i = 0; i < 3; ++i) {
    const Floats luminance = all(kToRgb[i][0] + kToRgb[i][1] + kToRgb[i][2]);
    const Floats x = all(kToRgb[i][0]), z = all(-kToRgb[i][2]);
    rgb[i] = clamped(fma(luminance, r.luminance, fma(x, r.redGreen, z * r.blueYellow)),
                     fma(luminance, d.luminance, fma(x, d.redGreen, z * d.blueYellow)));
  }
  constexpr float kInverseX = 1.052156925f, kInverseZ = 0.918357670f;
  constexpr float kToXyz[3][3] = {
      {10135552.0f / 24577794.0f * kInverseX, 8788810.0f / 24577794.0f * kInverseX,
       4435075.0f / 24577794.0f * kInverseX},
      {2613072.0f / 12288897.0f, 8788810.0f / 12288897.0f, 887015.0f / 12288897.0f},
      {1425312.0f / 73733382.0f * kInverseZ, 8788810.0f / 73733382.0f * kInverseZ,
       70074185.0f / 73733382.0f * kInverseZ}};
  Pair f[3];
  for (int i = 0; i < 3; ++i) {
    const Floats red = all(kToXyz[i][0]), green = all(kToXyz[i][1]), blue = all(kToXyz[i][2]);
    f[i] = lightness({fma(red, rgb[0].of, fma(green, rgb[1].of, blue * rgb[2].of)),
                      fma(red, rgb[0].difference, fma(green, rgb[1].difference, blue * rgb[2].difference))});
  }
  const Floats l = fma(all(116.0f), f[1].of, all(-16.0f)), dl = 116.0f * f[1].difference;
  const auto huntChange = [&](Floats chroma, Floats change) {
    return 0.01f * fma(l, change, dl * (chroma + change));
  };
  const Floats da = huntChange(500.0f * (f[0].of - f[1].of), 500.0f * (f[0].difference - f[1].difference));
  const Floats db = huntChange(200.0f * (f[1].of - f[2].of), 200.0f * (f[1].difference - f[2].difference));
  return magnitude(dl) + squareRoot(fma(da, da, db * db));
}

TRIMTAB_INLINE Floats errorOf(const Seen& r, const Seen& d, const FlipFilters& f) {
  constexpr float kQc = 0.7f, kPt = 0.95f;
  const Floats hyab = colourDifference(r, d);
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
  const Floats change = larger(lengthChange(r.edgeX, r.edgeY, d.edgeX, d.edgeY),
                               lengthChange(r.pointX, r.pointY, d.pointX, d.pointY));
  const Floats feature = squareRoot(change * 0.70710678f);
  const Floats error = exp2Of(larger(colour * (1.0f - feature), all(-120.0f)));
  return equal ? Floats{} : error;
}

double flipError(const float* filtered, std::size_t pitch, int from, int to, int shift,
                 const FlipFilters& filters, float* error) {
  double sum = 0;
  for (int x = from; x < to; x += kLanes) {
    const float* at = filtered + x + shift;
    const Floats e =
        errorOf(horizontal(at, pitch, filters), horizontal(at + 7 * pitch, pitch, filters), filters);
    const int count = to - x < kLanes ? to - x : kLanes;
    sum += sumOf(e, count);
    if (error) {
      if (count == kLanes)
        store(error + x, e);
      else
        for (int i = 0; i < count; ++i) error[x + i] = e[i];
    }
  }
  return sum;
}

}  // namespace
}  // namespace trimtab
