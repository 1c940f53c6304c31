#pragma once

#include <cstdint>
#include <filesystem>

#include "trimtab/terrain/grid/progress.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

struct LandPictureOptions {
  std::uint32_t seed = 1;
  double pixelM = 10;  ///< metres; the nearest whole part of the distance of posts is taken
  Progress progress;
};
/// Paints an image of the ground from elevation, to drape over it: sea, rivers, fields, roads, villages,
/// woods and rock. It stands in for aerial imagery of that resolution. `elevation` is one raster of WGS84
/// degrees, north up; heights of 0 and below, and voids, are sea. Rivers need the whole grid in memory and
/// are painted up to 4,096 posts a side. Works band by band otherwise. The same options give the same
/// picture.
Result<Done> writeLandPicture(const std::filesystem::path& elevation, const std::filesystem::path& tif,
                              const LandPictureOptions& options);

}  // namespace trimtab::terrain
