#include <algorithm>
#include <array>
#include <set>

#include "feature_table.h"
#include "trimtab/terrain/cdb/features.h"

namespace trimtab::terrain {

namespace {

/// Returns "LC02: 1, L01: 3" of tiles, coarsest first.
std::string levelsOf(const std::vector<const CdbFile*>& tiles) {
  std::map<int, std::size_t> count;
  for (const CdbFile* const tile : tiles) ++count[tile->tile.level];
  std::string text;
  for (const auto& [level, number] : count) {
    CdbTile tile;
    tile.level = level;
    text += (text.empty() ? "" : ", ") + tile.levelName() + ": " + std::to_string(number);
  }
  return text;
}

using Cells = std::set<std::pair<int, int>>;

Cells cellsOf(const std::vector<const CdbFile*>& tiles) {
  Cells cells;
  for (const CdbFile* const tile : tiles) cells.insert({tile->tile.south, tile->tile.west});
  return cells;
}

/// Returns the first eight names, and says how many more there are.
std::string someOf(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kMost) text += " and " + std::to_string(names.size() - kMost) + " more";
  return text;
}

/// Names the cells of some files that others do not have.
std::string withoutCells(const Cells& some, const Cells& others) {
  std::vector<std::string> names;
  for (const auto& [south, west] : some) {
    if (others.contains({south, west})) continue;
    CdbTile tile;
    tile.south = south;
    tile.west = west;
    names.push_back(tile.name().substr(0, 7));
  }
  return someOf(names);
}

/// Counts rows of lines and areas at their finest tables, for each data set; and what else there is.
std::map<int, std::array<std::size_t, 2>> linesAndAreas(const CdbCatalogue& cdb) {
  constexpr int kLines = 3, kAreas = 5;
  std::map<int, std::array<std::size_t, 2>> count;
  std::set<CdbTile> withRows;
  std::vector<std::pair<CdbTile, std::size_t>> tables;
  for (const CdbFile& file : cdb.files) {
    if (file.ending != ".shp" || (file.tile.second != kLines && file.tile.second != kAreas)) continue;
    const std::size_t rows = cdbRowsIn(file.file).value_or(0);
    tables.emplace_back(file.tile, rows);
    for (CdbTile tile = file.tile; rows > 0 && tile.level > CdbTile::kCoarsest;)
      withRows.insert(tile = tile.parent());
  }
  for (const auto& [tile, rows] : tables)
    if (!withRows.contains(tile)) count[tile.set][tile.second == kLines ? 0 : 1] += rows;
  return count;
}

}  // namespace

Findings aboutCdb(const CdbCatalogue& cdb, const CdbFeatures& features) {
  Findings notes;
  const auto say = [&](const std::string& key, const std::string& what, const std::string& found) {
    notes.push_back({Severity::note, cdb.root.string(), key, what, found});
  };
  constexpr std::array<std::string_view, 3> kHeights{".tif", ".tiff", ".img"},
      kImages{".jp2", ".tif", ".jpg"};
  const auto heights = cdb.tiles(CdbSet::kElevation, 1, 1, kHeights),
             images = cdb.tiles(CdbSet::kImagery, 1, 1, kImages);
  if (cdb.versions.size() > 1) {
    std::string names;
    for (const auto& version : cdb.versions) names += (names.empty() ? "" : ", ") + version.string();
    say("versions", "one, or several of which an earlier one replaces what later ones hold", names);
  }
  say("elevation", "tiles by level, LC10 coarsest", heights.empty() ? "none" : levelsOf(heights));
  say("imagery", "tiles by level", images.empty() ? "none" : levelsOf(images));
  if (const std::string gaps = withoutCells(cellsOf(images), cellsOf(heights)); !gaps.empty())
    say("gaps", "elevation in each cell that has imagery", "none in " + gaps);
  const std::size_t placed = features.list.placements.size();
  say("features", "point features with a model, placed",
      std::to_string(placed) + " by " + std::to_string(features.models.size()) + " models (" +
          std::to_string(features.specific) + " of one place, " + std::to_string(features.typical) +
          " of shared models); " + std::to_string(features.replaced) +
          " rows of coarser levels that finer ones replace");
  if (!features.withoutModel.empty()) {
    std::size_t count = 0;
    std::vector<std::string> names;
    for (const auto& [name, rows] : features.withoutModel) {
      count += rows;
      names.push_back(name);
    }
    say("models", "a model for each feature",
        "none for " + std::to_string(count) + " features, which are not drawn: " + someOf(names));
  }
  if (features.lights > 0)
    say("lights", "features that are drawn", std::to_string(features.lights) + " lights (100), not drawn");
  for (const auto& [set, count] : linesAndAreas(cdb))
    if (count[0] + count[1] > 0)
      say("lines and areas", "features that are drawn",
          std::to_string(count[0]) + " lines and " + std::to_string(count[1]) + " areas of data set " +
              std::to_string(set) + ", not drawn");
  return notes;
}

}  // namespace trimtab::terrain
