// The loops of depth_raster.h, for simd_levels.inl. F and I are eight floats and eight integers; a triangle's
// rows are filled by Floats, as many texels at a time as the level has.

TRIMTAB_INLINE F select(I condition, F yes, F no) {
  return choose(condition, yes, no);
}
TRIMTAB_INLINE I select(I condition, I yes, I no) {
  return choose(condition, yes, no);
}
TRIMTAB_INLINE F least(F a, F b) {
  return select(a < b, a, b);
}
TRIMTAB_INLINE F most(F a, F b) {
  return select(a > b, a, b);
}
TRIMTAB_INLINE F spread(float v) {
  return spread<F>(v);
}
TRIMTAB_INLINE I spread(std::int32_t v) {
  return spread<I>(v);
}
TRIMTAB_INLINE F read(const float* from) {
  return read<F>(from);
}
/// The lanes whose sign is set.
TRIMTAB_INLINE unsigned bitsOf(I lanes) {
#if defined(TRIMTAB_AVX2) || defined(TRIMTAB_AVX512)
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(lanes)));
#else
  unsigned bits = 0;
  for (std::size_t k = 0; k < kLanes; ++k) bits |= (static_cast<unsigned>(lanes[k]) & 1u) << k;
  return bits;
#endif
}
TRIMTAB_INLINE void write(std::uint8_t* to, I v) {
  for (std::size_t k = 0; k < kLanes; ++k) to[k] = static_cast<std::uint8_t>(v[k]);
}
TRIMTAB_INLINE F toFloat(I v) {
  return __builtin_convertvector(v, F);
}
/// The number must fit into a whole one.
TRIMTAB_INLINE I roundedDown(F v) {
  const I cut = __builtin_convertvector(v, I);
  return cut + (toFloat(cut) > v);
}
TRIMTAB_INLINE F gathered(const float* from, const std::uint16_t* at) {
  return F{from[at[0]], from[at[1]], from[at[2]], from[at[3]],
           from[at[4]], from[at[5]], from[at[6]], from[at[7]]};
}

void projectLanes(const Projection& p, const Vertices& v, Seen& seen) {
  const F nan = spread(std::numeric_limits<float>::quiet_NaN()), one = spread(1.0f), zero = spread(0.0f);
  I any = spread(0);
  for (std::size_t i = 0; i < v.count; i += kLanes) {
    const F x = read(v.x + i) + spread(p.offset[0]), y = read(v.y + i) + spread(p.offset[1]),
            z = read(v.z + i) + spread(p.offset[2]);
    const auto along = [&](const std::array<float, 3>& axis) {
      return x * spread(axis[0]) + y * spread(axis[1]) + z * spread(axis[2]);
    };
    const F depth = along(p.forward), ahead = most(depth, zero);
    F slope = read(v.slope + i);
    // How far sideways the samples of this vertex's triangles look; no less than sqrt(1 + slope^2) is used.
    const float wide = 1.25f * std::max(p.aside[0], p.aside[1]);
    const auto sideways = [&] { return spread(wide) * (ahead + spread(2 * p.edge) * (one + slope)); };
    const I far = sideways() > spread(p.reach);
    slope = select(far, most(slope, spread(p.farSlope)), slope);
    const F leaning = one - slope * spread(p.tilt);
    I usable = (sideways() <= spread(p.farReach)) & (leaning > spread(0.5f));
    slope = (slope + spread(p.tilt)) / leaning;
    const F k =
        most(spread(p.down[0]) + slope * spread(p.aside[0]), spread(p.down[1]) + slope * spread(p.aside[1]));
    // Lowering changes the depth that decides how much to lower: solved for the vertex as lowered.
    const F solved = one + k * spread(p.forward[2]);
    usable &= solved > spread(0.25f);
    const F lower = k * ahead / solved * spread(p.lowering);
    const F low = depth - lower * spread(p.forward[2]), right = along(p.right) - lower * spread(p.right[2]),
            up = along(p.up) - lower * spread(p.up[2]);
    const F per = one / low;
    const F sx = right * per * spread(p.scaleX) + spread(p.left),
            sy = up * per * spread(p.scaleY) + spread(p.bottom);
    const I there = (low > spread(p.nearM * 1.01f)) & (magnitude(sx) <= spread(kGuard)) &
                    (magnitude(sy) <= spread(kGuard));
    // What is not a number is dropped, not clipped.
    usable &=
        (magnitude(low) < spread(1e9f)) & (magnitude(right) < spread(1e9f)) & (magnitude(up) < spread(1e9f));
    const I drawn = there & usable;
    write(seen.x.data() + i, select(drawn, sx, nan));
    write(seen.y.data() + i, sy);
    write(seen.w.data() + i, spread(p.nearM) * per);
    write(seen.right.data() + i, right);
    write(seen.up.data() + i, up);
    write(seen.depth.data() + i, low);
    write(seen.kept.data() + i,
          select(usable, spread(std::int32_t{Seen::kClip}) & ~there, spread(std::int32_t{Seen::kDropped})));
    any |= ~drawn;
  }
  seen.anyKept = bitsOf(any) != 0;
}

