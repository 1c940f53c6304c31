#pragma once

#include <string>
#include <vector>

#include "trimtab/units/result.h"

/// Man pages and shell completion of a program, from its table of options.
namespace trimtab::manual {

/// An option, or a positional argument, whose one name has no dash.
struct Argument {
  std::vector<std::string> names;  ///< "-o", "--output"
  std::string value;               ///< what stands for its value, such as "DIR"; empty: a flag
  std::string text;                ///< what it does; empty for some positionals
  std::string range, unset;        ///< allowed values, such as "[1 - 100]", and the value if it is not given
  std::vector<std::string> choices;  ///< the words that it takes, if they are few
  std::vector<std::string> needs, excludes;
  bool required = false, repeats = false;

  bool positional() const { return !names.front().starts_with('-'); }
};

/// A program or one of its subcommands.
struct Command {
  std::string name;  ///< as it is typed: "trimtab-cli terrain bake"
  std::string text;
  std::vector<Argument> arguments;
  std::vector<Command> commands;
};

/// Returns the man page of one command, in roff with the macros of man(7), without those of its subcommands.
std::string manPage(const Command& command);

/// Returns a script for bash that completes subcommands, options, and values of which there are few.
/// Elsewhere bash offers files.
std::string bashCompletion(const Command& program);

/// Writes a page for the program and each subcommand into `folder`, such as trimtab-cli-terrain-bake.1, and
/// the completion as trimtab-cli.bash.
Result<Done> writeManual(const Command& program, const std::string& folder);

}  // namespace trimtab::manual
