#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// A model as a file holds it, flattened to triangles, before it is checked and before it has levels.
namespace trimtab::terrain {

/// A corner of triangles in the model's axes: metres east (x), north (y) and up (z) of its origin. Nothing of
/// it need be a number that makes sense: buildModel() checks.
struct SourceVertex {
  std::array<float, 3> position{};
  std::array<float, 3> normal{};  ///< of any length; zero or not a number: the face's is used
  std::array<std::uint8_t, 4> colour{255, 255, 255, 255};  ///< sRGB and opacity, multiplied by the texture's
  std::array<float, 2> place{};                            ///< in the texture, u and v; it repeats
  std::uint32_t texture = kNoTexture;                      ///< its number in SourceModel::textures

  static constexpr std::uint32_t kNoTexture = 0xffffffffu;
};
static_assert(sizeof(SourceVertex) == 40, "vertices are welded by their bytes");

struct SourceMesh {
  std::vector<SourceVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< three per triangle
  /// Triangles are seen from both sides; if false they are anticlockwise from outside.
  bool bothSides = true;

  std::size_t triangles() const { return indices.size() / 3; }
};

/// RGBA, sRGB, rows from the bottom.
struct SourceTexture {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  ///< width * height * 4
};

/// A light, in the model's axes like a vertex.
struct SourceLight {
  std::array<float, 3> position{};
  std::array<std::uint8_t, 4> colour{255, 255, 255, 255};  ///< sRGB; the last is not used
};

struct SourceModel {
  std::string name;                ///< as the placements call it
  std::vector<SourceMesh> levels;  ///< finest first; at least one
  std::vector<SourceTexture> textures;
  std::vector<SourceLight> lights = {};
};

/// Returns a checksum of all that a model holds but its name: two files that hold the same have the same.
std::uint64_t checksumOf(const SourceModel& model);

}  // namespace trimtab::terrain
