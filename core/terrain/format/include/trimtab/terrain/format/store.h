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

/// The files of a database folder: manifest.json names and checks the others, which are little-endian.
///
/// heights.f32 heights in metres, rows from south, and heights.sums the checksums of its blocks of rows;
/// patches.pages the error-bounded levels (patch_store.h); ground.pages colours and normals. Of grids of up
/// to kMostTiledPosts posts also, where memory allowed: nodes.f32 eight numbers a node (box, error, slope);
/// slopes.u8 the cells of CellSlopes; cones.u32 a NormalCone a node, which earlier bakes lack; image.rgba
/// four bytes a post with image.sums, where there is an image. static-lod.bin the trees of static levels of
/// detail, where the source was scenery.
///
/// Version 1 has neither sums nor pages: all of a file is checked when the folder is opened.
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

/// Whether a bake may take a folder's place: there is nothing, or an empty folder, or a database of ours (a
/// damaged one may be baked again) with nothing beside it.
bool mayReplace(const std::filesystem::path& folder);

/// All that a database holds; what is large is mapped, not read.
struct Contents {
  TerrainInfo info;
  PostGrid posts;
  std::shared_ptr<const CheckedRows> heights;
  std::shared_ptr<const CheckedRows> image;  ///< RGBA a post; null without an image, and without tiles
  TerrainIndex index;                        ///< empty where there are no tiles
  CellSlopes slopes;
  std::shared_ptr<const StaticLodTerrain> staticLod;  ///< null where the source was no scenery
  std::shared_ptr<const PatchTerrain> patches;        ///< these two null in version 1
  std::shared_ptr<const GroundPyramid> ground;
  std::vector<std::shared_ptr<const PageFile>> pageFiles;  ///< behind them
};

/// Four interleaved FNV-1a sums over 64-bit words, the last one filled up with zeros, then folded with the
/// size.
std::uint64_t checksum(std::string_view bytes);
std::string hexadecimal(std::uint64_t value);

/// A file as the manifest names it. `sum`: of its bytes; of rows that have sums, of those; of a page file,
/// its own.
struct FileEntry {
  std::string name;
  std::uint64_t bytes = 0;
  std::optional<std::uint64_t> sum;
};
Result<FileEntry> writeFile(const std::filesystem::path& folder, const std::string& name,
                            std::string_view bytes);
std::vector<float> nodeNumbers(const TerrainIndex& index);

/// Of `info` what does not follow from the grid. `recipe`: a JSON object, what it was made from.
Result<Done> writeManifest(const std::filesystem::path& folder, const TerrainInfo& info,
                           const PostGrid& posts, const std::vector<FileEntry>& files,
                           std::optional<std::uint32_t> trianglesPerNode, const std::string& recipe);
/// Checks the manifest, the sizes of all files and what is read whole: sizes before anything is allocated by
/// them.
Result<Contents> readContents(const std::filesystem::path& folder);

}  // namespace trimtab::terrain
