#pragma once

#include <filesystem>

#include "trimtab/terrain/elevation/georeference.h"

namespace trimtab::terrain {

/// Reports what is wrong with a DTED file as a series of profiles (MIL-PRF-89020B): profiles that are
/// missing, which is an error at the end of the file (it was cut) and a warning elsewhere, and profiles that
/// do not agree with their checksums, which is an error unless `ignoreChecksums` (then a warning). Reads the
/// file once. Returns nothing about rasters of other formats.
Findings dtedFaults(const PlacedRaster& raster, const std::filesystem::path& file, bool ignoreChecksums);

}  // namespace trimtab::terrain
