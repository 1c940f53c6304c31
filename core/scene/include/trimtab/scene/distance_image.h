#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace trimtab::scene {

/// A depth map as a grey image for people: black at kNearestM, nearly white at kFarthestM, by the logarithm
/// of the distance, and white where there is nothing. Row 0 is at the bottom. Without pixels there was no
/// map.
struct DistanceImage {
  static constexpr double kNearestM = 50, kFarthestM = 200e3;
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
};

/// Makes the image from depths (near plane / distance, row 0 at the bottom); `nearM` is the near plane.
DistanceImage distanceImage(std::span<const float> depths, int width, int height, double nearM);

}  // namespace trimtab::scene
