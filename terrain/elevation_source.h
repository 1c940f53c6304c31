#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "trimtab/terrain/database.h"
#include "trimtab/terrain/height_window.h"

namespace trimtab::terrain {

/// Elevation of any number of files as one grid of posts, read a band at a time: memory does not follow the
/// size of the data.
class ElevationSource {
 public:
  virtual ~ElevationSource() = default;
  virtual const PostGrid& posts() const = 0;
  /// Rows [first, first + rows) of the merged grid, NaN where no file has a height. One thread at a time.
  virtual Result<Done> readRows(std::uint32_t first, std::uint32_t rows, std::span<float> heights) = 0;
  /// Names of the files, in order of their say.
  virtual std::vector<std::string> names() const = 0;
};

/// Opens what importElevation reads, and says of every file that it cannot use why. Findings carry notes
/// about what was assumed.
Result<std::unique_ptr<ElevationSource>> openElevation(std::span<const std::filesystem::path> sources);

}  // namespace trimtab::terrain
