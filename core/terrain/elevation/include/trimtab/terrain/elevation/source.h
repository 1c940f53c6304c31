#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "trimtab/terrain/grid/height_window.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::terrain {

/// Elevation of any number of files as one grid of posts, read a band at a time, which does not change what
/// is read. Memory follows the grid's columns (some hundred rows of them for each file that covers them), a
/// row of the longest file's blocks, and GDAL's cache; neither the number of files nor their rows, but for
/// what GDAL keeps of the 128 that it has open.
///
/// A post that lies on a file's own is that file's height to the bit; between a file's posts the height is
/// cubic. Of files that have a height at a post the finest leads, and of equals the first; towards a border
/// where another file goes on, or a void that it fills, the leading file gives way over 32 posts, so that
/// there is no step.
class ElevationSource {
 public:
  virtual ~ElevationSource() = default;
  virtual const PostGrid& posts() const = 0;
  /// Rows [first, first + rows) of the merged grid, NaN where no file has a height. `beyond`, where wanted:
  /// 1 where no file reaches (about a raster that stands askew), 0 at voids. One thread at a time; rows in
  /// order are read once.
  virtual Result<Done> readRows(std::uint32_t first, std::uint32_t rows, std::span<float> heights,
                                std::span<std::uint8_t> beyond = {}) = 0;
  /// Names of the files, in order of their say.
  virtual std::vector<std::string> names() const = 0;
  /// Of the rows read so far, the posts that each of them gave, or gave most of.
  virtual std::vector<std::uint64_t> given() const = 0;
};

struct ElevationOptions {
  /// Distance of posts, degrees of latitude; else that of the finest file. A file that is finer is averaged.
  std::optional<double> stepLatitude;
  Progress progress;
};

/// Opens what importElevation reads, and says of every file that it cannot use why. Each file is read through
/// once, for its voids and for damage. Findings carry notes about what was assumed.
///
/// The grid is that of the finest file that is geographic already, unless another file is finer by a tenth.
/// Round the earth it has at most 360 degrees: its last column may stand where the first does.
Result<std::unique_ptr<ElevationSource>> openElevation(std::span<const std::filesystem::path> sources,
                                                       const ElevationOptions& options = {});

/// What each of several files gave to a grid, as notes; nothing of one file alone. `given`: one a name,
/// posts.
Findings sharesOf(const std::vector<std::string>& names, const std::vector<std::uint64_t>& given);

}  // namespace trimtab::terrain
