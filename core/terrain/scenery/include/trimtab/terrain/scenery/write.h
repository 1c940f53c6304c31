#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/terrain/scenery/scenery.h"

/// Writes FlightGear scenery: tiles (`.btg.gz`) and where they belong.
namespace trimtab::terrain {

/// A surface to write as a tile.
struct BtgSurface {
  SceneryMesh mesh;           ///< vertices, materials and triangles; the other members are not written
  std::vector<Vec3> normals;  ///< per vertex, earth-centred, of length 1
  /// Texture coordinates, per vertex. FlightGear scales them by the size of the material's texture, so that
  /// one unit is one kilometre on the ground.
  std::vector<std::array<float, 2>> texture;
};

/// Returns the unzipped bytes of a tile: version 7 if all indices fit in 16 bits, else 10. Vertices are
/// floats relative to the middle of the box around them: within 1 mm for a tile of 30 km. Its creation time
/// is 0, so that the same surface gives the same bytes. The mesh must have a vertex, and every array one
/// entry per vertex.
std::string btgBytes(const BtgSurface& surface);
/// Zips bytes as gunzip() reads them, without a time.
std::string gzip(std::string_view bytes);

/// Returns texture coordinates by place, as scenery's land has them: kilometres east and north of the
/// south-west corner of the whole degree that holds the middle of `places`. Neighbouring tiles of one degree
/// agree on their border.
std::vector<std::array<float, 2>> textureByPlace(const std::vector<Vec3>& places);

/// Returns the folder of a bucket below `Terrain`, such as "e000n50/e007n50". The index must be a bucket's.
std::filesystem::path bucketFolder(long index);

}  // namespace trimtab::terrain
