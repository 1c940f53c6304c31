#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// Replaces NaN by a smooth surface through the heights around it (a membrane), and counts them. All void:
/// sea, 0 m.
std::uint64_t fillVoids(HeightGrid& grid);

/// The same over heights that are kept elsewhere, to the bit, however wide a void is.
struct VoidFill {
  std::uint32_t columns = 0, rows = 0;
  /// Rows [first, first + rows). Asked for twice, each time from the first row to the last.
  std::function<Result<Done>(std::uint32_t first, std::uint32_t rows, std::span<float> heights)> read;
  /// Rows that had voids, filled, in order; each after it was read for the last time, so that it may go where
  /// it was read from.
  std::function<Result<Done>(std::uint32_t first, std::uint32_t rows, std::span<const float> heights)> write;
  /// Coarser levels (a third of the heights' size) go to a nameless file here where they do not fit in
  /// `memory`, bytes. Beside them up to some 100 rows are held, where all are voids; half where few are.
  std::filesystem::path scratch = std::filesystem::temp_directory_path();
  std::size_t memory = std::size_t{64} << 20;
  std::function<bool(double fraction)> carryOn;
};
/// How many were filled.
Result<std::uint64_t> fillVoids(const VoidFill& fill);

}  // namespace trimtab::terrain
