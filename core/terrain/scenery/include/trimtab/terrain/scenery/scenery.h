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

/// Reads FlightGear scenery: tiles (`.btg`, `.btg.gz`, versions 6, 7 and 10) and the lists that place them
/// (`.stg`).
namespace trimtab::terrain {

/// Texture coordinates, and those of a triangle's corners.
using TexturePlace = std::array<float, 2>;
using TextureCorners = std::array<TexturePlace, 3>;

/// One tile or airport, with the triangles of the file's triangle lists, strips and fans. They are
/// anticlockwise from above, except slivers that fold back in the file. Triangles that repeat a vertex, by
/// number or by place, are dropped and counted.
struct SceneryMesh {
  struct Triangle {
    std::array<std::uint32_t, 3> vertex{};
    std::uint16_t material = 0;
  };

  std::string name;  ///< the file's name without its endings, such as "3105386" or "EDNY"
  bool airport = false;
  std::vector<Vec3> vertices;          ///< earth-centred (ECEF), metres
  std::vector<std::string> materials;  ///< as the file spells them
  std::vector<Triangle> triangles;
  std::vector<TextureCorners> texture;  ///< per triangle; empty unless asked for and in the file
  int version = 0;
  std::uint64_t trianglesInFile = 0, degenerate = 0;  ///< the first includes the second
  std::uint64_t facingDown = 0;                       ///< slivers that fold back, among the triangles
};

/// Called now and then with a fraction of 0 to 1; returning false cancels.
using SceneryProgress = std::function<bool(double fraction, const std::string& what)>;

/// Reads a tile, zipped or not, as its first bytes say. Fails if the file ends early, points past its arrays
/// or has vertices off the earth; the finding names the offset in the unzipped bytes, what was expected and
/// what was found. Reads texture coordinates only if asked to.
Result<SceneryMesh> readBtg(const std::filesystem::path& file, bool withTexture = false);
/// Parses the unzipped bytes of a tile. `where` is the file's path, which also gives the mesh its name.
Result<SceneryMesh> parseBtg(std::string_view bytes, const std::string& where, bool withTexture = false);
/// Unpacks all members of a gzip file and checks their sums. Fails beyond 256 MiB.
Result<std::string> gunzip(std::string_view bytes, const std::string& where);

/// The files that a source names: tiles first, then airports, each sorted by path.
struct SceneryList {
  struct File {
    std::filesystem::path path;
    bool airport = false;
  };
  std::vector<File> files;
  std::vector<std::string> missing;  ///< listed, but not there
};
/// Finds the files of a source. It opens lists only; findings as those of readScenery.
Result<SceneryList> listScenery(const std::filesystem::path& path);

/// Tiles and airports in the order of SceneryList.
struct Scenery {
  std::vector<SceneryMesh> tiles;
  std::vector<std::string> missing;  ///< listed, but not there
};
/// Reads all tiles below a folder, of one `.stg` list, or of one `.btg[.gz]` file. In a folder with `.stg`
/// lists only what they list is read; in one without, every `.btg[.gz]`. A listed tile that is not there is a
/// warning. A broken one is an error, and the others are still read.
Result<Scenery> readScenery(const std::filesystem::path& path, const SceneryProgress& progress = {});
/// Returns the files that readScenery reads, lists included.
Result<std::vector<std::filesystem::path>> sceneryFiles(const std::filesystem::path& path);
/// Reports whether a path is a `.btg[.gz]` or `.stg` file, or a folder with one somewhere below.
bool isScenery(const std::filesystem::path& path);

/// A cell of FlightGear's tiling: one eighth of a degree high, and so wide that it is about square.
struct Bucket {
  long index = 0;
  Degrees west, south, east, north;
};
/// Returns the bucket that holds a place, or the one with an index; its index is -1 if there is none.
Bucket bucketAt(Degrees latitude, Degrees longitude);
Bucket bucketOf(long index);
/// Does what bucketAt does, with borders near `longitude` even if that is beyond 180 degrees.
Bucket bucketNear(Degrees latitude, Degrees longitude);

/// Returns the sRGB colour of a material by its name: that of its land cover, or grey for an unknown name.
std::array<std::uint8_t, 3> materialColour(std::string_view material);

}  // namespace trimtab::terrain