/// Eight triangles that are ready to be filled: of each edge what it is at the first texel's centre and how
/// it changes; the same of the depth.
struct Ready {
  F edge[3], acrossX[3], acrossY[3];
  F w, wX, wY, farthest;
  I x0, x1, y0, y1;
};

/// One triangle, as many texels of a row at a time as the processor has lanes.
struct Filler {
  Floats edge[3], acrossX[3], acrossY[3], w, wX, wY;
  Ints farthest;

  TRIMTAB_INLINE Filler(const Ready& r, std::size_t i) {
    for (std::size_t k = 0; k < 3; ++k) {
      edge[k] = spread<Floats>(r.edge[k][i]);
      acrossX[k] = spread<Floats>(r.acrossX[k][i]);
      acrossY[k] = spread<Floats>(r.acrossY[k][i]);
    }
    w = spread<Floats>(r.w[i]);
    wX = spread<Floats>(r.wX[i]);
    wY = spread<Floats>(r.wY[i]);
    farthest = reinterpret_cast<Ints>(spread<Floats>(r.farthest[i]));
  }
  /// At texels `step` to the side of the first.
  TRIMTAB_INLINE void begin(Floats step) {
    for (std::size_t k = 0; k < 3; ++k) e_[k] = edge[k] + acrossX[k] * step;
    w_ = w + wX * step;
  }
  TRIMTAB_INLINE void row(float* texels, float above) const {
    const Floats up = spread<Floats>(above);
    // Sign bits are compared as those of whole numbers, which is right because depths are not negative
    // either.
    const Ints out = reinterpret_cast<Ints>(e_[0] + acrossY[0] * up) |
                     reinterpret_cast<Ints>(e_[1] + acrossY[1] * up) |
                     reinterpret_cast<Ints>(e_[2] + acrossY[2] * up);
    const Ints plane = reinterpret_cast<Ints>(w_ + wY * up);
    const Ints depth = (plane > farthest ? plane : farthest) & ~(out >> 31);
    Ints there;
    std::memcpy(&there, texels, sizeof there);
    there = there > depth ? there : depth;
    std::memcpy(texels, &there, sizeof there);
  }

 private:
  Floats e_[3], w_;
};

/// `kRows` are few: as many as are filled without a look at the triangle's own.
TRIMTAB_INLINE void fillBlock(const Texels& to, const Ready& r, std::size_t i) {
  const int x = r.x0[i] & ~(kWide - 1);
  Filler filler(r, i);
  filler.begin(read<Floats>(kSteps) + spread<Floats>(static_cast<float>(x - r.x0[i])));
  float* row = to.first + static_cast<std::ptrdiff_t>(r.y0[i]) * to.stride + x;
  for (int y = 0; y < kBlockRows; ++y)
    filler.row(row + static_cast<std::ptrdiff_t>(y) * to.stride, static_cast<float>(y));
}

TRIMTAB_INLINE void fill(const Texels& to, const Ready& r, std::size_t i) {
  // From a whole group of lanes on: what was stored a moment ago is read again at the same place.
  Filler filler(r, i);
  const int x0 = r.x0[i], x1 = r.x1[i], rows = r.y1[i] - r.y0[i] + 1, stride = to.stride;
  float* first = to.first + static_cast<std::ptrdiff_t>(r.y0[i]) * stride;
  for (int x = x0 & ~(kWide - 1); x <= x1; x += kWide) {
    filler.begin(read<Floats>(kSteps) + spread<Floats>(static_cast<float>(x - x0)));
    float *row = first + x, above = 0;
    for (int y = 0; y < rows; ++y, row += stride, above += 1) filler.row(row, above);
  }
}

