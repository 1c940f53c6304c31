#include "app/experiment/leverage.h"

#include <iostream>
#include <memory>
#include <string>

#include "commands.h"
#include "experiment_setup.h"
#include "progress.h"
#include "trimtab/preset/preset.h"

namespace trimtab::cli {
namespace {

struct LeverageOptions : SetupArguments {
  std::size_t frames = 24;
  std::string losses;
};

int run(const LeverageOptions& arguments) {
  if (!mayWriteTo(arguments.output) || !mayWriteFile(arguments.losses)) return kRefused;
  const auto preset = loadPreset(arguments.preset);
  std::optional<experiment::Setup> setup = setupFrom(arguments);
  if (!preset || !setup) return kRefused;
  setup->frames = arguments.frames;
  const Result<experiment::Leverage> done = experiment::measureLeverage(*setup);
  report(done.findings());
  if (!done || isDamaged(*setup)) return kRefused;
  std::cout << (arguments.json ? toJson(*done) : toText(toReport(*done)));
  bool written = true;
  if (!arguments.losses.empty()) {
    TuningParameters tuned = setup->parameters;
    takeLosses(*done, tuned.hold);
    written &= wrotePreset(*preset, tuned, arguments.losses);
  }
  if (!arguments.output.empty()) {
    const auto results = writeLeverage(arguments.output, *done);
    report(results.findings());
    written &= results.ok();
  }
  return written ? kDone : kRefused;
}

}  // namespace

void addLeverage(CLI::App& app, int& exitCode) {
  CLI::App* command = app.add_subcommand(
      "leverage", "What each lever of a policy is worth here: milliseconds won against image lost");
  command->footer(
      "Each lever goes from one end of its usual range to the other with all others at rest. A lever that "
      "has "
      "nothing to do in the flight is measured under the condition that it is for, which its row names.");
  auto arguments = std::make_shared<LeverageOptions>();
  arguments->addTo(*command);
  command->get_option("--flight")->required()->description("The flight");
  command->add_option("--frames", arguments->frames, "Frames of the flight, evenly spread")
      ->capture_default_str()
      ->check(CLI::Range(1, 10000));
  arguments->addOutput(*command, "Folder for leverage.json, leverage.csv and leverage.html");
  command->add_option("--losses", arguments->losses,
                      "Preset file that receives what the arbiter loses by each lever, hold.loss_*");
  stopWhenAsked(*command);
  command->callback([arguments, &exitCode] { exitCode = cli::run(*arguments); });
}

}  // namespace trimtab::cli
