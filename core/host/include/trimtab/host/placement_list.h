#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/units/quantity.h"
#include "trimtab/units/result.h"

namespace trimtab {

/// Where an object stands, WGS 84, and the line that says so, from 1.
struct ListedPlacement {
  Degrees latitude, longitude;
  std::optional<Metres> height;  ///< of its origin above mean sea level; unset: on the ground
  Degrees heading;               ///< true, clockwise from north
  double scale = 1;
  std::uint32_t model = 0;  ///< its number in PlacementList::models
  std::uint32_t line = 0;
  Metres aboveGround{};  ///< how much higher than the ground it stands, if `height` is unset
};

/// A text or table from which placements were read.
struct PlacementTable {
  std::string where;
  std::size_t first = 0;  ///< its first placement; those of the next table follow
};

struct PlacementList {
  std::vector<std::string> models;  ///< as the text names them, in the order of their first rows
  std::vector<ListedPlacement> placements;
  /// In the order of their placements; empty: one, which the caller names.
  std::vector<PlacementTable> tables{};

  /// Names a placement for findings, "TABLE:LINE"; `otherwise` is the table if the list names none.
  std::string placeOf(std::size_t placement, const std::string& otherwise) const;
};

/// What a name of a list stands for: the file of a model, and how it is changed before it is placed.
struct ModelFile {
  std::string file;                        ///< on disk, or "/vsizip/ARCHIVE/NAME"
  std::array<double, 3> stretch{1, 1, 1};  ///< along x, y and z, before the placement's own scale
  Degrees roll{}, pitch{};  ///< it is turned about x, then about y, anticlockwise seen against the axis
};

/// What a source of terrain brings to stand on it.
struct PlacedModels {
  PlacementList list;             ///< `models` has names that differ; each row names its table
  std::vector<ModelFile> models;  ///< one per name of the list
};

/// Limits of a row; the latitude and longitude are those of every place.
struct PlacementLimits {
  static constexpr double kHeightM = 20000;   ///< either way
  static constexpr double kHeadingDeg = 360;  ///< either way
  static constexpr double kLeastScale = 1e-3, kMostScale = 1e3;
};

/// Reads where objects stand from a delimited text with a header: `model`, `latitude_deg`, `longitude_deg`,
/// and if wanted `height_m` (or `height_ft`), `heading_deg` and `scale`. Without the column, or where the
/// cell is empty, an object stands on the ground, faces north and has scale 1. Other columns do not matter.
/// `where` names the text in findings.
///
/// A row that cannot be used is left out, with a warning that names its line and what is wrong; the first
/// FindingList::kMost of them, then their number. Refuses a table without the three columns, and one without
/// any row that can be used.
Result<PlacementList> readPlacementList(std::string_view text, const std::string& where);

}  // namespace trimtab
