#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "app/experiment/experiment.h"
#include "commands.h"
#include "experiment_setup.h"
#include "progress.h"
#include "trimtab/measure/machine_watch.h"

namespace trimtab::cli {
namespace {

using Run = Result<experiment::Report> (*)(const experiment::Setup&);

int run(const SetupArguments& arguments, Run experiment) {
  // Opening the terrain may bake it first.
  if (!mayWriteTo(arguments.output)) return kRefused;
  const std::optional<experiment::Setup> setup = setupFrom(arguments);
  if (!setup) return kRefused;
  const MachineWatch watch;
  Result<experiment::Report> done = experiment(*setup);
  report(done.findings());
  if (!done || isDamaged(*setup)) return kRefused;
  if (std::string busy = busyText(watch.othersShare()); !busy.empty()) done->notes.push_back(std::move(busy));
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
           Named{"head-motion-varying", "Turns and nods of varying speed (document C, Figures 9 and 10)",
                 &experiment::runHeadMotionVarying},
           Named{"weather", "Three vertex counts, four densities; fixed ratio and adaptive (document D)",
                 &experiment::runWeather},
           Named{"weather-protocol", "One ratio at several vertex counts, as published (document D)",
                 &experiment::runWeatherProtocol},
           Named{"hold", "A budget held through head motion and weather, in four modes (beyond C and D)",
                 &experiment::runHold},
           Named{"static-lod", "Faces by level of one tile of scenery (document E)",
                 &experiment::runStaticLod},
       }) {
    auto arguments = std::make_shared<SetupArguments>();
    CLI::App* command = group->add_subcommand(named.name, named.what);
    const bool headMotion = std::string_view(named.name).starts_with("head-motion");
    // Each repeat is a pass, and fewer than six have no interval.
    if (headMotion) arguments->repeats = 9;
    arguments->addTo(*command);
    if (headMotion) {
      command->get_option("--repeats")->description("Passes in each mode; fewer than six tell no difference");
      command->add_option("--host-rate", arguments->hostRateHz, "Host states a second")
          ->capture_default_str()
          ->check(CLI::Range(1, 1000));
    }
    if (std::string_view(named.name) == "hold") {
      experiment::HoldSetup& hold = arguments->hold;
      command->add_flag(
          "--fixed", hold.fixedSettings,
          "Also fly fixed settings of the same levers in turns with hold, but for those that are far too "
          "slow, and name the best");
      command
          ->add_option("--budget", hold.budgetMs, "Budget, ms; 0.6 of the median image without it if unset")
          ->check(CLI::PositiveNumber);
      command->add_option("--seconds", hold.flightS, "Seconds of the flight, from its middle")
          ->capture_default_str()
          ->check(CLI::Range(2, 600));
      command->add_option("--strain", hold.strain, "Only this strain: sweep, head log, weather, or steady")
          ->check(CLI::IsMember({"sweep", "head log", "weather", "steady"}));
      command->add_option("--head", arguments->head, "Head log, or sweep:DEG/S; bad rows are left out");
      command->add_option("--head-columns", arguments->headColumns, link::kHeadColumnsHelp);
    }
    arguments->addOutput(*command, "Folder for JSON, CSV and a page with plots");
    stopWhenAsked(*command);
    command->callback([arguments, run = named.run, &exitCode] { exitCode = cli::run(*arguments, run); });
  }
}

}  // namespace trimtab::cli
