#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "trimtab/frame/light_index.h"
#include "trimtab/frame/object_index.h"

/// The objects of a database: what stands on its ground, with meshes and textures.
namespace trimtab::terrain {

/// A vertex as the renderer uploads it, in the model's axes: metres east, north and up of the model's origin,
/// before its heading.
struct ObjectVertex {
  float x = 0, y = 0, z = 0;
  std::array<std::int8_t, 3> normal{0, 0, 127};            ///< unit length, times 127
  std::uint8_t texture = kNoTexture;                       ///< its number in ObjectTerrain::textures
  std::array<std::uint8_t, 4> colour{255, 255, 255, 255};  ///< sRGB and opacity, multiplied by the texture's
  std::array<std::uint16_t, 2> place{};  ///< in the texture: half floats, u and v; they repeat

  static constexpr std::uint8_t kNoTexture = 255;
};
static_assert(sizeof(ObjectVertex) == 24);

/// Where the mesh of a level is in ObjectTerrain::vertices and indices.
struct ObjectMesh {
  std::uint32_t firstVertex = 0, firstIndex = 0, indices = 0;
  /// Triangles are seen from both sides, as leaves and open shells are. If false they are anticlockwise from
  /// outside.
  std::uint32_t bothSides = 1;
};

/// RGBA, sRGB, rows from the bottom. All textures of a terrain have this one size, so that they are the
/// layers of one array.
struct ObjectTexture {
  static constexpr std::uint32_t kSidePx = 256;
  std::vector<std::uint8_t> pixels;  ///< kSidePx * kSidePx * 4
};

struct ObjectTerrain {
  ObjectIndex index;
  std::vector<std::string> names;  ///< one per model, as its source called it
  std::vector<ObjectMesh> meshes;  ///< one per level of the index
  std::vector<ObjectVertex> vertices;
  std::vector<std::uint32_t> indices;   ///< three per triangle, from the mesh's first vertex
  std::vector<ObjectTexture> textures;  ///< at most 255
  LightIndex lights;                    ///< in the frame of `index`
};

}  // namespace trimtab::terrain
