#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "horizon_kernels.h"
#include "trimtab/frame/terrain_index.h"

/// What the parts of the horizon share.
namespace trimtab::horizon {

constexpr float kNowhere = -std::numeric_limits<float>::max();
/// What is nearer than this in plan, metres, or than this share of its own tile's size, hides nothing and is
/// seen: floats would leave its direction too uncertain.
constexpr float kNearest = 64, kNearestShare = 0.05f;

/// Distance at which a room's play is tested with the parts instead of taken off the lines, metres: there it
/// is about a column.
constexpr float kFarM = 8000;

/// Rings of distance in plan, 128 to an octave from 1 m, by the bits of the number: what is in a lower ring
/// is nearer.
constexpr int kRingShift = 16;
constexpr std::uint32_t kRings = 26 * 128;
inline std::uint32_t ringOf(float distance) {
  const std::uint32_t ring =
      (std::bit_cast<std::uint32_t>(std::max(distance, 1.0f)) - 0x3f800000u) >> kRingShift;
  return std::min(ring, kRings - 1);
}

/// Forwards and sideways of a quarter: +x, +y, -x, -y.
struct Turned {
  float f, l;
};
inline constexpr std::array<std::array<float, 2>, 4> kForward{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
inline Turned turned(int side, float x, float y) {
  const auto [a, b] = kForward[static_cast<std::size_t>(side)];
  return {a * x + b * y, a * y - b * x};
}

/// The same of a box in plan.
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

/// From places as they lie from the eye.
inline Projection projectionOf(int side, const float* x, const float* y, const float* z, float perT = 1) {
  const bool turn = side % 2 != 0;
  return {turn ? y : x, turn ? x : y, z, side < 2 ? 1.0f : -1.0f, side == 0 || side == 3 ? 1.0f : -1.0f,
          perT};
}

/// What a box in front of the eye spans at most, and how high its top reaches.
struct BoxImage {
  float t0, t1, w;

  BoxImage(const TurnedBox& b, float top) {
    const float nearer = 1 / b.f0, further = 1 / b.f1;
    t0 = b.l0 * (b.l0 < 0 ? nearer : further);
    t1 = b.l1 * (b.l1 > 0 ? nearer : further);
    w = top * (top > 0 ? nearer : further);
  }
};

/// Whether the quarter, and so much of t beside it, meets the box.
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
