#include "flight_columns.h"

#include <algorithm>
#include <array>

#include "column_advice.h"
#include "core/host/limits.h"
#include "foreign_file.h"
#include "profiles.h"
#include "trimtab/frame/frame.h"

namespace trimtab {
namespace {

constexpr double kAny = 1e15;
constexpr double kHalf = 89.9;  // half-angles of a view; a quarter turn has no picture plane
constexpr std::array<FlightQuantityRow, kFlightQuantities> kRows{{
    {"time_s", -kAny, kAny, false},
    {"latitude_deg", -90, 90, true},
    {"longitude_deg", -180, 180, true},
    {"altitude_ft", -66000, 3.3e6, true},
    {"height_m", limits::kLowest, limits::kHighest, false},
    {"pitch_deg", -90, 90, true},
    {"roll_deg", -360, 360, true},
    {"heading_deg", -360, 360, true},
    {"packet", 0, 9007199254740992.0, false},
    {"head_heading_deg", -360, 360, false},
    {"head_pitch_deg", -90, 90, false},
    {"head_roll_deg", -360, 360, false},
    {"above_ground_m", -limits::kHighest, limits::kHighest, false},
    {"visibility_m", 0, limits::kVisibility, false},
    {"precipitation", 0, 0, false},  // none, rain or snow
    {"precipitation_severity", 0, HostWeather::kMostSevere, false},
    {"precipitation_visibility_m", 0, limits::kVisibility, false},
    {"wind_speed_mps", 0, 200, false},
    {"wind_from_deg", -360, 360, false},
    {"wind_up_mps", -200, 200, false},
    {"view_near_m", 1e-6, limits::kHighest, false},
    {"view_left_deg", -kHalf, kHalf, false},
    {"view_right_deg", -kHalf, kHalf, false},
    {"view_bottom_deg", -kHalf, kHalf, false},
    {"view_top_deg", -kHalf, kHalf, false},
}};

using Names = std::span<const std::string_view>;
using Units = std::span<const Unit>;

constexpr std::array<std::string_view, 9> kTimes{
    "time", "timestamp", "time_stamp", "elapsed_time", "sim_time", "datetime", "seconds", "t", "utc"};
constexpr std::array<std::string_view, 2> kLatitudes{"latitude", "lat"};
constexpr std::array<std::string_view, 4> kLongitudes{"longitude", "lon", "long", "lng"};
constexpr std::array<std::string_view, 5> kAltitudes{"altitude", "altitude_msl", "altitude_asl", "alt",
                                                     "alt_msl"};
constexpr std::array<std::string_view, 2> kPitches{"pitch", "theta"};
constexpr std::array<std::string_view, 3> kRolls{"roll", "bank", "phi"};
constexpr std::array<std::string_view, 6> kHeadings{"heading", "heading_true", "true_heading",
                                                    "hdg",     "yaw",          "psi"};
constexpr std::array kTimeUnits{Unit::seconds, Unit::milliseconds, Unit::microseconds, Unit::nanoseconds,
                                Unit::none};
constexpr std::array kAngleUnits{Unit::degrees, Unit::none, Unit::radians};
constexpr std::array kFeet{Unit::feet};
constexpr std::array kMetres{Unit::metres};
constexpr std::array kNoUnit{Unit::none};

/// What others call it, in the order in which names and units count.
struct OtherNames {
  FlightQuantity quantity;
  Names names;
  Units units;
};
constexpr OtherNames kOtherNames[] = {
    {kTime, kTimes, kTimeUnits},
    {kLatitude, kLatitudes, kAngleUnits},
    {kLongitude, kLongitudes, kAngleUnits},
    {kAltitudeFt, kAltitudes, kFeet},
    {kPitch, kPitches, kAngleUnits},
    {kRoll, kRolls, kAngleUnits},
    {kHeading, kHeadings, kAngleUnits},
};

const char* nameOf(std::size_t quantity) {
  return kRows[quantity].name;
}

/// Finds the quantity that a map calls so, in any unit that it is read in.
std::optional<std::size_t> mappedQuantity(std::string_view name, LogColumn& column) {
  const ColumnName wanted = columnName(name);
  column.unit = wanted.unit;
  if (wanted == ColumnName{"altitude", Unit::metres}) return kHeightM;
  for (std::size_t q = 0; q < kFlightQuantities; ++q)
    if (columnName(nameOf(q)) == wanted) return q;
  for (const OtherNames& other : kOtherNames) {
    const bool unit = std::find(other.units.begin(), other.units.end(), wanted.unit) != other.units.end();
    if (unit && wanted.base == other.names.front()) return other.quantity;
  }
  return std::nullopt;
}

class Search {
 public:
  Search(const DelimitedText& table, const Refuse& refuse)
      : table_(table), refuse_(refuse), columns_(table.header()) {}

