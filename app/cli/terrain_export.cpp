#include <iostream>
#include <memory>

#include "commands.h"
#include "progress.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/static_lod/export.h"
#include "trimtab/units/number.h"

namespace trimtab::cli {

namespace {

struct BtgArguments {
  std::string terrain;
  terrain::SceneryExport options;
};

int exportBtg(const BtgArguments& arguments) {
  const auto database = terrain::Database::open(arguments.terrain);
  report(database.findings());
  if (!database) return kRefused;
  const auto trees = (*database)->staticLod();
  if (!trees) {
    report({{Severity::error, arguments.terrain, "", "a database baked from scenery (.btg, .stg)",
             "a terrain without static levels of detail"}});
    return kRefused;
  }
  const auto done = terrain::exportScenery(*trees, arguments.options, arguments.terrain);
  report(done.findings());
  if (!done) return kRefused;
  std::cout << "level " << arguments.options.level << ": " << done->tiles << " tiles, " << done->airports
            << " airports, " << done->lists << " lists, " << done->triangles << " triangles, " << done->bytes
            << " bytes\n"
            << "error against the source triangles: " << numberText(done->rmsErrorM, 4) << " m RMS, "
            << numberText(done->maxErrorM, 4) << " m at most\n";
  if (done->seas > 0)
    std::cout << done->seas << " buckets of open sea left out: FlightGear makes them itself\n";
  return kDone;
}

}  // namespace

void addTerrainExport(CLI::App& terrain, int& exitCode) {
  CLI::App* group = terrain.add_subcommand("export", "Write a database in a format of another program");
  group->require_subcommand(1);
  auto btg = std::make_shared<BtgArguments>();
  CLI::App* write = group->add_subcommand(
      "btg", "Write one level of the static levels of detail as FlightGear scenery (.btg.gz and .stg)");
  write->add_option("terrain", btg->terrain, "Folder of a database baked from scenery")->required();
  write
      ->add_option("--level", btg->options.level,
                   "0 is the coarsest; leaves above it are written where a tree is less deep")
      ->required();
  write
      ->add_option("-o,--output", btg->options.output,
                   "Folder to write, for FlightGear's --fg-scenery; it must not exist or be empty")
      ->required();
  stopWhenAsked(*write);
  write->callback([btg, &exitCode] {
    btg->options.progress = progressLines();
    exitCode = exportBtg(*btg);
  });
}

}  // namespace trimtab::cli
