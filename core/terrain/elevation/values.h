#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "trimtab/terrain/elevation/georeference.h"

/// Converts the numbers of a raster to metres above the EGM96 geoid.
namespace trimtab::terrain {

/// Tells whether a raster is an image rather than heights.
bool looksLikeImage(GDALDataset& data);

/// Numbers that mark voids in files whose band names no no-data value.
inline constexpr std::array<float, 4> kVoidNumbers = {-32768, -32767, -9999, 32767};

struct Values {
  std::optional<double> noData;
  double scale = 1, offset = 0;  ///< metres = value * scale + offset
  /// Which of kVoidNumbers are voids in this file.
  std::array<bool, kVoidNumbers.size()> isVoid{};
  /// Voids without a tag were found: whatever lies under 500 m below the sea is taken for one too (the lowest
  /// shore is at -430 m, and resampling makes mixtures). Without such voids these depths are a sea floor.
  bool deepIsVoid = false;
};

/// Reads the band's tags. `unit`: metres per unit of its heights.
Values valuesOf(GDALRasterBand& band, double unit);

/// Statistics of all numbers of a file, from which its void numbers are recognised.
class Census {
 public:
  void add(std::span<const float> raw, const Values& values);
  /// Counts the posts of a block that the file does not store; it reads as the no-data value, or as 0.
  void leaveOut(std::uint64_t count, const Values& values) {
    posts_ += count, voids_ += values.noData ? count : 0;
  }
  /// Says what means a void in the file. Where the band names its no-data value, any other height that can be
  /// on earth is a height. Where it names none, so is one of kVoidNumbers if as many posts or more come
  /// within a tenth of it or go further: -9999 in a deep sea, 32767 of mountains in centimetres.
  void judge(Values& values) const;
  /// Heights, and voids that have no tag, as `judge` said.
  std::uint64_t heights(const Values& values) const { return posts_ - voids_ - untagged(values); }
  std::uint64_t untagged(const Values& values) const;

 private:
  struct Number {
    std::uint64_t posts = 0, like = 0;  ///< like: other possible heights within a tenth, or beyond
  };
  std::uint64_t posts_ = 0, voids_ = 0;  ///< voids: those with a tag
  std::array<Number, kVoidNumbers.size()> numbers_{};
  std::uint64_t deep_ = 0;        ///< under 500 m below the sea, but for the numbers
  std::uint64_t impossible_ = 0;  ///< once in metres, but for the numbers
  std::uint64_t absurd_ = 0;      ///< of these, what no mistake in a height makes
};

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