  FlightColumns found(const ColumnMap& map) {
    const LogProfile* profile = flightProfile(table_.header());
    if (profile) takeProfile(*profile);
    takeMap(map);
    const bool altitudeMapped = found_.has(kAltitudeFt);
    for (std::size_t q = 0; q < kFlightQuantities; ++q) {
      if (q == kHeightM && altitudeMapped) continue;
      const ColumnName own = columnName(nameOf(q));
      const std::array<std::string_view, 1> names{own.base};
      const std::array units{own.unit};
      take(q, names, units);
    }
    for (const OtherNames& other : kOtherNames) {
      if (other.quantity == kAltitudeFt && found_.has(kHeightM)) continue;
      take(other.quantity, other.names, other.units);
    }
    if (!found_.has(kAltitudeFt) && !found_.has(kHeightM)) take(kHeightM, kAltitudes, kMetres);
    if (!complete())
      refuse_(
          "", "the columns of a flight",
          (profile ? "what seems to be " + std::string(profile->name) + ": " : seemsToBe(table_.header())) +
              table_.beginning());
    return std::move(found_);
  }

 private:
  void take(std::size_t quantity, Names names, Units units) {
    if (found_.at[quantity]) return;
    bool twice = false;
    found_.at[quantity] = columns_.find(names, units, twice);
    if (twice) refuse_(nameOf(quantity), "one column of this name", "two");
  }

  void takeProfile(const LogProfile& profile) {
    found_.profile = profileText(profile);
    const Result<ColumnMap> map = parseColumnMap(profile.columns);
    for (const auto& [name, source] : *map) {
      LogColumn meant;
      const auto quantity = mappedQuantity(name, meant);
      const auto column = columns_.find(source);
      if (!quantity || !column) continue;
      found_.at[*quantity] = *column;
      found_.at[*quantity]->unit = meant.unit;
    }
  }

  void takeMap(const ColumnMap& map) {
    for (const auto& [name, source] : map) {
      LogColumn meant;
      const auto quantity = mappedQuantity(name, meant);
      const auto column = columns_.find(source);
      if (!quantity) {
        std::string all;
        for (const FlightQuantityRow& row : kRows) all += (all.empty() ? "" : ", ") + std::string(row.name);
        refuse_(name, "one of " + all, "a quantity that no flight has");
      } else if (!column) {
        refuse_(name, "one column named \"" + source.column + '"', table_.beginning());
      } else {
        found_.at[*quantity] = *column;
        found_.at[*quantity]->unit = meant.unit;
      }
    }
  }

  bool complete() {
    bool complete = true;
    const auto missing = [&](std::size_t quantity, std::string expected, std::string found) {
      complete = false;
      refuse_(nameOf(quantity), std::move(expected), std::move(found));
    };
    for (std::size_t q = 0; q < kFlightQuantities; ++q) {
      const bool fromTrack = (q == kPitch || q == kRoll || q == kHeading) && found_.attitudeFromTrack();
      if (!kRows[q].required || found_.at[q] || fromTrack) continue;
      bool twice = false;
      if (q != kAltitudeFt)
        missing(q, "a column of this name", "none in the header");
      else if (const auto column = columns_.find(kAltitudes, kNoUnit, twice); column && !found_.has(kHeightM))
        missing(q, "a unit in the name of the altitude, as altitude_ft or altitude_m",
                '"' + column->name + "\", which may be feet or metres: " +
                    mapAdvice({"altitude_ft=" + columnText(column->name),
                               "altitude_m=" + columnText(column->name)}));
      else if (!found_.has(kHeightM))
        missing(q, "a column of this name", "none in the header");
    }
    if (found_.has(kHeadHeading) != found_.has(kHeadPitch))
      missing(found_.has(kHeadHeading) ? kHeadPitch : kHeadHeading, "both head columns", "one alone");
    return complete;
  }

  const DelimitedText& table_;
  const Refuse& refuse_;
  LogColumns columns_;
  FlightColumns found_;
};

}  // namespace

const FlightQuantityRow& flightQuantity(FlightQuantity quantity) {
  return kRows[quantity];
}

FlightColumns flightColumns(const DelimitedText& table, const ColumnMap& map, const Refuse& refuse) {
  return Search(table, refuse).found(map);
}

}  // namespace trimtab
