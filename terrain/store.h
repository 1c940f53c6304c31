#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/terrain/database.h"
#include "trimtab/terrain/measure_levels.h"
#include "trimtab/terrain/post_grid.h"

/// The files of a database folder: manifest.json names and checks the others, which are little-endian arrays.
///
/// heights.f32 heights in metres, rows from south; nodes.f32 eight numbers a node (box, error, slope);
/// slopes.u8 the cells of CellSlopes; image.rgba four bytes a post, where there is an image; static-lod.bin
/// the trees of static levels of detail, where the source was scenery.
namespace trimtab::terrain {

inline constexpr int kFormatVersion = 1;
inline constexpr const char* kManifestName = "manifest.json";
inline constexpr const char* kStaticLodName = "static-lod.bin";

/// All that a database holds, read into memory.
struct Contents {
  TerrainInfo info;
  HeightGrid grid;
  TerrainIndex index;
  CellSlopes slopes;
  std::shared_ptr<const StaticLodTerrain> staticLod;  ///< null where the source was no scenery
};

/// Four interleaved FNV-1a sums over 64-bit words, the last one filled up with zeros, then folded with the
/// size.
std::uint64_t checksum(std::string_view bytes);
std::string hexadecimal(std::uint64_t value);

/// Writes the files into an existing empty folder.
Result<Done> writeContents(const std::filesystem::path& folder, const Contents& contents);
/// Reads and checks all of it: sizes before anything is allocated by them.
Result<Contents> readContents(const std::filesystem::path& folder);

}  // namespace trimtab::terrain
