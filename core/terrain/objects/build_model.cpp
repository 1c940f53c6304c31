#include "trimtab/terrain/objects/build_model.h"

#include <algorithm>
#include <cmath>

#include "checked_mesh.h"
#include "simplify.h"
#include "stand_ins.h"
#include "surface_distance.h"
#include "textures.h"
#include "trimtab/terrain/format/object_file.h"
#include "trimtab/terrain/format/store.h"
#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

Finding refusedModel(const SourceModel& source, std::string expected, std::string found) {
  return {Severity::error, source.name, "", std::move(expected), std::move(found)};
}

void addFaults(const SourceModel& source, const MeshFaults& faults, Findings& findings) {
  const auto add = [&](std::size_t count, const char* expected, const char* what) {
    if (count > 0)
      findings.push_back({Severity::warning, source.name, "", expected, std::to_string(count) + what});
  };
  add(faults.noNumber, "corners that are numbers", " triangles with others, left out");
  add(faults.noCorner, "corners that are there", " triangles without, left out");
  add(faults.noPlace, "places in textures that are numbers", " corners with others, taken as 0");
  // Modellers leave slivers everywhere; nothing is lost with them.
  if (faults.noArea > 0)
    findings.push_back({Severity::note, source.name, "", "triangles with an area",
                        std::to_string(faults.noArea) + " without, left out"});
}

/// Returns the lights that can be drawn.
std::vector<SourceLight> checkedLights(const SourceModel& source, Findings& findings) {
  std::vector<SourceLight> lights;
  for (const SourceLight& light : source.lights) {
    const auto& [x, y, z] = light.position;
    if (std::hypot(double{x}, double{y}, double{z}) <= double{ObjectLimits::kRadiusM})  // false for NaN
      lights.push_back(light);
  }
  if (const std::size_t others = source.lights.size() - lights.size(); others > 0)
    findings.push_back(
        {Severity::warning, source.name, "",
         "lights within " + numberText(double{ObjectLimits::kRadiusM}) + " m of the model's origin",
         std::to_string(others) + (others == 1 ? " other" : " others") + ", left out"});
  return lights;
}

double radiusOf(const SourceMesh& mesh) {
  double square = 0;
  for (const SourceVertex& v : mesh.vertices) {
    const double x = v.position[0], y = v.position[1], z = v.position[2];
    square = std::max(square, x * x + y * y + z * z);
  }
  return std::sqrt(square);
}

/// Measures meshes against one.
class Meter {
 public:
  explicit Meter(const SourceMesh& first) : first_(first), tree_(first), slackM_(radiusOf(first) / 1000) {}

  BuiltLevel measured(SourceMesh mesh) const {
    const double there = farthestFrom(mesh, tree_, slackM_),
                 back = farthestFrom(first_, TriangleTree(mesh), slackM_);
    const auto error = static_cast<float>(std::max(there, back));
    // The rounded number is no less than the measured one.
    return {std::move(mesh), std::max(std::nextafter(error, INFINITY), kLeastErrorM)};
  }

 private:
  const SourceMesh& first_;
  TriangleTree tree_;
  double slackM_;
};

/// Keeps given levels that are coarser than the one before, and names the others.
void keepGiven(const SourceModel& source, std::vector<BuiltLevel> given, BuiltModel& model,
               Findings& findings) {
  for (BuiltLevel& level : given) {
    const BuiltLevel& before = model.levels.back();
    if (level.errorM > before.errorM && level.mesh.triangles() < before.mesh.triangles()) {
      model.levels.push_back(std::move(level));
      continue;
    }
    findings.push_back({Severity::note, source.name, "levels", "each level coarser than the one before",
                        "one of " + std::to_string(level.mesh.triangles()) + " triangles with an error of " +
                            numberText(double{level.errorM}, 3) + " m after one of " +
                            std::to_string(before.mesh.triangles()) + " with " +
                            numberText(double{before.errorM}, 3) + " m, left out"});
  }
}

