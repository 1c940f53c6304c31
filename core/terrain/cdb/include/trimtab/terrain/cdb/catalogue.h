#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/terrain/cdb/tile.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// Tells whether a folder is a CDB: it holds `Tiles` with a folder of cells ("N32"), or is such a `Tiles`
/// itself; or a folder right inside it does, and it has no files of its own but texts.
bool isCdb(const std::filesystem::path& folder);

/// A file of a tile.
struct CdbFile {
  CdbTile tile;
  std::string rest;    ///< of the name behind the tile
  std::string ending;  ///< in lower case, with its dot
  std::filesystem::path file;
};

/// What a CDB holds, by the names of its files; none was opened.
struct CdbCatalogue {
  std::filesystem::path root;                   ///< the folder that holds Tiles
  std::vector<std::filesystem::path> versions;  ///< roots, an earlier one replaces what later ones hold
  /// Files of tiles, sorted by tile; where several versions have one, the first's.
  std::vector<CdbFile> files;

  /// Returns the files of a set's tiles with one of these endings, of which an earlier one is preferred.
  std::vector<const CdbFile*> tiles(int set, int first, int second,
                                    std::span<const std::string_view> endings) const;
};

/// Lists a CDB. Its versions are those of `Metadata/Configuration.xml`, in the order of that list, else those
/// that `Metadata/Version.xml` names one after the other. Refuses a folder that isCdb() does not know, one
/// that holds several, and one without any file of a tile.
///
/// Findings of success name files that are left out: names of no tile, names that their folders contradict,
/// cells that stand across the zones' borders and so claim a place of others, versions that are not there.
Result<CdbCatalogue> openCdb(const std::filesystem::path& folder);

/// Returns the rasters of a set that show somewhere, finest first: not those whose place finer ones fill
/// altogether. A raster that cannot be opened, or has another size than its level, is left out with a
/// warning, and a coarser one shows there.
Result<std::vector<std::filesystem::path>> cdbRasters(const CdbCatalogue& cdb, int set);

}  // namespace trimtab::terrain
