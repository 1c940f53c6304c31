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

/// Rasters and where they are. GDAL's types: for the importing .cpp files of this folder only.
namespace trimtab::terrain {

using Dataset = std::unique_ptr<GDALDataset, void (*)(GDALDataset*)>;
Dataset owned(GDALDataset* dataset);

struct PlacedRaster {
  Dataset data;
  std::array<double, 6> transform{};  ///< GDAL's: pixel corners to the CRS
  OGRSpatialReference crs;            ///< horizontal; axes as easting, northing or longitude, latitude
};

/// What a raster is opened for: pictures are refused as heights.
enum class RasterKind { any, heights };
/// Opens a raster and finds out where it is; without a CRS, degrees are taken as WGS84, with a note.
Result<PlacedRaster> openRaster(const std::filesystem::path& file, GdalErrors& errors,
                                RasterKind kind = RasterKind::any);

/// The posts of a raster that is already geographic, upright and within some 2 m of WGS84; none when it must
/// be warped.
std::optional<PostGrid> geographicPosts(const PlacedRaster& raster);
/// Posts of the raster's own spacing inside its outline, or around it where it stands too far askew; none
/// where PROJ cannot place it.
std::optional<PostGrid> fittingPosts(const PlacedRaster& raster);

/// Longitude, then latitude.
OGRSpatialReference degreesOfWgs84();
/// How far the CRS goes for a turn of the earth. Of a cylinder where the raster goes on beyond its edge,
/// which shows as a place that comes back from degrees a turn away; 0 otherwise.
double turnOf(const PlacedRaster& raster);

/// The raster on a grid of posts, in memory; `more` are options of gdalwarp. Null where GDAL refuses.
Dataset warped(GDALDataset& data, const OGRSpatialReference& crs, const PostGrid& posts,
               std::vector<std::string> more);

Finding about(Severity severity, const std::filesystem::path& file, std::string key, std::string expected,
              std::string found);

}  // namespace trimtab::terrain
