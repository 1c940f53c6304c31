#include "light_arrays.h"

#include <cmath>
#include <span>

#include "trimtab/terrain/format/object_file.h"

namespace trimtab::terrain {

template <>
inline constexpr bool kFillsItsBytes<LightPoint> = sizeof(LightPoint) == 16;
template <>
inline constexpr bool kFillsItsBytes<LightIndex::Cell> = sizeof(LightIndex::Cell) == 44;

void addLights(const LightIndex& lights, ArrayWriter& out) {
  out.array(lights.cells);
  out.array(lights.points);
}

void readLights(ArrayReader& in, LightIndex& lights) {
  in.array(lights.cells);
  in.array(lights.points);
}

std::string faultOfLights(const LightIndex& lights) {
  if (lights.points.size() > ObjectLimits::kLights) return "number of lights";
  std::size_t next = 0;
  for (const LightIndex::Cell& cell : lights.cells) {
    if (cell.first != next || cell.count < 1 || cell.count > LightIndex::kMostInCell ||
        cell.count > lights.points.size() - next)
      return "lights of cells";
    const Box& b = cell.bounds;
    for (const float v : {b.minX, b.minY, b.minZ, b.maxX, b.maxY, b.maxZ})
      if (!(std::abs(v) <= 2 * ObjectLimits::kFromOriginM)) return "bounds of lights";
    for (const std::int32_t v : cell.origin)
      if (v < -ObjectLimits::kCellOrigin || v > ObjectLimits::kCellOrigin) return "origins of lights";
    // A box that does not hold its lights would take them out of the image.
    const auto holds = [&](float place, std::size_t axis, float least, float most) {
      const double at = 16.0 * cell.origin[axis] + double{place};
      return double{least} <= at && at <= double{most};  // false for NaN
    };
    for (next += cell.count;
         const LightPoint& light : std::span(lights.points).subspan(cell.first, cell.count))
      if (!(holds(light.x, 0, b.minX, b.maxX) && holds(light.y, 1, b.minY, b.maxY) &&
            holds(light.z, 2, b.minZ, b.maxZ)))
        return "places of lights";
  }
  return next == lights.points.size() ? "" : "lights of cells";
}

}  // namespace trimtab::terrain
