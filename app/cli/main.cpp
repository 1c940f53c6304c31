#include <iostream>

#include "commands.h"
#include "trimtab/units/labelled.h"

namespace trimtab::cli {

void report(const Findings& findings) {
  std::cerr << labelled(findings);
}

}  // namespace trimtab::cli

int main(int argc, char** argv) {
  CLI::App app{"Trimtab: tune culling and level of detail of image generators"};
  app.set_version_flag("--version", TRIMTAB_VERSION);
  app.require_subcommand(1);
  int exitCode = trimtab::cli::kDone;
  trimtab::cli::addPreset(app, exitCode);
  trimtab::cli::addDecide(app, exitCode);
  trimtab::cli::addTerrain(app, exitCode);
  trimtab::cli::addFeed(app, exitCode);
  trimtab::cli::addBench(app, exitCode);
  trimtab::cli::addResults(app, exitCode);
  trimtab::cli::addExperiment(app, exitCode);
  trimtab::cli::addLeverage(app, exitCode);
  trimtab::cli::addWeather(app, exitCode);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? trimtab::cli::kDone : trimtab::cli::kUsage;
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return trimtab::cli::kRefused;
  }
  return exitCode;
}
