#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/host/column_map.h"
#include "trimtab/units/result.h"

/// Finds the columns of a flight or of a head log by the names in its header.
namespace trimtab {

enum class Unit { none, degrees, radians, seconds, milliseconds, microseconds, nanoseconds, feet, metres };

/// A name of a header, understood: "Altitude ASL (ft)", "altitude-asl-ft" and "pose/altitude_asl_ft" are
/// altitude_asl in feet.
struct ColumnName {
  std::string base;
  Unit unit = Unit::none;

  friend bool operator==(const ColumnName&, const ColumnName&) = default;
};
ColumnName columnName(std::string_view text);

/// One column, and how its numbers become a quantity.
struct LogColumn {
  std::size_t place = 0;
  std::size_t part = 0;  ///< 1 and 2: which side of the comma inside the cell; 0: the whole cell
  std::string name;
  Unit unit = Unit::none;
  double scale = 1, offset = 0;

  /// Returns the cell of a row that fits the header.
  std::string_view cell(const std::vector<std::string_view>& cells) const;
  double quantity(double number) const {
    return scale == 1 && offset == 0 ? number : number * scale + offset;
  }
};

class LogColumns {
 public:
  explicit LogColumns(const std::vector<std::string>& header);

  /// Returns the first column that has one of the base names, in their order, in one of the units, in theirs.
  /// `twice` is set if two columns have that name.
  std::optional<LogColumn> find(std::span<const std::string_view> bases, std::span<const Unit> units,
                                bool& twice) const;
  /// Returns the column that a map names; nothing if there is none, or if two are named so.
  std::optional<LogColumn> find(const ColumnSource& source) const;

 private:
  std::optional<std::size_t> placeOf(std::string_view name, bool toTheLetter = false) const;

  const std::vector<std::string>& header_;
  std::vector<ColumnName> names_;
};

}  // namespace trimtab
