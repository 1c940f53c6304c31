#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "delimited_text.h"
#include "log_columns.h"

/// The quantities of a flight, and the columns of a table that hold them.
namespace trimtab {

enum FlightQuantity : std::size_t {
  kTime,
  kLatitude,
  kLongitude,
  kAltitudeFt,
  kHeightM,
  kPitch,
  kRoll,
  kHeading,
  kPacket,
  kHeadHeading,
  kHeadPitch,
  kHeadRoll,
  kAboveGround,
  kVisibility,
  kPrecipitation,
  kSeverity,
  kLayerVisibility,
  kWindSpeed,
  kWindFrom,
  kWindUp,
  kViewNear,
  kViewLeft,
  kViewRight,
  kViewBottom,
  kViewTop,
  kFlightQuantities
};

struct FlightQuantityRow {
  const char* name;
  double lowest, highest;
  bool required;
};
const FlightQuantityRow& flightQuantity(FlightQuantity quantity);

struct FlightColumns {
  std::array<std::optional<LogColumn>, kFlightQuantities> at;
  std::string profile;  ///< whose columns they are; empty if their names say so themselves

  bool has(FlightQuantity quantity) const { return at[quantity].has_value(); }
  /// Reports whether the attitude has to come from the track: no column holds a pitch or a roll.
  bool attitudeFromTrack() const { return !has(kPitch) && !has(kRoll); }
};

/// Receives key, what was expected and what was found.
using Refuse = std::function<void(std::string, std::string, std::string)>;

/// Finds the columns of a flight: those that the map names, else those of a known profile, else those with
/// our names, else with names that others use. Refuses whatever is missing or stands twice, and says then how
/// the table begins.
FlightColumns flightColumns(const DelimitedText& table, const ColumnMap& map, const Refuse& refuse);

}  // namespace trimtab
