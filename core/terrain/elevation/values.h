#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "trimtab/terrain/elevation/georeference.h"

/// Converts the numbers of a raster to metres above the EGM96 geoid.
namespace trimtab::terrain {

/// Numbers that mark voids in many files, whatever the band names.
inline constexpr std::array<float, 4> kVoidNumbers = {-32768, -32767, -9999, 32767};

struct Values {
  std::optional<double> noData;
  double scale = 1, offset = 0;  ///< metres = value * scale + offset
  /// Numbers without a tag that are voids in this file.
  std::vector<float> voids;
  /// Metres; what lies deeper is a void too.
  float deepest = -std::numeric_limits<float>::infinity();
};

inline float metresOf(float raw, const Values& values) {
  return static_cast<float>(raw * values.scale + values.offset);
}
/// Tells whether a number is the band's no-data value, or no number.
inline bool isTagged(float raw, const Values& values) {
  return std::isnan(raw) || (values.noData && raw == static_cast<float>(*values.noData));
}
/// Deeper than any shore: the lowest is at -430 m.
inline bool isDeep(float metres) {
  return metres < -500;
}
inline bool isPossible(float metres) {
  return metres >= -11500 && metres <= 9500;
}
/// Tells whether a number is so far from any height that it means none.
inline bool isAbsurd(float metres) {
  return !(metres > -15000 && metres < 40000);
}

/// Reads the band's tags. `unit`: metres per unit of its heights.
Values valuesOf(GDALRasterBand& band, double unit);

/// Converts numbers to metres, and voids to NaN, in place.
void toMetres(std::span<float> raw, const Values& values);

/// Says how a file's heights are converted to heights above the EGM96 geoid. Files without a vertical datum
/// are assumed to have such heights already.
struct Vertical {
  std::optional<double> unit;  ///< metres per unit of the vertical CRS; none if the raster has no such CRS
  /// Transforms from EGM96 to the file's datum; null if no conversion is needed, or none is possible.
  std::shared_ptr<OGRCoordinateTransformation> toFile;
  std::optional<std::pair<std::string, std::string>> note;  ///< expected, found
  /// The same for places that PROJ cannot convert; their posts become voids.
  std::optional<std::pair<std::string, std::string>> lost;
};
Vertical verticalOf(const PlacedRaster& raster);

}  // namespace trimtab::terrain
