#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "progress.h"
#include "trimtab/terrain/database.h"

namespace trimtab::cli {

namespace {

nlohmann::ordered_json toJson(const terrain::Database& database) {
  const terrain::TerrainInfo& i = database.info();
  const TerrainIndex& index = database.index();
  nlohmann::ordered_json levels = nlohmann::ordered_json::array();
  for (std::size_t l = 0; l < index.levels.size(); ++l) {
    const TerrainIndex::Level& level = index.levels[l];
    float error = 0;
    for (std::uint32_t n = 0; n < level.columns * level.rows; ++n)
      error = std::max(error, index.errorM[level.firstNode + n]);
    levels.push_back({{"level", l}, {"columns", level.columns}, {"rows", level.rows}, {"error_m", error}});
  }
  return {{"name", i.name},
          {"source", i.source},
          {"south_deg", i.southWest.latitude.value()},
          {"west_deg", i.southWest.longitude.value()},
          {"north_deg", i.northEast.latitude.value()},
          {"east_deg", i.northEast.longitude.value()},
          {"columns", i.columns},
          {"rows", i.rows},
          {"post_longitude_deg", i.postLongitude.value()},
          {"post_latitude_deg", i.postLatitude.value()},
          {"lowest_m", i.lowest.value()},
          {"highest_m", i.highest.value()},
          {"voids_filled", i.voidsFilled},
          {"image", i.hasImage},
          {"bytes", i.bytes},
          {"levels", levels}};
}

void print(const terrain::Database& database) {
  const auto json = toJson(database);
  for (const auto& [key, value] : json.items())
    if (key != "levels")
      std::cout << std::left << std::setw(20) << key
                << (value.is_string() ? value.get<std::string>() : value.dump()) << '\n';
  for (const auto& level : json["levels"])
    std::cout << "level " << level["level"] << ": " << level["columns"] << " x " << level["rows"]
              << " tiles, error " << level["error_m"].get<double>() << " m\n";
}

}  // namespace

void addTerrain(CLI::App& app, int& exitCode) {
  CLI::App* group = app.add_subcommand("terrain", "Make, bake and look at terrain");
  group->require_subcommand(1);

  struct SampleArguments {
    std::string output;
    terrain::SampleOptions options;
  };
  auto sample = std::make_shared<SampleArguments>();
  CLI::App* makeSample = group->add_subcommand("sample", "Write the seeded sample terrain as a GeoTIFF");
  makeSample->add_option("-o,--output", sample->output, "GeoTIFF to write")->required();
  makeSample->add_option("--seed", sample->options.seed, "The same seed gives the same terrain")
      ->capture_default_str();
  makeSample->add_option("--size-km", sample->options.sizeKm, "Side of the square")
      ->capture_default_str()
      ->check(CLI::Range(5.0, 1000.0));
  makeSample->add_option("--post-m", sample->options.postM, "Distance of posts")
      ->capture_default_str()
      ->check(CLI::Range(5.0, 2000.0));
  makeSample->callback([sample, &exitCode] {
    const Interruptible guard;
    sample->options.progress = progressLines();
    const auto done = terrain::writeSample(sample->output, sample->options);
    report(done.findings());
    exitCode = done ? kDone : kRefused;
  });

  struct BakeArguments {
    std::vector<std::string> sources;
    std::string output, imagery;
  };
  auto bake = std::make_shared<BakeArguments>();
  CLI::App* makeBake = group->add_subcommand("bake", "Make a database of elevation files or folders");
  makeBake
      ->add_option("source", bake->sources,
                   "DTED, .hgt, GeoTIFF and whatever else GDAL reads; or folders of them")
      ->required();
  makeBake->add_option("-o,--output", bake->output, "Folder of the database")->required();
  makeBake->add_option("--imagery", bake->imagery, "Georeferenced image to drape");
  makeBake->callback([bake, &exitCode] {
    const Interruptible guard;
    terrain::BakeOptions options;
    options.sources.assign(bake->sources.begin(), bake->sources.end());
    options.output = bake->output;
    if (!bake->imagery.empty()) options.imagery = bake->imagery;
    options.progress = progressLines();
    const auto done = terrain::bake(options);
    report(done.findings());
    exitCode = done ? kDone : kRefused;
    if (done) print(**done);
  });

  struct InfoArguments {
    std::string database;
    bool json = false;
  };
  auto info = std::make_shared<InfoArguments>();
  CLI::App* showInfo = group->add_subcommand("info", "What a database holds");
  showInfo->add_option("database", info->database, "Folder of the database")->required();
  showInfo->add_flag("--json", info->json, "One JSON document on standard output");
  showInfo->callback([info, &exitCode] {
    const auto database = terrain::Database::open(info->database);
    report(database.findings());
    exitCode = database ? kDone : kRefused;
    if (!database) return;
    if (info->json)
      std::cout << toJson(**database).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
                << '\n';
    else
      print(**database);
  });
}

}  // namespace trimtab::cli
