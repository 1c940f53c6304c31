#include "run_options.h"

#include <cstdio>

#include "app/models/read_model.h"
#include "commands.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/bake/cache.h"

namespace trimtab::cli {

CLI::Option* RunOptions::addOutput(CLI::App& command, const char* help) {
  command.add_flag("--json", json, "One JSON document on standard output");
  return command.add_option("-o,--output", output, help);
}

bool RunOptions::readSize(int& widthPx, int& heightPx) const {
  char after = 0;
  if (std::sscanf(size.c_str(), "%dx%d%c", &widthPx, &heightPx, &after) == 2 && widthPx >= 16 &&
      heightPx >= 16 && widthPx <= 16384 && heightPx <= 16384)
    return true;
  report({{Severity::error, "--size", "", "WIDTHxHEIGHT, each 16 to 16384 px", size}});
  return false;
}

std::optional<Flight> RunOptions::readFlight(const std::string& file) const {
  Result<Flight> flight = link::openFlightOption(file, columns);
  report(flight.findings());
  if (!flight) return std::nullopt;
  return std::move(flight).value();
}

std::shared_ptr<const terrain::Database> RunOptions::openTerrain(const terrain::Progress& progress) const {
  const auto opened = scene::isOsgScene(terrain)
                          ? scene::openOsgScene(terrain, origin)
                          : terrain::openOrBake(terrain, terrain::cacheFolder(), progress,
                                                terrain::BakeOptions{}.trianglesPerNode,
                                                terrain::ObjectsToBake{{}, models::readModel});
  report(opened.findings());
  return opened ? *opened : nullptr;
}

}  // namespace trimtab::cli
