#pragma once

#include <ogrsf_frmts.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/core/terrain/elevation/rasters.h"
#include "trimtab/terrain/cdb/tile.h"

/// A CDB that tests write file by file. Where files go is written down here a second time, on purpose.
namespace trimtab::test {

namespace fs = std::filesystem;

struct MadeRow {
  std::optional<std::array<double, 3>> point;  ///< longitude, latitude, height
  std::map<std::string, std::string> values;
};

class MadeCdb {
 public:
  explicit MadeCdb(fs::path folder) : root(std::move(folder)) {}

  static std::string padded(int number, std::size_t digits) {
    const std::string text = std::to_string(std::abs(number));
    return std::string(digits - std::min(digits, text.size()), '0') + text;
  }
  static std::string cell(int south, int west) {
    return (south < 0 ? "S" : "N") + padded(south, 2) + (west < 0 ? "W" : "E") + padded(west, 3);
  }
  static std::string level(int number) { return (number < 0 ? "LC" : "L") + padded(number, 2); }
  static std::string nameOf(const terrain::CdbTile& t) {
    return cell(t.south, t.west) + "_D" + padded(t.set, 3) + "_S" + padded(t.first, 3) + "_T" +
           padded(t.second, 3) + '_' + level(t.level) + "_U" + std::to_string(t.up) + "_R" +
           std::to_string(t.right);
  }
  fs::path folderOf(const terrain::CdbTile& t) const {
    const std::string place = cell(t.south, t.west);
    const fs::path folder = root / "Tiles" / place.substr(0, 3) / place.substr(3) /
                            (padded(t.set, 3) + "_Any") / (t.level < 0 ? "LC" : level(t.level)) /
                            ("U" + std::to_string(t.up));
    fs::create_directories(folder);
    return folder;
  }
  fs::path fileOf(const terrain::CdbTile& t, const std::string& ending) const {
    return folderOf(t) / (nameOf(t) + ending);
  }

  /// Writes heights at the posts of a tile, columns from the west and rows from the south.
  fs::path heights(const terrain::CdbTile& t, const std::function<double(int, int)>& value,
                   std::function<void(RasterRecipe&)> otherwise = {}) const {
    const int side = t.level < 0 ? 1024 >> -t.level : 1024;
    const double height = 1.0 / (1 << std::max(0, t.level)), width = height * widthAt(t.south);
    RasterRecipe recipe;
    recipe.columns = recipe.rows = side;
    recipe.step = height / side;
    recipe.stepEast = width / side;
    recipe.west = t.west + t.right * width - *recipe.stepEast / 2;
    recipe.north = t.south + (t.up + 1) * height - recipe.step / 2;
    recipe.point = true;
    recipe.value = [value, side](int c, int r, int) { return value(c, side - 1 - r); };
    if (otherwise) otherwise(recipe);
    return writeRaster(fileOf(t, ".tif"), recipe);
  }

  /// Writes a table: a shape file if rows have points, else a .dbf alone.
  fs::path table(const terrain::CdbTile& t, const std::vector<std::string>& columns,
                 const std::vector<MadeRow>& rows, bool points) const {
    GDALAllRegister();
    const fs::path file = fileOf(t, points ? ".shp" : ".dbf");
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("ESRI Shapefile");
    GDALDataset* const data = driver->Create(file.c_str(), 0, 0, 0, GDT_Unknown, nullptr);
    OGRLayer* const layer =
        data->CreateLayer(nameOf(t).c_str(), nullptr, points ? wkbPoint25D : wkbNone, nullptr);
    for (const std::string& column : columns) {
      OGRFieldDefn field(column.c_str(), OFTString);
      field.SetWidth(60);
      EXPECT_EQ(layer->CreateField(&field), OGRERR_NONE);
    }
    for (const MadeRow& row : rows) {
      OGRFeature feature(layer->GetLayerDefn());
      for (const auto& [name, value] : row.values) feature.SetField(name.c_str(), value.c_str());
      if (row.point) {
        const OGRPoint point((*row.point)[0], (*row.point)[1], (*row.point)[2]);
        feature.SetGeometry(&point);
      }
      EXPECT_EQ(layer->CreateFeature(&feature), OGRERR_NONE);
    }
    GDALClose(data);
    return file;
  }

  /// Puts files into an archive.
  static void zip(const fs::path& archive, const std::map<std::string, std::string>& files) {
    const std::string name = "/vsizip/" + archive.string();
    VSILFILE* const keepOpen = VSIFOpenL(name.c_str(), "wb");
    for (const auto& [inside, bytes] : files) {
      VSILFILE* const out = VSIFOpenL((name + '/' + inside).c_str(), "wb");
      ASSERT_NE(out, nullptr) << inside;
      VSIFWriteL(bytes.data(), 1, bytes.size(), out);
      VSIFCloseL(out);
    }
    VSIFCloseL(keepOpen);
  }

  static int widthAt(int south) {
    // CDB volume 1: the zones' limits are 50, 70, 75, 80 and 89 degrees.
    const int from = south < 0 ? -south - 1 : south;
    return from < 50 ? 1 : from < 70 ? 2 : from < 75 ? 3 : from < 80 ? 4 : from < 89 ? 6 : 12;
  }

  fs::path root;
};

}  // namespace trimtab::test
