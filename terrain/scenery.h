#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/units/geodesy.h"
#include "trimtab/units/result.h"

/// FlightGear scenery: tiles (`.btg`, `.btg.gz`, versions 7 and 10) and the lists that place them (`.stg`).
namespace trimtab::terrain {

/// One tile or airport. Triangles from single triangles, strips and fans alike, anticlockwise from above;
/// those that repeat a vertex are dropped and counted.
struct SceneryMesh {
  struct Triangle {
    std::array<std::uint32_t, 3> vertex{};
    std::uint16_t material = 0;
  };

  std::string name;  ///< file name without its endings: "3105386", "EDNY"
  bool airport = false;
  std::vector<Vec3> vertices;          ///< ECEF, metres
  std::vector<std::string> materials;  ///< as the file spells them
  std::vector<Triangle> triangles;
  int version = 0;
  std::uint64_t trianglesInFile = 0, degenerate = 0;  ///< the file's include the degenerate
};

/// Finding names byte offset, expected and found. A file that ends early or points past its arrays is
/// refused.
Result<SceneryMesh> readBtg(const std::filesystem::path& file);
/// `bytes` as unzipped.
Result<SceneryMesh> parseBtg(std::string_view bytes, const std::string& where);

/// All tiles below a folder: by its `.stg` lists, or every `.btg[.gz]` where there are none. A listed tile
/// that is not there is a warning, a broken one an error that leaves the others.
struct Scenery {
  std::vector<SceneryMesh> tiles;
  std::vector<std::string> missing;
};
Result<Scenery> readScenery(const std::filesystem::path& folder);
/// Whether a path holds scenery of this kind: a `.btg[.gz]`, `.stg`, or a folder with one somewhere below.
bool isScenery(const std::filesystem::path& path);

/// Number of the bucket that holds a place, and its borders: FlightGear's tiling, one eighth of a degree
/// high.
struct Bucket {
  long index = 0;
  Degrees west, south, east, north;
};
Bucket bucketAt(Degrees latitude, Degrees longitude);
Bucket bucketOf(long index);

/// sRGB of a material by its name: land cover in sensible colours; a name nobody knows gets a grey.
std::array<std::uint8_t, 3> materialColour(std::string_view material);

}  // namespace trimtab::terrain
