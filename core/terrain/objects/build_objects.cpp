#include "trimtab/terrain/objects/build_objects.h"

#include <algorithm>
#include <numbers>

#include "light_cells.h"
#include "packed_models.h"
#include "placed_instances.h"
#include "trimtab/terrain/format/object_file.h"
#include "trimtab/units/finding_list.h"
#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

constexpr std::uint32_t kNoMesh = 0xffffffffu;

/// Turns the model's axes to those of the frame, at a place on the curved earth.
Mat3 standing(const LocalFrame& frame, const ListedPlacement& p) {
  const double heading = p.heading.value() * std::numbers::pi / 180;
  const double c = std::cos(heading), s = std::sin(heading);
  // Clockwise from above: north, the model's y, goes to the east.
  const Mat3 turned{{Vec3{c, s, 0}, Vec3{-s, c, 0}, Vec3{0, 0, 1}}};
  return frame.ecefToLocal() * transposed(eastNorthUp(p.latitude, p.longitude)) * turned;
}

/// Adds the models that can be used to `objects`; returns the numbers that they have there.
Result<std::vector<std::uint32_t>> packModels(std::span<const std::optional<BuiltModel>> models,
                                              const std::string& where, ObjectTerrain& objects,
                                              std::vector<ModelExtent>& extents, FindingList& findings) {
  ModelPacker packer(objects);
  std::vector<std::uint32_t> numbers;
  for (const std::optional<BuiltModel>& model : models) {
    const bool hasMesh = model && !model->levels.empty();
    numbers.push_back(hasMesh ? static_cast<std::uint32_t>(extents.size()) : kNoMesh);
    if (!hasMesh) continue;
    const auto extent = packer.add(*model);
    if (!extent) return extent.findings();
    extents.push_back(*extent);
  }
  if (packer.texturesLeftOut() > 0)
    findings.add({Severity::warning, where, "textures",
                  "at most " + std::to_string(ObjectLimits::kTextures) + " different ones",
                  std::to_string(packer.texturesLeftOut()) + " more, of which only the mean colour is used"});
  return numbers;
}

Finding tooLarge(const std::string& place, const ListedPlacement& p, double radiusM) {
  return {Severity::warning, place, "scale",
          "an object that reaches at most " + numberText(double{ObjectLimits::kRadiusM}) +
              " m from its origin; it is left out",
          numberText(radiusM * p.scale, 3) + " m at a scale of " + numberText(p.scale)};
}

Finding offTheGround(const std::string& place, const ListedPlacement& p) {
  return {
      Severity::warning, place, "", "a place on the terrain; the object is left out",
      "latitude " + numberText(p.latitude.value(), 9) + ", longitude " + numberText(p.longitude.value(), 9)};
}

}  // namespace

Result<ObjectTerrain> buildObjects(std::span<const std::optional<BuiltModel>> models,
                                   const PlacementList& list, const GroundHeights& ground,
                                   const LocalFrame& frame, const std::string& where,
                                   const Progress& progress) {
  ObjectTerrain objects;
  objects.index.frame = frame;
  FindingList findings;
  std::vector<ModelExtent> extents;
  const auto numbers = packModels(models, where, objects, extents, findings);
  if (!numbers) return numbers.findings();
  const std::vector<double> lit = reachesOfLights(models, list, where, findings);
  std::vector<PlacedLight> lights;
  std::vector<PlacedInstance> placed;
  placed.reserve(list.placements.size());
  std::vector<std::size_t> unused(models.size());
  constexpr std::size_t kBetweenReports = 4096;
  for (std::size_t i = 0; i < list.placements.size(); ++i) {
    if (progress && i % kBetweenReports == 0 &&
        !progress(static_cast<double>(i) / static_cast<double>(list.placements.size()), "placing objects"))
      return cancelled("placing objects");
    const ListedPlacement& p = list.placements[i];
    if (!models[p.model]) {
      ++unused[p.model];
      continue;
    }
    const std::uint32_t number = (*numbers)[p.model];
    const double radius = std::max(number == kNoMesh ? 0 : extents[number].radiusM, lit[p.model]);
    if (radius * p.scale > double{ObjectLimits::kRadiusM}) {
      findings.add(Severity::warning, [&] { return tooLarge(list.placeOf(i, where), p, radius); });
      continue;
    }
    const std::optional<Metres> onGround = ground.heightAt(p.latitude, p.longitude);
    if (!onGround) {
      findings.add(Severity::warning, [&] { return offTheGround(list.placeOf(i, where), p); });
      continue;
    }
    const GeodeticPosition position{p.latitude, wrapped180(p.longitude),
                                    p.height.value_or(*onGround + p.aboveGround)};
    const Vec3 place = frame.fromGeodetic(position);
    const Mat3 turn = standing(frame, p);
    if (lit[p.model] >= 0)
      for (const SourceLight& light : models[p.model]->lights) {
        const auto& [x, y, z] = light.position;
        lights.push_back({place + (turn * Vec3{x, y, z}) * p.scale, light.colour});
      }
    if (number != kNoMesh)
      placed.push_back({place, quantisedTurn(turn), static_cast<float>(p.scale), number});
  }
  for (std::size_t m = 0; m < unused.size(); ++m)
    if (unused[m] > 0)
      findings.add({Severity::warning, where, list.models[m], "a model that can be used",
                    std::to_string(unused[m]) + (unused[m] == 1 ? " row" : " rows") +
                        " with one that cannot, left out"});
  if (placed.empty() && lights.empty())
    findings.add({Severity::error, where, "", "at least one object on the terrain", "none"});
  Findings all = findings.all(where);
  if (hasError(all)) return all;
  fillCells(placed, extents, objects.index);
  objects.lights = lightsInCells(std::move(lights));
  return Result<ObjectTerrain>(std::move(objects), std::move(all));
}

}  // namespace trimtab::terrain
