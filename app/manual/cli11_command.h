#pragma once

#include <CLI/CLI.hpp>

#include "app/manual/command.h"

namespace trimtab::manual {

/// Returns a program that CLI11 parses, with everything that its --help shows. `name` is what people type.
Command commandOf(const CLI::App& app, const std::string& name);

/// Adds the hidden option --write-manual DIR, which writes the manual and ends the program. A refusal goes to
/// standard error and ends the program with an error of CLI11.
void addManualOption(CLI::App& app, const std::string& name);

}  // namespace trimtab::manual
