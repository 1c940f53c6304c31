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
/// Writes terrain of a country's size, with mountains, plains and sea, as a tiled GeoTIFF, for tests of large
/// terrain. Works band by band. Unlike the sample's terrain it has no rivers, because they need the whole
/// grid.
Result<Done> writeCountry(const std::filesystem::path& tif, const CountryOptions& options);

}  // namespace trimtab::terrain
