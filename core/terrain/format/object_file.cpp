#include "trimtab/terrain/format/object_file.h"

#include <cmath>

#include "array_file.h"
#include "light_arrays.h"
#include "trimtab/terrain/format/store.h"

namespace trimtab::terrain {

template <>
inline constexpr bool kFillsItsBytes<ObjectIndex::Level> = sizeof(ObjectIndex::Level) == 12;
template <>
inline constexpr bool kFillsItsBytes<ObjectIndex::Model> = sizeof(ObjectIndex::Model) == 12;
template <>
inline constexpr bool kFillsItsBytes<ObjectIndex::Cell> = sizeof(ObjectIndex::Cell) == 56;
template <>
inline constexpr bool kFillsItsBytes<ObjectInstance> = sizeof(ObjectInstance) == 28;
template <>
inline constexpr bool kFillsItsBytes<ObjectVertex> = sizeof(ObjectVertex) == 24;

namespace {

constexpr std::uint32_t kWithoutLights = 1, kObjectsVersion = 2;
constexpr ArrayFileKind kObjectsKind{
    {'T', 'R', 'I', 'M', 'O', 'B', 'J', 'S'}, "objects", kWithoutLights, kObjectsVersion};
constexpr std::size_t kTextureBytes = std::size_t{4} * ObjectTexture::kSidePx * ObjectTexture::kSidePx;

void readArrays(ArrayReader& in, ObjectTerrain& objects) {
  ObjectIndex& index = objects.index;
  double latitude = 0, longitude = 0, height = 0;
  for (double* v : {&latitude, &longitude, &height}) in.number(*v);
  if (!(std::abs(latitude) <= 90 && std::abs(longitude) <= 180 && std::abs(height) <= 1e6))
    return in.refuse();
  index.frame = LocalFrame({Degrees{latitude}, Degrees{longitude}, Metres{height}});
  in.array(index.levels);
  in.array(index.models);
  in.array(index.cells);
  in.array(index.instances);
  objects.names.resize(in.length(sizeof(std::uint64_t)));
  for (std::string& name : objects.names) in.text(name);
  in.array(objects.meshes);
  in.array(objects.vertices);
  in.array(objects.indices);
  objects.textures.resize(in.length(kTextureBytes));
  for (ObjectTexture& texture : objects.textures) in.array(texture.pixels);
}

bool within(float value, float most) {
  return std::abs(value) <= most;  // false for NaN
}
bool isLength(float value) {
  return value >= 0 && std::isfinite(value);
}
bool isFiniteHalf(std::uint16_t half) {
  constexpr std::uint16_t kExponent = 0x7c00;
  return (half & kExponent) != kExponent;
}
bool isUnit(const std::array<std::int16_t, 4>& turn) {
  constexpr double kOne = 32767.0 * 32767.0;
  double square = 0;
  for (const std::int16_t v : turn) square += double{static_cast<double>(v)} * v;
  return std::abs(square - kOne) <= 0.01 * kOne;
}

/// Models have their levels one after the other, and so have all of them together: none is named twice, so
/// that reading a file takes time linear in its size.
std::string faultOfModels(const ObjectTerrain& objects) {
  const ObjectIndex& index = objects.index;
  if (objects.names.size() != index.models.size()) return "names of models";
  if (objects.meshes.size() != index.levels.size()) return "meshes of levels";
  std::size_t level = 0;
  for (const ObjectIndex::Model& model : index.models) {
    if (model.firstLevel != level || model.levels < 1 || model.levels > index.levels.size() - level)
      return "levels of models";
    if (!(model.radiusM >= 0 && model.radiusM <= ObjectLimits::kRadiusM)) return "radius of models";
    for (std::uint32_t i = 0; i < model.levels; ++i) {
      const float error = index.levels[level + i].errorM;
      if (!std::isfinite(error) || (i == 0 ? error != 0 : !(error > index.levels[level + i - 1].errorM)))
        return "errors of levels";
    }
    level += model.levels;
  }
  return level == index.levels.size() ? "" : "levels of models";
}

std::string faultOfMeshes(const ObjectTerrain& objects) {
  std::size_t vertex = 0, at = 0;
  for (std::size_t i = 0; i < objects.meshes.size(); ++i) {
    const ObjectMesh& mesh = objects.meshes[i];
    const ObjectIndex::Level& level = objects.index.levels[i];
    if (mesh.firstVertex != vertex || level.vertices > objects.vertices.size() - vertex ||
        mesh.firstIndex != at || mesh.indices > objects.indices.size() - at || mesh.bothSides > 1)
      return "parts of meshes";
    if (level.triangles < 1 || mesh.indices != std::uint64_t{3} * level.triangles)
      return "triangles of levels";
    for (std::size_t k = at; k < at + mesh.indices; ++k)
      if (objects.indices[k] >= level.vertices) return "indices";
    vertex += level.vertices;
    at += mesh.indices;
  }
  return vertex == objects.vertices.size() && at == objects.indices.size() ? "" : "parts of meshes";
}

std::string faultOfVertices(const ObjectTerrain& objects) {
  const ObjectIndex& index = objects.index;
  for (const ObjectTexture& texture : objects.textures)
    if (texture.pixels.size() != kTextureBytes) return "size of textures";
  if (objects.textures.size() > ObjectLimits::kTextures) return "number of textures";
  for (const ObjectIndex::Model& model : index.models) {
    const double radius = model.radiusM;
    for (std::uint32_t i = model.firstLevel; i < model.firstLevel + model.levels; ++i)
      for (std::uint32_t k = 0; k < index.levels[i].vertices; ++k) {
        const ObjectVertex& v = objects.vertices[objects.meshes[i].firstVertex + k];
        const double x = v.x, y = v.y, z = v.z;
        if (!(x * x + y * y + z * z <= radius * radius)) return "vertices beyond the radius of their model";
        if (v.texture != ObjectVertex::kNoTexture && v.texture >= objects.textures.size())
          return "textures of vertices";
        if (!isFiniteHalf(v.place[0]) || !isFiniteHalf(v.place[1])) return "places in textures";
      }
  }
  return {};
}

std::string faultOfInstances(const ObjectIndex& index) {
  for (const ObjectInstance& instance : index.instances) {
    if (instance.model >= index.models.size()) return "models of instances";
    if (!(within(instance.x, ObjectLimits::kFromOriginM) && within(instance.y, ObjectLimits::kFromOriginM) &&
          within(instance.z, ObjectLimits::kFromOriginM)))
      return "places of instances";
    if (!isUnit(instance.turn)) return "turns of instances";
    if (!(instance.scale >= ObjectLimits::kLeastScale && instance.scale <= ObjectLimits::kMostScale))
      return "scales of instances";
  }
  return {};
}

/// Children of a cell follow each other to its end, and share out its instances in order.
std::string faultOfCells(const ObjectIndex& index) {
  const std::vector<ObjectIndex::Cell>& cells = index.cells;
  if (cells.empty()) return index.instances.empty() ? "" : "cells";
  if (cells[0].end != cells.size() || cells[0].firstInstance != 0 ||
      cells[0].instances != index.instances.size())
    return "root cell";
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    const ObjectIndex::Cell& cell = cells[i];
    const Box& b = cell.bounds;
    if (!(b.minX <= b.maxX && b.minY <= b.maxY && b.minZ <= b.maxZ)) return "bounds of cells";
    for (const float v : {b.minX, b.minY, b.minZ, b.maxX, b.maxY, b.maxZ})
      if (!within(v, 2 * ObjectLimits::kFromOriginM)) return "bounds of cells";
    for (const std::int32_t v : cell.origin)
      if (v < -ObjectLimits::kCellOrigin || v > ObjectLimits::kCellOrigin) return "origins of cells";
    if (!isLength(cell.largestRadiusM) || !isLength(cell.coarsestFromM)) return "radius or error of cells";
    if (cell.end <= i || cell.end > cells.size()) return "ends of cells";
  }
  // The cells around the one that is looked at, each with how far its children have come.
  struct Open {
    std::uint32_t end;
    std::uint64_t instance, lastInstance;
    bool leaf;
  };
  std::vector<Open> around;
  const auto closeTo = [&](std::uint32_t cell) {
    while (!around.empty() && around.back().end <= cell) {
      if (!around.back().leaf && around.back().instance != around.back().lastInstance) return false;
      around.pop_back();
    }
    return true;
  };
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    const ObjectIndex::Cell& cell = cells[i];
    if (!closeTo(i)) return "instances of cells";
    const std::uint64_t last = std::uint64_t{cell.firstInstance} + cell.instances;
    if (!around.empty()) {
      Open& parent = around.back();
      if (cell.end > parent.end) return "ends of cells";
      if (cell.firstInstance != parent.instance || last > parent.lastInstance) return "instances of cells";
      parent.instance = last;
    }
    around.push_back({cell.end, cell.firstInstance, last, cell.isLeaf(i)});
  }
  return closeTo(static_cast<std::uint32_t>(cells.size())) ? "" : "instances of cells";
}

