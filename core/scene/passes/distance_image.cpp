#include "trimtab/scene/distance_image.h"

#include <algorithm>
#include <cmath>

namespace trimtab::scene {

DistanceImage distanceImage(std::span<const float> depths, int width, int height, double nearM) {
  DistanceImage image{width, height, std::vector<std::uint8_t>(depths.size(), 255)};
  // Grey follows the logarithm of the distance, so that one step is the same ratio near and far.
  constexpr double kFrom = DistanceImage::kNearestM, kTo = DistanceImage::kFarthestM;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (!(depths[i] > 0)) continue;
    const double distance = std::clamp(nearM / double{depths[i]}, kFrom, kTo);
    image.pixels[i] =
        static_cast<std::uint8_t>(std::lround(254 * std::log(distance / kFrom) / std::log(kTo / kFrom)));
  }
  return image;
}

}  // namespace trimtab::scene
