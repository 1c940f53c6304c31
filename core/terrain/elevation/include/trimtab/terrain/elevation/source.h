#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "trimtab/terrain/grid/height_window.h"
#include "trimtab/terrain/grid/no_source.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::terrain {

/// Elevation of any number of files as one grid of posts, read a band of rows at a time. The heights do not
/// depend on the size of the bands. Memory grows with the grid's columns (some hundred rows for each file
/// that covers them), a row of the longest file's blocks, and GDAL's cache. It does not grow with the number
/// of files or their rows, except for what GDAL keeps of the at most 128 files that are open.
///
/// A post that coincides with a file's post has that file's height to the bit; between a file's posts the
/// height is interpolated cubically. If several files have a height at a post, the finest is used, among
/// equals the first. Within 32 posts of its border, or of a void that another file fills, it is blended with
/// that file, so that there is no step.
class ElevationSource {
 public:
  virtual ~ElevationSource() = default;
  virtual const PostGrid& posts() const = 0;
  /// Reads rows [first, first + rows) of the merged grid, metres, NaN where no file has a height. If `beyond`
  /// is not empty, it gets 1 where no file reaches (the corners around a rotated raster) and 0 elsewhere,
  /// also at voids. If `from` is not empty, it gets the number in names() of the file that gave each height
  /// or most of it, and kNoSource where there is none or names() is empty. Only one thread may call this at a
  /// time. Read the rows in order: then each is read from disk once.
  virtual Result<Done> readRows(std::uint32_t first, std::uint32_t rows, std::span<float> heights,
                                std::span<std::uint8_t> beyond = {}, std::span<std::uint16_t> from = {}) = 0;
  /// Returns the names of the files; an earlier file has precedence.
  virtual std::vector<std::string> names() const = 0;
  /// Returns, for each name, how many posts of the rows read so far have their height, or most of it, from
  /// it.
  virtual std::vector<std::uint64_t> given() const = 0;
};

/// What the user says about files that do not say it themselves.
struct Reading {
  /// Metres per unit of heights in files that name no unit, or none that is known (metresPerUnit).
  std::optional<double> heightUnit;
  /// Read DTED whose profiles do not agree with their checksums, or have none; otherwise it is refused.
  bool ignoreChecksums = false;
};

struct ElevationOptions {
  Reading reading;
  /// Post spacing, degrees of latitude; if unset, that of the finest file. Finer files are averaged.
  std::optional<double> stepLatitude;
  Progress progress;
};

/// Opens elevation files, or folders of them. Reports every file that cannot be used, with the reason. Reads
/// each file through once, for its voids and for damage. Findings include notes about what was assumed.
///
/// The grid is that of the finest file in degrees of WGS84, unless another file is finer by a tenth. A grid
/// round the earth spans at most 360 degrees: its last column may coincide with the first.
Result<std::unique_ptr<ElevationSource>> openElevation(std::span<const std::filesystem::path> sources,
                                                       const ElevationOptions& options = {});

/// Reports as notes which share of the posts each file gave; nothing if there is only one file. `given`:
/// posts, one count per name.
Findings sharesOf(const std::vector<std::string>& names, const std::vector<std::uint64_t>& given);

}  // namespace trimtab::terrain
