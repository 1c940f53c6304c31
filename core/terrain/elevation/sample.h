#pragma once

#include <cstdint>
#include <span>

/// Heights between the posts of a raster.
namespace trimtab::terrain {

/// Part of a raster in memory: metres, NaN for voids.
struct RasterWindow {
  std::int64_t column = 0, row = 0, columns = 0, rows = 0;  ///< where it lies in the raster
  std::span<const float> heights;
};

/// At (x, y), counted in the raster's posts: the height there, to the bit, where that is a post; cubic (Keys)
/// between posts, with what is missing about a void or a border continued from the other side; NaN where one
/// of the nearest four that counts is a void. It is never lower or higher than the up to 16 posts that it is
/// made from, so that a cliff casts no trench into the sea. Water stays level: four equal posts have nothing
/// else between them. Up to a post beyond the raster (`across` x `down` posts) straight on; NaN further away,
/// and where x or y is no number. The window must hold the 4 x 4 posts about the place, as far as the raster
/// has them.
float heightBetween(const RasterWindow& window, std::int64_t across, std::int64_t down, double x, double y);

/// A mean of posts that come in several windows, by rows.
class PostMean {
 public:
  /// Those of the window's posts that lie within `width` x `height` posts about (x, y).
  void add(const RasterWindow& window, double x, double y, double width, double height);
  /// NaN where most are voids, or none is there.
  float mean() const;

 private:
  double sum_ = 0;
  std::int64_t heights_ = 0, posts_ = 0;
};

/// Returns the mean of the window's posts within `width` x `height` posts about (x, y); NaN where most are
/// voids, or none is there.
float meanAbout(const RasterWindow& window, double x, double y, double width, double height);

/// Across: means of the rows' posts within `size` posts about x, cubic along y as heightBetween is. Not
/// across: means of the columns' posts about y, cubic along x. For a raster that is finer than what is asked
/// for on one axis alone. The window must hold the four rows, or columns, about the place.
float meanAlong(const RasterWindow& window, bool across, std::int64_t columns, std::int64_t rows, double x,
                double y, double size);

}  // namespace trimtab::terrain
