#pragma once

#include <cstdint>
#include <filesystem>

#include "trimtab/terrain/grid/progress.h"

namespace trimtab::terrain {

struct CountryOptions {
  std::uint32_t seed = 1;
  std::uint32_t columns = 13000, rows = 11000;
  double postM = 30;
  Progress progress;
};
/// Rough land with mountains, plains and sea of a country's size, as a tiled GeoTIFF, band by band: to try
/// large terrain with. Cheap rather than true: no rivers run in it, as they do in the sample's.
Result<Done> writeCountry(const std::filesystem::path& tif, const CountryOptions& options);

}  // namespace trimtab::terrain
