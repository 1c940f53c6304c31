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

/// Builds the ground's pyramid, block by block: memory follows what is given and the number of cores, not the
/// size of the land.
namespace trimtab::terrain {

class GroundTriangles;

/// What the ground's look is made from. Where no image has a colour the triangles' materials give it, and
/// where there are none of those the land cover that height, slope and latitude suggest.
struct GroundSources {
  const HeightSource* heights = nullptr;
  const PostGeometry* geometry = nullptr;
  /// Any raster that GDAL reads with bytes of red, green and blue, of grey, or of a palette, in any CRS; the
  /// first that has something at a place gives its colour.
  std::vector<std::filesystem::path> images;
  const GroundTriangles* triangles = nullptr;
  /// A power of two, 1/64 to 64. Without: as fine as the finest image, from 1 to `mostTexelsPerPost`; 2 for
  /// triangles.
  std::optional<double> texelsPerPost;
  double mostTexelsPerPost = 8;
  /// Bytes that blocks in work may take, some 32 MB each: of one at least.
  std::size_t memory = std::size_t{512} << 20;
};

/// What images cover of the finest texels that are made.
struct GroundCover {
  std::uint64_t texels = 0;            ///< of the whole ground
  std::vector<std::uint64_t> covered;  ///< one an image: of the whole, or of a share
};
/// Tells of images that leave ground without; an error where one covers none.
Findings aboutCover(std::span<const std::filesystem::path> images, const GroundCover& cover);

/// Into a page file that openGround opens. The bytes depend on the sources alone.
Result<Done> buildGround(const GroundSources& sources, const std::filesystem::path& file,
                         const Progress& progress);

/// The i-th of so many shares, for several processes or machines; joined, the same bytes as buildGround's.
Result<GroundCover> buildGroundPart(const GroundSources& sources, std::uint32_t part, std::uint32_t parts,
                                    const std::filesystem::path& file, const Progress& progress);
/// Removes a part that turns out damaged, and says so.
Result<Done> joinGround(std::span<const std::filesystem::path> parts, const std::filesystem::path& file,
                        const Progress& progress);

/// All of it in memory.
Result<std::shared_ptr<const GroundPyramid>> buildGroundInMemory(const GroundSources& sources,
                                                                 const Progress& progress = {});

}  // namespace trimtab::terrain
