#include "trimtab/terrain/grid/land_cover.h"

#include <algorithm>
#include <cmath>

namespace trimtab::terrain {

namespace {

struct Rgb {
  double r, g, b;
};

double smooth(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}
Rgb mix(Rgb a, Rgb b, double t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

double hash(std::uint32_t x, std::uint32_t y) {
  std::uint32_t h = x * 0x9e3779b1u ^ (y * 0x85ebca77u + 0x165667b1u);
  h ^= h >> 15;
  h *= 0x2c1b3c6du;
  h ^= h >> 12;
  return (h & 0xffff) / 65535.0;
}

/// -1..1, smooth over `size` posts.
double noise(std::uint32_t row, std::uint32_t column, std::uint32_t size) {
  const std::uint32_t y = row / size, x = column / size;
  const double v = static_cast<double>(row % size) / size, u = static_cast<double>(column % size) / size;
  const double south = hash(x, y) + (hash(x + 1, y) - hash(x, y)) * u;
  const double north = hash(x, y + 1) + (hash(x + 1, y + 1) - hash(x, y + 1)) * u;
  return 2 * (south + (north - south) * v) - 1;
}

/// Returns the height of lasting snow, metres: about 5,500 m in the subtropics, the sea at 75 degrees.
double snowLine(double latitudeDeg) {
  const double t = std::clamp((std::abs(latitudeDeg) - 22) / 53, 0.0, 1.0);
  return 5500 * (1 - t) * (1 - 0.15 * t);
}

}  // namespace

std::array<std::uint8_t, 3> landCover(double heightM, double slope, double latitudeDeg, std::uint32_t row,
                                      std::uint32_t column) {
  constexpr Rgb kWater{38, 78, 112}, kShore{176, 168, 132}, kField{134, 146, 88}, kMeadow{112, 132, 72},
      kForest{58, 88, 48}, kHeath{128, 122, 88}, kRock{124, 116, 106}, kSnow{238, 242, 246};
  if (heightM <= 0 && slope < 0.01) return {38, 78, 112};

  const double broad = noise(row, column, 12), fine = noise(row, column, 3);
  const double snow = snowLine(latitudeDeg), trees = 0.62 * snow;
  const double height = heightM + 0.06 * snow * broad + 0.02 * snow * fine;
  Rgb colour = mix(kField, kMeadow, 0.5 + 0.5 * fine);
  // Plains are farmed; slopes and hills are wooded.
  colour = mix(colour, kForest, smooth(0.05, 0.16, slope + 0.05 * broad + std::max(0.0, heightM) / 6000));
  colour = mix(colour, kHeath, smooth(trees - 0.08 * snow, trees + 0.04 * snow, height));
  colour = mix(colour, kRock, smooth(0.75, 1.15, slope + 0.12 * fine));
  colour = mix(colour, kRock, smooth(0.8 * snow, 0.97 * snow, height) * 0.8);
  colour = mix(colour, kSnow, smooth(snow, 1.08 * snow, height) * (1 - smooth(1.1, 1.8, slope)));
  colour = mix(kShore, colour, smooth(0.5, 4, heightM + 1.5 * fine));
  colour = mix(kWater, colour, smooth(-2, 0.5, heightM + 20 * slope));
  const double shade = 1 + 0.05 * fine + 0.04 * broad;
  const auto byte = [&](double v) { return static_cast<std::uint8_t>(std::clamp(v * shade, 0.0, 255.0)); };
  return {byte(colour.r), byte(colour.g), byte(colour.b)};
}

}  // namespace trimtab::terrain