/// Returns the first thing that keeps a reader from relying on the arrays, or nothing.
std::string faultOfObjects(const ObjectTerrain& objects) {
  for (const auto& fault : {faultOfModels, faultOfMeshes, faultOfVertices})
    if (std::string found = fault(objects); !found.empty()) return found;
  if (std::string found = faultOfInstances(objects.index); !found.empty()) return found;
  if (std::string found = faultOfCells(objects.index); !found.empty()) return found;
  return faultOfLights(objects.lights);
}

}  // namespace

Result<std::uint64_t> writeObjects(const std::filesystem::path& file, const ObjectTerrain& objects) {
  const ObjectIndex& index = objects.index;
  const GeodeticPosition& origin = index.frame.origin();
  ArrayWriter out;
  for (const double v : {origin.latitude.value(), origin.longitude.value(), origin.height.value()})
    out.number(v);
  out.array(index.levels);
  out.array(index.models);
  out.array(index.cells);
  out.array(index.instances);
  out.number(std::uint64_t{objects.names.size()});
  for (const std::string& name : objects.names) out.text(name);
  out.array(objects.meshes);
  out.array(objects.vertices);
  out.array(objects.indices);
  out.number(std::uint64_t{objects.textures.size()});
  for (const ObjectTexture& texture : objects.textures) out.array(texture.pixels);
  addLights(objects.lights, out);
  return writeArrayFile(file, kObjectsKind, kObjectsVersion, std::move(out));
}

