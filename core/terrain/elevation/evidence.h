#pragma once

#include <gdal_priv.h>

#include <cstdint>
#include <optional>
#include <string>

/// Weighs what says that a raster holds elevation, and what says that it holds something else.
namespace trimtab::terrain {

/// Says which image a raster is, by its bands and colours; empty if it is none.
std::optional<std::string> imageIn(GDALDataset& data);

/// Statistics of a raster's possible heights, metres.
struct HeightShape {
  std::uint64_t heights = 0, steps = 0;  ///< steps: pairs of neighbours in a row
  double lowest = 0, highest = 0, deviation = 0;
  double step = 0;   ///< mean difference of neighbours
  double turns = 0;  ///< share of steps of more than half a circle, 180
};

/// Points for elevation (above 0) and against it. What is declared counts more than what the numbers look
/// like, and names of files count least.
struct Evidence {
  int declared = 0, numbers = 0;
  std::string against;  ///< reasons, joined
  std::string form;     ///< equal for files of one set: driver, type, bands and unit

  int score() const { return declared + numbers; }
  /// A raster with so few points is something else.
  bool isOther() const { return score() <= kOther; }
  static constexpr int kOther = -2;
};

/// Weighs driver, bands, type, unit, descriptions and the name of the file or of the raster in it.
Evidence declaredBy(GDALDataset& data, const std::string& name);
/// Adds what the numbers look like. `whole`: the raster's type has no fractions.
void weighNumbers(Evidence& evidence, const HeightShape& shape, bool whole);

}  // namespace trimtab::terrain
