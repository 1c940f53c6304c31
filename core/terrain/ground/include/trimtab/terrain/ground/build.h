#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "trimtab/terrain/format/ground_pyramid.h"
#include "trimtab/terrain/grid/height_window.h"
#include "trimtab/terrain/grid/post_geometry.h"
#include "trimtab/terrain/grid/progress.h"

/// Builds the pyramid of ground colours and normals, block by block. Memory depends on GroundSources::memory
/// and the number of cores, not on the size of the terrain. Format: resources/docs/terrain-format.md.
namespace trimtab::terrain {

class GroundTriangles;

/// Says what the ground is coloured from: images first; where none has a colour, the materials of the
/// triangles; and where there are none either, land cover by height, slope and latitude.
struct GroundSources {
  const HeightSource* heights = nullptr;
  const PostGeometry* geometry = nullptr;
  /// Rasters that GDAL reads, in any CRS, with bytes of red, green and blue, of grey, or of a palette. Where
  /// images overlap, the first one that has a colour is used.
  std::vector<std::filesystem::path> images;
  const GroundTriangles* triangles = nullptr;
  /// A power of two, 1/64 to 64. If unset, as fine as the finest image, from 1 to `mostTexelsPerPost`; 2 if
  /// there are triangles.
  std::optional<double> texelsPerPost;
  double mostTexelsPerPost = 8;
  /// Most bytes for the blocks in work, some 32 MB each; one block is always allowed.
  std::size_t memory = std::size_t{512} << 20;
};

/// Counts how many of the finest texels each image covers.
struct GroundCover {
  std::uint64_t texels = 0;  ///< of the whole ground
  std::uint64_t coveredByAny = 0;
  std::vector<std::uint64_t> covered;  ///< one count per image, for the whole ground or for a share
};
/// Reports ground that no image covers, and images that cover none; it is an error if all cover none.
Findings aboutCover(std::span<const std::filesystem::path> images, const GroundCover& cover);

/// Builds a page file that openGround reads. Its bytes depend on the sources alone.
Result<Done> buildGround(const GroundSources& sources, const std::filesystem::path& file,
                         const Progress& progress);

/// Builds share `part` (from 0) of `parts`, for several processes or machines. Joined, the shares have the
/// same bytes as buildGround's file.
Result<GroundCover> buildGroundPart(const GroundSources& sources, std::uint32_t part, std::uint32_t parts,
                                    const std::filesystem::path& file, const Progress& progress);
/// Joins all shares to one file. A damaged share is removed and reported.
Result<Done> joinGround(std::span<const std::filesystem::path> parts, const std::filesystem::path& file,
                        const Progress& progress);

}  // namespace trimtab::terrain
