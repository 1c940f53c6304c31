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

/// Posts from the south-west to the north-east corner of what the triangles cover, both included. Without a
/// distance: 30 m, and up to 60 m where that keeps the grid at about six million posts.
Result<PostGrid> sceneryPosts(const SceneryCatalogue& scenery, std::optional<Metres> distance);
/// Posts over a rectangle of degrees, its corners included; without a distance as above.
Result<PostGrid> postsOver(const Rectangle& degrees, std::optional<Metres> distance);

/// Rows of a SceneryRaster: memory follows the catalogue's, not the size of the land. What lies in no tile's
/// rectangle is open sea, at 0 m, where its borders are, with a note; the rest of it is `beyond`. With
/// elevation, where there is one, at the posts that no triangle covers (BlendedRows).
class SceneryHeights final : public ElevationSource {
 public:
  /// Looks through all rows for open sea where tiles leave any out. The catalogue must outlive it.
  static Result<std::unique_ptr<SceneryHeights>> open(const SceneryCatalogue& scenery, const PostGrid& posts,
                                                      const Progress& progress,
                                                      std::unique_ptr<ElevationSource> elevation = nullptr);

  const PostGrid& posts() const override { return raster_.posts(); }
  Result<Done> readRows(std::uint32_t first, std::uint32_t rows, std::span<float> heights,
                        std::span<std::uint8_t> beyond = {}) override;
  std::vector<std::string> names() const override { return {}; }
  std::vector<std::uint64_t> given() const override { return {}; }
  /// Colours of all posts, RGBA, alpha 0 where there are none: elevation has none.
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
  std::optional<OpenSea> sea_;  ///< none: tiles reach every post
  std::vector<std::uint8_t> reached_;
};

/// What the files of some scenery hold.
SceneryCounts countsOf(const Scenery& scenery);

}  // namespace trimtab::terrain
