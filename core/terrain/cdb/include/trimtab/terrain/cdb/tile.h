#pragma once

#include <optional>
#include <string>
#include <string_view>

/// Reads OGC CDB 1.x: names of tiles, what a folder holds, where features stand and which models they have.
namespace trimtab::terrain {

/// Numbers of data sets that are read.
struct CdbSet {
  static constexpr int kElevation = 1, kImagery = 4, kSpecificFeatures = 100, kTypicalFeatures = 101,
                       kSpecificModels = 300, kSpecificTextures = 301;
};

/// A rectangle of degrees.
struct CdbExtent {
  double west = 0, south = 0, width = 0, height = 0;

  bool holds(double longitude, double latitude) const {
    return longitude >= west && longitude < west + width && latitude >= south && latitude < south + height;
  }
};

/// What the name of a tile's file says: "N32W118_D001_S001_T001_L02_U3_R1".
struct CdbTile {
  int south = 0, west = 0;             ///< degrees of the cell's south-west corner
  int set = 0, first = 1, second = 1;  ///< numbers behind D, S and T
  int level = 0;                       ///< -10 (LC10) to 23
  int up = 0, right = 0;               ///< numbers behind U, from the south, and R, from the west

  static constexpr int kCoarsest = -10, kFinest = 23;

  /// Returns the name without an ending.
  std::string name() const;
  /// Returns "LC10" to "LC01" or "L00" to "L23".
  std::string levelName() const;
  CdbExtent extent() const;
  /// Returns the posts or pixels of a side: 1,024 from level 0 on, half of them for each coarser level.
  int side() const;
  /// Returns the tile one level coarser over the same place; `level` must not be the coarsest.
  CdbTile parent() const;
  /// Returns the same set's tile of another level that holds a place of this cell.
  CdbTile at(double longitude, double latitude, int otherLevel) const;

  friend auto operator<=>(const CdbTile&, const CdbTile&) = default;
};

/// A name and what follows it: "_AL015_000_harbor_club" of a model.
struct CdbName {
  CdbTile tile;
  std::string rest;
};
/// Reads the name of a file without its ending; letters may be of either case. Returns none if it is none of
/// a tile: another form, a place off the earth, a level that there is not, or a U or R beyond the level's.
std::optional<CdbName> cdbNameOf(std::string_view stem);

/// Returns the degrees of longitude of a cell by the latitude of its south side: 1 up to 50 degrees, then 2,
/// 3, 4, 6 and 12 (CDB volume 1, zones).
int cdbCellWidth(int south);

}  // namespace trimtab::terrain
