#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands.h"
#include "experiment_setup.h"
#include "progress.h"
#include "trimtab/measure/machine_watch.h"
#include "trimtab/preset/preset.h"
#include "trimtab/units/number.h"

namespace trimtab::cli {
namespace {

struct WeatherOptions : SetupArguments {
  std::vector<std::string> steps;
  double vertices = 0;
};

std::string nameOf(WeatherStep step) {
  return std::string(findRow("weather.step")->choices[static_cast<std::size_t>(step)].name);
}

/// Returns the steps that `--step` names, or all but clear.
std::vector<WeatherStep> stepsOf(const std::vector<std::string>& names) {
  std::vector<WeatherStep> steps;
  for (int i = int(WeatherStep::rain_light); i <= int(WeatherStep::snow_heavy); ++i) {
    const auto step = static_cast<WeatherStep>(i);
    if (names.empty() || std::find(names.begin(), names.end(), nameOf(step)) != names.end())
      steps.push_back(step);
  }
  return steps;
}

std::string suffixOf(const StepCalibration& calibration) {
  const std::string why = whyRejected(calibration);
  return why.empty() ? why : "; rejected: " + why;
}

void print(const experiment::CalibratedWeather& calibrated, double othersShare) {
  std::printf("%.0f vertices in view in clear air\n", calibrated.vertices);
  std::printf("%-12s %9s %9s %12s %10s %8s %10s %8s  %s\n", "step", "clear ms", "uncut ms", "strongest ms",
              "matched ms", "far km", "ratio", "density", "outcome");
  for (const StepCalibration& c : calibrated.steps)
    std::printf("%-12s %9.2f %9.2f %12.2f %10.2f %8.2f %10.3g %8.3g  %s%s\n", nameOf(c.step).c_str(),
                c.clearMs, c.uncutMs, c.strongestMs, c.matchedMs, c.farM / 1000, c.nearFarRatio, c.density,
                std::string(toText(c.outcome)).c_str(), suffixOf(c).c_str());
  if (const std::string busy = busyText(othersShare); !busy.empty()) std::printf("%s\n", busy.c_str());
}

void printJson(const experiment::CalibratedWeather& calibrated, double othersShare) {
  nlohmann::ordered_json steps = nlohmann::ordered_json::array();
  for (const StepCalibration& c : calibrated.steps) {
    nlohmann::ordered_json trials = nlohmann::ordered_json::array();
    for (const CalibrationTrial& t : c.trials)
      trials.push_back({{"far_m", t.farM}, {"density", t.density}, {"ms", t.ms}});
    steps.push_back({{"step", nameOf(c.step)},
                     {"outcome", toText(c.outcome)},
                     {"clear_ms", c.clearMs},
                     {"uncut_ms", c.uncutMs},
                     {"strongest_ms", c.strongestMs},
                     {"matched_ms", c.matchedMs},
                     {"visibility_m", c.visibilityM},
                     {"far_m", c.farM},
                     {"near_far_ratio", c.nearFarRatio},
                     {"density", c.density},
                     {"drifted", c.drifted},
                     {"rejected", whyRejected(c)},
                     {"trials", trials}});
  }
  std::cout << nlohmann::ordered_json{{"vertices", calibrated.vertices},
                                      {"others_share", std::isfinite(othersShare)
                                                           ? nlohmann::ordered_json(othersShare)
                                                           : nlohmann::ordered_json()},
                                      {"steps", steps}}
                   .dump(2)
            << '\n';
}

int calibrate(const WeatherOptions& arguments) {
  if (!mayWriteFile(arguments.output)) return kRefused;
  const auto preset = loadPreset(arguments.preset);
  const std::optional<experiment::Setup> setup = setupFrom(arguments);
  if (!preset || !setup) return kRefused;
  experiment::WeatherCalibration wanted{stepsOf(arguments.steps), {}};
  if (arguments.vertices > 0) wanted.vertices = arguments.vertices;
  const MachineWatch watch;
  const auto calibrated = experiment::calibrateWeather(*setup, wanted);
  const double othersShare = watch.othersShare();
  report(calibrated.findings());
  if (!calibrated || isDamaged(*setup)) return kRefused;
  if (arguments.json)
    printJson(*calibrated, othersShare);
  else
    print(*calibrated, othersShare);
  if (arguments.output.empty()) return kDone;

  TuningParameters tuned = setup->parameters;
  const std::vector<RejectedStep> rejected = applyAccepted(calibrated->steps, tuned);
  for (const RejectedStep& each : rejected)
    report({{Severity::error, arguments.output, nameOf(each.step), "times that agree with each other",
             each.why}});
  if (rejected.size() < calibrated->steps.size() && !wrotePreset(*preset, tuned, arguments.output))
    return kRefused;
  return rejected.empty() ? kDone : kRefused;
}

}  // namespace

void addWeather(CLI::App& app, int& exitCode) {
  CLI::App* const group = app.add_subcommand("weather", "Calibrate what falls (document D)");
  group->require_subcommand(1);
  CLI::App* const command = group->add_subcommand("calibrate",
                                                  "Measure what each weather step costs and what the far cut "
                                                  "saves, and move the far plane out until both "
                                                  "match");
  const auto arguments = std::make_shared<WeatherOptions>();
  arguments->addTo(*command);
  std::vector<std::string> names;
  for (const WeatherStep step : stepsOf({})) names.push_back(nameOf(step));
  command->add_option("--step", arguments->steps, "Step to calibrate; may be repeated; without it all six")
      ->check(CLI::IsMember(names));
  command
      ->add_option("--vertices", arguments->vertices,
                   "Vertices in view, reached by the screen-space error; without it those of the preset")
      ->check(CLI::PositiveNumber);
  arguments->addOutput(*command,
                       "Preset file that receives far planes and densities, but none of a step whose times "
                       "contradict each other; then the exit code is 1");
  stopWhenAsked(*command);
  command->callback([arguments, &exitCode] { exitCode = calibrate(*arguments); });
}

}  // namespace trimtab::cli