/// Triangles of few texels, eight triangles at a time: each texel of the smallest box that holds any of them.
TRIMTAB_INLINE void fillSmall(const Texels& to, const Ready& r, I small) {
  const I wide = (r.x1 - r.x0) & small, high = (r.y1 - r.y0) & small;
  int width = 0, height = 0;
  for (std::size_t k = 0; k < kLanes; ++k) {
    width = std::max(width, wide[k]);
    height = std::max(height, high[k]);
  }
  const I first = r.y0 * spread(to.stride) + r.x0;
  for (int y = 0; y <= height; ++y) {
    const F up = spread(static_cast<float>(y));
    const F e0 = r.edge[0] + r.acrossY[0] * up, e1 = r.edge[1] + r.acrossY[1] * up,
            e2 = r.edge[2] + r.acrossY[2] * up, w = r.w + r.wY * up;
    const I inRow = small & (spread(y) <= high);
    for (int x = 0; x <= width; ++x) {
      const F step = spread(static_cast<float>(x));
      const I out = reinterpret_cast<I>(e0 + r.acrossX[0] * step) |
                    reinterpret_cast<I>(e1 + r.acrossX[1] * step) |
                    reinterpret_cast<I>(e2 + r.acrossX[2] * step);
      unsigned bits = bitsOf(inRow & (spread(x) <= wide) & (out >= 0));
      if (bits == 0) continue;
      const I plane = reinterpret_cast<I>(w + r.wX * step), least = reinterpret_cast<I>(r.farthest);
      const F depth = reinterpret_cast<F>(plane > least ? plane : least);
      const I at = first + spread(y * to.stride + x);
      for (; bits != 0; bits &= bits - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(bits));
        float& texel = to.first[at[k]];
        const float there = texel, here = depth[k];
        texel = there < here ? here : there;
      }
    }
  }
}

void drawLanes(const Texels& to, const Seen& seen, const Triangles& triangles, Touched& touched) {
  const F one = spread(1.0f), half = spread(0.5f);
  I leftmost = spread(1 << 30), lowest = leftmost, rightmost = spread(-1), topmost = rightmost;
  Ready r;
  for (std::size_t g = 0; g < triangles.groups(); ++g) {
    const std::uint16_t* at = triangles.group(g);
    const F x0 = gathered(seen.x.data(), at), x1 = gathered(seen.x.data(), at + kLanes),
            x2 = gathered(seen.x.data(), at + 2 * kLanes);
    const F y0 = gathered(seen.y.data(), at), y1 = gathered(seen.y.data(), at + kLanes),
            y2 = gathered(seen.y.data(), at + 2 * kLanes);
    const F dx1 = x1 - x0, dy1 = y1 - y0, dx2 = x2 - x0, dy2 = y2 - y0;
    const F p = dx1 * dy2, q = dx2 * dy1, area = p - q;
    // Anticlockwise as seen; not so where a corner is not a number.
    I drawn = area > spread(0.0f);
    if (bitsOf(drawn) == 0) continue;
    const F right = most(most(x0, x1), x2), left = least(least(x0, x1), x2), top = most(most(y0, y1), y2),
            bottom = least(least(y0, y1), y2);
    // Texels whose centres lie between.
    const auto first = [&](F low) {
      const F from = most(low - half, spread(0.0f));
      const I cut = __builtin_convertvector(from, I);
      return cut - (toFloat(cut) < from);
    };
    const auto last = [&](F high, int size) {
      return roundedDown(most(least(high - half, spread(static_cast<float>(size - 1))), -one));
    };
    const I fx = first(left), lx = last(right, to.width), fy = first(bottom), ly = last(top, to.height);
    drawn &= (fx <= lx) & (fy <= ly);
    unsigned bits = bitsOf(drawn);
    if (bits == 0) continue;
    const F w0 = gathered(seen.w.data(), at), w1 = gathered(seen.w.data(), at + kLanes),
            w2 = gathered(seen.w.data(), at + 2 * kLanes);
    leftmost = select(drawn & (fx < leftmost), fx, leftmost);
    lowest = select(drawn & (fy < lowest), fy, lowest);
    rightmost = select(drawn & (lx > rightmost), lx, rightmost);
    topmost = select(drawn & (ly > topmost), ly, topmost);

    const F cx = toFloat(fx) + half, cy = toFloat(fy) + half;
    const auto edge = [&](int k, F ax, F ay, F bx, F by) {
      const F stepX = ay - by, stepY = bx - ax;
      r.edge[k] = stepX * (cx - ax) + stepY * (cy - ay);
      r.acrossX[k] = stepX;
      r.acrossY[k] = stepY;
    };
    edge(0, x0, y0, x1, y1);
    edge(1, x1, y1, x2, y2);
    edge(2, x2, y2, x0, y0);
    const F per = one / area, dw1 = w1 - w0, dw2 = w2 - w0;
    const F wX = (dw1 * dy2 - dw2 * dy1) * per, wY = (dw2 * dx1 - dw1 * dx2) * per;
    const F near = most(most(w0, w1), w2), far = least(least(w0, w1), w2);
    // How wrong the plane can be: depth_map.h.
    const F thin = (right - left) * (top - bottom) * per;
    const F wrong = (magnitude(wX) + magnitude(wY)) * spread(kOutsideEdge) +
                    (near - far) * spread(kRounding) * thin * (one + thin);
    const F w = w0 + wX * (cx - x0) + wY * (cy - y0) - wrong;
    // A plane that is not of numbers, or is nearly upright, counts by its vertices alone.
    const I flat = (magnitude(wX) < one) & (magnitude(wY) < one) & (magnitude(w) < spread(kGuard * 2));
    r.w = select(flat, w, -one);
    r.wX = reinterpret_cast<F>(reinterpret_cast<I>(wX) & flat);
    r.wY = reinterpret_cast<F>(reinterpret_cast<I>(wY) & flat);
    r.farthest = far;
    r.x0 = fx;
    r.x1 = lx;
    r.y0 = fy;
    r.y1 = ly;
    const I small = drawn & (lx - fx < spread(kSmall)) & (ly - fy < spread(kSmall));
    const unsigned few = bitsOf(small);
    if (few != 0) fillSmall(to, r, small);
    const unsigned block = bitsOf(((fx ^ lx) < spread(kWide)) & (ly - fy < spread(kBlockRows))) & bits & ~few;
    for (unsigned b = block; b != 0; b &= b - 1)
      fillBlock(to, r, static_cast<std::size_t>(std::countr_zero(b)));
    for (bits &= ~few & ~block; bits != 0; bits &= bits - 1)
      fill(to, r, static_cast<std::size_t>(std::countr_zero(bits)));
  }
  for (std::size_t k = 0; k < kLanes; ++k) {
    touched.x0 = std::min(touched.x0, leftmost[k]);
    touched.y0 = std::min(touched.y0, lowest[k]);
    touched.x1 = std::max(touched.x1, rightmost[k]);
    touched.y1 = std::max(touched.y1, topmost[k]);
  }
}

