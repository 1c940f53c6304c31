#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "trimtab/host/place_list.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/format/height_query.h"
#include "trimtab/units/number.h"

namespace trimtab::cli {

namespace {

struct HeightArguments {
  std::string terrain, csv;
  std::vector<double> places;
  bool json = false;
};

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : " and ") + name;
  return all;
}

/// Says where heights come from. A database of scenery has no list of sources by posts.
std::string sourceOf(const terrain::GroundAt& ground, const terrain::Database& database) {
  if (!ground.filled && ground.sources.empty()) return database.info().source;
  const std::string files = joined(ground.sources);
  if (!ground.filled) return files;
  return files.empty() ? "no source, a void that was filled" : files + ", and a void that was filled";
}

nlohmann::ordered_json toJson(const ListedPlace& place, const std::optional<terrain::GroundAt>& ground,
                              const terrain::Database& database) {
  nlohmann::ordered_json json = {{"latitude_deg", place.latitude.value()},
                                 {"longitude_deg", place.longitude.value()},
                                 {"height_m", nullptr},
                                 {"error_m", nullptr},
                                 {"source", nullptr}};
  if (!ground) return json;
  json["height_m"] = ground->height.value();
  if (ground->error) json["error_m"] = ground->error->value();
  json["source"] = sourceOf(*ground, database);
  return json;
}

/// Puts a cell in quotes where it needs them (RFC 4180).
std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? "\"\"" : std::string(1, c);
  return cell + '"';
}

void printCsv(const ListedPlace& place, const std::optional<terrain::GroundAt>& ground,
              const terrain::Database& database) {
  std::cout << numberText(place.latitude.value()) << ',' << numberText(place.longitude.value()) << ',';
  if (ground)
    std::cout << numberText(ground->height.value(), 9) << ','
              << (ground->error ? numberText(ground->error->value(), 4) : "") << ','
              << csvCell(sourceOf(*ground, database));
  else
    std::cout << ",,";
  std::cout << '\n';
}

Result<std::vector<ListedPlace>> placesOf(const HeightArguments& arguments) {
  if (!arguments.csv.empty()) {
    const auto text = readWhole(arguments.csv);
    if (!text) return text.findings();
    return readPlaceList(*text, arguments.csv);
  }
  std::vector<ListedPlace> places;
  for (std::size_t i = 0; i + 1 < arguments.places.size(); i += 2)
    places.push_back({Degrees{arguments.places[i]}, Degrees{arguments.places[i + 1]}, 0});
  return places;
}

int printHeights(const HeightArguments& arguments) {
  const auto places = placesOf(arguments);
  report(places.findings());
  if (!places) return kRefused;
  const auto query = terrain::HeightQuery::open(arguments.terrain);
  report(query.findings());
  if (!query) return kRefused;
  const terrain::Database& database = query->database();
  const terrain::TerrainInfo& info = database.info();
  auto json = nlohmann::ordered_json::array();
  Findings outside;
  if (!arguments.json) std::cout << "latitude_deg,longitude_deg,height_m,error_m,source\n";
  for (const ListedPlace& place : *places) {
    const auto ground = query->at(place.latitude, place.longitude);
    if (arguments.json)
      json.push_back(toJson(place, ground, database));
    else
      printCsv(place, ground, database);
    if (ground) continue;
    const auto number = [](auto angle) { return numberText(angle.value(), 9); };
    outside.push_back(
        {Severity::error,
         place.line > 0 ? arguments.csv + ":" + std::to_string(place.line) : arguments.terrain, "place",
         "latitudes " + number(info.southWest.latitude) + " to " + number(info.northEast.latitude) +
             ", longitudes " + number(info.southWest.longitude) + " to " + number(info.northEast.longitude),
         number(place.latitude) + ", " + number(place.longitude)});
  }
  if (arguments.json) std::cout << json.dump(2, ' ', false, decltype(json)::error_handler_t::replace) << '\n';
  // A place inside without a height lies in a damaged block.
  report(database.damage());
  report(outside);
  return outside.empty() ? kDone : kRefused;
}

}  // namespace

void addTerrainHeight(CLI::App& terrain, int& exitCode) {
  auto arguments = std::make_shared<HeightArguments>();
  CLI::App* height = terrain.add_subcommand(
      "height",
      "Heights above mean sea level at places of a database, how far the drawn ground may be from them, and "
      "the file that each comes from");
  height->add_option("terrain", arguments->terrain, "Folder of a database")->required();
  CLI::Option* places = height->add_option("places", arguments->places,
                                           "Latitude and longitude of each place, degrees, WGS 84");
  height
      ->add_option("--csv", arguments->csv,
                   "Table of places with a header that names latitude_deg and longitude_deg")
      ->excludes(places);
  height->add_flag("--json", arguments->json, "One JSON document on standard output, instead of CSV");
  height->callback([arguments, &exitCode] {
    const auto& given = arguments->places;
    if (arguments->csv.empty() && given.empty())
      throw CLI::ValidationError("places", "latitude and longitude, or --csv with a table of them");
    if (given.size() % 2 != 0)
      throw CLI::ValidationError(
          "places", "a longitude after every latitude, not " + std::to_string(given.size()) + " numbers");
    for (std::size_t i = 0; i < given.size(); ++i)
      if (!(std::abs(given[i]) <= (i % 2 == 0 ? 90 : 360)))
        throw CLI::ValidationError(
            "places", std::string(i % 2 == 0 ? "a latitude of -90 to 90" : "a longitude of -360 to 360") +
                          ", not " + numberText(given[i]));
    exitCode = printHeights(*arguments);
  });
}

}  // namespace trimtab::cli
