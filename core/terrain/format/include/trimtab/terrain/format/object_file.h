#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "trimtab/terrain/format/object_terrain.h"
#include "trimtab/units/result.h"

/// Reads and writes objects.bin, the objects of a database (resources/docs/terrain-format.md).
namespace trimtab::terrain {

inline constexpr const char* kObjectsName = "objects.bin";

/// What a file of objects may hold at most. A bake refuses more, and so does a reader.
struct ObjectLimits {
  static constexpr float kRadiusM = 20000;  ///< farthest vertex from a model's origin, at scale 1
  static constexpr float kLeastScale = 1e-3f, kMostScale = 1e3f;
  static constexpr std::size_t kTextures = 255;
  static constexpr std::int32_t kCellOrigin = 1 << 20;  ///< either way, in steps of 16 m
  static constexpr float kFromOriginM = 2e7f;           ///< bounds and instances, either way
  static constexpr std::size_t kLights = 4000000;       ///< 64 MB on the GPU
};

/// Writes the file atomically; returns the checksum of its body, which the manifest states.
Result<std::uint64_t> writeObjects(const std::filesystem::path& file, const ObjectTerrain& objects);

/// Reads a file of objects. Whatever its bytes are, what is returned can be used without further checks:
/// every number of a mesh, a vertex, a texture, a model or an instance is in its array, instances and
/// triangles are each in one leaf cell and one mesh, lights in one cell whose box holds them, errors rise and
/// all numbers are finite.
/// `sum`: the checksum that the body must have, hexadecimal; empty accepts any.
Result<std::shared_ptr<const ObjectTerrain>> readObjects(const std::filesystem::path& file,
                                                         const std::string& sum = {});

/// Counts what `terrain info` reports.
struct ObjectCounts {
  std::size_t models = 0, levels = 0, instances = 0, cells = 0, textures = 0;
  std::uint64_t triangles = 0;        ///< of all levels, each once
  std::uint64_t finestTriangles = 0;  ///< of all instances, each by its finest level
  std::uint64_t coarsestTriangles = 0;
  std::size_t lights = 0;
};
ObjectCounts countObjects(const ObjectTerrain& objects);

}  // namespace trimtab::terrain
