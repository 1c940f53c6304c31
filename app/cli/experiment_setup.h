#pragma once

#include <optional>
#include <string>

#include "app/experiment/experiment.h"
#include "run_options.h"
#include "trimtab/preset/preset.h"

namespace trimtab::cli {

/// The options that say what an experiment runs on.
struct SetupArguments : RunOptions {
  std::string flight, preset = "default";
  int repeats = 3;
  double hostRateHz = 200;
  experiment::HoldSetup hold;
  std::string head, headColumns;  ///< a log or a sweep; empty: none

  void addTo(CLI::App& command);
};

/// Opens terrain, flight and preset. On an error, prints all findings on standard error and returns nothing.
std::optional<experiment::Setup> setupFrom(const SetupArguments& arguments);

/// Sees, before the work, that a folder can take its results. Prints what is wrong. An empty name is none.
bool mayWriteTo(const std::string& folder);
/// Sees the same of the folder of a file.
bool mayWriteFile(const std::string& file);
/// Writes a preset with other parameters, as differences from its base. Prints what is wrong.
bool wrotePreset(Preset preset, const TuningParameters& parameters, const std::string& file);
/// Prints the damage of the terrain that the work met: images of what is not there are no measurement.
bool isDamaged(const experiment::Setup& setup);

}  // namespace trimtab::cli
