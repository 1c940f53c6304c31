#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "app/harness/run.h"
#include "app/harness/sweep.h"
#include "app/harness/text.h"
#include "commands.h"
#include "progress.h"
#include "run_options.h"
#include "settings.h"
#include "trimtab/measure/trace.h"

namespace trimtab::cli {
namespace {

struct BenchOptions : RunOptions {
  std::string cases = "none,view_frustum,proposed";
  std::vector<std::string> flights, presets{"default"}, sweeps;
  std::size_t frames = 60, repeats = 5;
  bool whole = false;
  PartOptions part;
};

Finding refused(const char* option, const std::string& expected, const std::string& found) {
  return {Severity::error, option, "", expected, found};
}

/// "none,proposed"
bool parseCases(const std::string& text, std::vector<CullingCase>& cases) {
  constexpr CullingCase kAll[] = {CullingCase::none, CullingCase::view_frustum, CullingCase::proposed};
  cases.clear();
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string name = text.substr(at, end - at);
    bool known = false;
    for (const CullingCase method : kAll)
      if (harness::caseName(method) == name) {
        cases.push_back(method);
        known = true;
      }
    if (!known) return false;
    at = end + 1;
  }
  return true;
}

/// Returns the states of a trace's own rows, which a reader of flights would drop or mend, over the ground as
/// it was.
std::vector<AircraftState> statesOf(const std::vector<TraceRow>& trace) {
  std::vector<AircraftState> states;
  for (const TraceRow& row : trace) {
    states.push_back(row.input.state);
    if (row.input.aboveGround) states.back().aboveGround = row.input.aboveGround;
  }
  return states;
}

bool readFlights(const BenchOptions& arguments, harness::Plan& plan) {
  bool usable = true;
  for (const std::string& file : arguments.flights) {
    std::optional<Flight> flight = arguments.readFlight(file);
    if (!flight) {
      usable = false;
      continue;
    }
    harness::Plan::NamedFlight named{nameOf(file, plan.flights), *std::move(flight)};
    if (isTraceFile(file)) {
      const Result<std::vector<TraceRow>> trace = readTrace(file);
      report(trace.findings());
      if (!trace) {
        usable = false;
        continue;
      }
      named.flight.states = statesOf(*trace);
    }
    plan.flights.push_back(std::move(named));
  }
  return usable;
}

bool readPresets(const BenchOptions& arguments, harness::Plan& plan) {
  bool usable = true;
  std::vector<harness::SweepAxis> axes;
  for (const std::string& sweep : arguments.sweeps) {
    Result<harness::SweepAxis> axis = harness::parseAxis(sweep);
    report(axis.findings());
    usable = usable && axis;
    if (axis) axes.push_back(std::move(axis).value());
  }
  if (axes.size() > harness::kMostAxes) {
    report({refused("--sweep", "at most two parameters", std::to_string(axes.size()))});
    return false;
  }
  if (axes.size() == 2 && axes[0].key == axes[1].key) {
    report({{Severity::error, "--sweep", axes[0].key, "each parameter once", "twice"}});
    return false;
  }
  if (!usable) return false;
  for (const std::string& preset : arguments.presets) {
    const std::string name = nameOf(preset, plan.presets);
    for (const harness::Settings& swept : harness::combinations(axes)) {
      std::vector<std::string> settings = arguments.settings;
      settings.insert(settings.end(), swept.begin(), swept.end());
      const std::optional<ValidatedParameters> parameters = parametersFor(preset, settings);
      if (parameters)
        plan.presets.push_back({harness::sweptName(name, swept), *parameters});
      else
        usable = false;
    }
  }
  return usable;
}

int run(const BenchOptions& arguments) {
  harness::Plan plan;
  plan.version = TRIMTAB_VERSION;
  plan.frames = arguments.frames;
  plan.repeats = arguments.repeats;
  plan.whole = arguments.whole;
  plan.progress = progressLines();
  bool usable = arguments.readSize(plan.widthPx, plan.heightPx);
  if (!parseCases(arguments.cases, plan.cases)) {
    report({refused("--cases", "some of none, view_frustum, proposed with commas between", arguments.cases)});
    usable = false;
  }
  plan.part = arguments.part.read();
  usable = readFlights(arguments, plan) && usable;
  usable = readPresets(arguments, plan) && usable;
  plan.terrain = arguments.openTerrain(plan.progress);
  if (!plan.terrain || !usable) return kRefused;
  plan.terrainName = plan.terrain->info().name;
  const Result<harness::Results> results = harness::run(plan, arguments.output);
  report(results.findings());
  if (!results) return kRefused;
  if (results->units.empty()) return arguments.part.incomplete(results->notes);
  std::cout << (arguments.json ? harness::toJson(*results) : harness::toText(*results));
  return std::cout.flush() ? kDone : kRefused;
}

}  // namespace

void addBench(CLI::App& app, int& exitCode) {
  auto arguments = std::make_shared<BenchOptions>();
  CLI::App* command =
      app.add_subcommand("bench", "Run time against error, over flights x presets x culling cases");
  command->footer(
      "The folder gets results.json, frames.csv, report.html and pictures of the worst frames. A run that "
      "was "
      "stopped goes on where it was when the same command is given again.");
  arguments->add(*command, arguments->flights, "Flights (CSV, trace or capture); one or more",
                 arguments->presets, "Presets or exports; the first is compared against");
  command->get_option("--flight")->required();
  command->add_option("--cases", arguments->cases, "Culling cases, with commas between")
      ->capture_default_str();
  command
      ->add_option("--sweep", arguments->sweeps,
                   "KEY=A,B,...: measures every preset at each of these values; once or twice")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--frames", arguments->frames, "Frames of each flight, evenly spread")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  command->add_option("--repeats", arguments->repeats, "Timed draws of each frame")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  command->add_flag("--whole", arguments->whole,
                    "Draws every image of presets whose rules or budget depend on earlier images, not only "
                    "those that may have an effect on a measured frame");
  arguments->part.add(*command);
  arguments->addOutput(*command, "Folder for the results")->required();
  stopWhenAsked(*command);
  command->callback([arguments, &exitCode] { exitCode = cli::run(*arguments); });
}

}  // namespace trimtab::cli
