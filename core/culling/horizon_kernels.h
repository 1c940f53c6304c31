#pragma once

#include "trimtab/culling/box_arrays.h"

/// The horizon's inner loops, by what the processor has. All forms give the same bits: each number comes from
/// the same operations, none of them contracted.
namespace trimtab::horizon {

/// Forwards = signF * a, sideways = signL * b, over what is given; u in columns.
struct Projection {
  const float *a, *b, *z;
  float signF, signL, perT;
};

/// What each block of 2 x 2 cells of a part spans, by its first post: `t0[k * kLanes + i]` is that of the
/// posts from row 2k and column i on. Blocks begin at even columns; what is beyond the part's is anything.
struct PartHulls {
  static constexpr int kRows = 9, kLanes = 16, kBlockRows = kRows / 2;
  alignas(64) float t0[kBlockRows * kLanes], t1[kBlockRows * kLanes], top[kBlockRows * kLanes];
};

struct Kernels {
  /// Reads and writes up to the next multiple of 16.
  void (*project)(const Projection& p, int count, float* forward, float* u, float* w);
  /// Of kRows rows of kLanes posts; perT is not used.
  void (*hulls)(const Projection& p, PartHulls& hulls);
  /// 1 where each value is at least the one before, -1 where none is, else 0.
  int (*trend)(const float* values, int count);
  /// Lowers w to w - (up + |w| forwards) / nearest.
  void (*lower)(float* w, int count, float up, float forwards, float inverse);
  /// The first that is not above the limit, or count.
  int (*firstNotAbove)(const float* values, int count, float limit);
  void (*raise)(float* values, const float* to, int count);
  /// values[i] = least of values[i .. i + width - 1]; count - width + 1 of them stay.
  void (*erode)(float* values, int count, int width);
};

const Kernels& kernels(SimdLevel atMost);

}  // namespace trimtab::horizon
