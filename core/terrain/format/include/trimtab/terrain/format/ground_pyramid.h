#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/units/result.h"

/// Colour and normal of the ground as pictures of halving resolution, in tiles: independent of the levels of
/// the surface, so that land keeps its look when its mesh gets coarser.
namespace trimtab::terrain {

/// A texel: sRGB, and the normal of the finest surface there (local frame, x and y x 127; z is up).
struct GroundTexel {
  std::uint8_t red, green, blue;
  std::uint8_t voids;  ///< 255: a void that was filled; coarser levels say what share
  std::int8_t normalX, normalY;
  friend bool operator==(const GroundTexel&, const GroundTexel&) = default;
};
static_assert(sizeof(GroundTexel) == 6);

/// Level 0 is the finest: `texelsPerPost` (a power of two, may be less than 1) texels from a post to the
/// next. A texel of level 0 stands on post (c, r) / texelsPerPost, so pictures on the posts' own grid keep
/// every pixel; with less than one a post it is the mean of the posts from there on. Each level halves the
/// one before, to a single tile: a texel is the mean of two by two, those past the border being the last.
struct GroundShape {
  static constexpr std::uint32_t kTile = 256;  ///< texels a side
  struct Level {
    std::uint32_t columns = 0, rows = 0;  ///< texels
    std::uint32_t tileColumns() const { return (columns + kTile - 1) / kTile; }
    std::uint32_t tileRows() const { return (rows + kTile - 1) / kTile; }
    friend bool operator==(const Level&, const Level&) = default;
  };
  double texelsPerPost = 1;
  std::vector<Level> levels;

  /// Where a post is among the texels of level 0, texel c reaching from c to c + 1; level l is this by 2^-l.
  double texelOf(double post) const { return post * texelsPerPost + 0.5 * std::min(1.0, texelsPerPost); }
  friend bool operator==(const GroundShape&, const GroundShape&) = default;
};

GroundShape makeGroundShape(const PostGrid& posts, double texelsPerPost);

using GroundTile = std::vector<GroundTexel>;  ///< kTile x kTile, rows from south

class GroundPyramid {
 public:
  virtual ~GroundPyramid() = default;
  virtual const GroundShape& shape() const = 0;
  /// kTile x kTile texels, rows from south; past the last row or column the last is repeated. Waits for the
  /// disk. Thread-safe.
  virtual Result<GroundTile> readTile(std::uint32_t level, std::uint32_t column, std::uint32_t row) const = 0;
};

/// Opens what buildGround wrote (trimtab/terrain/ground/build.h) for these posts.
Result<std::shared_ptr<const GroundPyramid>> openGround(const std::filesystem::path& file,
                                                        const PostGrid& posts);

/// How tiles stand in a page file.
constexpr std::uint64_t groundKey(std::uint32_t level, std::uint32_t column, std::uint32_t row) {
  return (std::uint64_t{level} << 56) | (std::uint64_t{row} << 28) | column;
}
inline constexpr std::uint64_t kGroundShapeKey = ~std::uint64_t{0};
std::vector<std::byte> packGroundTile(const GroundTile& tile);
Result<GroundTile> unpackGroundTile(std::span<const std::byte> blob);
std::vector<std::byte> packGroundShape(const GroundShape& shape);
Result<GroundShape> unpackGroundShape(std::span<const std::byte> blob);

/// Texels of a tile inside its level; the rest of it repeats the last of them.
struct GroundTileSize {
  std::uint32_t columns = 0, rows = 0;
};
GroundTileSize sizeOfGroundTile(const GroundShape::Level& level, std::uint32_t column, std::uint32_t row);
void padGroundTile(GroundTile& tile, GroundTileSize size);

/// The tile above four, from the south-west one on, null where there is none. Colours are averaged in linear
/// light, normals as vectors.
GroundTile halvedGround(const std::array<const GroundTile*, 4>& below, GroundTileSize size);

}  // namespace trimtab::terrain
