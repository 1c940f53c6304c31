#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "trimtab/terrain/elevation/georeference.h"

/// What the numbers of a raster mean.
namespace trimtab::terrain {

/// Whether a raster is a picture and not heights.
bool looksLikeImage(GDALDataset& data);

/// Numbers that stand for voids in files whose band names no number for them.
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

/// By the band's tags; `crsUnit`: metres a unit of the vertical CRS, for a band that names no unit.
Values valuesOf(GDALRasterBand& band, double crsUnit);

/// What a look through a file finds.
class Census {
 public:
  void add(std::span<const float> raw, const Values& values);
  /// Posts of a block that is not in the file: it reads as the no-data value, or as 0.
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

/// Numbers to metres, voids to NaN.
void toMetres(std::span<float> raw, const Values& values);

/// How a file's heights are taken to heights above the EGM96 geoid, which is what files without a vertical
/// datum are taken to hold.
struct Vertical {
  double unit = 1;  ///< metres a unit of the vertical CRS
  /// From EGM96 to the file's; null where nothing is to be done, or nothing can be.
  std::shared_ptr<OGRCoordinateTransformation> toFile;
  std::optional<std::pair<std::string, std::string>> note;  ///< expected, found
  /// The same of places in the raster for which PROJ has nothing, and which therefore have no height.
  std::optional<std::pair<std::string, std::string>> lost;
};
Vertical verticalOf(const PlacedRaster& raster);

}  // namespace trimtab::terrain
