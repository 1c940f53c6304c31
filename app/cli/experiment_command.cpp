#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "app/experiment/experiment.h"
#include "commands.h"
#include "progress.h"
#include "settings.h"
#include "trimtab/host/flight.h"
#include "trimtab/terrain/bake/cache.h"

namespace trimtab::cli {
namespace {

struct Arguments {
  std::string terrain, flight, preset = "default", size = "1280x720", output;
  std::vector<std::string> settings;
  int repeats = 3;
  bool json = false;
};

using Run = Result<experiment::Report> (*)(const experiment::Setup&);

int run(const Arguments& arguments, Run experiment) {
  const Interruptible guard;
  experiment::Setup setup;
  setup.progress = progressLines();
  bool usable = parseSize(arguments.size, setup.widthPx, setup.heightPx);
  if (!usable) report({{Severity::error, "--size", {}, "WIDTHxHEIGHT, each 16 to 16384 px", arguments.size}});
  const std::optional<ValidatedParameters> parameters = parametersFor(arguments.preset, arguments.settings);
  usable = parameters && usable;
  if (!arguments.flight.empty()) {
    Result<Flight> flight = readFlight(arguments.flight);
    report(flight.findings());
    usable = flight && usable;
    if (flight) setup.flight = std::move(flight).value();
  }
  const auto terrain = terrain::openOrBake(arguments.terrain, terrain::cacheFolder(), setup.progress);
  report(terrain.findings());
  if (!terrain || !usable) return kRefused;
  setup.terrain = *terrain;
  setup.terrainName = setup.terrain->info().name;
  setup.parameters = **parameters;
  setup.presetName = arguments.preset;
  setup.repeats = arguments.repeats;
  const Result<experiment::Report> done = experiment(setup);
  report(done.findings());
  if (!done) return kRefused;
  std::cout << (arguments.json ? toJson(*done) : toText(*done));
  if (arguments.output.empty()) return kDone;
  const auto written = writeReport(arguments.output, *done);
  report(written.findings());
  return written ? kDone : kRefused;
}

}  // namespace

void addExperiment(CLI::App& app, int& exitCode) {
  CLI::App* group = app.add_subcommand("experiment", "The published experiments: their rows beside ours");
  group->require_subcommand(1);
  struct Named {
    const char *name, *what;
    Run run;
  };
  for (const Named& named : {
           Named{"culling", "No culling, view frustum and proposed at 2,000 to 8,000 ft (documents A, B)",
                 &experiment::runCulling},
           Named{"head-motion", "A sweep of 180 degrees in a second (document C)",
                 &experiment::runHeadMotion},
           Named{"weather", "Three vertex counts, four densities; fixed ratio and adaptive (document D)",
                 &experiment::runWeather},
           Named{"static-lod", "Faces by level of one tile of scenery (document E)",
                 &experiment::runStaticLod},
       }) {
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command = group->add_subcommand(named.name, named.what);
    command->add_option("--terrain", arguments->terrain, "Database, or elevation to bake")->required();
    command->add_option("--flight", arguments->flight, "Places to look from; without it the terrain's own");
    command->add_option("--preset", arguments->preset, "Preset or export")->capture_default_str();
    command->add_option("--set", arguments->settings, "KEY=VALUE on top of the preset; may be repeated");
    command->add_option("--size", arguments->size, "Render size")->capture_default_str();
    command->add_option("--repeats", arguments->repeats, "Frames a view whose median counts")
        ->capture_default_str()
        ->check(CLI::Range(1, 100));
    command->add_option("-o,--output", arguments->output, "Folder for JSON, CSV and plots");
    command->add_flag("--json", arguments->json, "One JSON document on standard output");
    command->callback([arguments, run = named.run, &exitCode] { exitCode = cli::run(*arguments, run); });
  }
}

}  // namespace trimtab::cli
