#include <cpl_error.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <memory>
#include <set>

#include "trimtab/terrain/cdb/catalogue.h"
#include "trimtab/units/finding_list.h"

namespace trimtab::terrain {

namespace fs = std::filesystem;

namespace {

/// Says what is wrong with a tile's raster; empty if nothing is.
std::string faultOf(const CdbFile& tile) {
  CPLPushErrorHandler(CPLQuietErrorHandler);
  CPLErrorReset();
  const std::unique_ptr<GDALDataset, void (*)(GDALDataset*)> data(
      GDALDataset::Open(tile.file.c_str(), GDAL_OF_RASTER), [](GDALDataset* d) { GDALClose(d); });
  const std::string why = CPLGetLastErrorMsg();
  CPLPopErrorHandler();
  if (!data) return why.empty() ? "something that GDAL cannot read" : why;
  if (data->GetRasterCount() < 1) return "a raster without a band";
  if (data->GetRasterXSize() == tile.tile.side() && data->GetRasterYSize() == tile.tile.side()) return {};
  return std::to_string(data->GetRasterXSize()) + " x " + std::to_string(data->GetRasterYSize());
}

/// Tells which places are filled by tiles, one level after the other from the finest.
class Filled {
 public:
  void add(const CdbTile& tile) { filled_.insert(tile); }
  bool has(const CdbTile& tile) const { return filled_.contains(tile); }

  /// Adds the tiles of one level coarser whose place is filled altogether.
  void rise(int level) {
    std::set<CdbTile> coarser;
    for (const CdbTile& tile : filled_)
      if (tile.level == level && isFilled(tile.parent())) coarser.insert(tile.parent());
    filled_.insert(coarser.begin(), coarser.end());
  }

 private:
  bool isFilled(const CdbTile& parent) const {
    CdbTile child = parent;
    ++child.level;
    if (parent.level < 0) return filled_.contains(child);
    for (int up = 0; up < 2; ++up)
      for (int right = 0; right < 2; ++right) {
        child.up = 2 * parent.up + up;
        child.right = 2 * parent.right + right;
        if (!filled_.contains(child)) return false;
      }
    return true;
  }

  std::set<CdbTile> filled_;
};

}  // namespace

Result<std::vector<fs::path>> cdbRasters(const CdbCatalogue& cdb, int set) {
  // Two posts a side are the least that has a distance between posts.
  constexpr int kCoarsestUsed = -9;
  constexpr std::array<std::string_view, 3> kHeights{".tif", ".tiff", ".img"},
      kImages{".jp2", ".tif", ".jpg"};
  GDALAllRegister();
  FindingList findings;
  Filled filled;
  std::vector<fs::path> files;
  const auto tiles = cdb.tiles(set, 1, 1, set == CdbSet::kElevation ? kHeights : kImages);
  for (int level = CdbTile::kFinest; level >= kCoarsestUsed; --level) {
    for (const CdbFile* const tile : tiles) {
      if (tile->tile.level != level || filled.has(tile->tile)) continue;
      if (const std::string fault = faultOf(*tile); !fault.empty()) {
        findings.add({Severity::warning, tile->file.string(), "",
                      "a raster of " + std::to_string(tile->tile.side()) + " x " +
                          std::to_string(tile->tile.side()) + ", as " + tile->tile.levelName() + " has",
                      fault + "; left out"});
        continue;
      }
      files.push_back(tile->file);
      filled.add(tile->tile);
    }
    if (level > CdbTile::kCoarsest) filled.rise(level);
  }
  return Result<std::vector<fs::path>>(std::move(files), findings.all(cdb.root.string()));
}

}  // namespace trimtab::terrain
