#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "app/tune/tune.h"
#include "commands.h"
#include "progress.h"
#include "run_options.h"
#include "settings.h"
#include "trimtab/preset/preset.h"

namespace trimtab::cli {
namespace {

struct TuneOptions : RunOptions {
  std::string preset = "default", time = "p95", error = "flip";
  std::vector<std::string> flights, heldOut, free;
  double budgetMs = 0, maxError = 0;
  tune::Plan plan;
  PartOptions part;
};

bool readFlights(const TuneOptions& arguments, tune::Plan& plan) {
  std::vector<harness::Plan::NamedFlight> all;
  bool usable = true;
  for (const auto* files : {&arguments.flights, &arguments.heldOut})
    for (const std::string& file : *files) {
      std::optional<Flight> flight = arguments.readFlight(file);
      usable = usable && flight;
      all.push_back({nameOf(file, all), std::move(flight).value_or(Flight{})});
    }
  const auto seen = all.begin() + static_cast<std::ptrdiff_t>(arguments.flights.size());
  plan.flights.assign(all.begin(), seen);
  plan.heldOut.assign(seen, all.end());
  return usable;
}

int run(const TuneOptions& arguments) {
  tune::Plan plan = arguments.plan;
  plan.version = TRIMTAB_VERSION;
  plan.progress = progressLines();
  plan.free = arguments.free;
  const Result<Preset> preset = loadPreset(arguments.preset);
  plan.startName = preset && !preset->name.empty() ? preset->name
                                                   : std::filesystem::path(arguments.preset).stem().string();
  if (arguments.budgetMs > 0) plan.budgetMs = arguments.budgetMs;
  if (arguments.maxError > 0) plan.maxError = arguments.maxError;
  plan.time = arguments.time == "median" ? tune::TimeMeasure::median
              : arguments.time == "p99"  ? tune::TimeMeasure::p99
                                         : tune::TimeMeasure::p95;
  plan.error = tune::errorKindOf(arguments.error);
  bool usable = arguments.readSize(plan.widthPx, plan.heightPx);
  plan.part = arguments.part.read();
  const std::optional<ValidatedParameters> start = parametersFor(arguments.preset, arguments.settings);
  usable = readFlights(arguments, plan) && usable;
  if (!usable || !start) return kRefused;
  plan.start = *start;
  plan.terrain = arguments.openTerrain(plan.progress);
  if (!plan.terrain) return kRefused;
  plan.terrainName = plan.terrain->info().name;
  const Result<tune::Outcome> outcome = tune::run(plan, arguments.output);
  report(outcome.findings());
  if (!outcome) return kRefused;
  if (outcome->answer.empty()) return arguments.part.incomplete(outcome->notes);
  const experiment::Report report = tune::toReport(plan, *outcome);
  std::cout << (arguments.json ? experiment::toJson(report) : experiment::toText(report));
  return std::cout.flush() ? kDone : kRefused;
}

}  // namespace

void addTune(CLI::App& app, int& exitCode) {
  auto arguments = std::make_shared<TuneOptions>();
  tune::Plan& plan = arguments->plan;
  CLI::App* command = app.add_subcommand("tune", "Search for presets: run time against error over flights");
  command->footer(
      "The folder gets the found presets, a page with the front, and every finished part of the work. A run "
      "that was stopped goes on where it was when the same command is given again. Several machines share a "
      "folder with --part 1/8 to 8/8, once for each step that the command names; without --part the command "
      "joins what they did.");
  arguments->add(*command, arguments->flights, "Flights (CSV, trace or capture) that the search sees",
                 arguments->preset, "Preset or export to start from");
  command->get_option("--terrain")->description("Database, or elevation to bake");
  command->get_option("--flight")->required();
  command->add_option("--hold-out", arguments->heldOut,
                      "Flights that the search does not see, on which what it found is proven");
  command
      ->add_option(
          "--free", arguments->free,
          "What may move: KEY, GROUP.* or KEY=LOW..HIGH; policy.terms and policy.rules free the numbers "
          "of the preset's policy")
      ->required();
  CLI::Option* budget =
      command->add_option("--budget-ms", arguments->budgetMs, "Longest time of a flight's images, ms")
          ->check(CLI::PositiveNumber);
  command
      ->add_option("--max-error", arguments->maxError,
                   "Greatest error, in the unit of --error: FLIP from 0 to 1, pixels, or pops of 255")
      ->check(CLI::PositiveNumber)
      ->excludes(budget);
  command
      ->add_option("--error", arguments->error,
                   "The error that is made small: flip (mean), geometric (largest, pixels) or pop (95th "
                   "percentile)")
      ->check(CLI::IsMember({"flip", "geometric", "pop"}))
      ->capture_default_str();
  command->add_option("--time", arguments->time, "The time that is made small: median, p95 or p99")
      ->check(CLI::IsMember({"median", "p95", "p99"}))
      ->capture_default_str();
  command->add_option("--points", plan.points, "Found presets to draw")
      ->check(CLI::Range(1, 6))
      ->capture_default_str();
  command->add_option("--frames", plan.frames, "Frames of each flight to draw, evenly spread")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--repeats", plan.repeats, "Timed draws of each frame")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--samples", plan.drawnRows, "Rows of a flight that estimates are made from")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--evaluations", plan.evaluations, "Estimates of each search")
      ->check(CLI::Range(100, 100000000))
      ->capture_default_str();
  command->add_option("--searches", plan.searches, "Searches, each with a seed of its own")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--seed", plan.seed, "Seed of the first search")->capture_default_str();
  arguments->part.add(*command);
  arguments->addOutput(*command, "Folder for the results")->required();
  stopWhenAsked(*command);
  command->callback([arguments, &exitCode] { exitCode = cli::run(*arguments); });
}

}  // namespace trimtab::cli
