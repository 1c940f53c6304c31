#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "trimtab/units/quantity.h"
#include "trimtab/units/result.h"

namespace trimtab {

/// A place of a table, WGS 84, and the line that it stands on, from 1.
struct ListedPlace {
  Degrees latitude, longitude;
  std::size_t line = 0;
};

/// Reads the places of a delimited text with a header that names latitude and longitude ("latitude_deg",
/// "Lat", "lng", in radians if it says so); other columns do not matter. Latitudes are -90 to 90 degrees,
/// longitudes -360 to 360. `where` names the text in findings. Refuses a table without the two columns, and
/// names every row that is not a place.
Result<std::vector<ListedPlace>> readPlaceList(std::string_view text, const std::string& where);

}  // namespace trimtab
