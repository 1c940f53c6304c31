#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace trimtab::terrain {

/// Returns the metres per unit of a length that is named as files name it: as UDUNITS, EPSG, GDAL, ESRI or
/// PROJ do ("US_survey_foot", "Foot (International)", "ftUS", "decimetres", "0.1 m"). Case, plurals,
/// brackets, spaces, hyphens and underscores make no difference. Returns none if the name is not known.
std::optional<double> metresPerUnit(std::string_view name);

/// Returns names that metresPerUnit knows, one for each unit, for help and messages.
std::string unitsOfHeight();

}  // namespace trimtab::terrain
