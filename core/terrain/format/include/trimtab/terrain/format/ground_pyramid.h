#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/terrain/format/page_file.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/units/result.h"

/// Colours and normals of the ground as a pyramid of images, each with half the resolution of the one before,
/// in tiles. They do not depend on the LOD of the mesh, so that the ground looks the same when its mesh gets
/// coarser.
namespace trimtab::terrain {

/// A texel: sRGB, and the normal of the finest surface there (local frame, x and y x 127; z is up).
struct GroundTexel {
  std::uint8_t red, green, blue;
  std::uint8_t voids;  ///< the share of the texel that was a filled void; 255 is all of it
  std::int8_t normalX, normalY;
  friend bool operator==(const GroundTexel&, const GroundTexel&) = default;
};
static_assert(sizeof(GroundTexel) == 6);

/// The levels of a pyramid. Level 0 is the finest, with `texelsPerPost` texels (a power of two, which may be
/// less than 1) from a post to the next. Texel (c, r) of level 0 lies on post (c, r) / texelsPerPost, so an
/// image on the posts' own grid keeps every pixel; with less than one texel per post it is the mean of the
/// posts from there on. Each level has half the resolution of the previous one, down to a single tile: a
/// texel is the mean of two by two, where those past the border repeat the last one.
struct GroundShape {
  static constexpr std::uint32_t kTile = 256;  ///< texels per side
  struct Level {
    std::uint32_t columns = 0, rows = 0;  ///< texels
    std::uint32_t tileColumns() const { return (columns + kTile - 1) / kTile; }
    std::uint32_t tileRows() const { return (rows + kTile - 1) / kTile; }
    friend bool operator==(const Level&, const Level&) = default;
  };
  double texelsPerPost = 1;
  std::vector<Level> levels;

  /// Returns the place of a post among the texels of level 0, where texel c reaches from c to c + 1. For
  /// level l multiply by 2^-l.
  double texelOf(double post) const { return post * texelsPerPost + 0.5 * std::min(1.0, texelsPerPost); }
  friend bool operator==(const GroundShape&, const GroundShape&) = default;
};

/// Returns the pyramid's levels for a grid of posts.
GroundShape makeGroundShape(const PostGrid& posts, double texelsPerPost);

using GroundTile = std::vector<GroundTexel>;  ///< kTile x kTile, rows from south

class GroundPyramid {
 public:
  virtual ~GroundPyramid() = default;
  virtual const GroundShape& shape() const = 0;
  /// Reads a tile of kTile x kTile texels, rows from the south. Beyond the level's border the last row or
  /// column is repeated. It fails for a damaged tile, waits for the disk, and is safe on any thread.
  virtual Result<GroundTile> readTile(std::uint32_t level, std::uint32_t column, std::uint32_t row) const = 0;
};

/// Opens what buildGround wrote (trimtab/terrain/ground/build.h) for these posts.
Result<std::shared_ptr<const GroundPyramid>> openGround(const std::filesystem::path& file,
                                                        const PostGrid& posts);
/// Does the same from a page file that is open; `file` is its name for messages.
Result<std::shared_ptr<const GroundPyramid>> openGround(std::shared_ptr<const PageFile> pages,
                                                        const std::filesystem::path& file,
                                                        const PostGrid& posts);

/// Returns the key of a tile in the page file.
constexpr std::uint64_t groundKey(std::uint32_t level, std::uint32_t column, std::uint32_t row) {
  return (std::uint64_t{level} << 56) | (std::uint64_t{row} << 28) | column;
}
inline constexpr std::uint64_t kGroundShapeKey = ~std::uint64_t{0};
std::vector<std::byte> packGroundTile(const GroundTile& tile);
Result<GroundTile> unpackGroundTile(std::span<const std::byte> blob);
std::vector<std::byte> packGroundShape(const GroundShape& shape);
Result<GroundShape> unpackGroundShape(std::span<const std::byte> blob);

/// The texels of a tile that lie inside its level; the rest repeat the last row and column.
struct GroundTileSize {
  std::uint32_t columns = 0, rows = 0;
};
GroundTileSize sizeOfGroundTile(const GroundShape::Level& level, std::uint32_t column, std::uint32_t row);
void padGroundTile(GroundTile& tile, GroundTileSize size);

/// Makes the coarser tile above four tiles, given from the south-west on; a tile beyond the border is null.
/// Colours are averaged in linear light, normals as vectors.
GroundTile halvedGround(const std::array<const GroundTile*, 4>& below, GroundTileSize size);

}  // namespace trimtab::terrain