Result<std::shared_ptr<const ObjectTerrain>> readObjects(const std::filesystem::path& file,
                                                         const std::string& sum) {
  const auto body = readArrayFile(file, kObjectsKind);
  if (!body) return body.findings();
  if (!sum.empty() && sum != hexadecimal(body->sum))
    return Finding{Severity::error, file.string(), "checksum", sum + ", as the manifest says",
                   hexadecimal(body->sum)};
  auto objects = std::make_shared<ObjectTerrain>();
  ArrayReader reader(body->bytes);
  readArrays(reader, *objects);
  if (body->version > kWithoutLights) readLights(reader, objects->lights);
  if (Findings end = endFindings(file, reader); !end.empty()) return end;
  if (std::string fault = faultOfObjects(*objects); !fault.empty())
    return faultFinding(file, std::move(fault));
  return std::shared_ptr<const ObjectTerrain>(std::move(objects));
}

ObjectCounts countObjects(const ObjectTerrain& objects) {
  const ObjectIndex& index = objects.index;
  ObjectCounts counts{index.models.size(), index.levels.size(), index.instances.size(), index.cells.size(),
                      objects.textures.size()};
  for (const ObjectIndex::Level& level : index.levels) counts.triangles += level.triangles;
  for (const ObjectInstance& instance : index.instances) {
    const ObjectIndex::Model& model = index.models[instance.model];
    counts.finestTriangles += index.levels[model.firstLevel].triangles;
    counts.coarsestTriangles += index.levels[model.firstLevel + model.levels - 1].triangles;
  }
  counts.lights = objects.lights.points.size();
  return counts;
}

}  // namespace trimtab::terrain
