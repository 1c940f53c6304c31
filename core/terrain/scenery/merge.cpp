#include "trimtab/terrain/scenery/merge.h"

#include <algorithm>
#include <cmath>

#include "trimtab/terrain/scenery/import.h"

namespace trimtab::terrain {

namespace {

constexpr double kDegreeM = 111320;
constexpr double kMostPosts = 1e8;  ///< where no distance was given

Rectangle rectangleOf(const PostGrid& posts) {
  return {posts.west, posts.south, posts.longitude(posts.columns - 1), posts.latitude(posts.rows - 1)};
}

}  // namespace

Result<PostGrid> postsOfBoth(const SceneryCatalogue& scenery, const PostGrid& elevation,
                             std::optional<Metres> distance) {
  const auto own = sceneryPosts(scenery, distance);
  if (!own) return own;
  Rectangle a = rectangleOf(*own);
  const Rectangle b = rectangleOf(elevation);
  const double turn = 360 * std::round((a.west + a.east - b.west - b.east) / 720);
  a = {std::min(a.west, b.west + turn), std::min(a.south, b.south), std::max(a.east, b.east + turn),
       std::max(a.north, b.north)};
  if (!distance) {
    const double step = std::min(own->stepLatitude, elevation.stepLatitude);
    const double posts = (a.east - a.west) * (a.north - a.south) / (step * step);
    distance = Metres{std::max(1.0, kDegreeM * step * std::sqrt(std::max(1.0, posts / kMostPosts)))};
  }
  return postsOver(a, distance);
}

Rectangle elevationsPart(const PostGrid& both, const PostGrid& elevation) {
  Rectangle where = rectangleOf(elevation);
  const Rectangle whole = rectangleOf(both);
  where = where.turned(360 * std::round((whole.west + whole.east - where.west - where.east) / 720));
  return {std::max(where.west, whole.west), std::max(where.south, whole.south),
          std::min(where.east, whole.east), std::min(where.north, whole.north)};
}

}  // namespace trimtab::terrain
