#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace trimtab::scene {

/// A depth map as a grey image for people. The grey follows the logarithm of the distance along the view's
/// axis: 0 at kNearestM and nearer, 254 at kFarthestM and farther, and 255 where there is nothing. Without
/// pixels there was no map. Renderer::readDepthMap may fill it with a horizon instead.
struct DistanceImage {
  static constexpr double kNearestM = 50, kFarthestM = 200e3;
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  ///< one byte per pixel without gaps, the bottom row first
};

/// Makes the image from `width` times `height` depths, the bottom row first. A depth is `nearM`, the distance
/// of the near plane in metres, over the distance along the view's axis. A depth that is not above 0 is
/// nothing.
DistanceImage distanceImage(std::span<const float> depths, int width, int height, double nearM);

}  // namespace trimtab::scene
