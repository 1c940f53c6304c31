#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace trimtab::terrain {

/// A square of terrain: heights in metres, rows from south, 0 at the sea.
struct Landscape {
  std::uint32_t side = 0;
  double cellM = 0;
  std::vector<float> heights;
  std::vector<float> drainedM2;  ///< area that drains through a cell
};

struct LandscapeShape {
  std::uint32_t side = 0;
  double cellM = 0;
  std::uint32_t seed = 1;
};

/// Simulates uplift and river erosion: two ranges, a basin in the middle, a coast in the east; every cell
/// drains to the sea. The heights are not yet scaled to a real range. Returns no heights if `carryOn` returns
/// false.
Landscape erodedLandscape(const LandscapeShape& shape, const std::function<bool(double)>& carryOn);

/// Cuts outlets so that every cell drains to the sea, and recomputes the drained areas.
void carveHollows(Landscape& land);

/// Returns a number by chance for a place of a lattice, -1 to 1.
double latticeNoise(std::int32_t x, std::int32_t y, std::uint32_t seed);

/// Returns smooth noise, -1 to 1: a sum of octaves, each with half the wavelength and amplitude of the one
/// before.
double fractalNoise(double x, double y, int octaves, std::uint32_t seed);

}  // namespace trimtab::terrain
