#include "light_cells.h"

#include <algorithm>
#include <cmath>

#include "placed_instances.h"
#include "trimtab/terrain/format/object_file.h"

namespace trimtab::terrain {

namespace {

/// Lights within a square of this side, metres, keep the order of the placements.
constexpr double kLightSquareM = 16;

LightIndex::Cell cellOfLights(std::span<const PlacedLight> lights, std::vector<LightPoint>& points) {
  Vec3 low = lights[0].place, high = low;
  for (const PlacedLight& light : lights) {
    const Vec3 p = light.place;
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  LightIndex::Cell cell;
  cell.origin = originOf((low + high) * 0.5);
  cell.first = static_cast<std::uint32_t>(points.size());
  cell.count = static_cast<std::uint32_t>(lights.size());
  const Vec3 origin = Vec3{double(cell.origin[0]), double(cell.origin[1]), double(cell.origin[2])} * 16;
  for (const PlacedLight& light : lights) {
    const Vec3 from = light.place - origin;
    points.push_back(
        {static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z), light.colour});
    // The box holds what is stored, whose floats are beside the places that they round.
    const LightPoint& stored = points.back();
    const Vec3 p = origin + Vec3{stored.x, stored.y, stored.z};
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  cell.bounds = boxAround(low, high);
  return cell;
}

}  // namespace

std::vector<double> reachesOfLights(std::span<const std::optional<BuiltModel>> models,
                                    const PlacementList& list, const std::string& where,
                                    FindingList& findings) {
  std::vector<std::uint64_t> rows(models.size());
  for (const ListedPlacement& p : list.placements) ++rows[p.model];
  std::vector<double> reaches(models.size(), -1);
  std::uint64_t all = 0;
  for (std::size_t m = 0; m < models.size(); ++m) {
    if (!models[m] || models[m]->lights.empty()) continue;
    const std::uint64_t each = models[m]->lights.size(), sum = each * rows[m];
    if (sum > ObjectLimits::kLights - all) {
      findings.add({Severity::warning, where, list.models[m],
                    "at most " + std::to_string(ObjectLimits::kLights) + " lights on a terrain",
                    std::to_string(each) + " in each of " + std::to_string(rows[m]) + " rows, after " +
                        std::to_string(all) + " of other models: its lights are left out"});
      continue;
    }
    all += sum;
    reaches[m] = 0;
    for (const SourceLight& light : models[m]->lights) {
      const auto& [x, y, z] = light.position;
      reaches[m] = std::max(reaches[m], std::hypot(double{x}, double{y}, double{z}));
    }
  }
  return reaches;
}

LightIndex lightsInCells(std::vector<PlacedLight> lights) {
  LightIndex index;
  if (lights.empty()) return index;
  double west = lights[0].place.x, south = lights[0].place.y;
  for (const PlacedLight& light : lights) {
    west = std::min(west, light.place.x);
    south = std::min(south, light.place.y);
  }
  const auto code = [&](const PlacedLight& light) {
    return quarters(static_cast<std::uint32_t>((light.place.x - west) / kLightSquareM),
                    static_cast<std::uint32_t>((light.place.y - south) / kLightSquareM));
  };
  std::stable_sort(lights.begin(), lights.end(),
                   [&](const PlacedLight& a, const PlacedLight& b) { return code(a) < code(b); });
  index.points.reserve(lights.size());
  for (std::size_t from = 0; from < lights.size(); from += LightIndex::kMostInCell) {
    const std::size_t count = std::min<std::size_t>(LightIndex::kMostInCell, lights.size() - from);
    index.cells.push_back(cellOfLights(std::span(lights).subspan(from, count), index.points));
  }
  return index;
}

}  // namespace trimtab::terrain
