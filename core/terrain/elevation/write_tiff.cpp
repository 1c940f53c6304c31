#include "trimtab/terrain/elevation/write_tiff.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <vector>

#include "trimtab/preset/unfinished.h"
#include "trimtab/terrain/elevation/georeference.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kTile = 256;

/// Describes a raster to be written.
struct Shape {
  int width = 0, height = 0, bands = 1;
  GDALDataType type = GDT_Float32;
  std::vector<const char*> options{"TILED=YES", "BIGTIFF=IF_SAFER"};
};

Dataset created(const fs::path& tif, Shape shape, std::array<double, 6> corner) {
  shape.options.push_back(nullptr);
  Dataset data = owned(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      tif.c_str(), shape.width, shape.height, shape.bands, shape.type,
      const_cast<char**>(shape.options.data())));
  if (!data) return data;
  OGRSpatialReference crs;
  crs.importFromEPSG(4326);
  data->SetGeoTransform(corner.data());
  data->SetSpatialRef(&crs);
  return data;
}

/// Writes a raster that `fill` gives some rows of at a time, its bands interleaved by pixel, after `prepare`.
template <class T>
Result<Done> write(const fs::path& tif, const Shape& shape, const std::array<double, 6>& corner,
                   const std::function<void(GDALDataset&)>& prepare,
                   const std::function<bool(std::uint32_t, std::uint32_t, std::span<T>)>& fill) {
  useGdal();
  GdalErrors errors;
  auto unfinished = Unfinished::file(tif);
  if (!unfinished) return unfinished.findings();
  const auto failed = [&](const std::string& otherwise) {
    return about(Severity::error, tif, "", "a GeoTIFF to be written", errors.last(otherwise));
  };
  {
    const Dataset data = created(unfinished->path(), shape, corner);
    if (!data) return failed("GDAL gives no reason");
    prepare(*data);
    const auto rows = static_cast<std::uint32_t>(shape.height);
    const std::size_t across = static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(shape.bands);
    const auto pixel = static_cast<GSpacing>(sizeof(T)) * shape.bands;
    std::vector<T> values(across * std::min(kTile, rows));
    for (std::uint32_t first = 0; first < rows; first += kTile) {
      const std::uint32_t some = std::min(kTile, rows - first);
      if (!fill(first, some, std::span(values).first(across * some))) return cancelled(tif.string());
      const int count = static_cast<int>(some);
      if (data->RasterIO(GF_Write, 0, static_cast<int>(first), shape.width, count, values.data(), shape.width,
                         count, shape.type, shape.bands, nullptr, pixel, pixel * shape.width,
                         static_cast<GSpacing>(sizeof(T)), nullptr) != CE_None)
        return failed("GDAL gives no reason");
      // Full rows of tiles go to the file, not to the cache.
      data->FlushCache();
      if (errors.any()) return failed("GDAL gives no reason");
    }
  }
  // Buffered tiles, and the table of tiles, are only written when the dataset closes.
  if (errors.any()) return failed("GDAL gives no reason");
  if (auto done = unfinished->putInPlace(); !done) return done;
  return {Done{}, unfinished.findings()};
}

}  // namespace

Result<Done> writeTiff(const fs::path& tif, const PostGrid& posts, const TiffRows& rows) {
  const std::array<double, 6> corner{
      posts.longitude(-0.5), posts.stepLongitude, 0, posts.latitude(posts.rows - 0.5), 0,
      -posts.stepLatitude};
  const auto areHeights = [](GDALDataset& data) {
    data.SetMetadataItem(GDALMD_AREA_OR_POINT, GDALMD_AOP_POINT);
    data.GetRasterBand(1)->SetUnitType("m");
  };
  return write<float>(tif, {static_cast<int>(posts.columns), static_cast<int>(posts.rows)}, corner,
                      areHeights, rows);
}

Result<Done> writePicture(const fs::path& tif, const PostGrid& pixels, const TiffPixels& rows) {
  const std::array<double, 6> corner{
      pixels.longitude(-0.5), pixels.stepLongitude, 0, pixels.latitude(pixels.rows - 0.5), 0,
      -pixels.stepLatitude};
  const Shape shape{static_cast<int>(pixels.columns),
                    static_cast<int>(pixels.rows),
                    3,
                    GDT_Byte,
                    {"TILED=YES", "BIGTIFF=IF_SAFER", "COMPRESS=JPEG", "JPEG_QUALITY=90", "PHOTOMETRIC=YCBCR",
                     "INTERLEAVE=PIXEL"}};
  return write<std::uint8_t>(
      tif, shape, corner, [](GDALDataset&) {}, rows);
}

}  // namespace trimtab::terrain
