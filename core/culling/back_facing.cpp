#include "trimtab/culling/back_facing.h"

#include <array>
#include <numbers>

#include "trimtab/culling/box_distance.h"

namespace trimtab {
namespace {

/// Cells per side of the table of leans, which is indexed by the upper six of each of the axis's twelve bits.
constexpr unsigned kCells = 64, kShift = 6;

/// Returns for each cell the largest lean of an axis in it, in steps, rounded up.
std::array<std::int16_t, kCells * kCells> leans() {
  std::array<std::int16_t, kCells * kCells> most{};
  for (std::uint32_t y = 0; y < kCells; ++y)
    for (std::uint32_t x = 0; x < kCells; ++x) {
      double angle = 0;
      // Inside an octahedron's face the lean has no maximum, so the corners suffice. The folds are borders of
      // cells, except the outer ones, and a cell there has both sides among its corners.
      for (const std::uint32_t i : {0u, 1u << kShift})
        for (const std::uint32_t j : {0u, 1u << kShift}) {
          const NormalCone corner{std::min(x * (1u << kShift) + i, 4095u) |
                                  std::min(y * (1u << kShift) + j, 4095u) << 12};
          angle = std::max(angle, std::acos(std::clamp(corner.axis().z, -1.0, 1.0)));
        }
      // A cell is 1/32 wide on an octahedron whose radius is at least 0.57: a twentieth of a radian covers
      // what its middle may lean beyond its corners.
      most[y * kCells + x] = static_cast<std::int16_t>(std::ceil((angle + 0.05) * kSteepnessSteps));
    }
  return most;
}

/// Returns the half-angles by their eight bits, in steps, rounded down.
std::array<std::int16_t, 256> halfAngles() {
  std::array<std::int16_t, 256> angles{};
  for (std::size_t i = 0; i < 255; ++i)
    angles[i] = static_cast<std::int16_t>(std::asin(static_cast<double>(i) / 254) * kSteepnessSteps);
  return angles;
}

constexpr std::int16_t kNever = std::numeric_limits<std::int16_t>::min();

}  // namespace

std::int16_t steepness(NormalCone cone) {
  static const auto lean = leans();
  static const auto half = halfAngles();
  if (!cone.isKnown()) return kNever;
  const std::uint32_t x = (cone.packed & 0xfffu) >> kShift, y = (cone.packed >> 12 & 0xfffu) >> kShift;
  return static_cast<std::int16_t>(lean[y * kCells + x] - half[cone.packed >> 24]);
}

bool mayFaceAway(std::int16_t steepness, const Box& box, Vec3 eye) {
  if (steepness == kNever) return false;
  // If a node faces away, the direction to the eye makes at least a right angle plus the half-angle with the
  // axis, so the sine of its elevation is at most that of `steepness`.
  const double angle = steepness / kSteepnessSteps;
  if (!(angle < std::numbers::pi / 2)) return true;
  if (!(angle > -std::numbers::pi / 2)) return false;
  const double up = eye.z - box.maxZ, x = std::max(std::abs(box.minX - eye.x), std::abs(box.maxX - eye.x)),
               y = std::max(std::abs(box.minY - eye.y), std::abs(box.maxY - eye.y)),
               z = std::max(std::abs(box.minZ - eye.z), std::abs(box.maxZ - eye.z));
  // The lowest elevation of the eye as seen from any point of the box.
  const double across = up >= 0 ? std::sqrt(x * x + y * y + z * z) : std::sqrt(distanceSquared(box, eye));
  return !(up > across * std::sin(angle) * (1 + 1e-9) + 1e-6);
}

}  // namespace trimtab
