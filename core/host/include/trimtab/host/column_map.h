#pragma once

#include <map>
#include <string>
#include <string_view>

#include "trimtab/units/result.h"

namespace trimtab {

/// Says from which column of a file a quantity is read: the cell's number, times `scale`, plus `offset`.
struct ColumnSource {
  std::string column;  ///< a name of the header, or "#3" for the third column
  double scale = 1, offset = 0;
  /// The whole of it as it was written: if a column has this very name, it is meant, without a scale.
  std::string written;
};

/// Where the quantities of a flight or of a head log are read from, by the names that they have in our own
/// files, as latitude_deg or head_pitch_deg.
using ColumnMap = std::map<std::string, ColumnSource, std::less<>>;

/// Parses "latitude_deg=Lat,altitude_ft=Alt*3.28084+10". A column whose name has a comma stands in quotes.
/// Findings name each part that is no assignment.
Result<ColumnMap> parseColumnMap(std::string_view text);

/// Reports whether a file was refused for its columns, so that a map may say what they are.
bool mapMayHelp(const Findings& findings);

}  // namespace trimtab
