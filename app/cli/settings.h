#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/harness/run.h"
#include "trimtab/preset/preset.h"

namespace CLI {
class App;
}

namespace trimtab::cli {

/// Applies the texts "key=value" of `--set`. Each one that cannot be applied is a finding.
Findings applySettings(const std::vector<std::string>& settings, TuningParameters& parameters);

/// Returns the valid parameters of a preset with every `--set key=value` applied. On an error, prints the
/// findings on standard error and returns nothing.
std::optional<ValidatedParameters> parametersFor(const std::string& preset,
                                                 const std::vector<std::string>& settings);

/// Returns the provenance of what this program exports: the time is now, or what reproducible builds ask for,
/// as ISO 8601 UTC.
Provenance provenanceNow();

/// The share of a run that one of several processes does.
struct PartOptions {
  std::string part;
  bool join = false;

  /// Adds --part and --join.
  void add(CLI::App& command);
  /// Returns the part that was asked for; of --join one that does nothing but join.
  std::optional<harness::Plan::Part> read() const;
  /// Says what is missing of a run that is not complete. Returns the exit code.
  int incomplete(const std::vector<std::string>& notes) const;
};

}  // namespace trimtab::cli
