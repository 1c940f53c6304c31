#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/units/geodesy.h"
#include "trimtab/units/result.h"

/// FlightGear scenery: tiles (`.btg`, `.btg.gz`, versions 7 and 10) and the lists that place them (`.stg`).
namespace trimtab::terrain {

/// One tile or airport. Triangles from single triangles, strips and fans alike, anticlockwise from above but
/// for slivers that fold back in the file; those that repeat a vertex, by its number or by its place, are
/// dropped and counted.
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
  std::uint64_t facingDown = 0;                       ///< of the triangles: slivers that fold back
};

/// Told now and then; returning false cancels.
using SceneryProgress = std::function<bool(double fraction, const std::string& what)>;

/// Zipped or not, as its first bytes say. Finding names byte offset (of the unzipped bytes), expected and
/// found. A file that ends early, points past its arrays or has vertices off the earth is refused.
Result<SceneryMesh> readBtg(const std::filesystem::path& file);
/// `bytes` as unzipped; `where` is a file's path, and names the mesh.
Result<SceneryMesh> parseBtg(std::string_view bytes, const std::string& where);
/// What gzip packed: all members, checked by their sums. Refuses to grow beyond 256 MiB.
Result<std::string> gunzip(std::string_view bytes, const std::string& where);

/// What a source names: tiles first, then airports, each by path.
struct SceneryList {
  struct File {
    std::filesystem::path path;
    bool airport = false;
  };
  std::vector<File> files;
  std::vector<std::string> missing;  ///< listed, but not there
};
/// Opens lists alone; findings as readScenery's.
Result<SceneryList> listScenery(const std::filesystem::path& path);

/// In the list's order.
struct Scenery {
  std::vector<SceneryMesh> tiles;
  std::vector<std::string> missing;  ///< listed, but not there
};
/// All tiles below a folder, of one `.stg` or of one `.btg[.gz]`. In a folder with `.stg` lists those say
/// which; in one without, every `.btg[.gz]` counts. A listed tile that is not there is a warning, a broken
/// one an error that leaves the others.
Result<Scenery> readScenery(const std::filesystem::path& path, const SceneryProgress& progress = {});
/// The files that readScenery reads, lists included.
Result<std::vector<std::filesystem::path>> sceneryFiles(const std::filesystem::path& path);
/// Whether a path holds scenery of this kind: a `.btg[.gz]`, `.stg`, or a folder with one somewhere below.
bool isScenery(const std::filesystem::path& path);

/// FlightGear's tiling: one eighth of a degree high, and as wide as keeps buckets about square.
struct Bucket {
  long index = 0;
  Degrees west, south, east, north;
};
/// The bucket that holds a place, and the borders of one; index -1 where there is none.
Bucket bucketAt(Degrees latitude, Degrees longitude);
Bucket bucketOf(long index);
/// bucketAt with borders in the turn of `longitude`: past 180 degrees where that is.
Bucket bucketNear(Degrees latitude, Degrees longitude);

/// sRGB of a material by its name: land cover in sensible colours; a name nobody knows gets a grey.
std::array<std::uint8_t, 3> materialColour(std::string_view material);

}  // namespace trimtab::terrain
