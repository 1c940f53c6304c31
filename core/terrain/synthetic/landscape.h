#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace trimtab::terrain {

/// A square of ground, heights in metres, rows from south; 0 is the sea.
struct Landscape {
  std::uint32_t side = 0;
  double cellM = 0;
  std::vector<float> heights;
  std::vector<float> drainedM2;  ///< ground that drains through a cell
};

struct LandscapeShape {
  std::uint32_t side = 0;
  double cellM = 0;
  std::uint32_t seed = 1;
};

/// Uplift against rivers: two ranges, a basin in the middle, a coast in the east; every cell drains to the
/// sea. The heights are those of the process, not yet of any country. Empty when `carryOn` says no.
Landscape erodedLandscape(const LandscapeShape& shape, const std::function<bool(double)>& carryOn);

/// Cuts through whatever keeps a cell from draining to the sea, and finds anew what drains where.
void carveHollows(Landscape& land);

/// -1..1, smooth, from a seed: sum of octaves, each twice as fine and half as high.
double fractalNoise(double x, double y, int octaves, std::uint32_t seed);

}  // namespace trimtab::terrain
