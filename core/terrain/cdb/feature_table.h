#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// A row of a table of features. It holds for the time of a call.
class CdbRow {
 public:
  std::uint32_t number = 0;  ///< from 1
  /// Longitude, latitude and height of the feature's point; none if it has none.
  std::optional<std::array<double, 3>> point;
  std::map<std::string, std::string> values;  ///< by the attribute's name in upper case; not the empty ones

  /// Returns an attribute's text; empty if the row has none.
  const std::string& text(const std::string& name) const;
};

/// Reads every row of a shape file or of a .dbf alone. Fails if GDAL cannot open or finish it; rows before
/// that were visited.
Result<Done> readCdbTable(const std::filesystem::path& file, const std::function<void(const CdbRow&)>& visit);

/// Counts the rows of a table by its header; none if it cannot be opened.
std::optional<std::size_t> cdbRowsIn(const std::filesystem::path& file);

}  // namespace trimtab::terrain
