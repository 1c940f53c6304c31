// FLIP's arithmetic. The test image is carried as its difference from the reference through every linear
// step, and the differences of roots are taken as quotients: what is equal gives exactly 0, and what is
// nearly equal is not lost in rounding, which the last steps (powers of 0.7 and 0.5) would magnify.

typedef float Pixel __attribute__((vector_size(16)));
typedef std::int32_t PixelOrder __attribute__((vector_size(16)));

TRIMTAB_INLINE Pixel pixelOf(const std::uint8_t* rgba, const FlipTable& table) {
  std::uint32_t bytes;
  __builtin_memcpy(&bytes, rgba, 4);
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
  bytes = __builtin_bswap32(bytes);
#endif
  const Pixel r = *reinterpret_cast<const Pixel*>(table[0][bytes & 255]);
  const Pixel g = *reinterpret_cast<const Pixel*>(table[1][bytes >> 8 & 255]);
  const Pixel b = *reinterpret_cast<const Pixel*>(table[2][bytes >> 16 & 255]);
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

/// Holds a number that the compiler knows.
template <int N>
struct Known {
  constexpr operator int() const { return N; }
};
/// Says how far the filters reach: known for the default number of pixels per degree, so that loops are
/// unrolled.
struct AnyReach {
  explicit AnyReach(const FlipFilters& f)
      : luminance(f.luminance.radius),
        redGreen(f.redGreen.radius),
        blueYellow(f.blueYellow1.radius),
        features(f.gauss.radius) {}
  int luminance, redGreen, blueYellow, features;
};
struct DefaultReach {
  static constexpr Known<6> luminance{};
  static constexpr Known<7> redGreen{};
  static constexpr Known<10> blueYellow{};
  static constexpr Known<9> features{};
};
bool isDefault(const FlipFilters& f) {
  return f.luminance.radius == DefaultReach::luminance && f.redGreen.radius == DefaultReach::redGreen &&
         f.blueYellow1.radius == DefaultReach::blueYellow && f.gauss.radius == DefaultReach::features;
}

/// Calls `tap(k)` for k from 1 to the radius.
template <class Tap>
TRIMTAB_INLINE void forTaps(int radius, const Tap& tap) {
  for (int k = 1; k <= radius; ++k) tap(k);
}
template <int N, class Tap>
TRIMTAB_INLINE void forTaps(Known<N>, const Tap& tap) {
#pragma GCC unroll 16
  for (int k = 1; k <= N; ++k) tap(k);
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

template <class Reach>
TRIMTAB_INLINE void horizontalBlock(const float* at, std::size_t pitch, const FlipFilters& f,
                                    const Reach& reach, float* out) {
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
  forTaps(reach.features, [&](int k) {
    const Both left = value(0, -k), right = value(0, k), sum = left + right;
    if (k <= reach.luminance) luminance = fma(all(f.luminance.weights[k]), sum, luminance);
    gauss = fma(all(f.gauss.weights[k]), sum, gauss);
    edge = fma(all(f.edge.weights[k]), right - left, edge);
    point = fma(all(f.point.weights[k]), sum - twice, point);  // of a plane area exactly 0
  });
  keep(0, luminance);
  keep(4, gauss);
  keep(5, edge);
  keep(6, point);

  Both redGreen = times(f.redGreen.weights[0], value(1, 0));
  forTaps(reach.redGreen,
          [&](int k) { redGreen = fma(all(f.redGreen.weights[k]), value(1, -k) + value(1, k), redGreen); });
  keep(1, redGreen);

  const Both blueYellow = value(2, 0);
  Both one = times(f.blueYellow1.weights[0], blueYellow), two = times(f.blueYellow2.weights[0], blueYellow);
  forTaps(reach.blueYellow, [&](int k) {
    const Both sum = value(2, -k) + value(2, k);
    one = fma(all(f.blueYellow1.weights[k]), sum, one);
    two = fma(all(f.blueYellow2.weights[k]), sum, two);
  });
  keep(2, one);
  keep(3, two);
}

template <class Reach>
void horizontal(const float* planes, std::size_t pitch, int blocks, const FlipFilters& filters,
                const Reach& reach, float* filtered, std::size_t blockPitch) {
  for (int block = 0; block < blocks; ++block)
    for (int x = 0; x < kFlipBlock; x += kWide)
      horizontalBlock(planes + block * kFlipBlock + x, pitch, filters, reach,
                      filtered + static_cast<std::size_t>(block) * blockPitch + x);
}

void flipHorizontal(const float* planes, std::size_t pitch, int blocks, const FlipFilters& filters,
                    float* filtered, std::size_t blockPitch) {
  if (isDefault(filters))
    horizontal(planes, pitch, blocks, filters, DefaultReach{}, filtered, blockPitch);
  else
    horizontal(planes, pitch, blocks, filters, AnyReach(filters), filtered, blockPitch);
}

/// Two rows of the reference, and of the difference.
struct BothRows {
  Twin r, d;
};
/// Holds what the filters leave of the two images at the pixels of two rows.
struct Seen {
  BothRows luminance, redGreen, blueYellow;
  BothRows edgeX, edgeY, pointX, pointY;
};

/// Runs the vertical pass at two rows, one below the other: what one reads above or below it, the other has
/// just read.
template <class Reach>
class TwoRows {
 public:
  TwoRows(const float* filtered, const std::size_t* rowOffset, const FlipFilters& filters, const Reach& reach)
      : filtered_(filtered), rowOffset_(rowOffset), f_(filters), reach_(reach) {}

  TRIMTAB_INLINE Seen seen() const {
    Seen s;
    s.luminance = symmetric(0, f_.luminance, reach_.luminance, {}).rows();
    s.redGreen = symmetric(1, f_.redGreen, reach_.redGreen, {}).rows();
    s.blueYellow =
        symmetric(3, f_.blueYellow2, reach_.blueYellow, symmetric(2, f_.blueYellow1, reach_.blueYellow, {}))
            .rows();
    Values edge, point;
    derivatives(edge, point);
    s.edgeY = edge.rows();
    s.pointY = point.rows();
    s.edgeX = symmetric(5, f_.gauss, reach_.features, {}).rows();
    s.pointX = symmetric(6, f_.gauss, reach_.features, {}).rows();
    return s;
  }

 private:
  struct Values {
    Both row[2] = {};
    TRIMTAB_INLINE BothRows rows() const { return {{row[0].r, row[1].r}, {row[0].d, row[1].d}}; }
  };

  TRIMTAB_INLINE Both value(int plane, int k) const {
    const float* at = filtered_ + rowOffset_[k] + plane * kFlipBlock;
    return {load(at), load(at + 7 * kFlipBlock)};
  }

  template <class Radius>
  TRIMTAB_INLINE Values symmetric(int plane, const HalfFilter& filter, Radius radius, Values sum) const {
    Both above = value(plane, 0), below = value(plane, 1);
    sum.row[0] = fma(all(filter.weights[0]), above, sum.row[0]);
    sum.row[1] = fma(all(filter.weights[0]), below, sum.row[1]);
    forTaps(radius, [&](int k) {
      const Floats w = all(filter.weights[k]);
      const Both higher = value(plane, -k), lower = value(plane, 1 + k);
      sum.row[0] = fma(w, higher + below, sum.row[0]);
      sum.row[1] = fma(w, above + lower, sum.row[1]);
      above = higher;
      below = lower;
    });
    return sum;
  }

  TRIMTAB_INLINE void derivatives(Values& edge, Values& point) const {
    Both above = value(4, 0), below = value(4, 1);
    const Both twice = above + above, twiceNext = below + below;
    forTaps(reach_.features, [&](int k) {
      const Both higher = value(4, -k), lower = value(4, 1 + k);
      const Floats w = all(f_.edge.weights[k]), v = all(f_.point.weights[k]);
      edge.row[0] = fma(w, below - higher, edge.row[0]);
      edge.row[1] = fma(w, lower - above, edge.row[1]);
      point.row[0] = fma(v, (higher + below) - twice, point.row[0]);
      point.row[1] = fma(v, (above + lower) - twiceNext, point.row[1]);
      above = higher;
      below = lower;
    });
  }

  const float* filtered_;
  const std::size_t* rowOffset_;
  const FlipFilters& f_;
  const Reach& reach_;
};

/// Clamps both colours to [0, 1].
TRIMTAB_INLINE BothRows clamped(Twin of, Twin difference) {
  const Twin other = of + difference;
  const Twin first = smaller(larger(of, Twin{}), 1.0f);
  const Twin second = smaller(larger(other, Twin{}), 1.0f);
  const TwinInts untouched = (first == of) & (second == other);
  return {first, select(untouched, difference, second - first)};
}

/// CIE Lab's f.
TRIMTAB_INLINE BothRows lightness(BothRows x) {
  constexpr float kDelta = 6.0f / 29.0f, kLimit = kDelta * kDelta * kDelta;
  constexpr float kSlope = 1.0f / (3.0f * kDelta * kDelta);
  // The part of each value beyond the limit has its root taken; the part below it is on a line.
  const Twin other = x.r + x.d;
  const Twin high = larger(x.r, kLimit), otherHigh = larger(other, kLimit);
  const TwinInts bothHigh = (high == x.r) & (otherHigh == other);
  const Twin highChange = select(bothHigh, x.d, otherHigh - high);
  const Twin a = cubeRoot(high), b = cubeRoot(otherHigh);
  return {fma(kSlope, x.r - high, a),
          fma(kSlope, x.d - highChange, highChange * reciprocal(fma(a, a + b, b * b)))};
}

/// |sqrt(x^2 + y^2) - sqrt((x + dx)^2 + (y + dy)^2)|
TRIMTAB_INLINE Twin lengthChange(BothRows x, BothRows y) {
  const Twin x2 = x.r + x.d, y2 = y.r + y.d;
  const Twin lengths = squareRoot(fma(x.r, x.r, y.r * y.r)) + squareRoot(fma(x2, x2, y2 * y2));
  const Twin change = fma(x.d, x.r + x2, y.d * (y.r + y2));
  return magnitude(change) * reciprocal(larger(lengths, 1e-30f));
}

/// HyAB of the two colours, Hunt-adjusted, from opponent luminance, X - Y and Y - Z.
TRIMTAB_INLINE Twin colourDifference(const Seen& s) {
  // The columns of the matrix to linear RGB, for the white point's shares of Y, X - Y and Y - Z.
  constexpr float kX = 0.950428545f, kZ = 1.088900371f;
  constexpr float kToRgb[3][3] = {{3.241003275f * kX, -1.537398934f, -0.498615861f * kZ},
                                  {-0.969224334f * kX, 1.875930071f, 0.041554224f * kZ},
                                  {0.055639423f * kX, -0.204011202f, 1.057148933f * kZ}};
  BothRows rgb[3];
  for (int i = 0; i < 3; ++i) {
    const Twin luminance = kToRgb[i][0] + kToRgb[i][1] + kToRgb[i][2];
    const Twin x = kToRgb[i][0], z = -kToRgb[i][2];
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
  BothRows f[3];
  for (int i = 0; i < 3; ++i) {
    const Twin red = kToXyz[i][0], green = kToXyz[i][1], blue = kToXyz[i][2];
    f[i] = lightness({fma(red, rgb[0].r, fma(green, rgb[1].r, blue * rgb[2].r)),
                      fma(red, rgb[0].d, fma(green, rgb[1].d, blue * rgb[2].d))});
  }
  const Twin l = fma(116.0f, f[1].r, -16.0f), dl = 116.0f * f[1].d;
  const auto huntChange = [&](Twin chroma, Twin change) {
    return 0.01f * fma(l, change, dl * (chroma + change));
  };
  const Twin da = huntChange(500.0f * (f[0].r - f[1].r), 500.0f * (f[0].d - f[1].d));
  const Twin db = huntChange(200.0f * (f[1].r - f[2].r), 200.0f * (f[1].d - f[2].d));
  return magnitude(dl) + squareRoot(fma(da, da, db * db));
}

TRIMTAB_INLINE Twin errorOf(const Seen& s, const FlipFilters& f) {
  constexpr float kQc = 0.7f, kPt = 0.95f, kLogPt = -0.0740005814f;
  const Twin hyab = colourDifference(s);
  const Twin raised = kQc * log2Of(larger(hyab, 1e-30f));
  Twin colour = raised + f.colourScale;
  const TwinInts beyond = colour >= kLogPt;
  if (any(beyond)) {
    const Twin upper = fma(exp2Of(raised) - f.colourKnee, (1 - kPt) / (f.colourMaximum - f.colourKnee), kPt);
    colour = select(beyond, log2Of(larger(upper, 0.5f)), colour);
  }
  const Twin change = larger(lengthChange(s.edgeX, s.edgeY), lengthChange(s.pointX, s.pointY));
  const Twin feature = squareRoot(change * 0.70710678f);
  const Twin error = exp2Of(larger(colour * (1.0f - feature), -120.0f));
  return select(hyab <= 1e-30f, Twin{}, error);
}

template <class Reach>
double errors(const float* filtered, std::size_t blockPitch, const std::size_t* rowOffset, int rows,
              int columns, const FlipFilters& filters, const Reach& reach, float* error,
              std::size_t errorPitch) {
  Doubles sum{};
  for (int x = 0; x < columns; x += kWide) {
    const float* block = filtered + static_cast<std::size_t>(x / kFlipBlock) * blockPitch + x % kFlipBlock;
    const int count = columns - x < kWide ? columns - x : kWide;
    for (int row = 0; row < rows; row += 2) {
      const Twin found = errorOf(TwoRows<Reach>(block, rowOffset + row, filters, reach).seen(), filters);
      for (int i = 0; i < 2 && row + i < rows; ++i) {
        const Floats e = firstLanes(i == 0 ? found.a : found.b, count);
        sum += __builtin_convertvector(e, Doubles);
        if (!error) continue;
        float* to = error + static_cast<std::size_t>(row + i) * errorPitch + x;
        if (count == kWide)
          store(to, e);
        else
          for (int lane = 0; lane < count; ++lane) to[lane] = e[lane];
      }
    }
  }
  double total = 0;
  for (int lane = 0; lane < kWide; ++lane) total += sum[lane];
  return total;
}

double flipError(const float* filtered, std::size_t blockPitch, const std::size_t* rowOffset, int rows,
                 int columns, const FlipFilters& filters, float* error, std::size_t errorPitch) {
  if (isDefault(filters))
    return errors(filtered, blockPitch, rowOffset, rows, columns, filters, DefaultReach{}, error, errorPitch);
  return errors(filtered, blockPitch, rowOffset, rows, columns, filters, AnyReach(filters), error,
                errorPitch);
}
