#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "trimtab/terrain/georeference.h"

/// What the numbers of a raster mean.
namespace trimtab::terrain {

/// Whether a raster is a picture and not heights.
bool looksLikeImage(GDALDataset& data);

struct Values {
  std::optional<double> noData;
  double scale = 1, offset = 0;  ///< metres = value * scale + offset
  /// Voids without a tag were found: whatever lies under 500 m below the sea is taken for one too (the lowest
  /// shore is at -430 m, and resampling makes mixtures). Without such voids these depths are a sea floor.
  bool deepIsVoid = false;
};

/// By the band's tags; `crsUnit`: metres a unit of the vertical CRS, for a band that names no unit.
Values valuesOf(GDALRasterBand& band, double crsUnit);

/// What a look through a file finds.
struct Census {
  std::uint64_t posts = 0, voids = 0;  ///< voids: those with a tag
  std::uint64_t untagged = 0;          ///< values that mean a void everywhere
  std::uint64_t deep = 0;              ///< under 500 m below the sea
  std::uint64_t impossible = 0;        ///< once in metres
  void add(std::span<const float> raw, const Values& values);
  /// Posts of a block that is not in the file: it reads as the no-data value, or as 0.
  void leaveOut(std::uint64_t count, const Values& values) {
    posts += count, voids += values.noData ? count : 0;
  }
};

/// Numbers to metres, voids to NaN.
void toMetres(std::span<float> raw, const Values& values);

/// How a file's heights are taken to heights above the EGM96 geoid, which is what files without a vertical
/// datum are taken to hold.
struct Vertical {
  double unit = 1;  ///< metres a unit of the vertical CRS
  /// From EGM96 to the file's; null where nothing is to be done, or nothing can be.
  std::shared_ptr<OGRCoordinateTransformation> toFile;
  std::optional<std::pair<std::string, std::string>> note;  ///< expected, found
};
Vertical verticalOf(const PlacedRaster& raster);

}  // namespace trimtab::terrain
