#pragma once

#include <memory>
#include <optional>

#include "trimtab/terrain/elevation/source.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/scenery/blend.h"
#include "trimtab/terrain/scenery/catalogue.h"
#include "trimtab/terrain/scenery/raster.h"
#include "trimtab/terrain/scenery/sea.h"

namespace trimtab::terrain {

/// Returns a grid of posts from the south-west to the north-east corner of what the triangles cover, both
/// included. Without a distance the posts are 30 m apart, or up to 60 m if that keeps the grid at about six
/// million posts.
Result<PostGrid> sceneryPosts(const SceneryCatalogue& scenery, std::optional<Metres> distance);
/// Returns a grid of posts over a rectangle in degrees, its corners included. Without a distance as above.
Result<PostGrid> postsOver(const Rectangle& degrees, std::optional<Metres> distance);

/// Scenery as a source of heights by rows (SceneryRaster). Its memory follows that of the catalogue, not the
/// size of the land. Posts in no tile's rectangle are open sea at 0 m if tiles around them are at sea level
/// (OpenSea), with a note; the others are `beyond`. With elevation, posts that no triangle covers have its
/// heights (BlendedRows).
class SceneryHeights final : public ElevationSource {
 public:
  /// Reads all rows once to find open sea, unless tiles reach every post. The catalogue must outlive the
  /// result.
  static Result<std::unique_ptr<SceneryHeights>> open(const SceneryCatalogue& scenery, const PostGrid& posts,
                                                      const Progress& progress,
                                                      std::unique_ptr<ElevationSource> elevation = nullptr);

  const PostGrid& posts() const override { return raster_.posts(); }
  Result<Done> readRows(std::uint32_t first, std::uint32_t rows, std::span<float> heights,
                        std::span<std::uint8_t> beyond = {}, std::span<std::uint16_t> from = {}) override;
  std::vector<std::string> names() const override { return {}; }
  std::vector<std::uint64_t> given() const override { return {}; }
  /// Returns the colours of all posts, RGBA. Alpha is 0 where there is no scenery: elevation has no colours.
  Result<std::vector<std::uint8_t>> image(const Progress& progress) const;

 private:
  SceneryHeights(const SceneryCatalogue& scenery, const PostGrid& posts,
                 std::unique_ptr<ElevationSource> elevation)
      : raster_(scenery, posts) {
    if (elevation) blended_.emplace(raster_, std::move(elevation));
  }
  Result<Done> findSea(const Progress& progress);
  Result<Done> readSources(std::uint32_t first, std::uint32_t rows, std::span<float> heights,
                           std::span<std::uint8_t> reached);

  SceneryRaster raster_;
  std::optional<BlendedRows> blended_;
  std::optional<OpenSea> sea_;  ///< empty if tiles reach every post
  std::vector<std::uint8_t> reached_;
};

/// Counts what the files of some scenery hold.
SceneryCounts countsOf(const Scenery& scenery);

}  // namespace trimtab::terrain
