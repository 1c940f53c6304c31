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
};
/// Writes the built-in default terrain as a GeoTIFF: mountains, valleys, rivers and a coast around 36.63 N
/// 128.35 E. The same options give the same bytes.
Result<Done> writeSample(const std::filesystem::path& tif, const SampleOptions& options);

}  // namespace trimtab::terrain
