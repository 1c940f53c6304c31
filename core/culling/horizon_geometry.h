#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "horizon_kernels.h"

/// Constants and small functions that the parts of the horizon share.
namespace trimtab::horizon {

constexpr float kNowhere = -std::numeric_limits<float>::max();
/// Ground nearer than this in plan, metres, or than this share of its own tile's size, hides nothing and is
/// never hidden, because floats would leave its direction too uncertain.
constexpr float kNearest = 64, kNearestShare = 0.05f;

/// Tested parts are widened by the shift that the eyes of a validity region see at this distance, metres,
/// which is about a column. Only what nearer lines are shifted by more is taken off those lines.
constexpr float kFarM = 8000;

/// Rings of distance in plan, 128 per octave from 1 m, taken from the bits of the number. Whatever is in a
/// lower ring is nearer.
constexpr int kRingShift = 16;
constexpr std::uint32_t kRings = 26 * 128;
inline std::uint32_t ringOf(float distance) {
  const std::uint32_t ring =
      (std::bit_cast<std::uint32_t>(std::max(distance, 1.0f)) - 0x3f800000u) >> kRingShift;
  return std::min(ring, kRings - 1);
}

/// A position in plan as a quarter (+x, +y, -x, -y) sees it: forwards and sideways.
struct Turned {
  float f, l;
};
inline constexpr std::array<std::array<float, 2>, 4> kForward{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
inline Turned turned(int side, float x, float y) {
  const auto [a, b] = kForward[static_cast<std::size_t>(side)];
  return {a * x + b * y, a * y - b * x};
}

/// A box in plan as a quarter sees it.
struct TurnedBox {
  float f0, f1, l0, l1;
};
inline TurnedBox turned(int side, float x0, float x1, float y0, float y1) {
  switch (side) {
    case 0:
      return {x0, x1, y0, y1};
    case 1:
      return {y0, y1, -x1, -x0};
    case 2:
      return {-x1, -x0, -y1, -y0};
    default:
      return {-y1, -y0, x0, x1};
  }
}

/// Returns how kernels read positions relative to the eye as a quarter sees them.
inline Projection projectionOf(int side, const float* x, const float* y, const float* z, float perT = 1) {
  const bool turn = side % 2 != 0;
  return {turn ? y : x, turn ? x : y, z, side < 2 ? 1.0f : -1.0f, side == 0 || side == 3 ? 1.0f : -1.0f,
          perT};
}

/// The largest span of t that a box in front of the eye covers, and the largest w of its top.
struct BoxImage {
  float t0, t1, w;

  BoxImage(const TurnedBox& b, float top) {
    const float nearer = 1 / b.f0, further = 1 / b.f1;
    t0 = b.l0 * (b.l0 < 0 ? nearer : further);
    t1 = b.l1 * (b.l1 > 0 ? nearer : further);
    w = top * (top > 0 ? nearer : further);
  }
};

/// Returns whether the box meets the quarter, widened by `beside` in t on both sides.
inline bool meets(const TurnedBox& b, float beside = 0.01f) {
  return b.f1 > 0 && std::max({b.l0, -b.l1, 0.0f}) <= (1 + beside) * b.f1;
}

inline bool isPlace(Vec3 p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

inline std::array<float, 3> fromEye(Vec3 eye, Vec3 origin) {
  return {static_cast<float>(origin.x - eye.x), static_cast<float>(origin.y - eye.y),
          static_cast<float>(origin.z - eye.z)};
}

}  // namespace trimtab::horizon
