#include "trimtab/terrain/scenery/lines.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

namespace trimtab::terrain {

namespace {

std::string lowerCase(std::string_view material) {
  std::string name;
  for (const char c : material) name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

template <std::size_t N>
bool isAnyOf(const std::string& name, const std::array<std::string_view, N>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

LineFeature lineFeatureOf(std::string_view material) {
  const std::string name = lowerCase(material);
  // Newer scenery has its roads in asphalt; that of airports is no line, and the caller knows airports.
  if (isAnyOf(name, std::array<std::string_view, 3>{"road", "freeway", "asphalt"})) return LineFeature::road;
  if (isAnyOf(name, std::array<std::string_view, 2>{"railroad", "railway"})) return LineFeature::railway;
  if (isAnyOf(name, std::array<std::string_view, 3>{"stream", "intermittentstream", "canal"}))
    return LineFeature::stream;
  return LineFeature::none;
}

bool isWater(std::string_view material) {
  return isAnyOf(lowerCase(material),
                 std::array<std::string_view, 8>{"ocean", "lake", "pond", "reservoir", "lagoon", "estuary",
                                                 "watercourse", "intermittentlake"});
}

bool isAirport(std::string_view tile) {
  return tile.find_first_not_of("0123456789") != std::string_view::npos;
}

}  // namespace trimtab::terrain
