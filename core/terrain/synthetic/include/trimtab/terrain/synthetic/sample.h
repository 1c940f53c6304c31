#pragma once

#include <cstdint>
#include <filesystem>

#include "trimtab/terrain/grid/progress.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

struct SampleOptions {
  std::uint32_t seed = 1;
  double sizeKm = 100;
  double postM = 60;
  Progress progress;
  bool objects = false;  ///< also writes what stands on it
};
/// Returns where writeSample() lists what stands on a sample: NAME-objects.csv beside NAME.tif. Its models
/// are in the folder NAME-objects.
std::filesystem::path sampleObjects(const std::filesystem::path& tif);

/// Writes the built-in default terrain as a GeoTIFF: mountains, valleys, rivers and a coast around 36.63 N
/// 128.35 E. The same options give the same bytes.
///
/// With `objects`, writes some 200,000 places of woods, a town, an airfield and a line of pylons
/// (trimtab/host/placement_list.h), fewer on a square of less than 18 km, and their models before it.
Result<Done> writeSample(const std::filesystem::path& tif, const SampleOptions& options);

}  // namespace trimtab::terrain
