#include "experiment_setup.h"

#include <filesystem>

#include "commands.h"
#include "progress.h"
#include "settings.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::cli {

void SetupArguments::addTo(CLI::App& command) {
  add(command, flight, "Places to look from; without it the terrain's own", preset, "Preset or export");
  command.add_option("--repeats", repeats, "Frames a view whose median counts")
      ->capture_default_str()
      ->check(CLI::Range(1, 100));
}

std::optional<experiment::Setup> setupFrom(const SetupArguments& arguments) {
  experiment::Setup setup;
  setup.progress = progressLines();
  bool usable = arguments.readSize(setup.widthPx, setup.heightPx);
  const std::optional<ValidatedParameters> parameters = parametersFor(arguments.preset, arguments.settings);
  usable = parameters && usable;
  if (!arguments.flight.empty()) {
    std::optional<Flight> flight = arguments.readFlight(arguments.flight);
    usable = flight && usable;
    if (flight) setup.flight = *std::move(flight);
  }
  setup.hold = arguments.hold;
  if (!arguments.head.empty()) {
    Result<HeadLog> head = link::openHeadOption(arguments.head, true, arguments.headColumns);
    report(head.findings());
    usable = head && usable;
    if (head) setup.hold.head = std::move(head).value();
  }
  setup.terrain = arguments.openTerrain(setup.progress);
  if (!setup.terrain || !usable) return std::nullopt;
  setup.terrainName = setup.terrain->info().name;
  setup.parameters = **parameters;
  setup.presetName = arguments.preset;
  setup.repeats = arguments.repeats;
  setup.hostRateHz = arguments.hostRateHz;
  return setup;
}

bool mayWriteTo(const std::string& folder) {
  if (folder.empty()) return true;
  const auto writable = makeWritable(folder);
  report(writable.findings());
  return writable.ok();
}

bool mayWriteFile(const std::string& file) {
  if (file.empty()) return true;
  const auto writable = canMake(file);
  report(writable.findings());
  return writable.ok();
}

bool wrotePreset(Preset preset, const TuningParameters& parameters, const std::string& file) {
  preset.parameters = parameters;
  const Result<std::string> text = presetText(preset);
  report(text.findings());
  if (!text) return false;
  const auto written = writeAtomically(file, *text);
  report(written.findings());
  return written.ok();
}

bool isDamaged(const experiment::Setup& setup) {
  const Findings damage = setup.terrain->damage();
  report(damage);
  return !damage.empty();
}

}  // namespace trimtab::cli