void rectangleLanes(const Projection& p, const BoxView& view, const Boxes& boxes, Rectangles& out) {
  F side[2][3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    side[0][axis] = read(boxes.low[axis]) + spread(p.offset[axis]);
    side[1][axis] = read(boxes.high[axis]) + spread(p.offset[axis]);
  }
  F lowX = spread(1e30f), lowY = lowX, nearest = lowX, highX = -lowX, highY = -lowX;
  I seen = spread(-1);
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const F &x = side[corner & 1][0], &y = side[corner >> 1 & 1][1], &z = side[corner >> 2][2];
    const auto along = [&](const std::array<float, 3>& axis) {
      return x * spread(axis[0]) + (y * spread(axis[1]) + z * spread(axis[2]));
    };
    const F depth = along(p.forward), right = along(p.right), up = along(p.up);
    // Said so that what is not a number hides nothing; and where rounding could shift a direction, neither.
    seen &= (depth > spread(p.nearM * 1.01f)) & (magnitude(right) + magnitude(up) < depth * spread(1000.0f));
    const F per = spread(1.0f) / depth, tx = right * per, ty = up * per;
    nearest = least(depth, nearest);
    lowX = least(tx, lowX);
    highX = most(tx, highX);
    lowY = least(ty, lowY);
    highY = most(ty, highY);
  }
  lowX = lowX * spread(p.scaleX) + spread(p.left - view.padX);
  highX = highX * spread(p.scaleX) + spread(p.left + view.padX);
  lowY = lowY * spread(p.scaleY) + spread(p.bottom - view.padY);
  highY = highY * spread(p.scaleY) + spread(p.bottom + view.padY);
  const F width = spread(static_cast<float>(view.width)), height = spread(static_cast<float>(view.height)),
          zero = spread(0.0f), one = spread(1.0f);
  const I outside = seen & ((highX < zero) | (highY < zero) | (lowX > width) | (lowY > height));
  const auto texel = [&](F at, F size) { return roundedDown(least(most(at, zero), size - one)); };
  const I x0 = texel(lowX, width);
  write(out.x0.data(),
        select(outside, spread(Rectangles::kOutside), select(seen, x0, spread(Rectangles::kInFront))));
  write(out.y0.data(), texel(lowY, height));
  write(out.x1.data(), texel(highX, width));
  write(out.y1.data(), texel(highY, height));
  write(out.limit.data(), spread(p.nearM * 1.0001f) / nearest);
}
