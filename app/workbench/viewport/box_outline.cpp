// SPDX-License-Identifier: GPL-3.0-or-later
#include "box_outline.h"

namespace trimtab::workbench {

QList<QLineF> outlineOf(const Box& box, const EyePose& eye, const ViewShape& view) {
  const auto corner = [&](unsigned bits) {
    const Vec3 place{bits & 1u ? box.maxX : box.minX, bits & 2u ? box.maxY : box.minY,
                     bits & 4u ? box.maxZ : box.minZ};
    return eye.axes * (place - eye.position);
  };
  const auto inImage = [&](const Vec3& seen) {
    const double x = seen.x / -seen.z, y = seen.y / -seen.z;
    return QPointF((x - view.left) / (view.right - view.left), (view.top - y) / (view.top - view.bottom));
  };
  QList<QLineF> edges;
  for (unsigned from = 0; from < 8; ++from)
    for (unsigned axis = 1; axis < 8; axis *= 2) {
      if (from & axis) continue;
      Vec3 a = corner(from), b = corner(from | axis);
      if (-a.z < view.nearM && -b.z < view.nearM) continue;
      Vec3& behind = a.z > b.z ? a : b;
      const Vec3& ahead = a.z > b.z ? b : a;
      if (-behind.z < view.nearM)
        behind = behind + (ahead - behind) * ((view.nearM + behind.z) / (behind.z - ahead.z));
      edges.append({inImage(a), inImage(b)});
    }
  return edges;
}

}  // namespace trimtab::workbench
