#pragma once

#include <array>

#include "trimtab/culling/box_arrays.h"
#include "trimtab/culling/relief.h"

/// The horizon's inner loops, by what the processor has. All forms give the same bits: each number comes from
/// the same operations, none of them contracted.
namespace trimtab::horizon {

/// Forwards = signF * a, sideways = signL * b, over what is given; u in columns.
struct Projection {
  const float *a, *b, *z;
  float signF, signL, perT;
};

/// Holds an upper bound of what the boxes of a part's blocks span, and how high their tops reach: a BoxImage
/// each.
struct BoxImages {
  alignas(64) std::array<float, TileRelief::Part::kMostBlocks> t0, t1, w;
};

struct Kernels {
  /// Reads and writes up to the next multiple of 16.
  void (*project)(const Projection& p, int count, float* forward, float* u, float* w);
  /// Computes the boxes as a quarter sees them; all of them must be in front of the eye. `from` is their
  /// origin, seen from it.
  void (*images)(int side, const TileRelief::Part& part, const std::array<float, 3>& from, BoxImages& images);
  /// 1 where each value is at least the one before, -1 where none is, else 0.
  int (*trend)(const float* values, int count);
  /// Lowers w to w - (up + |w| forwards) / nearest.
  void (*lower)(float* w, int count, float up, float forwards, float inverse);
  /// The first that is not above the limit, or count. Reads up to the next multiple of 16.
  int (*firstNotAbove)(const float* values, int count, float limit);
  void (*raise)(float* values, const float* to, int count);
  /// values[i] = least of values[i .. i + width - 1]; count - width + 1 of them stay.
  void (*erode)(float* values, int count, int width);
};

const Kernels& kernels(SimdLevel atMost);

}  // namespace trimtab::horizon
