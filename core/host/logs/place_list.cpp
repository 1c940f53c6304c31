#include "trimtab/host/place_list.h"

#include <array>
#include <cmath>
#include <numbers>

#include "delimited_text.h"
#include "log_columns.h"

namespace trimtab {
namespace {

constexpr std::array<std::string_view, 2> kLatitudeNames{"latitude", "lat"};
constexpr std::array<std::string_view, 4> kLongitudeNames{"longitude", "lon", "long", "lng"};
constexpr std::array kUnitsOfPlaces{Unit::degrees, Unit::none, Unit::radians};

/// Returns an angle of the row that is at most `most` either way, in degrees.
std::optional<double> angleOf(const DelimitedText& table, const LogColumn& column, double most) {
  const auto number = table.number(column.cell(table.cells()));
  if (!number) return {};
  const double angle = column.unit == Unit::radians ? *number * 180 / std::numbers::pi : *number;
  if (!(std::abs(angle) <= most)) return {};
  return angle;
}

}  // namespace

Result<std::vector<ListedPlace>> readPlaceList(std::string_view text, const std::string& where) {
  Findings findings;
  DelimitedText table(text, where);
  if (!table.open(findings)) return findings;
  const LogColumns columns(table.header());
  bool twice = false;
  const auto latitude = columns.find(kLatitudeNames, kUnitsOfPlaces, twice),
             longitude = columns.find(kLongitudeNames, kUnitsOfPlaces, twice);
  if (twice || !latitude || !longitude) {
    findings.push_back({Severity::error, table.headerPlace(), "",
                        "a header with one column for latitude_deg and one for longitude_deg",
                        table.beginning()});
    return findings;
  }
  std::vector<ListedPlace> places;
  while (table.nextRow()) {
    const auto north = table.rowFits() ? angleOf(table, *latitude, 90) : std::nullopt,
               east = table.rowFits() ? angleOf(table, *longitude, 360) : std::nullopt;
    if (!north || !east)
      findings.push_back({Severity::error, table.place(), north ? longitude->name : latitude->name,
                          north ? "-360 to 360 degrees" : "-90 to 90 degrees",
                          !table.rowFits() ? "a row with another number of cells than the header"
                                           : cellText((north ? *longitude : *latitude).cell(table.cells()))});
    else
      places.push_back({Degrees{*north}, Degrees{*east}, table.line()});
  }
  if (hasError(findings)) return findings;
  return Result<std::vector<ListedPlace>>(std::move(places), std::move(findings));
}

}  // namespace trimtab
