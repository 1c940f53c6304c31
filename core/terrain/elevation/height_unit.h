#pragma once

#include <optional>

#include "trimtab/terrain/elevation/georeference.h"
#include "trimtab/terrain/elevation/height_unit.h"
#include "values.h"

namespace trimtab::terrain {

/// Returns the metres per unit of a raster's heights: what its band names, else its vertical CRS, else `told`
/// (what the user says that files without a unit are in), else metres. Refuses, with the option that tells
/// it, a name that is not known, two names that contradict each other, and no name where places are in feet
/// or another unit that is not metric, because heights may be in either. `vertical` is that of the raster.
/// Notes say where `told` was used or contradicts the file.
Result<double> heightUnitOf(const PlacedRaster& raster, const std::string& file, const Vertical& vertical,
                            std::optional<double> told);

}  // namespace trimtab::terrain
