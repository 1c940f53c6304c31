#pragma once

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/support.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"

/// Rasters that tests make for themselves.
namespace trimtab::test {

struct RasterRecipe {
  int columns = 65, rows = 65;
  double west = 10, north = 50, step = 0.001;  ///< of the first pixel's corner
  std::optional<double> stepEast;              ///< where that differs
  std::string crs = "EPSG:4326";               ///< empty: none
  GDALDataType type = GDT_Float32;
  std::optional<double> noData;
  std::string unit;
  std::optional<double> scale;
  bool point = false, southUp = false, placed = true;
  int bands = 1;
  /// Value at (column, row, band), rows from the north.
  std::function<double(int, int, int)> value = [](int, int, int) { return 100.0; };
};

/// Imagery of many colours.
inline RasterRecipe anyColours(int columns, int rows) {
  RasterRecipe picture;
  picture.columns = columns;
  picture.rows = rows;
  picture.bands = 3;
  picture.type = GDT_Byte;
  picture.value = [](int c, int r, int band) { return (c * 3 + r * 5 + band * 70) % 256; };
  return picture;
}

inline std::filesystem::path writeRaster(const std::filesystem::path& file, const RasterRecipe& recipe) {
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  GDALDataset* data =
      driver->Create(file.c_str(), recipe.columns, recipe.rows, recipe.bands, recipe.type, nullptr);
  if (recipe.placed) {
    const double sign = recipe.southUp ? 1 : -1;
    const double top = recipe.southUp ? recipe.north - recipe.rows * recipe.step : recipe.north;
    std::array<double, 6> corner{recipe.west,       recipe.stepEast.value_or(recipe.step), 0, top, 0,
                                 sign * recipe.step};
    data->SetGeoTransform(corner.data());
  }
  if (!recipe.crs.empty()) {
    OGRSpatialReference crs;
    crs.SetFromUserInput(recipe.crs.c_str());
    data->SetSpatialRef(&crs);
  }
  if (recipe.point) data->SetMetadataItem(GDALMD_AREA_OR_POINT, GDALMD_AOP_POINT);
  for (int b = 1; b <= recipe.bands; ++b) {
    GDALRasterBand* band = data->GetRasterBand(b);
    if (recipe.noData) band->SetNoDataValue(*recipe.noData);
    if (recipe.scale) band->SetScale(*recipe.scale);
    if (!recipe.unit.empty()) band->SetUnitType(recipe.unit.c_str());
    std::vector<double> line(static_cast<std::size_t>(recipe.columns));
    for (int r = 0; r < recipe.rows; ++r) {
      const int row = recipe.southUp ? recipe.rows - 1 - r : r;
      for (int c = 0; c < recipe.columns; ++c) line[static_cast<std::size_t>(c)] = recipe.value(c, row, b);
      if (band->RasterIO(GF_Write, 0, r, recipe.columns, 1, line.data(), recipe.columns, 1, GDT_Float64, 0, 0,
                         nullptr) != CE_None)
        std::abort();
    }
  }
  GDALClose(data);
  return file;
}

/// Ground that is different everywhere, and rough.
inline double roughGround(int column, int row) {
  std::uint32_t h =
      static_cast<std::uint32_t>(column) * 0x9e3779b1u ^ static_cast<std::uint32_t>(row) * 0x85ebca77u;
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h ^= h >> 13;
  return 800 + 500 * std::sin(column * 0.11) * std::cos(row * 0.07) + (h & 255) * 0.3;
}

/// A database of one raster, in a scratch folder.
inline Result<std::shared_ptr<const terrain::Database>> bakeInto(const ScratchDir& dir,
                                                                 const std::filesystem::path& source) {
  terrain::BakeOptions options;
  options.sources = {source};
  options.output = dir / "db";
  return terrain::bake(options);
}

}  // namespace trimtab::test
