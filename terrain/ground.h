#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "trimtab/terrain/post_grid.h"
#include "trimtab/units/result.h"

/// Colour and normal of the ground as pictures of halving resolution, in tiles: independent of the levels of
/// the surface, so that land keeps its look when its mesh gets coarser.
namespace trimtab::terrain {

/// A texel: sRGB, and the normal of the finest surface there (local frame, x and y x 127; z is up).
struct GroundTexel {
  std::uint8_t red, green, blue;
  std::uint8_t voids;  ///< 255: a void that was filled; coarser levels say what share
  std::int8_t normalX, normalY;
};
static_assert(sizeof(GroundTexel) == 6);

/// Level 0 is the finest: `texelsPerPost` (a power of two, may be less than 1) texels from a post to the
/// next; texel (c, r) of level l stands for posts from c / texelsPerPost * 2^l on. Each level halves the one
/// before, to a single tile.
struct GroundShape {
  static constexpr std::uint32_t kTile = 256;  ///< texels a side
  struct Level {
    std::uint32_t columns = 0, rows = 0;  ///< texels
    std::uint32_t tileColumns() const { return (columns + kTile - 1) / kTile; }
    std::uint32_t tileRows() const { return (rows + kTile - 1) / kTile; }
  };
  double texelsPerPost = 1;
  std::vector<Level> levels;
};

class GroundPyramid {
 public:
  virtual ~GroundPyramid() = default;
  virtual const GroundShape& shape() const = 0;
  /// kTile x kTile texels, rows from south; past the last row or column the last is repeated. Waits for the
  /// disk. Thread-safe.
  virtual Result<std::vector<GroundTexel>> readTile(std::uint32_t level, std::uint32_t column,
                                                    std::uint32_t row) const = 0;
};

}  // namespace trimtab::terrain
