#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/terrain/format/checked_rows.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/page_file.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/grid/measure_levels.h"
#include "trimtab/terrain/grid/post_grid.h"

/// Reads and writes the files of a database folder. resources/docs/terrain-format.md describes them: the
/// manifest names all others with their sizes and checksums.
namespace trimtab::terrain {

inline constexpr int kFormatVersion = 2;
inline constexpr const char* kManifestName = "manifest.json";
inline constexpr const char* kHeightsName = "heights.f32";
inline constexpr const char* kHeightSumsName = "heights.sums";
inline constexpr const char* kImageName = "image.rgba";
inline constexpr const char* kImageSumsName = "image.sums";
inline constexpr const char* kNodesName = "nodes.f32";
inline constexpr const char* kSlopesName = "slopes.u8";
inline constexpr const char* kConesName = "cones.u32";
inline constexpr const char* kPatchesName = "patches.pages";
inline constexpr const char* kGroundName = "ground.pages";
inline constexpr const char* kStaticLodName = "static-lod.bin";
/// Larger grids are drawn from patches only.
inline constexpr std::size_t kMostTiledPosts = std::size_t{1} << 26;

/// Tells whether a file of a database has this name.
bool isDatabaseFile(std::string_view name);
/// Tells whether a bake may replace a folder: it does not exist, or is empty, or holds the files of a
/// database, possibly damaged, and nothing else.
bool mayReplace(const std::filesystem::path& folder);

/// The contents of a database. Large files are read where they are used.
struct Contents {
  TerrainInfo info;
  PostGrid posts;
  std::shared_ptr<const CheckedRows> heights;
  std::shared_ptr<const CheckedRows> image;  ///< RGBA per post; null if there is no image, or no tiles
  TerrainIndex index;                        ///< empty if there are no tiles
  CellSlopes slopes;
  std::shared_ptr<const StaticLodTerrain> staticLod;  ///< null if no source was scenery
  std::shared_ptr<const PatchTerrain> patches;        ///< null in version 1, as is `ground`
  std::shared_ptr<const GroundPyramid> ground;
  std::shared_ptr<const ObjectTerrain> objects;            ///< null if nothing stands on the ground
  std::vector<std::shared_ptr<const PageFile>> pageFiles;  ///< the files of `patches` and `ground`
};

/// Returns the checksum that all files use: four interleaved FNV-1a sums over 64-bit words, the last word
/// padded with zeros, then folded with the size. It is our own because it is part of the file format.
std::uint64_t checksum(std::string_view bytes);
/// Returns 16 lower-case hexadecimal digits.
std::string hexadecimal(std::uint64_t value);

/// A file as the manifest lists it. `sum` is the checksum of its bytes; for rows whose checksums are in a
/// file of their own, that of the latter; for a page file and for objects, the checksum in its header.
struct FileEntry {
  std::string name;
  std::uint64_t bytes = 0;
  std::optional<std::uint64_t> sum;
};
Result<FileEntry> writeFile(const std::filesystem::path& folder, const std::string& name,
                            std::string_view bytes);
/// Returns the contents of nodes.f32: box, error and slope of each node.
std::vector<float> nodeNumbers(const TerrainIndex& index);

/// Writes manifest.json. Of `info`, only what does not follow from the grid is used. `recipe`: a JSON object
/// that says what the database was made from.
Result<Done> writeManifest(const std::filesystem::path& folder, const TerrainInfo& info,
                           const PostGrid& posts, const std::vector<FileEntry>& files,
                           std::optional<std::uint32_t> trianglesPerNode, const std::string& recipe);
/// Opens a database folder. Checks the manifest, the sizes of all files, and the checksums of files that are
/// read whole. A size is checked before memory is allocated for it, so that a damaged manifest cannot exhaust
/// memory.
Result<Contents> readContents(const std::filesystem::path& folder);

}  // namespace trimtab::terrain