/// Keeps of all that could come after the last level, by rising error, what is worth a level.
void keepWorthy(std::vector<BuiltLevel> candidates, BuiltModel& model) {
  std::stable_sort(candidates.begin(), candidates.end(), [](const BuiltLevel& a, const BuiltLevel& b) {
    return a.errorM != b.errorM ? a.errorM < b.errorM : a.mesh.triangles() < b.mesh.triangles();
  });
  for (BuiltLevel& level : candidates) {
    const BuiltLevel& before = model.levels.back();
    const double most = ModelLimits::kFewer * static_cast<double>(before.mesh.triangles());
    if (level.errorM > before.errorM && static_cast<double>(level.mesh.triangles()) <= most)
      model.levels.push_back(std::move(level));
  }
}

}  // namespace

Result<BuiltModel> buildModel(const SourceModel& source) {
  Findings findings;
  BuiltModel model{source.name, {}, {}};
  std::vector<std::array<std::uint8_t, 4>> colours;
  for (const SourceTexture& texture : source.textures) {
    model.textures.push_back(scaledTexture(texture));
    colours.push_back(meanColour(model.textures.back()));
  }
  MeshFaults faults;
  std::vector<SourceMesh> given;
  for (const SourceMesh& mesh : source.levels) {
    if (mesh.triangles() > ModelLimits::kTriangles)
      return refusedModel(source, "at most " + std::to_string(ModelLimits::kTriangles) + " triangles",
                          std::to_string(mesh.triangles()) + ": simplify it, or divide it");
    SourceMesh checked = checkedMesh(mesh, source.textures.size(), faults);
    if (checked.triangles() > 0) given.push_back(std::move(checked));
  }
  addFaults(source, faults, findings);
  model.lights = checkedLights(source, findings);
  if (given.empty() && !model.lights.empty())
    return Result<BuiltModel>(std::move(model), std::move(findings));
  if (given.empty()) {
    findings.push_back(refusedModel(source, "a model with at least one triangle or light",
                                    faults.triangles() > 0 ? "none that can be drawn" : "none"));
    return findings;
  }
  if (!(faults.farthestM <= ObjectLimits::kRadiusM)) {
    findings.push_back(refusedModel(
        source,
        "all triangles within " + numberText(double{ObjectLimits::kRadiusM}) + " m of the model's origin",
        "one that reaches " + numberText(faults.farthestM, 3) +
            " m: see whether the file is in metres and about its own origin"));
    return findings;
  }
  model.levels.push_back({std::move(given.front()), 0});
  const SourceMesh first = model.levels.front().mesh;
  const Meter meter(first);
  std::vector<BuiltLevel> candidates;
  if (given.size() > 1) {
    std::vector<BuiltLevel> measured;
    for (std::size_t i = 1; i < given.size(); ++i) measured.push_back(meter.measured(std::move(given[i])));
    keepGiven(source, std::move(measured), model, findings);
  } else if (first.triangles() > ModelLimits::kSimplified) {
    for (SourceMesh& mesh : simplified(first, colours)) candidates.push_back(meter.measured(std::move(mesh)));
  }
  for (SourceMesh& mesh : standIns(first, meanColour(first, colours)))
    candidates.push_back(meter.measured(std::move(mesh)));
  keepWorthy(std::move(candidates), model);
  return Result<BuiltModel>(std::move(model), std::move(findings));
}

std::uint64_t checksumOf(const SourceModel& model) {
  std::string sums;
  const auto add = [&sums](const void* bytes, std::size_t size) {
    sums += hexadecimal(checksum({static_cast<const char*>(bytes), size}));
  };
  for (const SourceMesh& mesh : model.levels) {
    add(mesh.vertices.data(), mesh.vertices.size() * sizeof(SourceVertex));
    add(mesh.indices.data(), mesh.indices.size() * sizeof(std::uint32_t));
    sums += mesh.bothSides ? '2' : '1';
  }
  for (const SourceTexture& texture : model.textures) {
    sums += std::to_string(texture.width) + 'x' + std::to_string(texture.height);
    add(texture.pixels.data(), texture.pixels.size());
  }
  // Models without lights keep the sum that databases know them by.
  if (!model.lights.empty()) add(model.lights.data(), model.lights.size() * sizeof(SourceLight));
  return checksum(sums);
}

}  // namespace trimtab::terrain
