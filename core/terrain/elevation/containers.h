#pragma once

#include <gdal_priv.h>

#include <filesystem>
#include <string>
#include <vector>

#include "trimtab/terrain/elevation/files.h"
#include "trimtab/units/result.h"

/// Files that hold several rasters (netCDF, HDF, GeoPackage, CADRG): one of them is written `FILE:NAME`.
namespace trimtab::terrain {

/// One raster of a container.
struct ContainedRaster {
  std::string name;      ///< as it is written after `FILE:`
  std::string gdalName;  ///< as GDAL opens it
  std::string about;     ///< GDAL's description: size, name, type
};

/// Lists the rasters of an opened container; none if the file is a raster itself.
std::vector<ContainedRaster> rastersIn(GDALDataset& data, const std::filesystem::path& file);

/// Returns the name by which GDAL opens a path, which may be a `FILE:NAME`. Fails, with the list of rasters,
/// if the container has no raster of that name.
Result<std::string> gdalNameOf(const std::filesystem::path& path);

/// Returns the `FILE:NAME` of the one raster of a container that is elevation, with a note of what else there
/// is. Fails, with the list to choose from, if none stands out.
Result<std::filesystem::path> elevationIn(const std::filesystem::path& file,
                                          const std::vector<ContainedRaster>& rasters);

}  // namespace trimtab::terrain
