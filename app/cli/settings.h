#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trimtab/preset/table.h"

namespace trimtab::cli {

/// A preset's parameters after `--set key=value`s, valid; what is wrong goes to standard error.
std::optional<ValidatedParameters> parametersFor(const std::string& preset,
                                                 const std::vector<std::string>& settings);

/// "1280x720"; each 16 to 16384 pixels.
bool parseSize(const std::string& text, int& width, int& height);

}  // namespace trimtab::cli
