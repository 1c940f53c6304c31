#pragma once

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trimtab/terrain/elevation/gdal_errors.h"
#include "trimtab/terrain/grid/post_grid.h"

/// Rasters and their georeferences. Uses GDAL's types: include this in .cpp files that import only.
namespace trimtab::terrain {

using Dataset = std::unique_ptr<GDALDataset, void (*)(GDALDataset*)>;
Dataset owned(GDALDataset* dataset);

struct PlacedRaster {
  Dataset data;
  /// GDAL's: pixel corners to the CRS. A CDB's tile stands where its name says, and `data` may say otherwise.
  std::array<double, 6> transform{};
  OGRSpatialReference crs;  ///< horizontal; axes as easting, northing or longitude, latitude
  /// Columns that are used, from the first; all, unless the raster goes more than once round the earth.
  int columns = 0;
  std::string name;  ///< by which GDAL opens it
};

/// Says what a raster is opened for; `heights` refuses images.
enum class RasterKind { any, heights };
/// Opens a raster and reads its georeference. If it names no CRS, degrees are assumed to be WGS84, with a
/// note. Ground control points are used if they lie on a plane map within a quarter of a pixel; otherwise
/// they are refused.
Result<PlacedRaster> openRaster(const std::filesystem::path& file, GdalErrors& errors,
                                RasterKind kind = RasterKind::any);

/// Returns the posts of a raster that is in degrees, north up and within some 2 m of WGS84; none if the
/// raster has to be warped.
std::optional<PostGrid> geographicPosts(const PlacedRaster& raster);
/// Returns posts with the raster's spacing that lie inside its outline, or around it if it is rotated too
/// far; none if PROJ cannot place it.
std::optional<PostGrid> fittingPosts(const PlacedRaster& raster);

/// Returns WGS84 in degrees, with the axes longitude, latitude.
OGRSpatialReference degreesOfWgs84();
/// Returns the extent of the CRS for one turn of the earth, in its units, if the CRS is cylindrical and the
/// raster extends beyond its edge, so that a place transformed to degrees and back is a turn away; otherwise
/// 0.
double turnOf(const PlacedRaster& raster);

/// Warps the raster onto a grid of posts, in memory; `more` has further options of gdalwarp. Returns null if
/// GDAL fails.
Dataset warped(GDALDataset& data, const OGRSpatialReference& crs, const PostGrid& posts,
               std::vector<std::string> more);

/// Makes a finding about a file.
Finding about(Severity severity, const std::filesystem::path& file, std::string key, std::string expected,
              std::string found);

}  // namespace trimtab::terrain
