#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/harness/run.h"
#include "trimtab/preset/table.h"

namespace trimtab::cli {

/// Applies the texts "key=value" of `--set`. Each one that cannot be applied is a finding.
Findings applySettings(const std::vector<std::string>& settings, TuningParameters& parameters);

/// Returns the valid parameters of a preset with every `--set key=value` applied. On an error, prints the
/// findings on standard error and returns nothing.
std::optional<ValidatedParameters> parametersFor(const std::string& preset,
                                                 const std::vector<std::string>& settings);

/// Reads a size in pixels such as "1280x720". Returns false unless both sides are 16 to 16384.
bool parseSize(const std::string& text, int& width, int& height);

/// Reads a share of work such as "2/8". Returns false unless it is the first to the last of its number.
bool parsePart(const std::string& text, std::optional<harness::Plan::Part>& part);
Finding refusedPart(const std::string& text);

}  // namespace trimtab::cli
