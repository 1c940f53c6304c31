#pragma once

#include <optional>

namespace trimtab::scene {

/// Returns the height over (x, y) of a triangle whose corners have x, y and z, anticlockwise from above;
/// unset beside it. Neighbouring triangles leave no gap between them.
template <class Corner>
std::optional<double> heightOver(const Corner& a, const Corner& b, const Corner& c, double x, double y) {
  const auto area = [](double px, double py, double qx, double qy) { return px * qy - py * qx; };
  const double bx = double{b.x} - a.x, by = double{b.y} - a.y, cx = double{c.x} - a.x, cy = double{c.y} - a.y,
               whole = area(bx, by, cx, cy);
  if (!(whole > 0)) return {};
  const double v = area(x - a.x, y - a.y, cx, cy) / whole, w = area(bx, by, x - a.x, y - a.y) / whole;
  constexpr double kEdge = -1e-6;
  if (v < kEdge || w < kEdge || 1 - v - w < kEdge) return {};
  return a.z + v * (double{b.z} - a.z) + w * (double{c.z} - a.z);
}

}  // namespace trimtab::scene
