#include "trimtab/terrain/elevation/write_tiff.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <vector>

#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/elevation/georeference.h"
#include "trimtab/terrain/elevation/import.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kTile = 256;

Dataset created(const fs::path& tif, const PostGrid& posts) {
  std::array<const char*, 3> options{"TILED=YES", "BIGTIFF=IF_SAFER", nullptr};
  Dataset data = owned(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      tif.c_str(), static_cast<int>(posts.columns), static_cast<int>(posts.rows), 1, GDT_Float32,
      const_cast<char**>(options.data())));
  if (!data) return data;
  std::array<double, 6> corner{
      posts.longitude(-0.5), posts.stepLongitude, 0, posts.latitude(posts.rows - 0.5), 0,
      -posts.stepLatitude};
  OGRSpatialReference crs;
  crs.importFromEPSG(4326);
  data->SetGeoTransform(corner.data());
  data->SetSpatialRef(&crs);
  data->SetMetadataItem(GDALMD_AREA_OR_POINT, GDALMD_AOP_POINT);
  data->GetRasterBand(1)->SetUnitType("m");
  return data;
}

}  // namespace

Result<Done> writeTiff(const fs::path& tif, const PostGrid& posts, const TiffRows& rows) {
  useGdal();
  GdalErrors errors;
  const fs::path unfinished =
      tif.parent_path() / ("." + tif.filename().string() + ".part-" + std::to_string(::getpid()));
  const auto gone = [&](Finding why) {
    std::error_code ignored;
    fs::remove(unfinished, ignored);
    return why;
  };
  const auto failed = [&](const std::string& otherwise) {
    return gone(about(Severity::error, tif, "", "a GeoTIFF to be written", errors.last(otherwise)));
  };
  {
    const Dataset data = created(unfinished, posts);
    if (!data) return failed("GDAL gives no reason");
    std::vector<float> heights(std::size_t{posts.columns} * std::min(kTile, posts.rows));
    const int columns = static_cast<int>(posts.columns);
    for (std::uint32_t first = 0; first < posts.rows; first += kTile) {
      const std::uint32_t some = std::min(kTile, posts.rows - first);
      if (!rows(first, some, std::span(heights).first(std::size_t{posts.columns} * some)))
        return gone(cancelled(tif.string()));
      const int count = static_cast<int>(some);
      if (data->GetRasterBand(1)->RasterIO(GF_Write, 0, static_cast<int>(first), columns, count,
                                           heights.data(), columns, count, GDT_Float32, 0, 0,
                                           nullptr) != CE_None)
        return failed("GDAL gives no reason");
      // Full rows of tiles go to the file, not to the cache.
      data->FlushCache();
      if (errors.any()) return failed("GDAL gives no reason");
    }
  }
  // What was buffered, and the table of tiles, is only written when the dataset closes.
  if (errors.any()) return failed("GDAL gives no reason");
  const auto done = putInPlace(unfinished, tif);
  return done ? done : gone(done.findings().front());
}

}  // namespace trimtab::terrain
