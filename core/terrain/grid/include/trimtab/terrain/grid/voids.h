#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// Heights whose voids are filled. They need not be in memory.
struct VoidFill {
  std::uint32_t columns = 0, rows = 0;
  /// Reads rows [first, first + rows). All rows are read twice, each time from the first to the last.
  std::function<Result<Done>(std::uint32_t first, std::uint32_t rows, std::span<float> heights)> read;
  /// Receives rows that had voids, now filled, in order. A row is written after it was read for the last
  /// time, so that it may overwrite its source.
  std::function<Result<Done>(std::uint32_t first, std::uint32_t rows, std::span<const float> heights)> write;
  /// Coarser levels, a third of the heights' size, go to an unnamed file in this folder if they do not fit in
  /// `memory` bytes. Up to some 100 rows more are held in memory if all posts are voids, half of that if few
  /// are.
  std::filesystem::path scratch = std::filesystem::temp_directory_path();
  std::size_t memory = std::size_t{64} << 20;
  std::function<bool(double fraction)> carryOn;
};
/// Replaces NaN by a smooth surface (a membrane) through the heights around each void, and returns how many
/// posts were filled. If all posts are voids, they become 0 m. The result does not depend on `memory`.
Result<std::uint64_t> fillVoids(const VoidFill& fill);

}  // namespace trimtab::terrain
